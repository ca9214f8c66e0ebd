//! Which settings a mechanism supports, and messages for those that it does not.

use crate::{Approach, Coordinates, Correction, Integrator, Settings};

/// What a mechanism, the engine that moves it and the inputs that are set allow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offers {
    /// Joint coordinates, and the closed-form correction by way of them.
    pub joint_space: bool,
    /// Derivatives, which implicit methods need.
    pub derivatives: bool,
    /// The projection in the metric of the masses.
    pub projection: bool,
    /// The distance from one to the next number of the run's precision.
    pub epsilon: f64,
    /// Whether an input changes during the run.
    pub inputs_vary: bool,
    /// Whether there are rigid stops or friction that sticks.
    pub touches: bool,
    /// The shortest period of the controllers, s; `None` without any.
    pub period: Option<f64>,
}

/// A tolerance beyond which nothing is asked for: an error as large as the motion.
const COARSEST: f64 = 1.0;

/// Solvers refuse tolerances that are finer than this many units in the last place of one.
const ULPS: f64 = 4.0;

impl Offers {
    /// All there is, in double precision and with constant inputs.
    pub const ALL: Self = Self {
        joint_space: true,
        derivatives: true,
        projection: true,
        epsilon: f64::EPSILON,
        inputs_vary: false,
        touches: false,
        period: None,
    };

    /// The finest tolerance that is accepted.
    pub fn finest_tolerance(&self) -> f64 {
        ULPS * self.epsilon
    }

    /// Why a run cannot be made as it is asked for; `None` if it can.
    pub fn refusal(&self, settings: &Settings, approach: &Approach) -> Option<String> {
        if let Err(impossible) = settings.check() {
            return Some(impossible.to_string());
        }
        if approach.budget == Some(0) {
            return Some("a budget of 0 steps leads nowhere".to_owned());
        }
        if let Some(period) = self.period
            && approach.tolerance.is_none()
            && settings.step > period * (1.0 + 1e-9)
        {
            return Some(format!(
                "steps of {:e} s are longer than the period of a controller, {period:e} s: choose a --step of it or of a part of \
                 it, or a --tolerance",
                settings.step
            ));
        }
        self.refused_tolerance(approach).or_else(|| self.refused_method(approach))
    }

    fn refused_tolerance(&self, approach: &Approach) -> Option<String> {
        let tolerance = approach.tolerance?;
        let finest = self.finest_tolerance();
        if !(finest..=COARSEST).contains(&tolerance) {
            return Some(format!(
                "a tolerance of {tolerance:e} cannot be met: it has to be between {finest:.1e}, the finest in this precision, and \
                 {COARSEST}"
            ));
        } else if approach.integrator.is_adaptive() {
            return None;
        };
        Some(format!(
            "{} has no error estimate: give it a --step instead of a --tolerance, or use {}",
            approach.integrator,
            listed(Integrator::is_adaptive)
        ))
    }

    /// Why a run cannot be made by its method, in its coordinates, with its correction.
    pub fn refused_method(&self, approach: &Approach) -> Option<String> {
        let words = match (approach.coordinates, approach.correction) {
            _ if self.touches && !self.joint_space => {
                "rigid contacts are for generated code: choose --engine in-process or generated"
            }
            (Coordinates::Maximal, _) if self.touches && approach.integrator.is_implicit() => {
                return Some(format!(
                    "{} takes rigid contacts in joint coordinates alone: choose --coordinates joint, or {}",
                    approach.integrator,
                    listed(|method| method.is_adaptive() && !method.is_implicit())
                ));
            }
            (Coordinates::Maximal, correction)
                if self.touches && !matches!(correction, Correction::Partition | Correction::None) =>
            {
                return Some(format!(
                    "with rigid contacts there is no correction {correction}: choose --correction partition or none"
                ));
            }
            (Coordinates::Joint, _) if !self.joint_space => {
                "joint coordinates are for generated code of mechanisms that have them"
            }
            (Coordinates::Maximal, Correction::ClosedForm) if !self.joint_space => {
                "the closed form is for generated code with joint coordinates"
            }
            (Coordinates::Maximal, Correction::MassWeighted | Correction::Baumgarte(_))
                if !self.projection =>
            {
                return Some(format!(
                    "the correction {} needs a projection, which this mechanism does not have",
                    approach.correction
                ));
            }
            (Coordinates::Maximal, Correction::Baumgarte(_)) if approach.integrator.is_implicit() => {
                return Some(format!(
                    "{} has the derivatives of a mechanism, not those of Baumgarte's stabilisation: choose another correction, \
                     or {}",
                    approach.integrator,
                    listed(|method| method.is_adaptive() && !method.is_implicit())
                ));
            }
            _ if approach.integrator.is_implicit() && !self.derivatives => {
                return Some(format!(
                    "{} needs derivatives, which only generated code has",
                    approach.integrator
                ));
            }
            _ => return None,
        };
        Some(words.to_owned())
    }
}

/// The names of some methods, as a choice: `a, b or c`.
pub fn listed(which: impl Fn(Integrator) -> bool) -> String {
    let names: Vec<_> =
        Integrator::ALL.iter().filter(|method| which(**method)).map(|method| method.name()).collect();
    match names.split_last() {
        Some((last, [])) => (*last).to_owned(),
        Some((last, before)) => format!("{} or {last}", before.join(", ")),
        None => String::new(),
    }
}

#[cfg(test)]
mod tests;
