//! The summary that a run prints.

use crate::args::Engine;
use crate::proof::Standing;
use crate::scene::Scene;
use crate::verdict::Outcome;
use crate::words::{count, number, table};
use crate::{columns, compare, contacts, controllers, events, paths, remarks, verdict};
use gyro_assembled::Careful;
use gyro_codegen::Effort;
use gyro_model::{Model, Move};
use gyro_runner::{Approach, Between, Coordinates, Correction, JointSample, Sample, Settings, Summary, When};
use gyro_sim::Statistics;
use std::fmt::Write as _;
use std::path::PathBuf;

/// Digits of final positions and rates: enough to compare runs by eye.
const DIGITS: usize = 12;

/// Digits of residuals and times.
const FEW: usize = 3;

/// The whole summary.
pub(crate) fn text(
    scene: &Scene,
    (Outcome { samples, occurrences, summary: run, .. }, standing): (&Outcome, Option<Standing>),
    verdict: &str,
    written: &[PathBuf],
) -> String {
    let last = samples.last().expect("the start is a sample");
    let mut text = head(scene, (run, standing), last);
    if let Some(event) = events::end(&scene.model, occurrences) {
        let _ = writeln!(text, "ended by event {event}");
    }
    text += &moved(&scene.moved);
    text += &motion(&scene.model, last);
    text += &outputs(&scene.model, last);
    text += &events::text(&scene.model, occurrences);
    text += &quality(scene, samples, run, last);
    text += &compare::text(scene, samples);
    text += verdict;
    text + &files(written)
}

/// The summary of a run that was interrupted.
pub(crate) fn of_part(scene: &Scene, last: &Sample, written: &[PathBuf]) -> String {
    let mut text = format!(
        "{}: interrupted at t = {} s of {} s\nengine {}, {}\n",
        scene.model.name,
        last.t,
        scene.settings.t_end,
        engine(scene, None),
        scene.precision.name()
    );
    text += &motion(&scene.model, last);
    text += &outputs(&scene.model, last);
    text + &files(written)
}

/// What was written.
fn files(written: &[PathBuf]) -> String {
    let lines: String = written.iter().map(|path| format!("wrote {}\n", path.display())).collect();
    if written.is_empty() { lines } else { format!("\n{lines}") }
}

fn head(scene: &Scene, (run, standing): (&Summary, Option<Standing>), last: &Sample) -> String {
    let settings = &scene.settings;
    let method = method(&scene.approach, settings);
    let mut text = format!(
        "{}: {} s in {} (mean {} s), {method}\nengine {}, {}\n",
        scene.model.name,
        last.t,
        count(run.steps, "step"),
        number(last.t / run.steps.max(1) as f64, 6),
        engine(scene, standing),
        scene.precision.name()
    );
    let chosen = scene.chosen.to_string();
    if !chosen.is_empty() {
        let _ = writeln!(text, "chosen: {chosen}");
    }
    text += &mechanism(scene);
    for parameter in &scene.model.parameters {
        let _ = writeln!(text, "parameter {} = {:?}", parameter.name, gyro_model::to_f64(&parameter.value));
    }
    text
}

/// Integrator and correction in words.
fn method(approach: &Approach, settings: &Settings) -> String {
    let kept = match (approach.coordinates, approach.correction) {
        (Coordinates::Joint, _) => return format!("{} in joint coordinates", approach.integrator),
        (_, Correction::None) => return format!("{}, direct integration", approach.integrator),
        (_, Correction::Partition) => "coordinate partitioning".to_owned(),
        (_, Correction::ClosedForm) => "closed-form correction".to_owned(),
        (_, Correction::MassWeighted) => "mass-weighted projection".to_owned(),
        (_, Correction::Baumgarte(rate)) => {
            return format!("{}, Baumgarte's stabilisation at {rate:?}/s", approach.integrator);
        }
    };
    let when = match (approach.when, approach.tolerance, settings.correct_every) {
        (Some(When::Steps(1)), ..) | (None, Some(_), _) => "after every step".to_owned(),
        (Some(When::Steps(steps)), ..) => format!("every {steps} steps"),
        (Some(When::Violation(limit)), ..) => format!("beyond a violation of {limit:e}"),
        (None, None, every) => format!("every {:?} s", every.unwrap_or(settings.step)),
    };
    format!("{}, {kept} {when}", approach.integrator)
}

/// The engine's name, and why it is not what it is elsewhere.
fn engine(scene: &Scene, standing: Option<Standing>) -> String {
    let name = scene.engine.name();
    match Careful::<f64>::supports(&scene.model) {
        Err(reason) if scene.engine == Engine::Assembled => format!("{name} (in its dense form: {reason})"),
        _ if scene.engine.is_generated() => format!("{name}{}", searched(scene, standing)),
        _ => name.to_owned(),
    }
}

/// What was searched, and whether it was proved, where that is not as usual.
fn searched(scene: &Scene, standing: Option<Standing>) -> String {
    let effort = match scene.effort {
        Effort::Full => "",
        Effort::Quick => " (quick: few forms were searched)",
    };
    let proof = match (scene.engine, standing) {
        (Engine::Generated, _) => String::new(),
        (_, Some(standing)) => format!(", {}", standing.words()),
        (_, None) => ", not proved".to_owned(),
    };
    format!("{effort}{proof}")
}

/// Degrees of freedom, and what inputs are set to.
fn mechanism(scene: &Scene) -> String {
    let model = &scene.model;
    let freedom = model.degrees_of_freedom() as u64;
    let mut text =
        if freedom == 1 { "1 degree of freedom".to_owned() } else { format!("{freedom} degrees of freedom") };
    let dropped = model.dropped().count();
    if dropped > 0 {
        let _ = write!(text, ", {} dropped", count(dropped as u64, "redundant row"));
    }
    let stay = model.redundant.len() - dropped;
    if stay > 0 {
        let _ = write!(text, ", {} kept", count(stay as u64, "redundant row"));
    }
    text.push('\n');
    for (index, input) in model.inputs.iter().enumerate() {
        if let Some(controller) = controllers::setting(model, index) {
            let _ = writeln!(text, "input {}: set by controller {}", input.name, controller.name);
            continue;
        }
        if contacts::acting(model, index).is_some() || paths::moving(model, index).is_some() {
            continue;
        }
        let given = scene.start.inputs.iter().find(|given| given.index == index);
        let _ = match given.map(|given| given.rows.as_slice()) {
            None => writeln!(text, "input {} = {:?}", input.name, gyro_model::to_f64(&input.value)),
            Some([[_, value]]) => writeln!(text, "input {} = {value:?}", input.name),
            Some(rows) => {
                let between = match given.map(|given| given.between) {
                    Some(Between::Held) => ", held",
                    Some(Between::Smooth) => ", smooth",
                    _ => "",
                };
                writeln!(text, "input {}: table of {}{between}", input.name, count(rows.len() as u64, "row"))
            }
        };
    }
    text + &contacts::text(model)
}

/// How far the start is from where the model file put it.
fn moved(moved: &[Move]) -> String {
    if moved.is_empty() {
        return String::new();
    }
    let row = |m: &Move| {
        vec![format!("{}.{}", m.name, m.coordinate), format!("{} {}", number(m.amount, FEW), m.unit)]
    };
    let rows: Vec<Vec<String>> = moved.iter().map(row).collect();
    format!("\nmoved to close the mechanism at the start\n{}", table(&rows))
}

fn motion(model: &Model, last: &Sample) -> String {
    let mut rows = vec![vec![String::new(), format!("at t = {} s", last.t), "rate".to_owned()]];
    for (coordinate, sample) in columns::coordinates(model).iter().zip(&last.coordinates) {
        let (position, rate) = match sample {
            JointSample::Orientation { position, rate } => {
                (format!("({})", list(position)), format!("({}) rad/s", list(rate)))
            }
            JointSample::Angle { position, rate } | JointSample::Length { position, rate } => (
                format!("{} {}", number(*position, DIGITS), coordinate.unit()),
                format!("{} {}", number(*rate, DIGITS), coordinate.rate_unit()),
            ),
        };
        rows.push(vec![coordinate.name.clone(), position, rate]);
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

/// The outputs at the end.
fn outputs(model: &Model, last: &Sample) -> String {
    let mut rows = Vec::new();
    let mut values = last.outputs.iter();
    for output in &model.outputs {
        let columns = columns::output_columns(model, output).into_iter().enumerate();
        for ((number_of, (suffix, unit)), value) in columns.zip(&mut values) {
            let dot = if suffix.is_empty() { "" } else { "." };
            let cells =
                [format!("{}{dot}{suffix}", output.name), format!("{} {unit}", number(*value, DIGITS))];
            let mut row = cells.map(|cell| cell.trim_end().to_owned()).to_vec();
            if remarks::is_not_unique(model, &output.kind, number_of) {
                row.push("not unique".to_owned());
            }
            rows.push(row);
        }
    }
    if rows.is_empty() { String::new() } else { format!("\n{}", table(&rows)) }
}

fn list(values: &[f64]) -> String {
    values.iter().map(|v| number(*v, 7)).collect::<Vec<_>>().join(", ")
}

/// What the steps have cost and met.
fn cost(scene: &Scene, statistics: &Statistics) -> Vec<Vec<String>> {
    let Statistics {
        accepted,
        rejected,
        corrections,
        work,
        limited_by_stability,
        fastest_rate,
        leaps,
        passages,
        ..
    } = *statistics;
    let mut rows = vec![vec!["evaluations".to_owned(), work.evaluations.to_string()]];
    if rejected > 0 {
        rows.push(vec!["rejected steps".to_owned(), rejected.to_string()]);
    }
    if work.jacobians > 0 {
        rows.push(vec!["Jacobians".to_owned(), work.jacobians.to_string()]);
    }
    if corrections > 0 {
        rows.push(vec!["corrections".to_owned(), corrections.to_string()]);
    }
    if leaps > 0 {
        rows.push(vec!["singular poses stepped over".to_owned(), leaps.to_string()]);
    }
    if let Some(first) = verdict::passage(scene, statistics) {
        rows.push(vec!["singular poses passed".to_owned(), format!("{passages}, {first}")]);
    }
    if fastest_rate > 0.0 {
        rows.push(vec!["fastest rate".to_owned(), format!("{} 1/s", number(fastest_rate, FEW))]);
    }
    if limited_by_stability > 0 {
        let share = 100.0 * limited_by_stability as f64 / accepted.max(1) as f64;
        rows.push(vec!["steps limited by stability".to_owned(), format!("{} %", number(share, FEW))]);
    }
    rows
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
        let is_plain = scene.model.forces.is_empty() && !scene.model.is_driven();
        let name = if is_plain { "work of friction" } else { "work of forces and drivers" };
        rows.insert(4, vec![name.to_owned(), format!("{} J", number(last.work, DIGITS))]);
    }
    if scene.settings.correct_every.is_some() {
        rows.push(vec!["chart switches".to_owned(), run.chart_switches.to_string()]);
    }
    rows.extend(cost(scene, &run.statistics));
    if !scene.start.kinks.is_empty() {
        rows.push(vec!["kinks of laws crossed".to_owned(), run.kinks_crossed.to_string()]);
    }
    rows.push(vec!["samples".to_owned(), samples.len().to_string()]);
    rows.push(vec!["run time".to_owned(), format!("{} s", number(run.run_time_s, FEW))]);
    format!("\n{}", table(&rows))
}
