//! The summary that a run prints.

use crate::compare;
use crate::scene::Scene;
use crate::words::{count, number, table};
use gyro_model::Model;
use gyro_runner::{JointSample, Sample, Summary};
use std::fmt::Write as _;
use std::path::PathBuf;

/// Digits of final positions and rates: enough to compare runs by eye.
const DIGITS: usize = 12;

/// Digits of residuals and times.
const FEW: usize = 3;

/// The whole summary.
pub(crate) fn text(scene: &Scene, samples: &[Sample], run: &Summary, written: &[PathBuf]) -> String {
    let last = samples.last().expect("the start is a sample");
    let mut text = head(scene, run, last);
    text += &motion(&scene.model, last);
    text += &quality(scene, samples, run, last);
    text += &compare::text(scene, samples);
    if !written.is_empty() {
        text.push('\n');
    }
    for path in written {
        let _ = writeln!(text, "wrote {}", path.display());
    }
    text
}

fn head(scene: &Scene, run: &Summary, last: &Sample) -> String {
    let settings = &scene.settings;
    let method = match settings.correct_every {
        Some(every) => format!("coordinate partitioning every {every:?} s"),
        None => "direct integration".to_owned(),
    };
    let mut text = format!(
        "{}: {} s in {} (mean {} s), {method}\nengine {}, {}\n",
        scene.model.name,
        last.t,
        count(run.steps, "step"),
        number(last.t / run.steps.max(1) as f64, 6),
        scene.engine.name(),
        scene.precision.name()
    );
    for parameter in &scene.model.parameters {
        let _ = writeln!(text, "parameter {} = {:?}", parameter.name, gyro_model::to_f64(&parameter.value));
    }
    text
}

fn motion(model: &Model, last: &Sample) -> String {
    let mut rows = vec![vec![String::new(), format!("at t = {} s", last.t), "rate".to_owned()]];
    for (joint, sample) in model.joints.iter().zip(&last.joints) {
        match sample {
            JointSample::Angle { position, rate } => rows.push(vec![
                joint.name.clone(),
                format!("{} rad", number(*position, DIGITS)),
                format!("{} rad/s", number(*rate, DIGITS)),
            ]),
            JointSample::Orientation { position, rate } => rows.push(vec![
                joint.name.clone(),
                format!("({})", list(position)),
                format!("({}) rad/s", list(rate)),
            ]),
            JointSample::None => {}
        }
    }
    for ((_, name), body) in crate::scene::observed(model).iter().zip(&last.bodies) {
        let [x, y, z, euler @ ..] = &body.pose;
        let (velocity, spin) = body.velocity.split_at(3);
        let position = format!("({}) m", list(&[*x, *y, *z]));
        rows.push(vec![format!("{name} position"), position, format!("({}) m/s", list(velocity))]);
        let orientation = format!("({})", list(euler));
        rows.push(vec![format!("{name} orientation"), orientation, format!("({}) rad/s", list(spin))]);
    }
    format!("\n{}", table(&rows))
}

fn list(values: &[f64]) -> String {
    values.iter().map(|v| number(*v, 7)).collect::<Vec<_>>().join(", ")
}

fn quality(scene: &Scene, samples: &[Sample], run: &Summary, last: &Sample) -> String {
    let mut rows = vec![
        vec!["worst constraint violation".to_owned(), number(run.position_violation, FEW)],
        vec!["worst velocity violation".to_owned(), format!("{} 1/s", number(run.velocity_violation, FEW))],
        vec!["worst |p'p - 1|".to_owned(), number(run.norm_violation, FEW)],
        vec!["energy".to_owned(), format!("{} J", number(last.energy(), DIGITS))],
        vec!["energy drift".to_owned(), number(run.energy_drift, FEW)],
    ];
    if scene.model.has_work() {
        rows.insert(4, vec!["work of friction".to_owned(), format!("{} J", number(last.work, DIGITS))]);
    }
    if scene.settings.correct_every.is_some() {
        rows.push(vec!["chart switches".to_owned(), run.chart_switches.to_string()]);
    }
    rows.push(vec!["samples".to_owned(), samples.len().to_string()]);
    rows.push(vec!["run time".to_owned(), format!("{} s", number(run.run_time_s, FEW))]);
    format!("\n{}", table(&rows))
}
