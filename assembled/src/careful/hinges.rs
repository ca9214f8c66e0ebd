//! The tree of bodies as the careful form goes through it: what holds each, and by which of its sides.

use crate::model::joint::{End, Joint};
use gyro_model::JointKind;

/// A body with coordinates and what holds it; parents come before children.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Link {
    pub(crate) moving_body: usize,
    pub(crate) hold: Hold,
}

/// What holds a body.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Hold {
    Free,
    /// Index of the constrained body, and its first row.
    Constrained(usize, usize),
    Joint(Hinge),
}

/// A joint with its direction in the tree.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hinge {
    pub(crate) joint: usize,
    /// Its first row; the others follow.
    pub(crate) first_row: usize,
    pub(crate) bearing: Bearing,
    pub(crate) child: Side,
    /// The parent's moving_body, if the parent moves under the child's load.
    pub(crate) loads: Option<usize>,
}

/// The kinds of joint that elimination knows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Bearing {
    Revolute,
    Spherical,
    Fixed,
}

/// Which of a joint's bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    First,
    Second,
}

impl Bearing {
    pub(crate) fn of(kind: JointKind) -> Option<Self> {
        match kind {
            JointKind::Revolute => Some(Self::Revolute),
            JointKind::Spherical => Some(Self::Spherical),
            JointKind::Fixed => Some(Self::Fixed),
            _ => None,
        }
    }
}

impl Hinge {
    /// The parent's end of the joint and the child's.
    pub(crate) fn ends<'a, T>(&self, joint: &'a Joint<T>) -> (&'a End<T>, &'a End<T>) {
        match self.child {
            Side::First => (&joint.second, &joint.first),
            Side::Second => (&joint.first, &joint.second),
        }
    }
}
