//! The twists that move along a single component.

use crate::expr::graph::{ExprId, Graph};
use crate::expr::spatial_vector::SpatialVector;

/// A component of a twist or wrench.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Component {
    T(usize),
    Rho(usize),
}

impl Component {
    /// The component along which a twist is one, all others being zero.
    pub fn of(twist: &SpatialVector) -> Option<Self> {
        let all = (0..3).map(Self::T).chain((0..3).map(Self::Rho));
        let mut others = all.filter(|component| *component.get(twist) != Graph::ZERO);
        let first = others.next()?;
        (others.next().is_none() && *first.get(twist) == Graph::ONE).then_some(first)
    }

    pub fn get(self, twist: &SpatialVector) -> &ExprId {
        match self {
            Self::T(k) => &twist.t[k],
            Self::Rho(k) => &twist.rho[k],
        }
    }

    pub fn set(self, twist: &mut SpatialVector, value: ExprId) {
        match self {
            Self::T(k) => twist.t[k] = value,
            Self::Rho(k) => twist.rho[k] = value,
        }
    }
}
