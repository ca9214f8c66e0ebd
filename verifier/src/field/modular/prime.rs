//! The prime: how it is made so that given square roots exist.

use super::{Modular, arithmetic};
use crate::field::Field;
use gyro_model::Rational;
use num_bigint::{BigInt, BigUint};
use num_integer::Integer;
use num_traits::One;
use rand::Rng;
use std::cell::RefCell;
use std::collections::HashMap;

/// A prime `p ≡ 7 (mod 8)` of at most `64 L − 1` bits, with what Montgomery's arithmetic needs.
#[derive(Debug)]
pub struct Prime<const L: usize> {
    value: BigUint,
    limbs: [u64; L],
    negated_inverse: u64,
    /// `2^(64 L)` and its square modulo the prime.
    one: [u64; L],
    square: [u64; L],
    /// Every divisor of this number is a square.
    squares: BigUint,
    root_exponent: BigUint,
    pub(super) missed: RefCell<Vec<Rational>>,
    /// Rationals and roots of rationals met so far: to divide takes long.
    pub(super) rationals: Known<L>,
    pub(super) roots: Known<L>,
}

pub(super) type Known<const L: usize> = RefCell<HashMap<Rational, Option<[u64; L]>>>;

impl<const L: usize> Prime<L> {
    /// The largest Mersenne prime of some that there is room for; two is a square modulo each.
    pub fn mersenne() -> Self {
        let fits = |exponent: &&u32| **exponent < 64 * L as u32;
        let exponent = MERSENNE_EXPONENTS.iter().rfind(fits).expect("nine limbs at least");
        Self::new((BigUint::one() << *exponent) - 1_u32, BigUint::from(2_u32))
    }

    /// A random number that is all but surely a prime ([`Self::is_prime`] makes sure) for which every rational made of
    /// these integers has a square root; `None` if they take too many bits.
    ///
    /// Take p ≡ −1 modulo `8 n`. An odd prime q that divides n is then a square modulo p by quadratic reciprocity: if
    /// q ≡ 1 (mod 4), (q/p) = (p/q) = (−1/q) = 1; if q ≡ 3 (mod 4), (q/p) = −(p/q) = −(−1/q) = 1, as p ≡ 3 (mod 4).
    /// And (2/p) = 1, as p ≡ 7 (mod 8). So every divisor of n is a square.
    pub fn with_roots(n: &BigUint, random: &mut impl Rng) -> Option<Self> {
        let step = n * 8_u32;
        let bits = (64 * L as u64 - 1).checked_sub(step.bits()).filter(|&free| free >= MIN_RANDOM_BITS)?;
        loop {
            let words: Vec<u32> = (0..bits / 32).map(|_| random.next_u32()).collect();
            let candidate = &step * (BigUint::new(words) + 1_u32) - 1_u32;
            if candidate.bits() <= 64 * (L as u64 - 1) || has_small_divisor(&candidate) {
                continue;
            }
            let candidate = Self::new(candidate, n * 2_u32);
            if candidate.passes(random) {
                return Some(candidate);
            }
        }
    }

    /// Whether it is a prime, but for a probability of 4^-60: known of Mersenne's, tested of others.
    pub fn is_prime(&self, random: &mut impl Rng) -> bool {
        self.value.count_ones() == self.value.bits() || (0..ROUNDS).all(|_| self.passes(random))
    }

    /// A round of Miller and Rabin's test of a number ≡ 3 (mod 4) with a random base: the odd part of `p − 1` is `(p −
    /// 1) / 2`.
    fn passes(&self, random: &mut impl Rng) -> bool {
        let base = BigUint::new((0..8).map(|_| random.next_u32()).collect()) + 2_u32;
        let power = Modular::new(self, &base.into()).power(&(&self.value >> 1_u32));
        let one = Modular::new(self, &BigInt::one());
        power == one || power == one.neg()
    }

    fn new(value: BigUint, squares: BigUint) -> Self {
        let limbs = limbs(&value);
        // Newton's iteration doubles the correct bits of the inverse of an odd number, from three.
        let inverse =
            (0..5).fold(limbs[0], |x, _| x.wrapping_mul(2_u64.wrapping_sub(limbs[0].wrapping_mul(x))));
        let one = (BigUint::one() << (64 * L)) % &value;
        Self {
            limbs,
            negated_inverse: inverse.wrapping_neg(),
            square: self::limbs(&(&one * &one % &value)),
            one: self::limbs(&one),
            root_exponent: (&value + 1_u32) >> 2_u32,
            squares,
            missed: RefCell::default(),
            rationals: RefCell::default(),
            roots: RefCell::default(),
            value,
        }
    }

    /// The prime as a number.
    pub fn value(&self) -> &BigUint {
        &self.value
    }

    /// Whether all prime factors of a rational's numerator and denominator are squares by the prime's making. Only then
    /// is it sure that the root of `a²` which is a square is a and not −a.
    pub fn covers(&self, value: &Rational) -> bool {
        let mut rest = value.numer().magnitude() * value.denom().magnitude();
        loop {
            let common = rest.gcd(&self.squares);
            if common.is_one() {
                return rest.is_one();
            }
            rest /= common;
        }
    }

    /// Rationals whose root was asked for and for which the prime was not made.
    pub fn missed(&self) -> Vec<Rational> {
        self.missed.borrow().clone()
    }

    /// A number drawn evenly.
    pub fn draw(&self, random: &mut impl Rng) -> Modular<'_, L> {
        // Twice as many bits as the prime has make the remainder even to within 2^-500.
        let words: Vec<u32> = (0..4 * L).map(|_| random.next_u32()).collect();
        Modular::new(self, &BigInt::from(BigUint::new(words)))
    }

    pub(super) fn limbs(&self) -> &[u64; L] {
        &self.limbs
    }

    pub(super) fn one(&self) -> [u64; L] {
        self.one
    }

    pub(super) fn negated_inverse(&self) -> u64 {
        self.negated_inverse
    }

    pub(super) fn root_exponent(&self) -> &BigUint {
        &self.root_exponent
    }

    pub(super) fn in_montgomery_form(&self, value: &BigUint) -> [u64; L] {
        arithmetic::mul(&limbs(value), &self.square, &self.limbs, self.negated_inverse)
    }

    pub(super) fn plain(&self, value: &[u64; L]) -> BigUint {
        let mut one = [0; L];
        one[0] = 1;
        let number = arithmetic::mul(value, &one, &self.limbs, self.negated_inverse);
        BigUint::new(number.iter().flat_map(|&limb| halves(limb)).collect())
    }
}

/// Exponents of Mersenne primes, each a little less than a multiple of 64.
const MERSENNE_EXPONENTS: [u32; 4] = [521, 1279, 2281, 4423];

/// Random bits that a prime must have besides those that its roots take: there are then enough to choose from.
const MIN_RANDOM_BITS: u64 = 96;

/// Divisors below this are tried before powers are, which take far longer.
const SMALL: u32 = 2000;

/// Rounds of Miller and Rabin's test; each lets a composite pass with probability at most 1/4.
const ROUNDS: usize = 60;

/// What the table has of a value, or what is computed of it and noted there.
pub(super) fn known<const L: usize>(
    table: &Known<L>,
    value: &Rational,
    compute: impl FnOnce() -> Option<[u64; L]>,
) -> Option<[u64; L]> {
    if let Some(&known) = table.borrow().get(value) {
        return known;
    }
    let computed = compute();
    table.borrow_mut().insert(value.clone(), computed);
    computed
}

fn limbs<const L: usize>(value: &BigUint) -> [u64; L] {
    let digits = value.to_u64_digits();
    std::array::from_fn(|k| digits.get(k).copied().unwrap_or(0))
}

#[expect(clippy::cast_possible_truncation, reason = "the halves are what is meant")]
fn halves(limb: u64) -> [u32; 2] {
    [limb as u32, (limb >> 32) as u32]
}

/// Whether a number is divisible by one below [`SMALL`].
fn has_small_divisor(value: &BigUint) -> bool {
    // By what is not a prime nothing is found that one of its factors has not found before.
    (3..SMALL).step_by(2).any(|divisor| (value % divisor) == BigUint::ZERO)
}
