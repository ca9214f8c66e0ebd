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
            computed @ Self::Computed(_) => Self::integer(-1) * computed,
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
            (minus, x) | (x, minus) if minus == Self::integer(-1) && !matches!(x, Self::Computed(_)) => -x,
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
        let Self::Computed(computation) = self else { return Vec::new() };
        let own = if let Computation::Quotient(_, divisor) = &**computation { Some(divisor) } else { None };
        let inner = computation.operands().into_iter().flat_map(Self::divisors);
        own.into_iter().chain(inner).collect()
    }

    /// The value, given those of parameters and inputs; `None` where it divides by zero.
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
mod tests {
    use super::*;

    fn x() -> Number {
        Number::Parameter { index: 0, negated: false }
    }

    fn at(number: &Number, x: i64) -> Option<Rational> {
        number.evaluate(&|_| Rational::from_integer(x.into()), &|_| Rational::one())
    }

    #[test]
    fn what_is_known_is_folded() {
        let of = Number::integer;
        assert_eq!(of(2) + of(3), of(5));
        assert_eq!(of(1).over(of(4)).and_then(|quarter| quarter.over(of(2))), of(1).over(of(8)));
        assert_eq!((x() + of(0), x() * of(1), x() * of(0)), (x(), x(), of(0)));
        assert_eq!((-x(), of(-1) * x()), (Number::Parameter { index: 0, negated: true }, -x()));
        assert_eq!(
            (x().power(0), x().power(1), of(2).power(-3)),
            (Some(of(1)), Some(x()), of(1).over(of(8)))
        );
        assert_eq!((x().over(of(0)), of(0).power(-1), of(0).over(x())), (None, None, Some(of(0))));
    }

    /// (x² − 3) / (x − 2), with its weight: four names and numbers, one of them squared.
    #[test]
    fn a_computation_is_evaluated_where_it_is_defined() {
        let top = x().power(2).expect("positive") - Number::integer(3);
        let number = top.over(x() - Number::integer(2)).expect("not by zero");
        assert_eq!(at(&number, 5), Some(Rational::new(22.into(), 3.into())));
        assert_eq!(at(&number, 2), None);
        assert_eq!((number.weight(), number.divisors().len(), number.leaves().len()), (5, 1, 4));
        assert!(number.has_parameters() && !Number::integer(1).has_parameters());
    }
}
