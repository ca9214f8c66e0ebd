//! The runs behind the work-precision diagrams.

use super::curve::{Curve, Point, Setting, Treatment};
use super::lab::Lab;
use super::truth::Truth;
use crate::args::Precision;
use crate::report::curve::Engine;
use gyro_assembled::{Careful, Recursive};
use gyro_runner::{Correction, Integrator};

/// How much is tried.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Tolerances in each decade.
    pub(crate) per_decade: u32,
    /// Fixed steps are divided by two this often between one and the next but one: two settings for each halving, or
    /// one.
    pub(crate) halvings: Halvings,
    /// A curve ends where a run takes longer, s.
    pub(crate) longest_run: f64,
    /// Time for which a run is repeated, s.
    pub(crate) measure_for: f64,
}

impl Effort {
    /// Of the paper's scene in a full report.
    pub(crate) const FINE: Self =
        Self { per_decade: 2, halvings: Halvings::AndBetween, longest_run: 0.2, measure_for: 0.02 };

    /// Of other scenes in a full report.
    pub(crate) const COARSE: Self =
        Self { per_decade: 1, halvings: Halvings::Each, longest_run: 0.05, measure_for: 0.006 };

    /// Of any scene in a quick report.
    pub(crate) const SPARSE: Self =
        Self { per_decade: 1, halvings: Halvings::EveryOther, longest_run: 0.02, measure_for: 0.005 };
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Halvings {
    /// Every halving.
    Each,
    /// And one between two.
    AndBetween,
    /// Every other.
    EveryOther,
}

/// Every integrator × correction × coordinates × precision that is possible, and the runtime-assembled models.
pub(crate) fn curves(lab: &Lab) -> Vec<Curve> {
    let mut curves = Vec::new();
    for precision in [Precision::F64, Precision::F32] {
        for treatment in treatments(lab) {
            let implicit = |one: &Integrator| *one == Integrator::Rodas4;
            for &integrator in Integrator::ALL.iter().filter(|one| !(lab.touches() && implicit(one))) {
                curves.push(Curve { engine: Engine::Generated, precision, integrator, treatment });
            }
        }
    }
    let treatment = Treatment::Maximal(Correction::Partition);
    for engine in assembled_forms(lab) {
        for &integrator in Integrator::ALL.iter().filter(|one| **one != Integrator::Rodas4) {
            curves.push(Curve { engine, precision: Precision::F64, integrator, treatment });
        }
    }
    curves
}

/// What generated code of a model can be integrated in.
pub(crate) fn treatments(lab: &Lab) -> Vec<Treatment> {
    // Fast enough for the run, slow for its steps.
    let rate = crate::words::number(50.0 / lab.t_end, 1).parse().unwrap_or(50.0);
    let mut treatments = Vec::new();
    if lab.has_joint_coordinates() {
        treatments.push(Treatment::Joint);
    }
    if lab.touches() {
        return treatments;
    }
    treatments.push(Treatment::Maximal(Correction::Partition));
    if lab.has_joint_coordinates() {
        treatments.push(Treatment::Maximal(Correction::ClosedForm));
    }
    treatments.extend(
        [Correction::MassWeighted, Correction::Baumgarte(rate), Correction::None].map(Treatment::Maximal),
    );
    treatments
}

/// The forms of the runtime-assembled model that a model can have.
pub(crate) fn assembled_forms(lab: &Lab) -> Vec<Engine> {
    let mut assembled_forms = Vec::new();
    if lab.touches() {
        return assembled_forms;
    }
    if Recursive::<f64>::new(&lab.model).is_ok() {
        assembled_forms.push(Engine::Recursive);
    }
    if Careful::<f64>::supports(&lab.model).is_ok() {
        assembled_forms.push(Engine::Careful);
    }
    assembled_forms.push(Engine::Dense);
    assembled_forms
}

/// All points of a curve, by tolerance and by fixed step, from coarse to fine until runs take too long or rounding is
/// reached.
pub(crate) fn explore(lab: &mut Lab, truth: &Truth, curve: &Curve, effort: &Effort) -> Vec<Point> {
    let mut points = Vec::new();
    if curve.integrator != Integrator::Rk4 {
        let ladder = tolerances(curve.precision, effort.per_decade);
        points.extend(descend(lab, truth, curve, effort, ladder.into_iter().map(Setting::Tolerance)));
    }
    let ladder = steps(effort.halvings).map(Setting::Steps);
    points.extend(descend(lab, truth, curve, effort, ladder));
    points
}

fn tolerances(precision: Precision, per_decade: u32) -> Vec<f64> {
    let finest = match precision {
        Precision::F64 => -13,
        Precision::F32 => -6,
    };
    let n = (finest + 3_i32).unsigned_abs() * per_decade;
    (0..=n).map(|k| 10f64.powf(-3.0 - f64::from(k) / f64::from(per_decade))).map(rounded).collect()
}

/// To two digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.1e}").parse().unwrap_or(value)
}

/// Numbers of steps, from 25 on, that have a quarter of the sample times at least in common with them.
fn steps(halvings: Halvings) -> impl Iterator<Item = u64> {
    (0..21_u32).flat_map(move |k| {
        let whole = 25_u64 << k;
        match halvings {
            // 25, 50, 75, 100, 150, ...
            Halvings::AndBetween if k > 0 => vec![whole, whole + whole / 2],
            Halvings::EveryOther if k % 2 == 1 => vec![],
            _ => vec![whole],
        }
    })
}

/// A curve ends after so many settings that have not made the error smaller.
const FLAT: usize = 3;

/// And after so many failures beyond the first success, or before any.
const FAILURES: usize = 3;

fn descend(
    lab: &mut Lab,
    truth: &Truth,
    curve: &Curve,
    effort: &Effort,
    ladder: impl Iterator<Item = Setting>,
) -> Vec<Point> {
    let (mut points, mut cost, mut best, mut flat, mut failures) =
        (Vec::new(), Cost::default(), f64::INFINITY, 0, 0);
    for setting in ladder {
        if cost.of(setting) > 1.5 * effort.longest_run {
            break;
        }
        let point = lab.point(truth, curve, setting, (cost.budget(effort.longest_run), effort.measure_for));
        match &point.outcome {
            Ok(outcome) => {
                cost.learn(outcome.seconds, outcome.statistics.accepted + outcome.statistics.rejected);
                flat = if outcome.error < 0.7 * best { 0 } else { flat + 1 };
                // Before the error is small, nothing is said about rounding.
                flat = if best < 1e-2 { flat } else { 0 };
                best = best.min(outcome.error);
                failures = 0;
            }
            Err(_) => failures += 1,
        }
        let is_last = point.outcome.as_ref().is_ok_and(|outcome| outcome.seconds > effort.longest_run);
        points.push(point);
        let is_hopeless =
            failures >= FAILURES && (best.is_finite() || matches!(setting, Setting::Tolerance(_)));
        if is_last || flat >= FLAT || is_hopeless {
            break;
        }
    }
    points
}

/// What a step costs, as far as it is known.
#[derive(Clone, Copy, Debug, Default)]
struct Cost {
    of_a_step: Option<f64>,
}

impl Cost {
    fn learn(&mut self, seconds: f64, steps: u64) {
        if steps > 0 {
            self.of_a_step = Some(seconds / steps as f64);
        }
    }

    /// What a run will take, s.
    fn of(self, setting: Setting) -> f64 {
        match (setting, self.of_a_step) {
            (Setting::Steps(n), of_a_step) => n as f64 * of_a_step.unwrap_or(LEAST),
            _ => 0.0,
        }
    }

    /// Steps after which a run is given up.
    fn budget(self, longest: f64) -> u64 {
        // Three times what would be accepted: what fails shall not be far from it.
        (3.0 * longest / self.of_a_step.unwrap_or(UNKNOWN)) as u64 + 1000
    }
}

/// The cheapest step, and what one may cost of which nothing is known, s.
const LEAST: f64 = 5e-8;
const UNKNOWN: f64 = 2e-5;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ladders_descend() {
        let all: Vec<u64> = steps(Halvings::AndBetween).take(8).collect();
        assert_eq!(all, [25, 50, 75, 100, 150, 200, 300, 400]);
        assert_eq!(steps(Halvings::EveryOther).take(3).collect::<Vec<_>>(), [25, 100, 400]);
        assert_eq!(tolerances(Precision::F32, 2), [1e-3, 3.2e-4, 1e-4, 3.2e-5, 1e-5, 3.2e-6, 1e-6]);
        assert_eq!(tolerances(Precision::F64, 1).last(), Some(&1e-13));
    }
}
