//! What the schema is made from: keys, types and words of model files, as types that hold nothing.

mod controllers;
mod elements;
mod happenings;
mod numbers;

use controllers::Controller;
use elements::{Coupler, Driver, Force, Joint, Output};
use happenings::{Contact, Event};
use numbers::{Name, Number, Orientation, Plain, Vector};
use schemars::JsonSchema;
use std::collections::BTreeMap;

/// The schema as the text of `model.schema.json`.
pub fn schema() -> String {
    let schema = schemars::schema_for!(Model);
    let text = serde_json::to_string_pretty(&schema).expect("a schema is a value of JSON");
    text + "\n"
}

/// A mechanism for gyro-sim. All units are SI.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
struct Model {
    /// Version of the format.
    #[schemars(range(min = 1, max = 1))]
    format: u8,
    /// Name of the mechanism and of the generated module.
    name: Name,
    /// Acceleration of gravity, m/s², global frame.
    gravity: Option<Vector>,
    /// Whether the state carries the work of what is not conservative.
    count_work: Option<bool>,
    simulation: Option<Simulation>,
    generate: Option<Generate>,
    /// Numbers that stay tunable, with their defaults, or expressions of other parameters.
    parameters: Option<BTreeMap<String, Number>>,
    /// Numbers that the caller sets at every step, with their values until then.
    inputs: Option<BTreeMap<String, Input>>,
    #[schemars(length(min = 1))]
    body: Vec<Body>,
    joint: Option<Vec<Joint>>,
    coupler: Option<Vec<Coupler>>,
    driver: Option<Vec<Driver>>,
    force: Option<Vec<Force>>,
    output: Option<Vec<Output>>,
    controller: Option<Vec<Controller>>,
    event: Option<Vec<Event>>,
    contact: Option<Vec<Contact>>,
}

#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "a description")]
enum Input {
    Value(Plain),
    Described(DescribedInput),
}

/// An input with more than its value.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
struct DescribedInput {
    /// The value until the caller sets another.
    value: Plain,
    /// What the input is between the rows of a table; `linear` unless given.
    between: Option<Between>,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[expect(dead_code, reason = "a description")]
enum Between {
    /// Straight lines.
    Linear,
    /// The value of the row before.
    Held,
    /// The natural cubic spline through the rows.
    Smooth,
}

/// How a run is made unless told otherwise. What is not said here is chosen: joint coordinates where there are any, and
/// error control.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
struct Simulation {
    /// Length of the run, s.
    t_end: Option<Plain>,
    /// Steps of fixed length are at most so long, s: those of method "rk4".
    step: Option<Plain>,
    /// Interval between corrections at fixed steps, s.
    correct_every: Option<Plain>,
    /// Interval between samples, s.
    sample_every: Option<Plain>,
    coordinates: Option<Coordinates>,
    method: Option<Method>,
    /// Error tolerated in each step, relative and absolute alike.
    tolerance: Option<Plain>,
    /// How constraints are kept in maximal coordinates: partition, closed-form, mass-weighted, baumgarte=RATE or none.
    #[schemars(regex(pattern = "^(partition|closed-form|mass-weighted|none|baumgarte=.+)$"))]
    correction: Option<String>,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[expect(dead_code, reason = "a description")]
enum Coordinates {
    /// Those of the joints alone.
    Joint,
    /// Positions and Euler parameters of all bodies.
    Maximal,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[expect(dead_code, reason = "a description")]
enum Method {
    /// Kutta's method of order 4, in steps of fixed length.
    Rk4,
    /// Tsitouras's pair of orders 5 and 4, under error control.
    Tsit5,
    /// Dormand and Prince's method of order 8, under error control.
    Dop853,
    /// Rodas, L-stable of order 4, under error control: for stiff scenes.
    Rodas4,
    /// An earlier word for correction = "partition".
    Partitioned,
    /// An earlier word for correction = "none".
    Direct,
}

/// What the generated module has.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
struct Generate {
    /// Functions by their names or by groups.
    functions: Option<Vec<String>>,
}

/// A rigid body. Its frame has its origin at the mass centre.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
struct Body {
    name: Name,
    /// Held and folded into the formulas; or "constrained": by rows on coordinates of its own.
    fixed: Option<Fixed>,
    /// Floats: no joint leads to it from a fixed body.
    free: Option<bool>,
    driven: Option<Driven>,
    /// Mass, kg.
    mass: Option<Number>,
    /// Inertia tensor about the mass centre, kg·m².
    inertia: Option<Inertia>,
    /// Point masses that belong to the body.
    point_mass: Option<Vec<PointMass>>,
    /// Position of the mass centre, m, global frame.
    position: Option<Vector>,
    /// Euler parameters, of any length.
    orientation: Option<Orientation>,
    /// Start: velocity of the mass centre, m/s, global frame.
    velocity: Option<Vector>,
    /// Start: absolute angular velocity, rad/s, body's frame.
    angular_velocity: Option<Vector>,
    /// How strongly the assembly of the start holds the body near its guess.
    assembly_weight: Option<Plain>,
    /// The inertia is taken as it is, though a principal moment exceeds the sum of the others, as no rigid body's does.
    as_written: Option<bool>,
    /// What it looks like; nothing is computed of it.
    shape: Option<Vec<Shape>>,
}

/// A box, a cylinder, a sphere or a mesh.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
struct Shape {
    /// Lengths of the sides, m.
    #[schemars(rename = "box")]
    sides: Option<Vector>,
    /// Radius and length along z, m.
    cylinder: Option<[Number; 2]>,
    /// Radius, m.
    sphere: Option<Number>,
    /// Path of an STL, OBJ or COLLADA file (`.stl`, `.obj`, `.dae`), relative to the model file.
    mesh: Option<String>,
    /// By what the mesh's coordinates are multiplied to be in m: one number, or one for each axis.
    scale: Option<Scale>,
    /// Its colour: a name that CSS has for one, or `#rrggbb`.
    color: Option<String>,
    /// Its centre, m, in the body's frame.
    position: Option<Vector>,
    /// Euler parameters in the body's frame, of any length.
    orientation: Option<Orientation>,
}

#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "a description")]
enum Scale {
    Same(Number),
    Each(Vector),
}

#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "a description")]
enum Fixed {
    Flag(bool),
    Word(FixedWord),
}

#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[expect(dead_code, reason = "a description")]
enum FixedWord {
    Constrained,
}

/// The body's whole motion, prescribed in time.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
struct Driven {
    /// Displacement of the mass centre, m, global frame.
    translation: Option<[numbers::Motion; 3]>,
    /// Rotations, each about an axis that the ones before it have turned.
    rotations: Option<Vec<Rotation>>,
}

#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
struct Rotation {
    axis: Vector,
    /// Angle, rad.
    angle: numbers::Motion,
}

/// Three moments, a table of elements, or a symmetric matrix.
#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "a description")]
enum Inertia {
    Moments(Vector),
    Matrix([Vector; 3]),
    Elements(Elements),
}

/// Elements of the tensor: `xy` is −∫ x y dm.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
struct Elements {
    xx: Number,
    yy: Number,
    zz: Number,
    xy: Option<Number>,
    xz: Option<Number>,
    yz: Option<Number>,
}

/// A mass at a point of a body: the mass centre moves, what is given in the body's frame stays.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
struct PointMass {
    /// Mass, kg.
    mass: Number,
    /// Where it is, m, in the body's frame.
    at: Vector,
}
