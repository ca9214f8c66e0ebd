//! One row of a Jacobian: what a scalar's derivative has in the columns of each body.

use crate::model::primitives::Pull;
use crate::number::Number;

/// The most bodies that one row touches: a coupler of two joints has four, one by formula more.
pub(crate) const OF_TWO_JOINTS: usize = 4;
pub(crate) const OF_FORMULA: usize = 2 * gyro_model::Coupler::MOST;

/// Blocks of `3 + N` columns, (r, p) with N = 4 or (r, π') with N = 3, by ascending moving_body.
#[derive(Clone, Debug)]
pub(crate) struct Gradient<T, const N: usize, const BODIES: usize>([Option<(usize, Pull<T, N>)>; BODIES]);

impl<T: Number, const N: usize, const BODIES: usize> Gradient<T, N, BODIES> {
    pub(crate) fn new() -> Self {
        Self([const { None }; BODIES])
    }

    /// Adds a derivative with respect to the position of a body.
    pub(crate) fn add(&mut self, moving_body: usize, pull: Pull<T, N>) {
        let before =
            |block: &Option<(usize, _)>| block.as_ref().is_some_and(|(other, _)| *other < moving_body);
        let at = self.0.partition_point(before);
        match &mut self.0[at] {
            Some((other, sum)) if *other == moving_body => *sum = sum.combine(T::one(), &pull, T::one()),
            _ => {
                self.0[at..].rotate_right(1);
                self.0[at] = Some((moving_body, pull));
            }
        }
    }

    /// Calls the sink with column and value of each entry that is not zero by structure.
    pub(crate) fn walk(&self, mut sink: impl FnMut(usize, T)) {
        self.0.iter().flatten().for_each(|(moving_body, pull)| pull.walk(*moving_body, &mut sink));
    }
}
