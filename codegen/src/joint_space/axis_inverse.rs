//! Inverse dynamics of an open tree in frames that suit its joints, from base inertial parameters (J. Luh, M. Walker
//! and R. Paul (1980); W. Khalil and J.-F. Kleinfinger (1987)), and its mass matrix there.

use super::axis_derivatives::Entries;
use super::axis_dynamics::{AxisTree, carried, moving, of_ground};
use super::elementary_joints::Freedom;
use super::layout::Place;
use super::mass_moments::Motion;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Mat3, Vec3, ZERO3};
use std::collections::BTreeMap;

impl AxisTree {
    /// The force along each unknown that these accelerations take beyond all that acts on the mechanism.
    pub fn inverse(&self, system: &mut System, unknowns: &[ExprId]) -> Vec<ExprId> {
        let motions = self.motions(system, unknowns);
        let graph = &mut system.graph;
        let loads = self.segments.iter().zip(&motions).map(|(segment, motion)| {
            let taken = segment.moments.wrench(graph, motion).negated(graph);
            segment.applied.plus(graph, &taken)
        });
        let loads = loads.collect();
        let mut left = self.forces(graph, loads);
        for (taken, left) in self.taken_by_armatures(graph, unknowns).into_iter().zip(&mut left) {
            *left = graph.sub(*left, taken);
        }
        self.to_global(graph, &left).into_iter().map(|force| graph.neg(force)).collect()
    }

    /// The force along each unknown that the armatures take.
    fn taken_by_armatures(&self, graph: &mut Graph, unknowns: &[ExprId]) -> Vec<ExprId> {
        let mut taken = vec![Graph::ZERO; self.embedding.rates.len()];
        for segment in &self.segments {
            for (&(_, rate), &armature) in segment.free.iter().zip(&segment.armature) {
                for &(unknown, factor) in &self.embedding.rates[rate].columns {
                    let scaled = graph.mul(armature, factor);
                    let part = graph.mul(scaled, unknowns[unknown]);
                    taken[rate] = graph.add(taken[rate], part);
                }
            }
        }
        self.embedding.projected(graph, &taken)
    }

    /// How each station moves if the unknowns are these, gravity being an acceleration of the ground.
    pub(super) fn motions(&self, system: &mut System, unknowns: &[ExprId]) -> Vec<Motion> {
        let accelerations = self.embedding.rates_of_rates(&mut system.graph, unknowns);
        let accelerations = self.felt(system, accelerations);
        let mut motions: Vec<Motion> = Vec::new();
        for segment in &self.segments {
            let from = match segment.station.parent {
                Some(parent) => motions[parent],
                None => of_ground(system, segment.station.ground),
            };
            let by = (&segment.frame, accelerations.as_slice());
            motions.push(moving(&mut system.graph, &segment.station, by, from));
        }
        motions
    }

    /// The force along each unknown that holds the mechanism at rest against gravity.
    pub fn gravity(&self, system: &mut System) -> Vec<ExprId> {
        let felt = self.felt(system, vec![Graph::ZERO; self.embedding.rates.len()]);
        let mut motions: Vec<Motion> = Vec::new();
        for segment in &self.segments {
            let from = match segment.station.parent {
                Some(parent) => motions[parent].t,
                None => of_resting_ground(system, segment.station.ground),
            };
            let graph = &mut system.graph;
            let mut motion = Motion::new(graph, from, ZERO3, ZERO3);
            if let Freedom::Whole { position, .. } = segment.station.freedom {
                motion.t = [0, 1, 2].map(|k| felt[position.u + k]);
            }
            for by in segment.frame.moves.iter().rev() {
                motion = motion.back(graph, by);
            }
            motions.push(motion);
        }
        let graph = &mut system.graph;
        let mut wrenches: Vec<_> =
            self.segments.iter().zip(&motions).map(|(s, motion)| s.moments.wrench(graph, motion)).collect();
        let mut forces = vec![Graph::ZERO; self.embedding.rates.len()];
        for (index, segment) in self.segments.iter().enumerate().rev() {
            segment.free.iter().for_each(|&(k, rate)| forces[rate] = wrenches[index].component(k));
            let Some(parent) = segment.station.parent else { continue };
            let on_parent = carried(graph, &segment.frame, wrenches[index]);
            wrenches[parent] = wrenches[parent].plus(graph, &on_parent);
        }
        let mut forces = self.embedding.projected(graph, &forces);
        // What a body that nothing holds weighs, with all that hangs on it, is the same however it is turned.
        for (index, segment) in self.segments.iter().enumerate() {
            if let Freedom::Whole { position, .. } = segment.station.freedom {
                let mass = self.carried_mass(&mut system.graph, index);
                let gravity = system.numbers(&system.model.gravity);
                let weight = system.graph.scale_vec(mass, &gravity);
                let held = system.graph.neg_vec(&weight);
                forces[position.u..position.u + 3].copy_from_slice(&held);
            }
        }
        forces
    }

    /// The mass of a station and of all that hangs on it.
    fn carried_mass(&self, graph: &mut Graph, root: usize) -> ExprId {
        let mut is_carried = vec![false; self.segments.len()];
        let mut mass = Graph::ZERO;
        for (index, segment) in self.segments.iter().enumerate() {
            is_carried[index] =
                index == root || segment.station.parent.is_some_and(|parent| is_carried[parent]);
            if is_carried[index] {
                mass = graph.add(mass, segment.moments.mass);
            }
        }
        mass
    }

    /// The accelerations of all rates, those of a body that nothing holds in its own frame and less that of gravity.
    fn felt(&self, system: &mut System, mut accelerations: Vec<ExprId>) -> Vec<ExprId> {
        let gravity = system.numbers(&system.model.gravity);
        let graph = &mut system.graph;
        for (position, rotation) in self.wholes(graph) {
            let global = [0, 1, 2].map(|k| accelerations[position.u + k]);
            let felt = graph.sub_vec(&global, &gravity);
            let local = graph.transposed_vec(&rotation, &felt);
            accelerations[position.u..position.u + 3].copy_from_slice(&local);
        }
        accelerations
    }

    /// Numbers for each unknown, those of displacements of a body that nothing holds from its own frame to the global
    /// one.
    pub(super) fn to_global(&self, graph: &mut Graph, local: &[ExprId]) -> Vec<ExprId> {
        let mut all = local.to_vec();
        for (position, rotation) in self.wholes(graph) {
            let global = graph.mat_vec(&rotation, &[0, 1, 2].map(|k| local[position.u + k]));
            all[position.u..position.u + 3].copy_from_slice(&global);
        }
        all
    }

    /// Where the displacements of bodies that nothing holds stand, and their rotations.
    fn wholes(&self, graph: &mut Graph) -> Vec<(Place, Mat3)> {
        let mut wholes = Vec::new();
        for segment in &self.segments {
            if let Freedom::Whole { position, orientation } = segment.station.freedom {
                let p = [0, 1, 2, 3].map(|k| graph.symbol(Symbol::Unit(orientation.x + k)));
                wholes.push((position, graph.rotation(&p)));
            }
        }
        wholes
    }

    /// The force along each unknown of all that acts on the mechanism but gravity.
    pub fn acting(&self, system: &mut System) -> Vec<ExprId> {
        let loads = self.segments.iter().map(|segment| segment.applied).collect();
        let acting = self.forces(&mut system.graph, loads);
        self.to_global(&mut system.graph, &acting)
    }

    /// Entries in whose rows displacements of a body that nothing holds are in its own frame, in the global one.
    pub fn rows_to_global(&self, graph: &mut Graph, mut entries: Entries) -> Entries {
        for (position, rotation) in self.wholes(graph) {
            for column in 0..self.embedding.n_unknowns {
                let place = |k: usize| (position.u + k, column);
                let local = [0, 1, 2].map(|k| entries.get(&place(k)).copied().unwrap_or(Graph::ZERO));
                let global = graph.mat_vec(&rotation, &local);
                (0..3).for_each(|k| _ = entries.insert(place(k), global[k]));
            }
        }
        entries
    }

    /// The lower triangle of the mass matrix, displacements of a body that nothing holds in the global frame.
    pub fn global_mass_matrix(&self, graph: &mut Graph) -> BTreeMap<(usize, usize), ExprId> {
        let mut matrix = self.mass_matrix(graph);
        for (position, rotation) in self.wholes(graph) {
            let local = [0, 1, 2].map(|k| position.u + k);
            for other in (0..self.embedding.n_unknowns).filter(|other| !local.contains(other)) {
                let place = |k: usize| (k.max(other), k.min(other));
                let entries: Vec3 = local.map(|k| matrix.get(&place(k)).copied().unwrap_or(Graph::ZERO));
                let turned = graph.mat_vec(&rotation, &entries);
                local.iter().zip(turned).for_each(|(&k, entry)| _ = matrix.insert(place(k), entry));
            }
            // What a displacement of all that hangs on it takes is the same in all directions.
        }
        matrix.retain(|_, entry| *entry != Graph::ZERO);
        matrix
    }
}

/// The acceleration that gravity makes of a carrier without coordinates that does not move, in its frame.
fn of_resting_ground(system: &mut System, body: Option<usize>) -> Vec3 {
    let Some(body) = body else { return ZERO3 };
    let (gravity, a) = (system.numbers(&system.model.gravity), system.poses[body].a);
    let graph = &mut system.graph;
    let felt = graph.neg_vec(&gravity);
    graph.transposed_vec(&a, &felt)
}
