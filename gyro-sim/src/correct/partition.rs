//! The paper's two algorithms: direct integration and coordinate partitioning.

use super::{Correction, MAX_ITERATIONS, check_finite, check_time, reach};
use crate::contract::Storage;
use crate::violation::CONVERGED_EPSILONS;
use crate::violation::{Violation, constraint_violation};
use crate::{
    Clearance, Corrected, CorrectedDynamics, Error, Ode, Owner, Partition, Real, Rk4, Scalar, refer_turns,
};

/// *Direct integration* of the equations `D`, [`Exact`](crate::Exact) or [`Joint`](crate::Joint) of a mechanism or
/// those of a system of one's own. No constraint is corrected: violations grow, as the paper says.
#[derive(Clone, Debug)]
pub struct Direct<D, S> {
    dynamics: D,
    rk4: Rk4<S>,
}

impl<D, S: Clone> Direct<D, S> {
    /// A solver for states like this one.
    pub fn new(dynamics: D, state: &S) -> Self {
        Self { dynamics, rk4: Rk4::new(state) }
    }

    /// Advances `y` from `t` by `n_steps` steps of length `h`.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if the state is not finite afterwards, [`Error::InvalidEndTime`] if time or step are not
    /// finite.
    pub fn advance<M>(
        &mut self,
        model: &M,
        t: D::Scalar,
        h: D::Scalar,
        n_steps: u32,
        y: &mut S,
    ) -> Result<(), Error>
    where
        D: Ode<M, State = S, Scalar: Real>,
        S: Storage<D::Scalar>,
    {
        let end = t + h * D::Scalar::constant(f64::from(n_steps));
        check_time(t, end)?;
        for step in 0..n_steps {
            let t = t + h * D::Scalar::constant(f64::from(step));
            self.rk4.step(&self.dynamics, model, t, h, y);
        }
        check_finite(end, y.as_ref())
    }
}

/// *Coordinate partitioning* as a correction: dependent positions by Newton–Raphson, dependent velocities by eq. (19).
/// The choice of independent coordinates follows the motion.
#[derive(Clone, Debug)]
pub struct Partitioning<M: Partition> {
    independent: M::Independent,
    phi: M::Constraints,
    switches: u64,
}

impl<M: Partition<Scalar: Real>> Partitioning<M> {
    /// Begins with the best choice of independent coordinates at a state.
    pub fn new(mechanism: &M, t: M::Scalar, y: &M::State) -> Self {
        Self::with_independent(mechanism, mechanism.independent(t, y))
    }

    /// Begins with the given choice of independent coordinates.
    pub fn with_independent(mechanism: &M, independent: M::Independent) -> Self {
        Self { independent, phi: mechanism.buffers().constraints, switches: 0 }
    }

    /// Chooses the independent coordinates and corrects the dependent ones.
    ///
    /// # Errors
    /// [`Error`], with `y` as it was when the failure was noticed.
    pub fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        self.switches += u64::from(mechanism.follow(t, y, &mut self.independent));
        self.correct_with_current_choice(mechanism, t, y)
    }

    /// Corrects the dependent coordinates without checking whether the choice is still a good one: to show the effect
    /// of a fixed choice, or to choose by other means.
    ///
    /// # Errors
    /// [`Error`], with `y` as it was when the failure was noticed.
    pub fn correct_with_current_choice(
        &mut self,
        mechanism: &M,
        t: M::Scalar,
        y: &mut M::State,
    ) -> Result<(), Error> {
        self.correct_positions(mechanism, t, y)?;
        mechanism.solve_velocities(t, &self.independent, y)?;
        refer_turns(mechanism, t, y);
        check_finite(t, y.as_ref())
    }

    /// How often the choice of independent coordinates has changed, counted joint by joint.
    pub fn switches(&self) -> u64 {
        self.switches
    }

    /// The present choice of independent coordinates.
    pub fn independent(&self) -> &M::Independent {
        &self.independent
    }

    fn correct_positions(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        let tolerance = M::Scalar::EPSILON * M::Scalar::constant(CONVERGED_EPSILONS);
        let mut worst = Violation { value: tolerance, owner: None };
        for _ in 0..MAX_ITERATIONS {
            mechanism.newton_step(t, &self.independent, y)?;
            mechanism.phi(t, y, &mut self.phi);
            worst = constraint_violation(mechanism, self.phi.as_ref(), |x| x);
            if worst.value <= tolerance || worst.value <= tolerance * reach(mechanism, y) {
                return Ok(());
            }
            if mechanism.is_met(t, y, &self.phi) {
                return Ok(());
            }
        }
        let owner = worst.owner.unwrap_or(Owner::Body(0));
        Err(Error::NoConvergence { t: t.to_f64(), violation: worst.value.to_f64(), owner })
    }
}

impl<D, M> Correction<D, M> for Partitioning<M>
where
    M: Partition<Scalar: Real>,
    D: Ode<M, Scalar = M::Scalar, State = M::State>,
{
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        self.correct(mechanism, t, y)
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar {
        mechanism.phi(t, y, &mut self.phi);
        constraint_violation(mechanism, self.phi.as_ref(), |x| x).value
    }
    fn switches(&self) -> u64 {
        self.switches
    }
    fn clearance(&self, mechanism: &M, t: M::Scalar, y: &M::State) -> Option<Clearance<M::Scalar>> {
        mechanism.clearance(t, y)
    }
}

/// The paper's algorithm: RK4 and, after a number of steps, [`Partitioning`].
#[derive(Clone, Debug)]
pub struct Partitioned<M: Partition + CorrectedDynamics> {
    direct: Direct<Corrected, M::State>,
    partitioning: Partitioning<M>,
}

impl<M: Partition<Scalar: Real> + CorrectedDynamics> Partitioned<M> {
    /// A solver that starts with the best choice of independent coordinates at `state` and time zero.
    pub fn new(mechanism: &M, state: &M::State) -> Self {
        Self::with_independent(mechanism, state, mechanism.independent(M::Scalar::constant(0.0), state))
    }

    /// A solver that starts with the given choice of independent coordinates.
    pub fn with_independent(mechanism: &M, state: &M::State, independent: M::Independent) -> Self {
        Self {
            direct: Direct::new(Corrected, state),
            partitioning: Partitioning::with_independent(mechanism, independent),
        }
    }

    /// Advances `y` from `t` by `n_steps` steps of length `h` and corrects it.
    ///
    /// # Errors
    /// [`Error`], with `y` as it was when the failure was noticed.
    pub fn advance(
        &mut self,
        mechanism: &M,
        t: M::Scalar,
        h: M::Scalar,
        n_steps: u32,
        y: &mut M::State,
    ) -> Result<(), Error> {
        self.direct.advance(mechanism, t, h, n_steps, y)?;
        self.correct(mechanism, t + h * M::Scalar::constant(f64::from(n_steps)), y)
    }

    /// See [`Partitioning::correct`].
    ///
    /// # Errors
    /// [`Error`], with `y` as it was when the failure was noticed.
    pub fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        self.partitioning.correct(mechanism, t, y)
    }

    /// See [`Partitioning::correct_with_current_choice`].
    ///
    /// # Errors
    /// [`Error`], with `y` as it was when the failure was noticed.
    pub fn correct_with_current_choice(
        &mut self,
        mechanism: &M,
        t: M::Scalar,
        y: &mut M::State,
    ) -> Result<(), Error> {
        self.partitioning.correct_with_current_choice(mechanism, t, y)
    }

    /// How often the choice of independent coordinates has changed, counted joint by joint.
    pub fn switches(&self) -> u64 {
        self.partitioning.switches()
    }

    /// The present choice of independent coordinates.
    pub fn independent(&self) -> &M::Independent {
        self.partitioning.independent()
    }
}
