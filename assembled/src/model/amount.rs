//! Strengths of forces: constants, inputs, and formulas of what moves.

use crate::model::between::Frames;
use crate::model::curves::Curves;
use crate::model::jets::{jet, power};
use crate::model::joint::Joint;
use crate::model::measure::Coordinate;
use crate::model::path::Path;
use crate::model::place::{Moment, Places, first_state, vector};
use crate::model::scene::Scene;
use crate::model::spot::Spot;
use crate::number::{Number, call, number};
use gyro_model::{ForceKind, Formula, Model, Number as PageNumber, Operation, OutputKind, Seen};
use std::convert::Infallible;
use std::sync::Arc;

/// A number of a force.
#[derive(Clone, Debug)]
pub(crate) enum Amount<T> {
    Constant(T),
    /// Index into [`crate::Lowered::inputs`], and a factor of 1 or −1.
    Input(usize, T),
    Formula(Arc<Written<T>>),
}

/// A formula, with what stands at each of its operations that has no operands, and the curves that it calls.
#[derive(Clone, Debug)]
pub(crate) struct Written<T> {
    pub(crate) formula: Formula,
    leaves: Vec<Option<Leaf<T>>>,
    curves: Curves,
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
    /// A number of one frame seen from another.
    Relative(Box<Frames<T>>, usize),
    /// The distance of the ends of the link whose strength it is.
    Length,
    /// The rate of that.
    LengthRate,
    /// An element of the state: one of the model file's own.
    State(usize),
    /// A reading of the bushing whose strength it is.
    Between(usize),
    /// The rate of one.
    BetweenRate(usize),
    /// A reading of a bushing.
    Seen(Box<Frames<T>>, usize),
    /// A number among those of all outputs.
    Output(usize),
}

/// When a strength is asked for, in a link at which distance of its ends and rate of that, and in a bushing at which
/// readings and rates of these.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Now<'a, T: Number> {
    pub(crate) scene: &'a Scene<T>,
    pub(crate) at: Moment<'a, T>,
    pub(crate) line: [T; 2],
    pub(crate) frames: Option<&'a [[T; 6]; 2]>,
    /// What is known of the numbers of outputs.
    pub(crate) outputs: &'a [T],
}

impl<'a, T: Number> Now<'a, T> {
    /// Where no link and no bushing is meant, and outputs are not known.
    pub(crate) fn new(scene: &'a Scene<T>, at: Moment<'a, T>) -> Self {
        Self { scene, at, line: [T::zero(); 2], frames: None, outputs: &[] }
    }
}

/// What laws ask of amounts.
pub(crate) trait Read<T> {
    /// The value.
    fn value(&self, amount: &Amount<T>) -> T;
    /// The derivative by one of the numbers that a formula sees.
    fn slope(&self, amount: &Amount<T>, by: Seen) -> T;
}

impl<T: Number> Read<T> for Now<'_, T> {
    fn value(&self, amount: &Amount<T>) -> T {
        amount.value(self)
    }

    fn slope(&self, amount: &Amount<T>, by: Seen) -> T {
        amount.slope(self, by)
    }
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
                let (leaves, curves) = (leaves.collect(), Curves::of(model, formula));
                Self::Formula(Arc::new(Written { formula: Formula::clone(formula), leaves, curves }))
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
            Self::Formula(written) => {
                let value = written.formula.value(|operation, values: &[T]| {
                    Ok::<_, Infallible>(written.operation(operation, values, now))
                });
                let Ok(value) = value;
                value
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
            Seen::Between(k) => Self::Between(k),
            Seen::BetweenRate(k) => Self::BetweenRate(k),
            Seen::Coordinate(on) => {
                Self::Coordinate(Path::Coordinate(Coordinate::of(&joints[on.joint], on.coordinate)))
            }
            Seen::Rate(on) => Self::Rate(Path::Coordinate(Coordinate::of(&joints[on.joint], on.coordinate))),
            Seen::Output { output, number } => match &model.outputs[output].kind {
                OutputKind::Pose(frame) => Self::Pose(Spot::new(model, places, frame), number),
                OutputKind::Velocity(frame) => Self::Velocity(Spot::new(model, places, frame), number),
                OutputKind::Inertial(frame) if number >= 3 => {
                    Self::Velocity(Spot::new(model, places, frame), number)
                }
                OutputKind::Link { force } if number >= 1 => match &model.forces[*force].kind {
                    ForceKind::Link { first, second, .. } => {
                        let end =
                            |(body, point): &(usize, _)| (places.of(*body), vector(model.values(point)));
                        let line = Path::Line([end(first), end(second)]);
                        if number == 1 { Self::Coordinate(line) } else { Self::Rate(line) }
                    }
                    _ => unreachable!("the output is one of a link"),
                },
                OutputKind::Relative(relative) => {
                    let frames = Frames::new(model, places, relative.frames.each_ref());
                    Self::Relative(Box::new(frames), number)
                }
                OutputKind::State { state } => Self::State(first_state(model) + state),
                OutputKind::Bushing { force } if number < 6 => match &model.forces[*force].kind {
                    ForceKind::Bushing(bushing) => {
                        Self::Seen(Box::new(Frames::new(model, places, bushing.ends())), number)
                    }
                    _ => unreachable!("the output is one of a bushing"),
                },
                _ => {
                    let before = model.outputs[..output].iter().map(|output| output.kind.columns().len());
                    Self::Output(before.sum::<usize>() + number)
                }
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
            Self::Rate(path) => {
                path.grip(scene, &path.places(scene).map(|place| scene.motion(at, place))).rate
            }
            Self::Pose(spot, number) => spot.pose(&scene.motion(at, &spot.place))[*number],
            Self::Velocity(spot, number) => spot.velocity(&scene.motion(at, &spot.place))[*number],
            Self::State(place) => at.y[*place],
            Self::Length => now.line[0],
            Self::LengthRate => now.line[1],
            Self::Between(k) => now.frames.map_or(T::zero(), |[places, _]| places[*k]),
            Self::BetweenRate(k) => now.frames.map_or(T::zero(), |[_, rates]| rates[*k]),
            Self::Seen(frames, k) => frames.readings(scene, at).seen[0][*k],
            Self::Relative(frames, k) => frames.relative(scene, at)[*k],
            Self::Output(place) => now.outputs.get(*place).copied().unwrap_or_else(T::zero),
        }
    }
}

impl<T: Number> Amount<T> {
    /// The derivative of a formula by one of the numbers that it sees, which are independent of one another.
    pub(crate) fn slope(&self, now: &Now<'_, T>, by: Seen) -> T {
        let Self::Formula(formula) = self else { return T::zero() };
        let Written { formula, leaves, curves } = &**formula;
        let slope = |place: usize, operation: &Operation| {
            let value = leaves[place].as_ref().map_or(T::zero(), |leaf| leaf.value(now));
            let slope = if *operation == Operation::Seen(by) { T::one() } else { T::zero() };
            [value, slope, T::zero()]
        };
        jet(formula, curves, slope)[1]
    }
}

impl<T: Number> Written<T> {
    /// The value of an operation, given those of the ones before it.
    pub(crate) fn operation(&self, operation: &Operation, values: &[T], now: &Now<'_, T>) -> T {
        match operation {
            Operation::Number(_) | Operation::Seen(_) => {
                self.leaves[values.len()].as_ref().map_or(T::zero(), |leaf| leaf.value(now))
            }
            Operation::Negative(a) => -values[*a],
            Operation::Sum(a, b) => values[*a] + values[*b],
            Operation::Difference(a, b) => values[*a] - values[*b],
            Operation::Product(a, b) => values[*a] * values[*b],
            Operation::Quotient(a, b) => values[*a] / values[*b],
            Operation::Power(a, exponent) => power(values[*a], *exponent),
            Operation::Call(function, operands) => match self.curves.jet(*function, values[operands[0]]) {
                Some([value, ..]) => value,
                None => call(*function, operands.map(|a| values[a])),
            },
        }
    }
}
