//! Gravity that is not the same everywhere: that of a central body.

use crate::Number;

/// The attraction of a point mass that stays where it is.
///
/// A body of mass m whose mass centre is at r is pulled there, as if all of it were at that point, by
/// `−m μ (r − c)/|r − c|³`, and the energy `−m μ/|r − c|` is counted as stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Attraction {
    /// μ, the gravitational parameter: the constant of gravitation times the attracting mass, m³/s².
    pub mu: Number,
    /// c in the global frame, m.
    pub centre: [Number; 3],
}
