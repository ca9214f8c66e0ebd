//! The accelerations of the bodies that go with those of the joint coordinates.

use super::coordinates::Coordinates;
use super::dynamics;
use super::link_kinematics::Carriage;
use crate::derive::system::System;
use crate::expr::definitions::Values;
use crate::expr::graph::ExprId;
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use crate::expr::vector::{UNIT3, ZERO3, transposed};
use crate::solve::articulated_body::Arm;
use crate::solve::motion_subspace::{Freedom, Parent};

/// (s̈, ẇ') of each slot by the symbols that stand for them.
pub fn accelerations_by_symbol(accelerations: &[ExprId]) -> Values {
    let symbol = |index: usize| Symbol::Acceleration { slot: index / 6, k: index % 6 };
    accelerations.iter().enumerate().map(|(index, &value)| (symbol(index), value)).collect()
}

/// (s̈, ẇ') of each slot from the rates' rates: translations in each body's own frame, or in the global one.
pub fn outward(system: &mut System, coordinates: &Coordinates, rates: &[ExprId]) -> [Vec<ExprId>; 2] {
    [false, true].map(|is_global| {
        let motions = motions(system, &coordinates.carriages, rates, is_global);
        system.expanded(&coordinates.of_joints, &motions)
    })
}

/// (s̈, ẇ') of each slot from the rates' rates, with translations in the global frame or in each body's own.
pub fn motions(
    system: &mut System,
    carriages: &[Carriage],
    rates: &[ExprId],
    is_global: bool,
) -> Vec<ExprId> {
    let spins: Vec<_> = system.slots.iter().map(|&body| system.poses[body].w).collect();
    let mut motions = vec![SpatialVector::ZERO; spins.len()];
    for carriage in carriages {
        let bias = dynamics::bias(system, carriage, &spins);
        let ground = dynamics::of_ground(system, carriage, &ZERO3);
        let freedom = dynamics::local_freedom(system, carriage);
        let freedom = if is_global { in_global_frame(system, carriage, freedom) } else { freedom };
        let body = system.slots[carriage.slot];
        let parent_frame = match (is_global, carriage.parent) {
            (true, Some(parent)) => system.poses[parent].a,
            (true, None) => UNIT3,
            (false, _) => transposed(&carriage.rotation),
        };
        let own_frame = if is_global { system.poses[body].a } else { UNIT3 };
        let graph = &mut system.graph;
        let (on_parent, on_body) =
            (graph.mat_vec(&parent_frame, &bias.on_parent), graph.mat_vec(&own_frame, &bias.on_body));
        let ground_t = graph.mat_vec(&own_frame, &ground.t);
        let mut motion = SpatialVector { t: graph.add_vec(&on_parent, &on_body), rho: bias.rho };
        motion = motion.plus(graph, &SpatialVector { t: ground_t, rho: ground.rho });
        if let Some(parent) = freedom.parent {
            let carried = parent.twist(graph, &motions[parent.slot]);
            motion = motion.plus(graph, &carried);
        }
        for (free, twist) in carriage.free.iter().zip(&freedom.free).rev() {
            let yielded = twist.scaled(graph, rates[free.rate]);
            motion = motion.plus(graph, &yielded);
        }
        motions[carriage.slot] = Arm::on_body(graph, &freedom).twist(graph, &motion);
    }
    let mut all = Vec::new();
    for (slot, motion) in motions.iter().enumerate() {
        let a = system.poses[system.slots[slot]].a;
        let linear = if is_global { motion.t } else { system.graph.mat_vec(&a, &motion.t) };
        all.extend(linear.into_iter().chain(motion.rho));
    }
    all
}

fn in_global_frame(system: &mut System, carriage: &Carriage, local: Freedom) -> Freedom {
    let frame = system.poses[system.slots[carriage.slot]].a;
    let graph = &mut system.graph;
    let free =
        local.free.iter().map(|twist| SpatialVector { t: graph.mat_vec(&frame, &twist.t), rho: twist.rho });
    let free = free.collect();
    let parent = local.parent.map(|parent| {
        let frame = system.poses[system.slots[parent.slot]].a;
        Parent { frame, carried: UNIT3, ..parent }
    });
    Freedom { frame, free, parent, ..local }
}
