//! Formulas of what is seen of a mechanism.

use crate::Seen;
use gyro_sim::Real;
use nanoserde::{DeBin, SerBin};

/// Arithmetic with numbers of the mechanism.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub enum Formula {
    /// A constant.
    Number(f64),
    /// A number of the mechanism.
    Seen(Seen),
    /// The other sign.
    Negative(Box<Formula>),
    /// The square root.
    Root(Box<Formula>),
    /// The sum of both.
    Sum(Box<[Formula; 2]>),
    /// The first less the second.
    Difference(Box<[Formula; 2]>),
    /// The product of both.
    Product(Box<[Formula; 2]>),
    /// The first divided by the second.
    Quotient(Box<[Formula; 2]>),
    /// A whole power.
    Power(Box<Formula>, i32),
}

impl Formula {
    /// Its value; not finite where it divides by zero or has the root of a negative number.
    pub(crate) fn value<T: Real>(&self, see: &impl Fn(Seen) -> T) -> T {
        match self {
            Self::Number(value) => T::constant(*value),
            Self::Seen(seen) => see(*seen),
            Self::Negative(a) => -a.value(see),
            Self::Root(a) => a.value(see).sqrt(),
            Self::Sum(parts) => parts[0].value(see) + parts[1].value(see),
            Self::Difference(parts) => parts[0].value(see) - parts[1].value(see),
            Self::Product(parts) => parts[0].value(see) * parts[1].value(see),
            Self::Quotient(parts) => parts[0].value(see) / parts[1].value(see),
            Self::Power(base, exponent) => power(base.value(see), *exponent),
        }
    }
}

/// By repeated squaring.
fn power<T: Real>(base: T, exponent: i32) -> T {
    let (mut square, mut power) = (base, T::constant(1.0));
    let mut rest = exponent.unsigned_abs();
    while rest > 0 {
        if rest & 1 == 1 {
            power = power * square;
        }
        square = square * square;
        rest >>= 1;
    }
    if exponent < 0 { T::constant(1.0) / power } else { power }
}
