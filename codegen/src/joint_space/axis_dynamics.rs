//! The accelerations of the joint coordinates of a tree in frames that suit its joints, from base inertial
//! parameters: by articulated bodies, or through the mass matrix of composite bodies.
//!
//! What all rates being constant would take is found first, as inverse dynamics (J. Luh, M. Walker and R. Paul (1980)),
//! and left out of the loads; gravity is an acceleration of the ground, and a body that nothing holds falls.

use super::articulated_inertia::ArticulatedInertia;
use super::axis_frames::{Frame, frames};
use super::coordinates::Coordinates;
use super::elementary_joints::{Freedom, Station, stations};
use super::embedding::Embedding;
use super::mass_moments::{MassMoments, Motion};
use crate::derive::outputs::time_derivative;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::schedule::Operations;
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use crate::expr::vector::ZERO3;
use crate::solve::ldl::Elimination;
use std::collections::BTreeMap;

/// Beyond this many rates one after the other a mass matrix takes more operations than a recursion: they grow with the
/// cube of their number.
const MAX_DEPTH: usize = 12;

/// A tree with frames, ready to be solved.
#[derive(Debug)]
pub struct AxisTree {
    /// Root first.
    pub(super) segments: Vec<Segment>,
    pub(super) embedding: Embedding,
}

#[derive(Debug)]
pub(super) struct Segment {
    pub station: Station,
    pub frame: Frame,
    /// The components of its twist that are free, three displacements before three turns, and their rates.
    pub free: Vec<(usize, usize)>,
    /// Base inertial parameters.
    pub moments: MassMoments,
    /// What acts on it besides gravity.
    pub applied: SpatialVector,
    /// At constant rates.
    pub motion: Motion,
    /// What acts on it besides gravity, less what constant rates take.
    pub load: SpatialVector,
    /// The acceleration that constant rates force upon it, its carrier turning at a constant rate.
    forced: SpatialVector,
    /// The same load, less what it takes to turn at a constant rate.
    load_at_rest: SpatialVector,
    /// The force along each free component.
    pub along: Vec<ExprId>,
    /// What resists each besides the inertia of bodies.
    pub armature: Vec<ExprId>,
}

/// Where the accelerations that are found start.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Start {
    /// From those at constant rates: the fewest operations.
    ConstantRates,
    /// From nothing: what gravity and the rates force upon a body is not found by a difference.
    Rest,
}

impl AxisTree {
    /// `None` for a tree with joints that are not made of turns and displacements.
    /// The angles of `invariant`, by their places in x, do not turn frames.
    pub fn new(system: &mut System, coordinates: &Coordinates, invariant: &[usize]) -> Option<Self> {
        let Coordinates { embedding, layout, loads, .. } = coordinates;
        let stations = stations(system, &layout.links, &|x| !invariant.contains(&x))?;
        let frames = frames(system, &stations);
        let biases = embedding.biases();
        let moments = base_parameters(system, &stations, &frames);
        let mut segments: Vec<Segment> = Vec::new();
        for ((station, frame), moments) in stations.into_iter().zip(frames).zip(moments) {
            let from = match station.parent {
                Some(parent) => segments[parent].motion,
                None => of_ground(system, station.ground),
            };
            let applied = load(&mut system.graph, &station, &frame, loads);
            let is_unknown = |&(_, rate): &(usize, usize)| !embedding.rates[rate].columns.is_empty();
            let free: Vec<_> = station.freedom.components().into_iter().filter(is_unknown).collect();
            let along = along(system, &station, &free, &coordinates.along);
            let armature = free.iter().map(|&(_, rate)| coordinates.armature[rate]).collect();
            let graph = &mut system.graph;
            let motion = moving(graph, &station, (&frame, &biases), from);
            let turning = Motion::new(graph, ZERO3, from.rho, ZERO3);
            let forced = moving(graph, &station, (&frame, &biases), turning);
            let turning = Motion::new(graph, ZERO3, motion.rho, ZERO3);
            let [load, load_at_rest] = [motion, turning].map(|motion| {
                let taken = moments.wrench(graph, &motion).negated(graph);
                applied.plus(graph, &taken)
            });
            let forced = SpatialVector { t: forced.t, rho: forced.rho_dot };
            segments.push(Segment {
                station,
                frame,
                free,
                moments,
                applied,
                motion,
                load,
                forced,
                load_at_rest,
                along,
                armature,
            });
        }
        Some(Self { segments, embedding: embedding.clone() })
    }

    /// By elimination from the leaves to the roots.
    fn recursion(&self, system: &mut System, start: Start) -> Vec<ExprId> {
        let grounds: Vec<_> =
            self.segments.iter().map(|segment| of_carrier(system, segment, start)).collect();
        let graph = &mut system.graph;
        let mut inertias: Vec<_> =
            self.segments.iter().map(|segment| ArticulatedInertia::rigid(graph, &segment.moments)).collect();
        let (mut loads, forced): (Vec<_>, Vec<_>) = (self.segments.iter())
            .map(|segment| match start {
                Start::ConstantRates => (segment.load, SpatialVector::ZERO),
                Start::Rest => (segment.load_at_rest, segment.forced),
            })
            .unzip();
        let mut eliminated = Vec::new();
        for (index, segment) in self.segments.iter().enumerate().rev() {
            let (mut inertia, mut load) = (inertias[index], loads[index]);
            let mut steps = Vec::new();
            let resisting = segment.along.iter().zip(&segment.armature);
            for (&(component, _), (&along, &armature)) in segment.free.iter().zip(resisting) {
                let (rest, step) = inertia.without(graph, component, armature);
                steps.push((step, step.yield_to(graph, &mut load, along)));
                inertia = rest;
            }
            eliminated.push(steps);
            let Some(parent) = segment.station.parent else { continue };
            let taken = inertia.times(graph, &forced[index]).negated(graph);
            load = load.plus(graph, &taken);
            for by in &segment.frame.moves {
                inertia = inertia.moved(graph, by);
                load = by.wrench(graph, &load);
            }
            inertias[parent] = inertias[parent].plus(graph, &inertia);
            loads[parent] = loads[parent].plus(graph, &load);
        }
        let mut found = vec![Graph::ZERO; self.embedding.n_unknowns];
        let mut motions: Vec<SpatialVector> = Vec::new();
        for (index, (segment, steps)) in self.segments.iter().zip(eliminated.iter().rev()).enumerate() {
            let mut motion = segment.station.parent.map_or(grounds[index], |parent| motions[parent]);
            for by in segment.frame.moves.iter().rev() {
                motion = by.twist(graph, &motion);
            }
            motion = motion.plus(graph, &forced[index]);
            for ((step, share), &(_, rate)) in steps.iter().zip(&segment.free).rev() {
                let (unknown, _) = self.embedding.rates[rate].columns[0];
                found[unknown] = step.release(graph, &mut motion, *share);
            }
            motions.push(motion);
        }
        self.of_tree(system, &found)
    }

    /// Through the mass matrix of composite bodies.
    fn by_mass_matrix(&self, system: &mut System) -> Vec<ExprId> {
        let forces = self.constant_forces(&mut system.graph);
        let matrix = self.mass_matrix(&mut system.graph);
        let mut elimination = Elimination::new(matrix, forces);
        let graph = &mut system.graph;
        self.order().iter().rev().for_each(|&unknown| elimination.pivot(graph, unknown));
        let found = elimination.substitute_back(graph);
        self.of_tree(system, &found)
    }

    /// Unknowns as they occur, root first.
    pub(super) fn order(&self) -> Vec<usize> {
        let rates = self.segments.iter().flat_map(|segment| &segment.free).map(|&(_, rate)| rate);
        let mut order = Vec::new();
        for &(unknown, _) in rates.flat_map(|rate| &self.embedding.rates[rate].columns) {
            if !order.contains(&unknown) {
                order.push(unknown);
            }
        }
        order
    }

    /// The forms of u̇ that are compared.
    pub fn forms(&self, system: &mut System) -> Vec<(&'static str, Vec<ExprId>)> {
        let mut forms = Vec::new();
        let by_matrix = (self.depth() <= MAX_DEPTH).then(|| self.by_mass_matrix(system));
        if self.unknowns_are_single() {
            let from_rates = self.recursion(system, Start::ConstantRates);
            forms.push(("recursion in joint frames", self.recursion(system, Start::Rest)));
            if let Some(by_matrix) = &by_matrix {
                let either = self.shorter(&system.graph, [&from_rates, by_matrix]);
                if either != from_rates && either != *by_matrix {
                    forms.push(("recursion or mass matrix for each limb", either));
                }
            }
            forms.push(("recursion in joint frames from constant rates", from_rates));
        } else {
            forms.push(("recursion in joint frames from constant rates", self.recursion_of_shared(system)));
        }
        forms.extend(by_matrix.map(|by_matrix| ("mass matrix in joint frames", by_matrix)));
        forms
    }

    /// Whether each unknown is the rate of one joint alone.
    fn unknowns_are_single(&self) -> bool {
        let columns = || self.embedding.rates.iter().flat_map(|rate| &rate.columns);
        columns().count() == self.embedding.n_unknowns && columns().all(|(_, factor)| *factor == Graph::ONE)
    }

    /// How many rates a station has with all that carry it, at most.
    fn depth(&self) -> usize {
        let mut depths: Vec<usize> = Vec::new();
        for segment in &self.segments {
            depths.push(segment.free.len() + segment.station.parent.map_or(0, |parent| depths[parent]));
        }
        depths.into_iter().max().unwrap_or(0)
    }

    /// The shorter of two solutions for each tree that stands on the ground by itself.
    fn shorter(&self, graph: &Graph, ways: [&[ExprId]; 2]) -> Vec<ExprId> {
        let mut rates: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        let mut roots: Vec<usize> = Vec::new();
        for (index, segment) in self.segments.iter().enumerate() {
            roots.push(segment.station.parent.map_or(index, |parent| roots[parent]));
            rates.entry(roots[index]).or_default().extend(segment.free.iter().map(|&(_, rate)| rate));
        }
        let mut taken = ways[0].to_vec();
        for rates in rates.values() {
            let cost = |way: &[ExprId]| {
                let roots: Vec<_> = rates.iter().map(|&rate| way[rate]).collect();
                Operations::recurring(graph, &roots).total()
            };
            if cost(ways[1]) < cost(ways[0]) {
                rates.iter().for_each(|&rate| taken[rate] = ways[1][rate]);
            }
        }
        taken
    }

    /// The same of all that acts, less what constant rates take.
    pub(super) fn constant_forces(&self, graph: &mut Graph) -> Vec<ExprId> {
        self.forces(graph, self.segments.iter().map(|segment| segment.load).collect())
    }

    /// What loads and the forces along them leave along each unknown for the rates to change.
    pub(super) fn forces(&self, graph: &mut Graph, mut loads: Vec<SpatialVector>) -> Vec<ExprId> {
        let mut forces = vec![Graph::ZERO; self.embedding.rates.len()];
        for (index, segment) in self.segments.iter().enumerate().rev() {
            for (&(component, rate), &along) in segment.free.iter().zip(&segment.along) {
                let load = loads[index].component(component);
                forces[rate] = graph.add(load, along);
            }
            let Some(parent) = segment.station.parent else { continue };
            let load = carried(graph, &segment.frame, loads[index]);
            loads[parent] = loads[parent].plus(graph, &load);
        }
        self.embedding.projected(graph, &forces)
    }

    pub(super) fn mass_matrix(&self, graph: &mut Graph) -> BTreeMap<(usize, usize), ExprId> {
        let mut composite: Vec<_> = self.segments.iter().map(|segment| segment.moments).collect();
        let mut matrix = BTreeMap::new();
        for (index, segment) in self.segments.iter().enumerate().rev() {
            for (k, &(component, rate)) in segment.free.iter().enumerate() {
                let mut wrench = composite[index].wrench_of(graph, component);
                for &(other, other_rate) in &segment.free[..=k] {
                    self.couple(graph, &mut matrix, (rate, other_rate), wrench.component(other));
                }
                self.couple(graph, &mut matrix, (rate, rate), segment.armature[k]);
                let mut at = index;
                while let Some(parent) = self.segments[at].station.parent {
                    wrench = carried(graph, &self.segments[at].frame, wrench);
                    for &(other, other_rate) in &self.segments[parent].free {
                        self.couple(graph, &mut matrix, (rate, other_rate), wrench.component(other));
                    }
                    at = parent;
                }
            }
            let Some(parent) = segment.station.parent else { continue };
            let mut moments = composite[index];
            for by in &segment.frame.moves {
                moments = moments.moved(graph, by);
            }
            composite[parent] = composite[parent].plus(graph, &moments);
        }
        matrix.retain(|_, entry| *entry != Graph::ZERO);
        matrix
    }

    /// Adds what two rates have in common to the lower triangle between unknowns.
    fn couple(
        &self,
        graph: &mut Graph,
        matrix: &mut BTreeMap<(usize, usize), ExprId>,
        (rate, other): (usize, usize),
        entry: ExprId,
    ) {
        for &(a, factor) in &self.embedding.rates[rate].columns {
            for &(b, other_factor) in &self.embedding.rates[other].columns {
                let scaled = graph.mul(factor, entry);
                let mut scaled = graph.mul(other_factor, scaled);
                if a == b && rate != other {
                    // Both orders are on the diagonal.
                    scaled = graph.add(scaled, scaled);
                }
                let whole = matrix.entry((a.max(b), a.min(b))).or_insert(Graph::ZERO);
                *whole = graph.add(*whole, scaled);
            }
        }
    }

    /// The accelerations of all rates of the tree; those of a body that nothing holds in the global frame, with that of
    /// gravity.
    pub(super) fn of_tree(&self, system: &mut System, unknowns: &[ExprId]) -> Vec<ExprId> {
        let mut found = self.embedding.rates_of_rates(&mut system.graph, unknowns);
        let gravity = system.numbers(&system.model.gravity);
        for segment in &self.segments {
            if let Freedom::Whole { position, orientation } = segment.station.freedom {
                let graph = &mut system.graph;
                let p = [0, 1, 2, 3].map(|k| graph.symbol(Symbol::Unit(orientation.x + k)));
                let rotation = graph.rotation(&p);
                let local = [0, 1, 2].map(|k| found[position.u + k]);
                let global = graph.mat_vec(&rotation, &local);
                let global = graph.add_vec(&global, &gravity);
                found[position.u..position.u + 3].copy_from_slice(&global);
            }
        }
        found
    }
}

/// Base inertial parameters of each station, in its frame: from the leaves to the roots, what a joint cannot tell from
/// mass of its carrier is moved there. A body that nothing holds stays as it is.
fn base_parameters(system: &mut System, stations: &[Station], frames: &[Frame]) -> Vec<MassMoments> {
    let mut all: Vec<_> =
        stations.iter().zip(frames).map(|(station, frame)| own_moments(system, station, frame)).collect();
    let graph = &mut system.graph;
    for (index, (station, frame)) in stations.iter().zip(frames).enumerate().rev() {
        let is_whole = |parent: usize| matches!(stations[parent].freedom, Freedom::Whole { .. });
        if station.parent.is_some_and(is_whole) && !matches!(station.freedom, Freedom::Rigid) {
            continue;
        }
        let (kept, mut given) = split(&station.freedom, &all[index]);
        all[index] = kept;
        let Some(parent) = station.parent else { continue };
        for (place, by) in frame.moves.iter().enumerate() {
            // What is given is the same however the joint stands.
            let is_joint = place == frame.joint && !matches!(station.freedom, Freedom::Rigid);
            if !is_joint {
                given = given.moved(graph, by);
            }
        }
        all[parent] = all[parent].plus(graph, &given);
    }
    all
}

/// What a joint tells, and what it does not.
fn split(freedom: &Freedom, moments: &MassMoments) -> (MassMoments, MassMoments) {
    let (mut kept, mut given) = (*moments, MassMoments::NONE);
    match freedom {
        Freedom::Rigid => std::mem::swap(&mut kept, &mut given),
        Freedom::Turn { .. } => {
            std::mem::swap(&mut kept.mass, &mut given.mass);
            std::mem::swap(&mut kept.first[2], &mut given.first[2]);
            std::mem::swap(&mut kept.second[2][2], &mut given.second[2][2]);
        }
        Freedom::Slide(_) => std::mem::swap(&mut kept.second, &mut given.second),
        Freedom::Ball(_) => std::mem::swap(&mut kept.mass, &mut given.mass),
        Freedom::Whole { .. } => {}
    }
    (kept, given)
}

/// Of the body alone, in its frame.
fn own_moments(system: &mut System, station: &Station, frame: &Frame) -> MassMoments {
    let Some(moving_body) = station.moving_body else { return MassMoments::NONE };
    let (mass, inertia) = (system.mass(moving_body), system.inertia(moving_body));
    let graph = &mut system.graph;
    let moments = MassMoments::of_body(graph, mass, &inertia);
    let from_origin = graph.neg_vec(&frame.origin);
    let moments = moments.moved(graph, &super::screw_moves::Move::Shift(from_origin));
    moments.moved(graph, &super::screw_moves::Move::Rotation(frame.axes))
}

/// What acts on a body besides gravity, as a wrench in its frame.
fn load(graph: &mut Graph, station: &Station, frame: &Frame, loads: &[SpatialVector]) -> SpatialVector {
    let Some(moving_body) = station.moving_body else { return SpatialVector::ZERO };
    let load = &loads[moving_body];
    let from_origin = graph.neg_vec(&frame.origin);
    let moment = graph.cross(&from_origin, &load.t);
    let torque = graph.add_vec(&load.rho, &moment);
    SpatialVector { t: graph.mat_vec(&frame.axes, &load.t), rho: graph.mat_vec(&frame.axes, &torque) }
}

/// The force along each free component.
fn along(system: &mut System, station: &Station, free: &[(usize, usize)], along: &[ExprId]) -> Vec<ExprId> {
    let mut own: Vec<_> = free.iter().map(|&(_, rate)| along[rate]).collect();
    if let Freedom::Whole { orientation, .. } = station.freedom {
        let graph = &mut system.graph;
        let p = [0, 1, 2, 3].map(|k| graph.symbol(Symbol::Unit(orientation.x + k)));
        let rotation = graph.rotation(&p);
        let local = graph.transposed_vec(&rotation, &[own[0], own[1], own[2]]);
        own[..3].copy_from_slice(&local);
    }
    own
}

/// Of a carrier without coordinates, in its frame.
pub(super) fn of_ground(system: &mut System, body: Option<usize>) -> Motion {
    let Some(body) = body else { return Motion::new(&mut system.graph, ZERO3, ZERO3, ZERO3) };
    let (gravity, pose) = (system.numbers(&system.model.gravity), system.poses[body]);
    let (linear, angular) = (time_derivative(system, &pose.s), time_derivative(system, &pose.w));
    let graph = &mut system.graph;
    let felt = graph.sub_vec(&linear, &gravity);
    let felt = graph.transposed_vec(&pose.a, &felt);
    Motion::new(graph, felt, pose.w, angular)
}

/// The acceleration of a carrier without coordinates, beyond that at the start.
fn of_carrier(system: &mut System, segment: &Segment, start: Start) -> SpatialVector {
    if start == Start::ConstantRates || segment.station.parent.is_some() {
        return SpatialVector::ZERO;
    }
    let ground = of_ground(system, segment.station.ground);
    SpatialVector { t: ground.t, rho: ground.rho_dot }
}

/// How a station moves if the rates of the tree accelerate so, from how its carrier moves.
pub(super) fn moving(
    graph: &mut Graph,
    station: &Station,
    (frame, accelerations): (&Frame, &[ExprId]),
    from: Motion,
) -> Motion {
    let mut motion = from;
    for by in frame.moves[frame.joint..].iter().rev() {
        motion = motion.back(graph, by);
    }
    motion = with_rates(graph, &station.freedom, accelerations, motion);
    for by in frame.moves[..frame.joint].iter().rev() {
        motion = motion.back(graph, by);
    }
    motion
}

/// With the motion of the joint itself; a body that nothing holds accelerates so in its own frame.
fn with_rates(graph: &mut Graph, freedom: &Freedom, accelerations: &[ExprId], motion: Motion) -> Motion {
    let rate = |graph: &mut Graph, u: usize| graph.symbol(Symbol::Rate(u));
    let three = |u: usize| [0, 1, 2].map(|k| accelerations[u + k]);
    let (mut given, mut t) = (ZERO3, motion.t);
    let spin = match *freedom {
        Freedom::Rigid => return motion,
        Freedom::Slide(place) => {
            let speed = [Graph::ZERO, Graph::ZERO, rate(graph, place.u)];
            let (turned, two) = (graph.cross(&motion.rho, &speed), graph.integer(2));
            let mut relative = graph.scale_vec(two, &turned);
            relative[2] = graph.add(relative[2], accelerations[place.u]);
            return Motion { t: graph.add_vec(&motion.t, &relative), ..motion };
        }
        Freedom::Turn { place, .. } => {
            given[2] = accelerations[place.u];
            [Graph::ZERO, Graph::ZERO, rate(graph, place.u)]
        }
        Freedom::Ball(place) => {
            given = three(place.u);
            [0, 1, 2].map(|k| rate(graph, place.u + k))
        }
        Freedom::Whole { position, orientation } => {
            t = graph.add_vec(&t, &three(position.u));
            given = three(orientation.u);
            [0, 1, 2].map(|k| rate(graph, orientation.u + k))
        }
    };
    let turning = graph.cross(&motion.rho, &spin);
    let turning = graph.add_vec(&turning, &given);
    let (rho, rho_dot) = (graph.add_vec(&motion.rho, &spin), graph.add_vec(&motion.rho_dot, &turning));
    Motion::new(graph, t, rho, rho_dot)
}

/// A wrench on a station as one on its carrier.
pub(super) fn carried(graph: &mut Graph, frame: &Frame, wrench: SpatialVector) -> SpatialVector {
    frame.moves.iter().fold(wrench, |wrench, by| by.wrench(graph, &wrench))
}
