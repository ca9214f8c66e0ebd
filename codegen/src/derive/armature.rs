//! Armatures: inertias that turn, or slide, with a joint's coordinate alone, as rotors behind gears do. The gyroscopic
//! effect of such a rotor is neglected, so what it takes is a force along the coordinate.
//!
//! Off the constraints, too, what it does to the two bodies is equal and opposite: the rate is that of the second body
//! relative to the first, of an angle about the second body's axis.

use crate::derive::joint_coordinate::{self, Load};
use crate::derive::system::System;
use crate::expr::differentiate::Derivative;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use gyro_model::CoordinateKind;

/// The armature of a joint.
#[derive(Clone, Copy, Debug)]
pub struct Rotor {
    pub inertia: ExprId,
    /// How fast it turns, b·v.
    pub rate: ExprId,
    /// How that changes while no body with coordinates accelerates, ḃ·v.
    pub bias: ExprId,
    /// The joint's bodies.
    pub bodies: [usize; 2],
    /// b: what a unit force along the coordinate does to them.
    pub along: [Load; 2],
}

impl Rotor {
    /// Those of all joints that have one.
    pub fn all(system: &mut System) -> Vec<Self> {
        let joints = 0..system.joints.len();
        joints.filter_map(|joint| Self::of(system, joint)).collect()
    }

    /// That of one joint, if it has one.
    pub fn of(system: &mut System, index: usize) -> Option<Self> {
        let description = &system.model.joints[index];
        if description.armature.is_zero() {
            return None;
        }
        let (joint, inertia) = (system.joints[index], system.number(&description.armature));
        // About the second body's axis.
        let kind = if description.kind.coordinates()[0].is_angle() {
            CoordinateKind::SecondAngle
        } else {
            CoordinateKind::Displacement
        };
        let rate = joint_coordinate::rate_as(system, &joint, kind);
        let along = joint_coordinate::unit_loads_as(system, &joint, kind);
        let motion = system.motion();
        let bias = Derivative::new(&system.definitions, motion).of(&mut system.graph, rate);
        Some(Self { inertia, rate, bias, bodies: [joint.first.body, joint.second.body], along })
    }

    /// b of a moving body.
    pub fn on(&self, system: &mut System, moving_body: usize) -> SpatialVector {
        let body = system.moving_bodies[moving_body];
        let ends = self.bodies.iter().zip(&self.along).filter(|(of, _)| **of == body);
        ends.fold(SpatialVector::ZERO, |sum, (_, load)| {
            sum.plus(&mut system.graph, &SpatialVector { t: load.force, rho: load.torque })
        })
    }

    /// How it accelerates, the bodies' accelerations being known.
    pub fn acceleration(&self, system: &mut System) -> ExprId {
        let mut sum = self.bias;
        for moving_body in 0..system.moving_bodies.len() {
            let along = self.on(system, moving_body);
            let motion = known(&mut system.graph, moving_body);
            let part = along.dot(&mut system.graph, &motion);
            sum = system.graph.add(part, sum);
        }
        sum
    }
}

/// The acceleration of a body, as it is known.
pub fn known(graph: &mut Graph, moving_body: usize) -> SpatialVector {
    let mut component = |k| graph.symbol(Symbol::Acceleration { moving_body, k });
    SpatialVector { t: [0, 1, 2].map(&mut component), rho: [3, 4, 5].map(component) }
}
