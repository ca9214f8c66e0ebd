//! A joint that closes a loop where the bodies already are.

use crate::page::{Joint, Kind, list, printed};
use crate::vector::{Place, Vector, cross, difference, dot, scaled, sum};
use gyro_model::{Model, Support};
use nalgebra::DMatrix;

/// The least singular value of what a joint's rows are of the free motions that counts as regular; its rows are about
/// one.
pub const REGULAR: f64 = 0.02;

/// Two points that are farther apart than this are different, m.
const APART: f64 = 0.2;

/// A small motion, by which rows are differentiated.
const SMALL: f64 = 1e-6;

/// A joint with its ends.
#[derive(Clone, Debug)]
pub struct Closing {
    pub kind: Kind,
    length: f64,
    pub ends: [End; 2],
}

#[derive(Clone, Copy, Debug)]
pub struct End {
    pub body: usize,
    point: Vector,
    /// Axis and zero direction, where this end has them.
    frame: Option<[Vector; 2]>,
}

impl Closing {
    /// A joint at a point of the first body, with this axis and zero direction there; none if these make no frame. Only
    /// of a rod is the other body's point chosen too.
    pub fn between(
        kind: Kind,
        [a, b]: [usize; 2],
        places: &[Place],
        [first, second]: [Vector; 2],
        [axis, zero]: [Vector; 2],
    ) -> Option<Self> {
        let (from, to) = (places[a].global(first), places[b].global(second));
        let apart = difference(to, from);
        let length = dot(apart, apart).sqrt();
        let normal = cross(axis, zero);
        let is_frame =
            dot(normal, normal) > 0.05 * dot(axis, axis) * dot(zero, zero) && dot(axis, axis) > 0.04;
        let [h, f, g] = [axis, zero, normal].map(|v| places[a].turned(v));
        let line = scaled(1.0 / dot(h, h).sqrt(), h);
        let back = |v: Vector| places[b].turned_back(v);
        let (own, at) = (Some([axis, zero]), |point: Vector| places[b].local(point));
        let [first_frame, point, frame] = match kind.name {
            "rod" | "spherical" => {
                let point = if kind.name == "rod" { second } else { at(from) };
                return (kind.name != "rod" || length > APART)
                    .then(|| Self::new(kind, length, [(a, first, None), (b, point, None)]));
            }
            _ if !is_frame => return None,
            "point_on_line" => {
                return Some(Self::new(
                    kind,
                    length,
                    [(a, first, own), (b, at(sum(from, scaled(0.3, line))), None)],
                ));
            }
            // Its points coincide, its axes are at right angles.
            "universal" => [own, Some([at(from), [0.0; 3]]), Some([back(g), back(h)])],
            // Planar: the second point is somewhere in the plane.
            _ => [own, Some([at(sum(from, scaled(0.5, g))), [0.0; 3]]), Some([back(h), back(f)])],
        };
        let point = point.map_or(second, |[point, _]| point);
        Some(Self::new(kind, length, [(a, first, first_frame), (b, point, frame)]))
    }

    /// A revolute or prismatic joint between bodies that move in one plane, where its other rows hold already.
    pub fn in_plane(kind: Kind, [a, b]: [usize; 2], points: [Vector; 2], frames: [[Vector; 2]; 2]) -> Self {
        Self::new(kind, 0.0, [(a, points[0], Some(frames[0])), (b, points[1], Some(frames[1]))])
    }

    fn new(kind: Kind, length: f64, ends: [(usize, Vector, Option<[Vector; 2]>); 2]) -> Self {
        Self { kind, length, ends: ends.map(|(body, point, frame)| End { body, point, frame }) }
    }

    /// The joint for the model file, the bodies being where they are.
    pub fn joint(&self, root: usize) -> Joint {
        let mut text = format!("kind = {:?}\n", self.kind.name);
        if self.kind.name == "rod" {
            text += &format!("length = {:?}\n", self.length);
        }
        for (key, End { body, point, frame }) in ["first", "second"].into_iter().zip(self.ends) {
            let frame = frame.map(|frame| frame.map(|direction| list(&printed(direction))));
            let frame = frame.map_or(String::new(), |[axis, zero]| format!(", axis = {axis}, zero = {zero}"));
            text += &format!("{key} = {{ body = \"b{body}\", point = {}{frame} }}\n", list(&printed(point)));
        }
        Joint { kind: self.kind, root, text, starts: Vec::new(), taken: Vec::new(), following: Vec::new() }
    }

    /// What the joint holds at zero, or at its length; of joints in a plane what they hold there.
    fn rows(&self, places: &[Place]) -> Vec<f64> {
        let [a, b] = self.ends;
        let (first, second) = (places[a.body], places[b.body]);
        let apart = difference(second.global(b.point), first.global(a.point));
        let direction = |place: Place, v: Vector| scaled(1.0 / dot(v, v).sqrt(), place.turned(v));
        let axis = |end: End, place: Place| end.frame.map(|[axis, _]| direction(place, axis));
        let across = |end: End, place: Place| {
            end.frame.map(|[axis, zero]| {
                let g = cross(axis, zero);
                [direction(place, g), direction(place, cross(g, axis))]
            })
        };
        let own_across = across(a, first).unwrap_or_default();
        match (self.kind.name, axis(a, first), axis(b, second)) {
            ("rod", ..) => vec![dot(apart, apart).sqrt()],
            ("point_on_line" | "revolute", ..) => own_across.map(|v| dot(v, apart)).to_vec(),
            ("prismatic", _, Some(other)) => vec![dot(own_across[0], apart), dot(own_across[0], other)],
            ("universal", Some(h), Some(other)) => [&apart[..], &[dot(h, other)]].concat(),
            ("planar", Some(h), Some(other)) => {
                let tilts = own_across.map(|v| dot(v, other));
                [&tilts[..], &[dot(h, apart)]].concat()
            }
            _ => apart.to_vec(),
        }
    }

    /// Whether none of the joint's rows is a consequence of others: their derivatives along free motions are
    /// independent.
    pub fn is_regular(&self, model: &Model, places: &[Place], motions: &[Vec<f64>]) -> bool {
        let rows = self.rows(places);
        let rates: Vec<f64> = motions
            .iter()
            .flat_map(|motion| {
                let moved = self.rows(&moved(model, places, motion));
                moved.into_iter().zip(&rows).map(|(moved, row)| (moved - row) / SMALL).collect::<Vec<_>>()
            })
            .collect();
        let rates = DMatrix::from_vec(rows.len(), motions.len(), rates);
        rows.len() <= motions.len() && rates.singular_values().iter().all(|&value| value > REGULAR)
    }
}

/// The places a small time later.
fn moved(model: &Model, places: &[Place], motion: &[f64]) -> Vec<Place> {
    let mut motions = motion.chunks_exact(6);
    let bodies = model.bodies.iter().zip(places);
    let later = bodies.map(|(body, place)| match body.support {
        Support::Fixed | Support::Driven => *place,
        _ => place.moved(motions.next().expect("six numbers a body"), SMALL),
    });
    later.collect()
}
