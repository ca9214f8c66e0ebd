//! The accelerations of the joint coordinates of a mechanism with loops, in frames that suit its joints: the mass
//! matrix of its tree and the rows of the joints that close loops are one sparse symmetric system,
//!
//! ```text
//! [ M  Jᵀ ] [  z ]   [ f ]
//! [ J  0  ] [ −λ ] = [ γ ]
//! ```
//!
//! Rows of a ball joint that closes a loop are the relative acceleration of its points as one of its bodies sees them.
//! For the end of a leg that slides and turns about a universal or ball joint J is then all but diagonal, and the legs
//! of a platform are eliminated one by one, rates before rows: what is left of each is an inertia of the platform.

use super::axis_dynamics::{AxisTree, Segment, carried, moving};
use super::coordinates::Coordinates;
use super::elementary_joints::Freedom;
use super::mass_moments::Motion;
use super::screw_moves::Move;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Mat3, UNIT3, Vec3, ZERO3};
use crate::solve::ldl::Elimination;
use gyro_model::{JointKind, RowOwner, Support};

/// As the data sheet calls it.
pub const WITH_ROWS: &str = "mass matrix and rows of loops in joint frames";

/// Beyond this many unknowns and rows the sparse system is not tried.
const MAX_SIZE: usize = 60;

/// A row that the unknowns must meet: `J z = γ`.
struct Row {
    jacobian: Vec<ExprId>,
    gamma: ExprId,
}

/// The rows of a joint, and whether they follow at once what they alone hold.
struct Group {
    rows: Vec<Row>,
    ends_leg: bool,
}

/// A tree with the rows of its loops.
struct Closed<'a> {
    tree: &'a AxisTree,
    coordinates: &'a Coordinates,
    /// Of each rate of the tree, its acceleration if all unknowns are zero.
    biases: Vec<ExprId>,
}

/// Whether the system is worth working out.
pub fn is_small(tree: &AxisTree, coordinates: &Coordinates) -> bool {
    tree.embedding.n_unknowns + coordinates.loops.others.len() <= MAX_SIZE
}

/// The accelerations of all rates of the tree.
pub fn accelerations(system: &mut System, tree: &AxisTree, coordinates: &Coordinates) -> Vec<ExprId> {
    let closed = Closed { tree, coordinates, biases: coordinates.embedding.biases() };
    let groups = closed.groups(system);
    let n = tree.embedding.n_unknowns;
    let mut forces = tree.constant_forces(&mut system.graph);
    let mut entries = tree.mass_matrix(&mut system.graph);
    for (at, row) in (n..).zip(groups.iter().flat_map(|group| &group.rows)) {
        let entry =
            |(unknown, &entry): (usize, &ExprId)| (entry != Graph::ZERO).then_some(((at, unknown), entry));
        entries.extend(row.jacobian.iter().enumerate().filter_map(entry));
        forces.push(row.gamma);
    }
    let mut elimination = Elimination::new(entries, forces);
    for unknown in closed.order(&groups) {
        elimination.pivot(&mut system.graph, unknown);
    }
    let found = elimination.substitute_back(&mut system.graph);
    tree.of_tree(system, &found[..n])
}

impl Closed<'_> {
    /// What is eliminated when: legs with their ends, then what is left of the tree from its leaves to its roots, then
    /// what is left of the rows.
    fn order(&self, groups: &[Group]) -> Vec<usize> {
        let n = self.tree.embedding.n_unknowns;
        let outwards = self.tree.order();
        let mut order: Vec<usize> = Vec::new();
        let mut late = Vec::new();
        let mut at = n;
        for (place, group) in groups.iter().enumerate() {
            let rows = at..at + group.rows.len();
            at = rows.end;
            if group.ends_leg {
                let own = outwards.iter().rev().filter(|&&unknown| is_own(groups, place, unknown));
                order.extend(own.copied());
                order.extend(rows);
            } else {
                late.extend(rows);
            }
        }
        let rest: Vec<_> = outwards.into_iter().rev().filter(|unknown| !order.contains(unknown)).collect();
        order.into_iter().chain(rest).chain(late).collect()
    }

    fn groups(&self, system: &mut System) -> Vec<Group> {
        let owners: Vec<_> = system.model.rows().into_iter().map(|row| row.owner).collect();
        let mut joints: Vec<(RowOwner, Vec<usize>)> = Vec::new();
        for &row in &self.coordinates.loops.others {
            let owner = owners[self.coordinates.closure.rows[row]];
            match joints.iter_mut().find(|(known, _)| *known == owner) {
                Some((_, rows)) => rows.push(row),
                None => joints.push((owner, vec![row])),
            }
        }
        let mut sides = Vec::new();
        let mut groups = Vec::new();
        for (owner, rows) in joints {
            let ball = match owner {
                RowOwner::Joint(joint) if rows.len() == 3 => self.ball(system, joint),
                _ => None,
            };
            let (rows, side) = match ball {
                Some((rows, side)) => (rows, Some(side)),
                None => (rows.into_iter().map(|row| self.as_derived(system, row)).collect(), None),
            };
            sides.push(side);
            groups.push(Group { rows, ends_leg: false });
        }
        for (place, side) in sides.into_iter().enumerate() {
            groups[place].ends_leg = side.is_some_and(|side| self.ends_leg(&groups, place, side));
        }
        groups
    }

    /// A row as it is differentiated. Of a body that nothing holds, the tree has accelerations in its own frame, less
    /// that of gravity.
    fn as_derived(&self, system: &mut System, row: usize) -> Row {
        let closure = &self.coordinates.closure;
        let (mut jacobian, mut gamma) = (closure.jacobian[row].clone(), closure.gamma[row]);
        let gravity = system.numbers(&system.model.gravity);
        for segment in &self.tree.segments {
            let Freedom::Whole { position, orientation } = segment.station.freedom else { continue };
            let graph = &mut system.graph;
            let global = [0, 1, 2].map(|k| jacobian[position.u + k]);
            let fallen = graph.dot(&global, &gravity);
            gamma = graph.sub(gamma, fallen);
            let rotation = orientation_of(graph, orientation.x);
            let local = graph.transposed_vec(&rotation, &global);
            jacobian[position.u..position.u + 3].copy_from_slice(&local);
        }
        Row { jacobian: self.tree.embedding.projected(&mut system.graph, &jacobian), gamma }
    }

    /// The rows of a ball joint as the body on the shorter way to the ground sees them, and that body's segment. `None`
    /// if both stand on the ground, if that moves, or if a body is seen from a frame that does not turn with it.
    fn ball(&self, system: &mut System, joint: usize) -> Option<(Vec<Row>, usize)> {
        let description = &system.model.joints[joint];
        if description.kind != JointKind::Spherical {
            return None;
        }
        let bodies = [description.first.body, description.second.body];
        let frames = system.joints[joint];
        let mut ends =
            [(bodies[0], frames.first.point), (bodies[1], frames.second.point)].map(|(body, point)| {
                let moving_body = system.moving_body_of(body);
                let is_at =
                    |segment: &Segment| moving_body.is_some() && segment.station.moving_body == moving_body;
                (self.tree.segments.iter().position(is_at), body, point)
            });
        let holds = |end: &(Option<usize>, usize, Vec3)| match end.0 {
            Some(segment) => self.way(segment).all(|at| self.holds_frame(system, at)),
            None => system.model.bodies[end.1].support == Support::Fixed,
        };
        if !ends.iter().all(holds) {
            return None;
        }
        let distance =
            |end: Option<usize>| end.map(|segment| (self.floats(segment), self.way(segment).count()));
        let [first, second] = ends.map(|end| distance(end.0));
        if second.is_some_and(|second| first.is_none_or(|first| second < first)) {
            ends.swap(0, 1);
        }
        let [(Some(near), _, near_point), (far, _, far_point)] = ends else { return None };
        let meet = far.and_then(|far| self.way(near).find(|at| self.way(far).any(|other| other == *at)));
        let near_moves = self.moves(system, near, meet);
        let far_moves = match far {
            Some(far) => self.moves(system, far, meet),
            None => Vec::new(),
        };
        let near_arm = self.seen(&mut system.graph, near, &near_point);
        let far_arm = far.map(|far| self.seen(&mut system.graph, far, &far_point));

        // Accelerations of the two points if all unknowns are zero.
        let own = self.bias_of(system, near, meet, &near_arm);
        let mut other = ZERO3;
        if let (Some(far), Some(arm)) = (far, far_arm) {
            other = self.bias_of(system, far, meet, &arm);
        }
        let graph = &mut system.graph;
        for by in &far_moves {
            other = by.turned(graph, &other);
        }
        if meet.is_none() {
            let gravity = system.numbers(&system.model.gravity);
            let graph = &mut system.graph;
            match (self.floats(near), far.is_some_and(|far| self.floats(far))) {
                (true, false) => other = graph.sub_vec(&other, &gravity),
                (false, true) => other = graph.add_vec(&other, &gravity),
                _ => {}
            }
        }
        let graph = &mut system.graph;
        for by in near_moves.iter().rev() {
            other = by.turned_back(graph, &other);
        }
        let missing = graph.sub_vec(&other, &own);

        let rows = (0..3).map(|k| {
            let graph = &mut system.graph;
            let mut along = vec![Graph::ZERO; self.tree.embedding.rates.len()];
            let force = UNIT3[k];
            let push = SpatialVector { t: force, rho: graph.cross(&near_arm, &force) };
            let mut at_meet = self.push(graph, &mut along, near, meet, push);
            if let (Some(far), Some(arm)) = (far, far_arm) {
                let mut force = graph.neg_vec(&force);
                for by in &near_moves {
                    force = by.turned(graph, &force);
                }
                for by in far_moves.iter().rev() {
                    force = by.turned_back(graph, &force);
                }
                let pull = SpatialVector { t: force, rho: graph.cross(&arm, &force) };
                let other = self.push(graph, &mut along, far, meet, pull);
                at_meet = SpatialVector { t: ZERO3, rho: graph.add_vec(&at_meet.rho, &other.rho) };
            }
            if let Some(meet) = meet {
                self.push(graph, &mut along, meet, None, at_meet);
            }
            Row { jacobian: self.tree.embedding.projected(graph, &along), gamma: missing[k] }
        });
        Some((rows.collect(), near))
    }

    /// From a segment to its root.
    fn way(&self, segment: usize) -> impl Iterator<Item = usize> {
        std::iter::successors(Some(segment), |&at| self.tree.segments[at].station.parent)
    }

    /// Whether nothing holds the root of a segment.
    fn floats(&self, segment: usize) -> bool {
        let root = self.way(segment).last();
        root.is_some_and(|root| matches!(self.tree.segments[root].station.freedom, Freedom::Whole { .. }))
    }

    /// Whether a segment's frame turns with it, and whether it stands on ground that is at rest.
    fn holds_frame(&self, system: &System, segment: usize) -> bool {
        let station = &self.tree.segments[segment].station;
        let rests = station.ground.is_none_or(|body| system.model.bodies[body].support != Support::Driven);
        rests && !matches!(station.freedom, Freedom::Turn { turns: false, .. })
    }

    /// What turns vectors of a segment's frame into those of another nearer to the root, or into global ones.
    fn moves(&self, system: &mut System, segment: usize, until: Option<usize>) -> Vec<Move> {
        let mut moves = Vec::new();
        for at in self.way(segment).take_while(|&at| Some(at) != until) {
            let Segment { station, frame, .. } = &self.tree.segments[at];
            moves.extend(frame.moves.iter().filter(|by| !matches!(by, Move::Shift(_))).copied());
            if let Freedom::Whole { orientation, .. } = station.freedom {
                moves.push(Move::Rotation(orientation_of(&mut system.graph, orientation.x)));
            }
            let of_ground = station.ground.map(|body| system.poses[body].a);
            moves.extend(of_ground.filter(|a| *a != UNIT3).map(Move::Rotation));
        }
        moves
    }

    /// A point of a body in its segment's frame.
    fn seen(&self, graph: &mut Graph, segment: usize, point: &Vec3) -> Vec3 {
        let frame = &self.tree.segments[segment].frame;
        let from_origin = graph.sub_vec(point, &frame.origin);
        graph.mat_vec(&frame.axes, &from_origin)
    }

    /// The acceleration of a point of a segment if all unknowns are zero, less that of the origin where the ways of two
    /// bodies meet.
    fn bias_of(&self, system: &mut System, segment: usize, meet: Option<usize>, arm: &Vec3) -> Vec3 {
        let graph = &mut system.graph;
        let mut motion = match meet {
            Some(meet) => {
                let Motion { rho, rho_dot, .. } = self.tree.segments[meet].motion;
                Motion::new(graph, ZERO3, rho, rho_dot)
            }
            None => Motion::new(graph, ZERO3, ZERO3, ZERO3),
        };
        let mut way: Vec<_> = self.way(segment).take_while(|&at| Some(at) != meet).collect();
        way.reverse();
        for at in way {
            let Segment { station, frame, .. } = &self.tree.segments[at];
            motion = moving(graph, station, (frame, &self.biases), motion);
        }
        let relative = graph.mat_vec(&motion.field, arm);
        graph.add_vec(&motion.t, &relative)
    }

    /// Adds what a wrench on a segment does along the rates up to another nearer to the root; the wrench there.
    fn push(
        &self,
        graph: &mut Graph,
        along: &mut [ExprId],
        segment: usize,
        until: Option<usize>,
        mut wrench: SpatialVector,
    ) -> SpatialVector {
        for at in self.way(segment).take_while(|&at| Some(at) != until) {
            let Segment { free, frame, .. } = &self.tree.segments[at];
            for &(component, rate) in free {
                along[rate] = graph.add(along[rate], wrench.component(component));
            }
            wrench = carried(graph, frame, wrench);
        }
        wrench
    }

    /// Whether the body of a segment is the end of a leg that goes wherever a ball joint takes it: it slides along what
    /// a universal or ball joint turns, and nothing but that joint holds these.
    fn ends_leg(&self, groups: &[Group], group: usize, segment: usize) -> bool {
        let is_own = |&at: &usize| {
            let rates = self.tree.segments[at].free.iter().map(|&(_, rate)| &self.tree.embedding.rates[rate]);
            rates.flat_map(|rate| &rate.columns).all(|&(unknown, _)| is_own(groups, group, unknown))
        };
        let leg: Vec<_> = self.way(segment).take_while(is_own).collect();
        let freedom = |at: usize| self.tree.segments[at].station.freedom;
        let is_free = |at: usize| !self.tree.segments[at].free.is_empty();
        let Some(slide) = leg.iter().position(|&at| is_free(at) && matches!(freedom(at), Freedom::Slide(_)))
        else {
            return false;
        };
        leg[slide + 1..].iter().any(|&at| {
            let is_turn = |at: usize| is_free(at) && matches!(freedom(at), Freedom::Turn { .. });
            let within = |parent: usize| self.tree.segments[parent].station.moving_body.is_none();
            let is_universal = self.tree.segments[at].station.parent.is_some_and(|parent| {
                leg.contains(&parent) && is_turn(at) && is_turn(parent) && within(parent)
            });
            matches!(freedom(at), Freedom::Ball(_)) || is_universal
        })
    }
}

/// Whether an unknown is in the rows of one group and in no others.
fn is_own(groups: &[Group], group: usize, unknown: usize) -> bool {
    groups.iter().enumerate().all(|(place, other)| {
        let is_in = other.rows.iter().any(|row| row.jacobian[unknown] != Graph::ZERO);
        is_in == (place == group)
    })
}

fn orientation_of(graph: &mut Graph, x: usize) -> Mat3 {
    let p = [0, 1, 2, 3].map(|k| graph.symbol(Symbol::Unit(x + k)));
    graph.rotation(&p)
}
