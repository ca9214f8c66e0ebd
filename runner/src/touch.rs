//! Contacts in a run: rigid stops, and friction that sticks.

use nanoserde::{DeBin, SerBin};

/// What may stop a joint coordinate, hold it, or rub on it.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub struct Touch {
    /// Indices of a joint and of one of its coordinates, which is no orientation.
    pub on: (usize, usize),
    /// The index of the input that is its force.
    pub input: usize,
    /// Where the coordinate is stopped, rad or m; infinite where it is not.
    pub ends: [f64; 2],
    /// What is left of the rate after an impact, from 0 to 1.
    pub restitution: f64,
    /// The kinetic and the static level of dry friction, N·m or N.
    pub levels: [f64; 2],
    /// What they grow by with the force of a reaction: 1 along a length, m along an angle.
    pub coefficients: [f64; 2],
    /// Where that reaction begins among the numbers of the outputs.
    pub reaction: Option<usize>,
}

impl Touch {
    /// Most of a run.
    pub const MOST: usize = 8;
}
