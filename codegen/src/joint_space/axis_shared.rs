//! The accelerations of a tree in which several joints follow one unknown (gears), by elimination from the leaves to
//! the roots in frames that suit its joints. What a shared unknown takes is carried on towards the root as a wrench,
//! and the unknown is eliminated as soon as all its joints have been passed (joints that move together are one
//! aggregate joint: A. Jain, *Multibody graph transformations and analysis, Part II*, Nonlinear Dynamics 67 (2012)).

use super::articulated_inertia::{ArticulatedInertia, Released};
use super::axis_dynamics::{AxisTree, Segment};
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use std::collections::BTreeMap;

/// The wrenches that unit accelerations of unknowns take.
type Wrenches = BTreeMap<usize, SpatialVector>;

/// A component of a twist that is an unknown of its own, eliminated.
struct Single {
    step: Released,
    rate: usize,
    share: ExprId,
    /// What it takes of unknowns that wait.
    couplings: Vec<(usize, ExprId)>,
}

/// A shared unknown, eliminated: `z = share − (P · a + Σ c y) / d`.
struct Shared {
    unknown: usize,
    wrench: SpatialVector,
    couplings: Vec<(usize, ExprId)>,
    share: ExprId,
    inverse: ExprId,
}

/// Between shared unknowns that wait.
struct Waiting {
    /// Lower triangle.
    couplings: BTreeMap<(usize, usize), ExprId>,
    /// The force along each unknown.
    loads: Vec<ExprId>,
    /// How many rates of each are yet to come.
    left: Vec<usize>,
}

impl AxisTree {
    /// From the accelerations at constant rates.
    pub(super) fn recursion_of_shared(&self, system: &mut System) -> Vec<ExprId> {
        let graph = &mut system.graph;
        let mut inertias: Vec<_> =
            self.segments.iter().map(|segment| ArticulatedInertia::rigid(graph, &segment.moments)).collect();
        let mut loads: Vec<_> = self.segments.iter().map(|segment| segment.load).collect();
        let mut pending = vec![Wrenches::new(); self.segments.len()];
        let mut waiting = Waiting::of(self);
        let mut eliminated = Vec::new();
        for (index, segment) in self.segments.iter().enumerate().rev() {
            let (mut inertia, mut load) = (inertias[index], loads[index]);
            let mut wrenches = std::mem::take(&mut pending[index]);
            self.absorb(graph, segment, (&inertia, &load), &mut wrenches, &mut waiting);
            let mut singles = Vec::new();
            let resisting = segment.along.iter().zip(&segment.armature);
            for (&(component, rate), (&along, &armature)) in segment.free.iter().zip(resisting) {
                if !self.is_single(rate) {
                    continue;
                }
                let (rest, step) = inertia.without(graph, component, armature);
                let share = step.yield_to(graph, &mut load, along);
                let couplings = waiting.release(graph, &step, share, &mut wrenches);
                singles.push(Single { step, rate, share, couplings });
                inertia = rest;
            }
            let is_ready = |unknown: &&usize| {
                waiting.left[**unknown] == 0 && pending.iter().all(|others| !others.contains_key(*unknown))
            };
            let ready: Vec<_> = wrenches.keys().filter(is_ready).copied().collect();
            let shared = ready
                .into_iter()
                .map(|unknown| waiting.eliminate(graph, unknown, (&mut inertia, &mut load), &mut wrenches));
            eliminated.push((singles, shared.collect::<Vec<_>>()));
            let Some(parent) = segment.station.parent else { continue };
            for by in &segment.frame.moves {
                inertia = inertia.moved(graph, by);
                load = by.wrench(graph, &load);
                wrenches.values_mut().for_each(|wrench| *wrench = by.wrench(graph, wrench));
            }
            inertias[parent] = inertias[parent].plus(graph, &inertia);
            loads[parent] = loads[parent].plus(graph, &load);
            for (unknown, wrench) in wrenches {
                let whole = pending[parent].entry(unknown).or_insert(SpatialVector::ZERO);
                *whole = whole.plus(graph, &wrench);
            }
        }
        eliminated.reverse();
        let found = self.released(graph, &eliminated);
        self.of_tree(system, &found)
    }

    /// Whether a rate is an unknown that moves nothing else.
    fn is_single(&self, rate: usize) -> bool {
        let [(unknown, Graph::ONE)] = self.embedding.rates[rate].columns[..] else { return false };
        let all = self.embedding.rates.iter().flat_map(|rate| &rate.columns);
        all.filter(|(other, _)| *other == unknown).count() == 1
    }

    /// Adds the components of a segment that follow shared unknowns to what these take.
    fn absorb(
        &self,
        graph: &mut Graph,
        segment: &Segment,
        (inertia, load): (&ArticulatedInertia, &SpatialVector),
        wrenches: &mut Wrenches,
        waiting: &mut Waiting,
    ) {
        let resisting = segment.along.iter().zip(&segment.armature);
        for (&(component, rate), (&along, &armature)) in segment.free.iter().zip(resisting) {
            if self.is_single(rate) {
                continue;
            }
            let column = inertia.column(graph, component);
            let own = graph.add(column.component(component), armature);
            let driving = graph.add(load.component(component), along);
            let columns = &self.embedding.rates[rate].columns;
            for (place, &(unknown, factor)) in columns.iter().enumerate() {
                for (&other, wrench) in wrenches.iter() {
                    let coupling = graph.mul(factor, wrench.component(component));
                    waiting.couple(graph, (unknown, other), coupling);
                    if other == unknown {
                        waiting.couple(graph, (unknown, unknown), coupling);
                    }
                }
                for &(other, other_factor) in &columns[..=place] {
                    let both = graph.mul(factor, other_factor);
                    let both = graph.mul(both, own);
                    waiting.couple(graph, (unknown, other), both);
                }
                let along = graph.mul(factor, driving);
                waiting.loads[unknown] = graph.add(waiting.loads[unknown], along);
                waiting.left[unknown] -= 1;
            }
            for &(unknown, factor) in columns {
                let scaled = column.scaled(graph, factor);
                let whole = wrenches.entry(unknown).or_insert(SpatialVector::ZERO);
                *whole = whole.plus(graph, &scaled);
            }
        }
    }

    /// The unknowns, root first.
    fn released(&self, graph: &mut Graph, eliminated: &[(Vec<Single>, Vec<Shared>)]) -> Vec<ExprId> {
        let mut found = vec![Graph::ZERO; self.embedding.n_unknowns];
        let mut motions: Vec<SpatialVector> = Vec::new();
        for (segment, (singles, shared)) in self.segments.iter().zip(eliminated) {
            let mut motion = segment.station.parent.map_or(SpatialVector::ZERO, |parent| motions[parent]);
            for by in segment.frame.moves.iter().rev() {
                motion = by.twist(graph, &motion);
            }
            let coupled = |graph: &mut Graph, found: &[ExprId], couplings: &[(usize, ExprId)]| {
                couplings.iter().fold(Graph::ZERO, |sum, &(unknown, coupling)| {
                    let part = graph.mul(coupling, found[unknown]);
                    graph.add(sum, part)
                })
            };
            for Shared { unknown, wrench, couplings, share, inverse } in shared.iter().rev() {
                let (inertial, rest) = (wrench.dot(graph, &motion), coupled(graph, &found, couplings));
                let resisted = graph.add(inertial, rest);
                let resisted = graph.mul(resisted, *inverse);
                found[*unknown] = graph.sub(*share, resisted);
            }
            for Single { step, rate, share, couplings } in singles.iter().rev() {
                let rest = coupled(graph, &found, couplings);
                let resisted = graph.mul(rest, step.inverse);
                let share = graph.sub(*share, resisted);
                let (unknown, _) = self.embedding.rates[*rate].columns[0];
                found[unknown] = step.release(graph, &mut motion, share);
            }
            for &(component, rate) in &segment.free {
                if !self.is_single(rate) {
                    let own = coupled(graph, &found, &self.embedding.rates[rate].columns);
                    let whole = motion.component_mut(component);
                    *whole = graph.add(*whole, own);
                }
            }
            motions.push(motion);
        }
        found
    }
}

impl Waiting {
    fn of(tree: &AxisTree) -> Self {
        let n = tree.embedding.n_unknowns;
        let mut left = vec![0; n];
        for &(_, rate) in tree.segments.iter().flat_map(|segment| &segment.free) {
            if !tree.is_single(rate) {
                tree.embedding.rates[rate].columns.iter().for_each(|&(unknown, _)| left[unknown] += 1);
            }
        }
        Self { couplings: BTreeMap::new(), loads: vec![Graph::ZERO; n], left }
    }

    fn couple(&mut self, graph: &mut Graph, (a, b): (usize, usize), value: ExprId) {
        let entry = self.couplings.entry((a.max(b), a.min(b))).or_insert(Graph::ZERO);
        *entry = graph.add(*entry, value);
    }

    /// What a component that yields takes of those that wait.
    fn release(
        &mut self,
        graph: &mut Graph,
        step: &Released,
        share: ExprId,
        wrenches: &mut Wrenches,
    ) -> Vec<(usize, ExprId)> {
        let mut couplings = Vec::new();
        for (&unknown, wrench) in wrenches.iter_mut() {
            let coupling = step.take(graph, wrench);
            if coupling != Graph::ZERO {
                couplings.push((unknown, coupling));
            }
        }
        self.less(graph, &couplings, share, step.inverse);
        couplings
    }

    /// Without an unknown that these are coupled with.
    fn less(&mut self, graph: &mut Graph, couplings: &[(usize, ExprId)], share: ExprId, inverse: ExprId) {
        for (place, &(unknown, coupling)) in couplings.iter().enumerate() {
            let taken = graph.mul(coupling, share);
            self.loads[unknown] = graph.sub(self.loads[unknown], taken);
            let factor = graph.mul(coupling, inverse);
            for &(other, other_coupling) in &couplings[..=place] {
                let taken = graph.mul(factor, other_coupling);
                let taken = graph.neg(taken);
                self.couple(graph, (unknown, other), taken);
            }
        }
    }

    fn eliminate(
        &mut self,
        graph: &mut Graph,
        unknown: usize,
        (inertia, load): (&mut ArticulatedInertia, &mut SpatialVector),
        wrenches: &mut Wrenches,
    ) -> Shared {
        let wrench = wrenches.remove(&unknown).expect("it is one of those that wait");
        let own = self.couplings.remove(&(unknown, unknown)).unwrap_or(Graph::ZERO);
        let inverse = graph.recip(own);
        let mut couplings = Vec::new();
        self.couplings.retain(|&(a, b), &mut value| {
            let is_of = a == unknown || b == unknown;
            if is_of && value != Graph::ZERO {
                couplings.push((if a == unknown { b } else { a }, value));
            }
            !is_of
        });
        let share = graph.mul(self.loads[unknown], inverse);
        self.less(graph, &couplings, share, inverse);
        for &(other, coupling) in &couplings {
            if let Some(whole) = wrenches.get_mut(&other) {
                let factor = graph.mul(coupling, inverse);
                let taken = wrench.scaled(graph, factor).negated(graph);
                *whole = whole.plus(graph, &taken);
            }
        }
        *inertia = inertia.less(graph, &wrench, inverse);
        let taken = wrench.scaled(graph, share).negated(graph);
        *load = load.plus(graph, &taken);
        Shared { unknown, wrench, couplings, share, inverse }
    }
}
