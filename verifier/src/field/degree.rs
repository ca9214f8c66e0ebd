//! Degrees of rational functions.

use super::Field;
use gyro_model::Rational;
use num_traits::Zero;

/// Bounds on the total degrees of a numerator and a denominator, as if nothing cancelled. Beyond 2^1023 infinite.
///
/// It is a number like others: to run a program over it gives bounds for its results.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Degree {
    /// Whether the number is identically zero.
    pub is_zero: bool,
    /// Degree of the numerator.
    pub numerator: f64,
    /// Degree of the denominator.
    pub denominator: f64,
}

impl Degree {
    /// A polynomial of this degree.
    pub fn polynomial(degree: f64) -> Self {
        Self { is_zero: false, numerator: degree, denominator: 0.0 }
    }

    /// A quotient of polynomials of these degrees.
    pub fn quotient(numerator: f64, denominator: f64) -> Self {
        Self { is_zero: false, numerator, denominator }
    }

    const ZERO: Self = Self { is_zero: true, numerator: 0.0, denominator: 0.0 };
}

impl Field for Degree {
    type Context = ();

    fn from_rational((): (), value: &Rational) -> Self {
        if value.is_zero() { Self::ZERO } else { Self::polynomial(0.0) }
    }

    fn sqrt_rational((): (), value: &Rational) -> Self {
        Self::from_rational((), value)
    }

    fn add(&self, other: &Self) -> Self {
        match (self.is_zero, other.is_zero) {
            (true, _) => *other,
            (_, true) => *self,
            _ => Self::quotient(
                (self.numerator + other.denominator).max(other.numerator + self.denominator),
                self.denominator + other.denominator,
            ),
        }
    }

    fn sub(&self, other: &Self) -> Self {
        self.add(other)
    }

    fn mul(&self, other: &Self) -> Self {
        if self.is_zero || other.is_zero {
            return Self::ZERO;
        }
        Self::quotient(self.numerator + other.numerator, self.denominator + other.denominator)
    }

    fn neg(&self) -> Self {
        *self
    }

    fn inv(&self) -> Option<Self> {
        (!self.is_zero).then(|| Self::quotient(self.denominator, self.numerator))
    }

    fn is_zero(&self) -> bool {
        self.is_zero
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `(x² + 1) / x − x` has degrees 2 over 2 before anything cancels.
    #[test]
    fn degrees_are_those_of_unreduced_fractions() {
        let x = Degree::polynomial(1.0);
        let one = Degree::integer((), 1);
        let quotient = x.mul(&x).add(&one).div(&x).expect("not zero");
        assert_eq!(quotient, Degree::quotient(2.0, 1.0));
        assert_eq!(quotient.sub(&x), Degree::quotient(2.0, 1.0));
        assert_eq!(quotient.add(&quotient), Degree::quotient(3.0, 2.0));
        assert_eq!(x.mul(&Degree::integer((), 0)).inv(), None);
    }
}
