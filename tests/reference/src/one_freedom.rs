//! Mechanisms with one degree of freedom, reduced to one coordinate x.
//!
//! ```text
//! M = Σ m r'·r' + w·J w      ½ M' = Σ m r'·r'' + w·J w'      Q = Σ m g·r'          ' = d/dx
//! M ẍ + ½ M' ẋ² = Q
//! ```
//!
//! with w the angular velocity of a body per unit of ẋ. Where bodies are as functions of x is all that is written down
//! of a mechanism; the derivatives are those of its [`Jet`]s.

use crate::DoubleDouble;
use crate::extrapolation::State;
use crate::jet::{Jet, Moving};
use crate::rotation::{Precise, tensor_times};
use crate::trajectory::{decimal, decimals, smooth_trajectory};
use crate::vector::dot;

/// Mass and inertia tensor `[xx, yy, zz, xy, xz, yz]` in the body's frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Heft {
    pub(crate) mass: DoubleDouble,
    pub(crate) inertia: [DoubleDouble; 6],
}

impl Heft {
    /// With moments of inertia about the axes of the body's frame.
    pub(crate) fn diagonal(mass: f64, inertia: [f64; 3]) -> Self {
        let ([x, y, z], zero) = (decimals(inertia), DoubleDouble::ZERO);
        Heft { mass: decimal(mass), inertia: [x, y, z, zero, zero, zero] }
    }
}

/// A mechanism with one degree of freedom.
pub(crate) trait OneFreedom {
    /// Its moving bodies where the coordinate is x.
    fn bodies(&self, x: Jet) -> Vec<(Heft, Moving)>;
    /// Acceleration of gravity.
    fn gravity(&self) -> Precise;
}

/// ½ M, ½ M', Q and the potential −Σ m g·r.
struct Reduced {
    half_mass: DoubleDouble,
    half_slope: DoubleDouble,
    force: DoubleDouble,
    potential: DoubleDouble,
}

fn reduced(mechanism: &impl OneFreedom, x: DoubleDouble) -> Reduced {
    let zero = DoubleDouble::ZERO;
    let mut sum = Reduced { half_mass: zero, half_slope: zero, force: zero, potential: zero };
    for (heft, body) in mechanism.bodies(Jet::variable(x)) {
        let [r, v, slope] = [0, 1, 2].map(|k| body.centre_derivative(k));
        let [w, w_slope] = body.turning();
        let turning = tensor_times(heft.inertia, w);
        sum.half_mass = sum.half_mass + (heft.mass * dot(v, v) + dot(w, turning)).times(0.5);
        sum.half_slope = sum.half_slope + heft.mass * dot(v, slope) + dot(turning, w_slope);
        sum.force = sum.force + heft.mass * dot(mechanism.gravity(), v);
        sum.potential = sum.potential - heft.mass * dot(mechanism.gravity(), r);
    }
    sum
}

/// ẍ at x and ẋ.
pub(crate) fn acceleration(mechanism: &impl OneFreedom, [x, rate]: [DoubleDouble; 2]) -> DoubleDouble {
    let Reduced { half_mass, half_slope, force, .. } = reduced(mechanism, x);
    (force - half_slope * rate * rate) / half_mass.times(2.0)
}

/// Kinetic and potential energy.
pub(crate) fn energy(mechanism: &impl OneFreedom, [x, rate]: [DoubleDouble; 2]) -> DoubleDouble {
    let Reduced { half_mass, potential, .. } = reduced(mechanism, x);
    half_mass * rate * rate + potential
}

/// x and ẋ at `times`.
pub(crate) fn motion(
    mechanism: &impl OneFreedom,
    start: [DoubleDouble; 2],
    times: &[f64],
) -> Vec<(DoubleDouble, State<2>)> {
    let derivative = |_, state: &State<2>| [state[1], acceleration(mechanism, *state)];
    smooth_trajectory(derivative, start, times)
}
