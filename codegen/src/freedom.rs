//! How a body may move relative to what holds it: the null space of its joint's rows, and their right inverse.
//!
//! Both are written down from the joint's axes, with no solve. They hold for every configuration, also off the constraint
//! manifold: a dot-1 row with the vector h of one body is blind to rotations about h whatever the other vector is.

use crate::graph::{ExprId, Graph};
use crate::kinematics::Kinematics;
use crate::linear::{Mat3, UNIT3, Vec3, ZERO3};
use crate::system::{JointFrames, System};
use gyro_model::{Attachment, JointKind, Link, RowOwner};
use std::ops::Range;

/// A velocity, virtual displacement or acceleration of a body at its joint point, or a wrench there, its dual.
#[derive(Clone, Copy, Debug)]
pub struct Twist {
    /// Of the joint point, global frame; or a force.
    pub t: Vec3,
    /// Rotation, body frame; or a torque about the joint point.
    pub rho: Vec3,
}

/// A body, what holds it, and how it may move relative to that.
#[derive(Clone, Debug)]
pub struct Freedom {
    pub slot: usize,
    /// The body nearer to the root, if it has coordinates too.
    pub parent: Option<Parent>,
    /// The joint point in the body's frame; its mass centre where no joint holds it.
    pub point: Vec3,
    /// Null space of the rows: with the parent at rest, these twists leave them all unchanged.
    pub free: Vec<Twist>,
    /// The joint's rows among all rows.
    pub rows: Range<usize>,
    /// Right inverse: twist `k` changes row `k` at unit rate and no other.
    pub forced: Vec<Twist>,
}

/// The parent's end of a joint.
#[derive(Clone, Copy, Debug)]
pub struct Parent {
    pub slot: usize,
    /// The joint point in the parent's frame.
    pub point: Vec3,
    /// `A_parentᵀ A_body`.
    pub relative: Mat3,
}

impl Freedom {
    pub fn of(system: &mut System, kinematics: &Kinematics, link: Link) -> Self {
        let slot = system.slot_of(link.body).expect("links have coordinates");
        let (owner, joint, reversed) = match link.attachment {
            Attachment::Free => return Self::whole(slot),
            Attachment::Constrained => (RowOwner::Body(link.body), None, false),
            Attachment::Joint { joint, reversed, .. } => {
                (RowOwner::Joint(joint), Some(system.joints[joint]), reversed)
            }
        };
        let rows = rows_of(system, owner);
        // The point rows are second minus first, whatever the order of the tree.
        let sign = if reversed { system.graph.integer(-1) } else { Graph::ONE };
        let points = UNIT3.map(|unit| Twist { t: system.graph.scale_vec(sign, &unit), rho: ZERO3 });
        let gradients: Vec<Vec3> = rows.clone().skip(3).map(|row| kinematics.rotation(row, slot)).collect();
        let axis = joint.and_then(|joint| free_axis(&mut system.graph, &joint, reversed));
        let rotations = right_inverse(&mut system.graph, &gradients, axis);
        let rotate = |rho| Twist { t: ZERO3, rho };
        let free = match (gradients.len(), axis) {
            (0, _) => UNIT3.map(rotate).to_vec(),
            (_, Some(axis)) => vec![rotate(axis)],
            (_, None) => Vec::new(),
        };
        Self {
            slot,
            parent: joint.and_then(|joint| Parent::of(system, &joint, reversed)),
            point: joint.map_or(ZERO3, |joint| if reversed { joint.first.point } else { joint.second.point }),
            free,
            rows,
            forced: points.into_iter().chain(rotations.into_iter().map(rotate)).collect(),
        }
    }

    /// Nothing holds the body.
    fn whole(slot: usize) -> Self {
        let translations = UNIT3.map(|t| Twist { t, rho: ZERO3 });
        let rotations = UNIT3.map(|rho| Twist { t: ZERO3, rho });
        let free = translations.into_iter().chain(rotations).collect();
        Self { slot, parent: None, point: ZERO3, free, rows: 0..0, forced: Vec::new() }
    }
}

impl Parent {
    fn of(system: &mut System, joint: &JointFrames, reversed: bool) -> Option<Self> {
        let end = if reversed { &joint.second } else { &joint.first };
        let turned = |column: usize| joint.relative.map(|row| row[column]);
        let relative = if reversed { [0, 1, 2].map(turned) } else { joint.relative };
        system.slot_of(end.body).map(|slot| Self { slot, point: end.point, relative })
    }
}

fn rows_of(system: &System, owner: RowOwner) -> Range<usize> {
    let rows = system.model.rows();
    let first = rows.iter().position(|row| row.owner == owner).expect("joints and held bodies have rows");
    first..first + rows.iter().filter(|row| row.owner == owner).count()
}

/// The axis h of the second body, in the frame of the body further from the root, where rotation about it is free.
fn free_axis(graph: &mut Graph, joint: &JointFrames, reversed: bool) -> Option<Vec3> {
    match joint.kind {
        JointKind::Revolute if reversed => Some(graph.mat_vec(&joint.relative, &joint.second.h)),
        JointKind::Revolute => Some(joint.second.h),
        JointKind::Spherical | JointKind::Fixed => None,
    }
}

/// Rotations that change one of the rows with these gradients and not the others; perpendicular to the free axis.
fn right_inverse(graph: &mut Graph, gradients: &[Vec3], axis: Option<Vec3>) -> Vec<Vec3> {
    match (gradients, axis) {
        ([], _) => Vec::new(),
        ([a, b], Some(h)) => {
            let (of_a, of_b) = (graph.cross(b, &h), graph.cross(&h, a));
            let unit = graph.dot(a, &of_a);
            scaled(graph, unit, &[of_a, of_b])
        }
        ([a, b, c], None) => {
            let cofactors = [graph.cross(b, c), graph.cross(c, a), graph.cross(a, b)];
            let determinant = graph.dot(c, &cofactors[2]);
            scaled(graph, determinant, &cofactors)
        }
        _ => unreachable!("a joint forbids no rotation, all but one, or all"),
    }
}

fn scaled(graph: &mut Graph, divisor: ExprId, vectors: &[Vec3]) -> Vec<Vec3> {
    let inverse = graph.recip(divisor);
    vectors.iter().map(|vector| graph.scale_vec(inverse, vector)).collect()
}
