//! Relations that determine a coordinate.

use gyro_model::{JointCoordinate, Model, Number, RowOwner};

/// A coordinate that others or time determine.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Determined {
    pub coordinate: JointCoordinate,
    pub by: Relation,
}

/// A row between coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// Index into the model's drivers.
    Driver(usize),
    /// Index into the model's couplers: its second coordinate by its first.
    Forward(usize),
    /// Its first coordinate by its second.
    Backward(usize),
    /// A row of a joint that closes a loop, by its place among all rows: the coordinate is zero, as the angle out of
    /// its plane of a linkage is.
    Held(usize),
}

impl Relation {
    /// The owner of its row, if it is a row beside the joints.
    pub fn owner(self) -> Option<RowOwner> {
        match self {
            Self::Driver(driver) => Some(RowOwner::Driver(driver)),
            Self::Forward(coupler) | Self::Backward(coupler) => Some(RowOwner::Coupler(coupler)),
            Self::Held(_) => None,
        }
    }

    /// The coordinate that the determined one is a multiple of, but for an offset.
    pub fn source(self, model: &Model) -> Option<JointCoordinate> {
        match self {
            Self::Driver(_) | Self::Held(_) => None,
            Self::Forward(coupler) => Some(linear(model, coupler).0),
            Self::Backward(coupler) => model.couplers[coupler].second,
        }
    }
}

/// First coordinate, ratio and offset of a coupler that determines a coordinate.
pub fn linear(model: &Model, coupler: usize) -> (JointCoordinate, &Number, &Number) {
    model.couplers[coupler].linear().expect("formulas determine nothing by themselves")
}
