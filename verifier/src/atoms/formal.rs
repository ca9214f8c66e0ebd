//! Degrees of atoms.

use super::Atoms;
use crate::field::Degree;
use gyro_model::Spline;

/// Atoms over [`Degree`]: each is a new variable or a point of a curve.
#[derive(Clone, Copy, Debug)]
pub struct Formal;

/// A point of the unit circle is `u¹⁶` of a rationally parametrised `u`; multiples that are met before it count up to
/// 32.
const CIRCLE: f64 = 1024.0;

impl Atoms<Degree> for Formal {
    fn sin(&self, _: &Degree) -> Degree {
        Degree::quotient(CIRCLE, CIRCLE)
    }

    fn cos(&self, _: &Degree) -> Degree {
        Degree::quotient(CIRCLE, CIRCLE)
    }

    fn tanh(&self, _: &Degree) -> Degree {
        Degree::polynomial(1.0)
    }

    fn atan2(&self, _: &Degree, _: &Degree) -> Degree {
        Degree::polynomial(1.0)
    }

    /// The root of a quotient is of half its degrees; they are counted whole. Where there is none, a variable stands
    /// for it.
    fn sqrt(&self, x: &Degree) -> Degree {
        Degree { numerator_log2: x.numerator_log2.max(0.0), ..*x }
    }

    fn spline(&self, _: &Spline, _: &Degree) -> [Degree; 3] {
        [Degree::polynomial(1.0); 3]
    }
}
