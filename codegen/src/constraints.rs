//! Φ(q, t): the textbook primitives and the joints made of them. Nothing else of a joint is written anywhere: Φ_q, ν and γ
//! are derived from these rows.

use crate::graph::{ExprId, Graph};
use crate::linear::{Mat3, Vec3};
use crate::system::{JointFrames, System};
use gyro_model::{JointKind, Support};

/// All joint rows in the order of `Model::rows`.
pub fn joint_rows(system: &mut System) -> Vec<ExprId> {
    let mut rows = Vec::new();
    for slot in 0..system.slots.len() {
        if system.model.bodies[system.slots[slot]].support == Support::Constrained {
            rows.extend(held(system, slot));
        }
    }
    for joint in system.joints.clone() {
        rows.extend(coincident_points(system, &joint));
        rows.extend(rotation_rows(&mut system.graph, &joint));
    }
    rows
}

/// `pᵀp − 1` of each slot, eq. (12).
pub fn normalisations(system: &mut System) -> Vec<ExprId> {
    let one = Graph::ONE;
    let euler: Vec<_> = system.slots.iter().map(|&body| system.poses[body].p).collect();
    euler
        .iter()
        .map(|p| {
            let square = system.graph.dot(p, p);
            system.graph.sub(square, one)
        })
        .collect()
}

/// A body held where it is given: `r − r0` and the vector part of `p0* p`, eqs. (5) and (6).
fn held(system: &mut System, slot: usize) -> Vec<ExprId> {
    let body = system.slots[slot];
    let (pose, given) = (system.poses[body], system.fixed_pose(body));
    let position = system.graph.sub_vec(&pose.r, &given.r);
    // G(p0) p is the vector part of p0* p.
    let g = system.graph.g_matrix(&given.p);
    let orientation = g.map(|row| system.graph.dot(&row, &pose.p));
    position.into_iter().chain(orientation).collect()
}

/// `r_j + A_j s_j' − r_i − A_i s_i'`, eq. (7).
fn coincident_points(system: &mut System, joint: &JointFrames) -> Vec3 {
    let (i, j) = (system.poses[joint.first.body], system.poses[joint.second.body]);
    let graph = &mut system.graph;
    let (arm_i, arm_j) = (graph.mat_vec(&i.a, &joint.first.point), graph.mat_vec(&j.a, &joint.second.point));
    let (point_i, point_j) = (graph.add_vec(&i.r, &arm_i), graph.add_vec(&j.r, &arm_j));
    graph.sub_vec(&point_j, &point_i)
}

/// The rows that keep the axes parallel, eq. (8), or all directions aligned.
fn rotation_rows(graph: &mut Graph, joint: &JointFrames) -> Vec<ExprId> {
    let (i, j, a) = (&joint.first, &joint.second, &joint.relative);
    match joint.kind {
        JointKind::Spherical => Vec::new(),
        JointKind::Revolute => vec![dot1(graph, &i.f, a, &j.h), dot1(graph, &i.g, a, &j.h)],
        JointKind::Fixed => {
            vec![dot1(graph, &i.f, a, &j.h), dot1(graph, &i.g, a, &j.h), dot1(graph, &i.f, a, &j.g)]
        }
    }
}

/// `a_i'ᵀ A_iᵀ A_j b_j'`, eqs. (9) and (10).
pub fn dot1(graph: &mut Graph, a_i: &Vec3, relative: &Mat3, b_j: &Vec3) -> ExprId {
    let turned = graph.mat_vec(relative, b_j);
    graph.dot(a_i, &turned)
}
