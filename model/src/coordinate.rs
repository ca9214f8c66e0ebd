//! Scalar coordinates of joints, and what else can be seen of a mechanism.

/// One scalar coordinate of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct JointCoordinate {
    /// Index into [`crate::Model::joints`].
    pub joint: usize,
    /// Index into the joint's [`crate::JointKind::coordinates`].
    pub coordinate: usize,
}

/// What is asked of a joint's coordinates, from little to much.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum CoordinateUse {
    /// Nothing.
    #[default]
    None,
    /// Their rates, by friction and dampers, or that forces act along them.
    Rate,
    /// Where they are, by springs and stops, or that an armature turns with them.
    Value,
    /// That they are what a coupler or a driver says.
    Prescribed,
}

/// What a scalar coordinate of a joint is. With (f, g, h) the joint frames and d from the first joint point to the
/// second: every angle is continuous over turns where something acts on it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum CoordinateKind {
    /// From the first body's f to the second's about h: `atan2(g_i·f_j, f_i·f_j)`, rad.
    Angle,
    /// Universal: from the first body's f to the second's h about the first's h: `atan2(g_i·h_j, f_i·h_j)`, rad.
    FirstAngle,
    /// Universal: from the first body's h to the second's f about the second's h: `atan2(−h_i·g_j, h_i·f_j)`, rad.
    SecondAngle,
    /// `h_i·d`, m.
    Displacement,
    /// `f_i·d`, m.
    X,
    /// `g_i·d`, m.
    Y,
}

impl CoordinateKind {
    /// Whether the coordinate is an angle, rad; a length, m, otherwise.
    pub fn is_angle(self) -> bool {
        matches!(self, Self::Angle | Self::FirstAngle | Self::SecondAngle)
    }

    /// The coordinate's name in the model file and in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Angle => "angle",
            Self::FirstAngle => "first_angle",
            Self::SecondAngle => "second_angle",
            Self::Displacement => "displacement",
            Self::X => "x",
            Self::Y => "y",
        }
    }
}

/// A number of the mechanism that controllers, events and formulas can see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Seen {
    /// A number of an output.
    Output {
        /// Index into [`crate::Model::outputs`].
        output: usize,
        /// Index into the [`crate::OutputKind::columns`] of its kind.
        number: usize,
    },
    /// A joint coordinate, rad or m.
    Coordinate(JointCoordinate),
    /// Its rate, rad/s or m/s.
    Rate(JointCoordinate),
    /// The time, s.
    Time,
    /// In the law of a link: the distance of its ends, m.
    Length,
    /// In the law of a link: the rate of that distance, m/s.
    LengthRate,
    /// In the law of a bushing: one of its [`crate::Bushing::READINGS`], m or rad.
    Between(usize),
    /// In the law of a bushing: the rate of one of these, m/s or rad/s.
    BetweenRate(usize),
}
