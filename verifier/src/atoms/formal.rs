//! Degrees of atoms.

use super::Atoms;
use super::elementary::CURVES;
use crate::field::{Degree, Field};
use crate::program::Function;
use gyro_model::Spline;

/// Atoms over [`Degree`]: each is a new variable or a point of a curve.
#[derive(Clone, Copy, Debug)]
pub struct Formal {
    /// How often a rationally parametrised point of the unit circle is doubled at most on the way to an angle's.
    pub doublings: u32,
}

impl Formal {
    /// Each doubling doubles the degree.
    fn circle(self) -> Degree {
        let degree = 2.0 * f64::from(self.doublings).exp2();
        Degree::quotient(degree, degree)
    }
}

impl Atoms<Degree> for Formal {
    /// The root of a quotient is of half its degrees; they are counted whole. Where there is none, a variable stands
    /// for it.
    fn call(&self, function: Function, [x, y]: [&Degree; 2]) -> Degree {
        match function {
            Function::Sin | Function::Cos => self.circle(),
            Function::Sqrt => Degree { numerator_log2: x.numerator_log2.max(0.0), ..*x },
            // A variable, or its reciprocal.
            Function::Exp => Degree::quotient(1.0, 1.0),
            Function::When | Function::Unless => Degree::polynomial(1.0).mul(y),
            Function::Curve { .. } => unreachable!("{CURVES}"),
            Function::Tanh | Function::Atan2 | Function::Ln | Function::Abs | Function::Floor => {
                Degree::polynomial(1.0)
            }
        }
    }

    fn spline(&self, _: &Spline, _: &Degree) -> [Degree; 4] {
        [Degree::polynomial(1.0); 4]
    }
}
