//! The scalar coordinates of joints: what they are, how fast they change, and what a force along them does to the
//! bodies.

use crate::derive::frames::JointFrames;
use crate::derive::system::System;
use crate::expr::differentiate::Derivative;
use crate::expr::graph::ExprId;
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Vec3, ZERO3};
use gyro_model::{CoordinateKind, JointCoordinate};

/// A force at a body's mass centre, global frame, with a torque, body frame.
#[derive(Clone, Copy, Debug)]
pub struct Load {
    pub force: Vec3,
    pub torque: Vec3,
}

/// The direction in which a displacement is measured, in the first body's frame.
pub fn direction(kind: CoordinateKind, joint: &JointFrames) -> Vec3 {
    match kind {
        CoordinateKind::X => joint.first.f,
        CoordinateKind::Y => joint.first.g,
        _ => joint.first.h,
    }
}

/// `(A_i u')·d` with d from the first joint point to the second, a dot-2 form.
pub fn displacement(system: &mut System, joint: &JointFrames, u: &Vec3) -> ExprId {
    let d = between_points(system, joint);
    let a = system.poses[joint.first.body].a;
    let u = system.graph.mat_vec(&a, u);
    system.graph.dot(&u, &d)
}

/// From the first joint point to the second, global frame: `r_j + A_j s_j' − r_i − A_i s_i'`.
pub fn between_points(system: &mut System, joint: &JointFrames) -> Vec3 {
    let (i, j) = (system.poses[joint.first.body], system.poses[joint.second.body]);
    let graph = &mut system.graph;
    let (arm_i, arm_j) = (graph.mat_vec(&i.a, &joint.first.point), graph.mat_vec(&j.a, &joint.second.point));
    let (point_i, point_j) = (graph.add_vec(&i.r, &arm_i), graph.add_vec(&j.r, &arm_j));
    graph.sub_vec(&point_j, &point_i)
}

/// The second joint point seen from the first body's mass centre, in the first body's frame.
pub fn arm_on_first(system: &mut System, joint: &JointFrames) -> Vec3 {
    let (i, j) = (system.poses[joint.first.body], system.poses[joint.second.body]);
    let graph = &mut system.graph;
    let arm = graph.mat_vec(&j.a, &joint.second.point);
    let point = graph.add_vec(&j.r, &arm);
    let from_centre = graph.sub_vec(&point, &i.r);
    graph.transposed_vec(&i.a, &from_centre)
}

/// The coordinate; of an angle its continuous value, which must be one of `Model::turn_references`.
pub fn value(system: &mut System, coordinate: JointCoordinate) -> ExprId {
    let kind = system.model.coordinate_kind(coordinate);
    if kind.is_angle() {
        let turn = system.turn_of(coordinate);
        return system.graph.symbol(Symbol::Angle(turn));
    }
    let joint = system.joints[coordinate.joint];
    displacement(system, &joint, &direction(kind, &joint))
}

/// The coordinate's rate: of an angle from the bodies' own axes, of a displacement its derivative.
pub fn rate(system: &mut System, coordinate: JointCoordinate) -> ExprId {
    let (joint, kind) = (system.joints[coordinate.joint], system.model.coordinate_kind(coordinate));
    rate_as(system, &joint, kind)
}

/// The rate of a coordinate of this kind.
pub fn rate_as(system: &mut System, joint: &JointFrames, kind: CoordinateKind) -> ExprId {
    let (w_i, w_j) = (system.poses[joint.first.body].w, system.poses[joint.second.body].w);
    match kind {
        CoordinateKind::Angle => {
            let graph = &mut system.graph;
            let (rate_i, rate_j) = (graph.dot(&joint.first.h, &w_i), graph.dot(&joint.second.h, &w_j));
            graph.sub(rate_j, rate_i)
        }
        CoordinateKind::FirstAngle => {
            let carried = system.graph.mat_vec(&joint.relative, &w_j);
            let relative = system.graph.sub_vec(&carried, &w_i);
            system.graph.dot(&joint.first.h, &relative)
        }
        CoordinateKind::SecondAngle => {
            let relative = relative_spin(system, joint);
            system.graph.dot(&joint.second.h, &relative)
        }
        CoordinateKind::Displacement | CoordinateKind::X | CoordinateKind::Y => {
            let value = displacement(system, joint, &direction(kind, joint));
            let motion = system.motion();
            Derivative::new(&system.definitions, motion).of(&mut system.graph, value)
        }
    }
}

/// `w'_j − A_jᵀA_i w'_i`: the second body's angular velocity relative to the first, in the second body's frame.
pub fn relative_spin(system: &mut System, joint: &JointFrames) -> Vec3 {
    let (w_i, w_j) = (system.poses[joint.first.body].w, system.poses[joint.second.body].w);
    let carried = system.graph.transposed_vec(&joint.relative, &w_i);
    system.graph.sub_vec(&w_j, &carried)
}

/// What a unit force along the coordinate does to the joint's first and second body.
pub fn unit_loads(system: &mut System, coordinate: JointCoordinate) -> [Load; 2] {
    let (joint, kind) = (system.joints[coordinate.joint], system.model.coordinate_kind(coordinate));
    unit_loads_as(system, &joint, kind)
}

/// The same along a coordinate of this kind.
pub fn unit_loads_as(system: &mut System, joint: &JointFrames, kind: CoordinateKind) -> [Load; 2] {
    let (h_i, h_j, relative) = (joint.first.h, joint.second.h, joint.relative);
    let torques = |system: &mut System, on_first: Vec3, on_second: Vec3| {
        let on_first = system.graph.neg_vec(&on_first);
        [on_first, on_second].map(|torque| Load { force: ZERO3, torque })
    };
    match kind {
        CoordinateKind::Angle => torques(system, h_i, h_j),
        CoordinateKind::FirstAngle => {
            let on_second = system.graph.transposed_vec(&relative, &h_i);
            torques(system, h_i, on_second)
        }
        CoordinateKind::SecondAngle => {
            let on_first = system.graph.mat_vec(&relative, &h_j);
            torques(system, on_first, h_j)
        }
        kind => along(system, joint, &direction(kind, joint)),
    }
}

/// A unit force along u at the second body's joint point, and its opposite on the first body at the same place.
fn along(system: &mut System, joint: &JointFrames, u: &Vec3) -> [Load; 2] {
    let (a_i, a_j) = (system.poses[joint.first.body].a, system.poses[joint.second.body].a);
    let arm = arm_on_first(system, joint);
    let graph = &mut system.graph;
    let force = graph.mat_vec(&a_i, u);
    let in_second = graph.transposed_vec(&a_j, &force);
    let on_second = Load { force, torque: graph.cross(&joint.second.point, &in_second) };
    let on_first = Load { force: graph.neg_vec(&force), torque: graph.cross(u, &arm) };
    [on_first, on_second]
}
