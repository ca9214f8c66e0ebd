//! What a body looks like; contacts between bodies ask for some of it.

use crate::Number;

/// A solid or a surface, fixed to a body.
#[derive(Clone, Debug)]
pub struct Shape {
    /// What it is, and how large.
    pub kind: ShapeKind,
    /// Its colour, red, green and blue, where the model file gives one.
    pub color: Option<[u8; 3]>,
    /// Its centre in the body's frame, of a mesh the origin of its file, m.
    pub position: [Number; 3],
    /// Euler parameters of its frame in the body's, of any length.
    pub orientation: [Number; 4],
}

/// The kinds of shape.
#[derive(Clone, Debug)]
pub enum ShapeKind {
    /// Edges along x, y and z, m.
    Box([Number; 3]),
    /// Radius and length, m; its axis is z.
    Cylinder([Number; 2]),
    /// Radius, m.
    Sphere(Number),
    /// Radius, and length between the centres of its round ends, m; its axis is z.
    Capsule([Number; 2]),
    /// Half of its length along x, y and z, m.
    Ellipsoid([Number; 3]),
    /// Radius of the rim's centre line, and that of the rim, m; its axis is z.
    Torus([Number; 2]),
    /// The plane of x and y, and edges of what is drawn of it, m.
    Plane([Number; 2]),
    /// Corners of a convex body, m.
    Vertices(Vec<[Number; 3]>),
    /// Triangles of a file, which only what draws them reads.
    Mesh {
        /// The path as the model file writes it, relative to its folder.
        file: String,
        /// By what the coordinates of the file are multiplied to be in m.
        scale: [Number; 3],
    },
}
