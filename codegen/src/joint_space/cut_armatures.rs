//! Armatures of joints that close loops. Such a joint has no rate of its own: what its armature resists is how fast the
//! rates of the tree turn it, `θ̈ = c·u̇ + b`.

use super::closure::{Directions, all_held};
use super::dynamics;
use super::embedding::Embedding;
use super::link_kinematics::LinkKinematics;
use crate::derive::armature::Rotor;
use crate::derive::joint_coordinate;
use crate::derive::system::System;
use crate::expr::definitions::Definitions;
use crate::expr::differentiate::Derivative;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::solve::gram_schmidt::Armature;
use gyro_model::JointCoordinate;
use std::collections::BTreeMap;

/// The armature of a joint that closes a loop.
#[derive(Clone, Debug)]
pub struct CutArmature {
    pub inertia: ExprId,
    /// c, one number for each rate of the state.
    by_rates: Vec<ExprId>,
    /// b.
    bias: ExprId,
}

impl CutArmature {
    pub fn all(system: &mut System, directions: &Directions<'_>, links: &[LinkKinematics]) -> Vec<Self> {
        let joints = system.tree.loop_joints.clone();
        let of = |joint| Self::of(system, directions, links, joint);
        joints.into_iter().filter_map(of).collect()
    }

    fn of(
        system: &mut System,
        directions: &Directions<'_>,
        links: &[LinkKinematics],
        joint: usize,
    ) -> Option<Self> {
        let rotor = Rotor::of(system, joint)?;
        let (layout, none) = (directions.layout, Definitions::default());
        let on = JointCoordinate { joint, coordinate: 0 };
        let mut rate = rotor.rate;
        if !system.model.coordinate_kind(on).is_angle() {
            let value = joint_coordinate::value(system, on);
            let value = system.expanded(&directions.angles.poses, &[value])[0];
            let motion = directions.of_motion(&mut system.graph, system.model);
            rate = Derivative::new(&none, motion).of(&mut system.graph, value);
        }
        let mut values = directions.angles.poses.clone();
        for (moving_body, spin) in dynamics::spins(system, links).into_iter().enumerate() {
            values.extend((0..3).map(|k| (Symbol::Spin { moving_body, k }, spin[k])));
        }
        let rate = system.expanded(&values, &[rate]);
        let held = all_held(system, layout);
        let rate = system.expanded(&held, &rate)[0];
        let graph = &mut system.graph;
        let by_rate = |rate_of_state: usize| {
            let alone = directions.of_rate_alone(graph, rate_of_state);
            Derivative::new(&none, alone).of(graph, rate)
        };
        let by_rates = (0..layout.n_rates).map(by_rate).collect();
        let motion = directions.of_motion(&mut system.graph, system.model);
        let bias = Derivative::new(&none, motion).of(&mut system.graph, rate);
        Some(Self { inertia: rotor.inertia, by_rates, bias })
    }

    /// Takes from the force along each rate what the armature takes if all unknowns are zero.
    pub fn hold_back(&self, graph: &mut Graph, embedding: &Embedding, along: &mut [ExprId]) {
        let turns = self.by_rates.iter().zip(&embedding.rates);
        let acceleration = turns.fold(self.bias, |sum, (&factor, motion)| {
            let part = graph.mul(factor, motion.bias);
            graph.add(sum, part)
        });
        let torque = graph.mul(self.inertia, acceleration);
        for (along, &factor) in along.iter_mut().zip(&self.by_rates) {
            let taken = graph.mul(torque, factor);
            *along = graph.sub(*along, taken);
        }
    }

    /// The inertia with the unknowns that turn it.
    pub fn by_unknowns(&self, graph: &mut Graph, embedding: &Embedding) -> Armature {
        let mut columns = BTreeMap::new();
        for (&factor, motion) in self.by_rates.iter().zip(&embedding.rates) {
            for &(unknown, by_unknown) in &motion.columns {
                let part = graph.mul(factor, by_unknown);
                let sum = columns.entry(unknown).or_insert(Graph::ZERO);
                *sum = graph.add(*sum, part);
            }
        }
        (self.inertia, columns.into_iter().filter(|(_, factor)| *factor != Graph::ZERO).collect())
    }
}
