//! What can go wrong in a run.

use crate::Owner;
use core::fmt;

/// A failure of a run, with the time and the number that failed. The run has not gone on past it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Error {
    /// The state is no longer finite: the step is too large for the motion, the pose is singular, or the start was not finite.
    NotFinite {
        /// Time, s.
        t: f64,
        /// Index of the first element of the state that is not finite.
        index: u16,
    },
    /// The Newton–Raphson iteration on the dependent positions did not converge.
    NoConvergence {
        /// Time, s.
        t: f64,
        /// Largest remaining violation (lengths divided by the mechanism's size).
        violation: f64,
        /// Whose constraint it is.
        owner: Owner,
    },
    /// The dependent coordinates cannot be solved for: the mechanism is in a singular pose.
    Singular {
        /// Time, s.
        t: f64,
        /// The pivot that vanished.
        pivot: f64,
        /// Whose constraint depends on others there, where that is known.
        owner: Option<Owner>,
    },
    /// A correction would change the dependent positions by so much that the solution need not be the one nearby: it may be
    /// another way to assemble the mechanism, in which the run must not go on.
    Jump {
        /// Time, s.
        t: f64,
        /// Largest change of a dependent coordinate (lengths divided by the mechanism's size).
        change: f64,
        /// The largest change that is safe in this pose; it shrinks to zero towards a singular one.
        limit: f64,
        /// Whose constraint was violated most.
        owner: Owner,
    },
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFinite { t, index } => {
                write!(f, "at t = {t} s element {index} of the state is not finite")
            }
            Self::NoConvergence { t, violation, owner } => {
                write!(f, "at t = {t} s the constraints of {owner:?} cannot be met: violation {violation:e}")
            }
            Self::Singular { t, pivot, owner: None } => {
                write!(f, "at t = {t} s the dependent coordinates are singular: pivot {pivot:e}")
            }
            Self::Singular { t, pivot, owner: Some(owner) } => {
                write!(f, "at t = {t} s the constraints of {owner:?} depend on others: pivot {pivot:e}")
            }
            Self::Jump { t, change, limit, owner } => write!(
                f,
                "at t = {t} s the constraints of {owner:?} need a change of {change:e} where {limit:e} is safe: it may lead to \
                 another branch"
            ),
        }
    }
}

impl core::error::Error for Error {}
