//! What is computed from parameters: sums, products, quotients and powers of numbers of the model file.

use std::ops::{Add, Mul, Neg, Sub};
use std::sync::Arc;

use num_traits::{One, Zero};

use super::{Number, Rational};

/// An operation on numbers of which at least one is a parameter, or computed from one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Computation {
    /// The sum of both.
    Sum(Number, Number),
    /// The product of both.
    Product(Number, Number),
    /// The first divided by the second.
    Quotient(Number, Number),
    /// A power: 2 or more.
    Power(Number, u32),
}

impl Computation {
    /// The numbers that it is computed from.
    pub fn operands(&self) -> Vec<&Number> {
        match self {
            Self::Sum(a, b) | Self::Product(a, b) | Self::Quotient(a, b) => vec![a, b],
            Self::Power(base, _) => vec![base],
        }
    }
}

impl From<Computation> for Number {
    fn from(computation: Computation) -> Self {
        Self::Computed(Arc::new(computation))
    }
}

// What both operands know exactly is folded, and what is neutral is left out.

impl Add for Number {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        match (self, other) {
            (Self::Exact(a), Self::Exact(b)) => Self::Exact(a + b),
            (zero, x) | (x, zero) if zero.is_zero() => x,
            (a, b) => Computation::Sum(a, b).into(),
        }
    }
}

impl Sub for Number {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Number {
    type Output = Self;

    fn neg(self) -> Self {
        match self {
            Self::Exact(value) => Self::Exact(-value),
            Self::Parameter { index, negated } => Self::Parameter { index, negated: !negated },
            Self::Input { index, negated } => Self::Input { index, negated: !negated },
            computed @ (Self::Computed(_) | Self::Formula(_)) => Self::integer(-1) * computed,
        }
    }
}

impl Mul for Number {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        match (self, other) {
            (Self::Exact(a), Self::Exact(b)) => Self::Exact(a * b),
            (zero, _) | (_, zero) if zero.is_zero() => Self::integer(0),
            (one, x) | (x, one) if one.is_one() => x,
            (minus, x) | (x, minus)
                if minus == Self::integer(-1) && !matches!(x, Self::Computed(_) | Self::Formula(_)) =>
            {
                -x
            }
            (a, b) => Computation::Product(a, b).into(),
        }
    }
}

impl Number {
    fn is_one(&self) -> bool {
        matches!(self, Self::Exact(value) if value.is_one())
    }

    /// The number divided by another; `None` if that is exactly zero.
    #[must_use]
    pub fn over(self, divisor: Self) -> Option<Self> {
        match (self, divisor) {
            (_, Self::Exact(b)) if b.is_zero() => None,
            (a, Self::Exact(b)) => Some(a * Self::Exact(b.recip())),
            (zero, _) if zero.is_zero() => Some(zero),
            (a, b) => Some(Computation::Quotient(a, b).into()),
        }
    }

    /// A power of the number, which of exponent 0 is 1; `None` of zero with a negative exponent.
    #[must_use]
    pub fn power(self, exponent: i32) -> Option<Self> {
        let size = exponent.unsigned_abs();
        let power = match (self, size) {
            (_, 0) => Self::integer(1),
            (x, 1) => x,
            (Self::Exact(value), _) => Self::Exact(num_traits::pow(value, size as usize)),
            (x, _) => Computation::Power(x, size).into(),
        };
        if exponent < 0 { Self::integer(1).over(power) } else { Some(power) }
    }

    /// How many numbers and names it is computed from, powers counted as products: a bound on its digits.
    pub fn weight(&self) -> u64 {
        let Self::Computed(computation) = self else { return 1 };
        let power = if let Computation::Power(_, exponent) = **computation { exponent.into() } else { 1 };
        let operands: u64 = computation.operands().iter().map(|number| number.weight()).sum();
        operands.saturating_mul(power)
    }

    /// The number itself, or what it is computed from: exact numbers, parameters and inputs.
    pub fn leaves(&self) -> Vec<&Self> {
        match self {
            Self::Formula(formula) => formula.numbers().flat_map(Self::leaves).collect(),
            Self::Computed(computation) => {
                computation.operands().into_iter().flat_map(Self::leaves).collect()
            }
            leaf => vec![leaf],
        }
    }

    /// Whether a parameter occurs in it.
    pub fn has_parameters(&self) -> bool {
        self.leaves().iter().any(|leaf| matches!(leaf, Self::Parameter { .. }))
    }

    /// The numbers that it divides by: none of them may be zero.
    pub fn divisors(&self) -> Vec<&Self> {
        let computation = match self {
            Self::Computed(computation) => computation,
            Self::Formula(formula) => return formula.numbers().flat_map(Self::divisors).collect(),
            _ => return Vec::new(),
        };
        let own = if let Computation::Quotient(_, divisor) = &**computation { Some(divisor) } else { None };
        let inner = computation.operands().into_iter().flat_map(Self::divisors);
        own.into_iter().chain(inner).collect()
    }

    /// The value, given those of parameters and inputs; `None` where it divides by zero, and of formulas.
    pub(crate) fn evaluate(
        &self,
        parameter: &dyn Fn(usize) -> Rational,
        input: &dyn Fn(usize) -> Rational,
    ) -> Option<Rational> {
        let value = |number: &Self| number.evaluate(parameter, input);
        let signed = |value: Rational, negated: bool| if negated { -value } else { value };
        Some(match self {
            Self::Exact(value) => value.clone(),
            Self::Parameter { index, negated } => signed(parameter(*index), *negated),
            Self::Input { index, negated } => signed(input(*index), *negated),
            Self::Formula(_) => return None,
            Self::Computed(computation) => match &**computation {
                Computation::Sum(a, b) => value(a)? + value(b)?,
                Computation::Product(a, b) => value(a)? * value(b)?,
                Computation::Quotient(a, b) => {
                    let divisor = value(b)?;
                    if divisor.is_zero() {
                        return None;
                    }
                    value(a)? / divisor
                }
                Computation::Power(base, exponent) => num_traits::pow(value(base)?, *exponent as usize),
            },
        })
    }
}

#[cfg(test)]
mod tests;
