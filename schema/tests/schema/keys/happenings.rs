//! Events, and contacts: what happens at an instant.

use super::numbers::{Name, Number};
use schemars::JsonSchema;

/// A crossing of a level, which runs list.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
pub(crate) struct Event {
    name: Name,
    /// What crosses: the name of a column of a run's table.
    of: String,
    /// What is subtracted from it.
    minus: Option<String>,
    /// The level, 0 unless given.
    level: Option<Number>,
    /// Which crossings count; `both` unless given.
    direction: Option<Direction>,
    /// Whether the run ends at the first one.
    stop: Option<bool>,
}

#[derive(JsonSchema)]
#[schemars(rename_all = "snake_case")]
#[expect(dead_code, reason = "a description")]
enum Direction {
    /// From below the level.
    Rising,
    /// From above the level.
    Falling,
    /// All crossings.
    Both,
}

/// Rigid stops and dry friction that sticks, along a joint coordinate.
#[derive(JsonSchema)]
#[schemars(deny_unknown_fields)]
#[expect(dead_code, reason = "a description")]
pub(crate) struct Contact {
    name: Name,
    joint: String,
    /// Which coordinate, of a joint with several.
    coordinate: Option<String>,
    /// The lower stop, rad or m.
    lower: Option<Number>,
    /// The upper stop, rad or m.
    upper: Option<Number>,
    /// The part of its rate with which the joint rebounds from a stop, 0 to 1.
    restitution: Option<Number>,
    /// The level of friction on what moves, N·m or N.
    friction: Option<Number>,
    /// The level of friction on what is at rest; that of `friction` unless given.
    static_friction: Option<Number>,
    /// The coefficient of friction on what moves, in proportion to the force of the joint's reaction.
    friction_coefficient: Option<Number>,
    /// The coefficient of friction on what is at rest; that of `friction_coefficient` unless given.
    static_friction_coefficient: Option<Number>,
    /// The radius of the bearing, m, at which that friction acts about an axis.
    radius: Option<Number>,
}
