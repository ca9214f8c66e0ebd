//! Strengths of forces: constants, inputs, and formulas of what moves.

use crate::model::joint::Joint;
use crate::model::measure::Coordinate;
use crate::model::path::Path;
use crate::model::place::{Moment, Places, vector};
use crate::model::scene::Scene;
use crate::model::spot::Spot;
use crate::number::{Number, number};
use gyro_model::{ForceKind, Formula, Model, Number as PageNumber, Operation, OutputKind, Seen};
use gyro_program::elementary::Function;
use gyro_sim::Scalar;
use std::convert::Infallible;
use std::sync::Arc;

/// A number of a force.
#[derive(Clone, Debug)]
pub(crate) enum Amount<T> {
    Constant(T),
    /// Index into [`crate::Lowered::inputs`], and a factor of 1 or −1.
    Input(usize, T),
    /// A formula, with what stands at each of its operations that has no operands.
    Formula(Arc<(Formula, Vec<Option<Leaf<T>>>)>),
}

/// What a formula begins with.
#[derive(Clone, Debug)]
pub(crate) enum Leaf<T> {
    Constant(T),
    Input(usize, T),
    Time,
    Coordinate(Path<T>),
    Rate(Path<T>),
    /// A number of a pose.
    Pose(Spot<T>, usize),
    /// A number of a velocity.
    Velocity(Spot<T>, usize),
    /// The distance of the ends of the link whose strength it is.
    Length,
    /// The rate of that.
    LengthRate,
}

/// When a strength is asked for, and in a link at which distance of its ends and rate of that.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Now<'a, T: Number> {
    pub(crate) scene: &'a Scene<T>,
    pub(crate) at: Moment<'a, T>,
    pub(crate) line: [T; 2],
}

impl<T: Number> Amount<T> {
    pub(crate) fn new(model: &Model, parts: (&Places<T>, &[Joint<T>]), value: &PageNumber) -> Self {
        match value {
            PageNumber::Input { index, negated } => Self::Input(*index, sign(*negated)),
            PageNumber::Formula(formula) => {
                let leaves = formula.operations.iter().map(|operation| match operation {
                    Operation::Number(PageNumber::Input { index, negated }) => {
                        Some(Leaf::Input(*index, sign(*negated)))
                    }
                    Operation::Number(value) => Some(Leaf::Constant(number(model.value(value)))),
                    Operation::Seen(seen) => Some(Leaf::new(model, parts, *seen)),
                    _ => None,
                });
                Self::Formula(Arc::new((Formula::clone(formula), leaves.collect())))
            }
            PageNumber::Exact(_) | PageNumber::Parameter { .. } | PageNumber::Computed(_) => {
                Self::Constant(number(model.value(value)))
            }
        }
    }

    pub(crate) fn value(&self, now: &Now<'_, T>) -> T {
        match self {
            Self::Constant(value) => *value,
            Self::Input(index, sign) => now.scene.inputs[*index].1 * *sign,
            Self::Formula(formula) => {
                let (formula, leaves) = &**formula;
                value(formula, |place| leaves[place].as_ref().map_or(T::zero(), |leaf| leaf.value(now)))
            }
        }
    }
}

fn sign<T: Number>(negated: bool) -> T {
    if negated { -T::one() } else { T::one() }
}

impl<T: Number> Leaf<T> {
    fn new(model: &Model, (places, joints): (&Places<T>, &[Joint<T>]), seen: Seen) -> Self {
        match seen {
            Seen::Time => Self::Time,
            Seen::Length => Self::Length,
            Seen::LengthRate => Self::LengthRate,
            Seen::Coordinate(on) => {
                Self::Coordinate(Path::Coordinate(Coordinate::of(&joints[on.joint], on.coordinate)))
            }
            Seen::Rate(on) => Self::Rate(Path::Coordinate(Coordinate::of(&joints[on.joint], on.coordinate))),
            Seen::Output { output, number } => match &model.outputs[output].kind {
                OutputKind::Pose(frame) => Self::Pose(Spot::new(model, places, frame), number),
                OutputKind::Velocity(frame) | OutputKind::Inertial(frame) => {
                    Self::Velocity(Spot::new(model, places, frame), number)
                }
                OutputKind::Link { force } => match &model.forces[*force].kind {
                    ForceKind::Link { first, second, .. } => {
                        let end =
                            |(body, point): &(usize, _)| (places.of(*body), vector(model.values(point)));
                        Self::Coordinate(Path::Line([end(first), end(second)]))
                    }
                    _ => unreachable!("the output is one of a link"),
                },
                _ => unreachable!("the reader refuses outputs that follow from forces"),
            },
        }
    }

    fn value(&self, now: &Now<'_, T>) -> T {
        let (scene, at) = (now.scene, now.at);
        match self {
            Self::Constant(value) => *value,
            Self::Input(index, sign) => scene.inputs[*index].1 * *sign,
            Self::Time => at.t,
            Self::Coordinate(path) => path.value(scene, at),
            Self::Rate(path) => path.grip(scene, &path.places(scene).map(|place| scene.motion(at, place))).rate,
            Self::Pose(spot, number) => spot.pose(&scene.motion(at, &spot.place))[*number],
            Self::Velocity(spot, number) => spot.velocity(&scene.motion(at, &spot.place))[*number],
            Self::Length => now.line[0],
            Self::LengthRate => now.line[1],
        }
    }
}

/// The value of a formula, given the numbers that it begins with, by the places of their operations.
fn value<T: Number>(formula: &Formula, leaf: impl Fn(usize) -> T) -> T {
    let value = formula.value(|operation, values: &[T]| {
        Ok::<_, Infallible>(match operation {
            Operation::Number(_) | Operation::Seen(_) => leaf(values.len()),
            Operation::Negative(a) => -values[*a],
            Operation::Sum(a, b) => values[*a] + values[*b],
            Operation::Difference(a, b) => values[*a] - values[*b],
            Operation::Product(a, b) => values[*a] * values[*b],
            Operation::Quotient(a, b) => values[*a] / values[*b],
            Operation::Power(a, exponent) => power(values[*a], *exponent),
            Operation::Call(function, operands) => call(*function, operands.map(|a| values[a])),
        })
    });
    let Ok(value) = value;
    value
}

fn power<T: Number>(base: T, exponent: i32) -> T {
    let power = (0..exponent.unsigned_abs()).fold(T::one(), |power, _| power * base);
    if exponent < 0 { T::one() / power } else { power }
}

fn call<T: Number>(function: Function, [a, b]: [T; 2]) -> T {
    match function {
        Function::Sqrt => Scalar::sqrt(a),
        Function::Sin => Scalar::sin(a),
        Function::Cos => Scalar::cos(a),
        Function::Tanh => Scalar::tanh(a),
        Function::Atan2 => Scalar::atan2(a, b),
        Function::Exp => Scalar::exp(a),
        Function::Ln => Scalar::ln(a),
        Function::Abs => Scalar::abs(a),
        Function::Floor => Scalar::floor(a),
        Function::When => if_positive(a, b, T::zero()),
        Function::Unless => if_positive(a, T::zero(), b),
    }
}

/// The first where this is greater than zero, else the second; neither of what is not a number.
fn if_positive<T: Number>(margin: T, a: T, b: T) -> T {
    if margin > T::zero() {
        a
    } else if margin <= T::zero() {
        b
    } else {
        margin
    }
}
