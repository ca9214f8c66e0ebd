//! Where laws have kinks or jumps.

use crate::formula::Formula;
use nanoserde::{DeBin, SerBin};

/// Where a law has a kink or a jump: where a formula comes to one of some values.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub struct Kink {
    /// What tells.
    pub of: Formula,
    /// At which of its values.
    pub at: Levels,
}

/// At which values of an argument something has a kink or a jump.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub enum Levels {
    /// At whole numbers.
    Whole,
    /// At these, which ascend.
    At(Vec<f64>),
}

impl Levels {
    /// Between which of the levels a value is: a number that tells two such places apart. `None` at a level itself, and
    /// of what is not finite.
    pub(crate) fn place(&self, value: f64) -> Option<f64> {
        let is_level = match self {
            Self::Whole => value == value.floor(),
            Self::At(levels) => levels.contains(&value),
        };
        let place = match self {
            Self::Whole => value.floor(),
            Self::At(levels) => levels.partition_point(|level| *level < value) as f64,
        };
        (value.is_finite() && !is_level).then_some(place)
    }
}
