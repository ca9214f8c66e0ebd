//! The coordinate partition.

use super::{Mechanism, Owner};
use crate::{Error, Lanes};
use core::fmt::Debug;

/// The steps of the coordinate partition, eqs. (18) to (20): positions and velocities are split into independent ones,
/// which keep their integrated values, and dependent ones, which follow from the constraints.
///
/// Generated trees whose partition is unrolled have it for packs of lanes too, each lane with a choice of its own.
pub trait Partition: Mechanism<Scalar: Lanes> {
    /// Which coordinates are independent; `()` where those of a tree of joints always are
    /// ([`joint_partition`](crate::joint_partition)).
    type Independent: Clone + Debug + PartialEq;

    /// The best choice at a state.
    fn independent(&self, t: Self::Scalar, y: &Self::State) -> Self::Independent;
    /// Follows the motion: replaces the choice where it has become a poor one. Returns the number of changes.
    fn follow(&self, t: Self::Scalar, y: &Self::State, choice: &mut Self::Independent) -> u32;
    /// One Newton step of the dependent positions towards Φ(q, t) = 0.
    ///
    /// # Errors
    /// [`Error::Singular`] if the equations cannot be solved for the dependent coordinates.
    fn newton_step(
        &self,
        t: Self::Scalar,
        choice: &Self::Independent,
        y: &mut Self::State,
    ) -> Result<(), Error>;
    /// Whether rounding prevents the rows of Φ from coming nearer to zero, although one exceeds the tolerance for poses
    /// near the origin: Newton's iteration then ends. Angles of many turns are known less accurately than angles of a
    /// few, and a mechanism with such rows compares each with the terms that it subtracts
    /// ([`pivoting::is_met`](crate::pivoting::is_met)).
    fn is_met(&self, _t: Self::Scalar, _y: &Self::State, _phi: &Self::Constraints) -> bool {
        false
    }
    /// Solves eq. (19) for the dependent velocities, at corrected positions; the independent ones (components of ṙ and
    /// ṗ, or the rate about a joint's axis) keep the values that they have in `y`.
    ///
    /// # Errors
    /// [`Error::Singular`] if the equations cannot be solved for the dependent velocities.
    fn solve_velocities(
        &self,
        t: Self::Scalar,
        choice: &Self::Independent,
        y: &mut Self::State,
    ) -> Result<(), Error>;
    /// How far a state is from singular poses; `None` for mechanisms that have none, like trees.
    fn clearance(&self, _t: Self::Scalar, _y: &Self::State) -> Option<Clearance<Self::Scalar>> {
        None
    }
}

/// How far a state is from singular poses, in which a mechanism has more degrees of freedom than elsewhere and several
/// motions continue.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearance<T> {
    /// A pure number, of order one far from singular poses and zero in them.
    pub pivot: T,
    /// The owner of the constraint that depends on others there, where it is known.
    pub owner: Option<Owner>,
}
