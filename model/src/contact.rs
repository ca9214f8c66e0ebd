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
    /// Of a coordinate that joint states may not have, as its joint is cut or a coupler ties it: the first of three
    /// outputs, which are its value, its rate and its acceleration.
    pub seen: Option<usize>,
}

/// Surfaces of two bodies that may touch at a point, rigid: what each of the pairs of shapes of a
/// `[[contact]]` comes to. By a bushing they push along the normal of the surfaces and rub along two tangents, with
/// forces that are inputs.
#[derive(Clone, Debug)]
pub struct Touching {
    /// Name of the pair and number of the point.
    pub name: String,
    /// What is left of the rate, or of the impulse, after an impact: from 0 to 1.
    pub restitution: Number,
    /// Whether restitution is of impulses, Poisson's law, rather than of rates, Newton's.
    pub is_of_impulses: bool,
    /// The kinetic and the static coefficient of friction.
    pub coefficients: [Number; 2],
    /// Indices into [`crate::Model::inputs`] of the push, and of friction along both tangents, N.
    pub inputs: [usize; 3],
    /// Indices into [`crate::Model::outputs`], each of one number: the gap, its rate and its acceleration; the velocity
    /// of slip along the first tangent and its derivative; and those along the second.
    pub outputs: [usize; 7],
}

impl Contact {
    /// Most contacts of a model.
    pub const MOST: usize = 96;

    /// All its numbers.
    pub(crate) fn numbers(&self) -> impl Iterator<Item = &Number> {
        let levels = self.levels.iter().chain(&self.coefficients).chain(&self.radius);
        self.ends.iter().flatten().chain([&self.restitution]).chain(levels)
    }
}
