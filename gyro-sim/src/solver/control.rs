//! Settings and statistics of a solver.

use super::Passage;
use crate::When;
use crate::integrate::Work;
#[cfg(feature = "wire")]
use crate::wire::*;

/// Settings of a solver.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Relative error tolerated in each step.
    pub relative: f64,
    /// Absolute error tolerated in each step in addition, in the element's own unit.
    pub absolute: f64,
    /// Length of the first step that is tried, s; zero to have it estimated.
    pub first_step: f64,
    /// Steps are not made shorter than this, s; rounding of the time sets a limit of its own.
    pub smallest_step: f64,
    /// Steps are not made longer than this, s.
    pub largest_step: f64,
    /// Number of steps, rejected ones included, after which the solver gives up.
    pub budget: u64,
    /// When to correct.
    pub when: When,
}

impl Default for Control {
    fn default() -> Self {
        Self {
            relative: 1e-8,
            absolute: 1e-8,
            first_step: 0.0,
            smallest_step: 0.0,
            largest_step: f64::INFINITY,
            budget: 10_000_000,
            when: When::Steps(1),
        }
    }
}

impl Control {
    /// Both tolerances set to one number.
    #[must_use]
    pub fn with_tolerance(self, tolerance: f64) -> Self {
        Self { relative: tolerance, absolute: tolerance, ..self }
    }
}

/// Statistics of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "wire", derive(SerBin, DeBin))]
pub struct Statistics {
    /// Steps that were kept.
    pub accepted: u64,
    /// Steps that were repeated with a shorter length.
    pub rejected: u64,
    /// Corrections made.
    pub corrections: u64,
    /// Evaluations of the system.
    pub work: Work,
    /// Accepted steps of explicit methods whose length was at the limit of stability rather than set by accuracy.
    pub limited_by_stability: u64,
    /// The largest estimate of a rate |λ| of the system, 1/s; explicit methods only.
    pub fastest_rate: f64,
    /// The shortest accepted step, s, not counting steps that were shortened to end at a given time.
    pub shortest_step: f64,
    /// The longest accepted step, s.
    pub longest_step: f64,
    /// Accepted steps that were extrapolated over a singular pose.
    pub leaps: u64,
    /// Singular poses that steps of fixed length have passed so closely that they may have continued on another branch
    /// than the motion does.
    pub passages: u64,
    /// The first of them.
    pub first_passage: Option<Passage>,
}

impl Statistics {
    /// All steps that were tried: kept or repeated.
    pub fn tried(&self) -> u64 {
        self.accepted + self.rejected
    }
}
