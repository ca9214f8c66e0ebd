//! The derivatives of inverse dynamics of an open tree, by recursion (J. Carpentier and N. Mansard, *Analytical
//! derivatives of rigid body dynamics algorithms* (2018); S. Singh, R. Russell and P. Wensing, *Efficient analytical
//! derivatives of rigid-body dynamics using spatial vector algebra*, IEEE Robotics and Automation Letters 7 (2022)), in
//! frames that suit its joints, from base inertial parameters.
//!
//! What a joint carries does not change if the joint is displaced: seen from there it is the carrier that moves
//! otherwise. If the frame at the joint turns faster by δω, its acceleration and its angular acceleration being
//! changed too, a point at r, which moves at ṙ from the origin, accelerates by
//!
//! ```text
//! δa + δψ × r + 2 δω × ṙ,    δψ = δω̇ + ω × δω
//! ```
//!
//! more, wherever it is in the tree beyond. So force and torque follow from `∫ dm`, `∫ r dm`, `∫ r rᵀ dm`, `∫ ṙ dm` and
//! `∫ r ṙᵀ dm` of all that is carried; and what a change further down does to a joint beyond is the same product with
//! the roles exchanged.

use super::axis_dynamics::{AxisTree, Segment, of_ground};
use super::elementary_joints::Freedom;
use super::mass_moments::{MassMoments, Motion};
use super::screw_moves::Move;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Mat3, UNIT3, Vec3, ZERO3};
use std::collections::BTreeMap;

/// Entries by row and column, without zeros.
pub type Entries = BTreeMap<(usize, usize), ExprId>;

/// The derivatives of τ by the displacements and by the rates, between unknowns; displacements of a body that nothing
/// holds are in its own frame.
#[derive(Debug, Default)]
pub struct Slopes {
    pub by_place: Entries,
    pub by_rate: Entries,
}

/// All that a joint carries.
#[derive(Clone, Copy)]
struct Carried {
    moments: MassMoments,
    /// `2 ∫ ṙ dm`.
    momentum: Vec3,
    /// `2 ∫ r ṙᵀ dm`.
    flow: Mat3,
}

/// How the motion of a frame changes: what is said of δa, δψ and δω above.
#[derive(Clone, Copy)]
struct Change {
    a: Vec3,
    psi: Vec3,
    omega: Vec3,
}

impl Change {
    const NONE: Self = Self { a: ZERO3, psi: ZERO3, omega: ZERO3 };
}

/// What a change of the motion of a frame does to one force.
#[derive(Clone, Copy)]
struct Effect {
    /// Of δa and δψ: what a unit acceleration along the force takes.
    wrench: SpatialVector,
    omega: Vec3,
}

/// A free component of a segment.
#[derive(Clone, Copy)]
struct Free {
    component: usize,
    rate: usize,
    /// By a displacement along it, and by its rate.
    changes: [Change; 2],
    /// Whether the frame is displaced with it.
    is_displaced: bool,
}

impl AxisTree {
    /// At these motions.
    pub fn slopes(&self, system: &mut System, motions: &[Motion]) -> Slopes {
        let (mut free, mut speeds): (Vec<Vec<Free>>, Vec<Vec<Vec3>>) = (Vec::new(), Vec::new());
        for (segment, motion) in self.segments.iter().zip(motions) {
            let carrier = match segment.station.parent {
                Some(parent) => motions[parent],
                None => of_ground(system, segment.station.ground),
            };
            let (of_moves, of_carrier) = self::speeds(&mut system.graph, segment, &carrier);
            free.push(self::free(&mut system.graph, segment, motion, &of_carrier));
            speeds.push(of_moves);
        }
        let graph = &mut system.graph;
        let mut carried: Vec<_> = (self.segments.iter().zip(motions))
            .map(|(segment, motion)| Carried::of_body(graph, &segment.moments, &motion.rho))
            .collect();
        let mut wrenches: Vec<_> =
            self.segments.iter().zip(motions).map(|(s, motion)| s.moments.wrench(graph, motion)).collect();
        let mut slopes = Slopes::default();
        for (index, segment) in self.segments.iter().enumerate().rev() {
            for own in &free[index] {
                let whole = &carried[index];
                let [mut by_place, mut by_rate] = own.changes.map(|change| whole.response(graph, &change));
                let mut effect = whole.effect(graph, own.component);
                let turned = if own.is_displaced {
                    turned_with(graph, own.component, &wrenches[index], &by_place)
                } else {
                    by_place
                };
                for other in &free[index] {
                    // Forces on a body that nothing holds are given in the global frame, where they turn with it.
                    let is_global =
                        matches!(segment.station.freedom, Freedom::Whole { .. }) && other.component < 3;
                    let of_place = if is_global { &turned } else { &by_place };
                    let place = (other.rate, own.rate);
                    self.add(graph, &mut slopes.by_place, place, of_place.component(other.component));
                    self.add(graph, &mut slopes.by_rate, place, by_rate.component(other.component));
                }
                by_place = turned;
                let mut at = index;
                while let Some(parent) = self.segments[at].station.parent {
                    for (by, speed) in self.segments[at].frame.moves.iter().zip(&speeds[at]) {
                        [by_place, by_rate] = [by_place, by_rate].map(|wrench| by.wrench(graph, &wrench));
                        effect = effect.moved(graph, by, speed);
                    }
                    for other in &free[parent] {
                        let (row, column) = (other.rate, own.rate);
                        let [of_place, of_rate] = other.changes.map(|change| effect.of(graph, &change));
                        self.add(
                            graph,
                            &mut slopes.by_place,
                            (row, column),
                            by_place.component(other.component),
                        );
                        self.add(
                            graph,
                            &mut slopes.by_rate,
                            (row, column),
                            by_rate.component(other.component),
                        );
                        self.add(graph, &mut slopes.by_place, (column, row), of_place);
                        self.add(graph, &mut slopes.by_rate, (column, row), of_rate);
                    }
                    at = parent;
                }
            }
            let Some(parent) = segment.station.parent else { continue };
            let (mut all, mut wrench) = (carried[index], wrenches[index]);
            for (by, speed) in segment.frame.moves.iter().zip(&speeds[index]) {
                all = all.moved(graph, by, speed);
                wrench = by.wrench(graph, &wrench);
            }
            carried[parent] = carried[parent].plus(graph, &all);
            wrenches[parent] = wrenches[parent].plus(graph, &wrench);
        }
        slopes
    }

    /// Adds what two rates of the tree have in common to the entries between unknowns.
    fn add(&self, graph: &mut Graph, entries: &mut Entries, (row, column): (usize, usize), entry: ExprId) {
        for &(a, factor) in &self.embedding.rates[row].columns {
            for &(b, other_factor) in &self.embedding.rates[column].columns {
                let scaled = graph.mul(factor, entry);
                let scaled = graph.mul(other_factor, scaled);
                if scaled != Graph::ZERO {
                    let whole = entries.entry((a, b)).or_insert(Graph::ZERO);
                    *whole = graph.add(*whole, scaled);
                }
            }
        }
    }
}

impl Carried {
    fn of_body(graph: &mut Graph, moments: &MassMoments, spin: &Vec3) -> Self {
        let two = graph.integer(2);
        let first = graph.scale_vec(two, &moments.first);
        let second = moments.second.map(|row| graph.scale_vec(two, &row));
        // ∫ r (ω × r)ᵀ dm, a row of which is ω × ∫ r r_i dm.
        Self {
            moments: *moments,
            momentum: graph.cross(spin, &first),
            flow: second.map(|row| graph.cross(spin, &row)),
        }
    }

    fn plus(&self, graph: &mut Graph, other: &Self) -> Self {
        Self {
            moments: self.moments.plus(graph, &other.moments),
            momentum: graph.add_vec(&self.momentum, &other.momentum),
            flow: std::array::from_fn(|row| graph.add_vec(&self.flow[row], &other.flow[row])),
        }
    }

    /// In the frame that a move leads to; `speed` is twice that of a shift.
    fn moved(&self, graph: &mut Graph, by: &Move, speed: &Vec3) -> Self {
        let moments = self.moments.moved(graph, by);
        let Move::Shift(arm) = by else {
            let (momentum, flow) = (by.turned(graph, &self.momentum), by.turned_matrix(graph, &self.flow));
            return Self { moments, momentum, flow };
        };
        let carried = graph.scale_vec(moments.mass, speed);
        let flow = std::array::from_fn(|row| {
            let own = graph.scale_vec(moments.first[row], speed);
            let rest = graph.scale_vec(arm[row], &self.momentum);
            let both = graph.add_vec(&own, &rest);
            graph.add_vec(&self.flow[row], &both)
        });
        Self { moments, momentum: graph.add_vec(&self.momentum, &carried), flow }
    }

    /// `2 ∫ (r·ṙ 1 − ṙ rᵀ) dm`.
    fn turning(&self, graph: &mut Graph) -> Mat3 {
        let v = &self.flow;
        std::array::from_fn(|row| {
            std::array::from_fn(|column| {
                if row == column {
                    graph.add(v[(row + 1) % 3][(row + 1) % 3], v[(row + 2) % 3][(row + 2) % 3])
                } else {
                    graph.neg(v[column][row])
                }
            })
        })
    }

    /// The wrench that a change of the motion takes.
    fn response(&self, graph: &mut Graph, change: &Change) -> SpatialVector {
        let Change { a, psi, omega } = change;
        let MassMoments { mass, first, .. } = &self.moments;
        let (even, turned) = (graph.scale_vec(*mass, a), graph.cross(psi, first));
        let (force, swept) = (graph.add_vec(&even, &turned), graph.cross(omega, &self.momentum));
        let (inertia, turning) = (self.moments.inertia(graph), self.turning(graph));
        let (carried, torque) = (graph.cross(first, a), graph.mat_vec(&inertia, psi));
        let (torque, swept_about) = (graph.add_vec(&carried, &torque), graph.mat_vec(&turning, omega));
        SpatialVector { t: graph.add_vec(&force, &swept), rho: graph.add_vec(&torque, &swept_about) }
    }

    /// What changes of the motion do to the force along a component.
    fn effect(&self, graph: &mut Graph, component: usize) -> Effect {
        let unit = UNIT3[component % 3];
        let omega = if component < 3 {
            graph.cross(&self.momentum, &unit)
        } else {
            self.turning(graph)[component - 3]
        };
        Effect { wrench: self.moments.wrench_of(graph, component), omega }
    }
}

impl Effect {
    /// In the frame that a move leads to; `speed` is twice that of a shift.
    fn moved(&self, graph: &mut Graph, by: &Move, speed: &Vec3) -> Self {
        let (wrench, mut omega) = (by.wrench(graph, &self.wrench), by.turned(graph, &self.omega));
        if matches!(by, Move::Shift(_)) {
            let swept = graph.cross(speed, &self.wrench.t);
            omega = graph.add_vec(&omega, &swept);
        }
        Self { wrench, omega }
    }

    fn of(&self, graph: &mut Graph, change: &Change) -> ExprId {
        let (even, turned) = (graph.dot(&self.wrench.t, &change.a), graph.dot(&self.wrench.rho, &change.psi));
        let (swept, sum) = (graph.dot(&self.omega, &change.omega), graph.add(even, turned));
        graph.add(sum, swept)
    }
}

/// The free components of a segment that moves so, `carrier` being how what carries it turns.
fn free(graph: &mut Graph, segment: &Segment, motion: &Motion, carrier: &[Vec3; 2]) -> Vec<Free> {
    let freedom = &segment.station.freedom;
    let is_displaced = !matches!(freedom, Freedom::Turn { turns: false, .. });
    let mut free = Vec::new();
    for &(component, rate) in &segment.free {
        let mut changes = changes(graph, freedom, component, (motion, carrier));
        if !is_displaced {
            changes[0] = Change::NONE;
        }
        free.push(Free { component, rate, changes, is_displaced });
    }
    free
}

/// How the motion of a frame changes by a displacement along a component and by its rate, forces being seen from what
/// is displaced.
fn changes(
    graph: &mut Graph,
    freedom: &Freedom,
    component: usize,
    (motion, [spin_of_carrier, its_rate]): (&Motion, &[Vec3; 2]),
) -> [Change; 2] {
    let (unit, two) = (UNIT3[component % 3], graph.integer(2));
    let column = motion.field.map(|row| row[component % 3]);
    let across = graph.cross(&motion.rho, &unit);
    let felt = graph.cross(&motion.t, &unit);
    match freedom {
        Freedom::Rigid => [Change::NONE; 2],
        Freedom::Whole { .. } if component < 3 => [Change::NONE; 2],
        Freedom::Slide(_) => {
            let swept = graph.scale_vec(two, &across);
            [column, swept].map(|a| Change { a, ..Change::NONE })
        }
        // ω of the carrier and of the body have the same product with the axis.
        Freedom::Turn { .. } => {
            let psi = graph.scale_vec(two, &across);
            [Change { a: felt, psi: column, omega: across }, Change { a: ZERO3, psi, omega: unit }]
        }
        Freedom::Ball(_) | Freedom::Whole { .. } => {
            let spin = graph.sub_vec(&motion.rho, spin_of_carrier);
            let omega = graph.cross(spin_of_carrier, &unit);
            // ω̇ = ω̇₀ + ω₀ × σ + σ̇ with the carrier's ω₀ and the own spin σ.
            let (turned, swept) = (graph.cross(its_rate, &unit), graph.cross(&omega, &spin));
            let (omega_dot, beside) = (graph.add_vec(&turned, &swept), graph.cross(&motion.rho, &omega));
            let psi = graph.add_vec(&omega_dot, &beside);
            let of_rate = Change { a: ZERO3, psi: graph.add_vec(&omega, &across), omega: unit };
            [Change { a: felt, psi, omega }, of_rate]
        }
    }
}

/// Of each move that leads to the carrier twice the speed at which it shifts; and how the carrier turns, seen from
/// where the joint is: its angular velocity and acceleration.
fn speeds(graph: &mut Graph, segment: &Segment, carrier: &Motion) -> (Vec<Vec3>, [Vec3; 2]) {
    let (moves, joint) = (&segment.frame.moves, segment.frame.joint);
    let two = graph.integer(2);
    let mut speeds = vec![ZERO3; moves.len()];
    let (mut rho, mut rho_dot) = (carrier.rho, carrier.rho_dot);
    let mut of_carrier = [rho, rho_dot];
    for (place, by) in moves.iter().enumerate().rev() {
        if place + 1 == joint {
            let spin = own_spin(graph, &segment.station.freedom);
            rho = graph.add_vec(&rho, &spin);
        }
        if let Move::Shift(arm) = by {
            let arm = graph.scale_vec(two, arm);
            speeds[place] = graph.cross(&rho, &arm);
        }
        (rho, rho_dot) = (by.turned_back(graph, &rho), by.turned_back(graph, &rho_dot));
        if place == joint {
            of_carrier = [rho, rho_dot];
        }
    }
    if let Freedom::Slide(place) = segment.station.freedom {
        let rate = graph.symbol(Symbol::Rate(place.u));
        let along = graph.mul(two, rate);
        speeds[joint][2] = graph.add(speeds[joint][2], along);
    }
    (speeds, of_carrier)
}

fn own_spin(graph: &mut Graph, freedom: &Freedom) -> Vec3 {
    match *freedom {
        Freedom::Turn { place, .. } => [Graph::ZERO, Graph::ZERO, graph.symbol(Symbol::Rate(place.u))],
        Freedom::Ball(place) => [0, 1, 2].map(|k| graph.symbol(Symbol::Rate(place.u + k))),
        Freedom::Whole { orientation, .. } => {
            [0, 1, 2].map(|k| graph.symbol(Symbol::Rate(orientation.u + k)))
        }
        Freedom::Rigid | Freedom::Slide(_) => ZERO3,
    }
}

/// A wrench that changes so, and turns or is shifted with a displacement along a component.
fn turned_with(
    graph: &mut Graph,
    component: usize,
    wrench: &SpatialVector,
    change: &SpatialVector,
) -> SpatialVector {
    let unit = UNIT3[component % 3];
    let force = graph.cross(&unit, &wrench.t);
    if component < 3 {
        return SpatialVector { t: change.t, rho: graph.add_vec(&change.rho, &force) };
    }
    let torque = graph.cross(&unit, &wrench.rho);
    SpatialVector { t: graph.add_vec(&change.t, &force), rho: graph.add_vec(&change.rho, &torque) }
}
