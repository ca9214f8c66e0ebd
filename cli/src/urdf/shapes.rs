//! What links look like: boxes, cylinders and spheres of `<visual>`; meshes have no counterpart.

use super::element::{Findings, child};
use nalgebra::IsometryMatrix3;
use roxmltree::Node;

/// A simple solid of a link.
#[derive(Clone, Debug)]
pub(super) struct Shape {
    /// In the link's frame.
    pub(super) pose: IsometryMatrix3<f64>,
    pub(super) kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    /// Its edges.
    Box([f64; 3]),
    /// Radius and length; its axis is z in both formats.
    Cylinder([f64; 2]),
    /// Its radius.
    Sphere(f64),
}

/// The shapes of a link; a `<visual>` of another kind is left out.
pub(super) fn read(findings: &mut Findings<'_>, link: Node<'_, '_>) -> Vec<Shape> {
    let visuals = link.children().filter(|node| node.has_tag_name("visual"));
    visuals.filter_map(|visual| shape(findings, visual)).collect()
}

fn shape(findings: &mut Findings<'_>, visual: Node<'_, '_>) -> Option<Shape> {
    let geometry = child(visual, "geometry")?;
    let kind = if let Some(node) = child(geometry, "box") {
        Kind::Box(findings.vector_or(node, "size", [0.0; 3])?.into())
    } else if let Some(node) = child(geometry, "cylinder") {
        Kind::Cylinder([findings.number(node, "radius")?, findings.number(node, "length")?])
    } else {
        Kind::Sphere(findings.number(child(geometry, "sphere")?, "radius")?)
    };
    // Some robots have empty shapes: nothing is lost with them.
    let is_seen = match kind {
        Kind::Box(edges) => edges.iter().all(|edge| *edge > 0.0),
        Kind::Cylinder(sizes) => sizes.iter().all(|size| *size > 0.0),
        Kind::Sphere(radius) => radius > 0.0,
    };
    let pose = findings.origin(visual)?;
    is_seen.then_some(Shape { pose, kind })
}

impl Kind {
    /// As a model file writes it.
    pub(super) fn text(self) -> String {
        match self {
            Self::Box([x, y, z]) => format!("box = [{x:?}, {y:?}, {z:?}]"),
            Self::Cylinder([radius, length]) => format!("cylinder = [{radius:?}, {length:?}]"),
            Self::Sphere(radius) => format!("sphere = {radius:?}"),
        }
    }
}
