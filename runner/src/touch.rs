//! Contacts in a run: rigid stops, and friction that sticks.

use nanoserde::{DeBin, SerBin};

/// A contact.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub enum Touch {
    /// On a joint coordinate.
    Stop(Stop),
    /// Between surfaces of two bodies.
    Surfaces(Surfaces),
}

impl Touch {
    /// The inputs that are its forces.
    pub fn inputs(&self) -> &[usize] {
        match self {
            Self::Stop(stop) => core::slice::from_ref(&stop.input),
            Self::Surfaces(surfaces) => &surfaces.inputs,
        }
    }
}

/// A point at which rigid surfaces may touch.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub struct Surfaces {
    /// The indices of the inputs that are the push and friction along two tangents.
    pub inputs: [usize; 3],
    /// Where among the numbers of the outputs are the gap with its rate and acceleration, the velocity of slip along
    /// the first tangent with its derivative, and that along the second.
    pub outputs: [usize; 7],
    /// What is left after an impact, from 0 to 1.
    pub restitution: f64,
    /// Whether of the impulse (Poisson) rather than of the rate (Newton).
    pub is_of_impulses: bool,
    /// The kinetic and the static coefficient of friction.
    pub coefficients: [f64; 2],
}

/// What may stop a joint coordinate, hold it, or rub on it.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub struct Stop {
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
    /// Where among these the coordinate, its rate and its acceleration are, if its joint is cut.
    pub seen: Option<usize>,
}
