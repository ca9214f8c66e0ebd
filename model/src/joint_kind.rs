//! The kinds of joint: their rows of Φ and their coordinates.

use crate::{CoordinateKind, PointAxes, RowUnit};

/// The kinds of joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointKind {
    /// Rotation about one axis: point rows, eq. (7), and two dot-1 rows, eqs. (9) and (10).
    Revolute,
    /// Coincident points: eq. (7).
    Spherical,
    /// No relative motion: point rows and three dot-1 rows.
    Fixed,
    /// Two crossing axes at right angles (Hooke): point rows and `h_i·h_j`.
    Universal,
    /// Rotation about and displacement along one axis.
    Cylindrical,
    /// Displacement along one axis.
    Prismatic,
    /// Two displacements in a plane and rotation about its normal h.
    Planar,
    /// Rotation about an axis and displacement along it in a fixed ratio, [`crate::Joint::lead`].
    Screw,
    /// The second body's point stays on the first body's axis.
    PointOnLine,
    /// Two points at a fixed distance, [`crate::Joint::length`].
    Rod,
}

/// What a kind of joint is.
struct Described {
    /// Its name in the model file.
    name: &'static str,
    /// How many of its rows, the first ones, are lengths.
    lengths: usize,
    /// Its rows, as messages write them.
    rows: &'static [&'static str],
    coordinates: &'static [CoordinateKind],
}

impl JointKind {
    /// All kinds.
    pub const ALL: [Self; 10] = [
        Self::Revolute,
        Self::Spherical,
        Self::Fixed,
        Self::Universal,
        Self::Cylindrical,
        Self::Prismatic,
        Self::Planar,
        Self::Screw,
        Self::PointOnLine,
        Self::Rod,
    ];

    fn described(self) -> Described {
        use CoordinateKind::{Angle, Displacement, FirstAngle, SecondAngle, X, Y};
        let of = |name, lengths, rows, coordinates| Described { name, lengths, rows, coordinates };
        match self {
            Self::Revolute => of("revolute", 3, &["d x", "d y", "d z", "f_i.h_j", "g_i.h_j"], &[Angle]),
            Self::Spherical => of("spherical", 3, &["d x", "d y", "d z"], &[]),
            Self::Fixed => of("fixed", 3, &["d x", "d y", "d z", "f_i.h_j", "g_i.h_j", "f_i.g_j"], &[]),
            Self::Universal => {
                of("universal", 3, &["d x", "d y", "d z", "h_i.h_j"], &[FirstAngle, SecondAngle])
            }
            Self::Cylindrical => {
                of("cylindrical", 2, &["f_i.d", "g_i.d", "f_i.h_j", "g_i.h_j"], &[Angle, Displacement])
            }
            Self::Prismatic => {
                let rows = &["f_i.d", "g_i.d", "f_i.h_j", "g_i.h_j", "f_i.g_j"];
                of("prismatic", 2, rows, &[Displacement])
            }
            Self::Planar => of("planar", 1, &["h_i.d", "f_i.h_j", "g_i.h_j"], &[X, Y, Angle]),
            Self::Screw => {
                let rows = &["f_i.d", "g_i.d", "h_i.d - lead * angle", "f_i.h_j", "g_i.h_j"];
                of("screw", 3, rows, &[Angle])
            }
            Self::PointOnLine => of("point_on_line", 2, &["f_i.d", "g_i.d"], &[Displacement]),
            Self::Rod => of("rod", 1, &["(d.d / length - length) / 2"], &[]),
        }
    }

    /// The kind's name in the model file.
    pub fn name(self) -> &'static str {
        self.described().name
    }

    /// The kind of a name in the model file.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|kind| kind.name() == name)
    }

    /// Units of the joint's rows, in their order: see [`crate::Model::rows`].
    pub fn row_units(self) -> &'static [RowUnit] {
        use RowUnit::{Length, Pure};
        const UNITS: [RowUnit; 6] = [Length, Length, Length, Pure, Pure, Pure];
        let Described { lengths, rows, .. } = self.described();
        &UNITS[3 - lengths..][..rows.len()]
    }

    /// Whether the joint's one coordinate is its one freedom: then it can have an armature.
    pub fn turns_one_rotor(self) -> bool {
        self.coordinates().len() == 1 && self.n_free() == 1
    }

    /// Number of relative motions that the joint leaves free.
    pub fn n_free(self) -> usize {
        6 - self.row_units().len()
    }

    /// Whether the joint's first three rows say that its points coincide, paper eq. (7).
    pub fn joins_points(self) -> bool {
        matches!(self, Self::Revolute | Self::Spherical | Self::Fixed | Self::Universal)
    }

    /// What the joint's rows are, in their order, as messages write them.
    pub fn row_symbols(self, axes: PointAxes) -> Vec<&'static str> {
        let mut symbols = self.described().rows.to_vec();
        if self.joins_points() && axes == PointAxes::FirstBody {
            symbols[..3].copy_from_slice(&["f_i.d", "g_i.d", "h_i.d"]);
        }
        symbols
    }

    /// The joint's scalar coordinates. A spherical joint has an orientation instead; fixed joints and rods have none.
    pub fn coordinates(self) -> &'static [CoordinateKind] {
        self.described().coordinates
    }

    /// Whether the joint can carry a body in a tree: all but a rod.
    pub fn carries(self) -> bool {
        self != Self::Rod
    }

    /// Whether the joint carries a body and its coordinates say how the body is turned.
    pub(crate) fn turns(self) -> bool {
        self.carries() && self != Self::PointOnLine
    }
}
