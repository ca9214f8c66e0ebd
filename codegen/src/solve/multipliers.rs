//! λ from the balance of forces, leaf to root: what a body and all that hangs on it lack, its joint supplies.

use crate::derive::dynamics::Dynamics;
use crate::derive::kinematics::Kinematics;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use crate::solve::articulated_body::{Arm, Inertia};
use crate::solve::loop_closure::gradient;
use crate::solve::motion_subspace::Freedom;
use std::array::from_fn;

/// The multiplier of each row, in terms of known accelerations and closing multipliers.
pub fn of(
    system: &mut System,
    kinematics: &Kinematics,
    dynamics: &Dynamics,
    freedoms: &[Freedom],
) -> Vec<ExprId> {
    let mut lambda = vec![Graph::ZERO; kinematics.phi.len()];
    let mut lacking: Vec<_> = (0..system.slots.len()).map(|slot| imbalance(system, dynamics, slot)).collect();
    for (place, row) in system.closing_rows().into_iter().enumerate() {
        lambda[row] = system.graph.symbol(Symbol::Closing(place));
        for (lacking, taken) in lacking.iter_mut().zip(gradient(kinematics, row)) {
            let taken = taken.scaled(&mut system.graph, lambda[row]);
            *lacking = lacking.plus(&mut system.graph, &taken);
        }
    }
    for freedom in freedoms.iter().rev() {
        let graph = &mut system.graph;
        let arm = Arm::on_body(graph, freedom);
        let at_joint = arm.wrench(graph, &lacking[freedom.slot]);
        for (row, forced) in freedom.rows.clone().zip(&freedom.forced) {
            // M v̇ + Φᵀλ = f.
            let supplied = forced.dot(graph, &at_joint);
            lambda[row] = graph.neg(supplied);
        }
        if let Some(parent) = freedom.parent {
            let carried = parent.wrench(graph, &at_joint);
            lacking[parent.slot] = lacking[parent.slot].plus(graph, &carried);
        }
    }
    lambda
}

/// `M v̇ − f` of one body, v̇ known.
pub fn imbalance(system: &mut System, dynamics: &Dynamics, slot: usize) -> SpatialVector {
    let mut component = |k| system.graph.symbol(Symbol::Acceleration { slot, k });
    let motion = SpatialVector { t: from_fn(&mut component), rho: from_fn(|k| component(3 + k)) };
    let (inertia, bias) =
        (Inertia::rigid(system, slot), dynamics.minus_applied_force(&mut system.graph, slot));
    let inertial = inertia.times(&mut system.graph, &motion);
    inertial.plus(&mut system.graph, &bias)
}
