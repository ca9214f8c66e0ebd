//! Where a run starts.

use crate::control::Controller;
use crate::path::Path;
use crate::{Input, Kink, Touch, Watch};
use nanoserde::{DeBin, SerBin};

/// Where a run starts, what its inputs are set to and what is watched besides joints and outputs.
#[derive(Clone, Debug, Default, PartialEq, SerBin, DeBin)]
pub struct Start {
    /// `(r, p)` of each body with coordinates.
    pub positions: Vec<f64>,
    /// `(s, w')` of each body with coordinates.
    pub velocities: Vec<f64>,
    /// The model file's own states.
    pub states: Vec<f64>,
    /// The mechanism's turn references: the last elements of its state.
    pub turn_references: Vec<f64>,
    /// For each coordinate, joint after joint, the angle that its continuous angle starts nearest to, rad; anything for
    /// coordinates that are no angles.
    pub angles: Vec<f64>,
    /// What the mechanism's inputs are over time; those that are not here stay as they are.
    pub inputs: Vec<Input>,
    /// Times, s, at which the mechanism's own motions are not smooth: steps under error control end there.
    pub knots: Vec<f64>,
    /// Motions along straight lines, whose velocities jump.
    pub paths: Vec<Path>,
    /// Indices of the bodies whose pose and velocity are sampled.
    pub observed_bodies: Vec<usize>,
    /// What sets inputs in a closed loop; none of them is among `inputs`, and none is set twice.
    pub controllers: Vec<Controller>,
    /// Events that are looked for, at most [`Watch::MOST`].
    pub watches: Vec<Watch>,
    /// Kinks of laws: steps under error control end there, others that go over them are counted.
    pub kinks: Vec<Kink>,
    /// Rigid stops and friction that sticks, and surfaces that touch.
    pub contacts: Vec<Touch>,
}

impl Start {
    /// The last elements of the state: the model file's own states, then turn references.
    pub fn others(&self) -> impl Iterator<Item = f64> {
        self.states.iter().chain(&self.turn_references).copied()
    }

    /// How many these are.
    pub fn n_others(&self) -> usize {
        self.states.len() + self.turn_references.len()
    }
}
