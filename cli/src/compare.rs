//! The motion of each angle in three numbers, beside what linear theory says they are.

use crate::columns::{self, scalar};
use crate::fit::{Fit, NoFit, fit};
use crate::linear::{Linear, Response};
use crate::scene::Scene;
use crate::words::{number, table};
use gyro_model::CoordinateKind;
use gyro_runner::Sample;
use std::fmt::Write as _;

/// One angle, fitted in the run and in linear theory.
struct Compared<'a> {
    name: &'a str,
    run: Result<Fit, NoFit>,
    theory: Option<Result<Fit, NoFit>>,
}

/// Digits of the numbers in the table: agreement is judged in the sixth.
const DIGITS: usize = 9;

/// A slope that moves the angle by less than this part of the harmonic's amplitude over the run says nothing; the mean
/// does.
const LEVEL: f64 = 1e-2;

/// The fits of all angles as text; empty for a mechanism without angles, and for one of more than bodies and joints.
pub(crate) fn text(scene: &Scene, samples: &[Sample]) -> String {
    let all = columns::coordinates(&scene.model).into_iter().enumerate();
    let angles: Vec<(usize, usize)> = all
        .filter(|(_, c)| c.kind == Some(CoordinateKind::Angle))
        .map(|(index, c)| (index, c.joint))
        .collect();
    if angles.is_empty() || !Linear::is_about(&scene.model) {
        return String::new();
    }
    let n_regular = n_regular(samples, scene.settings.sample_every);
    let interval = scene.settings.sample_every;
    let theory =
        Linear::about_start(&scene.model).and_then(|l| l.response(&scene.model, interval, n_regular));
    let compared: Vec<Compared<'_>> = angles
        .iter()
        .map(|&(index, joint)| Compared {
            name: &scene.model.joints[joint].name,
            run: fit(interval, &values(&samples[..n_regular], index)),
            theory: theory.as_ref().ok().and_then(|r| theory_of(r, joint)).map(|v| fit(interval, v)),
        })
        .collect();
    describe(&compared, theory.err().as_deref(), interval * (n_regular.max(2) - 1) as f64)
}

/// Samples that lie on the sampling grid: all but, perhaps, the last.
fn n_regular(samples: &[Sample], interval: f64) -> usize {
    let is_regular =
        |(k, sample): &(usize, &Sample)| (sample.t - *k as f64 * interval).abs() < 1e-6 * interval;
    samples.iter().enumerate().take_while(is_regular).count()
}

fn values(samples: &[Sample], index: usize) -> Vec<f64> {
    samples.iter().map(|s| scalar(&s.coordinates[index]).0).collect()
}

fn theory_of(response: &Response, joint: usize) -> Option<&[f64]> {
    let index = response.joints.iter().position(|&j| j == joint)?;
    Some(&response.angles[index])
}

fn describe(compared: &[Compared<'_>], no_theory: Option<&str>, length: f64) -> String {
    let mut rows = Vec::new();
    let mut notes = String::new();
    for joint in compared {
        match &joint.run {
            Ok(run) => rows.extend(fitted(joint, run, length)),
            Err(NoFit::Still) => {}
            Err(reason) => {
                let _ = writeln!(notes, "  {}: no fit, {reason}", joint.name);
            }
        }
    }
    if let (Some(reason), false) = (no_theory, rows.is_empty()) {
        let _ = writeln!(notes, "  linear theory does not hold here: {reason}");
    }
    if rows.is_empty() && notes.is_empty() {
        return String::new();
    }
    if !rows.is_empty() {
        let mut head = vec!["", "run"];
        if no_theory.is_none() {
            head.extend(["linear theory", "difference"]);
        }
        rows.insert(0, head.into_iter().map(str::to_owned).collect());
    }
    let title = "fit of each angle by a + b t + A cos ωt + B sin ωt (b: precession or spin, ω: nutation)";
    format!("\n{title}\n{}{notes}", table(&rows))
}

/// The rows of an angle that could be fitted.
fn fitted(joint: &Compared<'_>, run: &Fit, length: f64) -> Vec<Vec<String>> {
    let theory = joint.theory.as_ref().and_then(|t| t.as_ref().ok());
    let is_level = |fit: &Fit| fit.harmonic.is_some_and(|h| fit.slope.abs() * length < LEVEL * h.amplitude);
    let row = |what: &str, value: fn(&Fit) -> Option<f64>| {
        let run = value(run)?;
        let mut row = vec![format!("{} {what}", joint.name), number(run, DIGITS)];
        if joint.theory.is_some() {
            let theory = theory.and_then(value);
            row.push(theory.map_or("none".to_owned(), |t| number(t, DIGITS)));
            row.push(theory.map_or(String::new(), |t| format!("{:+.1e}", run / t - 1.0)));
        }
        Some(row)
    };
    let line = if is_level(run) && theory.is_none_or(is_level) {
        row("mean [rad]", |fit| Some(fit.mean))
    } else {
        row("slope b [rad/s]", |fit| Some(fit.slope))
    };
    let omega = row("frequency ω [rad/s]", |fit| Some(fit.harmonic?.omega));
    let swing = row("peak to peak [rad]", |fit| Some(2.0 * fit.harmonic?.amplitude));
    [line, omega, swing].into_iter().flatten().collect()
}
