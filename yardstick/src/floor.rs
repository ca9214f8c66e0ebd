//! The floor: the paper's scene derived by hand in minimal coordinates.
//!
//! The outer ring turns about Y by α, the inner ring about its Z by β, the rotor about its x by φ. In the inner ring's
//! frame, with s = sin β and c = cos β, the inner ring turns at `(α̇ s, α̇ c, β̇)` and the rotor at `(σ, α̇ c, β̇)`
//! with the spin `σ = α̇ s + φ̇`. The rotor's mass centre, on the spin axis at d, moves at `d (0, β̇, −α̇ c)` and
//! stands `d s` above the gimbal centre. With moments I₁ of the outer and I₂ of the inner ring, A and B of the rotor
//! along and across its axis and its mass m:
//!
//! ```text
//! 2 T = (P + Q c²) α̇² + R β̇² + A σ²         P = I₁y + I₂x   Q = I₂y − I₂x + B + m d²
//!   V = m g d s                             R = I₂z + B + m d²
//! ```
//!
//! φ is cyclic and nothing acts along it: `d/dt (A σ) = 0`, so A σ counts as a constant in the other two of Lagrange's
//! equations:
//!
//! ```text
//! (P + Q c²) α̈ = c β̇ (2 Q α̇ s − A σ)
//!          R β̈ = c (α̇ (A σ − Q α̇ s) − m g d)
//!             φ̈ = −(α̈ s + α̇ β̇ c)
//! ```
//!
//! Divided by Q, with `e = α̇ s − (A/Q) σ` and `u = c β̇`, that is
//!
//! ```text
//! α̈ = u (α̇ s + e) / (P/Q + c²)     β̈ = −c ((Q/R) α̇ e + m g d / R)     φ̈ = −(α̈ s + α̇ u)
//! ```
//!
//! which takes 17 operations (negations not counted) and one sine with its cosine.

use gyro_sim::{Ode, Rk4};
use std::hint::black_box;

/// Additions, multiplications and divisions of [`Floor::accelerations`].
pub const FLOPS: u64 = 17;

/// The paper's step, s.
pub const STEP: f64 = 1e-4;

/// Steps of its second.
const STEPS: u32 = 10_000;

/// The constants of the derivation.
#[derive(Clone, Copy, Debug)]
pub struct Floor {
    /// A/Q.
    spin: f64,
    /// P/Q.
    frame: f64,
    /// −Q/R.
    gyration: f64,
    /// −m g d / R.
    weight: f64,
}

impl Floor {
    /// Of `models/gyroscope.toml`.
    pub const fn paper() -> Self {
        let (mass, gravity, d) = (80e-3, 10.0, 0.000_125);
        let (along, across) = (100e-7, 50e-7 + mass * d * d);
        let [p, q, r] = [10e-7 + 10e-7, 20e-7 - 10e-7 + across, 10e-7 + across];
        Self { spin: along / q, frame: p / q, gyration: -q / r, weight: -mass * gravity * d / r }
    }

    /// α̈, β̈, φ̈ at the state `(α, β, φ, α̇, β̇, φ̇)`.
    #[inline]
    pub fn accelerations(&self, y: &[f64; 6]) -> [f64; 3] {
        let [_, beta, _, alpha_rate, beta_rate, phi_rate] = *y;
        let (s, c) = libm::sincos(beta);
        let x = alpha_rate * s;
        let e = x - self.spin * (x + phi_rate);
        let u = c * beta_rate;
        let alpha = u * (x + e) / (self.frame + c * c);
        let beta = c * (self.gyration * (alpha_rate * e) + self.weight);
        [alpha, beta, -(alpha * s + alpha_rate * u)]
    }

    /// The paper's second by RK4: 10 000 steps.
    pub fn second(&self) {
        let mut y = START;
        let mut rk4 = Rk4::new(&y);
        for step in 0..STEPS {
            rk4.step(self, &(), f64::from(step) * STEP, STEP, &mut y);
        }
        black_box(y);
    }
}

/// The rings at rest, the rotor at 100 rad/s.
pub const START: [f64; 6] = [0.0, 0.0, 0.0, 0.0, 0.0, 100.0];

impl Ode for Floor {
    type Scalar = f64;
    type State = [f64; 6];

    fn derivative(&self, _: &(), _: f64, y: &[f64; 6], dy: &mut [f64; 6]) {
        dy[..3].copy_from_slice(&y[3..]);
        dy[3..].copy_from_slice(&self.accelerations(y));
    }
}
