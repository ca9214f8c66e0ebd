//! How a body may move relative to what holds it: the null space of its joint's rows, and their right inverse.
//!
//! Both are written down from the joint's axes, with no solve. They hold for every configuration, also off the
//! constraint manifold: a dot-1 row with the vector h of one body is blind to rotations about h whatever the other
//! vector is.

use crate::derive::frames::{End, JointFrames};
use crate::derive::joint_coordinate;
use crate::derive::kinematics::Kinematics;
use crate::derive::system::System;
use crate::expr::differentiate::Derivative;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::vector::{Mat3, UNIT3, Vec3, ZERO3};
use crate::solve::axis_bias::AxisBias;
use gyro_model::{Attachment, JointCoordinate, JointKind, Link, RowOwner};
use std::ops::Range;

/// A body, what holds it, and how it may move relative to that.
#[derive(Clone, Debug)]
pub struct MotionSubspace {
    pub moving_body: usize,
    /// The body nearer to the root, if it has coordinates too.
    pub parent: Option<Parent>,
    /// The joint point as the body meets it, in the body's frame; its mass centre where no joint holds it.
    pub point: Vec3,
    /// From the body's frame to that of the translations `t`.
    pub frame: Mat3,
    /// Null space of the rows: with the parent at rest, these twists leave them all unchanged.
    pub free: Vec<SpatialVector>,
    /// The joint's rows among all rows.
    pub rows: Range<usize>,
    /// Right inverse: twist `k` changes row `k` at unit rate and no other.
    pub forced: Vec<SpatialVector>,
    /// The acceleration that the rows force upon the body, its parent at rest: γ times the right inverse.
    pub bias: SpatialVector,
    /// The short way to its rotation.
    pub axis_bias: Option<AxisBias>,
    /// Of each free twist the inertia that resists it besides those of bodies: that of an armature; nothing if none has
    /// any.
    pub armature: Vec<ExprId>,
    /// The force along the free twist by which the armature resists the bias.
    pub held_back: ExprId,
}

/// The parent's end of a joint.
#[derive(Clone, Copy, Debug)]
pub struct Parent {
    pub moving_body: usize,
    /// The joint point as the parent meets it, in the parent's frame.
    pub point: Vec3,
    /// `A_parentᵀ A_body`.
    pub relative: Mat3,
    /// From the parent's frame to that of its translations.
    pub frame: Mat3,
    /// From the frame of the body's translations to that of the parent's.
    pub carried: Mat3,
}

/// How a joint restrains its child relative to its parent at rest.
struct Restraint {
    /// For each row that is a length the displacement that changes it at unit rate, global frame.
    held: Vec<Vec3>,
    /// Displacements that it leaves free, global frame.
    sliding: Vec<Vec3>,
    /// Rotations that it leaves free, in the child's frame.
    turning: Vec<Vec3>,
}

impl MotionSubspace {
    pub fn of(system: &mut System, kinematics: &Kinematics, link: Link) -> Self {
        let moving_body = system.moving_body_of(link.body).expect("links have coordinates");
        match link.attachment {
            Attachment::Free => Self::whole(system, moving_body),
            Attachment::Constrained => Self::held(system, kinematics, link.body, moving_body),
            Attachment::Joint { joint, reversed, .. } => {
                Self::carried(system, kinematics, moving_body, joint, reversed)
            }
        }
    }

    /// In a tree that has no rows, all vectors in the bodies' own frames.
    pub fn of_tree(
        moving_body: usize,
        parent: Option<Parent>,
        point: Vec3,
        free: Vec<SpatialVector>,
    ) -> Self {
        let (frame, bias) = (UNIT3, SpatialVector::ZERO);
        Self {
            moving_body,
            parent,
            point,
            frame,
            free,
            rows: 0..0,
            forced: Vec::new(),
            bias,
            axis_bias: None,
            armature: Vec::new(),
            held_back: Graph::ZERO,
        }
    }

    /// Nothing holds the body.
    fn whole(system: &System, moving_body: usize) -> Self {
        let translations = UNIT3.map(|t| SpatialVector { t, rho: ZERO3 });
        let rotations = UNIT3.map(|rho| SpatialVector { t: ZERO3, rho });
        let free = translations.into_iter().chain(rotations).collect();
        let frame = system.poses[system.moving_bodies[moving_body]].a;
        Self { frame, ..Self::of_tree(moving_body, None, ZERO3, free) }
    }

    /// The body's own six rows hold it.
    fn held(system: &mut System, kinematics: &Kinematics, body: usize, moving_body: usize) -> Self {
        let rows = system.model.rows_of(RowOwner::Body(body));
        let gradients: Vec<_> =
            rows.clone().skip(3).map(|row| kinematics.rotation(row, moving_body)).collect();
        let rotations = right_inverse(&mut system.graph, &gradients, &[]);
        let translations = UNIT3.map(|t| SpatialVector { t, rho: ZERO3 });
        let rotations = rotations.into_iter().map(|rho| SpatialVector { t: ZERO3, rho });
        let forced: Vec<_> = translations.into_iter().chain(rotations).collect();
        let frame = system.poses[body].a;
        let bias = accelerated(&mut system.graph, &kinematics.gamma[rows.clone()], &forced);
        Self { frame, rows, forced, bias, ..Self::of_tree(moving_body, None, ZERO3, Vec::new()) }
    }

    /// A joint holds the body. Its rows measure from the first body to the second, whichever of them is nearer to the
    /// root.
    fn carried(
        system: &mut System,
        kinematics: &Kinematics,
        moving_body: usize,
        index: usize,
        reversed: bool,
    ) -> Self {
        let joint = system.joints[index];
        let rows = system.model.rows_of(RowOwner::Joint(index));
        let restraint = Restraint::of(system, &joint, reversed);
        let sign = system.graph.integer(if reversed { -1 } else { 1 });
        let n_held = restraint.held.len();
        let gradients: Vec<_> =
            rows.clone().skip(n_held).map(|row| kinematics.rotation(row, moving_body)).collect();
        let rotations = right_inverse(&mut system.graph, &gradients, &restraint.turning);
        let held =
            restraint.held.iter().map(|t| SpatialVector { t: system.graph.scale_vec(sign, t), rho: ZERO3 });
        let held: Vec<_> = held.collect();
        let advance = Advance::of(system, &joint, index, moving_body, held.last());
        let turn = |system: &mut System, rho: Vec3| advance.follow(&mut system.graph, rho);
        let turning: Vec<_> = restraint.turning.iter().map(|&rho| turn(system, rho)).collect();
        let rotations: Vec<_> = rotations.into_iter().map(|rho| turn(system, rho)).collect();
        let (first, second) = (restraint.arm_of_first(system, &joint), joint.second.point);
        let (point, parent_point) = if reversed { (first, second) } else { (second, first) };
        let sliding = restraint.sliding.into_iter().map(|t| SpatialVector { t, rho: ZERO3 });
        let forced: Vec<_> = held.into_iter().chain(rotations).collect();
        let mut bias = accelerated(&mut system.graph, &kinematics.gamma[rows.clone()], &forced);
        let is_open = system.loop_closure_rows().is_empty();
        let axis_bias = if is_open { AxisBias::of(system, &joint, reversed) } else { None };
        if let Some(axis_bias) = &axis_bias {
            let back = [0, 1, 2].map(|column| joint.relative.map(|row| row[column]));
            bias.rho = axis_bias.angular_acceleration(&mut system.graph, &back, &UNIT3);
        }
        let free: Vec<_> = sliding.chain(turning).collect();
        let own = &system.model.joints[index].armature;
        let armature = if own.is_zero() { Vec::new() } else { vec![system.number(own)] };
        let held_back = held_back(&mut system.graph, &armature, &free, &bias);
        Self {
            moving_body,
            parent: Parent::of(system, &joint, reversed, parent_point),
            point,
            frame: system.poses[system.moving_bodies[moving_body]].a,
            free,
            rows,
            forced,
            bias,
            axis_bias,
            armature,
            held_back,
        }
    }
}

/// The force along a free twist by which an armature resists the bias. Only that of a rotation has a part along it:
/// displacements that rows force are across.
fn held_back(graph: &mut Graph, armature: &[ExprId], free: &[SpatialVector], bias: &SpatialVector) -> ExprId {
    armature.iter().zip(free).fold(Graph::ZERO, |sum, (&inertia, twist)| {
        let along = graph.dot(&twist.rho, &bias.rho);
        let taken = graph.mul(inertia, along);
        graph.sub(sum, taken)
    })
}

/// What the rows with these right-hand sides force upon a body.
fn accelerated(graph: &mut Graph, gamma: &[ExprId], forced: &[SpatialVector]) -> SpatialVector {
    let parts: Vec<_> = gamma.iter().zip(forced).map(|(&gamma, twist)| twist.scaled(graph, gamma)).collect();
    parts.iter().fold(SpatialVector::ZERO, |sum, part| sum.plus(graph, part))
}

impl MotionSubspace {
    /// What the rows force upon the body, its parent at rest, if these are the changes of all rows.
    pub fn forced_by(&self, graph: &mut Graph, changes: &[ExprId]) -> SpatialVector {
        accelerated(graph, &changes[self.rows.clone()], &self.forced)
    }

    /// The same between the mass centres, all vectors in the global frame.
    pub fn in_global_frame(&self, system: &mut System) -> Self {
        let frame_of = |moving_body: usize| system.poses[system.moving_bodies[moving_body]].a;
        let (a, of_parent) =
            (frame_of(self.moving_body), self.parent.map(|parent| frame_of(parent.moving_body)));
        let graph = &mut system.graph;
        let arm = graph.mat_vec(&a, &self.point);
        let turned = |graph: &mut Graph, twist: &SpatialVector| SpatialVector {
            t: twist.t,
            rho: graph.mat_vec(&a, &twist.rho),
        };
        let moved = |graph: &mut Graph, twist: SpatialVector| {
            let turned = graph.cross(&arm, &twist.rho);
            SpatialVector { t: graph.add_vec(&twist.t, &turned), ..twist }
        };
        let [free, forced]: [Vec<_>; 2] = [&self.free, &self.forced].map(|twists| {
            let twists = twists.iter().map(|twist| {
                let turned = turned(graph, twist);
                moved(graph, turned)
            });
            twists.collect()
        });
        let mut bias = turned(graph, &self.bias);
        if let Some(axis_bias) = &self.axis_bias {
            bias.rho = axis_bias.angular_acceleration(graph, &axis_bias.frame_of_first, &a);
        }
        if let Some(((axis_bias, parent), of_parent)) = self.held_point().zip(of_parent) {
            let arm_of_parent = graph.mat_vec(&of_parent, &parent.point);
            bias.t = axis_bias.acceleration_of_point(graph, (&of_parent, &arm_of_parent), (&a, &arm));
        }
        let held_back = held_back(graph, &self.armature, &free, &bias);
        let bias = moved(graph, bias);
        let parent = self.parent.zip(of_parent).map(|(parent, a)| {
            let point = graph.mat_vec(&a, &parent.point);
            let point = graph.sub_vec(&point, &arm);
            Parent { moving_body: parent.moving_body, point, relative: UNIT3, frame: UNIT3, carried: UNIT3 }
        });
        Self { parent, point: ZERO3, frame: UNIT3, free, forced, bias, held_back, ..self.clone() }
    }
}

impl MotionSubspace {
    /// For a joint that holds an axis and a point of it to a parent with coordinates.
    fn held_point(&self) -> Option<(&AxisBias, &Parent)> {
        let axis_bias = self.axis_bias.as_ref().filter(|axis_bias| axis_bias.holds_point)?;
        Some((axis_bias, self.parent.as_ref()?))
    }

    /// The same with all vectors in the bodies' own frames.
    pub fn in_own_frames(&self, system: &mut System) -> Self {
        let a = system.poses[system.moving_bodies[self.moving_body]].a;
        let graph = &mut system.graph;
        let mut turned =
            |twist: &SpatialVector| SpatialVector { t: graph.transposed_vec(&a, &twist.t), rho: twist.rho };
        let [free, forced] =
            [&self.free, &self.forced].map(|twists| twists.iter().map(&mut turned).collect());
        let mut bias = turned(&self.bias);
        if let Some((axis_bias, parent)) = self.held_point() {
            let (at_first, at_second) = axis_bias.centripetal(graph, &parent.point, &self.point);
            let at_first = graph.transposed_vec(&parent.relative, &at_first);
            bias.t = graph.sub_vec(&at_first, &at_second);
        }
        let parent = self.parent.map(|parent| Parent { frame: UNIT3, carried: parent.relative, ..parent });
        Self { parent, frame: UNIT3, free, forced, bias, ..self.clone() }
    }
}

impl Restraint {
    fn of(system: &mut System, joint: &JointFrames, reversed: bool) -> Self {
        let End { body, f, g, h, .. } = joint.first;
        let a = system.poses[body].a;
        let [along_f, along_g, along_h] = [f, g, h].map(|u| system.graph.mat_vec(&a, &u));
        let (held, sliding) = match joint.kind {
            JointKind::Cylindrical | JointKind::Prismatic | JointKind::PointOnLine => {
                (vec![along_f, along_g], vec![along_h])
            }
            JointKind::Planar => (vec![along_h], vec![along_f, along_g]),
            JointKind::Screw => (vec![along_f, along_g, along_h], Vec::new()),
            _ => (UNIT3.to_vec(), Vec::new()),
        };
        Self { held, sliding, turning: turning(&mut system.graph, joint, reversed) }
    }

    /// Where rows are measured along the first body's directions, that body is touched at the second joint point: there
    /// a rotation of the first body changes them as little as one of the second.
    fn arm_of_first(&self, system: &mut System, joint: &JointFrames) -> Vec3 {
        match joint.kind {
            JointKind::Revolute | JointKind::Spherical | JointKind::Fixed | JointKind::Universal => {
                joint.first.point
            }
            _ => joint_coordinate::arm_on_first(system, joint),
        }
    }
}

/// The rotations that are free, in the frame of the body further from the root. Rows with a vector of a body are blind
/// to rotations about it.
fn turning(graph: &mut Graph, joint: &JointFrames, reversed: bool) -> Vec<Vec3> {
    let second = if reversed { graph.mat_vec(&joint.relative, &joint.second.h) } else { joint.second.h };
    match joint.kind {
        JointKind::Revolute | JointKind::Cylindrical | JointKind::Planar | JointKind::Screw => vec![second],
        JointKind::Universal if reversed => vec![joint.first.h, second],
        JointKind::Universal => vec![graph.transposed_vec(&joint.relative, &joint.first.h), second],
        JointKind::Spherical | JointKind::PointOnLine => UNIT3.to_vec(),
        JointKind::Fixed | JointKind::Prismatic | JointKind::Rod => Vec::new(),
    }
}

/// The displacement that goes with a rotation: none, but along a screw's axis.
struct Advance {
    /// Change of the screw's row, per rotation in the child's frame, and the displacement that makes up for it.
    screw: Option<(Vec3, Vec3)>,
}

impl Advance {
    fn of(
        system: &mut System,
        joint: &JointFrames,
        index: usize,
        moving_body: usize,
        held: Option<&SpatialVector>,
    ) -> Self {
        if joint.kind != JointKind::Screw {
            return Self { screw: None };
        }
        let angle = joint_coordinate::value(system, JointCoordinate { joint: index, coordinate: 0 });
        let gradient = std::array::from_fn(|k| {
            let rotation = system.unit_direction(moving_body, 3 + k);
            let rate = Derivative::new(&system.definitions, rotation).of(&mut system.graph, angle);
            system.graph.mul(joint.lead, rate)
        });
        Self { screw: held.map(|along| (gradient, along.t)) }
    }

    fn follow(&self, graph: &mut Graph, rho: Vec3) -> SpatialVector {
        let Some((gradient, along)) = self.screw else { return SpatialVector { t: ZERO3, rho } };
        let advance = graph.dot(&gradient, &rho);
        SpatialVector { t: graph.scale_vec(advance, &along), rho }
    }
}

impl Parent {
    fn of(system: &mut System, joint: &JointFrames, reversed: bool, point: Vec3) -> Option<Self> {
        let end = if reversed { &joint.second } else { &joint.first };
        let turned = |column: usize| joint.relative.map(|row| row[column]);
        let relative = if reversed { [0, 1, 2].map(turned) } else { joint.relative };
        system.moving_body_of(end.body).map(|moving_body| {
            let frame = system.poses[end.body].a;
            Self { moving_body, point, relative, frame, carried: UNIT3 }
        })
    }
}

/// Rotations that change one of the rows with these gradients and not the others; perpendicular to a single free axis.
pub fn right_inverse(graph: &mut Graph, gradients: &[Vec3], free: &[Vec3]) -> Vec<Vec3> {
    match (gradients, free) {
        ([], _) => Vec::new(),
        ([a], _) => {
            let square = graph.dot(a, a);
            scaled(graph, square, &[*a])
        }
        ([a, b], [h]) => {
            let (of_a, of_b) = (graph.cross(b, h), graph.cross(h, a));
            let unit = graph.dot(a, &of_a);
            scaled(graph, unit, &[of_a, of_b])
        }
        ([a, b, c], []) => {
            let cofactors = [graph.cross(b, c), graph.cross(c, a), graph.cross(a, b)];
            let determinant = graph.dot(c, &cofactors[2]);
            scaled(graph, determinant, &cofactors)
        }
        _ => unreachable!("what a joint does not forbid of the three rotations it leaves free"),
    }
}

fn scaled(graph: &mut Graph, divisor: ExprId, vectors: &[Vec3]) -> Vec<Vec3> {
    let inverse = graph.recip(divisor);
    vectors.iter().map(|vector| graph.scale_vec(inverse, vector)).collect()
}

#[cfg(test)]
mod tests;
