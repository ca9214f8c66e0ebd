//! Numbers of the model file: exact rationals, references to parameters, or what is computed from these.

mod computation;
mod formula;

pub use computation::Computation;
pub use formula::{Formula, Kink, Levels, Operation};

use std::sync::Arc;

use num_bigint::BigInt;
use num_traits::{One, Signed, ToPrimitive, Zero};

/// An exact rational of any size.
pub type Rational = num_rational::BigRational;

/// A number as the model file gives it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Number {
    /// The rational that the decimal text denotes.
    Exact(Rational),
    /// A parameter, by its index, with its sign.
    Parameter {
        /// Index into [`crate::Model::parameters`].
        index: usize,
        /// Whether the parameter enters with a minus sign.
        negated: bool,
    },
    /// An input, by its index, with its sign. Only forces have such numbers.
    Input {
        /// Index into [`crate::Model::inputs`].
        index: usize,
        /// Whether the input enters with a minus sign.
        negated: bool,
    },
    /// Computed from parameters, of which at least one occurs in it, and exact numbers.
    Computed(Arc<Computation>),
    /// A formula of what moves, of time or of inputs. Only forces have such numbers.
    Formula(Arc<Formula>),
}

impl Number {
    /// An integer.
    pub fn integer(value: i64) -> Self {
        Self::Exact(Rational::from_integer(BigInt::from(value)))
    }

    /// The formula, if it is one.
    pub fn formula(&self) -> Option<&Formula> {
        match self {
            Self::Formula(formula) => Some(formula),
            _ => None,
        }
    }

    /// Whether the number is folded and exactly zero.
    pub fn is_zero(&self) -> bool {
        matches!(self, Self::Exact(value) if value.is_zero())
    }
}

/// The nearest `f64`.
pub fn to_f64(value: &Rational) -> f64 {
    value.to_f64().expect("a rational always converts, to infinity if need be")
}

/// Largest decimal exponent that is read: beyond it no `f64` can follow.
const MAX_EXPONENT: i64 = 400;

/// Decimal exponent of the largest size of a number in a model, and of the reciprocal of the smallest.
///
/// Squares and products of three such numbers are still far from the ends of `f64`, and no unit needs more.
pub(crate) const SIZE_EXPONENT: u32 = 100;

/// Whether a number is zero or of a size that the arithmetic of a run can work with.
pub(crate) fn in_range(value: &Rational) -> bool {
    let limit = Rational::from_integer(BigInt::from(10).pow(SIZE_EXPONENT));
    value.is_zero() || (value.abs() <= limit && (value.abs() * limit) >= Rational::one())
}

/// Reads a decimal (`-1_000.5e-7`, `3`, `.5`) as the rational it denotes; `None` for anything else.
pub fn parse_decimal(text: &str) -> Option<Rational> {
    let text = text.trim().replace('_', "");
    let (negative, unsigned) = match text.as_bytes().first()? {
        b'-' => (true, &text[1..]),
        b'+' => (false, &text[1..]),
        _ => (false, &text[..]),
    };
    let (mantissa, exponent) = match unsigned.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i64>().ok()?),
        None => (unsigned, 0),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits = format!("{whole}{fraction}");
    if digits.is_empty()
        || !digits.bytes().all(|b| b.is_ascii_digit())
        || !(-MAX_EXPONENT..=MAX_EXPONENT).contains(&exponent)
    {
        return None;
    }
    let shift = exponent - i64::try_from(fraction.len()).ok()?;
    let power = BigInt::from(10).pow(u32::try_from(shift.unsigned_abs()).ok()?);
    let digits: BigInt = digits.parse().ok()?;
    let value =
        if shift < 0 { Rational::new(digits, power) } else { Rational::new(digits * power, BigInt::one()) };
    Some(if negative { -value } else { value })
}
