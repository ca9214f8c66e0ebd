//! What a model file asks for besides the motion: [`gyro_model::OutputKind`].

use crate::model::place::{Place, Places, vector};
use crate::number::Number;
use gyro_model::{Model, OutputKind, RowOwner};
use nalgebra::Vector3;

/// An output; its name is in the description.
#[derive(Clone, Debug)]
pub(crate) struct Output<T> {
    pub(crate) columns: &'static [(&'static str, &'static str)],
    pub(crate) quantity: Quantity<T>,
}

/// What an output is.
#[derive(Clone, Debug)]
pub(crate) enum Quantity<T> {
    Pose(Spot<T>),
    Velocity(Spot<T>),
    Acceleration(Spot<T>),
    Inertial(Spot<T>),
    /// A joint and its rows.
    Reaction(usize, Vec<usize>),
    /// The driver's row, unless it was redundant.
    Driver(Option<usize>),
    Energy,
    Power,
}

/// A point of a body, in the body's frame.
#[derive(Clone, Debug)]
pub(crate) struct Spot<T> {
    pub(crate) place: Place<T>,
    pub(crate) point: Vector3<T>,
}

/// What eq. (17) says of a moment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Solution<'a, T> {
    /// `(s̈, ẇ')` body after body.
    pub(crate) accelerations: &'a [T],
    pub(crate) lambda: &'a [T],
    /// λᵀν.
    pub(crate) lambda_nu: T,
}

impl<T: Number> Output<T> {
    pub(crate) fn new(model: &Model, places: &Places<T>, output: &gyro_model::Output) -> Self {
        let spot = |body: &usize, point| Spot { place: places.of(*body), point: vector(model.values(point)) };
        let rows_of = |owner| -> Vec<usize> {
            let rows = model.rows().into_iter().enumerate();
            rows.filter(|(_, row)| row.owner == owner).map(|(index, _)| index).collect()
        };
        let quantity = match &output.kind {
            OutputKind::Pose { body, point } => Quantity::Pose(spot(body, point)),
            OutputKind::Velocity { body, point } => Quantity::Velocity(spot(body, point)),
            OutputKind::Acceleration { body, point } => Quantity::Acceleration(spot(body, point)),
            OutputKind::Inertial { body, point } => Quantity::Inertial(spot(body, point)),
            OutputKind::Reaction { joint } => Quantity::Reaction(*joint, rows_of(RowOwner::Joint(*joint))),
            OutputKind::Driver { driver } => {
                Quantity::Driver(rows_of(RowOwner::Driver(*driver)).first().copied())
            }
            OutputKind::Energy => Quantity::Energy,
            OutputKind::Power => Quantity::Power,
        };
        Self { columns: output.kind.columns(), quantity }
    }
}
