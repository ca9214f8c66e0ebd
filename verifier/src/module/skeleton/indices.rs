//! Where numbers stand, by name.

use super::pieces::lines;
use crate::joints::{Freedom, JointLayout};
use gyro_model::Model;

/// Coordinates of joints that have several, and what is said of all others.
const INNER: [&str; 8] =
    ["", "angle", "displacement", "first_angle", "second_angle", "x", "y", "orientation"];

pub(super) fn indices(model: &Model, joints: Option<&JointLayout>) -> String {
    let columns = model.outputs.iter().map(|output| output.kind.columns().len());
    let before = columns.scan(0, |sum, n| {
        *sum += n;
        Some(*sum - n)
    });
    let all = [
        joints.map(|joints| of_joints(model, joints)).unwrap_or_default(),
        module("input", &constants(model.inputs.iter().map(|p| &p.name).zip(0..))),
        module("output", &constants(model.outputs.iter().map(|p| &p.name).zip(before))),
        module("parameter", &constants(model.parameters.iter().map(|p| &p.name).zip(0..))),
    ];
    format!("#[allow(dead_code, missing_docs)] pub mod index {{ {} }}", all.concat())
}

/// Coordinates, rates; bodies, their rates.
fn of_joints(model: &Model, joints: &JointLayout) -> String {
    let name = |of: Freedom| match of {
        Freedom::Scalar(on) | Freedom::Turn(on) => &model.joints[on.joint].name,
        Freedom::Orientation { joint } => &model.joints[joint].name,
        Freedom::State(state) => &model.states[state].name,
        Freedom::Body { moving_body } => &model.bodies[model.coordinate_bodies()[moving_body]].name,
    };
    let inner = |of: Freedom| match of {
        Freedom::Scalar(on) => match model.joints[on.joint].kind.coordinates() {
            [_] => "",
            several => several[on.coordinate].name(),
        },
        Freedom::Orientation { .. } => "orientation",
        Freedom::Body { .. } => "body",
        Freedom::Turn(_) => "turn",
        Freedom::State(_) => "state",
    };
    let of = |wanted: &str, are_rates: bool| {
        let places = joints.places.iter().filter(|place| inner(place.of) == wanted);
        let at = |place: &crate::joints::Place| {
            if are_rates { joints.n_coordinates + place.u } else { place.x }
        };
        constants(places.map(|place| (name(place.of), at(place))))
    };
    let of_kind = |are_rates: bool| {
        let wrapped = |wanted: &&str| match *wanted {
            "" => of("", are_rates),
            wanted => module(wanted, &of(wanted, are_rates)),
        };
        INNER.iter().map(wrapped).collect::<String>()
    };
    [
        module("joint", &of_kind(false)),
        module("joint_rate", &of_kind(true)),
        module("body", &of("body", false)),
        module("body_rate", &of("body", true)),
        module("state", &of("state", false)),
    ]
    .concat()
}

fn constants<'m>(named: impl Iterator<Item = (&'m String, usize)>) -> String {
    lines(named.map(|(name, place)| format!("pub const {}: usize = {place};", name.to_uppercase())))
}

/// Nothing if it would be empty.
fn module(name: &str, content: &str) -> String {
    if content.is_empty() { String::new() } else { format!("pub mod {name} {{ {content} }}") }
}
