//! What a body looks like: for pictures only, nothing else asks for it.

use crate::Number;

/// A simple solid, fixed to a body.
#[derive(Clone, Debug)]
pub struct Shape {
    /// What it is, and how large.
    pub kind: ShapeKind,
    /// Its centre in the body's frame, m.
    pub position: [Number; 3],
    /// Euler parameters of its frame in the body's, of any length.
    pub orientation: [Number; 4],
}

/// The kinds of solid.
#[derive(Clone, Debug)]
pub enum ShapeKind {
    /// Edges along x, y and z, m.
    Box([Number; 3]),
    /// Radius and length, m; its axis is z.
    Cylinder([Number; 2]),
    /// Radius, m.
    Sphere(Number),
}
