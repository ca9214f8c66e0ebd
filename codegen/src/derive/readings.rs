//! What is read off a state: joint coordinates and rates.

use crate::derive::frames::{JointFrames, sine_and_cosine};
use crate::derive::joint_coordinate::{self, relative_spin};
use crate::derive::system::System;
use crate::expr::graph::ExprId;
use crate::expr::vector::{Mat3, Vec4};
use gyro_model::{CoordinateKind, JointCoordinate, JointKind};

/// The raw readings of all joints: see `gyro_sim::Coordinate`.
pub fn readings(system: &mut System) -> Vec<ExprId> {
    let mut readings = Vec::new();
    for index in 0..system.joints.len() {
        let joint = system.joints[index];
        if joint.kind == JointKind::Spherical {
            readings.extend(relative_euler(system, &joint));
            readings.extend(relative_spin(system, &joint));
        }
        for (coordinate, &kind) in joint.kind.coordinates().iter().enumerate() {
            let place = JointCoordinate { joint: index, coordinate };
            if kind.is_angle() {
                let (sine, cosine) = raw_angle(system, place, kind);
                readings.extend([sine, cosine]);
            } else {
                readings.push(joint_coordinate::value(system, place));
            }
            readings.push(joint_coordinate::rate(system, place));
        }
    }
    readings
}

/// Sine and cosine of an angle up to a common factor, whatever the lengths of p.
pub fn raw_angle(system: &mut System, place: JointCoordinate, kind: CoordinateKind) -> (ExprId, ExprId) {
    let joint = system.joints[place.joint];
    let relative = direction_rotation(system, &joint);
    sine_and_cosine(&mut system.graph, kind, &joint, &relative)
}

/// `A_iᵀ A_j` times |p_i|² |p_j|²: a rotation in direction whatever the length of p, which direct integration loses.
/// Only the ratio of an angle's sine and cosine matters.
fn direction_rotation(system: &mut System, joint: &JointFrames) -> Mat3 {
    let homogeneous = |system: &mut System, body: usize| match system.moving_body_of(body) {
        Some(_) => system.graph.homogeneous_rotation(&system.poses[body].p),
        None => system.poses[body].a,
    };
    let (a_i, a_j) = (homogeneous(system, joint.first.body), homogeneous(system, joint.second.body));
    let columns = |m: Mat3| [0, 1, 2].map(|column| m.map(|row| row[column]));
    let (columns_i, columns_j) = (columns(a_i), columns(a_j));
    columns_i.map(|u| columns_j.map(|v| system.graph.dot(&u, &v)))
}

/// `p_i* p_j`: scalar part p_iᵀp_j, vector part G(p_i) p_j.
pub fn relative_euler(system: &mut System, joint: &JointFrames) -> Vec4 {
    let (p_i, p_j) = (system.poses[joint.first.body].p, system.poses[joint.second.body].p);
    let [x, y, z] = system.graph.g_matrix(&p_i);
    [p_i, x, y, z].map(|row| system.graph.dot(&row, &p_j))
}
