//! Formulas of what is seen of a mechanism.

use crate::{Number, Seen};

/// Arithmetic with numbers of the model file and numbers of the mechanism, such as `"pan rate * length - 0.3"`.
#[derive(Clone, Debug)]
pub enum Formula {
    /// A number of the model file.
    Number(Number),
    /// A column of a run's table.
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
    /// All numbers of the model file that occur in it.
    pub(crate) fn numbers(&self) -> Vec<&Number> {
        match self {
            Self::Number(number) => vec![number],
            Self::Seen(_) => Vec::new(),
            Self::Negative(a) | Self::Root(a) | Self::Power(a, _) => a.numbers(),
            Self::Sum(parts) | Self::Difference(parts) | Self::Product(parts) | Self::Quotient(parts) => {
                parts.iter().flat_map(Self::numbers).collect()
            }
        }
    }
}
