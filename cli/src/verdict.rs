//! `simulate --verify`: how far a run can be trusted.
//!
//! A companion run of the same scene, by finer means and where there are some by other ones, says how large the error
//! of each joint coordinate is: the largest difference over all samples. It is held against the size of the motion, and
//! so is the energy's drift ([`gyro_runner::judge`]).

use crate::args::{Engine, Precision};
use crate::failure::Failure;
use crate::scene::Scene;
use crate::words::{count, number, table};
use crate::{columns, eigenvalues, equilibrium, kinks, lapse, remarks, rolling};
use gyro_model::{Model, RowOwner};
use gyro_runner::motion::Linear;
use gyro_runner::{
    Approach, Coordinates, Difference, Grade, Judgement, Measure, Occurrence, Plan, Reason, Remark, Sample,
    Settings, Summary, judge,
};
use gyro_sim::{Owner, Statistics};
use nalgebra::DMatrix;
use std::fmt::Write as _;

/// What is known of a run's quality.
#[derive(Debug)]
pub(crate) struct Verdict {
    pub(crate) judgement: Judgement,
    /// Name and units of each coordinate that was judged: of its position and of its rate.
    pub(crate) coordinates: Vec<(String, [&'static str; 2])>,
    /// What the companion was.
    pub(crate) companion: String,
    /// The fastest eigenvalue of the linearised motion at the end, 1/s; none for mechanisms without a joint form.
    pub(crate) fastest_eigenvalue: Option<f64>,
    /// What to say and to try.
    pub(crate) remarks: Vec<Remark>,
}

/// Samples, figures and linearisation of a run.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outcome {
    pub(crate) samples: Vec<Sample>,
    pub(crate) occurrences: Vec<Occurrence>,
    pub(crate) summary: Summary,
    pub(crate) linear: Option<Linear>,
    /// The last state before a failure, and its time.
    pub(crate) stopped: Option<(f64, Vec<f64>)>,
    /// When it was found to be stiff for its method.
    pub(crate) stiff: Option<f64>,
}

/// Judges a run. `run` makes companions: one whose own energy balance is open, or whose joints come apart, is taken
/// only where there is no better one.
///
/// # Errors
/// [`Failure::Unjudged`] if no companion came to its end, or rounding alone decides the motion.
pub(crate) fn verdict(
    scene: &Scene,
    outcome: &Outcome,
    mut run: impl FnMut(&Scene) -> Result<Outcome, Failure>,
) -> Result<Verdict, Failure> {
    if let Some(words) = equilibrium::unstable(scene) {
        return Err(Failure::Unjudged(words));
    }
    let (mut doubtful, mut last) = (None, None);
    for companion in companions(scene) {
        match run(&companion) {
            Ok(other) if gyro_runner::balance(&other.summary, scene.is_balanced).is_empty() => {
                return Ok(compare(scene, outcome, &companion, &other));
            }
            Ok(other) => doubtful = doubtful.or(Some((companion, other))),
            Err(failure @ Failure::Interrupted(_)) => return Err(failure),
            Err(failure) => last = Some(failure),
        }
    }
    match (doubtful, last) {
        (Some((companion, other)), _) => Ok(compare(scene, outcome, &companion, &other)),
        (None, Some(failure)) => Err(Failure::Unjudged(format!(
            "the run is complete but cannot be judged, as no run to compare it with comes to its end: {}",
            failure.words()
        ))),
        (None, None) => Err(Failure::Unjudged("there is no finer run to compare with".to_owned())),
    }
}

/// Scenes to compare with, the best first.
fn companions(scene: &Scene) -> Vec<Scene> {
    let double = |(settings, approach): (Settings, Approach)| {
        // Only generated code has joint coordinates.
        let has_them = approach.coordinates != Coordinates::Joint || scene.engine.is_generated();
        let engine = if has_them { scene.engine } else { Engine::InProcess };
        let approach = Approach { patience: None, leaves_stiff: false, ..approach };
        let settings = gyro_runner::closely(&settings, &approach);
        Scene { precision: Precision::F64, engine, settings, approach, proves: false, ..scene.clone() }
    };
    gyro_runner::companions(&scene.settings, &scene.approach).into_iter().map(double).collect()
}

fn compare(scene: &Scene, outcome: &Outcome, companion: &Scene, other: &Outcome) -> Verdict {
    let measure = Measure {
        tolerance: scene.approach.tolerance,
        size: scene.model.size(),
        is_balanced: scene.is_balanced,
    };
    let judgement = judge((&outcome.samples, &outcome.summary), (&other.samples, &other.summary), &measure);
    let fastest_eigenvalue = outcome.linear.as_ref().or(other.linear.as_ref()).map(fastest);
    let plan = Plan { settings: &scene.settings, approach: &scene.approach, offers: &scene.offers };
    Verdict {
        remarks: plan.remarks(&judgement, &outcome.summary, fastest_eigenvalue),
        judgement,
        coordinates: judged(&scene.model),
        companion: words(companion),
        fastest_eigenvalue,
    }
}

/// Joint coordinates, then position and orientation of each body that is observed.
fn judged(model: &Model) -> Vec<(String, [&'static str; 2])> {
    let joints = columns::coordinates(model).into_iter().map(|column| {
        let units =
            if column.is_orientation() { ["rad", "rad/s"] } else { [column.unit(), column.rate_unit()] };
        (column.name, units)
    });
    let bodies = crate::scene::observed(model).into_iter().flat_map(|(_, name)| {
        [(format!("{name} position"), ["m", "m/s"]), (format!("{name} orientation"), ["rad", "rad/s"])]
    });
    joints.chain(bodies).collect()
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
    let mut values: Vec<[f64; 2]> = eigenvalues::of(&matrix).iter().map(|v| [v.re, v.im]).collect();
    values.sort_by(|a, b| b[0].hypot(b[1]).total_cmp(&a[0].hypot(a[1])).then(b[1].total_cmp(&a[1])));
    values
}

/// What a grade means for this run.
fn sentence(judgement: &Judgement) -> String {
    let [position, rate] = [|e: &Difference| e.position, |e: &Difference| e.rate]
        .map(|of| number(judgement.errors.iter().map(of).fold(0.0, f64::max), 2));
    let relative = number(judgement.relative, 2);
    match judgement.grade {
        Grade::Good => format!("good: no error is larger than {relative} of its motion."),
        Grade::Usable if judgement.relative > 1.0 => {
            format!(
                "usable: positions to {position}, rates to {rate}; an angle has lost its phase, or a motion that is small beside the \
                 others is lost."
            )
        }
        Grade::Usable => {
            format!("usable to {relative} of the motion: positions to {position}, rates to {rate}.")
        }
        Grade::Worthless => {
            let reason = judgement.reasons.first().map_or(String::new(), ToString::to_string);
            format!("worthless: {reason}{}", until(judgement))
        }
    }
}

fn until(judgement: &Judgement) -> String {
    if judgement.until > 0.0
        && judgement.until < judgement.t_end
        && matches!(judgement.reasons.first(), Some(Reason::Error(_)))
    {
        format!(" Up to t = {} s none is.", number(judgement.until, 4))
    } else {
        String::new()
    }
}

/// Why the command ends with another exit status, if it does: by the verdict, or, without one, by what the run tells
/// itself.
pub(crate) fn worthless(scene: &Scene, outcome: &Outcome, verdict: Option<&Verdict>) -> Option<Failure> {
    let reason = match verdict {
        Some(verdict) => {
            let reasons = &verdict.judgement.reasons;
            (verdict.judgement.grade == Grade::Worthless).then(|| reasons.first().copied())?
        }
        None => gyro_runner::balance(&outcome.summary, scene.is_balanced).first().copied(),
    };
    let reason = reason.filter(|reason| reason.grade() == Grade::Worthless)?;
    Some(Failure::Worthless(format!("the result is worthless. {reason}")))
}

/// What a run says of itself that is not good.
pub(crate) fn warnings(scene: &Scene, outcome: &Outcome) -> Vec<String> {
    [doubts(scene, outcome), happenings(scene, outcome)].concat()
}

/// What of it a verdict tells better.
pub(crate) fn doubts(scene: &Scene, outcome: &Outcome) -> Vec<String> {
    let reasons = gyro_runner::balance(&outcome.summary, scene.is_balanced).into_iter();
    let all =
        reasons.map(|reason| reason.to_string()).chain(passage_words(scene, &outcome.summary.statistics));
    let all = all.map(|words| format!("{words} --verify tells how far the result can be trusted."));
    let stay = kinks::stay(&scene.start.kinks, &outcome.summary);
    all.chain(stay).collect()
}

/// What happened that no finer steps would change.
pub(crate) fn happenings(scene: &Scene, outcome: &Outcome) -> Vec<String> {
    [lapse::of_outputs(scene, &outcome.samples), rolling::that_lift(scene, &outcome.samples)].concat()
}

/// That steps of fixed length have passed singular poses, if they have.
fn passage_words(scene: &Scene, statistics: &Statistics) -> Option<String> {
    let first = passage(scene, statistics)?;
    Some(format!(
        "Steps of fixed length have passed {}, {first}: from there the mechanism may have gone on in another way. Under error control such poses \
         are stepped over.",
        count(statistics.passages, "singular pose")
    ))
}

/// When the first singular pose was passed, and whose constraints depend on others there.
pub(crate) fn passage(scene: &Scene, statistics: &Statistics) -> Option<String> {
    let first = statistics.first_passage?;
    let whose = first.owner.map_or(String::new(), |owner| {
        let (kind, name) = remarks::kind_and_name(&scene.model, row_owner(&scene.model, owner));
        format!(" ({kind} `{name}`)")
    });
    Some(format!("the first at t = {} s{whose}", number(first.t, 4)))
}

/// An owner in terms of the model: its bodies with coordinates are a mechanism's bodies.
pub(crate) fn row_owner(model: &Model, owner: Owner) -> RowOwner {
    match owner {
        Owner::Body(index) => RowOwner::Body(model.coordinate_bodies()[usize::from(index)]),
        Owner::Joint(index) => RowOwner::Joint(index.into()),
        Owner::Coupler(index) => RowOwner::Coupler(index.into()),
        Owner::Driver(index) => RowOwner::Driver(index.into()),
    }
}

/// That a run is not judged, in words.
pub(crate) fn unjudged(why: &Failure) -> String {
    format!("\nverdict\nnot judged: {}\n", why.words())
}

/// The verdict in words.
pub(crate) fn text(verdict: &Verdict, outcome: &Outcome) -> String {
    let row = |name: String, value: String| vec![name, value];
    let mut rows = Vec::new();
    for (which, of) in [(0, ""), (1, "the rate of ")] {
        rows.extend(verdict.coordinates.iter().zip(&verdict.judgement.errors).map(
            |((name, units), error)| {
                let error = [error.position, error.rate][which];
                row(
                    format!("estimated error of {of}{name}"),
                    format!("{} {}", number(error, 2), units[which]),
                )
            },
        ));
    }
    if let Some(pivot) = outcome.summary.smallest_pivot {
        rows.push(row("smallest pivot of the constraints".to_owned(), number(pivot, 3)));
    }
    if let Some(rate) = verdict.fastest_eigenvalue {
        rows.push(row("fastest eigenvalue at the end".to_owned(), format!("{} 1/s", number(rate, 4))));
    }
    let mut text = format!("\nverdict (compared with {})\n{}", verdict.companion, table(&rows));
    let _ = writeln!(text, "{}", sentence(&verdict.judgement));
    for remark in &verdict.remarks {
        let _ = writeln!(text, "{remark}");
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
