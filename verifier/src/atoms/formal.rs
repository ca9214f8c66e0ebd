//! Degrees of atoms.

use super::Atoms;
use crate::field::Degree;
use gyro_model::Spline;
use std::cell::Cell;

/// Atoms over [`Degree`]: each is a new variable or a point of a curve, and adds to the chance of an accident.
#[derive(Debug, Default)]
pub struct Formal {
    /// Sum of the degrees of all arguments.
    arguments: Cell<f64>,
    /// How many there were.
    count: Cell<f64>,
    /// How many roots were taken of arguments that vary.
    roots: Cell<f64>,
}

/// A point of the unit circle is `u⁴` of a rationally parametrised `u`, and the double angle's its square.
const CIRCLE: f64 = 16.0;

impl Formal {
    /// A bound on the degree of the product of all differences of arguments: where it vanishes, two atoms of different
    /// arguments are taken for one.
    pub fn collisions(&self) -> f64 {
        self.arguments.get() * self.count.get()
    }

    /// How many square roots of varying arguments were taken.
    pub fn roots(&self) -> f64 {
        self.roots.get()
    }

    fn note(&self, x: &Degree) {
        self.arguments.set(self.arguments.get() + x.numerator + x.denominator);
        self.count.set(self.count.get() + 1.0);
    }

    fn drawn(&self, arguments: &[&Degree], degree: Degree) -> Degree {
        arguments.iter().for_each(|x| self.note(x));
        degree
    }
}

impl Atoms<Degree> for Formal {
    fn sin(&self, x: &Degree) -> Degree {
        self.drawn(&[x], Degree::quotient(CIRCLE, CIRCLE))
    }

    fn cos(&self, x: &Degree) -> Degree {
        self.drawn(&[x], Degree::quotient(CIRCLE, CIRCLE))
    }

    fn tanh(&self, x: &Degree) -> Degree {
        self.drawn(&[x], Degree::polynomial(1.0))
    }

    fn atan2(&self, y: &Degree, x: &Degree) -> Degree {
        self.drawn(&[y, x], Degree::polynomial(1.0))
    }

    /// The root of a quotient is of half its degrees; they are counted whole.
    fn sqrt(&self, x: &Degree) -> Degree {
        if x.numerator > 0.0 || x.denominator > 0.0 {
            self.roots.set(self.roots.get() + 1.0);
        }
        *x
    }

    fn spline(&self, _: &Spline, t: &Degree) -> [Degree; 3] {
        [(); 3].map(|()| self.drawn(&[t], Degree::polynomial(1.0)))
    }
}
