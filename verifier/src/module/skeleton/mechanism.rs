//! What solvers and observers see of a mechanism.

use super::pieces::{buffers, fillings, list, names, setter};
use gyro_model::{CoordinateKind, JointKind, Model, RowOwner, RowUnit};

/// Number of elements of the state.
pub fn n_state(model: &Model) -> usize {
    let n = model.coordinate_bodies().len();
    13 * n + usize::from(model.has_work()) + model.turn_references().len()
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

pub(super) fn mechanism(model: &Model, name: &str) -> String {
    let (n, n_rows, n_outputs) = (model.coordinate_bodies().len(), model.rows().len(), columns(model).len());
    let sizes = [n_rows, n_rows + n, 6 * n, n_readings(model), n_outputs].map(|n| n.to_string());
    let [rows, constraints, velocities, readings, outputs] = &sizes;
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::Mechanism for {name}<T> {{
            type Scalar = T;
            type State = [T; {}];
            type Rows = [T; {rows}];
            type Constraints = [T; {constraints}];
            type Velocities = [T; {velocities}];
            type Readings = [T; {readings}];
            type Outputs = [T; {outputs}];
            fn description(&self) -> &gyro_sim::Description<'_> {{
                const DESCRIPTION: gyro_sim::Description<'static> = {};
                &DESCRIPTION
            }}
            {}
            fn start(&self) -> Self::State {{ HOLE_start }}
            {}
            fn energy(&self, ANY_t: T, ANY_y: &Self::State) -> gyro_sim::Energy<T> {{ HOLE_energy }}
            {}
            {}
        }}",
        n_state(model),
        description(model),
        buffers(
            "buffers",
            "Buffers",
            &[
                ("rows", rows),
                ("constraints", constraints),
                ("velocities", velocities),
                ("readings", readings),
                ("outputs", outputs),
            ],
        ),
        fillings(&[("phi", "Constraints"), ("velocity_residual", "Rows"), ("applied_force", "Velocities")]),
        fillings(&[("read_joints", "Readings"), ("outputs", "Outputs")]),
        setter("fn set_input", &model.inputs, ("self", "", "")),
    )
}

/// Names, rows and sizes.
fn description(model: &Model) -> String {
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
