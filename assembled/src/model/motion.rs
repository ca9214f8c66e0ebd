//! Where a body is and how it moves, and the vectors and points fixed in it.

use crate::model::textbook::{g_matrix, rotated_gradient, rotation};
use crate::number::{Number, number};
use nalgebra::{Matrix3, RealField, RowVector3, RowVector4, Vector3, Vector4};

/// Position and velocity of a body, and its acceleration as far as that is prescribed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Motion<T> {
    pub(crate) r: Vector3<T>,
    pub(crate) p: Vector4<T>,
    /// A(p).
    pub(crate) a: Matrix3<T>,
    pub(crate) s: Vector3<T>,
    /// w', body frame.
    pub(crate) w: Vector3<T>,
    /// s̈ of a body whose motion is prescribed; zero of all others.
    pub(crate) s_dot: Vector3<T>,
    /// ẇ' of a body whose motion is prescribed; zero of all others.
    pub(crate) w_dot: Vector3<T>,
}

/// A global vector with its first and second time derivative.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Jet<T> {
    pub(crate) value: Vector3<T>,
    pub(crate) rate: Vector3<T>,
    pub(crate) second: Vector3<T>,
}

impl<T: Number> Motion<T> {
    /// A body that has coordinates.
    #[inline]
    pub(crate) fn new(r: Vector3<T>, p: Vector4<T>, s: Vector3<T>, w: Vector3<T>) -> Self {
        Self { r, p, a: rotation(&p), s, w, s_dot: Vector3::zeros(), w_dot: Vector3::zeros() }
    }

    /// The same pose at rest.
    pub(crate) fn at_rest(self) -> Self {
        let zero = Vector3::zeros();
        Self { s: zero, w: zero, s_dot: zero, w_dot: zero, ..self }
    }

    /// ω = A w'.
    pub(crate) fn omega(&self) -> Vector3<T> {
        self.a * self.w
    }

    /// Global position of a point of the body.
    pub(crate) fn tip(&self, point: &Vector3<T>) -> Vector3<T> {
        self.r + self.a * point
    }

    /// Global velocity of a point of the body.
    pub(crate) fn tip_velocity(&self, point: &Vector3<T>) -> Vector3<T> {
        self.s + self.a * self.w.cross(point)
    }

    /// `A a'` of a vector fixed in the body: `ȧ = A w̃' a'` and `ä = A (w̃' w̃' + ẇ̃') a'`.
    pub(crate) fn direction(&self, a: &Vector3<T>) -> Jet<T> {
        let turning = self.w.cross(a);
        Jet {
            value: self.a * a,
            rate: self.a * turning,
            second: self.a * (self.w.cross(&turning) + self.w_dot.cross(a)),
        }
    }

    /// `r + A s'` of a point of the body.
    pub(crate) fn point(&self, point: &Vector3<T>) -> Jet<T> {
        let arm = self.direction(point);
        Jet { value: self.r + arm.value, rate: self.s + arm.rate, second: self.s_dot + arm.second }
    }
}

impl Motion<f64> {
    /// In the number type of the mechanism.
    pub(crate) fn rounded<T: Number>(&self) -> Motion<T> {
        let vector = |v: &Vector3<f64>| v.map(number);
        Motion {
            r: vector(&self.r),
            p: self.p.map(number),
            a: self.a.map(number),
            s: vector(&self.s),
            w: vector(&self.w),
            s_dot: vector(&self.s_dot),
            w_dot: vector(&self.w_dot),
        }
    }
}

impl<T: Number> Jet<T> {
    /// The difference of two vectors.
    pub(crate) fn minus(&self, other: &Self) -> Self {
        Self {
            value: self.value - other.value,
            rate: self.rate - other.rate,
            second: self.second - other.second,
        }
    }

    /// Value, first and second derivative of a scalar product.
    pub(crate) fn dot(&self, other: &Self) -> [T; 3] {
        let outer = self.second.dot(&other.value) + self.value.dot(&other.second);
        [
            self.value.dot(&other.value),
            self.rate.dot(&other.value) + self.value.dot(&other.rate),
            outer + number::<T>(2.0) * self.rate.dot(&other.rate),
        ]
    }
}

/// `∂(xᵀ A a')/∂p`.
pub(crate) fn along_p<T: RealField + Copy>(
    motion: &Motion<T>,
    x: &Vector3<T>,
    a: &Vector3<T>,
) -> RowVector4<T> {
    x.transpose() * rotated_gradient(&motion.p, a)
}

/// The same by rates of p, of which only what turns counts: by `w' = 2 G ṗ`.
pub(crate) fn along_turns<T: RealField + Copy>(
    motion: &Motion<T>,
    x: &Vector3<T>,
    a: &Vector3<T>,
) -> RowVector4<T> {
    along_pi(motion, x, a) * g_matrix(&motion.p) * nalgebra::convert::<f64, T>(2.0)
}

/// `∂(xᵀ A a')/∂π' = −xᵀ A ã'`, which is `(a' × Aᵀx)ᵀ`.
pub(crate) fn along_pi<T: RealField + Copy>(
    motion: &Motion<T>,
    x: &Vector3<T>,
    a: &Vector3<T>,
) -> RowVector3<T> {
    a.cross(&motion.a.tr_mul(x)).transpose()
}
