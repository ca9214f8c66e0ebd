//! The short way to what an axis forces upon a body.

use crate::derive::frames::JointFrames;
use crate::derive::outputs::time_derivative;
use crate::derive::system::System;
use crate::expr::graph::Graph;
use crate::expr::vector::{Mat3, Vec3, ZERO3};
use gyro_model::{JointKind, Support};

/// What γ times the right inverse amounts to where the rows are those of a joint point and an axis, in a few
/// operations.
///
/// The joint point of the second body has the acceleration of the first's. The axis of the second body, u, may only
/// accelerate along that of the first, a, and its length does not change. With Ω = w_j − w_i, all vectors in one frame:
///
/// ```text
/// u̇ = Ω × u,   ü = Ω̇ × u + Ω × (Ω × u) = −(|u̇|² / a·u) a      (seen from the first body)
/// Ω̇ = (Ω·u) Ω × u + (|Ω × u|² / a·u) a × u                     (across u)
/// ẇ_j = Ω̇ + w_i × w_j + ẇ_i
/// ```
#[derive(Clone, Copy, Debug)]
pub struct AxisBias {
    /// Whether the joint point is held too.
    pub holds_point: bool,
    /// Whether the first body is at rest.
    pub first_rests: bool,
    /// A of the first body.
    pub frame_of_first: Mat3,
    /// Angular velocity and axis of the first body, in its frame, and its angular acceleration if that is prescribed.
    first: [Vec3; 3],
    /// Angular velocity and axis of the second body, in its frame.
    second: [Vec3; 2],
}

impl AxisBias {
    /// Only what holds the second body to the first is steered.
    pub fn of(system: &mut System, joint: &JointFrames, reversed: bool) -> Option<Self> {
        let has_axis = matches!(joint.kind, JointKind::Revolute | JointKind::Cylindrical | JointKind::Planar);
        if reversed || !has_axis {
            return None;
        }
        let (i, j) = (system.poses[joint.first.body], system.poses[joint.second.body]);
        let is_driven = system.moving_body_of(joint.first.body).is_none();
        let prescribed = if is_driven { time_derivative(system, &i.w) } else { ZERO3 };
        let holds_point = joint.kind == JointKind::Revolute;
        Some(Self {
            holds_point,
            first_rests: system.model.bodies[joint.first.body].support == Support::Fixed,
            frame_of_first: i.a,
            first: [i.w, joint.first.h, prescribed],
            second: [j.w, joint.second.h],
        })
    }

    /// The `r̈_j + ẇ_j × s_j − r̈_i − ẇ_i × s_i` that keeps the joint points together. Of either body the matrix that
    /// leads to the global frame, and the arm in it.
    pub fn acceleration_of_point(
        &self,
        graph: &mut Graph,
        first: (&Mat3, &Vec3),
        second: (&Mat3, &Vec3),
    ) -> Vec3 {
        let (w_i, w_j) = (graph.mat_vec(first.0, &self.first[0]), graph.mat_vec(second.0, &self.second[0]));
        let (of_first, of_second) = (graph.centripetal(&w_i, first.1), graph.centripetal(&w_j, second.1));
        graph.sub_vec(&of_first, &of_second)
    }

    /// `w × (w × s)` of either body in its own frame, arms too.
    pub fn centripetal(&self, graph: &mut Graph, first: &Vec3, second: &Vec3) -> (Vec3, Vec3) {
        (graph.centripetal(&self.first[0], first), graph.centripetal(&self.second[0], second))
    }

    /// ẇ_j while ẇ_i is zero or as prescribed; both matrices lead to the frame that is asked for.
    pub fn angular_acceleration(&self, graph: &mut Graph, from_first: &Mat3, from_second: &Mat3) -> Vec3 {
        let [w_i, a, prescribed] = self.first.map(|v| graph.mat_vec(from_first, &v));
        let [w_j, u] = self.second.map(|v| graph.mat_vec(from_second, &v));
        let spin = graph.sub_vec(&w_j, &w_i);
        let leaving = graph.cross(&spin, &u);
        let (along, square, cosine) =
            (graph.dot(&spin, &u), graph.dot(&leaving, &leaving), graph.dot(&a, &u));
        let turning = graph.scale_vec(along, &leaving);
        let back = graph.div(square, cosine);
        let towards = graph.cross(&a, &u);
        let towards = graph.scale_vec(back, &towards);
        let relative = graph.add_vec(&turning, &towards);
        let carried = graph.cross(&w_i, &w_j);
        let carried = graph.add_vec(&carried, &prescribed);
        let sum = graph.add_vec(&relative, &carried);
        across(&u, sum)
    }
}

/// Without the component along a coordinate axis: a rotation about it is free.
fn across(h: &Vec3, mut rho: Vec3) -> Vec3 {
    let along: Vec<_> = (0..3).filter(|&k| h[k] != Graph::ZERO).collect();
    if let [along] = along[..] {
        rho[along] = Graph::ZERO;
    }
    rho
}
