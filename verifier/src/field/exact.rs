//! Exact rationals.

use super::Field;
use gyro_model::Rational;
use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};

/// A rational of any size; `None` where it is undefined: by a root that is not a rational.
#[derive(Clone, Debug)]
pub struct Exact(pub Option<Rational>);

impl Exact {
    fn combine(&self, other: &Self, operation: impl Fn(&Rational, &Rational) -> Rational) -> Self {
        Self(self.0.as_ref().zip(other.0.as_ref()).map(|(a, b)| operation(a, b)))
    }
}

impl PartialEq for Exact {
    fn eq(&self, other: &Self) -> bool {
        self.0.is_some() && self.0 == other.0
    }
}

impl Field for Exact {
    type Context = ();

    fn from_rational((): (), value: &Rational) -> Self {
        Self(Some(value.clone()))
    }

    /// Undefined where the root is not rational.
    fn sqrt_rational((): (), value: &Rational) -> Self {
        let root = |n: &BigInt| Some(n.sqrt()).filter(|root| !n.is_negative() && root * root == *n);
        let positive = !value.is_negative();
        let roots = positive.then(|| root(value.numer()).zip(root(value.denom()))).flatten();
        Self(roots.map(|(numerator, denominator)| Rational::new(numerator, denominator)))
    }

    fn add(&self, other: &Self) -> Self {
        self.combine(other, |a, b| a + b)
    }

    fn sub(&self, other: &Self) -> Self {
        self.combine(other, |a, b| a - b)
    }

    fn mul(&self, other: &Self) -> Self {
        self.combine(other, |a, b| a * b)
    }

    fn neg(&self) -> Self {
        Self(self.0.as_ref().map(|a| -a))
    }

    fn inv(&self) -> Option<Self> {
        (!self.is_zero()).then(|| Self(self.0.as_ref().map(|a| Rational::one() / a)))
    }

    fn is_zero(&self) -> bool {
        self.0.as_ref().is_some_and(Zero::is_zero)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyro_model::parse_decimal;

    #[test]
    fn rational_roots_are_found_and_others_undefined() {
        let root = |text| Exact::sqrt_rational((), &parse_decimal(text).expect("a decimal"));
        assert_eq!(root("0.25"), Exact(parse_decimal("0.5")));
        assert_ne!(root("2"), root("2"));
        assert_ne!(root("-1"), root("-1"));
        assert!(root("0").is_zero());
        assert_eq!(root("0").inv(), None);
    }
}
