//! Number types: few operations for the generated kernels, a few more for the solvers around them.

#[cfg(feature = "wire")]
use crate::wire::*;
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
    /// The exponential function, `eˣ`.
    #[inline(always)]
    #[must_use]
    fn exp(self) -> Self {
        Self::call(Elementary::Exp, [self; 2])
    }
    /// Natural logarithm: minus infinity of zero, NaN of what is negative.
    #[inline(always)]
    #[must_use]
    fn ln(self) -> Self {
        Self::call(Elementary::Ln, [self; 2])
    }
    /// Absolute value. Its derivative is −1, 0 or 1, at zero 0.
    #[inline(always)]
    #[must_use]
    fn abs(self) -> Self {
        Self::call(Elementary::Abs, [self; 2])
    }
    /// The largest whole number that is not larger. Its derivative is zero everywhere.
    #[inline(always)]
    #[must_use]
    fn floor(self) -> Self {
        Self::call(Elementary::Floor, [self; 2])
    }
    /// `x` where this number is greater than zero, 0 where it is at most zero, and NaN where it is NaN. Where `x` is
    /// not taken it may be infinite or NaN, and its derivative, too.
    #[inline(always)]
    #[must_use]
    fn when(self, x: Self) -> Self {
        Self::call(Elementary::When, [self, x])
    }
    /// `x` where this number is at most zero, 0 where it is greater than zero, and NaN where it is NaN: what
    /// [`when`](Self::when) leaves, so that `c.when(x) + c.unless(y)` is `x` or `y`.
    #[inline(always)]
    #[must_use]
    fn unless(self, x: Self) -> Self {
        Self::call(Elementary::Unless, [self, x])
    }
}

/// An elementary function, for number types that treat most of them alike. There will be more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "wire", derive(SerBin, DeBin))]
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
    /// The exponential function.
    Exp,
    /// Natural logarithm.
    Ln,
    /// Absolute value.
    Abs,
    /// The largest whole number that is not larger.
    Floor,
    /// The second operand where the first one is greater than zero, elsewhere zero.
    When,
    /// The second operand where the first one is at most zero, elsewhere zero.
    Unless,
}

impl Elementary {
    /// All functions, in their order.
    pub const ALL: [Self; 11] = [
        Self::Sqrt,
        Self::Sin,
        Self::Cos,
        Self::Tanh,
        Self::Atan2,
        Self::Exp,
        Self::Ln,
        Self::Abs,
        Self::Floor,
        Self::When,
        Self::Unless,
    ];

    /// The derivatives by the operands, the second one of functions of two, where the function has this value. By what
    /// a condition chooses it is one or zero, which nothing is to be multiplied by: where it is not chosen it may
    /// change infinitely fast.
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
            Self::Exp => (value, None),
            Self::Ln => (T::constant(1.0) / x, None),
            Self::Abs => (x.when(T::constant(1.0)) - (-x).when(T::constant(1.0)), None),
            Self::Floor => (T::constant(0.0), None),
            Self::When | Self::Unless => (T::constant(0.0), Some(T::call(self, [x, T::constant(1.0)]))),
        }
    }
}

/// The second number where the first one is greater than zero; zero, or NaN, where it is not.
#[inline(always)]
pub(crate) fn when<T: Lanes>([condition, x]: [T; 2]) -> T {
    let zero = T::constant(0.0);
    T::select(condition.greater(zero), x, T::select(condition.at_most(zero), zero, condition))
}

/// The second number where the first one is at most zero; zero, or NaN, where it is not.
#[inline(always)]
pub(crate) fn unless<T: Lanes>([condition, x]: [T; 2]) -> T {
    let zero = T::constant(0.0);
    T::select(condition.at_most(zero), x, T::select(condition.greater(zero), zero, condition))
}

/// A scalar that can be compared, as solvers need it.
pub trait Real: Scalar + PartialOrd {
    /// Distance from one to the next larger number.
    const EPSILON: Self;
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
