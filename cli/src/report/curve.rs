//! What is compared: who computes, by which integrator, in which coordinates, with which correction and in which
//! precision.

use crate::args::Precision;
use gyro_runner::{Approach, Coordinates, Correction, Integrator, When};
use gyro_sim::Statistics;

/// One line of a work-precision diagram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Curve {
    pub(crate) engine: Engine,
    pub(crate) precision: Precision,
    pub(crate) integrator: Integrator,
    pub(crate) treatment: Treatment,
}

/// In which coordinates, and how constraints are kept; corrections are made after every step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Treatment {
    Joint,
    Maximal(Correction),
}

/// How fine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Setting {
    Tolerance(f64),
    /// So many equal steps.
    Steps(u64),
}

/// A run that was tried.
#[derive(Clone, Debug)]
pub(crate) struct Point {
    pub(crate) curve: Curve,
    pub(crate) setting: Setting,
    pub(crate) outcome: Result<Outcome, String>,
}

/// What a run has come to.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outcome {
    /// The error that the diagrams show.
    pub(crate) error: f64,
    /// Of each coordinate.
    pub(crate) errors: Vec<f64>,
    /// Time of the processor as it was measured, s.
    pub(crate) measured: f64,
    /// The same as it would have been had the machine been as quick as it was most of the time: the ratio in terms of
    /// the hand-derived second's median.
    pub(crate) seconds: f64,
    /// The same over that of the hand-derived second.
    pub(crate) ratio: f64,
    pub(crate) statistics: Statistics,
    pub(crate) position_violation: f64,
    pub(crate) velocity_violation: f64,
    pub(crate) energy_drift: f64,
}

impl Treatment {
    pub(crate) fn name(self) -> String {
        match self {
            Self::Joint => "joint coordinates".to_owned(),
            Self::Maximal(Correction::None) => "maximal, no correction".to_owned(),
            Self::Maximal(Correction::Baumgarte(rate)) => {
                format!("maximal, Baumgarte {}/s", crate::words::number(rate, 3))
            }
            Self::Maximal(Correction::MassWeighted) => "maximal, mass-weighted".to_owned(),
            Self::Maximal(Correction::ClosedForm) => "maximal, closed form".to_owned(),
            Self::Maximal(Correction::Partition) => "maximal, partition".to_owned(),
        }
    }

    /// Whether every step ends on the constraints.
    pub(crate) fn is_corrected(self) -> bool {
        matches!(
            self,
            Self::Maximal(Correction::Partition | Correction::ClosedForm | Correction::MassWeighted)
        )
    }
}

impl Curve {
    pub(crate) fn name(&self) -> String {
        format!(
            "{}, {}, {}, {}",
            who(self.engine),
            self.precision.name(),
            self.integrator,
            self.treatment.name()
        )
    }

    /// Whether they differ in the integrator at most.
    pub(crate) fn is_like(&self, other: &Self) -> bool {
        (self.engine, self.precision, self.treatment) == (other.engine, other.precision, other.treatment)
    }

    pub(crate) fn approach(&self, setting: Setting, budget: u64) -> Approach {
        let (coordinates, correction) = match self.treatment {
            Treatment::Joint => (Coordinates::Joint, Correction::None),
            Treatment::Maximal(correction) => (Coordinates::Maximal, correction),
        };
        let tolerance = match setting {
            Setting::Tolerance(tolerance) => Some(tolerance),
            Setting::Steps(_) => None,
        };
        let when = Some(When::Steps(1));
        // Fixed steps are as many as they are.
        let budget = tolerance.map(|_| budget);
        Approach {
            integrator: self.integrator,
            tolerance,
            coordinates,
            correction,
            when,
            budget,
            patience: None,
            examine: false,
            leaves_stiff: false,
            meets_knots: false,
        }
    }
}

impl Setting {
    pub(crate) fn name(self, t_end: f64) -> String {
        match self {
            Self::Tolerance(tolerance) => format!("tolerance {}", crate::words::number(tolerance, 2)),
            Self::Steps(n) => format!("step {} s", crate::words::number(t_end / n as f64, 3)),
        }
    }
}

/// What is measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Engine {
    /// Generated code, compiled by rustc.
    Generated,
    /// The runtime-assembled model as a recursion in joint coordinates.
    Recursive,
    /// The same in its careful form.
    Careful,
    /// The same in the paper's dense form.
    Dense,
}

/// An engine as the report calls it.
pub(crate) fn who(engine: Engine) -> &'static str {
    match engine {
        Engine::Generated => "generated",
        Engine::Recursive => "assembled, recursive",
        Engine::Careful => "assembled, careful",
        Engine::Dense => "assembled, dense",
    }
}

impl Outcome {
    /// Evaluations of the right-hand side; a Jacobian is counted as one.
    pub(crate) fn evaluations(&self) -> f64 {
        (self.statistics.work.evaluations + self.statistics.work.jacobians) as f64
    }
}
