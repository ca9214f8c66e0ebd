//! How a body moves relative to what carries it, in joint coordinates and the body's own frame.

use super::layout::LinkCoordinates;
use crate::derive::frames::JointFrames;
use crate::derive::joint_coordinate;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Mat3, UNIT3, Vec3, ZERO3, transposed};
use gyro_model::{Attachment, CoordinateKind, JointKind};
use std::array::from_fn;

/// A link of the tree.
#[derive(Clone, Debug)]
pub struct LinkKinematics {
    pub moving_body: usize,
    /// The carrier, index into the model's bodies; none is the global frame.
    pub parent: Option<usize>,
    /// `A_parentᵀ A_body`.
    pub rotation: Mat3,
    /// The joint point in the frame of the parent and of the body.
    pub on_parent: Vec3,
    pub on_body: Vec3,
    /// One for each rate.
    pub free: Vec<Free>,
    /// Whether the sliding directions are those of the parent (else of the body).
    slides_on_parent: bool,
    /// For each rate the displacement that goes with it, in the frame of the body that the joint slides on.
    sliding: Vec<Vec3>,
}

/// A twist that the joint leaves free, with its rate.
#[derive(Clone, Copy, Debug)]
pub struct Free {
    /// Body frame, at the joint point.
    pub twist: SpatialVector,
    /// Index into u.
    pub rate: usize,
    /// Whether its rotation is about an axis of the parent.
    about_axis_of_parent: bool,
}

/// Whether an angle turns the frame in which a body is described: see [`super::invariant`].
pub type Turned<'a> = &'a dyn Fn(usize) -> bool;

impl LinkKinematics {
    /// `turned` says of an angle (index into x) whether it turns the body's frame.
    pub fn of(system: &mut System, coordinates: &LinkCoordinates, turned: Turned) -> Self {
        let moving_body = system.moving_body_of(coordinates.link.body).expect("links have coordinates");
        match coordinates.link.attachment {
            Attachment::Joint { joint, parent, reversed } => {
                let frames = system.joints[joint];
                Self::on_joint(system, coordinates, (moving_body, parent), &frames, reversed, turned)
            }
            Attachment::Constrained => {
                let given = system.fixed_pose(coordinates.link.body);
                Self::in_space(moving_body, given.a, given.r)
            }
            Attachment::Free => Self::free(system, coordinates, moving_body),
        }
    }

    fn in_space(moving_body: usize, rotation: Mat3, on_parent: Vec3) -> Self {
        let (parent, on_body, free, sliding) = (None, ZERO3, Vec::new(), Vec::new());
        Self { moving_body, parent, rotation, on_parent, on_body, free, slides_on_parent: true, sliding }
    }

    fn free(system: &mut System, coordinates: &LinkCoordinates, moving_body: usize) -> Self {
        let (Some(position), Some(orientation)) = (coordinates.position, coordinates.orientation) else {
            unreachable!("a free body has all coordinates")
        };
        let graph = &mut system.graph;
        let r = from_fn(|k| graph.symbol(Symbol::Coordinate(position.x + k)));
        let p = from_fn(|k| graph.symbol(Symbol::Unit(orientation.x + k)));
        let rotation = graph.rotation(&p);
        let translations = (0..3).map(|k| Free {
            twist: SpatialVector { t: rotation[k], rho: ZERO3 },
            rate: position.u + k,
            about_axis_of_parent: false,
        });
        let rotations = (0..3).map(|k| Free {
            twist: SpatialVector { t: ZERO3, rho: UNIT3[k] },
            rate: orientation.u + k,
            about_axis_of_parent: false,
        });
        let (free, sliding) = (translations.chain(rotations).collect(), [UNIT3, [ZERO3; 3]].concat());
        Self { free, sliding, ..Self::in_space(moving_body, rotation, r) }
    }

    fn on_joint(
        system: &mut System,
        coordinates: &LinkCoordinates,
        (moving_body, parent): (usize, usize),
        joint: &JointFrames,
        reversed: bool,
        turned: Turned,
    ) -> Self {
        let relative = relative_rotation(system, coordinates, joint, turned);
        let rotation = if reversed { transposed(&relative) } else { relative };
        let mut link_kinematics = Self {
            moving_body,
            parent: Some(parent),
            rotation,
            on_parent: if reversed { joint.second.point } else { joint.first.point },
            on_body: if reversed { joint.first.point } else { joint.second.point },
            free: Vec::new(),
            slides_on_parent: !reversed,
            sliding: Vec::new(),
        };
        for scalar in &coordinates.scalars {
            link_kinematics.add_scalar(&mut system.graph, joint, reversed, scalar.kind, scalar.place.u);
            link_kinematics.slide(system, joint, reversed, scalar.kind, scalar.place.x);
        }
        if let Some(place) = coordinates.orientation {
            for (k, &axis) in UNIT3.iter().enumerate() {
                link_kinematics.add(&mut system.graph, ZERO3, Turn::AboutSecond(axis), reversed, place.u + k);
            }
        }
        link_kinematics
    }

    fn add_scalar(
        &mut self,
        graph: &mut Graph,
        joint: &JointFrames,
        reversed: bool,
        kind: CoordinateKind,
        rate: usize,
    ) {
        match kind {
            CoordinateKind::FirstAngle => {
                self.add(graph, ZERO3, Turn::AboutFirst(joint.first.h), reversed, rate);
            }
            CoordinateKind::Angle | CoordinateKind::SecondAngle => {
                let advance = graph.scale_vec(joint.lead, &joint.first.h);
                let advance = if joint.kind == JointKind::Screw { advance } else { ZERO3 };
                self.add(graph, advance, Turn::AboutSecond(joint.second.h), reversed, rate);
            }
            kind => self.add(graph, joint_coordinate::direction(kind, joint), Turn::None, reversed, rate),
        }
    }

    /// Adds a free twist: a displacement in the first body's frame, a rotation of the second body relative to the
    /// first.
    fn add(&mut self, graph: &mut Graph, sliding: Vec3, turn: Turn, reversed: bool, rate: usize) {
        let (rho, about_first) = match turn {
            Turn::None => (ZERO3, false),
            Turn::AboutFirst(axis) => (axis, true),
            Turn::AboutSecond(axis) => (axis, false),
        };
        let turns = !matches!(turn, Turn::None);
        let about_axis_of_parent = turns && about_first != reversed;
        let rho = if about_axis_of_parent { graph.transposed_vec(&self.rotation, &rho) } else { rho };
        let t = if reversed { sliding } else { graph.transposed_vec(&self.rotation, &sliding) };
        let twist = SpatialVector { t, rho };
        let twist = if reversed { twist.negated(graph) } else { twist };
        self.free.push(Free { twist, rate, about_axis_of_parent });
        self.sliding.push(sliding);
    }

    /// Moves the joint point on the first body to where the second body's is.
    fn slide(
        &mut self,
        system: &mut System,
        joint: &JointFrames,
        reversed: bool,
        kind: CoordinateKind,
        x: usize,
    ) {
        let graph = &mut system.graph;
        let x = graph.symbol(Symbol::Coordinate(x));
        let direction = match (kind.is_angle(), joint.kind) {
            (true, JointKind::Screw) => graph.scale_vec(joint.lead, &joint.first.h),
            (true, _) => return,
            (false, _) => joint_coordinate::direction(kind, joint),
        };
        let displacement = graph.scale_vec(x, &direction);
        let point = if reversed { &mut self.on_body } else { &mut self.on_parent };
        *point = graph.add_vec(point, &displacement);
    }

    /// The angular velocity relative to the parent, in the body's frame.
    pub fn relative_spin(&self, graph: &mut Graph) -> Vec3 {
        self.free.iter().fold(ZERO3, |sum, free| {
            let rate = graph.symbol(Symbol::Rate(free.rate));
            let part = graph.scale_vec(rate, &free.twist.rho);
            graph.add_vec(&sum, &part)
        })
    }

    /// The angular velocity, in the body's frame.
    pub fn spin(&self, graph: &mut Graph, of_parent: &Vec3) -> Vec3 {
        let (carried, own) = (graph.transposed_vec(&self.rotation, of_parent), self.relative_spin(graph));
        graph.add_vec(&carried, &own)
    }

    /// What is left of the body's acceleration at the joint point, relative to the parent's, if all rates are constant.
    pub fn bias(&self, graph: &mut Graph, of_parent: &Vec3, own: &Vec3) -> Bias {
        let relative = self.relative_spin(graph);
        let mut rho = graph.cross(own, &relative);
        for free in self.free.iter().filter(|free| free.about_axis_of_parent) {
            // An axis of the parent turns backwards as the body sees it.
            let rate = graph.symbol(Symbol::Rate(free.rate));
            let change = graph.cross(&free.twist.rho, &relative);
            let change = graph.scale_vec(rate, &change);
            rho = graph.add_vec(&rho, &change);
        }
        let speed = self.sliding_speed(graph);
        let (of_slider, sign) = if self.slides_on_parent { (of_parent, 2) } else { (own, -2) };
        let (turned, twice) = (graph.cross(of_slider, &speed), graph.integer(sign));
        let coriolis = graph.scale_vec(twice, &turned);
        let on_parent = graph.centripetal(of_parent, &self.on_parent);
        let on_body = graph.centripetal(own, &self.on_body);
        let on_body = graph.neg_vec(&on_body);
        if self.slides_on_parent {
            Bias { on_parent: graph.add_vec(&on_parent, &coriolis), on_body, rho }
        } else {
            Bias { on_parent, on_body: graph.add_vec(&on_body, &coriolis), rho }
        }
    }

    /// Of the second joint point, in the frame of the body that the joint slides on.
    fn sliding_speed(&self, graph: &mut Graph) -> Vec3 {
        self.free.iter().zip(&self.sliding).fold(ZERO3, |sum, (free, direction)| {
            let rate = graph.symbol(Symbol::Rate(free.rate));
            let part = graph.scale_vec(rate, direction);
            graph.add_vec(&sum, &part)
        })
    }

    /// The velocity of the joint point that the sliding of the joint adds.
    pub fn sliding_velocity(&self, graph: &mut Graph) -> Slide {
        let speed = self.sliding_speed(graph);
        if self.slides_on_parent {
            Slide { on_parent: speed, on_body: ZERO3 }
        } else {
            Slide { on_parent: ZERO3, on_body: graph.neg_vec(&speed) }
        }
    }
}

/// A velocity, part of it in the parent's frame and part in the body's.
#[derive(Clone, Copy, Debug)]
pub struct Slide {
    pub on_parent: Vec3,
    pub on_body: Vec3,
}

/// Products of velocities in an acceleration.
#[derive(Clone, Copy, Debug)]
pub struct Bias {
    /// Of the joint point, in the parent's frame and, to be added, in the body's.
    pub on_parent: Vec3,
    pub on_body: Vec3,
    /// Angular, in the body's frame.
    pub rho: Vec3,
}

impl Bias {
    pub const NONE: Self = Self { on_parent: ZERO3, on_body: ZERO3, rho: ZERO3 };
}

/// A rotation of the second body relative to the first, about an axis of one of them.
#[derive(Clone, Copy)]
enum Turn {
    None,
    AboutFirst(Vec3),
    AboutSecond(Vec3),
}

/// `A_iᵀ A_j` in joint coordinates.
fn relative_rotation(
    system: &mut System,
    coordinates: &LinkCoordinates,
    joint: &JointFrames,
    turned: Turned,
) -> Mat3 {
    if let Some(place) = coordinates.orientation {
        let p = from_fn(|k| system.graph.symbol(Symbol::Unit(place.x + k)));
        return system.graph.rotation(&p);
    }
    let mut rotation = at_zero(&mut system.graph, joint);
    let graph = &mut system.graph;
    for scalar in coordinates.scalars.iter().filter(|scalar| scalar.kind.is_angle()) {
        let x = scalar.place.x;
        let (sine, cosine) = if turned(x) {
            (graph.symbol(Symbol::Sine(x)), graph.symbol(Symbol::Cosine(x)))
        } else {
            (Graph::ZERO, Graph::ONE)
        };
        rotation = if scalar.kind == CoordinateKind::FirstAngle {
            // Rot(θ) R = (Rᵀ Rot(−θ))ᵀ.
            let back = graph.neg(sine);
            let from_left = rotated(graph, &transposed(&rotation), &joint.first.h, (back, cosine));
            transposed(&from_left)
        } else {
            rotated(graph, &rotation, &joint.second.h, (sine, cosine))
        };
    }
    rotation
}

/// `A_iᵀ A_j` where all angles are zero.
pub fn at_zero(graph: &mut Graph, joint: &JointFrames) -> Mat3 {
    let (i, j) = (&joint.first, &joint.second);
    let pairs = if joint.kind == JointKind::Universal {
        // The first angle is from f_i to h_j, the second from h_i to f_j.
        [(i.f, j.h), (graph.neg_vec(&i.g), j.g), (i.h, j.f)]
    } else {
        [(i.f, j.f), (i.g, j.g), (i.h, j.h)]
    };
    let columns = |pick: fn(&(Vec3, Vec3)) -> Vec3| pairs.each_ref().map(pick);
    let (first, second) = (columns(|pair| pair.0), columns(|pair| pair.1));
    from_fn(|row| {
        from_fn(|column| {
            let (a, b) = (first.map(|u| u[row]), second.map(|u| u[column]));
            graph.dot(&a, &b)
        })
    })
}

/// `R (h hᵀ + cos (I − h hᵀ) + sin h̃)` (Rodrigues), R constant.
pub fn rotated(graph: &mut Graph, r: &Mat3, h: &Vec3, (sine, cosine): (ExprId, ExprId)) -> Mat3 {
    let along = graph.mat_vec(r, h);
    let tilde = graph.tilde(h);
    let skew = graph.mat_mul(r, &tilde);
    from_fn(|row| {
        from_fn(|column| {
            let dyad = graph.mul(along[row], h[column]);
            let across = graph.sub(r[row][column], dyad);
            let (turning, skew) = (graph.mul(cosine, across), graph.mul(sine, skew[row][column]));
            let even = graph.add(dyad, turning);
            graph.add(even, skew)
        })
    })
}
