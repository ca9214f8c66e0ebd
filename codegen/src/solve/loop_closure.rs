//! The rows that no joint of the tree owns: joints that close a loop, couplers, drivers. They are met by forces on the
//! tree: with R_l the tree's response to a unit multiplier of row l, `Φ_k R_l λ_l = Φ_k v̇ − γ_k`, a small symmetric
//! positive definite system.

use crate::derive::armature::Rotor;
use crate::derive::kinematics::Kinematics;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::solve::articulated_body::{EliminatedTree, Excitation};
use crate::solve::dependence::Yielding;
use crate::solve::ldl::Elimination;
use std::collections::BTreeMap;

/// What a row's unit multiplier takes from each moving body: its row of (Φ_r, Φ_π').
pub fn gradient(kinematics: &Kinematics, row: usize) -> Vec<SpatialVector> {
    let columns = kinematics.phi_pi[row].chunks_exact(6);
    columns.map(|c| SpatialVector { t: [c[0], c[1], c[2]], rho: [c[3], c[4], c[5]] }).collect()
}

/// The armature J of a joint that closes a loop, which resists `b·v̇` (what it takes while no body accelerates is one
/// of the applied forces). With `c = √J b` and `κ = c·v̇` the bodies feel `−cᵀ κ`: it is a row with the multiplier κ
/// that yields by κ.
#[derive(Clone, Debug)]
pub struct CutRotor(
    /// c of each moving body.
    Vec<SpatialVector>,
);

impl CutRotor {
    /// Those of all joints that close loops.
    pub fn all(system: &mut System) -> Vec<Self> {
        let joints = system.tree.loop_joints.clone();
        let rotors: Vec<_> = joints.into_iter().filter_map(|joint| Rotor::of(system, joint)).collect();
        rotors.into_iter().map(|rotor| Self::of(system, &rotor)).collect()
    }

    fn of(system: &mut System, rotor: &Rotor) -> Self {
        let root = system.graph.sqrt(rotor.inertia);
        let n_bodies = system.moving_bodies.len();
        let mut along = |moving_body| {
            let along = rotor.on(system, moving_body);
            along.scaled(&mut system.graph, root)
        };
        Self((0..n_bodies).map(&mut along).collect())
    }
}

/// Corrects the motions of the free tree, so that these rows change as `rates` of all rows say, against the armatures
/// of joints that close loops, but for what dependent rows yield; returns the multipliers too.
pub fn close(
    graph: &mut Graph,
    kinematics: &Kinematics,
    tree: &EliminatedTree,
    (rows, rates): (&[usize], &[ExprId]),
    (rotors, yielding): (&[CutRotor], &Yielding),
    mut motions: Vec<SpatialVector>,
) -> (Vec<SpatialVector>, Vec<ExprId>) {
    let mut gradients: Vec<_> = rows.iter().map(|&row| gradient(kinematics, row)).collect();
    gradients.extend(rotors.iter().map(|rotor| rotor.0.clone()));
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
    for k in rows.len()..gradients.len() {
        let entry = matrix.entry((k, k)).or_insert(Graph::ZERO);
        *entry = graph.add(*entry, Graph::ONE);
    }
    let place = |row: usize| rows.iter().position(|&other| other == row).expect("they close loops");
    for (&(k, l), &more) in yielding {
        let entry = matrix.entry((place(k), place(l))).or_insert(Graph::ZERO);
        *entry = graph.add(*entry, more);
    }
    matrix.retain(|_, entry| *entry != Graph::ZERO);
    let mut wanted: Vec<_> = rows.iter().map(|&row| rates[row]).collect();
    wanted.resize(gradients.len(), Graph::ZERO);
    let excess = wanted.into_iter().zip(&gradients).map(|(wanted, gradient)| {
        let rate = dot(graph, gradient, &motions);
        graph.sub(rate, wanted)
    });
    let excess = excess.collect();
    let mut multipliers = Elimination::new(matrix, excess).solve_in_order(graph);
    for (response, &multiplier) in responses.iter().zip(&multipliers) {
        for (motion, response) in motions.iter_mut().zip(response) {
            let correction = response.scaled(graph, multiplier).negated(graph);
            *motion = motion.plus(graph, &correction);
        }
    }
    multipliers.truncate(rows.len());
    (motions, multipliers)
}

fn dot(graph: &mut Graph, gradient: &[SpatialVector], motions: &[SpatialVector]) -> ExprId {
    gradient.iter().zip(motions).fold(Graph::ZERO, |sum, (wrench, motion)| {
        let product = wrench.dot(graph, motion);
        graph.add(sum, product)
    })
}
