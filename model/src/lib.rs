//! The description of a mechanism: one TOML file of bodies and joints, read, checked and assembled.
//!
//! [`read`] turns the text of a model file into a [`Model`] or reports every mistake in it at once. [`Model::assemble`]
//! finds the start: consistent positions and velocities from joint angles, rates and angular velocities. The crate
//! knows nothing of code: the generator and the runtime-assembled model both start from a [`Model`].
//!
//! A number in the model file is the rational that its decimal text denotes, so that the generator can fold it exactly.

#![deny(missing_docs)]

mod assemble;
mod attraction;
mod contact;
mod controller;
mod coordinate;
mod coupler;
mod curve;
mod diagnostics;
mod directions;
mod elements;
mod event;
mod frames;
mod joint_kind;
pub mod keys;
mod kinematics;
mod lines;
mod motion;
mod number;
mod numbers;
mod parse;
mod queries;
mod redundancy;
mod scalar;
mod shape;
mod sight;
mod sites;
mod spatial;
mod spline;
mod state;
mod tree;
mod validate;

pub use assemble::{AssemblyError, JointStart, Move, START_TOLERANCE, Start, StartTolerances};
pub use attraction::Attraction;
pub use contact::{Contact, Touching};
pub use controller::{Controller, Law};
pub use coordinate::{CoordinateKind, CoordinateUse, JointCoordinate, Seen};
pub use coupler::{Coupler, Coupling};
pub use curve::{Beyond, Curve, Joined};
pub use diagnostics::{Diagnostic, Diagnostics, Related};
pub use elements::{Driver, Element, Force, ForceKind, ForceParts, LoadFrame, Output, OutputKind, StopSide};
pub use event::{Direction, Event};
pub use frames::{BodyFrame, Bushing, BushingLaw, Relative};
pub use joint_kind::JointKind;
pub use kinematics::Kinematics;
pub use lines::Lines;
pub use motion::{BodyMotion, Motion, Prescribed};
pub use number::{Computation, Formula, Kink, Levels, Number, Operation, Rational, parse_decimal, to_f64};
pub use parse::{column, is_keyword, meant, pi, read, read_with, root};
pub use redundancy::{Analysis, analyse};
pub use shape::{Shape, ShapeKind};
pub use sites::Site;
pub use spatial::{Quaternion, Vector, unit_vector};
pub use spline::Spline;
pub use state::{State, StateStart};
pub use tree::{Attachment, Link, Tree};
pub use validate::{ParameterRule, is_inertia};

/// A mechanism as its model file describes it, checked: indices are in range, axes are not zero, inertias are physical
/// and every body that moves is connected to a fixed, a driven or a free one.
#[derive(Clone, Debug)]
pub struct Model {
    /// Name of the mechanism, an identifier in `snake_case`, used for the generated module.
    pub name: String,
    /// Acceleration of gravity in the global frame, m/s²; zero where a central body attracts in its place.
    pub gravity: [Number; 3],
    /// What attracts in place of a uniform gravity.
    pub attraction: Option<Attraction>,
    /// The numbers that stay tunable, in the order of the model file.
    pub parameters: Vec<Parameter>,
    /// The entries of `[parameters]` that are computed from others, in the order of the model file. Wherever the model
    /// file names one, its computation stands in the model.
    pub derived_parameters: Vec<DerivedParameter>,
    /// Numbers that the caller sets at every step (motor torques), with their values until then. Forces use them, and
    /// motions along straight [`Lines`].
    pub inputs: Vec<Parameter>,
    /// What each input is between the rows of a table that it may follow.
    pub between: Vec<Between>,
    /// All bodies, fixed ones included, in the order of the model file.
    pub bodies: Vec<Body>,
    /// All joints in the order of the model file.
    pub joints: Vec<Joint>,
    /// Gears and other couplings of two joint coordinates.
    pub couplers: Vec<Coupler>,
    /// Joint coordinates prescribed in time.
    pub drivers: Vec<Driver>,
    /// Forces besides gravity and the joints' own friction.
    pub forces: Vec<Force>,
    /// Ready elements, with what they were told: what they stand for is among forces, states, outputs and formulas.
    pub elements: Vec<Element>,
    /// Curves that formulas call, by their places in this list.
    pub curves: Vec<Curve>,
    /// Formulas that have a name. Wherever the model file names one, its operations stand in the model.
    pub formulas: Vec<(String, Formula)>,
    /// Quantities that a differential equation of first order tells, with the motion: see [`State`].
    pub states: Vec<State>,
    /// What is to be computed besides the motion: last, one output for each of the states.
    pub outputs: Vec<Output>,
    /// Sampled controllers, which runs close loops with; generated code knows nothing of them.
    pub controllers: Vec<Controller>,
    /// Events that runs look for; generated code knows nothing of them.
    pub events: Vec<Event>,
    /// Rigid stops and friction that sticks: generated code has their forces, as inputs; runs do the rest.
    pub contacts: Vec<Contact>,
    /// Where rigid surfaces of bodies may touch.
    pub touching: Vec<Touching>,
    /// Constraint rows that depend on others and were dropped, or stay: found by rank when the model file was read.
    pub redundant: Vec<RedundantRow>,
    /// Whether the state carries the work of what is not conservative, where there is such: see [`Model::has_work`].
    pub counts_work: bool,
    /// The functions that the generated module is to have, by their names; `None` where the model file does not say.
    pub functions: Option<Vec<String>>,
    /// What is not wrong in the model file, and yet hardly what was meant, a sentence for each with what to write: a
    /// coordinate direction or a right angle that is nearly, but not exactly, one; degrees in place of radians; a key
    /// by its former name.
    pub remarks: Vec<String>,
    /// How the model file asks to be simulated.
    pub simulation: Simulation,
}

/// A tunable number of the model file with its default.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Identifier in `snake_case`.
    pub name: String,
    /// Value, exact.
    pub value: Rational,
}

/// What an input is between the rows of a table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Between {
    /// The value of the row before.
    Held,
    /// Straight lines.
    #[default]
    Linear,
    /// The natural cubic spline through the rows.
    Smooth,
}

/// An entry of `[parameters]` that is computed from others.
#[derive(Clone, Debug)]
pub struct DerivedParameter {
    /// Identifier in `snake_case`.
    pub name: String,
    /// The expression as the model file writes it.
    pub text: String,
    /// What it computes.
    pub number: Number,
}

/// A rigid body. Its frame has its origin at the mass centre.
#[derive(Clone, Debug)]
pub struct Body {
    /// Name, an identifier.
    pub name: String,
    /// How the body is held.
    pub support: Support,
    /// Mass, kg. Zero where a folded body gives none.
    pub mass: Number,
    /// Inertia tensor about the mass centre in the body frame, kg·m²: `[xx, yy, zz, xy, xz, yz]`.
    pub inertia: [Number; 6],
    /// The origin of the frame in which the model file gives points of the body, seen from the mass centre, m: not zero
    /// of bodies with point masses.
    pub frame: [Number; 3],
    /// Whether the inertia may be one that no rigid body has: a principal moment above the sum of the others.
    pub as_written: bool,
    /// Position of the mass centre in the global frame, m: of fixed bodies, and the start of free ones.
    pub position: [Number; 3],
    /// Euler parameters `(e0, e1, e2, e3)`, not necessarily of unit length: of fixed bodies, and the start of free
    /// ones.
    pub orientation: [Number; 4],
    /// Start of a free body: velocity of the mass centre in the global frame, m/s.
    pub velocity: [Number; 3],
    /// Start: absolute angular velocity in the body frame, rad/s, where the model file gives one.
    pub angular_velocity: Option<[Number; 3]>,
    /// Of a driven body, its motion.
    pub motion: Option<BodyMotion>,
    /// How strongly the assembly of the start holds the body near its guess, relative to other bodies; 1 unless given.
    pub assembly_weight: Number,
    /// What it looks like, as far as the model file says.
    pub shapes: Vec<Shape>,
}

/// How a body is held in space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Support {
    /// Moves as its joints allow.
    Moving,
    /// Moves, and no joint leads from it towards the ground: the root of a tree.
    Free,
    /// Fixed and folded into the formulas: it has no coordinates.
    Fixed,
    /// Fixed, with seven coordinates of its own and six constraint rows, paper eqs. (5) and (6).
    Constrained,
    /// Its whole motion is prescribed in time ([`Body::motion`]) and folded into the formulas: it has no coordinates.
    Driven,
}

/// A joint between two bodies.
#[derive(Clone, Debug)]
pub struct Joint {
    /// Name, an identifier.
    pub name: String,
    /// What the joint constrains.
    pub kind: JointKind,
    /// Where the joint is on the first body.
    pub first: JointEnd,
    /// Where the joint is on the second body.
    pub second: JointEnd,
    /// Viscous damping: torque on the second body is `-damping` times the relative rate (N·m·s/rad). Zero if absent.
    pub damping: Number,
    /// Inertia that turns, or slides, with the joint's one coordinate alone, as a rotor behind a gear does: its kinetic
    /// energy is half of it times the square of the rate (kg·m² or kg). Zero if absent.
    pub armature: Number,
    /// Start of the joint's coordinate, as far as the model file gives one.
    pub start: JointStartSpec,
    /// Screw: advance along the axis per radian, m/rad. Zero otherwise.
    pub lead: Number,
    /// Rod: length, m. Zero otherwise.
    pub length: Number,
}

/// A joint as seen from one of its bodies; all vectors are in that body's frame.
#[derive(Clone, Debug)]
pub struct JointEnd {
    /// Index into [`Model::bodies`].
    pub body: usize,
    /// Joint point from the mass centre, m.
    pub point: [Number; 3],
    /// Joint axis h, of any length but zero.
    pub axis: [Number; 3],
    /// Zero direction f: of any length, made orthogonal to the axis by dropping its part along it.
    pub zero: [Number; 3],
}

/// What the model file says of a joint's start.
#[derive(Clone, Debug, Default)]
pub struct JointStartSpec {
    /// For each of the joint's scalar coordinates its value where the model file gives one: rad (may exceed a turn) or
    /// m.
    pub position: Vec<Option<Number>>,
    /// One number for each scalar coordinate; spherical: the second body's angular velocity relative to the first in
    /// the second body's frame.
    pub rate: Option<Vec<Number>>,
    /// Spherical: Euler parameters of the second body's frame in the first's, of any length.
    pub orientation: Option<[Number; 4]>,
    /// Whether the assembly may change the coordinates given here: they are guesses.
    pub is_rough: bool,
    /// For each scalar coordinate its value and its rate where they are set from outside: the assembly keeps both,
    /// whatever the model file says of them.
    pub set: Vec<[Option<Number>; 2]>,
}

/// How a run is to be made, all times in seconds. Of what the model file does not say there is nothing here: that is
/// chosen by whoever makes the run. Words are those that the command line takes.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// Length of the run.
    pub t_end: f64,
    /// Largest step of the integrator.
    pub step: f64,
    /// Interval between corrections.
    pub correct_every: f64,
    /// Interval between samples; a thousandth of the run where the model file gives none.
    pub sample_every: f64,
    /// What is integrated: `joint` or `maximal`.
    pub coordinates: Option<&'static str>,
    /// The integrator: `rk4`, `tsit5`, `dop853` or `rodas4`.
    pub method: Option<&'static str>,
    /// Error tolerated in each step, relative and absolute alike; never with `rk4`.
    pub tolerance: Option<f64>,
    /// How constraints are kept: `partition`, `closed-form`, `mass-weighted`, `baumgarte=RATE` or `none`.
    pub correction: Option<String>,
}

/// What one scalar constraint row belongs to and measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    /// The joint, body, coupler or driver that owns the row.
    pub owner: RowOwner,
    /// Which of the owner's rows it is, dropped ones counted.
    pub index: usize,
    /// Whether the row is a length (m) or a pure number.
    pub unit: RowUnit,
}

/// Owner of a constraint row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowOwner {
    /// Index into [`Model::bodies`].
    Body(usize),
    /// Index into [`Model::joints`].
    Joint(usize),
    /// Index into [`Model::couplers`].
    Coupler(usize),
    /// Index into [`Model::drivers`].
    Driver(usize),
}

/// A constraint row that depends on the others.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RedundantRow {
    /// The row.
    pub row: Row,
    /// Along which axes its owner's point rows are, those that stay among them: see [`Model::point_axes`].
    pub axes: PointAxes,
    /// Owners of the rows that it depends on, its own among them if they are: their multipliers are not unique.
    pub shared_with: Vec<RowOwner>,
    /// Of each joint that takes part, by its index, which numbers of its reaction (three of the force, three of the
    /// torque) the multipliers of this row could change at will: these are not unique.
    pub loads: Vec<(usize, [bool; 6])>,
    /// Whether the row stays, as how it depends on the others changes along the motion (Bennett's linkage): no
    /// choice of rows keeps its rank everywhere. See [`Model::dependent_rows`].
    pub stays: bool,
}

/// The axes along which coincident points are compared, paper eq. (7).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointAxes {
    /// The global ones.
    Global,
    /// Those of the joint frame (f, g, h) on the first body, with which they turn.
    FirstBody,
}

/// Unit of a constraint row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowUnit {
    /// Metres.
    Length,
    /// A product of unit vectors or an Euler parameter.
    Pure,
}
