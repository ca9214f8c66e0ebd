//! What a number must offer: little for the generated kernels, a little more for the solvers around them.

use crate::{fused, spline};
use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A number of a generated kernel: `f32`, `f64`, a pack of SIMD lanes, a dual number.
///
/// Kernels are straight-line, so there is no comparison here.
pub trait Scalar:
    Copy
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// The constant nearest to `value`.
    fn constant(value: f64) -> Self;
    /// `a b + c`, rounded once where the target has an instruction for it, else twice: see [`fused`](mod@crate::fused).
    #[inline(always)]
    #[must_use]
    fn fused(a: Self, b: Self, c: Self) -> Self {
        a * b + c
    }
    /// Square root.
    #[must_use]
    fn sqrt(self) -> Self;
    /// Sine.
    #[must_use]
    fn sin(self) -> Self;
    /// Cosine.
    #[must_use]
    fn cos(self) -> Self;
    /// Hyperbolic tangent.
    #[must_use]
    fn tanh(self) -> Self;
    /// The angle of the point `(x, self)`, in `(−π, π]`.
    #[must_use]
    fn atan2(self, x: Self) -> Self;
    /// Value, first and second derivative of a table's smooth curve at this time: see [`spline`](mod@crate::spline). Lanes of a
    /// pack may lie in different pieces.
    #[must_use]
    fn spline(self, knots: &[f64], pieces: &[[f64; 4]]) -> [Self; 3];
}

/// A scalar on which a solver can decide.
pub trait Real: Scalar + PartialOrd {
    /// Distance from one to the next larger number.
    const EPSILON: Self;
    /// Absolute value.
    #[must_use]
    fn abs(self) -> Self;
    /// The nearest integer.
    #[must_use]
    fn round(self) -> Self;
    /// Neither infinite nor NaN.
    fn is_finite(self) -> bool;
    /// For messages.
    fn to_f64(self) -> f64;
}

impl Scalar for f64 {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn fused(a: Self, b: Self, c: Self) -> Self {
        fused::double(a, b, c)
    }
    #[inline]
    fn sqrt(self) -> Self {
        libm::sqrt(self)
    }
    #[inline]
    fn sin(self) -> Self {
        libm::sin(self)
    }
    #[inline]
    fn cos(self) -> Self {
        libm::cos(self)
    }
    #[inline]
    fn tanh(self) -> Self {
        libm::tanh(self)
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        libm::atan2(self, x)
    }
    #[inline]
    fn spline(self, knots: &[f64], pieces: &[[f64; 4]]) -> [Self; 3] {
        spline::evaluate(knots, pieces, self)
    }
}

impl Real for f64 {
    const EPSILON: Self = Self::EPSILON;
    #[inline]
    fn abs(self) -> Self {
        libm::fabs(self)
    }
    #[inline]
    fn round(self) -> Self {
        libm::round(self)
    }
    #[inline]
    fn is_finite(self) -> bool {
        Self::is_finite(self)
    }
    #[inline]
    fn to_f64(self) -> f64 {
        self
    }
}

impl Scalar for f32 {
    #[inline(always)]
    #[expect(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is what is meant")]
    fn constant(value: f64) -> Self {
        value as Self
    }
    #[inline(always)]
    fn fused(a: Self, b: Self, c: Self) -> Self {
        fused::single(a, b, c)
    }
    #[inline]
    fn sqrt(self) -> Self {
        libm::sqrtf(self)
    }
    #[inline]
    fn sin(self) -> Self {
        libm::sinf(self)
    }
    #[inline]
    fn cos(self) -> Self {
        libm::cosf(self)
    }
    #[inline]
    fn tanh(self) -> Self {
        libm::tanhf(self)
    }
    #[inline]
    fn atan2(self, x: Self) -> Self {
        libm::atan2f(self, x)
    }
    #[inline]
    fn spline(self, knots: &[f64], pieces: &[[f64; 4]]) -> [Self; 3] {
        // Times of a long table differ by less than an f32 can tell.
        spline::evaluate(knots, pieces, f64::from(self)).map(Self::constant)
    }
}

impl Real for f32 {
    const EPSILON: Self = Self::EPSILON;
    #[inline]
    fn abs(self) -> Self {
        libm::fabsf(self)
    }
    #[inline]
    fn round(self) -> Self {
        libm::roundf(self)
    }
    #[inline]
    fn is_finite(self) -> bool {
        Self::is_finite(self)
    }
    #[inline]
    fn to_f64(self) -> f64 {
        f64::from(self)
    }
}
