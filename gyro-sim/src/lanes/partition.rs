//! Direct integration and coordinate partitioning of all lanes at once: what [`crate::Direct`] and
//! [`crate::Partitioned`] do, lane by lane.

use super::{Failures, are_finite, keep};
use crate::contract::Storage;
use crate::correct::{MAX_ITERATIONS, reach};
use crate::scalar::larger;
use crate::violation::CONVERGED_EPSILONS;
use crate::violation::constraint_violation;
use crate::{
    Corrected, CorrectedDynamics, Error, Lanes, Mechanism, Ode, Owner, Partition, Real, Rk4, Scalar,
    refer_turns,
};

/// *Direct integration* of the equations `D`: of maximal coordinates or, with [`Joint`](crate::Joint), of joint
/// coordinates.
#[derive(Clone, Debug)]
pub struct Direct<D, S> {
    dynamics: D,
    rk4: Rk4<S>,
    before: S,
    failures: Failures,
}

impl<D, S: Clone> Direct<D, S> {
    /// A solver for states like this one.
    pub fn new(dynamics: D, state: &S) -> Self {
        Self { dynamics, rk4: Rk4::new(state), before: state.clone(), failures: Failures::default() }
    }

    /// Advances the lanes of `y` that have not failed from `t` by `n_steps` steps of length `h`. Time and step may
    /// differ from lane to lane.
    pub fn advance<M>(&mut self, model: &M, t: D::Scalar, h: D::Scalar, n_steps: u32, y: &mut S)
    where
        D: Ode<M, State = S, Scalar: Lanes>,
        S: Storage<D::Scalar>,
    {
        self.before.as_mut().copy_from_slice(y.as_ref());
        for step in 0..n_steps {
            let t = t + h * D::Scalar::constant(f64::from(step));
            self.rk4.step(&self.dynamics, model, t, h, y);
        }
        keep(self.failures.running::<D::Scalar>(), y.as_mut(), self.before.as_ref());
        let end = t + h * D::Scalar::constant(f64::from(n_steps));
        self.failures.note_invalid_end_time(t, end);
        self.failures.note_not_finite(end, y.as_ref());
    }

    /// The errors so far.
    pub fn failures(&self) -> &Failures {
        &self.failures
    }
}

/// *Coordinate partitioning* of a tree of revolute, spherical and fixed joints: after a number of steps dependent
/// positions and velocities are corrected, in each lane on charts of its own.
#[derive(Clone, Debug)]
pub struct Partitioned<M: Partition + CorrectedDynamics> {
    direct: Direct<Corrected, M::State>,
    independent: M::Independent,
    phi: M::Constraints,
}

impl<M: Partition + CorrectedDynamics> Partitioned<M> {
    /// A solver that starts on the best charts at `state`.
    pub fn new(mechanism: &M, state: &M::State) -> Self {
        let independent = mechanism.independent(M::Scalar::constant(0.0), state);
        Self { direct: Direct::new(Corrected, state), independent, phi: mechanism.buffers().constraints }
    }

    /// Advances the lanes of `y` that have not failed from `t` by `n_steps` steps of length `h` and corrects them. Time
    /// and step may differ from lane to lane.
    pub fn advance(&mut self, mechanism: &M, t: M::Scalar, h: M::Scalar, n_steps: u32, y: &mut M::State) {
        self.direct.advance(mechanism, t, h, n_steps, y);
        self.correct(mechanism, t + h * M::Scalar::constant(f64::from(n_steps)), y);
    }

    /// Chooses the charts and corrects the lanes that have not failed.
    pub fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) {
        mechanism.follow(t, y, &mut self.independent);
        self.correct_positions(mechanism, t, y);
        self.direct.before.as_mut().copy_from_slice(y.as_ref());
        let solved = mechanism.solve_velocities(t, &self.independent, y);
        refer_turns(mechanism, t, y);
        let failures = &mut self.direct.failures;
        failures.note_all::<M::Scalar>(solved);
        keep(failures.running::<M::Scalar>(), y.as_mut(), self.direct.before.as_ref());
        failures.note_not_finite(t, y.as_ref());
    }

    /// The errors so far.
    pub fn failures(&self) -> &Failures {
        self.direct.failures()
    }

    /// Newton's iteration, in each lane until it has converged there.
    fn correct_positions(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) {
        let epsilon = <M::Scalar as Lanes>::Lane::EPSILON;
        let tolerance = M::Scalar::from_lanes(|_| epsilon) * M::Scalar::constant(CONVERGED_EPSILONS);
        let mut active = self.direct.failures.running::<M::Scalar>();
        for _ in 0..MAX_ITERATIONS {
            if active == 0 {
                return;
            }
            self.direct.before.as_mut().copy_from_slice(y.as_ref());
            let solved = mechanism.newton_step(t, &self.independent, y);
            self.direct.failures.note_all::<M::Scalar>(solved);
            keep(active, y.as_mut(), self.direct.before.as_ref());
            mechanism.phi(t, y, &mut self.phi);
            let (worst, is_finite) = violation(mechanism, self.phi.as_ref());
            active &= !M::Scalar::bits(worst.at_most(tolerance) & is_finite);
            if active != 0 {
                let is_met = worst.at_most(tolerance * reach(mechanism, y));
                active &= !M::Scalar::bits(is_met & is_finite);
            }
        }
        let phi = self.phi.as_ref();
        self.direct.failures.note(active, |lane| {
            let worst = constraint_violation(mechanism, phi, |x| x.lane(lane));
            let owner = worst.owner.unwrap_or(Owner::Body(0));
            Error::NoConvergence { t: t.lane(lane).to_f64(), violation: worst.value.to_f64(), owner }
        });
    }
}

/// The largest violation of a constraint, lengths in units of the mechanism's size, and where all are finite.
fn violation<M: Mechanism<Scalar: Lanes>>(
    mechanism: &M,
    phi: &[M::Scalar],
) -> (M::Scalar, <M::Scalar as Lanes>::Mask) {
    let mut worst = [M::Scalar::constant(0.0); 2];
    for (index, value) in phi.iter().enumerate() {
        let is_length = mechanism.description().is_length(index);
        let worst = &mut worst[usize::from(is_length)];
        *worst = larger(*worst, value.absolute());
    }
    // The largest of quotients by one number is the quotient of the largest.
    let [number, length] = worst;
    (larger(number, length / mechanism.size()), are_finite(phi))
}
