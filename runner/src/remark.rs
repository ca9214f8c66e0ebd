//! Remarks on a completed run, and advice for a better one.

use crate::advice::{Advice, Change, Plan, rounded};
use crate::{Coordinates, Correction, Grade, Integrator, Judgement, Reason, Summary, When};

/// A sentence, and perhaps advice with what it promises.
#[derive(Clone, Debug, PartialEq)]
pub struct Remark {
    /// Without the advice.
    pub words: String,
    /// What to try.
    pub advice: Option<Advice>,
    /// What following it does.
    pub promise: Promise,
}

/// What is promised of advice, beyond that it is accepted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Promise {
    /// Nothing.
    None,
    /// The error is divided by this number at least.
    Error(f64),
    /// The violation is divided by this number at least.
    Violation(f64),
    /// Stability does not limit the steps any more.
    Stability,
}

/// Violations that deserve a word: larger ones than this, and than so many units in the last place.
const VISIBLE_VIOLATION: f64 = 1e-9;
const VIOLATION_ULPS: f64 = 1e3;

/// A tolerance under which errors add up to more than this times itself is not a measure of them.
const ADDED_UP: f64 = 1e4;

/// What relative error better steps aim at, and by how much they are shortened.
const AIM: f64 = 2e-4;
const SHORTER: [f64; 2] = [2.0, 8.0];

/// A result of which less than this part is wrong changes with the step as theory says.
const SMOOTH: f64 = 0.1;

/// Rounding adds up like the root of the number of steps, so many units in the last place in each.
const ROUNDING_ULPS: f64 = 100.0;

/// Steps at the limit of stability: of the fastest rate and the step, the product is larger than this for every method.
const AT_LIMIT: f64 = 1.0;

/// A share of steps at that limit which deserves a word, and the finest tolerance at which a method of order 4 is worth
/// a try.
const STIFF_SHARE: f64 = 0.25;
const ORDER_FOUR: f64 = 1e-6;

impl Remark {
    fn words(words: String) -> Self {
        Self { words, advice: None, promise: Promise::None }
    }
}

impl std::fmt::Display for Remark {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&self.words)?;
        match &self.advice {
            Some(advice) => write!(f, " Try {advice}."),
            None => Ok(()),
        }
    }
}

impl Plan<'_> {
    /// What is to be said of a run and its judgement; `fastest` is the fastest rate of the linearised motion, 1/s,
    /// where it is known.
    pub fn remarks(&self, judged: &Judgement, summary: &Summary, fastest: Option<f64>) -> Vec<Remark> {
        let said = [
            self.on_errors(judged, summary),
            self.on_stability(summary, fastest),
            on_rejections(summary),
            self.on_violation(judged, summary),
        ];
        let mut remarks: Vec<Remark> = said.into_iter().flatten().collect();
        remarks.extend(judged.reasons.iter().filter_map(|reason| self.on_reason(reason)));
        remarks.into_iter().map(|remark| self.accepted(remark)).collect()
    }

    /// Without advice that would be refused.
    fn accepted(&self, remark: Remark) -> Remark {
        let is_refused = remark.advice.as_ref().is_some_and(|advice| !self.accepts(advice));
        if is_refused { Remark::words(remark.words) } else { remark }
    }

    fn on_errors(&self, judged: &Judgement, summary: &Summary) -> Option<Remark> {
        match self.approach.tolerance {
            Some(tolerance) => Some(self.on_tolerance(tolerance, judged)),
            None if judged.relative <= AIM => None,
            None => self.on_step(judged, summary),
        }
    }

    fn on_tolerance(&self, tolerance: f64, judged: &Judgement) -> Remark {
        let times = judged.in_tolerances;
        if !judged.reasons.iter().any(|reason| matches!(reason, Reason::Tolerance(_))) {
            return Remark::words(format!("The errors are within ten times the tolerance of {tolerance:e}."));
        }
        let words = format!("Errors have added up to {times:.1e} times the tolerance.");
        let finer = rounded(tolerance / times);
        let (change, promise) = if times <= ADDED_UP && finer >= self.finest() {
            (
                Change::Tolerance(finer),
                if judged.relative <= SMOOTH { Promise::Error(2.0) } else { Promise::None },
            )
        } else if self.is_single() {
            (Change::DoublePrecision, Promise::None)
        } else if times <= ADDED_UP {
            return Remark::words(format!(
                "{words} Rounding leaves room for no finer tolerance over this run."
            ));
        } else {
            return Remark::words(format!(
                "{words} The motion multiplies errors, or a finer one leads elsewhere."
            ));
        };
        Remark { words, advice: Some(Advice::to(change)), promise }
    }

    /// Shorter steps as far as rounding lets them help.
    fn on_step(&self, judged: &Judgement, summary: &Summary) -> Option<Remark> {
        #[expect(clippy::cast_precision_loss, reason = "a number of steps")]
        let rounding = ROUNDING_ULPS * self.offers.epsilon * (summary.steps as f64).sqrt();
        if judged.relative <= rounding {
            let advice = self.is_single().then(|| Advice::to(Change::DoublePrecision));
            let words = "What is left of the error is rounding.".to_owned();
            return Some(Remark { words, advice, promise: Promise::None });
        }
        let order = if self.offers.inputs_vary { 1.0 } else { f64::from(self.approach.integrator.order()) };
        let factor = (judged.relative / AIM).powf(1.0 / order).clamp(SHORTER[0], SHORTER[1]);
        // Shorter steps round more often, and small motions beside large ones are rounded with these.
        let largest = judged.errors.iter().map(|error| error.in_tolerances(1.0)).fold(0.0, f64::max);
        let is_passed =
            judged.reasons.iter().any(|reason| matches!(reason, Reason::Pivot(_) | Reason::Passage(_)));
        // Corrections at a limit of the violation come at other times in other steps.
        let has_limit = matches!(self.approach.when, Some(When::Violation(_)));
        let is_smooth = judged.relative <= SMOOTH
            && !has_limit
            && judged.grade < Grade::Worthless
            && judged.relative.min(largest) > 30.0 * rounding
            && !is_passed
            && !self.is_single();
        let promise = if is_smooth { Promise::Error(factor) } else { Promise::None };
        let words = match promise {
            Promise::Error(_) => format!("Shorter steps should divide the error by {factor:.1} at least."),
            _ => "Shorter steps may be better; by how much cannot be said.".to_owned(),
        };
        Some(Remark { words, advice: Some(self.step_over(factor)), promise })
    }

    fn on_stability(&self, summary: &Summary, fastest: Option<f64>) -> Option<Remark> {
        let met = &summary.statistics;
        let tolerance = self.approach.tolerance?;
        #[expect(clippy::cast_precision_loss, reason = "a share")]
        let (share, mean) = (
            met.limited_by_stability as f64 / met.accepted.max(1) as f64,
            self.settings.t_end / met.accepted.max(1) as f64,
        );
        // The rates that steps have met may be rounding's: those of the linearised motion are not, and steps at a true
        // limit are rejected.
        let is_true = match fastest {
            Some(rate) => rate * mean > AT_LIMIT,
            None => 50 * met.rejected > met.accepted,
        };
        if share <= STIFF_SHARE || !is_true || self.approach.integrator.is_implicit() {
            return None;
        }
        let words = format!(
            "{:.0} % of the steps were as long as stability allows {}, not accuracy: the scene is stiff for it.",
            100.0 * share,
            self.approach.integrator
        );
        let advice = (tolerance >= ORDER_FOUR).then(|| Advice::to(Change::Integrator(Integrator::Rodas4)));
        Some(Remark { words, advice, promise: Promise::Stability })
    }

    fn on_reason(&self, reason: &Reason) -> Option<Remark> {
        let words = match reason {
            Reason::Energy(_) | Reason::Violation(_) => in_words(reason),
            Reason::Passage(_) => {
                let advice = self.over_poses();
                return Some(Remark { words: in_words(reason), advice, promise: Promise::None });
            }
            Reason::Work(drift) => format!(
                "The energy balance is open by {drift:.1e} of the energy that moves, though the motion is right: work and powers cannot \
                 be trusted."
            ),
            Reason::Pivot(pivot) => format!(
                "The smallest pivot of the constraints was {pivot:.1e}: the mechanism has come near a singular pose, from which it may \
                 go on in more than one way."
            ),
            Reason::End(_) => in_words(reason),
            Reason::Error(_) | Reason::Tolerance(_) => return None,
        };
        Some(Remark::words(words))
    }

    /// Only what has corrections can be corrected more often, and only a motion that is there is worth it.
    fn on_violation(&self, judged: &Judgement, summary: &Summary) -> Option<Remark> {
        let violation = summary.position_violation;
        let visible = VISIBLE_VIOLATION.max(VIOLATION_ULPS * self.offers.epsilon);
        if violation <= visible || self.approach.coordinates == Coordinates::Joint {
            return None;
        }
        let words = format!("Constraints were violated by up to {violation:.1e} of the mechanism's size.");
        if judged.relative > SMOOTH {
            return Some(Remark::words(words));
        }
        let often = Change::When(When::Steps(1));
        let changes = match (self.approach.correction, self.approach.when) {
            (Correction::None | Correction::Baumgarte(_), _) => {
                vec![Change::Correction(Correction::Partition), often]
            }
            (_, Some(When::Steps(1))) => Vec::new(),
            (_, None) if self.approach.tolerance.is_some() => Vec::new(),
            _ => vec![often],
        };
        let advice = (!changes.is_empty()).then_some(Advice { changes });
        Some(Remark { words, advice, promise: Promise::Violation(2.0) })
    }
}

fn on_rejections(summary: &Summary) -> Option<Remark> {
    let met = &summary.statistics;
    (met.rejected > met.accepted / 2 && met.rejected > 10).then(|| {
        Remark::words(format!(
            "{} steps were rejected for {} accepted: something in the motion is not smooth.",
            met.rejected, met.accepted
        ))
    })
}

/// A reason that a run itself tells.
pub(crate) fn in_words(reason: &Reason) -> String {
    match reason {
        Reason::Energy(drift) => {
            format!("The energy balance is open by {drift:.1e} of the energy that moves.")
        }
        Reason::Violation(violation) => {
            format!("The joints come apart by {violation:.1e} of the mechanism's size.")
        }
        Reason::Error(share) => format!("A coordinate is off by {share:.1e} times its motion."),
        Reason::Tolerance(times) => format!("The errors are {times:.1e} times the tolerance."),
        Reason::Work(drift) => format!("The work is off by {drift:.1e} of the energy that moves."),
        Reason::Pivot(pivot) => format!("The smallest pivot is {pivot:.1e}."),
        Reason::End([run, other]) => format!(
            "An event ends the run at t = {run:.6e} s, and the run that it is compared with ends at t = {other:.6e} s."
        ),
        Reason::Passage(passage) => format!(
            "At t = {:.4} s steps of fixed length have passed a singular pose, from which the mechanism may have gone on in another way.",
            passage.t
        ),
    }
}

impl std::fmt::Display for Reason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(&in_words(self))
    }
}
