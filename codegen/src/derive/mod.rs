//! From the model to Φ and its derivatives, masses, forces and outputs: the textbook, symbol by symbol.

pub mod armature;
pub mod attraction;
pub mod between;
pub mod bushings;
pub mod constraints;
pub mod dynamics;
pub mod forces;
pub mod frames;
pub mod in_time;
pub mod joint_coordinate;
pub mod kinematics;
pub mod laws;
pub mod outputs;
pub mod points;
pub mod prescribed_motion;
pub mod readings;
pub mod system;

use crate::expr::graph::ExprId;
use dynamics::Dynamics;
use kinematics::Kinematics;
use system::System;

/// What follows from Φ, and the rest of eq. (17).
#[derive(Debug)]
pub struct Textbook {
    pub kinematics: Kinematics,
    pub dynamics: Dynamics,
}

impl Textbook {
    pub fn derive(system: &mut System) -> Self {
        let kinematics = Kinematics::derive(system);
        Self { kinematics, dynamics: Dynamics::derive(system) }
    }
}

/// What is read off a state, its accelerations and multipliers being known.
#[derive(Debug)]
pub struct Observed {
    /// The numbers of the outputs.
    pub outputs: Vec<ExprId>,
    /// Power of non-conservative forces and drivers.
    pub power: ExprId,
    /// The same without the forces that act along joint coordinates.
    pub power_but_along_coordinates: ExprId,
    /// Rates of the states, then of the turn references.
    pub other_rates: Vec<ExprId>,
    pub readings: Vec<ExprId>,
    /// (ṙ, ṗ) of each moving body by eqs. (16) and (14).
    pub position_rates: Vec<ExprId>,
}

impl Observed {
    pub fn derive(system: &mut System, textbook: &Textbook, lambda: &[ExprId]) -> Self {
        let Textbook { kinematics, dynamics } = textbook;
        let sources = outputs::Sources { kinematics, dynamics, lambda };
        let outputs = outputs::derive(system, &sources);
        let drivers_power = outputs::drivers_power(system, &sources);
        let power = system.graph.add(dynamics.power, drivers_power);
        let mut other_rates = state_rates(system);
        let turns = system.model.turn_references();
        other_rates.extend(turns.into_iter().map(|turn| joint_coordinate::rate(system, turn)));
        let readings = readings::readings(system);
        let position_rates = position_rates(system);
        let power_but_along_coordinates = system.graph.add(dynamics.power_at_points, drivers_power);
        Self { outputs, power, power_but_along_coordinates, other_rates, readings, position_rates }
    }
}

/// Rates of the states.
pub fn state_rates(system: &mut System) -> Vec<ExprId> {
    let states = system.model.states.iter();
    states.map(|state| laws::strength(system, &laws::OfBodies, &state.rate)).collect()
}

fn position_rates(system: &mut System) -> Vec<ExprId> {
    let poses: Vec<_> = system.moving_bodies.iter().map(|&body| system.poses[body]).collect();
    let rates = poses.iter().flat_map(|pose| {
        let p_rate = system.graph.euler_rate(&pose.p, &pose.w);
        pose.s.into_iter().chain(p_rate)
    });
    rates.collect()
}
