//! The number type of assembled mechanisms.

use gyro_program::elementary::Function;
use gyro_sim::{Real, Scalar};
use nalgebra::RealField;

/// A number on which both the solvers of `gyro-sim` and the matrices of `nalgebra` can work: `f32` and `f64`.
pub trait Number: Real + RealField {}
impl<T: Real + RealField> Number for T {}

/// The constant nearest to `value`.
pub(crate) fn number<T: Number>(value: f64) -> T {
    <T as Scalar>::constant(value)
}

/// Absolute value; both traits have one, as they have the functions below.
pub(crate) fn abs<T: Number>(value: T) -> T {
    <T as Scalar>::abs(value)
}

/// Square root.
pub(crate) fn sqrt<T: Number>(value: T) -> T {
    <T as Scalar>::sqrt(value)
}

/// Natural logarithm.
pub(crate) fn ln<T: Number>(value: T) -> T {
    <T as Scalar>::ln(value)
}

/// Hyperbolic tangent.
pub(crate) fn tanh<T: Number>(value: T) -> T {
    <T as Scalar>::tanh(value)
}

/// Sine and cosine.
pub(crate) fn sin_cos<T: Number>(angle: T) -> (T, T) {
    (<T as Scalar>::sin(angle), <T as Scalar>::cos(angle))
}

/// The angle of the point `(x, y)`.
pub(crate) fn atan2<T: Number>(y: T, x: T) -> T {
    <T as Scalar>::atan2(y, x)
}

/// The value of an elementary function.
pub(crate) fn call<T: Number>(function: Function, [a, b]: [T; 2]) -> T {
    match function {
        Function::Sqrt => Scalar::sqrt(a),
        Function::Sin => Scalar::sin(a),
        Function::Cos => Scalar::cos(a),
        Function::Tanh => Scalar::tanh(a),
        Function::Atan2 => Scalar::atan2(a, b),
        Function::Exp => Scalar::exp(a),
        Function::Ln => Scalar::ln(a),
        Function::Abs => Scalar::abs(a),
        Function::Floor => Scalar::floor(a),
        Function::When => if_positive(a, b, T::zero()),
        Function::Unless => if_positive(a, T::zero(), b),
        Function::Curve { .. } => unreachable!("curves are with formulas"),
    }
}

/// The first where this is greater than zero, else the second; neither of what is not a number.
pub(crate) fn if_positive<T: Number>(margin: T, a: T, b: T) -> T {
    if margin > T::zero() {
        a
    } else if margin <= T::zero() {
        b
    } else {
        margin
    }
}

/// A pivot below this many roundings counts as zero, in matrices whose entries are of order one.
const SINGULAR_EPSILONS: f64 = 16.0;

/// The smallest of the pivots; an error if it counts as zero or is not a number.
pub(crate) fn resolvable<T: Number>(pivots: impl Iterator<Item = T>) -> Result<T, T> {
    let smaller = |least: T, pivot: T| if least <= pivot { least } else { pivot };
    let pivot = pivots.map(abs).fold(T::one(), smaller);
    if pivot > T::EPSILON * number(SINGULAR_EPSILONS) { Ok(pivot) } else { Err(pivot) }
}
