//! The paper's scene written by hand in minimal coordinates: what a specialist's firmware would hold.
//!
//! Lagrange's equations with the rotor's momentum along its axis as a constant; the derivation stands at the floor of
//! the project's benches (`benches/src/floor.rs`), whose double this is for both precisions.

use gyro_sim::{Ode, Real};

/// The state is (α, β, φ) and their rates.
#[derive(Clone, Copy, Debug)]
pub struct Minimal<T> {
    spin: T,
    frame: T,
    gyration: T,
    weight: T,
}

impl<T: Real> Minimal<T> {
    /// The paper's numbers: masses, moments and the eighth of a millimetre.
    pub fn new() -> Self {
        let (mass, gravity, d) = (80e-3, 10.0, 0.000_125);
        let (along, across) = (100e-7, 50e-7 + mass * d * d);
        let [p, q, r] = [10e-7 + 10e-7, 20e-7 - 10e-7 + across, 10e-7 + across];
        let k = T::constant;
        Self { spin: k(along / q), frame: k(p / q), gyration: k(-q / r), weight: k(-mass * gravity * d / r) }
    }
}

impl<T: Real> Minimal<T> {
    /// The rings at rest, the rotor at 100 rad/s.
    pub fn start() -> [T; 6] {
        [0.0, 0.0, 0.0, 0.0, 0.0, 100.0].map(T::constant)
    }
}

impl<T: Real> Default for Minimal<T> {
    fn default() -> Self {
        Self::new()
    }
}

impl<T: Real> Ode for Minimal<T> {
    type Scalar = T;
    type State = [T; 6];

    fn derivative(&self, _: &(), _: T, y: &[T; 6], dy: &mut [T; 6]) {
        let [_, beta, _, alpha_rate, beta_rate, phi_rate] = *y;
        let (s, c) = (beta.sin(), beta.cos());
        let x = alpha_rate * s;
        let e = x - self.spin * (x + phi_rate);
        let u = c * beta_rate;
        let alpha = u * (x + e) / (self.frame + c * c);
        let beta = c * (self.gyration * (alpha_rate * e) + self.weight);
        *dy = [alpha_rate, beta_rate, phi_rate, alpha, beta, -(alpha * s + alpha_rate * u)];
    }
}
