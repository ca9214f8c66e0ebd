//! The attraction of a central body: see [`gyro_model::Attraction`].

use crate::derive::points::PointOfBody;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::vector::{Vec3, ZERO3};
use gyro_model::Number;

/// The field of the central body at a point.
pub struct Field {
    /// The acceleration of what is there and falls.
    pub acceleration: Vec3,
    /// `−μ/|r|`: the energy of a unit mass.
    pub potential: ExprId,
}

impl Field {
    /// None where gravity is the same everywhere.
    pub fn at(system: &mut System, point: &Vec3) -> Option<Self> {
        let attraction = system.model.attraction.as_ref()?;
        let (mu, centre) = (system.number(&attraction.mu), system.numbers(&attraction.centre));
        let graph = &mut system.graph;
        let from_centre = graph.sub_vec(point, &centre);
        let square = graph.dot(&from_centre, &from_centre);
        let distance = graph.sqrt(square);
        let inverse = graph.recip(distance);
        let depth = graph.mul(mu, inverse);
        let inverse_square = graph.mul(inverse, inverse);
        let by_distance = graph.mul(depth, inverse_square);
        let pull = graph.scale_vec(by_distance, &from_centre);
        Some(Self { acceleration: graph.neg_vec(&pull), potential: graph.neg(depth) })
    }
}

/// The acceleration of gravity, of either kind, at a point of a body.
pub fn gravity_at(system: &mut System, body: usize, point: &[Number; 3]) -> Vec3 {
    if system.model.attraction.is_none() {
        return system.numbers(&system.model.gravity);
    }
    let place = PointOfBody::new(system, body, point).position;
    Field::at(system, &place).map_or(ZERO3, |field| field.acceleration)
}

/// `−Σ m μ/|r|` of all bodies with coordinates; zero where gravity is the same everywhere.
pub fn potential(system: &mut System) -> ExprId {
    let mut sum = Graph::ZERO;
    for moving_body in 0..system.moving_bodies.len() {
        let r = system.poses[system.moving_bodies[moving_body]].r;
        let Some(field) = Field::at(system, &r) else { continue };
        let mass = system.mass(moving_body);
        let energy = system.graph.mul(mass, field.potential);
        sum = system.graph.add(sum, energy);
    }
    sum
}
