//! Attempts of steps, as those see them who have a say.

use super::Solver;
use crate::contract::Storage;
use crate::integrate::Method;
use crate::{Ode, Real, System};

/// An attempt of a step, before it is judged.
pub trait Tried<D, S, T> {
    /// The times at which it begins and ends, s.
    fn span(&self) -> [T; 2];
    /// The equations.
    fn dynamics(&self) -> &D;
    /// Whether its error is tolerated.
    fn fits(&mut self) -> bool;
    /// Writes the state at a fraction of it, 0 ≤ θ ≤ 1, not corrected.
    fn at(&mut self, theta: T, out: &mut S);
}

pub(super) struct Watched<'s, M, D, S, T, A, C> {
    solver: &'s mut Solver<D, S, T, A, C>,
    system: &'s M,
    h: T,
    end: T,
    is_prepared: bool,
}

impl<'s, M, D, S, T, A, C> Watched<'s, M, D, S, T, A, C> {
    /// The last attempt of a solver, by its length and its end.
    pub(super) fn new(solver: &'s mut Solver<D, S, T, A, C>, system: &'s M, (h, end): (T, T)) -> Self {
        Self { solver, system, h, end, is_prepared: false }
    }
}

impl<M, D, S, T, A, C> Tried<D, S, T> for Watched<'_, M, D, S, T, A, C>
where
    S: Storage<T>,
    T: Real,
    D: Ode<M, Scalar = T, State = S>,
    A: Method<D, M>,
{
    fn span(&self) -> [T; 2] {
        [self.solver.t, self.end]
    }

    fn dynamics(&self) -> &D {
        &self.solver.dynamics
    }

    fn fits(&mut self) -> bool {
        self.solver.weigh::<M>();
        let (error, _) = self.solver.method.error(self.h, &self.solver.weights);
        error <= T::constant(1.0)
    }

    fn at(&mut self, theta: T, out: &mut S) {
        let Solver { dynamics, method, t, y, statistics, .. } = &mut *self.solver;
        if theta <= T::constant(0.0) {
            return out.as_mut().copy_from_slice(y.as_ref());
        }
        if theta >= T::constant(1.0) {
            return out.as_mut().copy_from_slice(method.end().as_ref());
        }
        if !self.is_prepared {
            let system = System { dynamics: &*dynamics, model: self.system };
            method.prepare(system, *t, self.h, y, &mut statistics.work);
            self.is_prepared = true;
        }
        method.between(theta, out);
        dynamics.normalise(self.system, out);
    }
}
