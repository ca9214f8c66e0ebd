//! Bodies that nothing holds and that carry nothing: Newton and Euler, with nothing turned.

use super::layout::Layout;
use super::link_kinematics::LinkKinematics;
use crate::derive::dynamics::gyroscopic_torque;
use crate::derive::joint_coordinate::Load;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::solve::ldl::Elimination;
use gyro_model::Attachment;

/// The accelerations of the rates of such bodies, in mechanisms without loops.
pub fn accelerations(
    system: &mut System,
    (layout, links): (&Layout, &[LinkKinematics]),
    loads: &[Load],
) -> Vec<(usize, ExprId)> {
    let gravity = system.numbers(&system.model.gravity);
    let mut all = Vec::new();
    for (link, LinkKinematics { moving_body, .. }) in layout.links.iter().zip(links) {
        let body = link.link.body;
        let (Attachment::Free, Some(position), Some(orientation)) =
            (link.link.attachment, link.position, link.orientation)
        else {
            continue;
        };
        if links.iter().any(|other| other.parent == Some(body)) {
            continue;
        }
        let (mass, inertia, w) =
            (system.mass(*moving_body), system.inertia(*moving_body), system.poses[body].w);
        let graph = &mut system.graph;
        let inverse = graph.recip(mass);
        let pushed = graph.scale_vec(inverse, &loads[body].force);
        let linear = graph.add_vec(&pushed, &gravity);
        let gyroscopic = gyroscopic_torque(graph, &inertia, &w);
        let torque = graph.sub_vec(&loads[body].torque, &gyroscopic);
        let lower = (0..3).flat_map(|row| (0..=row).map(move |column| (row, column)));
        let entries = lower.map(|(row, column)| ((row, column), inertia[row][column]));
        let entries = entries.filter(|(_, entry)| *entry != Graph::ZERO).collect();
        let angular = Elimination::new(entries, torque.to_vec()).solve_in_order(graph);
        all.extend(linear.into_iter().enumerate().map(|(k, value)| (position.u + k, value)));
        all.extend(angular.into_iter().enumerate().map(|(k, value)| (orientation.u + k, value)));
    }
    all
}
