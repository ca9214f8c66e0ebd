//! What of the state moves neither bodies nor work: the model file's own states, and the turn references, which tell on
//! which turn an angle is.

use crate::model::amount::Now;
use crate::model::lowered::Lowered;
use crate::model::measure::Coordinate;
use crate::model::place::Moment;
use crate::number::Number;

impl<T: Number> Lowered<T> {
    /// Writes the rates of the states, and of the turn references: those of their angles.
    pub(crate) fn other_rates(&self, at: Moment<'_, T>, out: &mut [T]) {
        let (states, turns) = out.split_at_mut(self.states.len());
        for (out, rate) in states.iter_mut().zip(&self.states) {
            *out = rate.value(&Now::new(&self.scene, at));
        }
        for (out, turn) in turns.iter_mut().zip(&self.turns) {
            let joint = &self.scene.joints[turn.joint];
            *out = Coordinate::of(joint, turn.coordinate).grip(joint, &self.scene.motions(at, joint)).rate;
        }
    }

    /// Where these begin in the state.
    pub(crate) fn first_of_others(&self) -> usize {
        self.scene.n_q() + self.scene.n_v() + usize::from(self.work.is_some())
    }
}
