//! Joints and what acts on them.

use super::numbers::{Motion, Name, Number, Orientation, Plain, Vector};
use schemars::JsonSchema;

/// A joint between two bodies.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
pub(crate) struct Joint {
    name: Name,
    kind: JointKind,
    first: End,
    second: End,
    /// Joint point on both bodies, m.
    point: Option<Vector>,
    /// Direction of the axis on both bodies.
    axis: Option<Vector>,
    /// Direction from which the angle is measured, on both bodies.
    zero: Option<Vector>,
    /// Viscous damping, N·m·s/rad or N·s/m.
    damping: Option<Number>,
    /// The former name of `damping`.
    friction: Option<Number>,
    /// Revolute, prismatic or screw: inertia of a rotor that turns with the coordinate, kg·m² or kg.
    armature: Option<Number>,
    /// Screw: advance, m/rad.
    lead: Option<Number>,
    /// Screw: advance, m a turn.
    pitch: Option<Plain>,
    /// Rod: length, m.
    length: Option<Number>,
    /// Start, rad.
    angle: Option<Number>,
    /// Start, degrees.
    angle_deg: Option<Plain>,
    /// Start, rad.
    first_angle: Option<Number>,
    /// Start, degrees.
    first_angle_deg: Option<Plain>,
    /// Start, rad.
    second_angle: Option<Number>,
    /// Start, degrees.
    second_angle_deg: Option<Plain>,
    /// Start, m.
    displacement: Option<Number>,
    /// Start, m.
    x: Option<Number>,
    /// Start, m.
    y: Option<Number>,
    /// Start, spherical: Euler parameters of the second body in the first.
    orientation: Option<Orientation>,
    /// Start: rate of the coordinate, or of each of several.
    rate: Option<Rate>,
    /// What is given of the start is a guess.
    rough: Option<bool>,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[expect(dead_code, reason = "a description")]
enum JointKind {
    /// Rotation about one axis: `angle`.
    Revolute,
    /// Coincident points.
    Spherical,
    /// No relative motion.
    Fixed,
    /// Two crossing axes at right angles: `first_angle`, `second_angle`.
    Universal,
    /// Rotation about and displacement along one axis: `angle`, `displacement`.
    Cylindrical,
    /// Displacement along one axis: `displacement`.
    Prismatic,
    /// Two displacements in a plane and rotation about its normal: `x`, `y`, `angle`.
    Planar,
    /// Rotation and displacement in a fixed ratio: `angle`.
    Screw,
    /// The second point stays on the first body's axis: `displacement`.
    PointOnLine,
    /// Two points at a fixed distance.
    Rod,
}

#[derive(JsonSchema)]
#[schemars(untagged)]
#[expect(dead_code, reason = "a description")]
enum Rate {
    One(Number),
    Several(Vec<Number>),
}

/// A joint as seen from one of its bodies.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
struct End {
    /// Name of the body.
    body: String,
    /// Joint point from the mass centre, m, in the body's frame.
    point: Option<Vector>,
    /// Direction of the axis in the body's frame.
    axis: Option<Vector>,
    /// Direction from which the angle is measured, in the body's frame.
    zero: Option<Vector>,
}

/// A coordinate of a joint.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
struct JointCoordinate {
    joint: String,
    coordinate: Option<Coordinate>,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[expect(dead_code, reason = "a description")]
enum Coordinate {
    Angle,
    FirstAngle,
    SecondAngle,
    Displacement,
    X,
    Y,
}

/// Second coordinate = ratio · first coordinate + offset: a gear, a belt, a rack.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
pub(crate) struct Coupler {
    name: Name,
    first: JointCoordinate,
    second: JointCoordinate,
    ratio: Number,
    offset: Option<Number>,
}

/// A joint coordinate that is prescribed in time.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
pub(crate) struct Driver {
    name: Name,
    joint: String,
    coordinate: Option<Coordinate>,
    /// rad or m.
    motion: Motion,
}

/// A force besides gravity and the joints' own friction.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
pub(crate) struct Force {
    name: Name,
    kind: ForceKind,
    /// The joint along whose coordinate it acts.
    joint: Option<String>,
    coordinate: Option<Coordinate>,
    /// Spring, stop, link.
    stiffness: Option<Number>,
    /// Spring: where it is relaxed.
    free: Option<Number>,
    /// Damper, stop, link.
    damping: Option<Number>,
    /// Coulomb friction: torque or force of sliding.
    level: Option<Number>,
    /// Coulomb friction: rate at which it reaches 76 % of its level.
    rate: Option<Number>,
    /// Stop: where it is.
    limit: Option<Number>,
    /// Stop: which way is blocked.
    side: Option<Side>,
    /// Stop: the width over which it sets in.
    softness: Option<Number>,
    /// Motor: torque or force, usually an input.
    value: Option<Number>,
    /// Link: an end.
    first: Option<Point>,
    /// Link: the other end.
    second: Option<Point>,
    /// Link: length at which it is relaxed, m.
    free_length: Option<Number>,
    /// Load: the body.
    body: Option<String>,
    /// Load: where the force acts, m, in the body's frame.
    point: Option<Vector>,
    /// Load, N.
    force: Option<Vector>,
    /// Load, N·m.
    torque: Option<Vector>,
    /// Load: the frame in which it is constant.
    frame: Option<Frame>,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[expect(dead_code, reason = "a description")]
enum ForceKind {
    Spring,
    Damper,
    Coulomb,
    Stop,
    Motor,
    Link,
    Load,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[expect(dead_code, reason = "a description")]
enum Side {
    Lower,
    Upper,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[expect(dead_code, reason = "a description")]
enum Frame {
    Global,
    Body,
}

/// A point of a body.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
struct Point {
    body: String,
    /// m, in the body's frame.
    point: Option<Vector>,
}

/// What is computed besides the motion.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
pub(crate) struct Output {
    name: Name,
    kind: OutputKind,
    body: Option<String>,
    /// m, in the body's frame.
    point: Option<Vector>,
    /// Euler parameters of the output's axes in the body's frame.
    orientation: Option<Orientation>,
    joint: Option<String>,
    driver: Option<String>,
    coupler: Option<String>,
    force: Option<String>,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[expect(dead_code, reason = "a description")]
enum OutputKind {
    Pose,
    Velocity,
    Acceleration,
    Inertial,
    Reaction,
    Driver,
    Coupler,
    Spring,
    Link,
    Energy,
    Power,
}
