//! What solvers and observers see of a mechanism.

use super::pieces::{list, names, setter};
use crate::point::first_state;
use gyro_model::{CoordinateKind, JointKind, Model, RowOwner, RowUnit};

/// Number of elements of the state.
pub fn n_state(model: &Model) -> usize {
    first_state(model) + model.states.len() + model.turn_references().len()
}

fn coordinates(kind: JointKind) -> String {
    if kind == JointKind::Spherical {
        return "gyro_sim::Coordinate::Orientation".to_owned();
    }
    let name = |is_angle| if is_angle { "Angle" } else { "Length" };
    list(kind.coordinates().iter().map(|c| format!("gyro_sim::Coordinate::{}", name(c.is_angle()))))
}

fn owner(model: &Model, owner: RowOwner) -> String {
    let (kind, index) = match owner {
        RowOwner::Body(body) => {
            let before = model.coordinate_bodies().iter().filter(|&&other| other < body).count();
            ("Body", before)
        }
        RowOwner::Joint(joint) => ("Joint", joint),
        RowOwner::Coupler(coupler) => ("Coupler", coupler),
        RowOwner::Driver(driver) => ("Driver", driver),
    };
    format!("gyro_sim::Owner::{kind}({index})")
}

/// How many numbers are read off all joints: of an angle three, of a length two, of an orientation seven.
pub fn n_readings(model: &Model) -> usize {
    model.joints.iter().map(|joint| n_readings_of(joint.kind)).sum()
}

fn n_readings_of(kind: JointKind) -> usize {
    match kind {
        JointKind::Spherical => 7,
        _ => n_readings_of_all(kind.coordinates()),
    }
}

fn n_readings_of_all(coordinates: &[CoordinateKind]) -> usize {
    coordinates.iter().map(|c| if c.is_angle() { 3 } else { 2 }).sum()
}

/// Where the angle of each turn reference is among the readings.
fn turn_references(model: &Model) -> String {
    let turns = model.turn_references();
    let places = turns.iter().map(|turn| {
        let before: usize = model.joints[..turn.joint].iter().map(|joint| n_readings_of(joint.kind)).sum();
        let own = &model.joints[turn.joint].kind.coordinates()[..turn.coordinate];
        (before + n_readings_of_all(own)).to_string()
    });
    list(places)
}

/// The setter of inputs.
pub(super) fn set_input(model: &Model) -> String {
    setter("fn set_input", &model.inputs, ("self", "", ""))
}

/// Names, rows and sizes.
pub(super) fn description(model: &Model) -> String {
    let bodies = names(model.coordinate_bodies().iter().map(|&body| &model.bodies[body].name));
    let couplers = names(model.couplers.iter().map(|coupler| &coupler.name));
    let drivers = names(model.drivers.iter().map(|driver| &driver.name));
    let inputs = names(model.inputs.iter().map(|input| &input.name));
    let joints = list(model.joints.iter().map(|joint| {
        let (name, coordinates) = (&joint.name, coordinates(joint.kind));
        format!("gyro_sim::JointInfo {{ name: {name:?}, coordinates: &[{coordinates}] }}")
    }));
    let rows = list(model.rows().iter().map(|row| {
        let (owner, is_length) = (owner(model, row.owner), row.unit == RowUnit::Length);
        format!("gyro_sim::RowInfo {{ owner: {owner}, is_length: {is_length} }}")
    }));
    let outputs = list(columns(model).into_iter().map(|(name, suffix, unit)| {
        format!("gyro_sim::OutputInfo {{ name: {name:?}, suffix: {suffix:?}, unit: {unit:?} }}")
    }));
    let (size, has_work, turns) = (model.size(), model.has_work(), turn_references(model));
    format!(
        "gyro_sim::Description {{
            size: {size:?},
            bodies: &[{bodies}],
            joints: &[{joints}],
            couplers: &[{couplers}],
            drivers: &[{drivers}],
            rows: &[{rows}],
            has_work: {has_work},
            turn_references: &[{turns}],
            inputs: &[{inputs}],
            outputs: &[{outputs}]
        }}"
    )
}

/// Numbers of all outputs: name, suffix, unit.
fn columns(model: &Model) -> Vec<(&str, &'static str, &'static str)> {
    let of = |output: &'_ gyro_model::Output| output.kind.columns().to_vec();
    let outputs = model.outputs.iter();
    outputs.flat_map(|o| of(o).into_iter().map(|(suffix, unit)| (o.name.as_str(), suffix, unit))).collect()
}
