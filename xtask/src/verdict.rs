//! `simulate --verify`: how far a run can be trusted.
//!
//! A companion run of the same scene, by finer means and where there are some by other ones, says how large the error of each joint
//! coordinate is: the largest difference over all samples. Everything else was watched by the run itself.

use crate::args::{Engine, Precision};
use crate::columns;
use crate::failure::Failure;
use crate::scene::Scene;
use crate::words::{number, table};
use gyro_runner::motion::Linear;
use gyro_runner::{Approach, Coordinates, Correction, Integrator, Sample, Settings, Summary, differences};
use nalgebra::DMatrix;
use std::fmt::Write as _;

/// What is known of a run's quality.
#[derive(Debug)]
pub(crate) struct Verdict {
    /// Estimated error of each joint coordinate over the run, with its name and unit.
    pub(crate) errors: Vec<(String, &'static str, f64)>,
    /// What the companion was.
    pub(crate) companion: String,
    /// The fastest eigenvalue of the linearised motion at the end, 1/s; none for mechanisms without a joint form.
    pub(crate) fastest_eigenvalue: Option<f64>,
    /// What to do about it, sentence by sentence.
    pub(crate) advice: Vec<String>,
}

/// Samples, figures and linearisation of a run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outcome {
    pub(crate) samples: Vec<Sample>,
    pub(crate) summary: Summary,
    pub(crate) linear: Option<Linear>,
}

/// Judges a run. `run` makes companions.
///
/// # Errors
/// No companion came to its end.
pub(crate) fn verdict(
    scene: &Scene,
    outcome: &Outcome,
    mut run: impl FnMut(&Scene) -> Result<Outcome, Failure>,
) -> Result<Verdict, Failure> {
    let mut last = None;
    for companion in companions(scene) {
        match run(&companion) {
            Ok(other) => return Ok(compare(scene, outcome, &companion, &other)),
            Err(failure) => last = Some(failure),
        }
    }
    Err(last.unwrap_or_else(|| Failure::Run("there is no finer run to compare with".to_owned())))
}

/// Scenes to compare with, the best first.
fn companions(scene: &Scene) -> Vec<Scene> {
    let vary = scene.start.inputs.iter().any(|input| input.rows.len() > 1);
    let double = |(settings, approach): (Settings, Approach)| {
        // Only generated code has joint coordinates.
        let engine =
            if approach.coordinates == Coordinates::Joint { Engine::Generated } else { scene.engine };
        Scene { precision: Precision::F64, engine, settings, approach, ..scene.clone() }
    };
    gyro_runner::companions(&scene.settings, &scene.approach, vary).into_iter().map(double).collect()
}

fn compare(scene: &Scene, outcome: &Outcome, companion: &Scene, other: &Outcome) -> Verdict {
    let columns = columns::coordinates(&scene.model);
    let differences = differences(&outcome.samples, &other.samples);
    let errors =
        columns.iter().zip(differences).map(|(c, error)| (c.name.clone(), c.unit(), error)).collect();
    let fastest_eigenvalue = outcome.linear.as_ref().or(other.linear.as_ref()).map(fastest);
    let mut verdict = Verdict { errors, companion: words(companion), fastest_eigenvalue, advice: Vec::new() };
    verdict.advice = advice(scene, outcome, &verdict);
    verdict
}

fn words(scene: &Scene) -> String {
    match scene.approach.tolerance {
        Some(_) => scene.approach.to_string(),
        None => format!("{}, step {:e} s", scene.approach, scene.settings.step),
    }
}

/// The largest |λ|.
pub(crate) fn fastest(linear: &Linear) -> f64 {
    eigenvalues(linear).iter().map(|[re, im]| re.hypot(*im)).fold(0.0, f64::max)
}

/// Real and imaginary parts, the fastest first.
pub(crate) fn eigenvalues(linear: &Linear) -> Vec<[f64; 2]> {
    let n = linear.state.len();
    let matrix = DMatrix::from_row_slice(n, n, &linear.by_state);
    let mut values: Vec<[f64; 2]> = matrix.complex_eigenvalues().iter().map(|v| [v.re, v.im]).collect();
    values.sort_by(|a, b| b[0].hypot(b[1]).total_cmp(&a[0].hypot(a[1])).then(b[1].total_cmp(&a[1])));
    values
}

/// Constraint violations larger than this deserve a word.
const VISIBLE_VIOLATION: f64 = 1e-9;

/// A pivot smaller than this is near a singular pose.
const SMALL_PIVOT: f64 = 1e-3;

fn advice(scene: &Scene, outcome: &Outcome, verdict: &Verdict) -> Vec<String> {
    let mut advice = Vec::new();
    let statistics = &outcome.summary.statistics;
    let worst = verdict.errors.iter().map(|e| e.2).fold(0.0, f64::max);
    let approach = &scene.approach;
    match approach.tolerance {
        Some(tolerance) if worst > 10.0 * tolerance => advice.push(format!(
            "Errors have added up to {} times the tolerance: for {tolerance:e} over this run try --tolerance {:.0e}.",
            number(worst / tolerance, 2),
            tolerance * tolerance / worst
        )),
        Some(tolerance) => advice.push(format!("The errors are within ten times the tolerance of {tolerance:e}.")),
        None if worst.is_finite() => advice.push(format!(
            "The result can be trusted to {}; half the step would divide a smooth motion's error by {}.",
            number(worst, 2),
            2_u32.pow(order(approach.integrator))
        )),
        None => advice.push("The result cannot be trusted: the companion ends elsewhere.".to_owned()),
    }
    let share = statistics.limited_by_stability as f64 / statistics.accepted.max(1) as f64;
    if share > 0.25 {
        advice.push(format!(
            "{} % of the steps were as long as stability allows, not accuracy: the scene is stiff for {}; --integrator rodas4 is not \
             limited so.",
            number(100.0 * share, 2),
            approach.integrator
        ));
    }
    if statistics.rejected > statistics.accepted / 2 {
        advice.push(format!(
            "{} steps were rejected for {} accepted: something in the motion is not smooth.",
            statistics.rejected, statistics.accepted
        ));
    }
    if outcome.summary.position_violation > VISIBLE_VIOLATION {
        let cure = if approach.correction == Correction::None {
            "choose a --correction"
        } else {
            "correct more often"
        };
        advice.push(format!(
            "Constraints were violated by up to {}: {cure}.",
            number(outcome.summary.position_violation, 2)
        ));
    }
    if let Some(pivot) = outcome.summary.smallest_pivot.filter(|pivot| *pivot < SMALL_PIVOT) {
        advice.push(format!(
            "The smallest pivot of the constraints was {}: the mechanism has come near a singular pose, where errors are enlarged.",
            number(pivot, 2)
        ));
    }
    if outcome.summary.energy_drift > 1e3 * worst.max(1e-14) {
        advice.push(format!(
            "The energy balance is open by {} of the energy that moves, more than the estimated error explains.",
            number(outcome.summary.energy_drift, 2)
        ));
    }
    advice
}

fn order(integrator: Integrator) -> u32 {
    match integrator {
        Integrator::Rk4 | Integrator::Rodas4 => 4,
        Integrator::Tsit5 => 5,
        Integrator::Dop853 => 8,
    }
}

/// The verdict in words.
pub(crate) fn text(verdict: &Verdict, outcome: &Outcome) -> String {
    let row = |name: String, value: String| vec![name, value];
    let mut rows: Vec<Vec<String>> = verdict
        .errors
        .iter()
        .map(|(name, unit, error)| {
            row(format!("estimated error of {name}"), format!("{} {unit}", number(*error, 2)))
        })
        .collect();
    if let Some(pivot) = outcome.summary.smallest_pivot {
        rows.push(row("smallest pivot of the constraints".to_owned(), number(pivot, 3)));
    }
    if let Some(rate) = verdict.fastest_eigenvalue {
        rows.push(row("fastest eigenvalue at the end".to_owned(), format!("{} 1/s", number(rate, 4))));
    }
    let mut text = format!("\nverdict (compared with {})\n{}", verdict.companion, table(&rows));
    for sentence in &verdict.advice {
        let _ = writeln!(text, "{sentence}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eigenvalues_of_an_oscillator() {
        let linear = Linear { state: vec![0.0; 2], by_state: vec![0.0, 1.0, -9.0, 0.0], ..Linear::default() };
        let values = eigenvalues(&linear);
        assert!((values[0][1] - 3.0).abs() < 1e-12 && (values[1][1] + 3.0).abs() < 1e-12, "{values:?}");
        assert!((fastest(&linear) - 3.0).abs() < 1e-12);
    }
}
