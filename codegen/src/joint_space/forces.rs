//! What acts along joint coordinates.

use super::layout::{Layout, Place};
use super::whole_angles::WholeAngles;
use crate::derive::forces;
use crate::derive::joint_coordinate::{self, Load};
use crate::derive::laws::Readings;
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use gyro_model::{Attachment, JointCoordinate, JointKind};

/// Joint coordinates and rates as they are; those of joints that close loops in terms of angles of the tree, or else of
/// maximal coordinates.
pub struct OfJoints<'a> {
    pub layout: &'a Layout,
    pub angles: &'a WholeAngles,
}

impl OfJoints<'_> {
    fn summed_along(&self, system: &mut System, parts: &[forces::Along]) -> Vec<ExprId> {
        let mut along = vec![Graph::ZERO; self.layout.n_tree_rates()];
        for part in parts {
            for (place, is_negative) in self.parts(part.on).into_iter().flatten() {
                let (graph, sum) = (&mut system.graph, &mut along[place.u]);
                *sum = if is_negative { graph.sub(*sum, part.force) } else { graph.add(*sum, part.force) };
            }
        }
        along
    }

    /// The rates along which a force on a coordinate acts, with whether it does so backwards; `None` if it acts on the
    /// bodies.
    pub fn parts(&self, on: JointCoordinate) -> Option<Vec<(Place, bool)>> {
        match self.layout.scalar(on) {
            Some(scalar) => Some(vec![(scalar.place, false)]),
            None => self.angles.of_loop(on).map(|sum| sum.parts().to_vec()),
        }
    }
}

impl Readings for OfJoints<'_> {
    fn value(&self, system: &mut System, on: JointCoordinate) -> ExprId {
        match self.layout.scalar(on) {
            Some(scalar) => system.graph.symbol(Symbol::Coordinate(scalar.place.x)),
            None => joint_coordinate::value(system, on),
        }
    }

    fn rate(&self, system: &mut System, on: JointCoordinate) -> ExprId {
        let Some(parts) = self.parts(on) else { return joint_coordinate::rate(system, on) };
        let graph = &mut system.graph;
        parts.into_iter().fold(Graph::ZERO, |sum, (place, is_negative)| {
            let rate = graph.symbol(Symbol::Rate(place.u));
            if is_negative { graph.sub(sum, rate) } else { graph.add(sum, rate) }
        })
    }
}

/// The force along each rate of the tree.
pub fn along(system: &mut System, layout: &Layout, angles: &WholeAngles) -> Vec<ExprId> {
    let of_joints = OfJoints { layout, angles };
    let parts = forces::along_coordinates(system, &of_joints);
    of_joints.summed_along(system, &parts)
}

/// The armature along each rate of the tree.
pub fn armature(system: &mut System, layout: &Layout) -> Vec<ExprId> {
    let mut all = vec![Graph::ZERO; layout.n_tree_rates()];
    for scalar in layout.links.iter().flat_map(|link| &link.scalars) {
        all[scalar.place.u] = system.number(&system.model.joints[scalar.coordinate.joint].armature);
    }
    all
}

/// The loads on each body: these, and what acts along coordinates that are no sums of those of the tree.
pub fn loads(system: &mut System, (layout, angles): (&Layout, &WholeAngles), others: &[Load]) -> Vec<Load> {
    let of_joints = OfJoints { layout, angles };
    let mut loads = others.to_vec();
    for part in forces::along_coordinates(system, &of_joints) {
        if of_joints.parts(part.on).is_some() {
            continue;
        }
        let joint = system.joints[part.on.joint];
        let units = joint_coordinate::unit_loads(system, part.on);
        for (body, unit) in [joint.first.body, joint.second.body].into_iter().zip(units) {
            let load = unit.scaled(&mut system.graph, part.force);
            loads[body] = loads[body].plus(&mut system.graph, &load);
        }
    }
    loads
}

/// The power of what acts along joint coordinates and stores no energy: force times rate, of the tree's with nothing of
/// where the bodies are.
pub fn power(system: &mut System, layout: &Layout, angles: &WholeAngles) -> ExprId {
    let of_joints = OfJoints { layout, angles };
    let mut parts = forces::along_coordinates(system, &of_joints);
    parts.retain(|part| part.potential.is_none());
    let mut along = of_joints.summed_along(system, &parts);
    add_spherical_damping(system, layout, &mut along);
    let rates: Vec<_> = (0..along.len()).map(|rate| system.graph.symbol(Symbol::Rate(rate))).collect();
    let mut power = system.graph.dot_slices(&along, &rates);
    for part in parts.iter().filter(|part| of_joints.parts(part.on).is_none()) {
        let rate = joint_coordinate::rate(system, part.on);
        let done = system.graph.mul(part.force, rate);
        power = system.graph.add(power, done);
    }
    for joint in system.tree.loop_joints.clone() {
        let frames = system.joints[joint];
        if frames.kind == JointKind::Spherical {
            let damping = system.number(&system.model.joints[joint].damping);
            let spin = joint_coordinate::relative_spin(system, &frames);
            let square = system.graph.dot(&spin, &spin);
            let lost = system.graph.mul(damping, square);
            power = system.graph.sub(power, lost);
        }
    }
    power
}

/// The rates of a spherical joint are the relative spin that its damping resists.
fn add_spherical_damping(system: &mut System, layout: &Layout, along: &mut [ExprId]) {
    for link in &layout.links {
        let (Attachment::Joint { joint, .. }, Some(place)) = (link.link.attachment, link.orientation) else {
            continue;
        };
        let damping = system.number(&system.model.joints[joint].damping);
        for (k, along) in along[place.u..place.u + 3].iter_mut().enumerate() {
            let rate = system.graph.symbol(Symbol::Rate(place.u + k));
            let drag = system.graph.mul(damping, rate);
            *along = system.graph.sub(*along, drag);
        }
    }
}
