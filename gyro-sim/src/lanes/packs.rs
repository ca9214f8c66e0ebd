//! The packs of `wide` as scalars.

use super::{chart, sine};
use crate::fused::IS_FUSED;
use crate::{Elementary, Lanes, Scalar, scalar};
use wide::{f32x8, f64x2, f64x4, f64x8};

/// A function that is left to libm, lane after lane.
fn each<T: Lanes, const N: usize>(packs: [T; N], function: impl Fn([T::Lane; N]) -> T::Lane) -> T {
    T::from_lanes(|lane| function(packs.map(|pack| pack.lane(lane))))
}

macro_rules! pack {
    ($pack:ty, $lane:ty, $count:literal, $sin:expr, $cos:expr) => {
        impl Scalar for $pack {
            #[inline(always)]
            fn constant(value: f64) -> Self {
                Self::splat(Scalar::constant(value))
            }
            #[inline(always)]
            fn fused(a: Self, b: Self, c: Self) -> Self {
                if IS_FUSED { a.mul_add(b, c) } else { a * b + c }
            }
            #[inline(always)]
            fn call(function: Elementary, operands: [Self; 2]) -> Self {
                match function {
                    Elementary::Sqrt => Self::sqrt(operands[0]),
                    Elementary::Sin => $sin(operands[0]),
                    Elementary::Cos => $cos(operands[0]),
                    Elementary::Abs => Self::abs(operands[0]),
                    Elementary::When => scalar::when(operands),
                    Elementary::Unless => scalar::unless(operands),
                    _ => each(operands, |operands| Scalar::call(function, operands)),
                }
            }
            fn spline(self, knots: &[f64], pieces: &[[f64; 4]]) -> [Self; 3] {
                let lanes = self.to_array().map(|t| Scalar::spline(t, knots, pieces));
                [0, 1, 2].map(|order| Self::from_lanes(|lane| lanes[lane][order]))
            }
            fn spline_third(self, knots: &[f64], pieces: &[[f64; 4]]) -> Self {
                each([self], |[t]| Scalar::spline_third(t, knots, pieces))
            }
        }

        impl Lanes for $pack {
            type Lane = $lane;
            type Mask = Self;
            type Chart = [Self; 4];
            const COUNT: usize = $count;

            #[inline]
            fn from_lanes(lane: impl FnMut(usize) -> $lane) -> Self {
                Self::new(core::array::from_fn(lane))
            }
            #[inline]
            fn lane(&self, index: usize) -> $lane {
                self.as_array()[index]
            }
            #[inline]
            fn absolute(self) -> Self {
                Self::abs(self)
            }
            #[inline]
            fn greater(self, other: Self) -> Self {
                self.simd_gt(other)
            }
            #[inline]
            fn at_most(self, other: Self) -> Self {
                self.simd_le(other)
            }
            #[inline]
            fn finite(self) -> Self {
                Self::is_finite(self)
            }
            #[inline]
            fn select(mask: Self, one: Self, other: Self) -> Self {
                mask.select(one, other)
            }
            #[inline]
            fn bits(mask: Self) -> u32 {
                mask.to_bitmask()
            }
            fn best_chart(vector: &[Self; 4]) -> [Self; 4] {
                chart::largest(vector).1
            }
            fn follow_chart(vector: &[Self; 4], chart: &mut [Self; 4]) -> u32 {
                chart::follow(vector, chart)
            }
            #[inline]
            fn one_hot(chart: [Self; 4]) -> [Self; 4] {
                chart
            }
        }
    };
}

pack!(f64x2, f64, 2, sine::sin, sine::cos);
pack!(f64x4, f64, 4, sine::sin, sine::cos);
pack!(f64x8, f64, 8, sine::sin, sine::cos);
pack!(f32x8, f32, 8, sine::sin_of_singles, sine::cos_of_singles);
