//! The description of a mechanism: one TOML page of bodies and joints, read, checked and assembled.
//!
//! [`read`] turns the text of a page into a [`Model`] or reports every mistake in it at once. [`Model::assemble`]
//! finds the start: consistent positions and velocities from joint angles, rates and angular velocities. The crate
//! knows nothing of code: the generator and the runtime-assembled twin both start from a [`Model`].
//!
//! A number in the page is the rational that its decimal text denotes, so that the generator can fold it exactly.

#![deny(missing_docs)]

mod assemble;
mod diagnostics;
mod number;
mod parse;
mod spatial;
mod tree;
mod validate;

pub use assemble::{AssemblyError, JointStart, Start};
pub use diagnostics::{Diagnostic, Diagnostics, Related};
pub use number::{Number, Rational, parse_decimal, to_f64};
pub use parse::read;
pub use spatial::{Quaternion, Vector};
pub use tree::{Attachment, Link, Tree};

use std::ops::Range;

/// A mechanism as its page describes it, checked: indices are in range, axes are not zero, inertias are physical and
/// the bodies form trees rooted in a fixed or a free body.
#[derive(Clone, Debug)]
pub struct Model {
    /// Name of the mechanism, an identifier in `snake_case`, used for the generated module.
    pub name: String,
    /// Acceleration of gravity in the global frame, m/s².
    pub gravity: [Number; 3],
    /// The numbers that stay tunable, in the order of the page.
    pub parameters: Vec<Parameter>,
    /// All bodies, fixed ones included, in the order of the page.
    pub bodies: Vec<Body>,
    /// All joints in the order of the page.
    pub joints: Vec<Joint>,
    /// How the page asks to be simulated.
    pub simulation: Simulation,
}

/// A tunable number of the page with its default.
#[derive(Clone, Debug)]
pub struct Parameter {
    /// Identifier in `snake_case`.
    pub name: String,
    /// Value, exact.
    pub value: Rational,
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
    /// Position of the mass centre in the global frame, m: of fixed bodies, and the start of free ones.
    pub position: [Number; 3],
    /// Euler parameters `(e0, e1, e2, e3)`, not necessarily of unit length: of fixed bodies, and the start of free ones.
    pub orientation: [Number; 4],
    /// Start of a free body: velocity of the mass centre in the global frame, m/s.
    pub velocity: [Number; 3],
    /// Start: absolute angular velocity in the body frame, rad/s, where the page gives one.
    pub angular_velocity: Option<[Number; 3]>,
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
    /// Viscous friction: torque on the second body is `-friction` times the relative rate (N·m·s/rad). Zero if absent.
    pub friction: Number,
    /// Start of the joint's coordinate, as far as the page gives one.
    pub start: JointStartSpec,
}

/// The kinds of joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// Rotation about one axis: point rows, eq. (7), and two dot-1 rows, eqs. (9) and (10).
    Revolute,
    /// Coincident points: eq. (7).
    Spherical,
    /// No relative motion: point rows and three dot-1 rows.
    Fixed,
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

/// What the page says of a joint's start.
#[derive(Clone, Debug, Default)]
pub struct JointStartSpec {
    /// Revolute: angle, rad (may exceed a turn).
    pub angle: Option<Number>,
    /// Revolute: rate in rad/s, one number; spherical: the second body's angular velocity relative to the first in the
    /// second body's frame.
    pub rate: Option<Vec<Number>>,
    /// Spherical: Euler parameters of the second body's frame in the first's, of any length.
    pub orientation: Option<[Number; 4]>,
}

/// How a run is to be made, all in seconds.
#[derive(Clone, Debug, PartialEq)]
pub struct Simulation {
    /// Length of the run.
    pub t_end: f64,
    /// Largest step of the integrator.
    pub step: f64,
    /// Interval between corrections.
    pub correct_every: f64,
    /// Interval between samples; a thousandth of the run where the page gives none.
    pub sample_every: f64,
    /// Algorithm.
    pub method: Method,
}

/// The two algorithms of the paper's section 5.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Integration of eq. (17) alone.
    Direct,
    /// With coordinate partitioning: eqs. (18) to (20) after every correction interval.
    Partitioned,
}

/// What one scalar constraint row belongs to and measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Row {
    /// The joint or constrained body that owns the row.
    pub owner: RowOwner,
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
}

/// Unit of a constraint row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowUnit {
    /// Metres.
    Length,
    /// A product of unit vectors or an Euler parameter.
    Pure,
}

impl JointKind {
    /// Number of dot-1 rows that follow the three point rows: the rotations that the joint forbids.
    pub fn n_rotation_rows(self) -> usize {
        match self {
            Self::Revolute => 2,
            Self::Spherical => 0,
            Self::Fixed => 3,
        }
    }
}

impl Model {
    /// The value of a number of the page with the model's parameters as they are.
    pub fn exact(&self, number: &Number) -> Rational {
        match number {
            Number::Exact(value) => value.clone(),
            Number::Parameter { index, negated: false } => self.parameters[*index].value.clone(),
            Number::Parameter { index, negated: true } => -self.parameters[*index].value.clone(),
        }
    }

    /// The same, rounded to the nearest `f64`.
    pub fn value(&self, number: &Number) -> f64 {
        to_f64(&self.exact(number))
    }

    /// A vector of numbers, rounded.
    pub fn values<const N: usize>(&self, numbers: &[Number; N]) -> [f64; N] {
        std::array::from_fn(|k| self.value(&numbers[k]))
    }

    /// Indices of the bodies that have coordinates, in the order of the page: slot `s` of the generalised coordinates
    /// is body `coordinate_bodies()[s]`, with `q[7s..7s + 7] = (r, p)` and velocities `v[6s..6s + 6] = (s, w')`.
    pub fn coordinate_bodies(&self) -> Vec<usize> {
        (0..self.bodies.len()).filter(|&b| self.bodies[b].support != Support::Fixed).collect()
    }

    /// The constraint rows in their order, paper eq. (11), without the Euler-parameter normalisations (which follow,
    /// one for each coordinate body): constrained bodies first, then the joints.
    ///
    /// A constrained body has three position rows `r - r0` and three orientation rows, the vector part of `p0* p`. A
    /// joint has the rows of its point (second minus first, eq. (7)), then its dot-1 rows: `f_i·h_j`, `g_i·h_j`
    /// (eqs. (9), (10)) and, where the joint is fixed, `f_i·g_j`, where (f, g, h) is the joint frame on a body: unit
    /// zero direction, `g = h × f`, unit axis.
    pub fn rows(&self) -> Vec<Row> {
        let row = |owner, unit| Row { owner, unit };
        let mut rows = Vec::new();
        for (index, body) in self.bodies.iter().enumerate() {
            if body.support == Support::Constrained {
                let owner = RowOwner::Body(index);
                rows.extend([row(owner, RowUnit::Length); 3]);
                rows.extend([row(owner, RowUnit::Pure); 3]);
            }
        }
        for (index, joint) in self.joints.iter().enumerate() {
            let owner = RowOwner::Joint(index);
            rows.extend([row(owner, RowUnit::Length); 3]);
            rows.extend(std::iter::repeat_n(row(owner, RowUnit::Pure), joint.kind.n_rotation_rows()));
        }
        rows
    }

    /// The rows of one joint among [`Model::rows`].
    pub fn joint_rows(&self, joint: usize) -> Range<usize> {
        let rows = self.rows();
        let start =
            rows.iter().position(|r| r.owner == RowOwner::Joint(joint)).expect("every joint has rows");
        start..start + 3 + self.joints[joint].kind.n_rotation_rows()
    }

    /// A length typical of the mechanism, m, by which violations of length rows are divided: the largest distance of a
    /// joint point from its body's mass centre, or radius of gyration of a body with coordinates.
    pub fn size(&self) -> f64 {
        let norm = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        let points =
            self.joints.iter().flat_map(|j| [&j.first.point, &j.second.point]).map(|p| norm(self.values(p)));
        let gyration = self.bodies.iter().filter(|b| b.support != Support::Fixed).map(|b| {
            let [xx, yy, zz, ..] = self.values(&b.inertia);
            (xx.max(yy).max(zz) / self.value(&b.mass)).sqrt()
        });
        let size = points.chain(gyration).fold(0.0, f64::max);
        if size > 0.0 { size } else { 1.0 }
    }

    /// Whether some force does work that the energy does not account for (today: viscous friction).
    ///
    /// Such a model carries the work done so far as one more element of its state.
    pub fn has_work(&self) -> bool {
        self.joints.iter().any(|j| !j.friction.is_zero())
    }

    /// The same model with parameters set anew. Start over from the page's start: assemble it again.
    ///
    /// # Errors
    /// The message names the unknown parameter and the nearest one that exists, or what the new value makes unphysical.
    pub fn with_parameters(&self, settings: &[(String, Rational)]) -> Result<Self, String> {
        let mut model = self.clone();
        for (name, value) in settings {
            let Some(parameter) = model.parameters.iter_mut().find(|p| p.name == *name) else {
                return Err(parse::unknown_parameter(self, name));
            };
            parameter.value = value.clone();
        }
        validate::physical(&model).map_or(Ok(model), Err)
    }
}
