//! Number types: few operations for the generated kernels, a few more for the solvers around them.

use crate::{charts, fused, sine, spline};
use core::fmt::Debug;
use core::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Not, Sub};

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
    /// An elementary function of these operands; of one operand both are the same.
    #[must_use]
    fn call(function: Elementary, operands: [Self; 2]) -> Self;
    /// Value, first and second derivative of a table's smooth curve at this time: see [`spline`](mod@crate::spline).
    /// Lanes of a pack may lie in different pieces.
    #[must_use]
    fn spline(self, knots: &[f64], pieces: &[[f64; 4]]) -> [Self; 3];
    /// The third derivative of the same curve; at a knot that of the piece which begins there.
    #[must_use]
    fn spline_third(self, knots: &[f64], pieces: &[[f64; 4]]) -> Self;

    /// Square root.
    #[inline(always)]
    #[must_use]
    fn sqrt(self) -> Self {
        Self::call(Elementary::Sqrt, [self; 2])
    }
    /// Sine.
    #[inline(always)]
    #[must_use]
    fn sin(self) -> Self {
        Self::call(Elementary::Sin, [self; 2])
    }
    /// Cosine.
    #[inline(always)]
    #[must_use]
    fn cos(self) -> Self {
        Self::call(Elementary::Cos, [self; 2])
    }
    /// Hyperbolic tangent.
    #[inline(always)]
    #[must_use]
    fn tanh(self) -> Self {
        Self::call(Elementary::Tanh, [self; 2])
    }
    /// The angle of the point `(x, self)`, in `(−π, π]`.
    #[inline(always)]
    #[must_use]
    fn atan2(self, x: Self) -> Self {
        Self::call(Elementary::Atan2, [self, x])
    }
}

/// An elementary function, for number types that treat most of them alike. There will be more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Elementary {
    /// Square root.
    Sqrt,
    /// Sine.
    Sin,
    /// Cosine.
    Cos,
    /// Hyperbolic tangent.
    Tanh,
    /// The angle of the point (second operand, first operand).
    Atan2,
}

impl Elementary {
    /// The derivatives by the operands, the second one of functions of two, where the function has this value.
    #[inline(always)]
    pub(crate) fn slopes<T: Scalar>(self, [x, y]: [T; 2], value: T) -> (T, Option<T>) {
        match self {
            Self::Sqrt => (T::constant(0.5) / value, None),
            Self::Sin => (x.cos(), None),
            Self::Cos => (-x.sin(), None),
            Self::Tanh => (T::constant(1.0) - value * value, None),
            Self::Atan2 => {
                let square = x * x + y * y;
                (y / square, Some(-x / square))
            }
        }
    }
}

/// A scalar that can be compared, as solvers need it.
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
    /// The nearest `f64`, for messages.
    fn to_f64(self) -> f64;
}

/// A pack of lanes, on which a solver can decide lane by lane. A [`Real`] number is a pack of one lane; those of SIMD
/// registers come with the feature `lanes`.
pub trait Lanes: Scalar {
    /// The number in one lane.
    type Lane: Real;
    /// A boolean for each lane.
    type Mask: Copy
        + Debug
        + BitAnd<Output = Self::Mask>
        + BitOr<Output = Self::Mask>
        + Not<Output = Self::Mask>;
    /// For each lane the special Euler parameter of a joint: see [`charts`](mod@crate::charts).
    type Chart: Copy + Debug + PartialEq;
    /// Number of lanes, at most eight.
    const COUNT: usize;

    /// A pack of these lanes.
    fn from_lanes(lane: impl FnMut(usize) -> Self::Lane) -> Self;
    /// The number in a lane.
    fn lane(&self, index: usize) -> Self::Lane;
    /// Absolute values.
    #[must_use]
    fn absolute(self) -> Self;
    /// Where this one is greater.
    fn greater(self, other: Self) -> Self::Mask;
    /// Where this one is at most the other.
    fn at_most(self, other: Self) -> Self::Mask;
    /// Where this one is neither infinite nor NaN.
    fn finite(self) -> Self::Mask;
    /// The first where the mask is true, elsewhere the second.
    #[must_use]
    fn select(mask: Self::Mask, one: Self, other: Self) -> Self;
    /// A bit for each lane, the first one lowest.
    fn bits(mask: Self::Mask) -> u32;
    /// The mask of these bits.
    fn mask(bits: u32) -> Self::Mask {
        let lane = |index| Self::Lane::constant(f64::from(bits >> index & 1));
        Self::from_lanes(lane).greater(Self::constant(0.0))
    }
    /// The chart of the largest component of a four-vector.
    fn best_chart(vector: &[Self; 4]) -> Self::Chart;
    /// Switches to another chart where this one has become poor; returns the number of switches.
    fn follow_chart(vector: &[Self; 4], chart: &mut Self::Chart) -> u32;
    /// The unit four-vector of the special parameter.
    fn one_hot(chart: Self::Chart) -> [Self; 4];
}

/// The larger number in each lane; NaN is never larger.
#[inline]
pub(crate) fn larger<T: Lanes>(one: T, other: T) -> T {
    T::select(other.greater(one), other, one)
}

/// The largest absolute value in each lane, NaN left out; zero if there is none.
#[inline]
pub(crate) fn largest_magnitude<T: Lanes>(numbers: impl IntoIterator<Item = T>) -> T {
    numbers.into_iter().fold(T::constant(0.0), |largest, number| larger(largest, number.absolute()))
}

impl<T: Real> Lanes for T {
    type Lane = Self;
    type Mask = bool;
    type Chart = u8;
    const COUNT: usize = 1;

    #[inline]
    fn from_lanes(mut lane: impl FnMut(usize) -> Self) -> Self {
        lane(0)
    }
    #[inline]
    fn lane(&self, _: usize) -> Self {
        *self
    }
    #[inline]
    fn absolute(self) -> Self {
        self.abs()
    }
    #[inline]
    fn greater(self, other: Self) -> bool {
        self > other
    }
    #[inline]
    fn at_most(self, other: Self) -> bool {
        self <= other
    }
    #[inline]
    fn finite(self) -> bool {
        self.is_finite()
    }
    #[inline]
    fn select(mask: bool, one: Self, other: Self) -> Self {
        if mask { one } else { other }
    }
    #[inline]
    fn bits(mask: bool) -> u32 {
        u32::from(mask)
    }
    #[inline]
    fn best_chart(vector: &[Self; 4]) -> u8 {
        charts::largest(vector)
    }
    #[inline]
    fn follow_chart(vector: &[Self; 4], chart: &mut u8) -> u32 {
        charts::follow_largest(vector, chart)
    }
    #[inline]
    fn one_hot(chart: u8) -> [Self; 4] {
        core::array::from_fn(|k| Self::constant(if k == usize::from(chart) { 1.0 } else { 0.0 }))
    }
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
    #[inline(always)]
    fn call(function: Elementary, [x, y]: [Self; 2]) -> Self {
        match function {
            Elementary::Sqrt => libm::sqrt(x),
            Elementary::Sin => libm::sin(x),
            Elementary::Cos => libm::cos(x),
            Elementary::Tanh => libm::tanh(x),
            Elementary::Atan2 => libm::atan2(x, y),
        }
    }
    #[inline]
    fn spline(self, knots: &[f64], pieces: &[[f64; 4]]) -> [Self; 3] {
        spline::evaluate(knots, pieces, self)
    }
    #[inline]
    fn spline_third(self, knots: &[f64], pieces: &[[f64; 4]]) -> Self {
        spline::third(knots, pieces, self)
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
    #[inline(always)]
    fn call(function: Elementary, [x, y]: [Self; 2]) -> Self {
        match function {
            Elementary::Sqrt => libm::sqrtf(x),
            Elementary::Sin => sine::sin_of_any(x),
            Elementary::Cos => sine::cos_of_any(x),
            Elementary::Tanh => libm::tanhf(x),
            Elementary::Atan2 => libm::atan2f(x, y),
        }
    }
    #[inline]
    fn spline(self, knots: &[f64], pieces: &[[f64; 4]]) -> [Self; 3] {
        // Times of a long table differ by less than an f32 can tell.
        spline::evaluate(knots, pieces, f64::from(self)).map(Self::constant)
    }
    #[inline]
    fn spline_third(self, knots: &[f64], pieces: &[[f64; 4]]) -> Self {
        Self::constant(spline::third(knots, pieces, f64::from(self)))
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
