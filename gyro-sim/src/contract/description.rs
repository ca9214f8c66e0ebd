//! What a mechanism is made of, as data.

#[cfg(feature = "wire")]
use crate::wire::*;

/// Names, rows and sizes of a mechanism.
///
/// Generated mechanisms have it as a constant, so that a program keeps of it only what it reads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Description<'a> {
    /// A typical length of the mechanism, m. Violations of length rows are divided by it.
    pub size: f64,
    /// Names of the bodies that have coordinates, in the order of the state.
    pub bodies: &'a [&'a str],
    /// Names and coordinates of the joints.
    pub joints: &'a [JointInfo<'a>],
    /// Names of the couplers of joint coordinates, then of constraints.
    pub couplers: &'a [&'a str],
    /// Names of the drivers of joint coordinates.
    pub drivers: &'a [&'a str],
    /// What each joint row measures.
    pub rows: &'a [RowInfo],
    /// Whether the state contains the work done by non-conservative forces and drivers, after the velocities.
    pub has_work: bool,
    /// For each turn reference, which are the last elements of the state, the index of its angle's raw sine among the
    /// readings.
    pub turn_references: &'a [u16],
    /// Names of the inputs.
    pub inputs: &'a [&'a str],
    /// What each number of the outputs is.
    pub outputs: &'a [OutputInfo<'a>],
}

impl Description<'_> {
    /// Whether a row of Φ is a length, m; normalisations, which follow the joint rows, are pure numbers.
    pub fn is_length(&self, row: usize) -> bool {
        self.rows.get(row).is_some_and(|row| row.is_length)
    }

    /// Where among the readings those of a joint's coordinate begin; `None` for one that does not exist.
    pub fn reading(&self, joint: usize, coordinate: usize) -> Option<usize> {
        let (before, from) = self.joints.split_at_checked(joint)?;
        let own = from.first()?.coordinates;
        own.get(coordinate)?;
        let of_joints: usize = before.iter().map(JointInfo::n_readings).sum();
        Some(of_joints + own.iter().take(coordinate).map(|c| c.n_readings()).sum::<usize>())
    }

    /// The index of the work in the state, if it is there.
    pub fn work(&self) -> Option<usize> {
        self.has_work.then_some(13 * self.bodies.len())
    }
}

/// Name and coordinates of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct JointInfo<'a> {
    /// The name in the model file.
    pub name: &'a str,
    /// What its readings are, coordinate after coordinate; empty for a fixed joint or a rod.
    pub coordinates: &'a [Coordinate],
}

impl JointInfo<'_> {
    /// Number of raw readings of all its coordinates.
    pub fn n_readings(&self) -> usize {
        self.coordinates.iter().map(|coordinate| coordinate.n_readings()).sum()
    }
}

/// What the readings of a joint's coordinate are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Coordinate {
    /// Three readings: two that are proportional to the sine and the cosine of the angle by the same positive factor,
    /// and the rate, rad/s.
    Angle,
    /// Two readings: a length, m, and its rate, m/s.
    Length,
    /// Seven readings: the Euler parameters of the second body's frame in the first's, and the angular velocity of the
    /// second body relative to the first, in the second body's frame, rad/s.
    Orientation,
}

impl Coordinate {
    /// Number of raw readings.
    pub const fn n_readings(self) -> usize {
        match self {
            Self::Angle => 3,
            Self::Length => 2,
            Self::Orientation => 7,
        }
    }
}

/// What a joint row measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RowInfo {
    /// The owner of the row.
    pub owner: Owner,
    /// Whether the row is a length, m; it is a pure number otherwise.
    pub is_length: bool,
}

/// The owner of a constraint row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "wire", derive(SerBin, DeBin))]
pub enum Owner {
    /// A body's own constraint, by the index of the body.
    Body(u16),
    /// A joint, by its index.
    Joint(u16),
    /// A coupler of joint coordinates or a constraint, by its index.
    Coupler(u16),
    /// A driver of a joint coordinate, by its index.
    Driver(u16),
}

/// One number of the outputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct OutputInfo<'a> {
    /// The output's name in the model file.
    pub name: &'a str,
    /// Which of the output's numbers it is; empty for an output of a single number.
    pub suffix: &'a str,
    /// Its unit; empty for a pure number.
    pub unit: &'a str,
}
