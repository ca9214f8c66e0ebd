//! Events: crossings of levels, which runs find, list and may end at.

use crate::{Formula, Number};

/// A number of the mechanism, or a formula of several, crosses a level.
#[derive(Clone, Debug)]
pub struct Event {
    /// Name, an identifier.
    pub name: String,
    /// What crosses.
    pub of: Formula,
    /// The level, in the unit of what crosses.
    pub level: Number,
    /// Which crossings count.
    pub direction: Direction,
    /// Whether the run ends at the first one.
    pub stops: bool,
}

/// Which crossings count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Direction {
    /// From below the level to the level or above.
    Rising,
    /// From above the level to the level or below.
    Falling,
    /// All.
    #[default]
    Both,
}

impl Event {
    /// Most events of a model.
    pub const MOST: usize = 16;
}
