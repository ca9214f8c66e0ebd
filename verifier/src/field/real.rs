//! Floating-point numbers of many bits.

use super::Field;
use astro_float_num::{BigFloat, Consts, RoundingMode};
use gyro_model::Rational;
use num_bigint::{BigInt, Sign};
use std::cell::RefCell;

/// Mantissa in bits.
const BITS: usize = 384;

/// Rounding of each operation.
const NEAREST: RoundingMode = RoundingMode::ToEven;

/// A floating-point number with a mantissa of 384 bits, rounded to nearest.
#[derive(Clone, Debug)]
pub struct Real<'c> {
    value: BigFloat,
    precision: &'c Precision,
}

/// Constants that elementary functions share.
#[derive(Debug)]
pub struct Precision {
    constants: RefCell<Consts>,
}

impl Precision {
    /// Nothing computed yet.
    pub fn new() -> Self {
        Self { constants: RefCell::new(Consts::new().expect("small constants find memory")) }
    }
}

impl Default for Precision {
    fn default() -> Self {
        Self::new()
    }
}

impl<'c> Real<'c> {
    /// The number that an `f64` is, exactly.
    pub fn new(precision: &'c Precision, value: f64) -> Self {
        Self { value: BigFloat::from_f64(value, BITS), precision }
    }

    /// Another number of the same precision.
    #[must_use]
    pub fn like(&self, value: f64) -> Self {
        Self::new(self.precision, value)
    }

    /// The nearest `f64`, to about one unit in its last place.
    pub fn to_f64(&self) -> f64 {
        let Some((words, _, sign, exponent, _)) = self.value.as_raw_parts() else {
            return f64::NAN;
        };
        let top = words.last().copied().unwrap_or(0);
        let size = top as f64 / 2.0_f64.powi(64) * 2.0_f64.powi(exponent);
        if sign == astro_float_num::Sign::Neg { -size } else { size }
    }

    /// Square root.
    #[must_use]
    pub fn sqrt(&self) -> Self {
        self.with(self.value.sqrt(BITS, NEAREST))
    }

    /// A function of `astro-float`.
    #[must_use]
    pub(crate) fn by(&self, function: fn(&BigFloat, usize, RoundingMode, &mut Consts) -> BigFloat) -> Self {
        self.with(function(&self.value, BITS, NEAREST, &mut self.precision.constants.borrow_mut()))
    }

    /// The angle of the point `(x, self)`, in (−π, π].
    #[must_use]
    pub fn atan2(&self, x: &Self) -> Self {
        let constants = &mut self.precision.constants.borrow_mut();
        let pi = constants.pi(BITS, NEAREST);
        let quotient = |a: &BigFloat, b: &BigFloat| a.div(b, BITS, NEAREST);
        // The arc tangent of the smaller over the larger coordinate, turned into the point's octants.
        let (y, x) = (&self.value, &x.value);
        let angle = if x.abs_cmp(y).is_some_and(|order| order >= 0) {
            let angle = quotient(y, x).atan(BITS, NEAREST, constants);
            match (x.is_negative(), y.is_negative()) {
                (false, _) => angle,
                (true, false) => angle.add(&pi, BITS, NEAREST),
                (true, true) => angle.sub(&pi, BITS, NEAREST),
            }
        } else {
            let quarter = quotient(&pi, &BigFloat::from_word(2, BITS));
            let quarter = if y.is_negative() { quarter.neg() } else { quarter };
            quarter.sub(&quotient(x, y).atan(BITS, NEAREST, constants), BITS, NEAREST)
        };
        self.with(angle)
    }

    /// Absolute value.
    #[must_use]
    pub fn abs(&self) -> Self {
        self.with(self.value.abs())
    }

    /// The largest whole number that is not larger.
    #[must_use]
    pub fn floor(&self) -> Self {
        self.with(self.value.floor())
    }

    /// The first where this one is greater than zero, else the second; where this is no number, neither.
    #[must_use]
    pub(crate) fn choose(&self, one: &Self, other: &Self) -> Self {
        match self.value.cmp(&BigFloat::new(BITS)) {
            Some(order) if order > 0 => one.clone(),
            Some(_) => other.clone(),
            None => self.clone(),
        }
    }

    /// Whether the number is smaller than another.
    pub fn is_less(&self, other: &Self) -> bool {
        self.value.cmp(&other.value).is_some_and(|order| order < 0)
    }

    fn with(&self, value: BigFloat) -> Self {
        Self { value, precision: self.precision }
    }

    fn from_integer(precision: &'c Precision, value: &BigInt) -> Self {
        let radix = BigFloat::from_f64(2.0_f64.powi(64), BITS);
        // Every step but the last few of a very long integer is exact.
        let size = value.magnitude().to_u64_digits().iter().rev().fold(BigFloat::new(BITS), |sum, &digit| {
            let shifted = sum.mul(&radix, BITS, NEAREST);
            shifted.add(&BigFloat::from_u64(digit, BITS), BITS, NEAREST)
        });
        let value = if value.sign() == Sign::Minus { size.neg() } else { size };
        Self { value, precision }
    }
}

impl PartialEq for Real<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.value.cmp(&other.value) == Some(0)
    }
}

impl<'c> Field for Real<'c> {
    type Context = &'c Precision;

    fn from_rational(precision: Self::Context, value: &Rational) -> Self {
        let [numerator, denominator] =
            [value.numer(), value.denom()].map(|integer| Self::from_integer(precision, integer));
        numerator.with(numerator.value.div(&denominator.value, BITS, NEAREST))
    }

    fn sqrt_rational(precision: Self::Context, value: &Rational) -> Self {
        Self::from_rational(precision, value).sqrt()
    }

    fn add(&self, other: &Self) -> Self {
        self.with(self.value.add(&other.value, BITS, NEAREST))
    }

    fn sub(&self, other: &Self) -> Self {
        self.with(self.value.sub(&other.value, BITS, NEAREST))
    }

    fn mul(&self, other: &Self) -> Self {
        self.with(self.value.mul(&other.value, BITS, NEAREST))
    }

    fn neg(&self) -> Self {
        self.with(self.value.neg())
    }

    fn inv(&self) -> Option<Self> {
        (!self.is_zero()).then(|| self.with(self.value.reciprocal(BITS, NEAREST)))
    }

    fn div(&self, other: &Self) -> Option<Self> {
        (!other.is_zero()).then(|| self.with(self.value.div(&other.value, BITS, NEAREST)))
    }

    fn is_zero(&self) -> bool {
        self.value.is_zero()
    }
}

#[cfg(test)]
mod tests;
