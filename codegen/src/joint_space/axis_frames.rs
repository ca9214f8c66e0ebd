//! Frames of bodies that suit their joints. In which frame a body's quantities are written is free to choose: the
//! axis of its joint is z, its origin is where the common normal with the axis of the next joint meets it, and x is
//! along that normal (J. Denavit and R. Hartenberg (1955), as modified by W. Khalil and J.-F. Kleinfinger, *A new
//! geometric notation for open and closed-loop robots* (1986)). What leads from a body to its carrier is then a turn
//! about z, a constant one about x, and shifts along these axes. Neither the state nor the results depend on frames.

use super::elementary_joints::{Freedom, Seat, Station};
use super::screw_moves::Move;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Mat3, UNIT3, Vec3, ZERO3, transposed};

/// The square of the sine of an angle of about half a degree.
const ALL_BUT_PARALLEL: f64 = 1e-4;

/// The chosen frame of a body.
#[derive(Clone, Debug)]
pub struct Frame {
    /// Seen from the body's own frame.
    pub origin: Vec3,
    /// Its axes, each seen from the body's own frame.
    pub axes: Mat3,
    /// What leads to the frame of the carrier.
    pub moves: Vec<Move>,
    /// Among the moves: after how many of them the joint itself comes.
    pub joint: usize,
}

impl Frame {
    fn own(joint: usize, moves: Vec<Move>) -> Self {
        Self { origin: ZERO3, axes: UNIT3, moves, joint }
    }
}

/// A frame for each station, root first.
pub fn frames(system: &mut System, stations: &[Station]) -> Vec<Frame> {
    let next = next_joints(stations);
    let mut frames: Vec<Frame> = Vec::new();
    for (index, station) in stations.iter().enumerate() {
        let graph = &mut system.graph;
        let next = next[index].map(|next| stations[next].on_parent);
        let carrier = station.parent.map(|parent| Carrier {
            origin: frames[parent].origin,
            axes: frames[parent].axes,
            has_axis: matches!(stations[parent].freedom, Freedom::Turn { .. }),
        });
        let carrier = carrier.unwrap_or(Carrier { origin: ZERO3, axes: UNIT3, has_axis: false });
        let placing = Placing { station, carrier, next };
        let frame = match station.freedom {
            Freedom::Whole { .. } => Frame::own(0, Vec::new()),
            Freedom::Rigid => placing.rigid(graph),
            Freedom::Ball(place) => {
                let p = [0, 1, 2, 3].map(|k| graph.symbol(Symbol::Unit(place.x + k)));
                let rotation = graph.rotation(&p);
                placing.ball(graph, &rotation)
            }
            Freedom::Turn { place, turns } => {
                let turn = if turns {
                    [Symbol::Sine(place.x), Symbol::Cosine(place.x)].map(|symbol| graph.symbol(symbol))
                } else {
                    [Graph::ZERO, Graph::ONE]
                };
                placing.hinge(graph, turn)
            }
            Freedom::Slide(place) => {
                let x = graph.symbol(Symbol::Coordinate(place.x));
                placing.slider(graph, x)
            }
        };
        frames.push(frame);
    }
    frames
}

/// Of each station the joint that its frame is made for: that with most joints beyond it.
fn next_joints(stations: &[Station]) -> Vec<Option<usize>> {
    let mut sizes = vec![1_usize; stations.len()];
    let mut next: Vec<Option<usize>> = vec![None; stations.len()];
    for (index, station) in stations.iter().enumerate().rev() {
        let Some(parent) = station.parent else { continue };
        sizes[parent] += sizes[index];
        let has_axis = matches!(station.freedom, Freedom::Turn { .. } | Freedom::Slide(_));
        if has_axis && next[parent].is_none_or(|known| sizes[known] <= sizes[index]) {
            next[parent] = Some(index);
        }
    }
    next
}

/// The frame that a station hangs in.
struct Carrier {
    origin: Vec3,
    axes: Mat3,
    /// Whether its z is the axis of a joint.
    has_axis: bool,
}

struct Placing<'s> {
    station: &'s Station,
    carrier: Carrier,
    /// Where the next joint is on the body.
    next: Option<Seat>,
}

impl Placing<'_> {
    fn rigid(&self, graph: &mut Graph) -> Frame {
        let Station { on_parent, on_body, .. } = self.station;
        let Carrier { origin, axes, .. } = &self.carrier;
        let from_joint = graph.sub_vec(origin, &on_parent.point);
        let origin = carried(graph, on_parent, on_body, &from_joint);
        let origin = graph.add_vec(&on_body.point, &origin);
        let axes = axes.map(|axis| carried(graph, on_parent, on_body, &axis));
        Frame { origin, axes, moves: Vec::new(), joint: 0 }
    }

    fn ball(&self, graph: &mut Graph, rotation: &Mat3) -> Frame {
        let Station { on_parent, on_body, .. } = self.station;
        let rotation = graph.mat_mul(&self.carrier.axes, rotation);
        let place = self.seen(graph, &on_parent.point);
        let moves = vec![Move::Rotation(rotation), Move::Shift(place)];
        Frame { origin: on_body.point, axes: UNIT3, moves, joint: 0 }
    }

    fn slider(&self, graph: &mut Graph, x: ExprId) -> Frame {
        let Station { on_parent, on_body, .. } = self.station;
        let relative = self.relative(graph);
        let (axes, angles) = match Angles::of(graph, &relative) {
            Ok(angles) => {
                let back = graph.neg(angles.third[0]);
                let axes = about_z(graph, &on_body.triad, [back, angles.third[1]]);
                (axes, Ok(Angles { third: [Graph::ZERO, Graph::ONE], ..angles }))
            }
            Err(rotation) => (on_body.triad, Err(rotation)),
        };
        // A leaf is best seen from its mass centre.
        let origin = if self.next.is_none() { ZERO3 } else { on_body.point };
        let from_joint = graph.sub_vec(&origin, &on_body.point);
        let from_joint = carried(graph, on_body, on_parent, &from_joint);
        let place = graph.add_vec(&on_parent.point, &from_joint);
        let mut moves = vec![Move::Shift([Graph::ZERO, Graph::ZERO, x])];
        match angles {
            Ok(angles) => moves.extend([about(0, angles.second), about(2, angles.first)]),
            Err(rotation) => moves.push(Move::Rotation(rotation)),
        }
        moves.push(Move::Shift(self.seen(graph, &place)));
        Frame { origin, axes, moves, joint: 0 }
    }

    fn hinge(&self, graph: &mut Graph, turn: [ExprId; 2]) -> Frame {
        let Station { on_parent, on_body, .. } = self.station;
        let foot = self.foot(graph);
        let along = self.next_foot(graph).unwrap_or(foot);
        let ahead = graph.scale_vec(along, &on_body.triad[2]);
        let origin = graph.add_vec(&on_body.point, &ahead);
        let beyond = graph.sub(along, foot);
        let mut moves = vec![Move::Shift([Graph::ZERO, Graph::ZERO, beyond])];
        let ahead = graph.scale_vec(foot, &on_parent.triad[2]);
        let place = graph.add_vec(&on_parent.point, &ahead);
        let place = self.seen(graph, &place);
        let relative = self.relative(graph);
        let (axes, offsets) = match Angles::of(graph, &relative) {
            Ok(angles) => {
                let (heading, offsets) = self.heading(graph, angles.third);
                moves.extend([about(2, [Graph::ZERO; 2]), about(0, angles.second)]);
                moves.extend(angles.last_moves(graph, &place));
                (about_z(graph, &on_body.triad, heading), offsets)
            }
            Err(rotation) => {
                let none = [Graph::ZERO; 2];
                moves.extend([about(2, none), Move::Rotation(rotation), Move::Shift(place)]);
                (on_body.triad, [[Graph::ZERO, Graph::ONE]; 2])
            }
        };
        let [sine, cosine] = offsets.into_iter().fold(turn, |sum, offset| sum_of_angles(graph, sum, offset));
        moves[1] = Move::Turn { axis: 2, sine, cosine };
        Frame { origin, axes, moves, joint: 1 }
    }

    /// The joint's triad in the carrier's frame.
    fn relative(&self, graph: &mut Graph) -> Mat3 {
        let columns = self.station.on_parent.triad.map(|v| graph.mat_vec(&self.carrier.axes, &v));
        transposed(&columns)
    }

    /// A point of the carrying body in the carrier's frame.
    fn seen(&self, graph: &mut Graph, point: &Vec3) -> Vec3 {
        let from_origin = graph.sub_vec(point, &self.carrier.origin);
        graph.mat_vec(&self.carrier.axes, &from_origin)
    }

    /// How far along the axis the carrier's axis, or its origin, is nearest.
    fn foot(&self, graph: &mut Graph) -> ExprId {
        let Seat { point, triad } = &self.station.on_parent;
        if self.station.parent.is_none() {
            return Graph::ZERO;
        }
        let Carrier { origin, axes, has_axis } = &self.carrier;
        let nearest = if *has_axis { nearest(graph, (point, &triad[2]), (origin, &axes[2])) } else { None };
        nearest.unwrap_or_else(|| {
            let towards = graph.sub_vec(origin, point);
            let along = graph.dot(&towards, &triad[2]);
            if is_exact(graph, &[along]) { along } else { Graph::ZERO }
        })
    }

    /// How far along the axis that of the next joint is nearest.
    fn next_foot(&self, graph: &mut Graph) -> Option<ExprId> {
        let (next, Seat { point, triad }) = (self.next?, &self.station.on_body);
        nearest(graph, (point, &triad[2]), (&next.point, &next.triad[2]))
    }

    /// Sine and cosine of the angle from the joint's zero direction on the body to x, and of the angles to add to the
    /// joint's: two where the sine or cosine of their sum is one of unlike roots.
    fn heading(&self, graph: &mut Graph, third: [ExprId; 2]) -> ([ExprId; 2], [[ExprId; 2]; 2]) {
        let none = [Graph::ZERO, Graph::ONE];
        if let Some(heading) = self.normal(graph) {
            let offset = sum_of_angles(graph, heading, third);
            let is_whole = is_exact(graph, &offset);
            return (heading, if is_whole { [offset, none] } else { [third, heading] });
        }
        let is_right = third.contains(&Graph::ZERO);
        if self.next.is_none() || is_right {
            ([graph.neg(third[0]), third[1]], [none; 2])
        } else {
            (none, [third, none])
        }
    }

    /// Sine and cosine of the angle from the joint's zero direction to the common normal with the next axis.
    fn normal(&self, graph: &mut Graph) -> Option<[ExprId; 2]> {
        let (next, Seat { point, triad: [f, g, h] }) = (self.next?, &self.station.on_body);
        let mut across = graph.cross(h, &next.triad[2]);
        if across != ZERO3 {
            let square = graph.dot(&across, &across);
            if !are_apart(graph, square) {
                return None;
            }
        } else {
            let towards = graph.sub_vec(&next.point, point);
            let along = graph.dot(&towards, h);
            let along = graph.scale_vec(along, h);
            across = graph.sub_vec(&towards, &along);
        }
        if across == ZERO3 || !is_exact(graph, &across) {
            return None;
        }
        let x = graph.normalise(&across);
        let heading = [graph.dot(g, &x), graph.dot(f, &x)];
        is_exact(graph, &heading).then_some(heading)
    }
}

/// A constant rotation as turns about z, x and z, the last of which comes first: sine and cosine of each.
#[derive(Clone, Copy)]
struct Angles {
    first: [ExprId; 2],
    second: [ExprId; 2],
    third: [ExprId; 2],
}

impl Angles {
    /// The rotation itself, if they are not constants that can be written exactly.
    fn of(graph: &mut Graph, rotation: &Mat3) -> Result<Self, Mat3> {
        let none = [Graph::ZERO, Graph::ONE];
        let cosine = rotation[2][2];
        let minus_one = graph.neg(Graph::ONE);
        if cosine == Graph::ONE || cosine == minus_one {
            let second = if cosine == Graph::ONE { none } else { [Graph::ZERO, minus_one] };
            let third = [graph.mul(cosine, rotation[1][0]), rotation[0][0]];
            return if is_exact(graph, &third) {
                Ok(Self { first: none, second, third })
            } else {
                Err(*rotation)
            };
        }
        let square = graph.mul(cosine, cosine);
        let square = graph.sub(Graph::ONE, square);
        if !is_exact(graph, &[square]) {
            return Err(*rotation);
        }
        let sine = graph.sqrt(square);
        let inverse = graph.recip(sine);
        let minus = graph.neg(inverse);
        let first = [graph.mul(rotation[0][2], inverse), graph.mul(rotation[1][2], minus)];
        let third = [graph.mul(rotation[2][0], inverse), graph.mul(rotation[2][1], inverse)];
        let all = [first, [sine, cosine], third];
        if is_exact(graph, all.as_flattened()) {
            Ok(Self { first, second: [sine, cosine], third })
        } else {
            Err(*rotation)
        }
    }

    /// The first turn and the shift to a place that is given in the last frame.
    fn last_moves(&self, graph: &mut Graph, place: &Vec3) -> Vec<Move> {
        let [sine, cosine] = self.first;
        let back = Move::Turn { axis: 2, sine, cosine }.turned_back(graph, place);
        let is_along = back[1] == Graph::ZERO && is_exact(graph, &back);
        if !self.first.contains(&Graph::ZERO) && is_along {
            let (before, after) = ([back[0], Graph::ZERO, Graph::ZERO], [Graph::ZERO, Graph::ZERO, back[2]]);
            return vec![Move::Shift(before), about(2, self.first), Move::Shift(after)];
        }
        vec![about(2, self.first), Move::Shift(*place)]
    }
}

/// How far along the first line the second one is nearest, if they are not parallel.
fn nearest(graph: &mut Graph, (a, h): (&Vec3, &Vec3), (b, k): (&Vec3, &Vec3)) -> Option<ExprId> {
    let normal = graph.cross(h, k);
    if normal == ZERO3 {
        return None;
    }
    let towards = graph.sub_vec(b, a);
    let turned = graph.cross(&towards, k);
    let (along, square) = (graph.dot(&turned, &normal), graph.dot(&normal, &normal));
    if !are_apart(graph, square) {
        return None;
    }
    let quotient = graph.div(along, square);
    is_exact(graph, &[along, square, quotient]).then_some(quotient)
}

/// A vector at one end of a joint as the other has it where the joint's coordinates are zero.
fn carried(graph: &mut Graph, from: &Seat, to: &Seat, v: &Vec3) -> Vec3 {
    let parts = graph.mat_vec(&from.triad, v);
    graph.transposed_vec(&to.triad, &parts)
}

/// A triad turned about its last axis.
fn about_z(graph: &mut Graph, triad: &Mat3, [sine, cosine]: [ExprId; 2]) -> Mat3 {
    let [f, g, h] = triad;
    let (a, b) = (graph.scale_vec(cosine, f), graph.scale_vec(sine, g));
    let x = graph.add_vec(&a, &b);
    [x, graph.cross(h, &x), *h]
}

fn about(axis: usize, [sine, cosine]: [ExprId; 2]) -> Move {
    Move::Turn { axis, sine, cosine }
}

/// Sine and cosine of a sum.
fn sum_of_angles(graph: &mut Graph, a: [ExprId; 2], b: [ExprId; 2]) -> [ExprId; 2] {
    let sine = graph.dot(&a, &[b[1], b[0]]);
    let minus = graph.neg(b[0]);
    [sine, graph.dot(&a, &[minus, b[1]])]
}

/// Whether the square of the sine of the angle between two axes is large enough for a common normal: those of axes that
/// are all but parallel are far away, and arms from there cancel.
fn are_apart(graph: &Graph, square: ExprId) -> bool {
    graph.as_constant(square).is_some_and(|square| square.to_f64() > ALL_BUT_PARALLEL)
}

fn is_exact(graph: &Graph, all: &[ExprId]) -> bool {
    all.iter().all(|&id| graph.as_constant(id).is_some())
}
