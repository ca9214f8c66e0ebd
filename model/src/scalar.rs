//! Numbers of any kind: floating point, or dual numbers that carry a derivative along.

use num_dual::{Dual2_64, Dual64, DualNum};

/// A number that the kinematics is written in.
pub(crate) trait Scalar: DualNum<Primitive = f64> + Copy {
    /// The derivative that it carries; of a plain number zero.
    fn rate(&self) -> f64;
    /// Zero with this derivative.
    fn growing(rate: f64) -> Self;
}

impl Scalar for f64 {
    fn rate(&self) -> f64 {
        0.0
    }

    fn growing(_: f64) -> Self {
        0.0
    }
}

impl Scalar for Dual2_64 {
    fn rate(&self) -> f64 {
        self.v1
    }

    fn growing(rate: f64) -> Self {
        Self::new(0.0, rate, 0.0)
    }
}

impl Scalar for Dual64 {
    fn rate(&self) -> f64 {
        self.eps
    }

    fn growing(rate: f64) -> Self {
        Self::new(0.0, rate)
    }
}

/// Quaternion product: first the right rotation, then the left one.
pub(crate) fn product<D: Scalar>([a, b, c, d]: [D; 4], [w, x, y, z]: [D; 4]) -> [D; 4] {
    [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]
}
