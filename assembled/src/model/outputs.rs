//! What a model file asks for besides the motion: [`gyro_model::OutputKind`].

use crate::model::amount::Amount;
use crate::model::between::Frames;
use crate::model::bushing::Bushing;
use crate::model::joint::Joint;
use crate::model::measure::Coordinate;
use crate::model::path::Path;
use crate::model::place::{Places, first_state, vector};
use crate::model::spot::Spot;
use crate::model::tracked::{Subject, Tracked};
use crate::number::Number;
use gyro_model::{BodyFrame, ForceKind, Model, OutputKind, RowOwner};

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
    Relative(Box<Frames<T>>),
    /// A joint and its rows.
    Reaction(usize, Vec<usize>),
    /// The row of a driver or coupler, unless it was redundant.
    Load(Option<usize>),
    /// A spring along its coordinate, or a link along its line.
    Elastic(Elastic<T>),
    /// An element of the state.
    State(usize),
    /// A bushing.
    Bushing(Box<Bushing<T>>),
    /// A formula, which may see other outputs.
    Formula(Amount<T>),
    /// The derivative of a formula of what joints measure and of where frames are.
    Rate(Box<Tracked<T>>),
    Energy,
    Power,
}

/// `−stiffness (x − free) − damping ẋ − tension` along a path.
#[derive(Clone, Debug)]
pub(crate) struct Elastic<T> {
    pub(crate) path: Path<T>,
    pub(crate) stiffness: Amount<T>,
    pub(crate) free: Amount<T>,
    pub(crate) damping: Amount<T>,
    pub(crate) tension: Amount<T>,
    /// Whether x is told beside the force, rather than x − free.
    pub(crate) is_link: bool,
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

impl<T: Number> Elastic<T> {
    fn new(model: &Model, (places, joints): (&Places<T>, &[Joint<T>]), kind: &ForceKind) -> Self {
        let amount = |number: &_| Amount::new(model, (places, joints), number);
        match kind {
            ForceKind::Link { first, second, stiffness, damping, free_length, tension } => {
                let end = |(body, point): &(usize, _)| (places.of(*body), vector(model.values(point)));
                Self {
                    path: Path::Line([end(first), end(second)]),
                    stiffness: amount(stiffness),
                    free: amount(free_length),
                    damping: amount(damping),
                    tension: amount(tension),
                    is_link: true,
                }
            }
            ForceKind::Spring { on, stiffness, free } => Self {
                path: Path::Coordinate(Coordinate::of(&joints[on.joint], on.coordinate)),
                stiffness: amount(stiffness),
                free: amount(free),
                damping: Amount::Constant(T::zero()),
                tension: Amount::Constant(T::zero()),
                is_link: false,
            },
            _ => unreachable!("the reader refuses outputs of other forces"),
        }
    }
}

impl<T: Number> Output<T> {
    pub(crate) fn new(
        model: &Model,
        (places, joints, pairs): (&Places<T>, &[Joint<T>], &[usize]),
        output: &gyro_model::Output,
    ) -> Self {
        let spot = |frame: &BodyFrame| Spot::new(model, places, frame);
        let rows_of = |owner| -> Vec<usize> {
            let rows = model.rows().into_iter().enumerate();
            rows.filter(|(_, row)| row.owner == owner).map(|(index, _)| index).collect()
        };
        let quantity = match &output.kind {
            OutputKind::Pose(frame) => Quantity::Pose(spot(frame)),
            OutputKind::Velocity(frame) => Quantity::Velocity(spot(frame)),
            OutputKind::Acceleration(frame) => Quantity::Acceleration(spot(frame)),
            OutputKind::Inertial(frame) => Quantity::Inertial(spot(frame)),
            OutputKind::Relative(relative) => {
                Quantity::Relative(Box::new(Frames::new(model, places, relative.frames.each_ref())))
            }
            OutputKind::Reaction { joint } => Quantity::Reaction(*joint, rows_of(RowOwner::Joint(*joint))),
            OutputKind::Driver { driver } => {
                Quantity::Load(rows_of(RowOwner::Driver(*driver)).first().copied())
            }
            OutputKind::Coupler { coupler } => {
                Quantity::Load(rows_of(RowOwner::Coupler(*coupler)).first().copied())
            }
            OutputKind::Spring { force } | OutputKind::Link { force } => {
                Quantity::Elastic(Elastic::new(model, (places, joints), &model.forces[*force].kind))
            }
            OutputKind::State { state } => Quantity::State(first_state(model) + state),
            OutputKind::Bushing { force } => match &model.forces[*force].kind {
                ForceKind::Bushing(bushing) => {
                    Quantity::Bushing(Box::new(Bushing::new(model, (places, joints), bushing)))
                }
                _ => unreachable!("the reader refuses outputs of other forces"),
            },
            OutputKind::Formula(formula) => {
                let number = gyro_model::Number::Formula(formula.clone().into());
                Quantity::Formula(Amount::new(model, (places, joints), &number))
            }
            OutputKind::Rate(formula) => {
                let term = |subject: Subject| subject.term((joints, pairs));
                Quantity::Rate(Box::new(Tracked::new(model, formula, term)))
            }
            OutputKind::Energy => Quantity::Energy,
            OutputKind::Power => Quantity::Power,
        };
        Self { columns: output.kind.columns(), quantity }
    }
}
