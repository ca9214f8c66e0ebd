//! The summary as one JSON object.

use crate::failure::Failure;
use crate::scene::Scene;
use crate::verdict::{self, Outcome, Verdict};
use crate::{columns, events, linearization, remarks};
use gyro_model::Model;
use gyro_runner::motion::Linear;
use gyro_runner::{Advice, Difference, JointSample, Sample};
use gyro_sim::Statistics;
use serde_json::{Map, Value, json};
use std::path::PathBuf;

/// The object: see the documentation of `simulate --json`.
pub(crate) fn object(
    scene: &Scene,
    outcome: &Outcome,
    (verdict, linear): (Option<&Verdict>, Option<&Linear>),
    written: &[PathBuf],
) -> Value {
    let (summary, last) = (&outcome.summary, outcome.samples.last().expect("the start is a sample"));
    let mut object = json!({
        "model": scene.model.name,
        "engine": scene.engine.name(),
        "method": scene.method(),
        "integrator": scene.approach.integrator.name(),
        "coordinates": scene.approach.coordinates.name(),
        "correction": scene.approach.correction.to_string(),
        "tolerance": scene.approach.tolerance,
        "chosen": scene.chosen.to_string(),
        "step": scene.approach.tolerance.is_none().then_some(scene.settings.step),
        "t": last.t,
        "degrees_of_freedom": scene.model.degrees_of_freedom(),
        "redundant": redundant(&scene.model),
        "joints": joints(&scene.model, &last.coordinates),
        "inputs": inputs(scene, last),
        "outputs": outputs(&scene.model, &last.outputs),
        "components": components(&scene.model),
        "events": events::object(&scene.model, &outcome.occurrences),
        "files": files(written),
        "constraint_violation": summary.position_violation,
        "norm_violation": summary.norm_violation,
        "velocity_violation": summary.velocity_violation,
        "energy": last.energy(),
        "energy_drift": summary.energy_drift,
        "steps": summary.steps,
        "rejected_steps": summary.statistics.rejected,
        "evaluations": summary.statistics.work.evaluations,
        "jacobians": summary.statistics.work.jacobians,
        "corrections": summary.statistics.corrections,
        "poses_stepped_over": summary.statistics.leaps,
        "poses_passed": poses(scene, &summary.statistics),
        "steps_limited_by_stability": summary.statistics.limited_by_stability,
        "kinks_crossed": (!scene.start.kinks.is_empty()).then_some(summary.kinks_crossed),
        "chart_switches": summary.chart_switches,
        "run_time_s": summary.run_time_s,
        "warnings": verdict::warnings(scene, outcome),
    });
    if let Some(verdict) = verdict {
        object["verdict"] = json!({
            "grade": verdict.judgement.grade.name(),
            "relative_error": verdict.judgement.relative,
            "usable_until": verdict.judgement.until,
            "estimated_errors": by_name(verdict, |error| error.position),
            "estimated_rate_errors": by_name(verdict, |error| error.rate),
            "companion": verdict.companion,
            "smallest_pivot": summary.smallest_pivot,
            "fastest_eigenvalue": verdict.fastest_eigenvalue,
            "advice": verdict.remarks.iter().map(ToString::to_string).collect::<Vec<_>>(),
            "try": verdict.remarks.iter().filter_map(|r| r.advice.as_ref().map(Advice::flags)).collect::<Vec<_>>(),
        });
    }
    if let Some(linear) = linear {
        object["linearization"] = linearization::object(&scene.model, linear);
    }
    object
}

/// The verdict on a run that cannot be judged.
pub(crate) fn unjudged(why: &Failure) -> Value {
    json!({
        "grade": "not judged",
        "reason": why.words(),
        "relative_error": null,
        "estimated_errors": {},
        "estimated_rate_errors": {},
        "companion": null,
        "advice": [],
        "try": [],
    })
}

/// For each joint its coordinates: numbers if there is a single one, else arrays in their order.
fn joints(model: &Model, samples: &[JointSample]) -> Map<String, Value> {
    let coordinates = columns::coordinates(model);
    let of = |joint: usize| {
        coordinates.iter().zip(samples).filter(move |(c, _)| c.joint == joint).map(|(_, sample)| sample)
    };
    let joints = model.joints.iter().enumerate();
    joints.map(|(index, joint)| (joint.name.clone(), object_of(&of(index).collect::<Vec<_>>()))).collect()
}

fn object_of(samples: &[&JointSample]) -> Value {
    match samples {
        [JointSample::Orientation { position, rate }] => json!({ "position": position, "rate": rate }),
        [single] => {
            let (position, rate) = columns::scalar(single);
            json!({ "position": position, "rate": rate })
        }
        several => {
            let (positions, rates): (Vec<f64>, Vec<f64>) =
                several.iter().map(|sample| columns::scalar(sample)).unzip();
            json!({ "position": positions, "rate": rates })
        }
    }
}

/// For each output its number, or an array of them.
fn outputs(model: &Model, values: &[f64]) -> Map<String, Value> {
    let mut rest = values;
    let mut object = Map::new();
    for output in &model.outputs {
        let (own, after) = rest.split_at(output.kind.columns().len().min(rest.len()));
        rest = after;
        let value = if let [single] = own { json!(single) } else { json!(own) };
        object.insert(output.name.clone(), value);
    }
    object
}

/// For each input its value at a sample.
fn inputs(scene: &Scene, sample: &Sample) -> Map<String, Value> {
    let values = columns::inputs_at(&scene.model, &scene.start, sample);
    scene.model.inputs.iter().zip(values).map(|(input, value)| (input.name.clone(), json!(value))).collect()
}

/// What the numbers of each joint, input and output are, with their units, in their order.
fn components(model: &Model) -> Value {
    let named =
        |name: &str, unit: &str| json!({ "name": name, "unit": if unit.is_empty() { "1" } else { unit } });
    let joints = model.joints.iter().enumerate().map(|(index, joint)| {
        let coordinates = columns::coordinates(model).into_iter().filter(|shown| shown.joint == index);
        let parts = coordinates.flat_map(|shown| match shown.kind {
            Some(kind) => vec![named(kind.name(), shown.unit())],
            None => ["e0", "e1", "e2", "e3"].map(|name| named(name, "1")).to_vec(),
        });
        (joint.name.clone(), json!(parts.collect::<Vec<_>>()))
    });
    let inputs = model.inputs.iter().enumerate();
    let inputs = inputs.map(|(index, input)| (input.name.clone(), json!(columns::input_unit(model, index))));
    let outputs = model.outputs.iter().map(|output| {
        let parts = columns::output_columns(model, output);
        (output.name.clone(), json!(parts.iter().map(|(name, unit)| named(name, unit)).collect::<Vec<_>>()))
    });
    json!({
        "joints": joints.collect::<Map<_, _>>(),
        "inputs": inputs.collect::<Map<_, _>>(),
        "outputs": outputs.collect::<Map<_, _>>(),
    })
}

/// Where the time series is, and the plots; with `--json` they are written only where `--out` says.
fn files(written: &[PathBuf]) -> Value {
    let is_table = |path: &&PathBuf| path.extension().is_some_and(|extension| extension == "csv");
    let (tables, plots): (Vec<&PathBuf>, Vec<&PathBuf>) = written.iter().partition(is_table);
    let note = "give --out FOLDER to have every sample as a CSV file";
    json!({
        "time_series": tables.first(),
        "events": tables.get(1),
        "plots": plots,
        "note": tables.is_empty().then_some(note),
    })
}

/// The singular poses that steps of fixed length have passed.
fn poses(scene: &Scene, statistics: &Statistics) -> Value {
    let first = statistics.first_passage.map(|first| {
        let owner = first.owner.map(|owner| verdict::row_owner(&scene.model, owner));
        let (kind, name) = owner.map(|owner| remarks::kind_and_name(&scene.model, owner)).unzip();
        json!({ "t": first.t, "clearance": first.pivot, "owner": kind, "name": name })
    });
    json!({ "count": statistics.passages, "first": first })
}

/// The rows that were dropped.
pub(crate) fn redundant(model: &Model) -> Vec<Value> {
    let rows = model.redundant.iter().map(|dropped| {
        let (kind, name) = remarks::kind_and_name(model, dropped.row.owner);
        let shared = dropped.shared_with.iter().map(|o| remarks::kind_and_name(model, *o).1);
        json!({
            "owner": kind,
            "name": name,
            "row": dropped.row.index + 1,
            "shared_with": shared.collect::<Vec<_>>(),
        })
    });
    rows.collect()
}

/// Errors by the names of their coordinates.
fn by_name(verdict: &Verdict, of: fn(&Difference) -> f64) -> Value {
    let named = verdict.coordinates.iter().zip(&verdict.judgement.errors);
    named.map(|((name, _), error)| (name.clone(), json!(of(error)))).collect::<Map<_, _>>().into()
}
