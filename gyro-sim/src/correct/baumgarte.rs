//! Baumgarte's stabilisation.

use super::Maximal;
use crate::{Mechanism, Ode, Projection, Scalar};

/// A mechanism whose accelerations steer violations back, `Φ̈ + 2 ω Φ̇ + ω² Φ = 0`, critically damped, with Euler parameters drawn
/// towards unit length at the rate ω (J. Baumgarte, *Stabilization of constraints and integrals of motion in dynamical systems*, Comput.
/// Methods Appl. Mech. Eng. 1 (1972)). ω is a rate of the mechanism's own motion: much slower does nothing, much faster makes it stiff.
#[derive(Clone, Copy, Debug)]
pub struct Baumgarte<'a, M: Mechanism> {
    /// The mechanism.
    pub mechanism: &'a M,
    /// ω, rad/s.
    pub rate: M::Scalar,
}

impl<M: Projection> Ode for Baumgarte<'_, M> {
    type Scalar = M::Scalar;
    type State = M::State;

    fn start(&self) -> Self::State {
        self.mechanism.start()
    }

    fn derivative(&self, t: Self::Scalar, y: &Self::State, dy: &mut Self::State) {
        let (mechanism, rate) = (self.mechanism, self.rate);
        mechanism.derivative(t, y, dy);
        let (mut phi, mut rows) = (mechanism.constraints(), mechanism.rows());
        let mut change = mechanism.velocities();
        mechanism.phi(t, y, &mut phi);
        mechanism.velocity_residual(t, y, &mut rows);
        for (row, phi) in rows.as_mut().iter_mut().zip(phi.as_ref()) {
            *row = -rate * (*row + *row + rate * *phi);
        }
        mechanism.project(t, y, &rows, &mut change);
        let n_bodies = mechanism.n_bodies();
        for (slope, change) in dy.as_mut().iter_mut().skip(7 * n_bodies).zip(change.as_ref()) {
            *slope = *slope + *change;
        }
        for (slopes, positions) in
            dy.as_mut().chunks_exact_mut(7).zip(y.as_ref().chunks_exact(7)).take(n_bodies)
        {
            let (slopes, p) = (&mut slopes[3..], &positions[3..]);
            let excess =
                p.iter().fold(Self::Scalar::constant(-1.0), |sum, e| Self::Scalar::fused(*e, *e, sum));
            let pull = -rate * Self::Scalar::constant(0.5) * excess;
            slopes.iter_mut().zip(p).for_each(|(slope, e)| *slope = Self::Scalar::fused(pull, *e, *slope));
        }
    }
}

impl<M: Projection> Maximal for Baumgarte<'_, M> {
    type Mechanism = M;

    fn mechanism(&self) -> &M {
        self.mechanism
    }
}
