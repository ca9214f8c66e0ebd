//! The tree as a sequence of turns about an axis, displacements along one, and balls: what a joint with several of them
//! has between them are bodies without mass.

use super::layout::{LinkCoordinates, Place};
use crate::derive::frames::{End, JointFrames};
use crate::derive::system::System;
use crate::expr::graph::Graph;
use crate::expr::vector::{Mat3, UNIT3, Vec3, ZERO3};
use gyro_model::{Attachment, CoordinateKind, JointKind};

/// A body, or what is between the axes of a joint, and how it moves on what carries it.
#[derive(Clone, Debug)]
pub struct Station {
    /// None of what is between the axes of a joint.
    pub moving_body: Option<usize>,
    /// The station that carries it; none is the ground.
    pub parent: Option<usize>,
    /// The body of the ground, index into the model's bodies; none is the global frame.
    pub ground: Option<usize>,
    pub on_parent: Seat,
    pub on_body: Seat,
    pub freedom: Freedom,
}

/// A joint as a body has it: at coordinates of zero the triads of both bodies are the same.
#[derive(Clone, Copy, Debug)]
pub struct Seat {
    pub point: Vec3,
    /// Its last axis is that of the joint.
    pub triad: Mat3,
}

impl Seat {
    const NONE: Self = Self { point: ZERO3, triad: UNIT3 };

    fn of(end: &End) -> Self {
        Self { point: end.point, triad: [end.f, end.g, end.h] }
    }

    /// The same with other axes last.
    fn rolled(self, by: usize) -> Self {
        let mut triad = self.triad;
        triad.rotate_left(by);
        Self { triad, ..self }
    }

    /// With its last axis backwards.
    fn reversed(self, graph: &mut Graph) -> Self {
        let [f, g, h] = self.triad;
        Self { triad: [f, graph.neg_vec(&g), graph.neg_vec(&h)], ..self }
    }
}

/// What an elementary joint leaves free.
#[derive(Clone, Copy, Debug)]
pub enum Freedom {
    /// Nothing.
    Rigid,
    /// A turn about the axis, and whether the frame turns too.
    Turn { place: Place, turns: bool },
    /// A displacement along the axis.
    Slide(Place),
    /// All turns.
    Ball(Place),
    /// All.
    Whole { position: Place, orientation: Place },
}

impl Freedom {
    /// The components of a twist that are free, three displacements before three turns, with their rates.
    pub fn components(&self) -> Vec<(usize, usize)> {
        match *self {
            Self::Rigid => Vec::new(),
            Self::Turn { place, .. } => vec![(5, place.u)],
            Self::Slide(place) => vec![(2, place.u)],
            Self::Ball(place) => (0..3).map(|k| (3 + k, place.u + k)).collect(),
            Self::Whole { position, orientation } => {
                let translations = (0..3).map(|k| (k, position.u + k));
                translations.chain((0..3).map(|k| (3 + k, orientation.u + k))).collect()
            }
        }
    }
}

/// Root first; `None` if the tree has a joint that is none of these one after the other. `turned` says of an angle
/// whether it turns the body's frame.
pub fn stations(
    system: &mut System,
    links: &[LinkCoordinates],
    turned: &dyn Fn(usize) -> bool,
) -> Option<Vec<Station>> {
    let mut stations: Vec<Station> = Vec::new();
    for link in links {
        let moving_body = system.moving_body_of(link.link.body);
        let whole = |freedom| Station {
            moving_body,
            parent: None,
            ground: None,
            on_parent: Seat::NONE,
            on_body: Seat::NONE,
            freedom,
        };
        let (parent, elements) = match link.link.attachment {
            Attachment::Free => {
                let (position, orientation) = (link.position?, link.orientation?);
                stations.push(whole(Freedom::Whole { position, orientation }));
                continue;
            }
            Attachment::Constrained => return None,
            Attachment::Joint { joint, parent, reversed } => {
                (parent, elements(system, link, joint, reversed, turned)?)
            }
        };
        let of_parent = system.moving_body_of(parent);
        let mut at =
            stations.iter().position(|station| of_parent.is_some() && station.moving_body == of_parent);
        if of_parent.is_some() && at.is_none() {
            return None;
        }
        let last = elements.len() - 1;
        for (place, (freedom, on_parent, on_body)) in elements.into_iter().enumerate() {
            let moving_body = moving_body.filter(|_| place == last);
            let ground = if at.is_none() { Some(parent) } else { None };
            stations.push(Station { moving_body, parent: at, ground, on_parent, on_body, freedom });
            at = Some(stations.len() - 1);
        }
    }
    Some(stations)
}

type Element = (Freedom, Seat, Seat);

/// From the parent to the body.
fn elements(
    system: &mut System,
    link: &LinkCoordinates,
    joint: usize,
    reversed: bool,
    turned: &dyn Fn(usize) -> bool,
) -> Option<Vec<Element>> {
    let frames = system.joints[joint];
    let from_first = from_first(&mut system.graph, link, &frames, turned)?;
    if !reversed {
        return Some(from_first);
    }
    if link.orientation.is_some() {
        return None;
    }
    let graph = &mut system.graph;
    let backwards = from_first
        .into_iter()
        .rev()
        .map(|(freedom, on_first, on_second)| (freedom, on_second.reversed(graph), on_first.reversed(graph)));
    Some(backwards.collect())
}

/// From the first body to the second.
fn from_first(
    graph: &mut Graph,
    link: &LinkCoordinates,
    joint: &JointFrames,
    turned: &dyn Fn(usize) -> bool,
) -> Option<Vec<Element>> {
    let place = |kind| link.scalars.iter().find(|scalar| scalar.kind == kind).map(|scalar| scalar.place);
    let turn = |place: Place| Freedom::Turn { place, turns: turned(place.x) };
    let (first, second) = (Seat::of(&joint.first), Seat::of(&joint.second));
    let between = Seat::NONE;
    let elements = match joint.kind {
        JointKind::Fixed => vec![(Freedom::Rigid, first, second)],
        JointKind::Revolute => vec![(turn(place(CoordinateKind::Angle)?), first, second)],
        JointKind::Prismatic => vec![(Freedom::Slide(place(CoordinateKind::Displacement)?), first, second)],
        JointKind::Cylindrical => vec![
            (Freedom::Slide(place(CoordinateKind::Displacement)?), first, between),
            (turn(place(CoordinateKind::Angle)?), between, second),
        ],
        JointKind::Planar => vec![
            (Freedom::Slide(place(CoordinateKind::X)?), first.rolled(1), between.rolled(1)),
            (Freedom::Slide(place(CoordinateKind::Y)?), between.rolled(2), between.rolled(2)),
            (turn(place(CoordinateKind::Angle)?), between, second),
        ],
        JointKind::Universal => {
            // The first angle is from f_i to h_j, the second from h_i to f_j.
            let [x, y, z] = UNIT3;
            let crossed = Seat { triad: [z, graph.neg_vec(&y), x], ..between };
            vec![
                (turn(place(CoordinateKind::FirstAngle)?), first, between),
                (turn(place(CoordinateKind::SecondAngle)?), crossed, second),
            ]
        }
        JointKind::Spherical => {
            let [first, second] = [first, second].map(|seat| Seat { triad: UNIT3, ..seat });
            vec![(Freedom::Ball(link.orientation?), first, second)]
        }
        JointKind::PointOnLine => {
            let centre = Seat { triad: first.triad, ..between };
            let second = Seat { triad: UNIT3, ..second };
            vec![
                (Freedom::Slide(place(CoordinateKind::Displacement)?), first, centre),
                (Freedom::Ball(link.orientation?), between, second),
            ]
        }
        JointKind::Screw | JointKind::Rod => return None,
    };
    Some(elements)
}
