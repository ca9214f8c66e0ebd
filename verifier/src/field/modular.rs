//! Integers modulo a prime, in Montgomery form.

mod arithmetic;
mod prime;

pub use prime::Prime;
use prime::known;

use super::Field;
use gyro_model::Rational;
use num_bigint::{BigInt, BigUint, Sign};
use std::fmt;

/// Numerators and denominators of small fractions have at most so many bits: more than those of 42 digits, and so few
/// that of 2¹⁵⁰ numbers less than one is such a fraction.
const SMALL_BITS: u32 = 180;

/// An integer modulo a prime of at most `64 L − 1` bits.
#[derive(Clone, Copy)]
pub struct Modular<'p, const L: usize> {
    /// The number times 2^(64 L), least significant limb first; `None` where it is undefined.
    limbs: Option<[u64; L]>,
    prime: &'p Prime<L>,
}

impl<'p, const L: usize> Modular<'p, L> {
    /// The residue of an integer.
    pub fn new(prime: &'p Prime<L>, value: &BigInt) -> Self {
        let size = value.magnitude() % prime.value();
        let positive = Self { limbs: Some(prime.in_montgomery_form(&size)), prime };
        if value.sign() == Sign::Minus { positive.neg() } else { positive }
    }

    /// The number between zero and the prime; `None` if it is undefined.
    pub fn residue(&self) -> Option<BigUint> {
        self.limbs.map(|limbs| self.prime.plain(&limbs))
    }

    /// The limbs in Montgomery form: equal exactly for equal numbers.
    pub fn key(&self) -> Option<[u64; L]> {
        self.limbs
    }

    /// The root that is itself a square, if the number is a square: so that products of roots are roots of products.
    pub fn sqrt(&self) -> Option<Self> {
        let root = self.power(self.prime.root_exponent());
        (root.mul(&root) == *self).then_some(root)
    }

    /// The fraction of small numerator and denominator that this is, if there is one: at most one is, and a number that
    /// was drawn hardly ever is one. Euclid's algorithm passes by it.
    pub fn small_fraction(&self) -> Option<Rational> {
        let small = BigInt::from(1) << SMALL_BITS;
        let (mut before, mut rest) =
            (BigInt::from(self.prime.value().clone()), BigInt::from(self.residue()?));
        let (mut factor_before, mut factor) = (BigInt::from(0), BigInt::from(1));
        while rest >= small {
            let quotient = &before / &rest;
            let next = &before - &quotient * &rest;
            let next_factor = &factor_before - quotient * &factor;
            (before, rest) = (rest, next);
            (factor_before, factor) = (factor, next_factor);
        }
        (*factor.magnitude() < *small.magnitude()).then(|| Rational::new(rest, factor))
    }

    /// Nothing that equals anything.
    pub fn undefined(prime: &'p Prime<L>) -> Self {
        Self { limbs: None, prime }
    }

    fn power(&self, exponent: &BigUint) -> Self {
        let one = Self { limbs: Some(self.prime.one()), prime: self.prime };
        (0..exponent.bits()).rev().fold(one, |power, bit| {
            let square = power.mul(&power);
            if exponent.bit(bit) { square.mul(self) } else { square }
        })
    }

    fn combine(&self, other: &Self, operation: impl Fn(&[u64; L], &[u64; L], &[u64; L]) -> [u64; L]) -> Self {
        let limbs = self.limbs.zip(other.limbs).map(|(a, b)| operation(&a, &b, self.prime.limbs()));
        Self { limbs, prime: self.prime }
    }
}

impl<const L: usize> PartialEq for Modular<'_, L> {
    fn eq(&self, other: &Self) -> bool {
        self.limbs.is_some() && self.limbs == other.limbs
    }
}

impl<const L: usize> fmt::Debug for Modular<'_, L> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.residue().fmt(f)
    }
}

impl<'p, const L: usize> Field for Modular<'p, L> {
    type Context = &'p Prime<L>;

    /// Undefined where the prime divides the denominator.
    fn from_rational(prime: Self::Context, value: &Rational) -> Self {
        let quotient = || {
            let [numerator, denominator] = [value.numer(), value.denom()].map(|n| Self::new(prime, n));
            numerator.div(&denominator).unwrap_or(Self::undefined(prime))
        };
        Self { limbs: known(&prime.rationals, value, || quotient().limbs), prime }
    }

    /// Undefined where the prime was not made for this root; the prime then notes that it was missed.
    fn sqrt_rational(prime: Self::Context, value: &Rational) -> Self {
        let root = || {
            if !prime.covers(value) {
                prime.missed.borrow_mut().push(value.clone());
                return None;
            }
            Self::from_rational(prime, value).sqrt().and_then(|root| root.limbs)
        };
        Self { limbs: known(&prime.roots, value, root), prime }
    }

    fn add(&self, other: &Self) -> Self {
        self.combine(other, arithmetic::add)
    }

    fn sub(&self, other: &Self) -> Self {
        self.combine(other, arithmetic::sub)
    }

    fn mul(&self, other: &Self) -> Self {
        let inverse = self.prime.negated_inverse();
        self.combine(other, |a, b, prime| arithmetic::mul(a, b, prime, inverse))
    }

    fn neg(&self) -> Self {
        let zero = Self { limbs: Some([0; L]), prime: self.prime };
        zero.sub(self)
    }

    /// By Euclid's algorithm.
    fn inv(&self) -> Option<Self> {
        let inverse = || self.residue().and_then(|residue| residue.modinv(self.prime.value()));
        let limbs = || inverse().map(|inverse| self.prime.in_montgomery_form(&inverse));
        (!self.is_zero()).then(|| Self { limbs: limbs(), prime: self.prime })
    }

    fn is_zero(&self) -> bool {
        self.limbs == Some([0; L])
    }

    fn integer(prime: Self::Context, value: i64) -> Self {
        Self::new(prime, &BigInt::from(value))
    }
}

#[cfg(test)]
mod tests;
