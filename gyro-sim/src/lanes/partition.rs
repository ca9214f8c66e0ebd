//! Direct integration and coordinate partitioning of all lanes at once: what [`crate::Direct`] and [`crate::Partitioned`] do, lane by lane.

use super::{Failures, Lanes, are_finite, keep};
use crate::correct::{CONVERGED_EPSILONS, MAX_ITERATIONS};
use crate::violation::constraint_violation;
use crate::{
    Charted, Corrected, Error, Mechanism, Ode, Owner, Real, Rk4, Scalar, Storage, charts, refer_turns,
};

/// *Direct integration*, of maximal coordinates or, as [`JointForm`](crate::JointForm), of joint coordinates.
#[derive(Clone, Debug)]
pub struct Direct<S> {
    rk4: Rk4<S>,
    before: S,
    failures: Failures,
}

impl<S: Clone> Direct<S> {
    /// A solver for states like this one.
    pub fn new(state: &S) -> Self {
        Self { rk4: Rk4::new(state), before: state.clone(), failures: Failures::default() }
    }

    /// Advances the lanes of `y` that have not failed from `t` by `n_steps` steps of length `h`. Time and step may differ from lane to
    /// lane.
    pub fn advance<O>(&mut self, system: &O, t: O::Scalar, h: O::Scalar, n_steps: u32, y: &mut S)
    where
        O: Ode<State = S, Scalar: Lanes>,
        S: Storage<O::Scalar>,
    {
        self.before.as_mut().copy_from_slice(y.as_ref());
        for step in 0..n_steps {
            self.rk4.step(system, t + h * O::Scalar::constant(f64::from(step)), h, y);
        }
        keep(self.failures.running::<O::Scalar>(), y.as_mut(), self.before.as_ref());
        let end = t + h * O::Scalar::constant(f64::from(n_steps));
        self.failures.note_no_end(t, end);
        self.failures.note_not_finite(end, y.as_ref());
    }

    /// What has gone wrong so far.
    pub fn failures(&self) -> &Failures {
        &self.failures
    }
}

/// *Coordinate partitioning* of a tree of revolute, spherical and fixed joints: after a number of steps dependent positions and
/// velocities are corrected, in each lane on charts of its own.
#[derive(Clone, Debug)]
pub struct Partitioned<M: Charted> {
    direct: Direct<M::State>,
    /// Each joint's chart as a unit vector.
    charts: M::Vectors,
    phi: M::Constraints,
}

impl<M: Charted<Scalar: Lanes>> Partitioned<M> {
    /// A solver that starts on the best charts at `state`.
    pub fn new(mechanism: &M, state: &M::State) -> Self {
        let (direct, phi) = (Direct::new(state), mechanism.constraints());
        let mut charts = mechanism.chart_vectors(state);
        charts.as_mut().iter_mut().for_each(|vector| *vector = largest(vector).1);
        Self { direct, charts, phi }
    }

    /// Advances the lanes of `y` that have not failed from `t` by `n_steps` steps of length `h` and corrects them. Time and step may
    /// differ from lane to lane.
    pub fn advance(&mut self, mechanism: &M, t: M::Scalar, h: M::Scalar, n_steps: u32, y: &mut M::State) {
        self.direct.advance(&Corrected(mechanism), t, h, n_steps, y);
        self.correct(mechanism, t + h * M::Scalar::constant(f64::from(n_steps)), y);
    }

    /// Chooses the charts and corrects the lanes that have not failed.
    pub fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) {
        let vectors = mechanism.chart_vectors(y);
        for (vector, chart) in vectors.as_ref().iter().zip(self.charts.as_mut()) {
            follow(vector, chart);
        }
        self.correct_positions(mechanism, t, y);
        self.direct.before.as_mut().copy_from_slice(y.as_ref());
        mechanism.solve_velocities_on(t, &self.charts, y);
        refer_turns(mechanism, t, y);
        let failures = &mut self.direct.failures;
        keep(failures.running::<M::Scalar>(), y.as_mut(), self.direct.before.as_ref());
        failures.note_not_finite(t, y.as_ref());
    }

    /// What has gone wrong so far.
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
            mechanism.newton_step_on(t, &self.charts, y);
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

/// The largest component and, as a unit vector, which one it is.
fn largest<T: Lanes>(vector: &[T; 4]) -> (T, [T; 4]) {
    let [zero, one] = [0.0, 1.0].map(T::constant);
    let mut size = vector[0].abs();
    let mut unit = [one, zero, zero, zero];
    for k in 1..4 {
        let is_larger = vector[k].abs().greater(size);
        size = T::select(is_larger, vector[k].abs(), size);
        unit = unit.map(|x| T::select(is_larger, zero, x));
        unit[k] = T::select(is_larger, one, unit[k]);
    }
    (size, unit)
}

/// Leaves a chart that has become poor.
fn follow<T: Lanes>(vector: &[T; 4], chart: &mut [T; 4]) {
    let (size, best) = largest(vector);
    let [a, b, c, d] = core::array::from_fn(|k| vector[k].abs() * chart[k]);
    let is_poor = size.greater((a + b + c + d) * T::constant(charts::HYSTERESIS));
    *chart = core::array::from_fn(|k| T::select(is_poor, best[k], chart[k]));
}

/// The largest violation of a constraint, lengths in units of the mechanism's size, and where all are finite.
fn violation<M: Mechanism<Scalar: Lanes>>(
    mechanism: &M,
    phi: &[M::Scalar],
) -> (M::Scalar, <M::Scalar as Lanes>::Mask) {
    let n_rows = phi.len().saturating_sub(mechanism.n_bodies());
    let mut worst = [M::Scalar::constant(0.0); 2];
    for (index, value) in phi.iter().enumerate() {
        let is_length = index < n_rows && mechanism.row(index).is_length;
        let worst = &mut worst[usize::from(is_length)];
        *worst = larger(*worst, value.abs());
    }
    // The largest of quotients by one number is the quotient of the largest.
    let [number, length] = worst;
    (larger(number, length / mechanism.size()), are_finite(phi))
}

/// The largest coordinate of a mass centre in units of the mechanism's size.
fn reach<M: Mechanism<Scalar: Lanes>>(mechanism: &M, y: &M::State) -> M::Scalar {
    let bodies = y.as_ref().chunks_exact(7).take(mechanism.n_bodies());
    let coordinates = bodies.flat_map(|body| body.iter().take(3));
    coordinates.fold(M::Scalar::constant(0.0), |largest, r| larger(largest, r.abs())) / mechanism.size()
}

fn larger<T: Lanes>(one: T, other: T) -> T {
    T::select(other.greater(one), other, one)
}
