//! Planar linkages: chains of revolute and prismatic joints in one plane of a body, which is at rest or moves, closed
//! by another such joint. Three of the five rows of that joint are redundant.

use crate::closing::Closing;
use crate::loops::{free_motions, places};
use crate::page::{Hold, Joint, KINDS, Kind, Page, list, printed};
use crate::vector::{Place, Vector, dot, scaled, sum};

/// A chain that is to be closed.
#[derive(Clone, Debug)]
pub struct Linkage {
    plane: Plane,
    /// Its carrier and its last body.
    ends: [usize; 2],
}

/// The normal of a plane and two directions in it, the same in the frames of all bodies.
#[derive(Clone, Copy, Debug)]
struct Plane {
    normal: Vector,
    first: Vector,
    second: Vector,
}

const fn plane(normal: Vector, first: Vector, second: Vector) -> Plane {
    Plane { normal, first, second }
}

const PLANES: [Plane; 6] = [
    plane([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]),
    plane([0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, -1.0, 0.0]),
    plane([0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]),
    plane([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]),
    plane([0.6, 0.0, 0.8], [0.8, 0.0, -0.6], [0.0, -1.0, 0.0]),
    plane([1.0, 2.0, 2.0], [2.0, 1.0, -2.0], [2.0, -2.0, 1.0]),
];

/// How the bodies hang on one another, each chain with two coordinates more than it has ways to move once it is closed.
const CHAINS: [&[&str]; 7] = [
    &["revolute", "revolute", "revolute"],
    &["revolute", "revolute", "revolute"],
    &["revolute", "revolute", "prismatic"],
    &["prismatic", "revolute", "revolute"],
    &["revolute", "prismatic", "revolute"],
    &["revolute", "revolute", "prismatic", "revolute"],
    &["revolute", "revolute", "revolute", "revolute"],
];

/// Coordinates that a closed chain takes.
const TAKEN: usize = 2;

/// How often a place for the joint that closes the chain is looked for.
const TRIES: usize = 20;

impl Plane {
    /// A point, its coordinates decimals of few digits: nothing sticks out of the plane.
    fn point(&self, [x, y]: [f64; 2]) -> Vector {
        sum(scaled(x, self.first), scaled(y, self.second)).map(|number| rounded(number, 1e9))
    }

    /// The same point's coordinates in the plane, to a few digits.
    fn coordinates(&self, point: Vector) -> [f64; 2] {
        let along = |v: Vector| dot(point, v) / dot(v, v);
        [self.first, self.second].map(|v| rounded(along(v), 1e6))
    }
}

fn rounded(number: f64, digits: f64) -> f64 {
    (number * digits).round() / digits + 0.0
}

impl Page {
    /// A chain in a plane of any body, as long as it is not closed.
    pub fn chain(&mut self) -> Linkage {
        let carrier = self.dice.below(self.bodies.len());
        let (plane, kinds) = (self.dice.pick(&PLANES), self.dice.pick(&CHAINS));
        let mut last = carrier;
        for (index, name) in kinds.iter().enumerate() {
            let kind = *KINDS.iter().find(|kind| kind.name == *name).expect("a kind of joint");
            let child = self.bodies.len();
            let solid = self.solid();
            self.bodies.push((Hold::Joint, solid));
            self.roots.push(self.roots[carrier]);
            self.held.push(self.held[carrier]);
            *self.freedoms.entry(self.roots[carrier]).or_default() += 1;
            let mut joint = self.planar_joint(&plane, kind, [last, child]);
            // What a driver or a coupler may take of them.
            if index + TAKEN >= kinds.len() {
                joint.taken.push(kind.coordinates[0]);
            }
            self.joints.push(joint);
            last = child;
        }
        Linkage { plane, ends: [carrier, last] }
    }

    fn planar_joint(&mut self, plane: &Plane, kind: Kind, [parent, child]: [usize; 2]) -> Joint {
        let frame = match kind.name {
            "revolute" => [plane.normal, plane.first],
            _ => [if self.dice.once_in(2) { plane.first } else { plane.second }, plane.normal],
        };
        let frame = frame.map(|direction| list(&printed(direction)));
        let mut text = format!("kind = {:?}\n", kind.name);
        let mut ends = [parent, child];
        if self.dice.once_in(5) {
            ends.reverse();
        }
        for (key, body) in ["first", "second"].into_iter().zip(ends) {
            let point = plane.point([self.span(), self.span()]);
            text += &format!(
                "{key} = {{ body = \"b{body}\", point = {}, axis = {}, zero = {} }}\n",
                list(&printed(point)),
                frame[0],
                frame[1]
            );
        }
        let start = format!("{:.2}", self.dice.between(-2.0, 2.0));
        let root = self.roots[parent];
        let starts = vec![(kind.coordinates[0], start)];
        Joint { kind, root, text, starts, taken: Vec::new(), following: Vec::new() }
    }

    fn span(&mut self) -> f64 {
        self.dice.pick(&[0.0, 0.2, -0.3, 0.25, 0.5, -0.45, 0.1])
    }

    /// Closes the chain where it is, unless nothing could move then.
    pub fn close_chain(&mut self, linkage: &Linkage) {
        let root = self.roots[linkage.ends[0]];
        if self.freedoms[&root] <= TAKEN {
            return;
        }
        let model = self.read();
        let (places, motions) = (places(&model), free_motions(&model));
        let closed = (0..TRIES).find_map(|_| {
            let closing = self.closing_in_plane(linkage, &places);
            closing.is_regular(&model, &places, &motions).then_some(closing)
        });
        let Some(closing) = closed else { return };
        *self.freedoms.get_mut(&root).expect("a tree that has joints") -= TAKEN;
        self.joints.push(closing.joint(root));
    }

    fn closing_in_plane(&mut self, Linkage { plane, ends }: &Linkage, places: &[Place]) -> Closing {
        let [carrier, last] = ends.map(|body| places[body]);
        let own = [self.span(), self.span()];
        let name = if self.dice.once_in(4) { "prismatic" } else { "revolute" };
        let kind = *KINDS.iter().find(|kind| kind.name == name).expect("a kind of joint");
        let second = plane.point(own);
        let first = plane.point(plane.coordinates(carrier.local(last.global(second))));
        let frames = if name == "revolute" {
            [[plane.normal, plane.first]; 2]
        } else {
            let direction = [rounded(self.dice.between(-1.0, 1.0), 1e6), 1.0];
            let global = carrier.turned(plane.point(direction));
            let of_last = plane.coordinates(last.turned_back(global));
            [[plane.point(direction), plane.normal], [plane.point(of_last), plane.normal]]
        };
        Closing::in_plane(kind, *ends, [first, second], frames)
    }
}
