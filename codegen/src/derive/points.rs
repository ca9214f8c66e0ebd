//! Points and frames that are fixed in bodies: where they are and how they move.

use crate::derive::system::System;
use crate::expr::graph::ExprId;
use crate::expr::vector::{Mat3, Vec3, Vec4};
use gyro_model::{BodyFrame, Number};

/// A point of a body.
pub struct PointOfBody {
    pub body: usize,
    /// In the body's frame.
    pub point: Vec3,
    /// Global.
    pub position: Vec3,
    pub velocity: Vec3,
}

impl PointOfBody {
    pub fn new(system: &mut System, body: usize, point: &[Number; 3]) -> Self {
        let point = system.numbers(point);
        let pose = system.poses[body];
        let graph = &mut system.graph;
        let (arm, turning) = (graph.mat_vec(&pose.a, &point), graph.cross(&pose.w, &point));
        let turning = graph.mat_vec(&pose.a, &turning);
        let (position, velocity) = (graph.add_vec(&pose.r, &arm), graph.add_vec(&pose.s, &turning));
        Self { body, point, position, velocity }
    }
}

/// Position of a frame's origin, global, and the frame's Euler parameters.
pub fn pose(system: &mut System, frame: &BodyFrame) -> Vec<ExprId> {
    let position = PointOfBody::new(system, frame.body, &frame.point).position;
    let p = system.poses[frame.body].p;
    let p = match orientation(system, frame) {
        Some(own) => system.graph.compose(&p, &own),
        None => p,
    };
    position.into_iter().chain(p).collect()
}

/// Velocity of a frame's origin, global, and the frame's w'.
pub fn velocity(system: &mut System, frame: &BodyFrame) -> Vec<ExprId> {
    let velocity = PointOfBody::new(system, frame.body, &frame.point).velocity;
    let w = by_axes(system, frame, system.poses[frame.body].w);
    velocity.into_iter().chain(w).collect()
}

/// Euler parameters of a frame in its body's; `None` where it has the body's axes.
fn orientation(system: &mut System, frame: &BodyFrame) -> Option<Vec4> {
    let parameters = system.numbers(frame.orientation.as_ref()?);
    Some(system.graph.normalise(&parameters))
}

/// The axes of a frame in its body, column by column; `None` where it has the body's.
pub fn axes(system: &mut System, frame: &BodyFrame) -> Option<Mat3> {
    let p = orientation(system, frame)?;
    Some(system.graph.rotation(&p))
}

/// A vector in a body's frame, by the axes of a frame that is fixed there.
pub fn by_axes(system: &mut System, frame: &BodyFrame, vector: Vec3) -> Vec3 {
    let Some(axes) = axes(system, frame) else { return vector };
    system.graph.transposed_vec(&axes, &vector)
}
