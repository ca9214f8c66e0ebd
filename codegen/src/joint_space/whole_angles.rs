//! Where the bodies of a tree are, by the sines and cosines of whole angles: those of joints about parallel axes add up
//! to the angle by which a body is turned.

use super::layout::{Layout, LinkCoordinates, Place};
use super::link_kinematics::{LinkKinematics, at_zero, rotated};
use crate::derive::frames::JointFrames;
use crate::derive::system::System;
use crate::expr::definitions::Values;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Mat3, UNIT3, Vec3, ZERO3, transposed};
use gyro_model::{Attachment, CoordinateKind, JointCoordinate};

/// Poses of the bodies, and the angles that they are made of.
#[derive(Debug)]
pub struct WholeAngles {
    /// (r, A) of each moving_body, in terms of joint coordinates and of the sines and cosines of angles.
    pub poses: Values,
    /// The sums of joint angles, counted on behind the coordinates and rates of the tree.
    pub sums: Vec<Sum>,
    /// How each moving_body is turned, and where its joint point is.
    pub bodies: Vec<BodyPlace>,
    /// The angles of joints that close loops, where they are sums of those of the tree.
    pub of_loops: Vec<(JointCoordinate, Sum)>,
    first: Place,
}

/// How a body is turned and carried.
#[derive(Clone, Debug)]
pub struct BodyPlace {
    /// The angle by which it is turned about a constant axis, and that axis in the body's frame and in the global one;
    /// nothing if it only slides.
    pub turn: Option<(Place, Vec3, Vec3)>,
    /// Whether it turns in no other way.
    pub is_planar: bool,
    /// The joint point in the body's frame and in the global one.
    pub joint_point: (Vec3, Vec3),
}

/// A sum of joint angles with their signs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sum(Vec<(Place, bool)>);

/// How a body is turned: `before · base · Rot(axis, angle)`, the axis in the body's frame, base and axis constant.
#[derive(Clone, Debug)]
struct Attitude {
    before: Option<Mat3>,
    base: Mat3,
    axis: Vec3,
    angle: Sum,
}

impl Sum {
    /// The angles, with whether they are subtracted.
    pub fn parts(&self) -> &[(Place, bool)] {
        &self.0
    }

    /// Of one number for each place.
    pub fn sum(&self, graph: &mut Graph, mut number: impl FnMut(&mut Graph, Place) -> ExprId) -> ExprId {
        self.0.iter().fold(Graph::ZERO, |sum, &(place, is_negative)| {
            let part = number(graph, place);
            if is_negative { graph.sub(sum, part) } else { graph.add(sum, part) }
        })
    }

    /// Sine and cosine, from those of the angles.
    pub fn sine_and_cosine(
        &self,
        graph: &mut Graph,
        of: impl Fn(Place) -> (ExprId, ExprId),
    ) -> (ExprId, ExprId) {
        self.0.iter().fold((Graph::ZERO, Graph::ONE), |(s, c), &(place, is_negative)| {
            let (sine, cosine) = of(place);
            let sine = if is_negative { graph.neg(sine) } else { sine };
            let [sc, cs, cc, ss] =
                [(s, cosine), (c, sine), (c, cosine), (s, sine)].map(|(a, b)| graph.mul(a, b));
            (graph.add(sc, cs), graph.sub(cc, ss))
        })
    }

    fn plus(&self, other: &Self, negated: bool) -> Self {
        let mut all = self.0.clone();
        for &(place, is_negative) in &other.0 {
            let is_negative = is_negative != negated;
            match all.iter().position(|(known, sign)| known.x == place.x && *sign != is_negative) {
                Some(opposite) => drop(all.remove(opposite)),
                None => all.push((place, is_negative)),
            }
        }
        all.sort_by_key(|(place, is_negative)| (place.x, *is_negative));
        Self(all)
    }

    fn starts_negative(&self) -> bool {
        self.0.first().is_some_and(|(_, is_negative)| *is_negative)
    }
}

impl WholeAngles {
    /// `is_held` says of an angle (index into x) whether it is zero.
    pub fn of(
        system: &mut System,
        layout: &Layout,
        links: &[LinkKinematics],
        is_held: impl Fn(usize) -> bool,
    ) -> Self {
        let first = Place { x: layout.n_tree_coordinates(), u: layout.n_tree_rates() };
        let mut angles = Self {
            poses: Values::default(),
            sums: Vec::new(),
            bodies: Vec::new(),
            of_loops: Vec::new(),
            first,
        };
        let mut attitudes: Vec<Option<Attitude>> = vec![None; system.moving_bodies.len()];
        // The joint point of each body, and where it is.
        let mut held: Vec<(Vec3, Vec3)> = vec![(ZERO3, ZERO3); attitudes.len()];
        for (link, kinematics) in layout.links.iter().zip(links) {
            let carrier = kinematics.parent.and_then(|body| system.moving_body_of(body));
            let (of_parent, (parent_point, parent_place)) = match (kinematics.parent, carrier) {
                (_, Some(carrier)) => {
                    (attitudes[carrier].clone().expect("parents come first"), held[carrier])
                }
                (Some(body), None) => {
                    let pose = system.poses[body];
                    (Attitude::of_carrier(&system.graph, pose.a), (ZERO3, pose.r))
                }
                (None, None) => (Attitude::of_carrier(&system.graph, UNIT3), (ZERO3, ZERO3)),
            };
            let parent_frame = angles.matrix(&mut system.graph, &of_parent);
            let own = match Turn::of(system, link, kinematics, &is_held) {
                Some(turn) => of_parent.followed(&mut system.graph, &parent_frame, turn),
                None => Attitude::any(system.graph.mat_mul(&parent_frame, &kinematics.rotation)),
            };
            let frame = angles.matrix(&mut system.graph, &own);
            let graph = &mut system.graph;
            let arm = graph.sub_vec(&kinematics.on_parent, &parent_point);
            let arm = graph.mat_vec(&parent_frame, &arm);
            let place = graph.add_vec(&parent_place, &arm);
            let own_arm = graph.mat_vec(&frame, &kinematics.on_body);
            let r = graph.sub_vec(&place, &own_arm);
            let moving_body = kinematics.moving_body;
            for k in 0..3 {
                angles.poses.insert(Symbol::Position { moving_body, k }, r[k]);
                for (column, &entry) in frame[k].iter().enumerate() {
                    angles.poses.insert(Symbol::Rotation { moving_body, row: k, column }, entry);
                }
            }
            (attitudes[moving_body], held[moving_body]) = (Some(own), (kinematics.on_body, place));
        }
        angles.close_loops(system, &attitudes);
        for (turn, on) in system.model.turn_references().into_iter().enumerate() {
            let angle = Symbol::Angle(turn);
            let counted = layout.turns.iter().any(|(counted, _)| *counted == on);
            // An angle that x counts is differentiated as one.
            let known = layout.scalar(on).map(|scalar| Symbol::Coordinate(scalar.place.x));
            if let Some(symbol) = known.or(counted.then_some(angle)) {
                angles.poses.insert(angle, system.graph.symbol(symbol));
            }
        }
        let places: Vec<_> = attitudes
            .into_iter()
            .zip(held)
            .map(|(attitude, joint_point)| {
                let attitude = attitude.expect("every body is a link");
                let turn = (!attitude.angle.0.is_empty()).then(|| {
                    let in_space = system.graph.mat_vec(&attitude.base, &attitude.axis);
                    (angles.place(&attitude.angle), attitude.axis, in_space)
                });
                BodyPlace { turn, is_planar: attitude.before.is_none(), joint_point }
            })
            .collect();
        angles.bodies = places;
        angles
    }

    /// Finds the angles of joints that close loops.
    fn close_loops(&mut self, system: &mut System, attitudes: &[Option<Attitude>]) {
        for joint in system.tree.loop_joints.clone() {
            let on = JointCoordinate { joint, coordinate: 0 };
            let frames = system.joints[joint];
            if frames.kind.coordinates().first() != Some(&CoordinateKind::Angle) {
                continue;
            }
            let attitude = |body: usize| match system.moving_body_of(body) {
                Some(moving_body) => attitudes[moving_body].clone().expect("every body is a link"),
                None => Attitude::of_carrier(&system.graph, system.poses[body].a),
            };
            let ends = [attitude(frames.first.body), attitude(frames.second.body)];
            let Some(sum) = Attitude::between(&mut system.graph, &ends, &frames) else { continue };
            if let Some(turn) = system.model.turn_references().iter().position(|&turn| turn == on) {
                let coordinate = |graph: &mut Graph, place: Place| graph.symbol(Symbol::Coordinate(place.x));
                let value = sum.sum(&mut system.graph, coordinate);
                self.poses.insert(Symbol::Angle(turn), value);
            }
            self.of_loops.push((on, sum));
        }
    }

    /// The angle of a joint that closes a loop.
    pub fn of_loop(&self, on: JointCoordinate) -> Option<&Sum> {
        self.of_loops.iter().find(|(known, _)| *known == on).map(|(_, sum)| sum)
    }

    /// The places of the sums.
    pub fn places(&self) -> impl Iterator<Item = (Place, &Sum)> {
        let place = |k: usize| Place { x: self.first.x + k, u: self.first.u + k };
        self.sums.iter().enumerate().map(move |(k, sum)| (place(k), sum))
    }

    fn place(&mut self, sum: &Sum) -> Place {
        if let [(place, false)] = sum.0[..] {
            return place;
        }
        let known = self.sums.iter().position(|known| known == sum);
        let place = known.unwrap_or_else(|| {
            self.sums.push(sum.clone());
            self.sums.len() - 1
        });
        Place { x: self.first.x + place, u: self.first.u + place }
    }

    /// The angles of joints that make up an angle, with whether they are subtracted.
    pub fn parts(&self, of: Place) -> Vec<(Place, bool)> {
        match of.u.checked_sub(self.first.u) {
            Some(sum) => self.sums[sum].0.clone(),
            None => vec![(of, false)],
        }
    }

    fn matrix(&mut self, graph: &mut Graph, attitude: &Attitude) -> Mat3 {
        let Attitude { before, base, axis, angle } = attitude;
        let turned = if angle.0.is_empty() {
            *base
        } else {
            let place = self.place(angle).x;
            let [sine, cosine] = [Symbol::Sine(place), Symbol::Cosine(place)].map(|s| graph.symbol(s));
            rotated(graph, base, axis, (sine, cosine))
        };
        before.map_or(turned, |before| graph.mat_mul(&before, &turned))
    }
}

impl Attitude {
    fn any(a: Mat3) -> Self {
        Self { before: Some(a), base: UNIT3, axis: ZERO3, angle: Sum(Vec::new()) }
    }

    /// Of a body without coordinates.
    fn of_carrier(graph: &Graph, a: Mat3) -> Self {
        let is_constant = a.iter().flatten().all(|&entry| !graph.is_changing(entry));
        if is_constant { Self { before: None, base: a, ..Self::any(a) } } else { Self::any(a) }
    }

    /// Of a body that is carried by one of this attitude, of which `frame` is the matrix.
    fn followed(&self, graph: &mut Graph, frame: &Mat3, turn: Turn) -> Self {
        let Some((axis, own)) = turn.about else {
            let axis = graph.transposed_vec(&turn.at_zero, &self.axis);
            return Self { base: graph.mat_mul(&self.base, &turn.at_zero), axis, ..self.clone() };
        };
        let carried = graph.transposed_vec(&turn.at_zero, &self.axis);
        let opposite = graph.neg_vec(&axis);
        let angle = match (self.angle.0.is_empty(), carried == axis, carried == opposite) {
            (true, ..) => own,
            (_, true, _) => own.plus(&self.angle, false),
            (_, _, true) => own.plus(&self.angle, true),
            _ => {
                return Self { before: Some(*frame), base: turn.at_zero, axis, angle: own }.normalised(graph);
            }
        };
        let base = graph.mat_mul(&self.base, &turn.at_zero);
        Self { before: self.before, base, axis, angle }.normalised(graph)
    }

    /// The angle of a joint between two bodies that turn about its axis only, and are as its zero says where their own
    /// angles are zero.
    fn between(graph: &mut Graph, [first, second]: &[Self; 2], joint: &JointFrames) -> Option<Sum> {
        let mut sign = |own: &Self, axis: &Vec3| {
            let opposite = graph.neg_vec(axis);
            match own.angle.0.is_empty() || own.axis == *axis {
                true => Some(false),
                false => (own.axis == opposite).then_some(true),
            }
        };
        let signs = [sign(first, &joint.first.h)?, sign(second, &joint.second.h)?];
        let mut in_space = |own: &Self, axes: [&Vec3; 2]| axes.map(|axis| graph.mat_vec(&own.base, axis));
        let frames = [
            in_space(first, [&joint.first.f, &joint.first.h]),
            in_space(second, [&joint.second.f, &joint.second.h]),
        ];
        let is_zero = first.before == second.before && frames[0] == frames[1];
        let none = Sum(Vec::new());
        is_zero.then(|| none.plus(&second.angle, signs[1]).plus(&first.angle, !signs[0]))
    }

    /// With an angle whose first term is positive.
    fn normalised(mut self, graph: &mut Graph) -> Self {
        if self.angle.starts_negative() {
            self.axis = graph.neg_vec(&self.axis);
            self.angle.0.iter_mut().for_each(|(_, is_negative)| *is_negative = !*is_negative);
        }
        self
    }
}

/// The rotation of a body relative to its carrier, `at_zero · Rot(axis, angle)`.
struct Turn {
    at_zero: Mat3,
    about: Option<(Vec3, Sum)>,
}

impl Turn {
    /// Of a joint with at most one angle that is not held.
    fn of(
        system: &mut System,
        link: &LinkCoordinates,
        kinematics: &LinkKinematics,
        is_held: &impl Fn(usize) -> bool,
    ) -> Option<Self> {
        let Attachment::Joint { joint, reversed, .. } = link.link.attachment else { return None };
        if link.orientation.is_some() {
            return None;
        }
        let joint = system.joints[joint];
        let angles: Vec<_> =
            link.scalars.iter().filter(|scalar| scalar.kind.is_angle() && !is_held(scalar.place.x)).collect();
        let graph = &mut system.graph;
        let angle = match angles[..] {
            // All angles, if there are any, are held.
            [] => return Some(Self { at_zero: kinematics.rotation, about: None }),
            [angle] => angle,
            _ => return None,
        };
        let at_zero = at_zero(graph, &joint);
        // Rot(h_i, θ) R = R Rot(Rᵀ h_i, θ).
        let axis = if angle.kind == CoordinateKind::FirstAngle {
            graph.transposed_vec(&at_zero, &joint.first.h)
        } else {
            joint.second.h
        };
        if reversed {
            // (R Rot(axis, θ))ᵀ = Rᵀ Rot(R axis, −θ).
            let axis = graph.mat_vec(&at_zero, &axis);
            let about = Some((axis, Sum(vec![(angle.place, true)])));
            return Some(Self { at_zero: transposed(&at_zero), about });
        }
        Some(Self { at_zero, about: Some((axis, Sum(vec![(angle.place, false)]))) })
    }
}
