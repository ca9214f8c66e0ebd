//! Orientation: the paper's eqs. (3) and (15), Rodrigues' formula, products of Euler parameters.

use super::jet::Jet;
use super::linear::{Matrix, Vector};
use super::scope::Scope;
use crate::field::Field;

/// Euler parameters `(e0, e1, e2, e3)`.
pub type Euler<F> = [Jet<F>; 4];

impl<F: Field> Scope<'_, F> {
    /// A(p), eq. (3): from body components to global ones.
    pub fn rotation(&self, [e0, e1, e2, e3]: &Euler<F>) -> Matrix<F> {
        let half = &self.half;
        let rows = [
            [e0 * e0 + e1 * e1 - half, e1 * e2 - e0 * e3, e1 * e3 + e0 * e2],
            [e1 * e2 + e0 * e3, e0 * e0 + e2 * e2 - half, e2 * e3 - e0 * e1],
            [e1 * e3 - e0 * e2, e2 * e3 + e0 * e1, e0 * e0 + e3 * e3 - half],
        ];
        Matrix(rows.map(|row| row.map(|entry| &entry + &entry)))
    }

    /// Rodrigues: the rotation by an angle about a unit axis u, `cos I + (1 − cos) u uᵀ + sin ũ`.
    pub fn rotation_about(&self, u: &Vector<F>, angle: &Jet<F>) -> Matrix<F> {
        let (sin, cos) = (self.sin(angle), self.cos(angle));
        let rest = &self.one - &cos;
        let [x, y, z] = &u.0;
        let (sx, sy, sz) = (x * &sin, y * &sin, z * &sin);
        Matrix([
            [x * x * &rest + &cos, x * y * &rest - &sz, x * z * &rest + &sy],
            [y * x * &rest + &sz, y * y * &rest + &cos, y * z * &rest - &sx],
            [z * x * &rest - &sy, z * y * &rest + &sx, z * z * &rest + &cos],
        ])
    }

    /// Euler parameters of that rotation: `(cos ½angle, u sin ½angle)`.
    pub fn euler_about(&self, u: &Vector<F>, angle: &Jet<F>) -> Euler<F> {
        let angle = angle * &self.half;
        let (sin, [x, y, z]) = (self.sin(&angle), &u.0);
        [self.cos(&angle), x * &sin, y * &sin, z * &sin]
    }

    /// `½ G(p)ᵀ w'`, eqs. (14) and (15).
    pub fn euler_rate(&self, [e0, e1, e2, e3]: &Euler<F>, w: &Vector<F>) -> Euler<F> {
        let minus = |e: &Jet<F>| -e.clone();
        let g = [
            [minus(e1), e0.clone(), e3.clone(), minus(e2)],
            [minus(e2), minus(e3), e0.clone(), e1.clone()],
            [minus(e3), e2.clone(), minus(e1), e0.clone()],
        ];
        let [x, y, z] = &w.0;
        std::array::from_fn(|k| (&g[0][k] * x + &g[1][k] * y + &g[2][k] * z) * &self.half)
    }
}

/// The product of quaternions: of the frames' rotations, the second about the first.
pub fn compose<F: Field>([a0, a1, a2, a3]: &Euler<F>, [b0, b1, b2, b3]: &Euler<F>) -> Euler<F> {
    [
        a0 * b0 - a1 * b1 - a2 * b2 - a3 * b3,
        a0 * b1 + a1 * b0 + a2 * b3 - a3 * b2,
        a0 * b2 - a1 * b3 + a2 * b0 + a3 * b1,
        a0 * b3 + a1 * b2 - a2 * b1 + a3 * b0,
    ]
}

/// The rotation back.
pub fn conjugate<F: Field>([e0, e1, e2, e3]: &Euler<F>) -> Euler<F> {
    [e0.clone(), -e1.clone(), -e2.clone(), -e3.clone()]
}
