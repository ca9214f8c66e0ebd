//! Frames of joints on their bodies, and what two of them make of each other.

use crate::expr::graph::{ExprId, Graph};
use crate::expr::vector::{Mat3, Vec3};
use gyro_model::{CoordinateKind, JointKind};

/// A joint on one of its bodies, in that body's frame.
#[derive(Clone, Copy, Debug)]
pub struct End {
    pub body: usize,
    pub point: Vec3,
    /// Orthonormal triad: f along the zero direction, h along the axis, g = h × f.
    pub f: Vec3,
    pub g: Vec3,
    pub h: Vec3,
}

/// A joint.
#[derive(Clone, Copy, Debug)]
pub struct JointFrames {
    pub kind: JointKind,
    pub first: End,
    pub second: End,
    /// A_iᵀ A_j: entries are symbols.
    pub relative: Mat3,
    /// Screw: advance per radian. Rod: length.
    pub lead: ExprId,
    pub length: ExprId,
}

/// Sine and cosine of an angle, up to a common positive factor, from `A_iᵀ A_j` up to such a factor.
pub fn sine_and_cosine(
    graph: &mut Graph,
    kind: CoordinateKind,
    joint: &JointFrames,
    relative: &Mat3,
) -> (ExprId, ExprId) {
    let (i, j) = (&joint.first, &joint.second);
    let (sine, cosine) = match kind {
        CoordinateKind::FirstAngle => ((i.g, j.h), (i.f, j.h)),
        CoordinateKind::SecondAngle => ((graph.neg_vec(&i.h), j.g), (i.h, j.f)),
        _ => ((i.g, j.f), (i.f, j.f)),
    };
    (dot1(graph, &sine.0, relative, &sine.1), dot1(graph, &cosine.0, relative, &cosine.1))
}

/// `a_i'ᵀ A_iᵀ A_j b_j'`, eqs. (9) and (10).
pub fn dot1(graph: &mut Graph, a_i: &Vec3, relative: &Mat3, b_j: &Vec3) -> ExprId {
    let turned = graph.mat_vec(relative, b_j);
    graph.dot(a_i, &turned)
}
