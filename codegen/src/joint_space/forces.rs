//! What acts along joint coordinates.

use super::layout::Layout;
use crate::derive::forces::{self, Readings};
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use gyro_model::{Attachment, JointCoordinate};

/// Joint coordinates and rates as they are.
struct OfJoints<'a>(&'a Layout);

impl Readings for OfJoints<'_> {
    fn value(&self, system: &mut System, on: JointCoordinate) -> ExprId {
        let scalar = self.0.scalar(on).expect("joints of a tree have their coordinates");
        system.graph.symbol(Symbol::Coordinate(scalar.place.x))
    }

    fn rate(&self, system: &mut System, on: JointCoordinate) -> ExprId {
        let scalar = self.0.scalar(on).expect("joints of a tree have their coordinates");
        system.graph.symbol(Symbol::Rate(scalar.place.u))
    }
}

/// The force along each rate of the tree.
pub fn along(system: &mut System, layout: &Layout) -> Vec<ExprId> {
    let parts = forces::along_coordinates(system, &OfJoints(layout));
    summed_along(system, layout, parts)
}

fn summed_along(system: &mut System, layout: &Layout, parts: Vec<forces::Along>) -> Vec<ExprId> {
    let mut along = vec![Graph::ZERO; layout.n_tree_rates()];
    for part in parts {
        let at = layout.scalar(part.on).expect("joints of a tree have their coordinates").place.u;
        along[at] = system.graph.add(along[at], part.force);
    }
    along
}

/// The power of what acts along joint coordinates and stores no energy: force times rate, with nothing of where the
/// bodies are.
pub fn power(system: &mut System, layout: &Layout) -> ExprId {
    let mut parts = forces::along_coordinates(system, &OfJoints(layout));
    parts.retain(|part| part.potential.is_none());
    let mut along = summed_along(system, layout, parts);
    add_spherical_friction(system, layout, &mut along);
    let rates = 0..layout.n_tree_rates();
    let rates: Vec<_> = rates.map(|rate| system.graph.symbol(Symbol::Rate(rate))).collect();
    rates.iter().zip(along).fold(Graph::ZERO, |sum, (&rate, force)| {
        let power = system.graph.mul(force, rate);
        system.graph.add(sum, power)
    })
}

/// The rates of a spherical joint are the relative spin that its friction resists.
fn add_spherical_friction(system: &mut System, layout: &Layout, along: &mut [ExprId]) {
    for link in &layout.links {
        let (Attachment::Joint { joint, .. }, Some(place)) = (link.link.attachment, link.orientation) else {
            continue;
        };
        let friction = system.number(&system.model.joints[joint].friction);
        for (k, along) in along[place.u..place.u + 3].iter_mut().enumerate() {
            let rate = system.graph.symbol(Symbol::Rate(place.u + k));
            let drag = system.graph.mul(friction, rate);
            *along = system.graph.sub(*along, drag);
        }
    }
}
