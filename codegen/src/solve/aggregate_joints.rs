//! Elimination of a tree in which joints share unknowns: gears, loops (joints that move together are one aggregate
//! joint: A. Jain, *Multibody graph transformations and analysis, Part II*, Nonlinear Dynamics 67 (2012); M. Chignoli,
//! N. Adrian, S. Kim and P. Wensing, *Recursive rigid-body dynamics algorithms for systems with kinematic loops*
//! (2023)).
//!
//! Bodies are visited from the leaves to the roots, as in [`articulated_body`](super::articulated_body). An unknown
//! that moves joints elsewhere too is not eliminated yet: what it takes is carried on towards the root beside the
//! articulated inertia, as a wrench, and it is eliminated as soon as all its joints have been passed.

use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::solve::articulated_body::{Arm, Excitation, Inertia};
use crate::solve::motion_subspace::MotionSubspace;
use std::collections::BTreeMap;

/// A tree with all unknowns eliminated. All vectors are in the bodies' own frames.
#[derive(Debug)]
pub struct AggregateTree {
    links: Vec<Link>,
    /// The unknowns of each link's free twists.
    unknowns: Vec<Vec<usize>>,
    n_unknowns: usize,
}

/// A link, root first, after elimination.
#[derive(Debug)]
struct Link {
    subspace: MotionSubspace,
    /// The inertia at the joint point before anything is eliminated there.
    steps: Vec<Step>,
    /// What is left of unknowns and inertia for the parent, at the joint point.
    pending: BTreeMap<usize, SpatialVector>,
    rest: Inertia,
}

/// An unknown eliminated: `z = −(F · a + load + Σ c_w z_w) / d`.
#[derive(Debug)]
struct Step {
    unknown: usize,
    wrench: SpatialVector,
    /// To unknowns that are eliminated later.
    couplings: Vec<(usize, ExprId)>,
    inverse: ExprId,
}

/// The lower triangle between unknowns that have not been eliminated.
#[derive(Debug)]
struct Couplings(BTreeMap<(usize, usize), ExprId>);

impl Couplings {
    fn get(&self, a: usize, b: usize) -> ExprId {
        self.0.get(&(a.max(b), a.min(b))).copied().unwrap_or(Graph::ZERO)
    }

    /// The unknowns that one is coupled with, which is left out from now on.
    fn others(&mut self, unknown: usize) -> Vec<(usize, ExprId)> {
        let is_of = |&(a, b): &(usize, usize)| a == unknown || b == unknown;
        let of: Vec<_> =
            self.0.iter().filter(|(key, _)| is_of(key)).map(|(&key, &value)| (key, value)).collect();
        self.0.retain(|key, _| !is_of(key));
        let other = |((a, b), value)| (if a == unknown { b } else { a }, value);
        of.into_iter()
            .map(other)
            .filter(|(other, value)| *other != unknown && *value != Graph::ZERO)
            .collect()
    }

    fn add(&mut self, graph: &mut Graph, (a, b): (usize, usize), value: ExprId) {
        let entry = self.0.entry((a.max(b), a.min(b))).or_insert(Graph::ZERO);
        *entry = graph.add(*entry, value);
    }
}

impl AggregateTree {
    /// The links come root first; `unknowns` has for each link the unknown of each free twist. `armature` is what
    /// resists the unknowns besides the inertia of bodies, its lower triangle.
    pub fn new(
        system: &mut System,
        subspaces: Vec<MotionSubspace>,
        unknowns: Vec<Vec<usize>>,
        (n_unknowns, armature): (usize, BTreeMap<(usize, usize), ExprId>),
    ) -> Self {
        let mut left = vec![0; n_unknowns];
        unknowns.iter().flatten().for_each(|&unknown| left[unknown] += 1);
        let n_bodies = system.moving_bodies.len();
        let mut bodies: Vec<_> = (0..n_bodies).map(|body| Inertia::rigid(system, body)).collect();
        let mut pending = vec![BTreeMap::<usize, SpatialVector>::new(); n_bodies];
        let mut couplings = Couplings(armature);
        let graph = &mut system.graph;
        let mut links = Vec::new();
        for (subspace, unknowns) in subspaces.into_iter().zip(&unknowns).rev() {
            let arm = Arm::on_body(graph, &subspace);
            let mut rest = bodies[subspace.moving_body].seen_through(graph, &arm);
            let below = std::mem::take(&mut pending[subspace.moving_body]);
            let mut waiting: BTreeMap<_, _> =
                below.into_iter().map(|(unknown, wrench)| (unknown, arm.wrench(graph, &wrench))).collect();
            for (twist, &unknown) in subspace.free.iter().zip(unknowns) {
                absorb(graph, (twist, unknown), &rest, &mut waiting, &mut couplings);
                left[unknown] -= 1;
            }
            let waits_elsewhere =
                |unknown: &usize| pending.iter().any(|waiting| waiting.contains_key(unknown));
            let ready: Vec<_> = waiting
                .keys()
                .copied()
                .filter(|unknown| left[*unknown] == 0 && !waits_elsewhere(unknown))
                .collect();
            let steps = ready
                .into_iter()
                .map(|unknown| Step::eliminate(graph, unknown, &mut rest, &mut waiting, &mut couplings));
            let steps = steps.collect();
            if let Some(parent) = subspace.parent {
                let load = rest.on_parent(graph, &parent);
                let arm = Arm::on_parent(graph, &parent);
                let load = load.seen_through(graph, &arm);
                bodies[parent.moving_body].add(graph, &load);
                for (&unknown, wrench) in &waiting {
                    let carried = parent.wrench(graph, wrench);
                    let whole = pending[parent.moving_body].entry(unknown).or_insert(SpatialVector::ZERO);
                    *whole = whole.plus(graph, &carried);
                }
            }
            links.push(Link { subspace, steps, pending: waiting, rest });
        }
        links.reverse();
        Self { links, unknowns, n_unknowns }
    }

    /// How fast each unknown changes.
    pub fn respond(&self, graph: &mut Graph, excitation: &Excitation) -> Vec<ExprId> {
        let Excitation { bias, forced, along } = excitation;
        let mut bias = bias.clone();
        let mut loads = vec![Graph::ZERO; self.n_unknowns];
        for (unknowns, along) in self.unknowns.iter().zip(along) {
            for (&unknown, &along) in unknowns.iter().zip(along) {
                loads[unknown] = graph.sub(loads[unknown], along);
            }
        }
        let links = self.links.iter().zip(&self.unknowns).zip(forced);
        for ((link, unknowns), forced) in links.clone().rev() {
            let own = bias[link.subspace.moving_body];
            let on_parent = link.pass_on(graph, (unknowns, &own), forced, &mut loads);
            if let (Some(parent), Some(on_parent)) = (link.subspace.parent, on_parent) {
                bias[parent.moving_body] = bias[parent.moving_body].plus(graph, &on_parent);
            }
        }
        let mut rates = vec![Graph::ZERO; self.n_unknowns];
        let mut motions = vec![SpatialVector::ZERO; bias.len()];
        for ((link, unknowns), forced) in links {
            let mut motion = *forced;
            if let Some(parent) = link.subspace.parent {
                let carried = parent.twist(graph, &motions[parent.moving_body]);
                motion = motion.plus(graph, &carried);
            }
            for step in link.steps.iter().rev() {
                rates[step.unknown] = step.rate(graph, &motion, &loads, &rates);
            }
            for (twist, &unknown) in link.subspace.free.iter().zip(unknowns) {
                let own = twist.scaled(graph, rates[unknown]);
                motion = motion.plus(graph, &own);
            }
            motions[link.subspace.moving_body] = Arm::on_body(graph, &link.subspace).twist(graph, &motion);
        }
        rates
    }
}

/// Adds a free twist of an unknown to what the unknown takes.
fn absorb(
    graph: &mut Graph,
    (twist, unknown): (&SpatialVector, usize),
    rest: &Inertia,
    waiting: &mut BTreeMap<usize, SpatialVector>,
    couplings: &mut Couplings,
) {
    for (&other, wrench) in waiting.iter() {
        let coupling = twist.dot(graph, wrench);
        couplings.add(graph, (unknown, other), coupling);
        if other == unknown {
            couplings.add(graph, (unknown, unknown), coupling);
        }
    }
    let wrench = rest.times(graph, twist);
    let own = twist.dot(graph, &wrench);
    couplings.add(graph, (unknown, unknown), own);
    let whole = waiting.entry(unknown).or_insert(SpatialVector::ZERO);
    *whole = whole.plus(graph, &wrench);
}

impl Step {
    fn eliminate(
        graph: &mut Graph,
        unknown: usize,
        rest: &mut Inertia,
        waiting: &mut BTreeMap<usize, SpatialVector>,
        couplings: &mut Couplings,
    ) -> Self {
        let wrench = waiting.remove(&unknown).expect("it is one of those that wait");
        let inverse = graph.recip(couplings.get(unknown, unknown));
        *rest = rest.less(graph, &wrench, inverse);
        let others = couplings.others(unknown);
        for &(other, coupling) in &others {
            let share = graph.mul(coupling, inverse);
            // An unknown that is coupled by an armature alone may not have been met yet.
            let whole = waiting.entry(other).or_insert(SpatialVector::ZERO);
            let taken = wrench.scaled(graph, share).negated(graph);
            *whole = whole.plus(graph, &taken);
            for &(another, factor) in others.iter().filter(|(another, _)| *another <= other) {
                let taken = graph.mul(share, factor);
                let taken = graph.neg(taken);
                couplings.add(graph, (other, another), taken);
            }
        }
        Self { unknown, wrench, couplings: others, inverse }
    }

    fn rate(&self, graph: &mut Graph, motion: &SpatialVector, loads: &[ExprId], rates: &[ExprId]) -> ExprId {
        let inertial = self.wrench.dot(graph, motion);
        let mut resisting = graph.add(inertial, loads[self.unknown]);
        for &(other, coupling) in &self.couplings {
            let part = graph.mul(coupling, rates[other]);
            resisting = graph.add(resisting, part);
        }
        let resisted = graph.mul(resisting, self.inverse);
        graph.neg(resisted)
    }
}

impl Link {
    /// Adds to the loads on unknowns what acts beyond the joint; what is left for the parent's mass centre.
    fn pass_on(
        &self,
        graph: &mut Graph,
        (unknowns, bias): (&[usize], &SpatialVector),
        forced: &SpatialVector,
        loads: &mut [ExprId],
    ) -> Option<SpatialVector> {
        let mut bias = Arm::on_body(graph, &self.subspace).wrench(graph, bias);
        for (twist, &unknown) in self.subspace.free.iter().zip(unknowns) {
            let load = twist.dot(graph, &bias);
            loads[unknown] = graph.add(loads[unknown], load);
        }
        for step in &self.steps {
            let share = graph.mul(loads[step.unknown], step.inverse);
            let taken = step.wrench.scaled(graph, share).negated(graph);
            bias = bias.plus(graph, &taken);
            for &(other, coupling) in &step.couplings {
                let taken = graph.mul(coupling, share);
                loads[other] = graph.sub(loads[other], taken);
            }
        }
        for (&unknown, wrench) in &self.pending {
            let load = wrench.dot(graph, forced);
            loads[unknown] = graph.add(loads[unknown], load);
        }
        let parent = self.subspace.parent?;
        let inertial = self.rest.times(graph, forced);
        bias = bias.plus(graph, &inertial);
        Some(parent.wrench(graph, &bias))
    }
}
