//! Everything that a module computes, as final expressions of one graph.

use crate::Elimination;
use crate::definitions::Expansion;
use crate::dynamics::{self, Dynamics};
use crate::graph::{ExprId, Graph};
use crate::kinematics::{Kinematics, Matrix, non_zeros};
use crate::null_space;
use crate::partition::Partition;
use crate::saddle;
use crate::system::System;
use gyro_model::Model;

/// Non-zeros with their places.
pub type Sparse = Vec<(usize, usize, ExprId)>;

/// The roots of all generated functions.
#[derive(Debug)]
pub struct Equations<'m> {
    pub model: &'m Model,
    pub graph: Graph,
    /// Joint rows, then normalisations.
    pub phi: Vec<ExprId>,
    pub phi_q: Sparse,
    pub phi_pi: Sparse,
    pub nu: Vec<ExprId>,
    pub gamma: Vec<ExprId>,
    pub velocity_residual: Vec<ExprId>,
    pub applied_force: Vec<ExprId>,
    /// (s̈, ẇ') of each slot.
    pub accelerations: Vec<ExprId>,
    pub lambda: Vec<ExprId>,
    /// (ṙ, ṗ) of each slot.
    pub position_rates: Vec<ExprId>,
    /// Power of the non-conservative forces, where the state carries their work.
    pub power: Option<ExprId>,
    pub kinetic: ExprId,
    pub potential: ExprId,
    pub readings: Vec<ExprId>,
    pub chart_vectors: Vec<ExprId>,
    pub newton_positions: Vec<ExprId>,
    pub solved_velocities: Vec<ExprId>,
}

impl<'m> Equations<'m> {
    pub fn derive(model: &'m Model, elimination: Elimination) -> Self {
        let mut system = System::new(model);
        let kinematics = Kinematics::derive(&mut system);
        let dynamics = Dynamics::derive(&mut system);
        let solution = match elimination {
            Elimination::NullSpace => null_space::solve(&mut system, &kinematics, &dynamics),
            Elimination::Saddle => saddle::solve(&mut system, &kinematics, &dynamics),
        };
        let readings = dynamics::readings(&mut system);
        let partition = Partition::derive(&mut system, &kinematics);

        let definitions = std::mem::take(&mut system.definitions);
        let mut expansion = Expansion::new(&definitions);
        let graph = &mut system.graph;
        let phi_q = expand_matrix(&mut expansion, graph, &kinematics.phi_q);
        let phi_pi = expand_matrix(&mut expansion, graph, &kinematics.phi_pi);
        let gamma = expansion.all(graph, &kinematics.gamma);
        let applied_force = expansion.all(graph, &dynamics.applied_force);
        let velocity_residual = expansion.all(graph, &kinematics.velocity_residual);
        let all_phi: Vec<_> = kinematics.phi.iter().chain(&kinematics.normalisations).copied().collect();
        let phi = expansion.all(graph, &all_phi);
        let nu = expansion.all(graph, &kinematics.nu);
        let readings = expansion.all(graph, &readings);
        let vectors: Vec<_> = partition.chart_vectors.iter().flatten().copied().collect();
        let chart_vectors = expansion.all(graph, &vectors);
        let newton_positions = expansion.all(graph, &partition.positions);
        let solved_velocities = expansion.all(graph, &partition.velocities);
        let power = expansion.of(graph, dynamics.power);

        let accelerations = expansion.all(graph, &solution.accelerations);
        let lambda = expansion.all(graph, &solution.lambda);
        let position_rates = position_rates(&mut system);
        Self {
            model,
            phi,
            phi_q: non_zeros(&phi_q),
            phi_pi: non_zeros(&phi_pi),
            nu,
            gamma,
            velocity_residual,
            applied_force,
            accelerations,
            lambda,
            position_rates,
            power: model.has_work().then_some(power),
            kinetic: dynamics.kinetic,
            potential: dynamics.potential,
            readings,
            chart_vectors,
            newton_positions,
            solved_velocities,
            graph: system.graph,
        }
    }

    pub fn n_slots(&self) -> usize {
        self.accelerations.len() / 6
    }

    pub fn n_rows(&self) -> usize {
        self.lambda.len()
    }

    pub fn n_charts(&self) -> usize {
        self.chart_vectors.len() / 4
    }

    pub fn n_state(&self) -> usize {
        13 * self.n_slots() + usize::from(self.power.is_some())
    }
}

/// (ṙ, ṗ) of each slot by eqs. (16) and (14).
fn position_rates(system: &mut System) -> Vec<ExprId> {
    let poses: Vec<_> = system.slots.iter().map(|&body| system.poses[body]).collect();
    let rates = poses.iter().flat_map(|pose| {
        let p_rate = system.graph.euler_rate(&pose.p, &pose.w);
        pose.s.into_iter().chain(p_rate)
    });
    rates.collect()
}

fn expand_matrix(expansion: &mut Expansion, graph: &mut Graph, matrix: &Matrix) -> Matrix {
    matrix.iter().map(|row| expansion.all(graph, row)).collect()
}
