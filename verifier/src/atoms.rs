//! Functions that are not rational: the same value for the same argument on both sides of an identity.

mod drawn;
mod elementary;
mod formal;

pub use drawn::Drawn;
pub(crate) use drawn::HALVINGS;
pub use elementary::Elementary;
pub(crate) use elementary::{quotient, range_of_call, rate_of_call, sum};
pub use formal::Formal;

use crate::field::Field;
use crate::program::Function;
use gyro_model::Spline;

/// The functions that emitted code and the textbook may call.
///
/// [`Drawn`] values are random, one for each argument: an identity that holds for all of them holds for the functions.
/// [`Elementary`] ones are the functions themselves, in floating point. [`Formal`] ones have degrees.
pub trait Atoms<F: Field> {
    /// An elementary function; of one operand both are the same.
    fn call(&self, function: Function, operands: [&F; 2]) -> F;
    /// Value and three derivatives of a table's curve.
    fn spline(&self, table: &Spline, t: &F) -> [F; 4];
    /// Sine.
    fn sin(&self, x: &F) -> F {
        self.call(Function::Sin, [x, x])
    }
    /// Cosine.
    fn cos(&self, x: &F) -> F {
        self.call(Function::Cos, [x, x])
    }
    /// Hyperbolic tangent.
    fn tanh(&self, x: &F) -> F {
        self.call(Function::Tanh, [x, x])
    }
    /// The angle of the point `(x, y)`.
    fn atan2(&self, y: &F, x: &F) -> F {
        self.call(Function::Atan2, [y, x])
    }
    /// The exponential function.
    fn exp(&self, x: &F) -> F {
        self.call(Function::Exp, [x, x])
    }
    /// Natural logarithm.
    fn ln(&self, x: &F) -> F {
        self.call(Function::Ln, [x, x])
    }
    /// Absolute value.
    fn abs(&self, x: &F) -> F {
        self.call(Function::Abs, [x, x])
    }
    /// The largest whole number that is not larger.
    fn floor(&self, x: &F) -> F {
        self.call(Function::Floor, [x, x])
    }
    /// `x` where the condition is greater than zero, zero where it is not.
    fn when(&self, condition: &F, x: &F) -> F {
        self.call(Function::When, [condition, x])
    }
    /// `x` where the condition is at most zero, zero where it is greater.
    fn unless(&self, condition: &F, x: &F) -> F {
        self.call(Function::Unless, [condition, x])
    }
    /// Square root.
    fn sqrt(&self, x: &F) -> F {
        self.call(Function::Sqrt, [x, x])
    }
}
