//! Which of the two that stand for an orientation a run shows.

use crate::motion::Motion;
use gyro_sim::{Mechanism, Scalar};

/// Where Euler parameters begin in a maximal state that a motion has with the other sign than its start. In joint
/// coordinates they are products of half turns, which are continuous over any number of turns: so the sign at the start
/// tells them for good, also between looks that are whole turns apart.
#[derive(Debug, Default)]
pub(super) struct Sides(Vec<usize>);

impl Sides {
    /// Of a motion that begins at a state.
    pub(super) fn of<M: Mechanism<Scalar: PartialOrd>>(
        mechanism: &M,
        motion: &mut dyn Motion<M>,
        start: &M::State,
    ) -> Self {
        let mut shown = start.clone();
        if motion.at(mechanism, motion.time(), &mut shown).is_err() {
            return Self::default();
        }
        let zero = M::Scalar::constant(0.0);
        let along = |first: usize| {
            let both = (first..first + 4).map(|k| start.as_ref()[k] * shown.as_ref()[k]);
            both.fold(zero, |sum, product| sum + product)
        };
        let bodies = 0..mechanism.description().bodies.len();
        Self(bodies.map(|body| 7 * body + 3).filter(|&first| along(first) < zero).collect())
    }

    /// Gives a state that the motion has shown the signs that follow from the start's.
    pub(super) fn set<T: Scalar>(&self, y: &mut [T]) {
        self.0.iter().for_each(|&first| y[first..first + 4].iter_mut().for_each(|e| *e = -*e));
    }
}
