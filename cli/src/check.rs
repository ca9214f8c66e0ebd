//! `gyro check`: what is wrong with a model file, or what it describes.

mod sketch;

use crate::args::CheckArgs;
use crate::failure::Failure;
use crate::show::meshes;
use crate::words::{count, listed, number};
use crate::write::{self, Known};
use crate::{columns, contacts, controllers, remarks, scene};
use gyro_codegen::{Functions, Group};
use gyro_model::{Attachment, Body, Link, Model, Number, Start, Support, Tree};
use std::fmt::Write as _;
use std::io::Write as _;

/// Digits of numbers that are shown.
const DIGITS: usize = 6;

/// Reads the model file, and prints what it is.
pub(crate) fn check(args: &CheckArgs) -> Result<(), Failure> {
    let model = scene::read(&args.model)?;
    let page = args.model.display().to_string();
    let functions = functions(&model).map_err(|words| Failure::Usage(format!("{page}: {words}")))?;
    let start = model.assemble().map_err(|error| Failure::Usage(format!("{page}: {error}")))?;
    meshes::read(&model, &args.model)?;
    let mut text = head(&model) + "\n" + &skeleton(&model, &start) + "\n" + &closure(&model, &start);
    text += &coordinates(&model, &functions);
    text += &numbers(&model);
    remarks::report_redundant(&model, &page, false)?;
    unused(&model).iter().for_each(|name| {
        remarks::warn(&format!("{page}: the parameter `{name}` is used nowhere"));
    });
    if let Some(path) = &args.svg {
        let picture = sketch::svg(&model, &start).map_err(Failure::Run)?;
        write::write(path, &picture, Known::Mark(sketch::MARK))?;
        let _ = writeln!(text, "wrote {}", path.display());
    }
    // Nobody is left to be told if standard output is closed.
    let _ = std::io::stdout().write_all(text.as_bytes());
    Ok(())
}

fn functions(model: &Model) -> Result<Functions, String> {
    match &model.functions {
        None => Ok(Functions::usual()),
        Some(names) => {
            Functions::named(names.iter().map(String::as_str)).map_err(|unknown| unknown.to_string())
        }
    }
}

/// Name and sizes, in one line.
fn head(model: &Model) -> String {
    let n = |items: usize, noun: &str| count(items as u64, noun);
    let moving = model.coordinate_bodies().len();
    let n_loops = Tree::of(model).loop_joints.len();
    let bodies = match model.bodies.len() {
        1 => "1 body".to_owned(),
        all => format!("{all} bodies, {moving} with coordinates"),
    };
    let mut parts = vec![
        bodies,
        n(model.joints.len(), "joint"),
        n(n_loops, "closed loop"),
        format!("{} of freedom", n(model.degrees_of_freedom(), "degree")),
    ];
    let others = [
        (model.couplers.iter().filter(|coupler| coupler.second.is_some()).count(), "coupler"),
        (model.couplers.iter().filter(|coupler| coupler.second.is_none()).count(), "constraint"),
        (model.drivers.len(), "driver"),
        (model.forces.len(), "force"),
        (model.outputs.len(), "output"),
    ];
    parts.extend(others.into_iter().filter(|(items, _)| *items > 0).map(|(items, noun)| n(items, noun)));
    format!("{}: {}\n", model.name, parts.join(", "))
}

/// Bodies and joints as trees from what is fixed, driven or free.
fn skeleton(model: &Model, start: &Start) -> String {
    let tree = Tree::of(model);
    let hangs = |link: &&Link| matches!(link.attachment, Attachment::Joint { .. });
    let is_held = |body: usize| tree.links.iter().filter(hangs).any(|link| link.body == body);
    let mut text = String::new();
    for body in (0..model.bodies.len()).filter(|&body| !is_held(body)) {
        let _ = writeln!(text, "{}", described(model, &model.bodies[body]));
        branches(&mut text, (model, start, &tree), body, "");
    }
    for &joint in &tree.loop_joints {
        let joint = &model.joints[joint];
        let [first, second] = [&joint.first, &joint.second].map(|end| &model.bodies[end.body].name);
        let _ = writeln!(text, "{} ({}) closes a loop: {first} to {second}", joint.name, joint.kind.name());
    }
    text
}

fn branches(text: &mut String, (model, start, tree): (&Model, &Start, &Tree), parent: usize, indent: &str) {
    let held = tree.links.iter().filter_map(|link| match link.attachment {
        Attachment::Joint { joint, parent: from, .. } if from == parent => Some((link.body, joint)),
        _ => None,
    });
    let held: Vec<_> = held.collect();
    for (k, &(body, joint)) in held.iter().enumerate() {
        let (branch, below) = if k + 1 < held.len() { ("├─ ", "│  ") } else { ("└─ ", "   ") };
        let (what, body_words) = (joint_words(model, start, joint), described(model, &model.bodies[body]));
        let _ = writeln!(text, "{indent}{branch}{what} ── {body_words}");
        branches(text, (model, start, tree), body, &format!("{indent}{below}"));
    }
}

/// A joint with its kind and where it starts.
fn joint_words(model: &Model, start: &Start, joint: usize) -> String {
    let (described, at) = (&model.joints[joint], &start.joints[joint].position);
    let coordinates = described.kind.coordinates().iter().zip(at).map(|(kind, &at)| {
        let value = if kind.is_angle() {
            format!("{}°", number(at.to_degrees(), DIGITS))
        } else {
            format!("{} m", number(at, DIGITS))
        };
        if described.kind.coordinates().len() == 1 { value } else { format!("{} {value}", kind.name()) }
    });
    let coordinates: Vec<String> = coordinates.collect();
    let at = if coordinates.is_empty() { String::new() } else { format!(", {}", coordinates.join(", ")) };
    format!("{} ({}{at})", described.name, described.kind.name())
}

fn described(model: &Model, body: &Body) -> String {
    let mass = || format!("{} kg", number(model.value(&body.mass), DIGITS));
    let what = match body.support {
        Support::Fixed => "fixed".to_owned(),
        Support::Constrained => format!("fixed, with coordinates, {}", mass()),
        Support::Driven => "driven".to_owned(),
        Support::Free => format!("free, {}", mass()),
        Support::Moving => mass(),
    };
    format!("{} ({what})", body.name)
}

/// Whether the start closes, and what had to move for that.
fn closure(model: &Model, start: &Start) -> String {
    let mut text = match start.moved.as_slice() {
        [] => "The start satisfies all joints as it is given.\n".to_owned(),
        moved => {
            let shown = moved.iter().take(5).map(|change| {
                let amount = number(change.amount.abs(), 3);
                format!("{}.{} by {amount} {}", change.name, change.coordinate, change.unit)
            });
            let more = if moved.len() > 5 { ", ..." } else { "" };
            format!("The start was closed by moving {}{more}.\n", shown.collect::<Vec<_>>().join(", "))
        }
    };
    let dropped = model.dropped().count();
    if dropped > 0 {
        let rows = count(dropped as u64, "constraint row");
        let _ = writeln!(text, "{rows} dropped, as the others imply them.");
    }
    text
}

/// The coordinates of a run, and the functions of the module.
fn coordinates(model: &Model, functions: &Functions) -> String {
    let names: Vec<String> = columns::coordinates(model).into_iter().map(|shown| shown.name).collect();
    let mut text = "Maximal or joint coordinates.\n".to_owned();
    if !names.is_empty() {
        let _ = writeln!(text, "coordinates: {}", listed(&names));
    }
    let groups = Group::all().filter(|&group| functions.has(group));
    let _ = writeln!(text, "functions: {}", groups.map(Group::name).collect::<Vec<_>>().join(", "));
    text
}

/// Parameters and inputs.
fn numbers(model: &Model) -> String {
    let mut text = String::new();
    for (what, parameters) in [("parameter", &model.parameters), ("input", &model.inputs)] {
        for parameter in parameters {
            let value = number(gyro_model::to_f64(&parameter.value), DIGITS);
            let _ = writeln!(text, "{what} {} = {value}", parameter.name);
        }
    }
    text += &controllers::text(model);
    text += &contacts::text(model);
    for derived in &model.derived_parameters {
        let value = number(model.value(&derived.number), DIGITS);
        let _ = writeln!(text, "computed {} = {} = {value}", derived.name, derived.text);
    }
    text
}

/// Parameters that no number of the mechanism depends on.
fn unused(model: &Model) -> Vec<&str> {
    let numbers = model.numbers();
    let leaves: Vec<&Number> = numbers.into_iter().flat_map(Number::leaves).collect();
    let is_used =
        |k: usize| leaves.iter().any(|leaf| matches!(leaf, Number::Parameter { index, .. } if *index == k));
    let parameters = model.parameters.iter().enumerate();
    parameters.filter(|(k, _)| !is_used(*k)).map(|(_, parameter)| parameter.name.as_str()).collect()
}

#[cfg(test)]
mod tests;
