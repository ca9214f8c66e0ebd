//! Values of formulas over any scalar, with the model's parameters as they are.

use crate::scalar::Scalar;
use crate::{Formula, JointCoordinate, Model, Operation, Seen, Spline};
use gyro_program::elementary::Function;
use std::convert::Infallible;

/// A formula with the values of its numbers.
#[derive(Clone, Debug)]
pub(crate) struct Sight {
    formula: Formula,
    /// Of each operation that is a number its value; zero of others.
    numbers: Vec<f64>,
    /// Those of the model that it calls, by their places.
    curves: Vec<(u16, Spline)>,
}

impl Sight {
    pub(crate) fn new(model: &Model, formula: &Formula) -> Self {
        let number = |operation: &Operation| match operation {
            Operation::Number(number) => model.value(number),
            _ => 0.0,
        };
        let curve = |place: usize| (place as u16, model.curves[place].spline.clone());
        Self {
            formula: formula.clone(),
            numbers: formula.operations.iter().map(number).collect(),
            curves: formula.curves().map(curve).collect(),
        }
    }

    /// The joint coordinates that it sees.
    pub(crate) fn coordinates(&self) -> impl Iterator<Item = JointCoordinate> {
        self.formula.uses().map(|(on, _)| on)
    }

    /// The value, given joint coordinates and the time, of a formula that sees nothing else: of constraints.
    pub(crate) fn value<D: Scalar>(&self, coordinate: impl Fn(JointCoordinate) -> D, t: D) -> D {
        self.of(|seen| if let Seen::Coordinate(on) = seen { coordinate(on) } else { t })
    }

    /// The value, given all that it sees.
    pub(crate) fn of<D: Scalar>(&self, see: impl Fn(Seen) -> D) -> D {
        let value = self.formula.value(|operation, values: &[D]| {
            Ok::<_, Infallible>(match operation {
                Operation::Number(_) => D::from(self.numbers[values.len()]),
                Operation::Seen(seen) => see(*seen),
                Operation::Negative(a) => -values[*a],
                Operation::Sum(a, b) => values[*a] + values[*b],
                Operation::Difference(a, b) => values[*a] - values[*b],
                Operation::Product(a, b) => values[*a] * values[*b],
                Operation::Quotient(a, b) => values[*a] / values[*b],
                Operation::Power(a, exponent) => values[*a].powi(*exponent),
                Operation::Call(Function::Curve { curve, .. }, [a, _]) => {
                    let spline = self.curves.iter().find(|(place, _)| place == curve);
                    spline.map_or(D::zero(), |(_, spline)| spline.at(values[*a]))
                }
                Operation::Call(function, operands) => call(*function, operands.map(|a| values[a])),
            })
        });
        let Ok(value) = value;
        value
    }
}

fn call<D: Scalar>(function: Function, [a, b]: [D; 2]) -> D {
    let zero = D::zero();
    match function {
        Function::Sqrt => a.sqrt(),
        Function::Sin => a.sin(),
        Function::Cos => a.cos(),
        Function::Tanh => a.tanh(),
        Function::Atan2 => a.atan2(b),
        Function::Exp => a.exp(),
        Function::Ln => a.ln(),
        Function::Abs => {
            if a.re() < 0.0 {
                -a
            } else {
                a
            }
        }
        Function::Floor => D::from(a.re().floor()),
        Function::Curve { .. } => unreachable!("curves are with formulas"),
        Function::When => {
            if a.re() > 0.0 {
                b
            } else {
                zero
            }
        }
        Function::Unless => {
            if a.re() > 0.0 {
                zero
            } else {
                b
            }
        }
    }
}
