//! Vectors of exact numbers.

use crate::{Model, Number, Rational};

/// Numbers of the model file with the model's parameters as they are.
pub(crate) fn exact<const N: usize>(model: &Model, numbers: &[Number; N]) -> [Rational; N] {
    std::array::from_fn(|k| model.exact(&numbers[k]))
}

/// Vector product.
pub(crate) fn cross(a: &[Rational; 3], b: &[Rational; 3]) -> [Rational; 3] {
    [&a[1] * &b[2] - &a[2] * &b[1], &a[2] * &b[0] - &a[0] * &b[2], &a[0] * &b[1] - &a[1] * &b[0]]
}
