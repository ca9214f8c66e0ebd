//! What solvers and observers see of a mechanism.

use super::pieces::{buffers, fillings, list, lookup, name_lookup};
use gyro_model::{CoordinateKind, JointKind, Model, RowOwner, RowUnit};

/// Number of elements of the state.
pub fn n_state(model: &Model) -> usize {
    let n = model.coordinate_bodies().len();
    13 * n + usize::from(model.has_work()) + model.turn_references().len()
}

pub(super) fn ode(model: &Model, name: &str) -> String {
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::Ode for {name}<T> {{
            type Scalar = T;
            type State = [T; {}];
            fn start(&self) -> Self::State {{ HOLE_start }}
            fn derivative(&self, ANY_t: T, ANY_y: &Self::State, dy: &mut Self::State) {{ HOLE_derivative }}
        }}",
        n_state(model)
    )
}

pub(super) fn coordinates(kind: JointKind) -> String {
    if kind == JointKind::Spherical {
        return "gyro_sim::Coordinate::Orientation".to_owned();
    }
    let name = |is_angle| if is_angle { "Angle" } else { "Length" };
    list(kind.coordinates().iter().map(|c| format!("gyro_sim::Coordinate::{}", name(c.is_angle()))))
}

pub(super) fn owner(model: &Model, owner: RowOwner) -> String {
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

pub(super) fn n_readings_of(kind: JointKind) -> usize {
    match kind {
        JointKind::Spherical => 7,
        _ => n_readings_of_all(kind.coordinates()),
    }
}

pub(super) fn n_readings_of_all(coordinates: &[CoordinateKind]) -> usize {
    coordinates.iter().map(|c| if c.is_angle() { 3 } else { 2 }).sum()
}

/// Where the angle of each turn reference is among the readings.
pub(super) fn turn_references(model: &Model) -> String {
    let turns = model.turn_references();
    let places = turns.iter().map(|turn| {
        let before: usize = model.joints[..turn.joint].iter().map(|joint| n_readings_of(joint.kind)).sum();
        let own = &model.joints[turn.joint].kind.coordinates()[..turn.coordinate];
        (before + n_readings_of_all(own)).to_string()
    });
    if turns.is_empty() {
        return String::new();
    }
    format!("fn turn_references(&self) -> &[u16] {{ &[{}] }}", list(places))
}

pub(super) fn mechanism(model: &Model, name: &str, is_tree: bool) -> String {
    let corrected = "fn corrected_derivative(&self, t: T, y: &Self::State, dy: &mut Self::State) {
        HOLE_corrected_derivative
    }";
    let corrected = if is_tree { corrected } else { "" };
    let (n, n_rows) = (model.coordinate_bodies().len(), model.rows().len());
    let [rows, constraints, readings] = [n_rows, n_rows + n, n_readings(model)].map(|n| n.to_string());
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::Mechanism for {name}<T> {{
            type Rows = [T; {rows}];
            type Constraints = [T; {constraints}];
            type Readings = [T; {readings}];
            {}
            {corrected}
            {}
            fn energy(&self, ANY_t: T, ANY_y: &Self::State) -> gyro_sim::Energy<T> {{ HOLE_energy }}
            {}
            {}
        }}",
        buffers(&[
            ("rows", "Rows", &rows),
            ("constraints", "Constraints", &constraints),
            ("readings", "Readings", &readings)
        ]),
        fillings(&[("phi", "Constraints"), ("velocity_residual", "Rows")]),
        fillings(&[("read_joints", "Readings")]),
        descriptions(model),
    )
}

/// Names, rows and sizes.
pub(super) fn descriptions(model: &Model) -> String {
    let moving_bodies = model.coordinate_bodies();
    let bodies: Vec<_> = moving_bodies.iter().map(|&b| &model.bodies[b].name).collect();
    let couplers: Vec<_> = model.couplers.iter().map(|c| &c.name).collect();
    let drivers: Vec<_> = model.drivers.iter().map(|d| &d.name).collect();
    let joint = |name: &str, coordinates: &str| {
        format!("gyro_sim::JointInfo {{ name: {name:?}, coordinates: &[{coordinates}] }}")
    };
    let joints: Vec<_> = model.joints.iter().map(|j| joint(&j.name, &coordinates(j.kind))).collect();
    let row = |owner: &str, is_length: bool| {
        format!("gyro_sim::RowInfo {{ owner: {owner}, is_length: {is_length} }}")
    };
    let rows = model.rows();
    let rows: Vec<_> = rows.iter().map(|r| row(&owner(model, r.owner), r.unit == RowUnit::Length)).collect();
    let work = if model.has_work() {
        format!("fn work(&self, y: &Self::State) -> T {{ y[{}] }}", 13 * moving_bodies.len())
    } else {
        "fn work(&self, _y: &Self::State) -> T { T::constant(0.0) }".to_owned()
    };
    format!(
        "{}
        fn n_bodies(&self) -> usize {{ {} }}
        fn n_joints(&self) -> usize {{ {} }}
        {} {} {} {} {}
        fn size(&self) -> T {{ T::constant({:?}) }}
        {work}",
        turn_references(model),
        moving_bodies.len(),
        model.joints.len(),
        name_lookup("body_name", "body", "BODIES", &bodies),
        lookup(
            "fn joint(&self, joint: usize) -> gyro_sim::JointInfo<'_> JOINTS",
            "joint",
            "gyro_sim::JointInfo<'static>",
            &joints,
            &format!("unwrap_or({})", joint("", "")),
        ),
        name_lookup("coupler_name", "coupler", "COUPLERS", &couplers),
        name_lookup("driver_name", "driver", "DRIVERS", &drivers),
        lookup(
            "fn row(&self, row: usize) -> gyro_sim::RowInfo ROWS",
            "row",
            "gyro_sim::RowInfo",
            &rows,
            &format!("unwrap_or({})", row("gyro_sim::Owner::Body(0)", false)),
        ),
        model.size(),
    )
}
