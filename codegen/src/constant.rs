//! Exact constants: a rational times the square root of a whole number.
//!
//! Every number of a model page is rational, and normalising an axis adds one square root, so products, quotients and like
//! sums of these constants stay exact. Rounding happens once, at emission.

use gyro_model::{Rational, to_f64};
use num_bigint::{BigInt, BigUint, Sign};
use num_integer::Integer;
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::borrow::Cow;
use std::fmt;
use std::hash::{Hash, Hasher};

/// `coefficient · √radicand`.
#[derive(Clone, Debug, Eq)]
pub struct Constant {
    coefficient: Rational,
    /// At least one; free of the squares of small primes, so that equal constants are equal in this form too.
    radicand: BigUint,
}

/// Rationals are in lowest terms, so that their parts tell them apart: to expand them into continued fractions, as [`Rational`]
/// does for the sake of others, takes long.
impl PartialEq for Constant {
    fn eq(&self, other: &Self) -> bool {
        let (own, others) = (&self.coefficient, &other.coefficient);
        own.numer() == others.numer() && own.denom() == others.denom() && self.radicand == other.radicand
    }
}

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
            .then(|| Self::new(sum(&self.coefficient, &other.coefficient), self.radicand.clone()))
    }

    pub fn mul(&self, other: &Self) -> Self {
        // Most factors of formulas are one.
        if self.is_one() {
            return other.clone();
        }
        if other.is_one() {
            return self.clone();
        }
        let coefficient = product(&self.coefficient, &other.coefficient);
        if self.radicand.is_one() || other.radicand.is_one() {
            return Self::new(coefficient, &self.radicand * &other.radicand);
        }
        // √(g a) √(g b) = g √(a b): as radicands are free of small squares, g is all that there is to take out.
        let shared = common_divisor(&self.radicand, &other.radicand);
        let rest = (&self.radicand / &shared) * (&other.radicand / &shared);
        let (root, rest) = without_square(rest);
        let outside = Rational::from_integer((shared * root).into());
        Self::new(product(&coefficient, &outside), rest)
    }

    /// `1 / (a √b) = √b / (a b)`; `None` for zero.
    pub fn recip(&self) -> Option<Self> {
        let square = Rational::from_integer(self.radicand.clone().into());
        (!self.is_zero())
            .then(|| Self::new(product(&self.coefficient, &square).recip(), self.radicand.clone()))
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
    fn mul_root(&self, n: BigUint) -> Self {
        if n.is_zero() {
            return Self::integer(0);
        }
        let (mut outside, mut n) = without_square(n);
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
        Self::new(product(&self.coefficient, &outside), n)
    }
}

/// `(√n, 1)` if n is a square, else `(1, n)`.
fn without_square(n: BigUint) -> (BigUint, BigUint) {
    let root = n.sqrt();
    if &root * &root == n { (root, BigUint::one()) } else { (BigUint::one(), n) }
}

/// A product in lowest terms. Its factors are in lowest terms already, so there is nothing to look for but what they have in common
/// crosswise: [`Rational`]'s own product looks three times, and half of all derivation was spent on it.
fn product(a: &Rational, b: &Rational) -> Rational {
    let crosswise = [common(a.numer(), b.denom()), common(b.numer(), a.denom())];
    let without =
        |x: &BigInt, divisor: &Option<BigInt>| divisor.as_ref().map_or_else(|| x.clone(), |d| x / d);
    let numerator = without(a.numer(), &crosswise[0]) * without(b.numer(), &crosswise[1]);
    let denominator = without(a.denom(), &crosswise[1]) * without(b.denom(), &crosswise[0]);
    if numerator.is_zero() { Rational::zero() } else { Rational::new_raw(numerator, denominator) }
}

/// A sum in lowest terms, after Knuth, "The Art of Computer Programming" 2, 4.5.1: with g what the denominators have in common, nothing
/// but a divisor of g can cancel.
fn sum(a: &Rational, b: &Rational) -> Rational {
    let Some(shared) = common(a.denom(), b.denom()) else {
        let numerator = a.numer() * b.denom() + b.numer() * a.denom();
        return if numerator.is_zero() {
            Rational::zero()
        } else {
            Rational::new_raw(numerator, a.denom() * b.denom())
        };
    };
    let (rest_a, rest_b) = (a.denom() / &shared, b.denom() / &shared);
    let numerator = a.numer() * &rest_b + b.numer() * &rest_a;
    match common(&numerator, &shared) {
        _ if numerator.is_zero() => Rational::zero(),
        Some(cancelled) => Rational::new_raw(numerator / &cancelled, rest_a * (b.denom() / cancelled)),
        None => Rational::new_raw(numerator, rest_a * b.denom()),
    }
}

/// The greatest common divisor; `None` for one.
fn common(a: &BigInt, b: &BigInt) -> Option<BigInt> {
    let divisor = common_divisor(a.magnitude(), b.magnitude());
    (!divisor.is_one()).then(|| divisor.into())
}

/// By Euclid's algorithm as long as the numbers are large, for which `BigUint` shifts bit by bit.
fn common_divisor(a: &BigUint, b: &BigUint) -> BigUint {
    let (mut a, mut b) = (Cow::Borrowed(a), Cow::Borrowed(b));
    loop {
        match (a.to_u128(), b.to_u128()) {
            (Some(a), Some(b)) => return a.gcd(&b).into(),
            _ if b.is_zero() => return a.into_owned(),
            _ => (a, b) = (b.clone(), Cow::Owned(&*a % &*b)),
        }
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

    /// Small parts and parts beyond 128 bits; what cancels and what does not.
    #[test]
    fn products_and_sums_are_those_of_rationals() {
        let parts = ["1", "-6", "1e-7", "-0.15", "2.5e30", "1234567e-9", "-3e-45", "0", "30", "1e-45"];
        let mut numbers: Vec<_> = parts.map(|text| parse_decimal(text).expect("a decimal")).to_vec();
        numbers.extend(numbers.clone().iter().filter(|x| !x.is_zero()).map(|x| x / BigInt::from(21)));
        for a in &numbers {
            for b in &numbers {
                let (product, sum) = (product(a, b), sum(a, b));
                for (found, expected) in [(&product, a * b), (&sum, a + b)] {
                    let [found_parts, expected_parts] = [found, &expected].map(|x| (x.numer(), x.denom()));
                    assert_eq!(found_parts, expected_parts, "{a}, {b}");
                }
            }
        }
    }

    #[test]
    fn equal_constants_have_one_form() {
        assert_eq!(root("8"), Constant::integer(2).mul(&root("2")));
        assert_eq!(root("0.5").recip(), Some(root("2")));
        assert_eq!(root("2").add(&root("8")), Some(Constant::integer(3).mul(&root("2"))));
        assert_eq!(root("2").add(&root("3")), None);
        // 1000003 is beyond the primes whose squares are looked for.
        let [one, other] = ["2000006", "5000015"].map(root);
        assert_eq!(one.mul(&other), Constant::integer(1_000_003).mul(&root("10")));
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
