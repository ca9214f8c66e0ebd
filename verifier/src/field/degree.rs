//! Degrees of rational functions.

use super::Field;
use gyro_model::Rational;
use num_traits::Zero;

/// Bounds on the total degrees of a numerator and a denominator, as if nothing cancelled. A factorisation doubles them
/// with every pivot, so they are kept as logarithms.
///
/// It is a number like others: to run a program over it gives bounds for its results.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Degree {
    /// Whether the number is identically zero.
    pub is_zero: bool,
    /// Logarithm to base two of the numerator's degree: minus infinity of a constant.
    pub numerator_log2: f64,
    /// The same of the denominator.
    pub denominator_log2: f64,
}

impl Degree {
    /// A polynomial of this degree.
    pub fn polynomial(degree: f64) -> Self {
        Self::quotient(degree, 0.0)
    }

    /// A quotient of polynomials of these degrees.
    pub fn quotient(numerator: f64, denominator: f64) -> Self {
        Self { is_zero: false, numerator_log2: numerator.log2(), denominator_log2: denominator.log2() }
    }

    /// Logarithm of the degree of numerator times denominator.
    pub fn whole_log2(&self) -> f64 {
        sum_log2(self.numerator_log2, self.denominator_log2)
    }

    const ZERO: Self =
        Self { is_zero: true, numerator_log2: f64::NEG_INFINITY, denominator_log2: f64::NEG_INFINITY };
}

/// Logarithm to base two of the sum of two numbers given by theirs.
pub fn sum_log2(a: f64, b: f64) -> f64 {
    let (small, large) = (a.min(b), a.max(b));
    if small == f64::NEG_INFINITY {
        large
    } else {
        large + (small - large).exp2().ln_1p() / std::f64::consts::LN_2
    }
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
            _ => Self {
                is_zero: false,
                numerator_log2: sum_log2(self.numerator_log2, other.denominator_log2)
                    .max(sum_log2(other.numerator_log2, self.denominator_log2)),
                denominator_log2: sum_log2(self.denominator_log2, other.denominator_log2),
            },
        }
    }

    fn sub(&self, other: &Self) -> Self {
        self.add(other)
    }

    fn mul(&self, other: &Self) -> Self {
        if self.is_zero || other.is_zero {
            return Self::ZERO;
        }
        Self {
            is_zero: false,
            numerator_log2: sum_log2(self.numerator_log2, other.numerator_log2),
            denominator_log2: sum_log2(self.denominator_log2, other.denominator_log2),
        }
    }

    fn neg(&self) -> Self {
        *self
    }

    fn inv(&self) -> Option<Self> {
        let turned = || Self {
            is_zero: false,
            numerator_log2: self.denominator_log2,
            denominator_log2: self.numerator_log2,
        };
        (!self.is_zero).then(turned)
    }

    fn is_zero(&self) -> bool {
        self.is_zero
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_is(degree: Degree, numerator: f64, denominator: f64) {
        let found = [degree.numerator_log2.exp2(), degree.denominator_log2.exp2()];
        let near = |(found, expected): (&f64, &f64)| (found - expected).abs() < 1e-12;
        assert!(found.iter().zip(&[numerator, denominator]).all(near), "{found:?}");
    }

    /// `(x² + 1) / x − x` has degrees 2 over 1 before anything cancels.
    #[test]
    fn degrees_are_those_of_unreduced_fractions() {
        let x = Degree::polynomial(1.0);
        let one = Degree::integer((), 1);
        let quotient = x.mul(&x).add(&one).div(&x).expect("not zero");
        assert_is(quotient, 2.0, 1.0);
        assert_is(quotient.sub(&x), 2.0, 1.0);
        assert_is(quotient.add(&quotient), 3.0, 2.0);
        assert_eq!(x.mul(&Degree::integer((), 0)).inv(), None);
    }

    /// Squared two thousand times: a degree that no `f64` holds.
    #[test]
    fn degrees_may_be_huge() {
        let x = (0..2000).fold(Degree::polynomial(1.0), |x, _| x.mul(&x));
        assert!((x.numerator_log2 - 2000.0).abs() < 1e-9, "{x:?}");
    }
}
