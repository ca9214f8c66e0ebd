//! Functions that are not rational: the same value for the same argument on both sides of an identity.

mod drawn;
mod elementary;
mod formal;

pub use drawn::Drawn;
pub(crate) use drawn::HALVINGS;
pub use elementary::Elementary;
pub use formal::Formal;

use crate::field::Field;
use gyro_model::Spline;

/// The functions that emitted code and the textbook may call.
///
/// [`Drawn`] values are random, one for each argument: an identity that holds for all of them holds for the functions.
/// [`Elementary`] ones are the functions themselves, in floating point. [`Formal`] ones have degrees.
pub trait Atoms<F: Field> {
    /// Sine.
    fn sin(&self, x: &F) -> F;
    /// Cosine.
    fn cos(&self, x: &F) -> F;
    /// Hyperbolic tangent.
    fn tanh(&self, x: &F) -> F;
    /// The angle of the point `(x, y)`.
    fn atan2(&self, y: &F, x: &F) -> F;
    /// Square root.
    fn sqrt(&self, x: &F) -> F;
    /// Value, first and second derivative of a table's curve.
    fn spline(&self, table: &Spline, t: &F) -> [F; 3];
}
