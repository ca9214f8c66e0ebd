//! The solve of eq. (17) for small open trees by least squares: `B u̇` comes as near as can be, in the metric of the
//! masses, to how the bodies would accelerate alone. The columns of B, how each rate moves all bodies, are made
//! orthogonal one after the other from the leaves to the roots (modified Gram–Schmidt: Björck, *Solving linear least
//! squares problems by Gram–Schmidt orthogonalization*, BIT 7 (1967)).
//!
//! `Bᵀ M B` is never formed and no inertia is subtracted from another. Where a heavy leaf hangs on a light root, what
//! matters is then a short motion, not the small difference of two large inertias: the accuracy does not depend on the
//! ratios of masses, moments and arms.

use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::vector::ZERO3;
use crate::solve::articulated_body::{Arm, Basis, Excitation, Frames, Inertia, Response};
use crate::solve::motion_subspace::MotionSubspace;
use std::collections::BTreeMap;

/// With more rates elimination takes fewer operations: its number grows linearly, here with the third power.
pub const MAX_RATES: usize = 8;

/// The inertia of an armature, and the unknowns that turn it with their factors.
pub type Armature = (ExprId, Vec<(usize, ExprId)>);

/// A small open tree whose free twists are orthogonal.
#[derive(Debug)]
pub struct GramSchmidtTree {
    /// Root first.
    pub subspaces: Vec<MotionSubspace>,
    /// Of each moving body.
    frames: Vec<Frames>,
    /// Of each moving body, then of armatures, each of which moves along a direction of its own.
    bodies: Vec<Inertia>,
    /// Of each subspace the unknowns that its free twists are parts of.
    unknowns: Vec<Vec<usize>>,
    /// One for each unknown.
    columns: Vec<Column>,
}

/// How a rate moves the mass centres while those further from the root yield.
#[derive(Debug)]
struct Column {
    /// Of each moving body that it moves.
    parts: BTreeMap<usize, Part>,
    /// Of what the motion takes along itself.
    inverse: ExprId,
    /// How fast others yield, per unit of this rate.
    yielding: Vec<(usize, ExprId)>,
}

#[derive(Clone, Copy, Debug)]
struct Part {
    motion: SpatialVector,
    /// What the motion takes.
    wrench: SpatialVector,
}

impl GramSchmidtTree {
    /// The links come root first. The basis has rotations in the bodies' own frames: there their inertias are
    /// constants.
    pub fn new(system: &mut System, subspaces: Vec<MotionSubspace>, basis: Basis) -> Self {
        let mut next = 0..;
        let each = |subspace: &MotionSubspace| next.by_ref().take(subspace.free.len()).collect();
        let unknowns = subspaces.iter().map(each).collect();
        let unknowns: Vec<Vec<usize>> = unknowns;
        let armature = |(subspace, unknowns): (&MotionSubspace, &Vec<usize>)| {
            let each = subspace.armature.iter().zip(unknowns);
            each.map(|(&inertia, &unknown)| (inertia, vec![(unknown, Graph::ONE)])).collect::<Vec<_>>()
        };
        let rotors: Vec<_> = subspaces.iter().zip(&unknowns).flat_map(armature).collect();
        Self::of_unknowns(system, subspaces, (unknowns, &rotors), basis)
    }

    /// The same where free twists of several joints may belong to one unknown. Unknowns are numbered root first.
    /// Armatures are given with the factors by which unknowns turn them.
    pub fn of_unknowns(
        system: &mut System,
        subspaces: Vec<MotionSubspace>,
        (unknowns, rotors): (Vec<Vec<usize>>, &[Armature]),
        basis: Basis,
    ) -> Self {
        let frames = basis.frames(system);
        let mut bodies: Vec<_> =
            (0..system.moving_bodies.len()).map(|moving_body| Inertia::rigid(system, moving_body)).collect();
        let graph = &mut system.graph;
        let mut motions = motions_at_unit_rates(graph, &subspaces, &unknowns);
        for (inertia, factors) in rotors {
            for &(unknown, factor) in factors {
                let turning = SpatialVector { t: ZERO3, rho: [factor, Graph::ZERO, Graph::ZERO] };
                motions[unknown].insert(bodies.len(), turning);
            }
            bodies.push(Inertia::turning(*inertia));
        }
        let mut columns: BTreeMap<usize, Column> = BTreeMap::new();
        for (rate, mut motion) in motions.into_iter().enumerate().rev() {
            let mut yielding = Vec::new();
            for (&other, column) in columns.iter().rev() {
                let share = column.yield_to(graph, &mut motion);
                if share != Graph::ZERO {
                    yielding.push((other, share));
                }
            }
            columns.insert(rate, Column::new(graph, &bodies, &motion, yielding));
        }
        Self { subspaces, frames, bodies, unknowns, columns: columns.into_values().collect() }
    }

    pub fn respond(&self, graph: &mut Graph, excitation: &Excitation) -> Response {
        let Excitation { bias, forced, along } = excitation;
        let at_rest: Vec<_> =
            self.subspaces.iter().map(|subspace| vec![Graph::ZERO; subspace.free.len()]).collect();
        let unforced = self.motions(graph, forced, &at_rest);
        let bias = bias.iter().zip(&self.frames).map(|(bias, frames)| frames.enter(graph, bias));
        let bias: Vec<_> = bias.collect();
        let mut left: Vec<_> = (self.bodies.iter().zip(&unforced).zip(&bias))
            .map(|((body, motion), bias)| body.times(graph, motion).plus(graph, bias).negated(graph))
            .collect();
        left.resize(self.bodies.len(), SpatialVector::ZERO);
        let mut forces = vec![Graph::ZERO; self.columns.len()];
        for (unknowns, along) in self.unknowns.iter().zip(along) {
            for (&unknown, &along) in unknowns.iter().zip(along) {
                forces[unknown] = graph.add(forces[unknown], along);
            }
        }
        let mut all = vec![Graph::ZERO; forces.len()];
        for (rate, column) in self.columns.iter().enumerate().rev() {
            for &(other, share) in &column.yielding {
                let passed_on = graph.mul(share, forces[other]);
                forces[rate] = graph.sub(forces[rate], passed_on);
            }
            all[rate] = column.taken_from(graph, &mut left, forces[rate]);
        }
        for (rate, column) in self.columns.iter().enumerate() {
            for &(other, share) in &column.yielding {
                let yielded = graph.mul(share, all[rate]);
                all[other] = graph.sub(all[other], yielded);
            }
        }
        let rates =
            self.unknowns.iter().map(|unknowns| unknowns.iter().map(|&unknown| all[unknown]).collect());
        let rates: Vec<Vec<_>> = rates.collect();
        let mut motions = self.motions(graph, forced, &rates);
        for (motion, frames) in motions.iter_mut().zip(&self.frames) {
            *motion = frames.leave(graph, motion);
        }
        Response { motions, rates }
    }

    /// Of the mass centre of each moving body, if the rates of each joint change like this.
    fn motions(
        &self,
        graph: &mut Graph,
        forced: &[SpatialVector],
        rates: &[Vec<ExprId>],
    ) -> Vec<SpatialVector> {
        let mut motions = vec![SpatialVector::ZERO; self.frames.len()];
        for ((subspace, forced), rates) in self.subspaces.iter().zip(forced).zip(rates) {
            let mut motion = *forced;
            if let Some(parent) = subspace.parent {
                let carried = parent.twist(graph, &motions[parent.moving_body]);
                motion = motion.plus(graph, &carried);
            }
            for (twist, &rate) in subspace.free.iter().zip(rates) {
                let own = twist.scaled(graph, rate);
                motion = motion.plus(graph, &own);
            }
            motions[subspace.moving_body] = Arm::on_body(graph, subspace).twist(graph, &motion);
        }
        motions
    }
}

/// Of each unknown how it moves the mass centres of the moving_bodies, root first.
fn motions_at_unit_rates(
    graph: &mut Graph,
    subspaces: &[MotionSubspace],
    unknowns: &[Vec<usize>],
) -> Vec<BTreeMap<usize, SpatialVector>> {
    let mut motions: Vec<BTreeMap<usize, SpatialVector>> = Vec::new();
    for (subspace, unknowns) in subspaces.iter().zip(unknowns) {
        let arm = Arm::on_body(graph, subspace);
        for motion in &mut motions {
            let carried =
                subspace.parent.and_then(|parent| Some((parent, *motion.get(&parent.moving_body)?)));
            if let Some((parent, of_parent)) = carried {
                let at_joint = parent.twist(graph, &of_parent);
                motion.insert(subspace.moving_body, arm.twist(graph, &at_joint));
            }
        }
        for (twist, &unknown) in subspace.free.iter().zip(unknowns) {
            let own = arm.twist(graph, twist);
            motions.resize_with(motions.len().max(unknown + 1), BTreeMap::new);
            let whole = motions[unknown].entry(subspace.moving_body).or_insert(SpatialVector::ZERO);
            *whole = whole.plus(graph, &own);
        }
    }
    motions
}

impl Column {
    fn new(
        graph: &mut Graph,
        bodies: &[Inertia],
        motion: &BTreeMap<usize, SpatialVector>,
        yielding: Vec<(usize, ExprId)>,
    ) -> Self {
        let part = |(&moving_body, &motion): (&usize, &SpatialVector)| {
            (moving_body, Part { motion, wrench: bodies[moving_body].times(graph, &motion) })
        };
        let parts: BTreeMap<_, _> = motion.iter().map(part).collect();
        let resistance = parts.values().fold(Graph::ZERO, |sum, part| {
            let along = part.motion.dot(graph, &part.wrench);
            graph.add(sum, along)
        });
        Self { parts, inverse: graph.recip(resistance), yielding }
    }

    /// Makes a motion orthogonal to this one; returns how much of this one was in it.
    fn yield_to(&self, graph: &mut Graph, motion: &mut BTreeMap<usize, SpatialVector>) -> ExprId {
        let mut taken = Graph::ZERO;
        for (moving_body, part) in &self.parts {
            if let Some(motion) = motion.get(moving_body) {
                let along = motion.dot(graph, &part.wrench);
                taken = graph.add(taken, along);
            }
        }
        let share = graph.mul(taken, self.inverse);
        if share != Graph::ZERO {
            for (&moving_body, part) in &self.parts {
                let yielded = part.motion.scaled(graph, share).negated(graph);
                let motion = motion.entry(moving_body).or_insert(SpatialVector::ZERO);
                *motion = motion.plus(graph, &yielded);
            }
        }
        share
    }

    /// How fast the motion accelerates under the wrenches and a force along it; the wrenches are left with what it does
    /// not take.
    fn taken_from(&self, graph: &mut Graph, wrenches: &mut [SpatialVector], force: ExprId) -> ExprId {
        let driving = self.parts.iter().fold(force, |sum, (&moving_body, part)| {
            let along = part.motion.dot(graph, &wrenches[moving_body]);
            graph.add(sum, along)
        });
        let rate = graph.mul(driving, self.inverse);
        for (&moving_body, part) in &self.parts {
            let taken = part.wrench.scaled(graph, rate).negated(graph);
            wrenches[moving_body] = wrenches[moving_body].plus(graph, &taken);
        }
        rate
    }
}
