//! Turn references: the elements of the state that tell on which turn an angle is.

use crate::model::lowered::Lowered;
use crate::model::measure::Coordinate;
use crate::model::place::Moment;
use crate::number::Number;

impl<T: Number> Lowered<T> {
    /// Where the turn references begin in the state.
    pub(crate) fn first_turn(&self) -> usize {
        self.scene.n_q() + self.scene.n_v() + usize::from(self.work.is_some())
    }

    /// Writes the rates of the turn references: those of their angles.
    pub(crate) fn turn_rates(&self, at: Moment<'_, T>, out: &mut [T]) {
        for (out, turn) in out.iter_mut().zip(&self.turns) {
            let joint = &self.scene.joints[turn.joint];
            *out = Coordinate::of(joint, turn.coordinate).grip(joint, &self.scene.motions(at, joint)).rate;
        }
    }
}
