//! Euler parameters.

use crate::Scalar;

/// Makes a unit vector of Euler parameters.
pub(crate) fn normalise<T: Scalar>(p: &mut [T]) {
    let square = p.iter().fold(T::constant(0.0), |sum, e| T::fused(*e, *e, sum));
    let scale = T::constant(1.0) / square.sqrt();
    p.iter_mut().for_each(|e| *e = *e * scale);
}
