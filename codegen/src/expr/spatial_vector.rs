//! Velocities and wrenches of bodies, as expressions.

use crate::expr::graph::{ExprId, Graph};
use crate::expr::vector::{Vec3, ZERO3};

/// A velocity, virtual displacement or acceleration of a body at its joint point, or a wrench there, its dual.
#[derive(Clone, Copy, Debug)]
pub struct SpatialVector {
    /// Of the joint point, global frame (in joint coordinates the body's own); or a force.
    pub t: Vec3,
    /// Rotation, body frame; or a torque about the joint point.
    pub rho: Vec3,
}

impl SpatialVector {
    pub const ZERO: Self = Self { t: ZERO3, rho: ZERO3 };

    /// Three of the displacement or force, then three of the rotation or torque.
    pub fn component(&self, component: usize) -> ExprId {
        if component < 3 { self.t[component] } else { self.rho[component - 3] }
    }

    pub fn component_mut(&mut self, component: usize) -> &mut ExprId {
        if component < 3 { &mut self.t[component] } else { &mut self.rho[component - 3] }
    }

    pub fn dot(&self, graph: &mut Graph, wrench: &Self) -> ExprId {
        let (force, torque) = (graph.dot(&self.t, &wrench.t), graph.dot(&self.rho, &wrench.rho));
        graph.add(force, torque)
    }

    pub fn plus(&self, graph: &mut Graph, other: &Self) -> Self {
        Self { t: graph.add_vec(&self.t, &other.t), rho: graph.add_vec(&self.rho, &other.rho) }
    }

    pub fn scaled(&self, graph: &mut Graph, factor: ExprId) -> Self {
        Self { t: graph.scale_vec(factor, &self.t), rho: graph.scale_vec(factor, &self.rho) }
    }

    pub fn negated(&self, graph: &mut Graph) -> Self {
        Self { t: graph.neg_vec(&self.t), rho: graph.neg_vec(&self.rho) }
    }
}
