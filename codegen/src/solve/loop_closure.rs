//! The rows that no joint of the tree owns: joints that close a loop, couplers, drivers. They are met by forces on the
//! tree: with R_l the tree's response to a unit multiplier of row l, `Φ_k R_l λ_l = Φ_k v̇ − γ_k`, a small symmetric
//! positive definite system.

use crate::derive::kinematics::Kinematics;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::solve::articulated_body::{EliminatedTree, Excitation};
use crate::solve::ldl::Elimination;
use std::collections::BTreeMap;

/// What a row's unit multiplier takes from each moving body: its row of (Φ_r, Φ_π').
pub fn gradient(kinematics: &Kinematics, row: usize) -> Vec<SpatialVector> {
    let columns = kinematics.phi_pi[row].chunks_exact(6);
    columns.map(|c| SpatialVector { t: [c[0], c[1], c[2]], rho: [c[3], c[4], c[5]] }).collect()
}

/// Corrects the motions of the free tree, so that these rows change as `rates` of all rows say; returns the multipliers
/// too.
pub fn close(
    graph: &mut Graph,
    kinematics: &Kinematics,
    tree: &EliminatedTree,
    (rows, rates): (&[usize], &[ExprId]),
    mut motions: Vec<SpatialVector>,
) -> (Vec<SpatialVector>, Vec<ExprId>) {
    let gradients: Vec<_> = rows.iter().map(|&row| gradient(kinematics, row)).collect();
    let respond = |gradient: &Vec<SpatialVector>| {
        let bias = gradient.iter().map(|twist| twist.negated(graph)).collect();
        let none = Excitation::none(tree.n_moving_bodies(), tree.joints.len());
        tree.respond(graph, &Excitation { bias, ..none }).motions
    };
    let responses: Vec<_> = gradients.iter().map(respond).collect();
    let mut matrix = BTreeMap::new();
    for (k, gradient) in gradients.iter().enumerate() {
        for (l, response) in responses.iter().enumerate().take(k + 1) {
            matrix.insert((k, l), dot(graph, gradient, response));
        }
    }
    matrix.retain(|_, entry| *entry != Graph::ZERO);
    let excess = rows.iter().zip(&gradients).map(|(&row, gradient)| {
        let rate = dot(graph, gradient, &motions);
        graph.sub(rate, rates[row])
    });
    let excess = excess.collect();
    let multipliers = Elimination::new(matrix, excess).solve_in_order(graph);
    for (response, &multiplier) in responses.iter().zip(&multipliers) {
        for (motion, response) in motions.iter_mut().zip(response) {
            let correction = response.scaled(graph, multiplier).negated(graph);
            *motion = motion.plus(graph, &correction);
        }
    }
    (motions, multipliers)
}

fn dot(graph: &mut Graph, gradient: &[SpatialVector], motions: &[SpatialVector]) -> ExprId {
    gradient.iter().zip(motions).fold(Graph::ZERO, |sum, (wrench, motion)| {
        let product = wrench.dot(graph, motion);
        graph.add(sum, product)
    })
}
