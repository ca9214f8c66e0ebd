//! Strengths of forces that are formulas, see [`gyro_model::Formula`].

use crate::derive::between::{self, Between};
use crate::derive::joint_coordinate;
use crate::derive::points::{self, PointOfBody};
use crate::derive::system::System;
use crate::expr::elementary;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use gyro_model::{ForceKind, Formula, JointCoordinate, Number, Operation, OutputKind, Seen};
use gyro_program::elementary::Function;
use std::convert::Infallible;

/// What laws read of joint coordinates.
pub trait Readings {
    /// The joint coordinate; of an angle its continuous value.
    fn value(&self, system: &mut System, on: JointCoordinate) -> ExprId;
    /// Its rate.
    fn rate(&self, system: &mut System, on: JointCoordinate) -> ExprId;
}

/// Joint coordinates in terms of maximal ones.
pub struct OfBodies;

impl Readings for OfBodies {
    fn value(&self, system: &mut System, on: JointCoordinate) -> ExprId {
        joint_coordinate::value(system, on)
    }

    fn rate(&self, system: &mut System, on: JointCoordinate) -> ExprId {
        joint_coordinate::rate(system, on)
    }
}

/// The distance of a link's ends, and its rate.
pub struct Line {
    pub length: ExprId,
    pub rate: ExprId,
}

/// What the laws of links and bushings see of their own ends.
#[derive(Clone, Copy)]
pub enum Own<'o> {
    Nothing,
    Line(&'o Line),
    /// Six readings and their rates.
    Frames([&'o [ExprId; 6]; 2]),
}

/// A strength.
pub fn strength(system: &mut System, readings: &impl Readings, number: &Number) -> ExprId {
    read(system, readings, Own::Nothing, number)
}

/// A strength of a link or of a bushing.
pub fn own_strength(system: &mut System, own: Own<'_>, number: &Number) -> ExprId {
    read(system, &OfBodies, own, number)
}

fn read(system: &mut System, readings: &impl Readings, own: Own<'_>, number: &Number) -> ExprId {
    let Number::Formula(formula) = number else { return system.number(number) };
    value(system, formula, |system, seen| see(system, readings, own, seen))
}

/// A number of the mechanism, before accelerations are known.
pub fn see(system: &mut System, readings: &impl Readings, own: Own<'_>, seen: Seen) -> ExprId {
    match (seen, own) {
        (Seen::Coordinate(on), _) => readings.value(system, on),
        (Seen::Rate(on), _) => readings.rate(system, on),
        (Seen::Time, _) => system.graph.symbol(Symbol::Time),
        (Seen::Output { output, number }, _) => of_output(system, output, number),
        (Seen::Length, Own::Line(line)) => line.length,
        (Seen::LengthRate, Own::Line(line)) => line.rate,
        (Seen::Between(k), Own::Frames([places, _])) => places[k],
        (Seen::BetweenRate(k), Own::Frames([_, rates])) => rates[k],
        (Seen::Length | Seen::LengthRate | Seen::Between(_) | Seen::BetweenRate(_), _) => {
            unreachable!("the reader knows what is between ends in their own laws only")
        }
    }
}

/// A number of an output of position or velocity, or a state.
fn of_output(system: &mut System, output: usize, number: usize) -> ExprId {
    match &system.model.outputs[output].kind {
        OutputKind::State { state } => system.graph.symbol(Symbol::State(*state)),
        OutputKind::Pose(frame) => points::pose(system, frame)[number],
        OutputKind::Velocity(frame) => points::velocity(system, frame)[number],
        OutputKind::Relative(relative) => {
            between::Seen::new(system, relative.frames.each_ref()).numbers()[number]
        }
        // Of these the rates alone.
        OutputKind::Inertial(frame) => {
            let w = system.poses[frame.body].w;
            points::by_axes(system, frame, w)[number - 3]
        }
        OutputKind::Link { force } => match &system.model.forces[*force].kind {
            ForceKind::Link { first, second, .. } => {
                let [from, to] = [first, second].map(|(body, point)| PointOfBody::new(system, *body, point));
                let graph = &mut system.graph;
                let line = graph.sub_vec(&to.position, &from.position);
                let square = graph.dot(&line, &line);
                let length = graph.sqrt(square);
                if number == 1 {
                    return length;
                }
                let drift = graph.sub_vec(&to.velocity, &from.velocity);
                let product = graph.dot(&line, &drift);
                graph.div(product, length)
            }
            _ => unreachable!("the output is one of a link"),
        },
        OutputKind::Bushing { force } => match &system.model.forces[*force].kind {
            ForceKind::Bushing(bushing) => Between::new(system, bushing).places[number],
            _ => unreachable!("the output is one of a bushing"),
        },
        _ => unreachable!("the reader refuses outputs that follow from forces"),
    }
}

/// The expression that a formula denotes, with what it sees.
pub fn value(
    system: &mut System,
    formula: &Formula,
    mut see: impl FnMut(&mut System, Seen) -> ExprId,
) -> ExprId {
    let value = formula.value(|operation, values: &[ExprId]| {
        Ok::<_, Infallible>(one(system, operation, |place| values[place], &mut see))
    });
    let Ok(value) = value;
    value
}

/// The value of one operation.
fn one(
    system: &mut System,
    operation: &Operation,
    of: impl Fn(usize) -> ExprId,
    mut see: impl FnMut(&mut System, Seen) -> ExprId,
) -> ExprId {
    match operation {
        Operation::Number(number) => system.number(number),
        Operation::Seen(seen) => see(system, *seen),
        Operation::Negative(a) => system.graph.neg(of(*a)),
        Operation::Sum(a, b) => system.graph.add(of(*a), of(*b)),
        Operation::Difference(a, b) => system.graph.sub(of(*a), of(*b)),
        Operation::Product(a, b) => system.graph.mul(of(*a), of(*b)),
        Operation::Quotient(a, b) => system.graph.div(of(*a), of(*b)),
        Operation::Power(a, exponent) => power(system, of(*a), *exponent),
        Operation::Call(function, operands) => {
            let function = called(system, *function);
            system.graph.call(function, operands.map(of))
        }
    }
}

/// A function with the place of a curve's table.
fn called(system: &mut System, function: Function) -> Function {
    match function {
        Function::Curve { curve, order } => {
            let model = system.model;
            Function::curve(system.table(&model.curves[usize::from(curve)].spline), order)
        }
        function => function,
    }
}

/// The value of a formula and its derivative by one of the numbers that it sees, which are independent of one another.
pub fn with_slope(
    system: &mut System,
    formula: &Formula,
    readings: &impl Readings,
    by: Seen,
) -> (ExprId, ExprId) {
    let slope = |_: &mut System, seen: Seen, _: ExprId| if seen == by { Graph::ONE } else { Graph::ZERO };
    with_derivative(system, formula, readings, slope)
}

/// The value of a formula and its derivative along what each number that it sees changes by, given the number.
pub fn with_derivative(
    system: &mut System,
    formula: &Formula,
    readings: &impl Readings,
    mut change: impl FnMut(&mut System, Seen, ExprId) -> ExprId,
) -> (ExprId, ExprId) {
    let pair = formula.value(|operation, values: &[(ExprId, ExprId)]| {
        let value_of = |place: usize| values[place].0;
        let slope_of = |place: usize| values[place].1;
        let value =
            one(system, operation, value_of, |system, seen| see(system, readings, Own::Nothing, seen));
        if let Operation::Seen(seen) = operation {
            return Ok((value, change(system, *seen, value)));
        }
        let called = if let Operation::Call(of, _) = operation { Some(called(system, *of)) } else { None };
        let graph = &mut system.graph;
        let slope = match operation {
            Operation::Number(_) | Operation::Seen(_) => Graph::ZERO,
            Operation::Negative(a) => graph.neg(slope_of(*a)),
            Operation::Sum(a, b) => graph.add(slope_of(*a), slope_of(*b)),
            Operation::Difference(a, b) => graph.sub(slope_of(*a), slope_of(*b)),
            Operation::Product(a, b) => {
                graph.dot(&[slope_of(*a), value_of(*a)], &[value_of(*b), slope_of(*b)])
            }
            // (a/b)' = (a' − (a/b) b') / b
            Operation::Quotient(a, b) => {
                let taken = graph.mul(value, slope_of(*b));
                let rest = graph.sub(slope_of(*a), taken);
                graph.div(rest, value_of(*b))
            }
            // (aⁿ)' = n aⁿ⁻¹ a'
            Operation::Power(a, exponent) => {
                let factor = graph.integer(i64::from(*exponent));
                let less = power(system, value_of(*a), exponent - 1);
                let factor = system.graph.mul(factor, less);
                system.graph.mul(factor, slope_of(*a))
            }
            // What is not taken may change infinitely fast: it must not be multiplied by zero.
            Operation::Call(function @ (Function::When | Function::Unless), [condition, taken]) => {
                graph.call(*function, [value_of(*condition), slope_of(*taken)])
            }
            Operation::Call(function, operands) => {
                let function = called.unwrap_or(*function);
                let slopes = elementary::slopes(graph, function, operands.map(value_of), value);
                graph.dot(&slopes, &operands.map(slope_of))
            }
        };
        Ok::<_, Infallible>((value, slope))
    });
    let Ok(pair) = pair;
    pair
}

fn power(system: &mut System, base: ExprId, exponent: i32) -> ExprId {
    let power = system.power(base, exponent.unsigned_abs());
    if exponent < 0 { system.graph.div(Graph::ONE, power) } else { power }
}
