//! Rigid stops and dry friction that sticks, along joint coordinates.

use crate::{JointCoordinate, Number};

/// What may stop a joint coordinate, hold it, or rub on it; rigid, so that runs go from event to event.
///
/// A contact acts on the mechanism by a force of its own, a motor whose value is an input: both have its name.
#[derive(Clone, Debug)]
pub struct Contact {
    /// Name, an identifier.
    pub name: String,
    /// Where it acts.
    pub on: JointCoordinate,
    /// The lower and the upper stop, rad or m.
    pub ends: [Option<Number>; 2],
    /// What is left of the rate after an impact on a stop: from 0 to 1.
    pub restitution: Number,
    /// The kinetic and the static level of dry friction, N·m or N.
    pub levels: [Number; 2],
    /// The kinetic and the static coefficient of friction in proportion to the force of the joint's reaction.
    pub coefficients: [Number; 2],
    /// The radius of the bearing at which that friction acts, m; along an angle only.
    pub radius: Option<Number>,
    /// Index into [`crate::Model::outputs`] of that reaction, where friction depends on it.
    pub reaction: Option<usize>,
    /// Index into [`crate::Model::inputs`] of its force.
    pub input: usize,
}

impl Contact {
    /// Most contacts of a model.
    pub const MOST: usize = 8;

    /// All its numbers.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = &Number> {
        let levels = self.levels.iter().chain(&self.coefficients).chain(&self.radius);
        self.ends.iter().flatten().chain([&self.restitution]).chain(levels)
    }
}
