//! States of one's own: currents, temperatures, pressures, filters.

use crate::Number;

/// A quantity σ with `σ̇ = rate`, integrated with the motion: one more element of the state, in the order of the model
/// file.
#[derive(Clone, Debug)]
pub struct State {
    /// Name, an identifier.
    pub name: String,
    /// Where it starts.
    pub start: StateStart,
    /// Its rate: a strength, as those of forces are, which may depend on the states, too.
    pub rate: Number,
}

/// Where a state starts.
#[derive(Clone, Debug)]
pub enum StateStart {
    /// At this value.
    At(Number),
    /// Where its rate is zero as the mechanism starts.
    AtRest,
}
