//! The slider-crank of `models/slider-crank.toml`, derived by hand and reduced to its crank.
//!
//! Crank a and connecting rod l, the slider on the line through the crank's pivot; the crank stands at θ. With r = a
//! sin θ and y = a cos θ, the rod reaches h = √(l² − r²) along the line and turns at −κ per unit of the crank's rate,
//! and the slider moves at −v:
//!
//! ```text
//! κ = y/h     κ' = (κ² − 1) r/h     v = r (1 + κ)     v' = y (1 + κ) + r κ'          ' = d/dθ
//! ```
//!
//! The rod's mass counts as two point masses in its joints, which go with the crank's end and with the slider, and a
//! moment of inertia (which may be negative) that is missing, as in the [four-bar linkage](crate::FourBar). Only what
//! goes with the crank has weight that does work:
//!
//! ```text
//! M  = I₁ + I₂ κ² + m₃ v²      θ̈ = −(G y + (I₂ κ κ' + m₃ v v') θ̇²) / M
//! ```

use crate::Number;
use gyro_sim::Ode;

/// The mechanism's constants.
#[derive(Clone, Copy, Debug)]
pub struct SliderCrank<T> {
    /// a.
    crank: T,
    /// l².
    rod: T,
    /// I₁ and I₂.
    inertia: [T; 2],
    /// m₃.
    mass: T,
    /// G.
    weight: T,
}

impl<T: Number> SliderCrank<T> {
    /// Of `models/slider-crank.toml`.
    pub fn in_line() -> Self {
        let ([a, l], [m1, m2, m3], [j1, j2]) = ([0.1, 0.3], [0.5, 0.4, 0.6], [6e-4, 3.2e-3]);
        // Mass centres are in the middle: half the rod goes with the crank's end, half with the slider.
        let inertia = [j1 + (0.25 * m1 + 0.5 * m2) * a * a, j2 - 0.25 * m2 * l * l];
        Self {
            crank: T::constant(a),
            rod: T::constant(l * l),
            inertia: inertia.map(T::constant),
            mass: T::constant(m3 + 0.5 * m2),
            weight: T::constant(0.5 * (m1 + m2) * 9.81),
        }
    }

    /// The crank at 40 degrees, with 12 rad/s.
    pub fn start() -> [T; 2] {
        [40f64.to_radians(), 12.0].map(T::constant)
    }

    /// θ̈.
    #[inline]
    pub fn acceleration(&self, angle: T, rate: T) -> T {
        let one = T::constant(1.0);
        let (sin, cos) = angle.sin_cos();
        let (r, y) = (self.crank * sin, self.crank * cos);
        let per_reach = one / (self.rod - r * r).sqrt();
        let k = y * per_reach;
        let k_slope = (k * k - one) * (r * per_reach);
        let share = one + k;
        let v = r * share;
        let v_slope = y * share + r * k_slope;

        let (n2, n3) = (self.inertia[1] * k, self.mass * v);
        let mass = self.inertia[0] + n2 * k + n3 * v;
        let half_slope = n2 * k_slope + n3 * v_slope;
        -(self.weight * y + half_slope * (rate * rate)) / mass
    }
}

impl<T: Number> Ode for SliderCrank<T> {
    type Scalar = T;
    type State = [T; 2];

    fn derivative(&self, _: &(), _: T, y: &[T; 2], dy: &mut [T; 2]) {
        *dy = [y[1], self.acceleration(y[0], y[1])];
    }
}
