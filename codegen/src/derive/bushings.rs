//! Bushings: see [`gyro_model::Bushing`].

use crate::derive::between::Between;
use crate::derive::joint_coordinate::Load;
use crate::derive::laws::{Own, own_strength};
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use gyro_model::{Bushing, ForceKind};

/// What a bushing does.
pub struct Held {
    /// On the first and on the second body.
    pub loads: [Load; 2],
    /// Readings.
    places: [ExprId; 6],
    /// Along each of them.
    forces: [ExprId; 6],
    /// Energy of the springs.
    pub stored: ExprId,
    /// Power of all else.
    pub power: ExprId,
}

impl Held {
    pub fn of(system: &mut System, bushing: &Bushing) -> Self {
        let between = Between::new(system, bushing);
        let (mut forces, mut stored, mut power) = ([Graph::ZERO; 6], Graph::ZERO, Graph::ZERO);
        for (k, [stiffness, damping, load]) in bushing.strengths().into_iter().enumerate() {
            let (place, rate) = (between.places[k], between.rates[k]);
            let stiffness = system.number(stiffness);
            let [damping, load] = [damping, load]
                .map(|number| own_strength(system, Own::Frames([&between.places, &between.rates]), number));
            let graph = &mut system.graph;
            let (pull, drag, half) =
                (graph.mul(stiffness, place), graph.mul(damping, rate), graph.fraction(1, 2));
            let (double, working) = (graph.mul(pull, place), graph.sub(load, drag));
            let (energy, done) = (graph.mul(half, double), graph.mul(working, rate));
            forces[k] = graph.sub(working, pull);
            stored = graph.add(stored, energy);
            power = graph.add(power, done);
        }
        let own = Own::Frames([&between.places, &between.rates]);
        let moment = bushing.moment.each_ref().map(|number| own_strength(system, own, number));
        let turned = system.graph.dot(&moment, &between.seen.spin);
        power = system.graph.add(power, turned);
        let loads = between.loads(system, bushing, (&forces, moment));
        Self { loads, places: between.places, forces, stored, power }
    }
}

/// Readings and forces of a bushing.
pub fn told(system: &mut System, force: usize) -> Vec<ExprId> {
    let ForceKind::Bushing(bushing) = &system.model.forces[force].kind else {
        unreachable!("the output is one of a bushing")
    };
    let Held { places, forces, .. } = Held::of(system, bushing);
    places.into_iter().chain(forces).collect()
}
