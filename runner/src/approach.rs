//! Which integrator, in which coordinates, with which correction.

pub use gyro_sim::integrate::Integrator;
use nanoserde::{DeBin, SerBin};
use std::fmt;
use std::str::FromStr;

/// How a motion is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, SerBin, DeBin)]
pub struct Approach {
    /// The method.
    pub integrator: Integrator,
    /// Error tolerated in each step, relative and absolute alike; with `None` the steps have a fixed length.
    pub tolerance: Option<f64>,
    /// What is integrated.
    pub coordinates: Coordinates,
    /// How constraints are kept.
    pub correction: Correction,
    /// When; `None` stands for the interval of the [`Settings`](crate::Settings) at fixed steps and for every step
    /// under error control.
    pub when: Option<When>,
    /// Steps after which the run is given up; `None` for the solver's own under error control, and for any number of
    /// fixed steps.
    pub budget: Option<u64>,
    /// Seconds that fixed steps may take by their forecast; without a budget a longer run is refused. `None` for any
    /// time.
    pub patience: Option<f64>,
    /// Whether pivots are to be looked at, and the motion to be linearised about where it ends.
    pub examine: bool,
    /// Whether a run by an explicit method ends where it turns out to be stiff, and says so
    /// ([`Event::Stiff`](crate::Event::Stiff)), so that it can be made by another method.
    pub leaves_stiff: bool,
    /// Whether steps of fixed length end at the knots of inputs and of motions, with each input as it is in the middle
    /// of a step: for companions, which see what other steps may step over.
    pub meets_knots: bool,
}

/// What is integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, SerBin, DeBin)]
pub enum Coordinates {
    /// Positions and Euler parameters of all bodies, the paper's.
    #[default]
    Maximal,
    /// Joint coordinates and their rates: generated code only, of mechanisms that have them.
    Joint,
}

/// How constraints are kept.
#[derive(Clone, Copy, Debug, Default, PartialEq, SerBin, DeBin)]
pub enum Correction {
    /// The paper's coordinate partitioning.
    #[default]
    Partition,
    /// To joint coordinates and back.
    ClosedForm,
    /// The smallest change as the masses weigh it.
    MassWeighted,
    /// Baumgarte's stabilisation at this rate, 1/s: in the accelerations, so at all times.
    Baumgarte(f64),
    /// Not at all: direct integration.
    None,
}

/// When to correct.
#[derive(Clone, Copy, Debug, PartialEq, SerBin, DeBin)]
pub enum When {
    /// After so many steps.
    Steps(u32),
    /// After each step that leaves a larger violation, lengths in units of the mechanism's size.
    Violation(f64),
}

impl Coordinates {
    /// Both.
    pub const ALL: &'static [Self] = &[Self::Maximal, Self::Joint];

    /// Their name on the command line and in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Maximal => "maximal",
            Self::Joint => "joint",
        }
    }
}

impl fmt::Display for Coordinates {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for Coordinates {
    type Err = ();

    fn from_str(name: &str) -> Result<Self, ()> {
        Self::ALL.iter().copied().find(|one| one.name() == name).ok_or(())
    }
}

impl fmt::Display for Correction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Partition => f.write_str("partition"),
            Self::ClosedForm => f.write_str("closed-form"),
            Self::MassWeighted => f.write_str("mass-weighted"),
            Self::Baumgarte(rate) => write!(f, "baumgarte={rate:?}"),
            Self::None => f.write_str("none"),
        }
    }
}

impl FromStr for Correction {
    type Err = ();

    fn from_str(name: &str) -> Result<Self, ()> {
        Ok(match name {
            "partition" => Self::Partition,
            "closed-form" => Self::ClosedForm,
            "mass-weighted" => Self::MassWeighted,
            "none" => Self::None,
            _ => match name.strip_prefix("baumgarte=").and_then(|rate| rate.parse().ok()) {
                Some(rate) if rate > 0.0 && f64::is_finite(rate) => Self::Baumgarte(rate),
                _ => return Err(()),
            },
        })
    }
}

impl fmt::Display for When {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Steps(steps) => write!(f, "steps={steps}"),
            Self::Violation(limit) => write!(f, "violation={limit:?}"),
        }
    }
}

impl FromStr for When {
    type Err = ();

    fn from_str(text: &str) -> Result<Self, ()> {
        match text.split_once('=').ok_or(())? {
            ("steps", steps) => steps.parse().ok().filter(|&steps| steps > 0).map(Self::Steps).ok_or(()),
            ("violation", limit) => match limit.parse() {
                Ok(limit) if limit > 0.0 && f64::is_finite(limit) => Ok(Self::Violation(limit)),
                _ => Err(()),
            },
            _ => Err(()),
        }
    }
}

impl From<When> for gyro_sim::When {
    fn from(when: When) -> Self {
        match when {
            When::Steps(steps) => Self::Steps(steps),
            When::Violation(limit) => Self::Violation(limit),
        }
    }
}

impl fmt::Display for Approach {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}, {} coordinates", self.integrator, self.coordinates)?;
        if self.coordinates == Coordinates::Maximal {
            write!(f, ", correction {}", self.correction)?;
            if let Some(when) = self.when {
                write!(f, " at {when}")?;
            }
        }
        match self.tolerance {
            Some(tolerance) => write!(f, ", tolerance {tolerance:e}"),
            None => Ok(()),
        }
    }
}

#[cfg(test)]
mod tests;
