//! The accelerations of the bodies that go with those of the joint coordinates.

use super::coordinates::Coordinates;
use super::dynamics;
use super::link_kinematics::{Bias, LinkKinematics};
use crate::derive::system::System;
use crate::expr::definitions::{Expansion, Values};
use crate::expr::graph::ExprId;
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use crate::expr::vector::{UNIT3, ZERO3, transposed};
use crate::solve::articulated_body::Arm;
use crate::solve::motion_subspace::{MotionSubspace, Parent};

/// (s̈, ẇ') of each moving body by the symbols that stand for them.
pub fn accelerations_by_symbol(accelerations: &[ExprId]) -> Values {
    let symbol = |index: usize| Symbol::Acceleration { moving_body: index / 6, k: index % 6 };
    accelerations.iter().enumerate().map(|(index, &value)| (symbol(index), value)).collect()
}

/// (s̈, ẇ') of each moving body from the rates' rates, expanded: translations in each body's own frame, or in the
/// global one.
pub fn outward(
    system: &mut System,
    coordinates: &Coordinates,
    expansion: &mut Expansion,
    rates: &[ExprId],
) -> [Vec<ExprId>; 2] {
    [false, true].map(|is_global| {
        let motions = motions(system, &coordinates.links, (rates, Part::All), is_global);
        expansion.all(&mut system.graph, &motions)
    })
}

/// Which part of an acceleration.
#[derive(Clone, Copy, Debug)]
pub enum Part {
    All,
    /// What is linear in the rates' rates: what velocities are of rates, where nothing moves without these.
    Linear,
}

/// (s̈, ẇ') of each moving body from the rates' rates, with translations in the global frame or in each body's own.
pub fn motions(
    system: &mut System,
    links: &[LinkKinematics],
    (rates, part): (&[ExprId], Part),
    is_global: bool,
) -> Vec<ExprId> {
    let spins: Vec<_> = system.moving_bodies.iter().map(|&body| system.poses[body].w).collect();
    let mut motions = vec![SpatialVector::ZERO; spins.len()];
    for link_kinematics in links {
        let (bias, ground) = match part {
            Part::All => (
                dynamics::bias(system, link_kinematics, &spins),
                dynamics::of_ground(system, link_kinematics, &ZERO3),
            ),
            Part::Linear => (Bias::NONE, SpatialVector::ZERO),
        };
        let subspace = dynamics::local_subspace(system, link_kinematics);
        let subspace = if is_global { in_global_frame(system, link_kinematics, subspace) } else { subspace };
        let body = system.moving_bodies[link_kinematics.moving_body];
        let parent_frame = match (is_global, link_kinematics.parent) {
            (true, Some(parent)) => system.poses[parent].a,
            (true, None) => UNIT3,
            (false, _) => transposed(&link_kinematics.rotation),
        };
        let own_frame = if is_global { system.poses[body].a } else { UNIT3 };
        let graph = &mut system.graph;
        let (on_parent, on_body) =
            (graph.mat_vec(&parent_frame, &bias.on_parent), graph.mat_vec(&own_frame, &bias.on_body));
        let ground_t = graph.mat_vec(&own_frame, &ground.t);
        let mut motion = SpatialVector { t: graph.add_vec(&on_parent, &on_body), rho: bias.rho };
        motion = motion.plus(graph, &SpatialVector { t: ground_t, rho: ground.rho });
        if let Some(parent) = subspace.parent {
            let carried = parent.twist(graph, &motions[parent.moving_body]);
            motion = motion.plus(graph, &carried);
        }
        for (free, twist) in link_kinematics.free.iter().zip(&subspace.free).rev() {
            let yielded = twist.scaled(graph, rates[free.rate]);
            motion = motion.plus(graph, &yielded);
        }
        motions[link_kinematics.moving_body] = Arm::on_body(graph, &subspace).twist(graph, &motion);
    }
    let mut all = Vec::new();
    for (moving_body, motion) in motions.iter().enumerate() {
        let a = system.poses[system.moving_bodies[moving_body]].a;
        let linear = if is_global { motion.t } else { system.graph.mat_vec(&a, &motion.t) };
        all.extend(linear.into_iter().chain(motion.rho));
    }
    all
}

fn in_global_frame(
    system: &mut System,
    link_kinematics: &LinkKinematics,
    local: MotionSubspace,
) -> MotionSubspace {
    let frame = system.poses[system.moving_bodies[link_kinematics.moving_body]].a;
    let graph = &mut system.graph;
    let free =
        local.free.iter().map(|twist| SpatialVector { t: graph.mat_vec(&frame, &twist.t), rho: twist.rho });
    let free = free.collect();
    let parent = local.parent.map(|parent| {
        let frame = system.poses[system.moving_bodies[parent.moving_body]].a;
        Parent { frame, carried: UNIT3, ..parent }
    });
    MotionSubspace { frame, free, parent, ..local }
}
