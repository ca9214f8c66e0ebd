//! Formulas of what joints measure, with derivatives: what coordinates are to be that couplers move.

use crate::model::curves::Curves;
use crate::model::measure::Term;
use crate::number::{Number, call, number};
use gyro_model::{Formula, JointCoordinate, Model, Operation, Seen};
use gyro_program::elementary::Function;
use std::convert::Infallible;

/// A formula of joint coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Tracked<T> {
    formula: Formula,
    curves: Curves,
    /// Of each operation its number, if it is one; zero of others.
    numbers: Vec<T>,
    /// The coordinates, each once.
    pub(crate) terms: Vec<Term<T>>,
    coordinates: Vec<JointCoordinate>,
}

/// Value, first and second derivative.
type Jet<T> = [T; 3];

impl<T: Number> Tracked<T> {
    pub(crate) fn new(model: &Model, formula: &Formula, term: impl Fn(JointCoordinate) -> Term<T>) -> Self {
        let value = |operation: &Operation| match operation {
            Operation::Number(value) => number(model.value(value)),
            _ => T::zero(),
        };
        let coordinates: Vec<_> = formula.uses().map(|(on, _)| on).collect();
        Self {
            formula: formula.clone(),
            curves: Curves::of(model, formula),
            numbers: formula.operations.iter().map(value).collect(),
            terms: coordinates.iter().map(|on| term(*on)).collect(),
            coordinates,
        }
    }

    /// A formula of time alone.
    pub(crate) fn of_time(model: &Model, formula: &Formula) -> Self {
        Self::new(model, formula, |_| unreachable!("the reader allows no coordinates in motions"))
    }

    /// The value with its derivatives, from those of the coordinates in their order and the time.
    pub(crate) fn jet(&self, coordinates: &[Jet<T>], t: T) -> Jet<T> {
        let (zero, two) = (T::zero(), number::<T>(2.0));
        let jet = self.formula.value(|operation, values: &[Jet<T>]| {
            Ok::<_, Infallible>(match operation {
                Operation::Number(_) => [self.numbers[values.len()], zero, zero],
                Operation::Seen(Seen::Coordinate(on)) => {
                    let place = self.coordinates.iter().position(|known| known == on);
                    place.map_or([zero; 3], |place| coordinates[place])
                }
                // The reader allows nothing else.
                Operation::Seen(_) => [t, T::one(), zero],
                Operation::Negative(a) => values[*a].map(|x| -x),
                Operation::Sum(a, b) => [0, 1, 2].map(|k| values[*a][k] + values[*b][k]),
                Operation::Difference(a, b) => [0, 1, 2].map(|k| values[*a][k] - values[*b][k]),
                // (u v)'' = u'' v + 2 u' v' + u v''
                Operation::Product(a, b) => {
                    let ([u, du, ddu], [v, dv, ddv]) = (values[*a], values[*b]);
                    [u * v, du * v + u * dv, ddu * v + two * du * dv + u * ddv]
                }
                // q v = u, differentiated twice.
                Operation::Quotient(a, b) => {
                    let ([u, du, ddu], [v, dv, ddv]) = (values[*a], values[*b]);
                    let q = u / v;
                    let dq = (du - q * dv) / v;
                    [q, dq, (ddu - two * dq * dv - q * ddv) / v]
                }
                Operation::Power(a, n) => {
                    let power = |n: i32| {
                        let size = (0..n.unsigned_abs()).fold(T::one(), |power, _| power * values[*a][0]);
                        if n < 0 { T::one() / size } else { size }
                    };
                    let factor = |n: i32| number::<T>(f64::from(n));
                    let slopes = [factor(*n) * power(n - 1), factor(*n) * factor(n - 1) * power(n - 2)];
                    chain(power(*n), slopes, values[*a])
                }
                Operation::Call(function, operands) => {
                    match self.curves.jet(*function, values[operands[0]][0]) {
                        Some([value, slope, bend]) => chain(value, [slope, bend], values[operands[0]]),
                        None => function_jet(*function, operands.map(|a| values[a])),
                    }
                }
            })
        });
        let Ok(jet) = jet;
        jet
    }

    /// The derivatives by each coordinate.
    pub(crate) fn slopes(&self, coordinates: &[Jet<T>]) -> Vec<T> {
        let one = |by: usize| {
            let seeded = coordinates.iter().enumerate().map(|(place, [value, ..])| {
                [*value, if place == by { T::one() } else { T::zero() }, T::zero()]
            });
            self.jet(&seeded.collect::<Vec<_>>(), T::zero())[1]
        };
        (0..coordinates.len()).map(one).collect()
    }
}

/// `f(x)` by the chain rule, given its derivatives by x.
fn chain<T: Number>(value: T, [slope, bend]: [T; 2], [_, dx, ddx]: Jet<T>) -> Jet<T> {
    [value, slope * dx, bend * dx * dx + slope * ddx]
}

fn function_jet<T: Number>(function: Function, [x, y]: [Jet<T>; 2]) -> Jet<T> {
    let value = call(function, [x[0], y[0]]);
    let (zero, one, two) = (T::zero(), T::one(), number::<T>(2.0));
    let slopes = match function {
        Function::Sqrt => {
            let slope = one / (two * value);
            [slope, -slope / (two * x[0])]
        }
        Function::Sin => [call(Function::Cos, [x[0]; 2]), -value],
        Function::Cos => [-call(Function::Sin, [x[0]; 2]), -value],
        Function::Tanh => {
            let slope = one - value * value;
            [slope, -two * value * slope]
        }
        Function::Exp => [value, value],
        Function::Ln => [one / x[0], -one / (x[0] * x[0])],
        Function::Abs => [if x[0] < zero { -one } else { one }, zero],
        Function::Floor => [zero, zero],
        Function::Curve { .. } => unreachable!("curves are with formulas"),
        // θ' = (x y' − y x') / r² of the point (x, y), and its derivative.
        Function::Atan2 => {
            let ([b, db, ddb], [a, da, dda]) = (x, y);
            let square = a * a + b * b;
            let rate = (a * db - b * da) / square;
            let growth = two * (a * da + b * db);
            return [value, rate, (a * ddb - b * dda - rate * growth) / square];
        }
        Function::When => return if x[0] > zero { y } else { [value, zero, zero] },
        Function::Unless => return if x[0] > zero { [value, zero, zero] } else { y },
    };
    chain(value, slopes, x)
}
