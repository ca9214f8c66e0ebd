//! Where laws have kinks or jumps.

use crate::formula::Formula;
use nanoserde::{DeBin, SerBin};

/// Where a law has a kink or a jump: where a formula comes to one of some values.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub struct Kink {
    /// Where it is, in the words of the model file.
    pub words: String,
    /// What tells.
    pub of: Formula,
    /// At which of its values.
    pub at: Levels,
}

/// A motion that stays at a kink: steps do not end there any more.
#[derive(Clone, Copy, Debug, PartialEq, SerBin, DeBin)]
pub struct Stay {
    /// Which of [`Start::kinks`](crate::Start::kinks).
    pub kink: usize,
    /// Since when, s.
    pub t: f64,
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

    /// The first level on the way from one of these places to a value, if that is at another place.
    pub(crate) fn next(&self, from: f64, value: f64) -> Option<f64> {
        let to = self.place(value).filter(|to| *to != from)?;
        let index = if to > from { from } else { from - 1.0 };
        Some(match self {
            Self::Whole => index + 1.0,
            Self::At(levels) => levels[index as usize],
        })
    }
}
