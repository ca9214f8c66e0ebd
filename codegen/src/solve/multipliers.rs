//! λ from the balance of forces, leaf to root: what a body and all that hangs on it lack, its joint supplies.

use crate::derive::armature::known;
use crate::derive::dynamics::Dynamics;
use crate::derive::kinematics::Kinematics;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use crate::solve::articulated_body::{Arm, Inertia};
use crate::solve::loop_closure::gradient;
use crate::solve::motion_subspace::MotionSubspace;

/// The multiplier of each row, in terms of known accelerations and loop multipliers.
pub fn of(
    system: &mut System,
    kinematics: &Kinematics,
    dynamics: &Dynamics,
    subspaces: &[MotionSubspace],
) -> Vec<ExprId> {
    let mut lambda = vec![Graph::ZERO; kinematics.phi.len()];
    let mut lacking: Vec<_> =
        (0..system.moving_bodies.len()).map(|moving_body| imbalance(system, dynamics, moving_body)).collect();
    for (place, row) in system.loop_closure_rows().into_iter().enumerate() {
        lambda[row] = system.graph.symbol(Symbol::LoopMultiplier(place));
        for (lacking, taken) in lacking.iter_mut().zip(gradient(kinematics, row)) {
            let taken = taken.scaled(&mut system.graph, lambda[row]);
            *lacking = lacking.plus(&mut system.graph, &taken);
        }
    }
    for subspace in subspaces.iter().rev() {
        let graph = &mut system.graph;
        let arm = Arm::on_body(graph, subspace);
        let at_joint = arm.wrench(graph, &lacking[subspace.moving_body]);
        for (row, forced) in subspace.rows.clone().zip(&subspace.forced) {
            // M v̇ + Φᵀλ = f.
            let supplied = forced.dot(graph, &at_joint);
            lambda[row] = graph.neg(supplied);
        }
        if let Some(parent) = subspace.parent {
            let carried = parent.wrench(graph, &at_joint);
            lacking[parent.moving_body] = lacking[parent.moving_body].plus(graph, &carried);
        }
    }
    lambda
}

/// `M v̇ − f` of one body, v̇ known.
pub fn imbalance(system: &mut System, dynamics: &Dynamics, moving_body: usize) -> SpatialVector {
    let motion = known(&mut system.graph, moving_body);
    let (inertia, bias) =
        (Inertia::rigid(system, moving_body), dynamics.minus_applied_force(&mut system.graph, moving_body));
    let inertial = inertia.times(&mut system.graph, &motion);
    let mut lacking = inertial.plus(&mut system.graph, &bias);
    for rotor in &dynamics.rotors {
        let (along, acceleration) = (rotor.on(system, moving_body), rotor.acceleration(system));
        let graph = &mut system.graph;
        // The bias of the rotor is among the applied forces.
        let accelerated = graph.sub(acceleration, rotor.bias);
        let taken = graph.mul(rotor.inertia, accelerated);
        let taken = along.scaled(graph, taken);
        lacking = lacking.plus(graph, &taken);
    }
    lacking
}
