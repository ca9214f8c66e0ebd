//! Exact constants: a rational times the square root of a whole number.
//!
//! Every number of a model file is rational, and normalising an axis adds one square root, so products, quotients and
//! like sums of these constants stay exact. Rounding happens once, at emission. The parts of a rough direction have
//! hundreds of digits after a few products, and most of the time of a generation may go into bringing them to lowest
//! terms: hence a library of numbers whose greatest common divisors are quick.

use dashu_base::{BitTest, Gcd, PowerOfTwo, Sign, SquareRoot, UnsignedAbs};
use dashu_int::{IBig, UBig};
use dashu_ratio::RBig;
use gyro_model::Rational;
use std::fmt;
use std::rc::Rc;

/// A constant; copies share their digits, so that an expression which has one is as small as any.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub struct Constant(Rc<Exact>);

/// `coefficient · √radicand`.
#[derive(Debug, PartialEq, Eq, Hash)]
struct Exact {
    coefficient: RBig,
    /// At least one; free of the squares of small primes, so that equal constants are equal in this form too.
    radicand: UBig,
}

/// Squares of primes up to this bound are taken out of a radicand. Two equal constants whose radicands differ by the
/// square of a larger prime would merely not be recognised as equal.
const LARGEST_PRIME: u32 = 1000;

impl Constant {
    pub fn rational(coefficient: Rational) -> Self {
        let numerator = IBig::from_le_bytes(&coefficient.numer().to_signed_bytes_le());
        let denominator = UBig::from_le_bytes(&coefficient.denom().magnitude().to_bytes_le());
        Self::of(RBig::from_parts(numerator, denominator), UBig::ONE)
    }

    pub fn integer(value: i64) -> Self {
        Self::of(IBig::from(value).into(), UBig::ONE)
    }

    pub fn is_zero(&self) -> bool {
        self.0.coefficient.is_zero()
    }

    pub fn is_one(&self) -> bool {
        self.0.coefficient.is_one() && self.0.radicand.is_one()
    }

    pub fn is_negative(&self) -> bool {
        self.0.coefficient.sign() == Sign::Negative
    }

    pub fn neg(&self) -> Self {
        Self::of(-self.0.coefficient.clone(), self.0.radicand.clone())
    }

    pub fn abs(&self) -> Self {
        if self.is_negative() { self.neg() } else { self.clone() }
    }

    pub fn is_rational(&self) -> bool {
        self.0.radicand.is_one()
    }

    /// The largest whole number that is not larger than a rational.
    pub fn floor(&self) -> Self {
        Self::of(self.0.coefficient.floor().into(), UBig::ONE)
    }

    /// `None` for a sum that is not of this form.
    pub fn add(&self, other: &Self) -> Option<Self> {
        if self.is_zero() {
            return Some(other.clone());
        }
        if other.is_zero() {
            return Some(self.clone());
        }
        if self.0.radicand == other.0.radicand {
            return Some(Self::new(&self.0.coefficient + &other.0.coefficient, self.0.radicand.clone()));
        }
        // A large square may have stayed in a radicand. What the two do not have in common is square then.
        let common = (&self.0.radicand).gcd(&other.0.radicand);
        let over_common = |constant: &Self| {
            let (root, rest) = whole_root(&constant.0.radicand / &common);
            rest.is_one().then(|| &constant.0.coefficient * root)
        };
        let (a, b) = (over_common(self)?, over_common(other)?);
        Some(Self::new(a + b, common))
    }

    pub fn mul(&self, other: &Self) -> Self {
        // Most factors of formulas are one.
        if self.is_one() {
            return other.clone();
        }
        if other.is_one() {
            return self.clone();
        }
        let coefficient = &self.0.coefficient * &other.0.coefficient;
        if self.0.radicand.is_one() || other.0.radicand.is_one() {
            return Self::new(coefficient, &self.0.radicand * &other.0.radicand);
        }
        // What the rest is made of is apart, and neither has small squares.
        let common = (&self.0.radicand).gcd(&other.0.radicand);
        let rest = (&self.0.radicand / &common) * (&other.0.radicand / &common);
        let (root, rest) = whole_root(rest);
        Self::new(coefficient * common * root, rest)
    }

    /// `1 / (a √b) = √b / (a b)`; `None` for zero.
    pub fn recip(&self) -> Option<Self> {
        (!self.is_zero()).then(|| {
            let inverse = RBig::ONE / (&self.0.coefficient * &self.0.radicand);
            Self::new(inverse, self.0.radicand.clone())
        })
    }

    /// Square root of a rational that is not negative; `None` otherwise.
    pub fn sqrt(&self) -> Option<Self> {
        if self.is_negative() || !self.0.radicand.is_one() {
            return None;
        }
        let (numerator, denominator) = self.0.coefficient.clone().into_parts();
        let (_, numerator) = numerator.into_parts();
        Some(Self::root(numerator * &denominator, denominator))
    }

    /// The nearest `f64`: a root is taken to 128 bits before the one rounding.
    pub fn to_f64(&self) -> f64 {
        if self.0.radicand.is_one() {
            return self.0.coefficient.to_f64().value();
        }
        let (numerator, denominator) = (self.0.coefficient.numerator(), self.0.coefficient.denominator());
        let (square, divisor) = (numerator.sqr() * &self.0.radicand, denominator.sqr());
        let half = (divisor.bit_len().saturating_sub(square.bit_len()) / 2) + 129;
        let root = ((square << (2 * half)) / divisor).sqrt();
        let nearest = RBig::from_parts(root.into(), UBig::ONE << half).to_f64().value();
        if self.is_negative() { -nearest } else { nearest }
    }

    /// Whether it is a number of few binary digits, so that it is not rounded.
    pub fn is_double(&self) -> bool {
        let Exact { coefficient, radicand } = &*self.0;
        radicand.is_one()
            && coefficient.denominator().is_power_of_two()
            && coefficient.numerator().bit_len() <= 53
    }

    /// Whether a product with it is not rounded.
    pub fn is_power_of_two(&self) -> bool {
        self.is_double() && self.0.coefficient.numerator().unsigned_abs().is_power_of_two()
    }

    fn of(coefficient: RBig, radicand: UBig) -> Self {
        Self(Rc::new(Exact { coefficient, radicand }))
    }

    fn new(coefficient: RBig, radicand: UBig) -> Self {
        if coefficient.is_zero() { Self::integer(0) } else { Self::of(coefficient, radicand) }
    }

    /// `√n / divisor`.
    fn root(n: UBig, divisor: UBig) -> Self {
        if n.is_zero() {
            return Self::integer(0);
        }
        let (mut outside, mut n) = whole_root(n);
        for factor in 2..LARGEST_PRIME {
            let square = UBig::from(factor * factor);
            if square > n {
                break;
            }
            while (&n % &square).is_zero() {
                n /= &square;
                outside *= factor;
            }
        }
        Self::new(RBig::from_parts(outside.into(), divisor), n)
    }
}

/// The root of a perfect square and one; otherwise one and the number itself.
fn whole_root(n: UBig) -> (UBig, UBig) {
    let root = n.sqrt();
    if root.sqr() == n { (root, UBig::ONE) } else { (UBig::ONE, n) }
}

/// `1/2*sqrt(2)`, `-3/10`.
impl fmt::Display for Constant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.0.coefficient)?;
        if self.0.radicand.is_one() { Ok(()) } else { write!(f, "*sqrt({})", self.0.radicand) }
    }
}

#[cfg(test)]
mod tests;
