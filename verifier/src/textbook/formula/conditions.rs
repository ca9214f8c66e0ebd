//! Conditions.

use super::Value;
use num_traits::Signed;

/// A condition.
pub(super) enum Condition<F> {
    /// The number is greater than zero.
    Positive(Value<F>),
    Not(Box<Condition<F>>),
    And(Box<Condition<F>>, Box<Condition<F>>),
    Or(Box<Condition<F>>, Box<Condition<F>>),
}

impl<F> Condition<F> {
    /// Whether it chooses the first of two values, where numbers alone decide that; of one number either.
    pub(super) fn takes_first(&self, [a, b]: [&Value<F>; 2]) -> Option<bool> {
        if a.exact.is_some() && a.exact == b.exact { Some(true) } else { self.decided() }
    }

    /// Whether it holds, where numbers alone decide that.
    fn decided(&self) -> Option<bool> {
        match self {
            Self::Positive(margin) => margin.exact.as_ref().map(Signed::is_positive),
            Self::Not(inner) => inner.decided().map(|holds| !holds),
            Self::And(p, q) => match [p.decided(), q.decided()] {
                [Some(false), _] | [_, Some(false)] => Some(false),
                [Some(true), other] | [other, Some(true)] => other,
                _ => None,
            },
            Self::Or(p, q) => match [p.decided(), q.decided()] {
                [Some(true), _] | [_, Some(true)] => Some(true),
                [Some(false), other] | [other, Some(false)] => other,
                _ => None,
            },
        }
    }
}
