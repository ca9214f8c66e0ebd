//! Going back to where the last step began, to end it elsewhere.

use super::{Solver, Statistics, Watch};
use crate::contract::Storage;
use crate::integrate::Method;
use crate::{Correction, Error, Ode, Real};

/// Where a step began: kept by those who may go back.
#[derive(Clone, Debug)]
pub(crate) struct Mark<S, T> {
    t: T,
    t_rest: T,
    y: S,
    since_correction: u32,
    statistics: Statistics,
}

impl<S: Storage<T>, T: Real> Mark<S, T> {
    pub(crate) fn new(t: T, y: &S) -> Self {
        let t_rest = T::constant(0.0);
        Self { t, t_rest, y: y.clone(), since_correction: 0, statistics: Statistics::default() }
    }

    pub(crate) fn time(&self) -> T {
        self.t
    }
}

impl<D, S: Storage<T>, T: Real, A, C> Solver<D, S, T, A, C> {
    /// Keeps where the next step begins.
    pub(crate) fn mark(&self, mark: &mut Mark<S, T>) {
        (mark.t, mark.t_rest) = (self.t, self.t_rest);
        mark.y.as_mut().copy_from_slice(self.y.as_ref());
        (mark.since_correction, mark.statistics) = (self.since_correction, self.statistics);
    }

    /// Takes an element of the state from the mark, where a correction has moved it.
    pub(crate) fn pin(&mut self, mark: &Mark<S, T>, index: usize) {
        let kept = mark.y.as_ref()[index];
        let now = &mut self.y.as_mut()[index];
        self.is_untouched &= *now == kept;
        *now = kept;
    }

    /// Puts in the state's place one that a correction of it has made.
    pub(crate) fn replace(&mut self, y: &S) {
        self.y.as_mut().copy_from_slice(y.as_ref());
        self.is_untouched = false;
    }

    /// Steps so far say nothing of how stiff the equations are that hold from here on.
    pub(crate) fn forget_stiffness(&mut self) {
        self.stiff = 0;
    }

    /// The length of the last step, s.
    pub(crate) fn last_step(&self) -> T {
        self.before.2
    }

    /// Goes back there. The steps since then count as rejected.
    pub(crate) fn rewind(&mut self, mark: &Mark<S, T>) {
        let Statistics { accepted, rejected, .. } = self.statistics;
        (self.t, self.t_rest) = (mark.t, mark.t_rest);
        self.set_state(&mark.y);
        self.since_correction = mark.since_correction;
        (self.is_kept, self.is_checked, self.resumes) = (false, true, false);
        self.statistics.accepted = mark.statistics.accepted;
        self.statistics.rejected = rejected + accepted.saturating_sub(mark.statistics.accepted);
        self.statistics.shortest_step = mark.statistics.shortest_step;
        self.statistics.longest_step = mark.statistics.longest_step;
    }

    /// Writes the state at a fraction of the last step, 0 ≤ θ ≤ 1, corrected, and returns its time. Fractions tell
    /// states apart that differ by less than the rounding of the time.
    pub(crate) fn within<M>(&mut self, system: &M, theta: T, out: &mut S) -> Result<T, Error>
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
        C: Correction<D, M>,
    {
        let (start, first, h) = &self.before;
        let (one, t) = (T::constant(1.0), T::fused(theta, *h, *start));
        if theta >= one {
            out.as_mut().copy_from_slice(self.y.as_ref());
            return Ok(self.t);
        }
        // The ends are what they are in the steps before and after, to the last bit.
        if theta <= T::constant(0.0) {
            out.as_mut().copy_from_slice(first.as_ref());
            return Ok(*start);
        }
        if self.leap.is_some() || !self.is_kept || self.watch == Watch::Needed {
            self.interpolate(system, t, out)?;
        } else {
            self.prepare_interpolation(system);
            self.method.between(theta, out);
            self.correction.correct(system, t, out)?;
        }
        Ok(t)
    }
}
