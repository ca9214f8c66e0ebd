//! The crank-rocker of `models/four-bar.toml`, derived by hand and reduced to its crank.
//!
//! Crank a, coupler l and rocker b between pivots O and D at the distance d along x; the crank stands at θ. The coupler
//! p from the crank's end A to B and the rocker q from D to B have p = q + L with L from A to D. With r = |L| and
//! L⊥ = L turned by a quarter turn, B is where the circles about A and D meet:
//!
//! ```text
//! w = ½ (r² + l² − b²)     r² p = w L + σ L⊥     σ² = l² r² − w²     σ = p ∧ q     p·q = l² − w
//! ```
//!
//! C = a d cos θ and S = a d sin θ are all that changes in r², w, and in the crank's A'·L = −S and A'·L⊥ = C − a²,
//! where ' = d/dθ. So coupler and rocker turn at κ₂ and κ₃ per unit of the crank's rate, with x = S/σ and u = 1/r²:
//!
//! ```text
//! κ₃ = u (x w + a² − C)     κ₃' = u (x' w + S (1 − κ₂ − κ₃))
//! κ₂ = κ₃ − x               κ₂' = κ₃' − x'                     x' = (C − x² p·q) / σ
//! ```
//!
//! The coupler's mass counts as two point masses in its joints, which go round with crank and rocker, and a moment of
//! inertia (which may be negative) that is missing: I₂ = J₂ − m₂ ε (1 − ε) l² for a mass centre at ε of its length.
//! Then
//!
//! ```text
//! M  = I₁ + I₂ κ₂² + I₃ κ₃²      V' = G₁ C + G₃ κ₃ d q_x      r² d q_x = (w − r²) (d² − C) + σ S
//! θ̈ = −(V' + (I₂ κ₂ κ₂' + I₃ κ₃ κ₃') θ̇²) / M
//! ```

use crate::Number;
use gyro_sim::Ode;

/// The linkage's constants.
#[derive(Clone, Copy, Debug)]
pub struct FourBar<T> {
    /// a d.
    area: T,
    /// w + C.
    middle: T,
    /// ½ (l² − b²).
    k: T,
    /// l² − b².
    two_k: T,
    /// l².
    coupler: T,
    /// l² (l² − b²).
    closure: T,
    /// a².
    crank: T,
    /// d².
    ground: T,
    /// I₁, I₂ and I₃.
    inertia: [T; 3],
    /// G₁ and G₃.
    weight: [T; 2],
}

impl<T: Number> FourBar<T> {
    /// Of `models/four-bar.toml`.
    pub fn crank_rocker() -> Self {
        let [a, l, b, d] = [0.2, 0.5, 0.4, 0.5];
        let ([m1, m2, m3], [j1, j2, j3]) = ([0.4, 1.0, 0.8], [1.35e-3, 2.1e-2, 1.08e-2]);
        let gravity = 9.81;
        // Mass centres are in the middle: half the coupler goes round with the crank, half with the rocker.
        let inertia = [
            j1 + (0.25 * m1 + 0.5 * m2) * a * a,
            j2 - 0.25 * m2 * l * l,
            j3 + (0.25 * m3 + 0.5 * m2) * b * b,
        ];
        let weight = [0.5 * (m1 + m2) * gravity / d, 0.5 * (m2 + m3) * gravity / d];
        let two_k = l * l - b * b;
        Self {
            area: T::constant(a * d),
            middle: T::constant(0.5 * (a * a + d * d + two_k)),
            k: T::constant(0.5 * two_k),
            two_k: T::constant(two_k),
            coupler: T::constant(l * l),
            closure: T::constant(l * l * two_k),
            crank: T::constant(a * a),
            ground: T::constant(d * d),
            inertia: inertia.map(T::constant),
            weight: weight.map(T::constant),
        }
    }

    /// The crank at 60 degrees, with 6 rad/s.
    pub fn start() -> [T; 2] {
        [core::f64::consts::FRAC_PI_3, 6.0].map(T::constant)
    }

    /// θ̈.
    #[inline]
    pub fn acceleration(&self, angle: T, rate: T) -> T {
        let [i1, i2, i3] = self.inertia;
        let one = T::constant(1.0);
        let (sin, cos) = angle.sin_cos();
        let (s, c) = (self.area * sin, self.area * cos);
        let w = self.middle - c;
        let u = T::constant(0.5) / (w - self.k);
        let dot = self.coupler - w;
        let sigma = (w * (self.coupler + dot) - self.closure).sqrt();
        let per_sigma = one / sigma;

        let x = s * per_sigma;
        let k3 = u * (x * w + (self.crank - c));
        let k2 = k3 - x;
        let x_slope = per_sigma * (c - x * x * dot);
        let k3_slope = u * (x_slope * w + s * (one - k2 - k3));
        let k2_slope = k3_slope - x_slope;

        let (n2, n3) = (i2 * k2, i3 * k3);
        let mass = i1 + n2 * k2 + n3 * k3;
        let half_slope = n2 * k2_slope + n3 * k3_slope;
        let across = (self.two_k - w) * (self.ground - c) + sigma * s;
        let slope_of_potential = self.weight[0] * c + self.weight[1] * (u * k3) * across;
        -(slope_of_potential + half_slope * (rate * rate)) / mass
    }
}

impl<T: Number> Ode for FourBar<T> {
    type Scalar = T;
    type State = [T; 2];

    fn derivative(&self, _: &(), _: T, y: &[T; 2], dy: &mut [T; 2]) {
        *dy = [y[1], self.acceleration(y[0], y[1])];
    }
}
