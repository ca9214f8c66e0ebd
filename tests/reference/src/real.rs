//! What the equations of motion ask of a number.

use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::DoubleDouble;

/// A real number of some precision: `f64` for speed, [`DoubleDouble`] for reference values.
pub trait Real:
    Copy
    + Debug
    + PartialOrd
    + From<f64>
    + Neg<Output = Self>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
{
    /// Sine and cosine of an angle in radians.
    #[must_use]
    fn sin_cos(self) -> (Self, Self);
}

impl Real for f64 {
    fn sin_cos(self) -> (f64, f64) {
        f64::sin_cos(self)
    }
}

impl Real for DoubleDouble {
    fn sin_cos(self) -> (DoubleDouble, DoubleDouble) {
        DoubleDouble::sin_cos(self)
    }
}
