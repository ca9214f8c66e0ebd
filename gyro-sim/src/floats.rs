//! `f64` and `f32` as number types, and as packs of one lane.

use crate::scalar::{Elementary, Lanes, Real, Scalar};
use crate::{charts, fused, scalar, sine, spline};

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
            Elementary::Exp => libm::exp(x),
            Elementary::Ln => libm::log(x),
            Elementary::Abs => libm::fabs(x),
            Elementary::Floor => libm::floor(x),
            Elementary::When => scalar::when([x, y]),
            Elementary::Unless => scalar::unless([x, y]),
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
            Elementary::Exp => libm::expf(x),
            Elementary::Ln => libm::logf(x),
            Elementary::Abs => libm::fabsf(x),
            Elementary::Floor => libm::floorf(x),
            Elementary::When => scalar::when([x, y]),
            Elementary::Unless => scalar::unless([x, y]),
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
