//! Errors of a motion with contacts.

use core::fmt;

/// Why a motion with contacts cannot go on, with the time and the number that failed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Error {
    /// What ends motions without contacts too.
    Solver(crate::Error),
    /// The forces of contacts are not determined: friction in proportion to a reaction to which it adds may jam, or no
    /// phases of the contacts are consistent.
    Jammed {
        /// Time, s.
        t: f64,
        /// Index of the contact's coordinate in the state.
        index: u16,
        /// How much friction a unit of friction adds by way of the reactions, at most: from 1 on it may jam.
        gain: f64,
    },
}

impl From<crate::Error> for Error {
    fn from(error: crate::Error) -> Self {
        Self::Solver(error)
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Solver(error) => error.fmt(f),
            Self::Jammed { t, index, gain } => write!(
                f,
                "at t = {t} s the forces of the contact on element {index} of the state are not determined: a unit of friction \
                 adds up to {gain:e} to itself by way of the reactions that it grows with, and from 1 on it may jam"
            ),
        }
    }
}

impl core::error::Error for Error {}
