//! `f64` and `f32`: what emitted code computes, operation by operation.

use super::{Constant, Field};
use gyro_model::{Rational, to_f64};

/// Operations of the number type itself.
macro_rules! operations {
    () => {
        fn add(&self, other: &Self) -> Self {
            self + other
        }
        fn sub(&self, other: &Self) -> Self {
            self - other
        }
        fn mul(&self, other: &Self) -> Self {
            self * other
        }
        fn neg(&self) -> Self {
            -self
        }
        fn inv(&self) -> Option<Self> {
            Some(1.0 / self)
        }
        fn div(&self, other: &Self) -> Option<Self> {
            Some(self / other)
        }
        fn is_zero(&self) -> bool {
            *self == 0.0
        }
    };
}

impl Field for f64 {
    type Context = ();

    fn from_rational((): (), value: &Rational) -> Self {
        to_f64(value)
    }
    fn sqrt_rational((): (), value: &Rational) -> Self {
        libm::sqrt(to_f64(value))
    }
    fn constant((): (), constant: &Constant) -> Self {
        constant.literal
    }
    operations! {}
}

impl Field for f32 {
    type Context = ();

    fn from_rational((): (), value: &Rational) -> Self {
        narrow(to_f64(value))
    }
    fn sqrt_rational((): (), value: &Rational) -> Self {
        narrow(libm::sqrt(to_f64(value)))
    }
    fn constant((): (), constant: &Constant) -> Self {
        narrow(constant.literal)
    }
    operations! {}
}

#[expect(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is what is meant")]
fn narrow(value: f64) -> f32 {
    value as f32
}
