//! What a mechanism is made of, as far as a picture of it needs to know.

use crate::Mesh;
use serde::Serialize;
use std::collections::BTreeMap;

/// Bodies and what connects them. Lengths in m, all vectors in the frame of the body that they belong to.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Mechanism {
    /// Its name.
    pub name: String,
    /// Acceleration of gravity, m/s², in the global frame.
    pub gravity: [f64; 3],
    /// All bodies.
    pub bodies: Vec<Body>,
    /// All joints.
    pub joints: Vec<Joint>,
    /// Springs and dampers between points of bodies.
    pub links: Vec<Link>,
    /// Indices of joints along whose coordinate a spring acts.
    pub springs: Vec<usize>,
    /// Forces at points of bodies.
    pub loads: Vec<Load>,
    /// Where bodies touch.
    pub touches: Vec<Touch>,
    /// What acts along the coordinates of joints.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub efforts: Vec<Effort>,
    /// Surfaces that shapes are made of.
    #[serde(skip)]
    pub meshes: Vec<Mesh>,
}

/// A rigid body; the origin of its frame is at its mass centre.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Body {
    /// Its name.
    pub name: String,
    /// Whether it moves.
    pub support: Support,
    /// Whether it floats: no joint tells where it is.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    pub free: bool,
    /// Mass, kg; zero if it is not known.
    pub mass: f64,
    /// `[xx, yy, zz, xy, xz, yz]` about the mass centre, kg·m².
    pub inertia: [f64; 6],
    /// What it looks like, if that is known.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub shapes: Vec<Shape>,
}

/// How a body is held.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Support {
    /// It moves.
    #[default]
    Moving,
    /// It stands still.
    Fixed,
    /// Its motion is prescribed.
    Driven,
}

/// A solid or a surface that is part of a body's look.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Shape {
    /// `box`, `cylinder` (its axis is z), `sphere`, `capsule`, `ellipsoid`, `torus`, `plane`, `vertices` or `mesh`.
    pub kind: &'static str,
    /// Its sizes as model files have them, m; all coordinates of vertices. Of a mesh, by what its coordinates are
    /// multiplied to be in m.
    pub size: Vec<f64>,
    /// Which of the mechanism's meshes it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mesh: Option<usize>,
    /// Its colour, `#rrggbb`, where it is given.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub color: Option<String>,
    /// Its centre in the body's frame, of a mesh the origin of its coordinates, m.
    pub position: [f64; 3],
    /// Euler parameters `(e0, e1, e2, e3)` of its frame in the body's.
    pub orientation: [f64; 4],
}

/// A joint.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Joint {
    /// Its name.
    pub name: String,
    /// Its kind, as model files write it: `revolute`, `prismatic` …
    pub kind: String,
    /// Where it is on its first and on its second body.
    pub ends: [JointEnd; 2],
    /// Screw: advance along the axis per radian, m/rad.
    pub lead: f64,
}

/// A joint as seen from one of its bodies.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct JointEnd {
    /// Index of the body.
    pub body: usize,
    /// Joint point from the mass centre, m.
    pub point: [f64; 3],
    /// Unit joint axis.
    pub axis: [f64; 3],
    /// Unit zero direction.
    pub zero: [f64; 3],
}

/// A spring, a damper or both between two points.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Link {
    /// Its name.
    pub name: String,
    /// Body and point, m, of both ends.
    pub ends: [(usize, [f64; 3]); 2],
    /// N/m.
    pub stiffness: f64,
    /// N·s/m.
    pub damping: f64,
    /// m.
    pub free_length: f64,
    /// N, with which it pushes its points apart, where that is told by a formula.
    pub force: Option<Amount>,
}

/// A force or torque along a coordinate of a joint, on its second body.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Effort {
    /// Index of the joint.
    pub joint: usize,
    /// The coordinate: `angle`, `first_angle`, `second_angle`, `displacement`, `x` or `y`.
    pub coordinate: &'static str,
    /// Title of the coordinate's columns.
    pub title: String,
    /// What it depends on: `spring`, `damper`, `coulomb`, `upper` and `lower` stop, or `motor`.
    pub law: &'static str,
    /// The numbers of the law, by the names that model files have for them.
    pub numbers: BTreeMap<&'static str, Amount>,
}

/// A number of a law.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Amount {
    /// One that the run does not change.
    Value(f64),
    /// An input.
    Input {
        /// Its index.
        input: usize,
        /// 1 or -1, by which it is multiplied.
        sign: i8,
    },
    /// What the run tells: a formula, or the force of a link.
    Output {
        /// Name of the output.
        output: String,
        /// Which of its numbers, or empty.
        part: &'static str,
    },
}

impl Default for Amount {
    fn default() -> Self {
        Self::Value(0.0)
    }
}

/// What acts between two bodies where they touch: on the second, and its opposite on the first at the same place.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Touch {
    /// Its name.
    pub name: String,
    /// Indices of both bodies.
    pub bodies: [usize; 2],
    /// Euler parameters `(e0, e1, e2, e3)` of the frame in the first body, by whose axes force and torque are given.
    pub orientation: [f64; 4],
    /// If the first touches with a plane, a point of that, in its body's frame, m; z points away from it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub plane: Option<[f64; 3]>,
    /// Point of the second body about which the torque is, m.
    pub point: [f64; 3],
    /// N.
    pub force: [Amount; 3],
    /// N·m.
    pub torque: [Amount; 3],
}

/// A force at a point of a body, and a torque.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Load {
    /// Its name.
    pub name: String,
    /// Index of the body.
    pub body: usize,
    /// Point, m.
    pub point: [f64; 3],
    /// N.
    pub force: [Amount; 3],
    /// N·m.
    pub torque: [Amount; 3],
    /// Whether both are given in the body's frame, with which they turn.
    pub in_body: bool,
}
