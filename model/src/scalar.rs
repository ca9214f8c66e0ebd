//! Numbers of any kind: floating point, or dual numbers that carry a derivative along.

use num_dual::DualNum;

/// A number that the kinematics is written in.
pub(crate) trait Scalar: DualNum<Primitive = f64> + Copy {}

impl<T: DualNum<Primitive = f64> + Copy> Scalar for T {}

/// Quaternion product: first the right rotation, then the left one.
pub(crate) fn product<D: Scalar>([a, b, c, d]: [D; 4], [w, x, y, z]: [D; 4]) -> [D; 4] {
    [
        a * w - b * x - c * y - d * z,
        a * x + b * w + c * z - d * y,
        a * y - b * z + c * w + d * x,
        a * z + b * y - c * x + d * w,
    ]
}
