//! Exact constants: a rational times the square root of a whole number.
//!
//! Every number of a model page is rational, and normalising an axis adds one square root, so products, quotients and like
//! sums of these constants stay exact. Rounding happens once, at emission.

use gyro_model::{Rational, to_f64};
use num_bigint::{BigInt, BigUint, Sign};
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::fmt;
use std::hash::{Hash, Hasher};

/// `coefficient · √radicand`.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Constant {
    coefficient: Rational,
    /// At least one; free of the squares of small primes, so that equal constants are equal in this form too.
    radicand: BigUint,
}

/// Rationals are in lowest terms, so that their parts tell them apart: to expand them into continued fractions, as [`Rational`]
/// does for the sake of others, takes long.
impl Hash for Constant {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.coefficient.numer().hash(state);
        self.coefficient.denom().hash(state);
        self.radicand.hash(state);
    }
}

/// Squares of primes up to this bound are taken out of a radicand. Two equal constants whose radicands differ by the square
/// of a larger prime would merely not be recognised as equal.
const LARGEST_PRIME: u32 = 1000;

impl Constant {
    pub fn rational(coefficient: Rational) -> Self {
        Self { coefficient, radicand: BigUint::one() }
    }

    pub fn integer(value: i64) -> Self {
        Self::rational(Rational::from_integer(value.into()))
    }

    pub fn is_zero(&self) -> bool {
        self.coefficient.is_zero()
    }

    pub fn is_one(&self) -> bool {
        self.coefficient.is_one() && self.radicand.is_one()
    }

    pub fn is_negative(&self) -> bool {
        self.coefficient.is_negative()
    }

    pub fn neg(&self) -> Self {
        Self { coefficient: -self.coefficient.clone(), radicand: self.radicand.clone() }
    }

    pub fn abs(&self) -> Self {
        if self.is_negative() { self.neg() } else { self.clone() }
    }

    /// `None` for a sum that is not of this form.
    pub fn add(&self, other: &Self) -> Option<Self> {
        if self.is_zero() {
            return Some(other.clone());
        }
        if other.is_zero() {
            return Some(self.clone());
        }
        (self.radicand == other.radicand)
            .then(|| Self::new(&self.coefficient + &other.coefficient, self.radicand.clone()))
    }

    pub fn mul(&self, other: &Self) -> Self {
        // Most factors of formulas are one.
        if self.is_one() {
            return other.clone();
        }
        if other.is_one() {
            return self.clone();
        }
        let coefficient = &self.coefficient * &other.coefficient;
        if self.radicand.is_one() || other.radicand.is_one() {
            return Self::new(coefficient, &self.radicand * &other.radicand);
        }
        Self::new(coefficient, BigUint::one()).mul_root(&self.radicand * &other.radicand)
    }

    /// `1 / (a √b) = √b / (a b)`; `None` for zero.
    pub fn recip(&self) -> Option<Self> {
        let square = Rational::from_integer(self.radicand.clone().into());
        (!self.is_zero()).then(|| Self::new((&self.coefficient * square).recip(), self.radicand.clone()))
    }

    /// Square root of a rational that is not negative; `None` otherwise.
    pub fn sqrt(&self) -> Option<Self> {
        if self.is_negative() || !self.radicand.is_one() {
            return None;
        }
        let (numerator, denominator) = (self.coefficient.numer(), self.coefficient.denom());
        let scale = Self::rational(Rational::new(BigInt::one(), denominator.clone()));
        Some(scale.mul_root((numerator * denominator).magnitude().clone()))
    }

    /// The nearest `f64`: the root is taken to 128 bits beyond the binary point before the one rounding.
    pub fn to_f64(&self) -> f64 {
        if self.radicand.is_one() {
            return to_f64(&self.coefficient);
        }
        let (numerator, denominator) = (self.coefficient.numer(), self.coefficient.denom());
        let shift = 128 + denominator.bits();
        let square = (numerator.magnitude().pow(2) * &self.radicand) << (2 * shift);
        let root = BigInt::from_biguint(numerator.sign(), square.sqrt());
        Rational::new(root, denominator << shift).to_f64().expect("a rational always converts")
    }

    fn new(coefficient: Rational, radicand: BigUint) -> Self {
        if coefficient.is_zero() { Self::integer(0) } else { Self { coefficient, radicand } }
    }

    /// `self · √n` for a rational `self`.
    fn mul_root(&self, mut n: BigUint) -> Self {
        if n.is_zero() {
            return Self::integer(0);
        }
        let mut outside = BigUint::one();
        let root = n.sqrt();
        if &root * &root == n {
            (outside, n) = (root, BigUint::one());
        }
        for factor in 2..LARGEST_PRIME {
            let square = BigUint::from(factor * factor);
            if square > n {
                break;
            }
            while (&n % &square).is_zero() {
                n /= &square;
                outside *= factor;
            }
        }
        let outside = Rational::from_integer(BigInt::from_biguint(Sign::Plus, outside));
        Self::new(&self.coefficient * outside, n)
    }
}

/// `1/2*sqrt(2)`, `-3/10`.
impl fmt::Display for Constant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.coefficient)?;
        if self.radicand.is_one() { Ok(()) } else { write!(f, "*sqrt({})", self.radicand) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyro_model::parse_decimal;

    fn root(text: &str) -> Constant {
        Constant::rational(parse_decimal(text).expect("a decimal")).sqrt().expect("not negative")
    }

    #[test]
    fn roots_multiply_back() {
        for text in ["2", "0.5", "1.05", "3.0000000009", "1e-9", "9", "1234567"] {
            let square = root(text).mul(&root(text));
            assert_eq!(square, Constant::rational(parse_decimal(text).expect("a decimal")), "{text}");
        }
    }

    #[test]
    fn equal_constants_have_one_form() {
        assert_eq!(root("8"), Constant::integer(2).mul(&root("2")));
        assert_eq!(root("0.5").recip(), Some(root("2")));
        assert_eq!(root("2").add(&root("8")), Some(Constant::integer(3).mul(&root("2"))));
        assert_eq!(root("2").add(&root("3")), None);
    }

    #[test]
    fn roots_round_to_the_nearest_double() {
        for text in ["2", "3", "0.1", "1e-30", "7e20", "123.456"] {
            let expected = text.parse::<f64>().expect("a decimal").sqrt();
            assert!((root(text).to_f64() - expected).abs() <= f64::EPSILON * expected, "{text}");
        }
        assert_eq!(root("2").to_f64(), std::f64::consts::SQRT_2);
    }
}
