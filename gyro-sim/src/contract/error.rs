//! Errors of a run.

use super::Owner;
use core::fmt;

/// A failure of a run, with the time and the number that failed. The run stops there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Error {
    /// The state is no longer finite: the step is too large for the motion, the pose is singular, or the start was not
    /// finite.
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
    /// A correction would change the dependent positions by so much that the solution need not be the one nearby: it
    /// may be another way to assemble the mechanism, in which the run must not go on.
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
    /// The tolerance cannot be met, however short the step is.
    StepTooShort {
        /// Time, s.
        t: f64,
        /// The step that would have to be tried next, s.
        step: f64,
        /// Index of the element of the state whose error is largest.
        index: u16,
    },
    /// The budget of steps is used up.
    TooManySteps {
        /// Time, s.
        t: f64,
        /// Number of steps taken, rejected ones included.
        steps: u64,
    },
    /// Stability keeps the steps of an explicit method so short that the budget would not suffice: the equations
    /// are stiff for it. An L-stable method such as [`Rodas4`](crate::Rodas4) does not have this limit.
    Stiff {
        /// Time, s.
        t: f64,
        /// The fastest rate met so far, 1/s.
        rate: f64,
        /// The step that stability allows, s.
        step: f64,
    },
    /// A setting of the solver, or a step, that is not a valid step length.
    Setting {
        /// Its name.
        setting: &'static str,
        /// Its value, s.
        value: f64,
    },
    /// The time to start from or to go to is not finite, or the time to interpolate at not within the last step.
    InvalidEndTime {
        /// Time, s.
        t: f64,
        /// The time to go to, s.
        t_end: f64,
    },
    /// The tolerances are not positive numbers, or are finer than the number type can resolve.
    Tolerance {
        /// Relative tolerance.
        relative: f64,
        /// Absolute tolerance.
        absolute: f64,
        /// The smallest relative tolerance.
        smallest: f64,
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
                write!(f, "at t = {t} s the mechanism is in a singular pose: pivot {pivot:e}")
            }
            Self::Singular { t, pivot, owner: Some(owner) } => {
                write!(
                    f,
                    "at t = {t} s the mechanism is in a singular pose: the constraints of {owner:?} depend on others, pivot {pivot:e}"
                )
            }
            Self::Jump { t, change, limit, owner } => write!(
                f,
                "at t = {t} s the constraints of {owner:?} need a correction of {change:e}, but only {limit:e} is safe: it may \
                 lead to another branch"
            ),
            Self::StepTooShort { t, step, index } => {
                write!(
                    f,
                    "at t = {t} s the tolerance cannot be met: element {index} of the state would need steps as short as {step:e} s"
                )
            }
            Self::Setting { setting, value } => write!(f, "{setting} = {value} s is not a valid step length"),
            Self::InvalidEndTime { t, t_end } => write!(
                f,
                "cannot go from t = {t} s to t = {t_end} s: the time is not finite or lies outside the last step"
            ),
            Self::TooManySteps { t, steps } => {
                write!(f, "at t = {t} s the budget of {steps} steps is used up")
            }
            Self::Stiff { t, rate, step } => write!(
                f,
                "at t = {t} s the equations are stiff for this method: a rate of {rate:e}/s limits steps to {step:e} s; \
                 use an L-stable method"
            ),
            Self::Tolerance { relative, absolute, smallest } => write!(
                f,
                "tolerances of {relative:e} (relative) and {absolute:e} (absolute) cannot be met: the former must be \
                 at least {smallest:e}, the latter positive"
            ),
        }
    }
}

impl core::error::Error for Error {}
