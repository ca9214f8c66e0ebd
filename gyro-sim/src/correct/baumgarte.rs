//! Baumgarte's stabilisation.

use crate::{Dynamics, Ode, Projection, Scalar};

/// Equations of motion whose accelerations reduce violations, `Φ̈ + 2 ω Φ̇ + ω² Φ = 0`, critically damped, with Euler
/// parameters drawn towards unit length at the rate ω (J. Baumgarte, *Stabilization of constraints and integrals of
/// motion in dynamical systems*, Comput. Methods Appl. Mech. Eng. 1 (1972)). ω is a rate of the mechanism's own motion:
/// a much slower one has no effect, a much faster one makes the equations stiff.
#[derive(Clone, Copy, Debug)]
pub struct Baumgarte<T> {
    /// ω, rad/s.
    pub rate: T,
}

impl<M: Dynamics + Projection> Ode<M> for Baumgarte<M::Scalar> {
    type Scalar = M::Scalar;
    type State = M::State;

    fn derivative(&self, mechanism: &M, t: M::Scalar, y: &M::State, dy: &mut M::State) {
        let rate = self.rate;
        mechanism.derivative(t, y, dy);
        let (mut phi, mut rows) = (mechanism.buffers().constraints, mechanism.buffers().rows);
        let mut change = mechanism.buffers().velocities;
        mechanism.phi(t, y, &mut phi);
        mechanism.velocity_residual(t, y, &mut rows);
        for (row, phi) in rows.as_mut().iter_mut().zip(phi.as_ref()) {
            *row = -rate * (*row + *row + rate * *phi);
        }
        mechanism.project(t, y, &rows, &mut change);
        let n_bodies = mechanism.description().bodies.len();
        for (slope, change) in dy.as_mut().iter_mut().skip(7 * n_bodies).zip(change.as_ref()) {
            *slope = *slope + *change;
        }
        for (slopes, positions) in
            dy.as_mut().chunks_exact_mut(7).zip(y.as_ref().chunks_exact(7)).take(n_bodies)
        {
            let (slopes, p) = (&mut slopes[3..], &positions[3..]);
            let excess = p.iter().fold(M::Scalar::constant(-1.0), |sum, e| M::Scalar::fused(*e, *e, sum));
            let pull = -rate * M::Scalar::constant(0.5) * excess;
            slopes.iter_mut().zip(p).for_each(|(slope, e)| *slope = M::Scalar::fused(pull, *e, *slope));
        }
    }
}
