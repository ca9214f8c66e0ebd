//! Vectors, quaternions and poses over any scalar: floating point, or dual numbers that carry a derivative along.

use num_dual::Dual64;

use crate::scalar::Scalar;
use crate::{Quaternion, Vector};

/// Scalar product.
pub(crate) fn dot<D: Scalar>(a: [D; 3], b: [D; 3]) -> D {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The angle whose sine and cosine are in the ratio of two numbers, continuous: within half a turn of `near`.
///
/// It is differentiated where its tangent is about zero, so no quadrant is worse than another.
pub(crate) fn angle<D: Scalar>(sine: D, cosine: D, near: f64) -> D {
    let turned = |by: f64| {
        let (s, c) = by.sin_cos();
        (sine * c - cosine * s, cosine * c + sine * s)
    };
    let (s, c) = turned(near);
    let nearest = near + s.re().atan2(c.re());
    let (s, c) = turned(nearest);
    s.atan2(c) + nearest
}

/// Where a body is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pose<D> {
    /// Position of the mass centre, global.
    pub(crate) r: [D; 3],
    /// Unit Euler parameters.
    pub(crate) p: [D; 4],
    /// The matrix A(p), paper eq. (3), by rows.
    pub(crate) a: [[D; 3]; 3],
}

impl<D: Scalar> Pose<D> {
    /// The pose of position and unit Euler parameters.
    pub(crate) fn new(r: [D; 3], p: [D; 4]) -> Self {
        let [e0, e1, e2, e3] = p;
        let diagonal = |e: D| (e0 * e0 + e * e - 0.5) * 2.0;
        let twice = |x: D| x * 2.0;
        let a = [
            [diagonal(e1), twice(e1 * e2 - e0 * e3), twice(e1 * e3 + e0 * e2)],
            [twice(e1 * e2 + e0 * e3), diagonal(e2), twice(e2 * e3 - e0 * e1)],
            [twice(e1 * e3 - e0 * e2), twice(e2 * e3 + e0 * e1), diagonal(e3)],
        ];
        Self { r, p, a }
    }

    /// A direction that is constant in the body, in the global frame.
    pub(crate) fn direction(&self, v: Vector) -> [D; 3] {
        let [x, y, z] = v.into();
        self.a.map(|row| row[0] * x + row[1] * y + row[2] * z)
    }

    /// A point of the body, in the global frame.
    pub(crate) fn point(&self, s: Vector) -> [D; 3] {
        let arm = self.direction(s);
        std::array::from_fn(|k| self.r[k] + arm[k])
    }
}

impl Pose<Dual64> {
    /// A pose that does not vary.
    pub(crate) fn still(r: [f64; 3], p: [f64; 4]) -> Self {
        Self::new(r.map(Dual64::from_re), p.map(Dual64::from_re))
    }

    /// The same pose with its derivative in one of the six directions (r, π'): `δp = ½ Gᵀ δπ'`, paper eq. (14).
    pub(crate) fn varied(&self, direction: usize) -> Self {
        let (r, p) = (self.r.map(|x| x.re), self.p.map(|x| x.re));
        let mut unit = [0.0; 3];
        if direction < 3 {
            unit[direction] = 1.0;
            return Self::new(std::array::from_fn(|k| Dual64::new(r[k], unit[k])), p.map(Dual64::from_re));
        }
        unit[direction - 3] = 0.5;
        let [x, y, z] = unit;
        let rate = (Quaternion(p) * Quaternion([0.0, x, y, z])).0;
        let p = std::array::from_fn(|k| Dual64::new(p[k], rate[k]));
        Self::new(r.map(Dual64::from_re), p)
    }
}
