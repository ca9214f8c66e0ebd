//! What to try instead: changes of a run's options that can be followed as they stand.
//!
//! Advice is a value, not a sentence: it prints as the options of the command line, and it can be followed by a program
//! ([`Advice::follow`]). None is given that the run's mechanism, engine and precision would refuse.

use crate::{Approach, Coordinates, Correction, Integrator, Offers, Schedule, Settings, When};
use gyro_sim::{Error, Statistics};
use std::fmt;

/// One option to change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Change {
    /// Another step, s.
    Step(f64),
    /// Another interval between corrections, s.
    CorrectEvery(f64),
    /// Another tolerance.
    Tolerance(f64),
    /// Another integrator.
    Integrator(Integrator),
    /// Another correction.
    Correction(Correction),
    /// Other moments of correction.
    When(When),
    /// Joint coordinates.
    Coordinates(Coordinates),
    /// More steps.
    Budget(u64),
    /// Double precision.
    DoublePrecision,
}

/// Changes that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Advice {
    /// All of them are to be made at once.
    pub changes: Vec<Change>,
}

/// A run as it was asked for, and what could have been asked for.
#[derive(Clone, Copy, Debug)]
pub struct Plan<'a> {
    /// When to step, correct and sample.
    pub settings: &'a Settings,
    /// By which method.
    pub approach: &'a Approach,
    /// What the mechanism allows.
    pub offers: &'a Offers,
}

impl Change {
    /// The option of the command line and its value.
    pub fn flags(&self) -> [String; 2] {
        let (flag, value) = match self {
            Self::Step(step) => ("--step", format!("{step:e}")),
            Self::CorrectEvery(every) => ("--correct-every", format!("{every:e}")),
            Self::Tolerance(tolerance) => ("--tolerance", format!("{tolerance:e}")),
            Self::Integrator(integrator) => ("--integrator", integrator.to_string()),
            Self::Correction(correction) => ("--correction", correction.to_string()),
            Self::When(when) => ("--correct-when", when.to_string()),
            Self::Coordinates(coordinates) => ("--coordinates", coordinates.to_string()),
            Self::Budget(steps) => ("--budget", steps.to_string()),
            Self::DoublePrecision => ("--precision", "f64".to_owned()),
        };
        [flag.to_owned(), value]
    }
}

impl Advice {
    /// A single change.
    pub fn to(change: Change) -> Self {
        Self { changes: vec![change] }
    }

    /// The options of the command line, each followed by its value.
    pub fn flags(&self) -> Vec<String> {
        self.changes.iter().flat_map(Change::flags).collect()
    }

    /// Whether the run is to be made in double precision from now on.
    pub fn is_of_precision(&self) -> bool {
        self.changes.contains(&Change::DoublePrecision)
    }

    /// The run with these changes; the precision is the caller's.
    pub fn follow(&self, settings: &Settings, approach: &Approach) -> (Settings, Approach) {
        let (mut settings, mut approach) = (*settings, *approach);
        for change in &self.changes {
            match *change {
                Change::Step(step) => settings.step = step,
                Change::CorrectEvery(every) => settings.correct_every = Some(every),
                Change::Tolerance(tolerance) => approach.tolerance = Some(tolerance),
                Change::Integrator(integrator) => approach.integrator = integrator,
                Change::Correction(correction) => approach.correction = correction,
                Change::When(when) => approach.when = Some(when),
                Change::Coordinates(coordinates) => approach.coordinates = coordinates,
                Change::Budget(steps) => approach.budget = Some(steps),
                Change::DoublePrecision => (),
            }
        }
        (settings, approach)
    }
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.flags().join(" "))
    }
}

/// `; try this, or that`; nothing where there is no advice.
pub(crate) fn try_words(advice: &[Advice]) -> String {
    let words: Vec<String> = advice.iter().map(Advice::to_string).collect();
    if words.is_empty() { String::new() } else { format!("; try {}", words.join(", or ")) }
}

/// By how much a step is shortened that was far too long.
const SHORTER: f64 = 8.0;

/// By how much a tolerance is changed that cannot be met, or that leads astray.
const COARSER: f64 = 100.0;

/// A tolerance beyond this promises nothing.
const COARSEST: f64 = 1e-3;

/// A tolerance of so many units in the last place is as fine as rounding of a long run allows.
const FINEST_ULPS: f64 = 100.0;

/// A tolerance at which singular poses are passed.
const PASSING: f64 = 1e-9;

/// More steps than this take too long to be advised.
const MOST_STEPS: f64 = 1e10;

/// A budget that would have to be this many times larger is not the way.
const SPARE: f64 = 1.5;

/// A share of steps at the limit of stability from which on a scene is stiff for a method.
const STIFF_SHARE: f64 = 0.25;

/// Of a rate and a step, a product that asks for no shorter step.
const SLOW: f64 = 1e-2;

/// A rate of the linearised motion that is less than this part of the fastest one met does not explain it.
const TRUE_SHARE: f64 = 0.1;

impl Plan<'_> {
    /// Whether a run that follows advice would not be refused.
    pub fn accepts(&self, advice: &Advice) -> bool {
        let (settings, approach) = advice.follow(self.settings, self.approach);
        let epsilon = if advice.is_of_precision() { f64::EPSILON } else { self.offers.epsilon };
        Offers { epsilon, ..*self.offers }.refusal(&settings, &approach).is_none()
    }

    /// Whether there is a correction whose moments the schedule has.
    fn is_scheduled(&self) -> bool {
        self.approach.tolerance.is_none() && self.approach.when.is_none() && self.is_corrected()
    }

    fn is_corrected(&self) -> bool {
        self.approach.coordinates == Coordinates::Maximal
            && !matches!(self.approach.correction, Correction::None | Correction::Baumgarte(_))
    }

    pub(crate) fn is_single(&self) -> bool {
        self.offers.epsilon > f64::EPSILON
    }

    /// The finest tolerance that can be advised.
    pub fn finest(&self) -> f64 {
        FINEST_ULPS * self.offers.epsilon
    }

    /// The longest step that can be taken: the one asked for, or an interval between events that it is cut off at.
    fn longest_step(&self) -> f64 {
        let Settings { t_end, step, correct_every, sample_every } = *self.settings;
        let every = correct_every.filter(|_| self.is_scheduled()).unwrap_or(f64::INFINITY);
        step.min(sample_every).min(every).min(t_end)
    }

    /// This part of the longest step, and of the interval between corrections where there are more of them than steps.
    pub fn step_over(&self, factor: f64) -> Advice {
        let step = rounded(self.longest_step() / factor);
        let mut changes = vec![Change::Step(step)];
        if let (true, Some(every)) = (self.is_scheduled(), self.settings.correct_every) {
            changes.push(Change::CorrectEvery(rounded(every / factor).max(step)));
        }
        Advice { changes }
    }

    /// A finer tolerance, where that can be met.
    fn finer(&self) -> Option<Advice> {
        let tolerance = rounded(self.approach.tolerance? / COARSER);
        (tolerance >= self.finest()).then(|| Advice::to(Change::Tolerance(tolerance)))
    }

    fn coarser(&self) -> Option<Advice> {
        let tolerance = rounded(self.approach.tolerance? * COARSER);
        (tolerance <= COARSEST).then(|| Advice::to(Change::Tolerance(tolerance)))
    }

    fn double(&self) -> Option<Advice> {
        self.is_single().then(|| Advice::to(Change::DoublePrecision))
    }

    /// What to try where stability limits the steps. The fastest rate that they have met may be that at which Euler
    /// parameters turn, or rounding's: the linearised motion in joint coordinates, where there is one, tells.
    fn unlimited(&self, met: &Statistics, fastest: Option<f64>) -> Option<Advice> {
        let is_of_motion = fastest.is_none_or(|rate| rate > TRUE_SHARE * met.fastest_rate);
        if is_of_motion {
            let can = self.offers.derivatives && !self.approach.integrator.is_implicit();
            return can.then(|| Advice::to(Change::Integrator(Integrator::Rodas4)));
        }
        self.joint()
    }

    fn joint(&self) -> Option<Advice> {
        let can = self.offers.joint_space && self.approach.coordinates == Coordinates::Maximal;
        can.then(|| Advice::to(Change::Coordinates(Coordinates::Joint)))
    }

    /// What to try after an error; `fastest` is the fastest rate of the linearised motion there, 1/s, where it is
    /// known.
    pub fn after(&self, error: &Error, met: &Statistics, fastest: Option<f64>) -> Vec<Advice> {
        let advice: Vec<Advice> = match *error {
            Error::NotFinite { .. } if self.approach.tolerance.is_some() => {
                self.double().into_iter().collect()
            }
            Error::NotFinite { t, .. } => {
                self.past(t).into_iter().chain(self.over_poses().filter(|_| t > 0.0)).collect()
            }
            Error::NoConvergence { t, .. } => self.past(t),
            Error::Singular { t, .. } | Error::Jump { t, .. } => {
                let over = self.over_poses().filter(|over| t > 0.0 && self.accepts(over));
                over.map_or_else(|| self.past(t), |over| vec![over])
            }
            Error::StepTooShort { .. } => self.double().or_else(|| self.coarser()).into_iter().collect(),
            Error::TooManySteps { t, steps } => self.beyond(t, steps, met, fastest),
            Error::Stiff { t, .. } => self.beyond(t, met.accepted + met.rejected, met, fastest),
            Error::Setting { .. } | Error::InvalidEndTime { .. } | Error::Tolerance { .. } => Vec::new(),
        };
        advice.into_iter().filter(|advice| self.accepts(advice)).collect()
    }

    /// Smaller steps, as far as they say anything: what fails at the start fails in any steps.
    fn past(&self, t: f64) -> Vec<Advice> {
        match self.approach.tolerance {
            None if t > 0.0 => vec![self.step_over(SHORTER)],
            Some(_) if t > 0.0 => self.double().or_else(|| self.finer()).into_iter().collect(),
            _ => Vec::new(),
        }
    }

    /// Steps that end elsewhere. Shorter steps of a schedule end at its samples and corrections again, where the ends
    /// of a link may meet; those of error control do not.
    ///
    /// Error control looks ahead for singular poses and steps over them, and corrections keep drift from hiding which
    /// way goes on. A pose that is not passed at one tolerance may be at another, where steps end elsewhere.
    pub(crate) fn over_poses(&self) -> Option<Advice> {
        let is_controlled = self.approach.tolerance.is_some() && self.is_corrected();
        let changes = [
            Change::Integrator(Integrator::Dop853),
            Change::Tolerance(PASSING.max(rounded(self.finest()))),
            Change::Correction(Correction::Partition),
        ];
        (!is_controlled).then(|| Advice { changes: changes.into() })
    }

    /// Steps that would do at the pace so far, or another way.
    fn beyond(&self, t: f64, steps: u64, met: &Statistics, fastest: Option<f64>) -> Vec<Advice> {
        #[expect(clippy::cast_precision_loss, reason = "steps that were counted")]
        let needed = match self.approach.tolerance {
            None => Schedule::steps(self.settings),
            Some(_) => (SPARE * steps as f64 * self.settings.t_end / t).ceil(),
        };
        let mut advice = Vec::new();
        #[expect(clippy::cast_precision_loss, reason = "a share")]
        let share = met.limited_by_stability as f64 / met.accepted.max(1) as f64;
        if share > STIFF_SHARE {
            advice.extend(self.unlimited(met, fastest));
        } else if fastest.is_some_and(|rate| rate * t < SLOW * steps as f64) && needed > MOST_STEPS {
            // Steps follow Euler parameters that turn, not the joints.
            advice.extend(self.joint());
        }
        if needed <= MOST_STEPS {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 1e10")]
            advice.push(Advice::to(Change::Budget(needed as u64)));
        } else {
            advice.extend(self.coarser());
        }
        advice
    }
}

/// Two digits are enough for advice; never more than the number itself.
pub(crate) fn rounded(x: f64) -> f64 {
    let near: f64 = format!("{x:.1e}").parse().unwrap_or(x);
    if near <= x { near } else { format!("{:.1e}", 0.95 * x).parse().unwrap_or(x) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is advised is shorter than the steps that were taken: samples and corrections had cut them.
    #[test]
    fn advice_does_not_repeat_the_steps_that_failed() {
        let (approach, offers) = (Approach::default(), Offers::ALL);
        for (step, correct_every, sample_every) in
            [(1.0, None, 0.01), (1.0, Some(0.01), 0.1), (0.01, Some(0.5), 0.1)]
        {
            let settings = Settings { t_end: 1.0, step, correct_every, sample_every };
            let plan = Plan { settings: &settings, approach: &approach, offers: &offers };
            let advice = plan.after(&Error::NotFinite { t: 0.5, index: 0 }, &Statistics::default(), None);
            let (followed, _) = advice.first().expect("shorter steps").follow(&settings, &approach);
            assert_eq!(followed.step, rounded(0.01 / SHORTER), "{settings:?}");
            assert!(Schedule::steps(&followed) >= SHORTER * Schedule::steps(&settings), "{settings:?}");
            // Shorter steps end at the same samples: where these are what fails, others are to be tried.
            assert!(advice[1].changes.contains(&Change::Integrator(Integrator::Dop853)), "{settings:?}");
        }
    }
}
