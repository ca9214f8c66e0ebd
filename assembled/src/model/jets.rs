//! Formulas with two derivatives, by the rules of differentiation.

use crate::model::curves::Curves;
use crate::number::{Number, call, if_positive, number};
use gyro_model::{Formula, Operation};
use gyro_program::elementary::Function;
use std::convert::Infallible;

/// Value, first and second derivative.
pub(crate) type Jet<T> = [T; 3];

/// The value of a formula with its derivatives, from those of what it begins with: the numbers, and what it sees, each
/// at its place among the operations.
pub(crate) fn jet<T: Number>(
    formula: &Formula,
    curves: &Curves,
    leaf: impl Fn(usize, &Operation) -> Jet<T>,
) -> Jet<T> {
    let two = number::<T>(2.0);
    let jet = formula.value(|operation, values: &[Jet<T>]| {
        Ok::<_, Infallible>(match operation {
            Operation::Number(_) | Operation::Seen(_) => leaf(values.len(), operation),
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
                let (base, factor) = (values[*a][0], |n: i32| number::<T>(f64::from(n)));
                let slope = factor(*n) * power(base, n - 1);
                let bend = factor(*n) * factor(n - 1) * power(base, n - 2);
                chain(power(base, *n), [slope, bend], values[*a])
            }
            Operation::Call(function, operands) => match curves.jet(*function, values[operands[0]][0]) {
                Some([value, slope, bend]) => chain(value, [slope, bend], values[operands[0]]),
                None => function_jet(*function, operands.map(|a| values[a])),
            },
        })
    });
    let Ok(jet) = jet;
    jet
}

/// A power with a whole exponent.
pub(crate) fn power<T: Number>(base: T, exponent: i32) -> T {
    let power = (0..exponent.unsigned_abs()).fold(T::one(), |power, _| power * base);
    if exponent < 0 { T::one() / power } else { power }
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
        Function::Abs => [if_positive(x[0], one, if_positive(-x[0], -one, zero)), zero],
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
        Function::When => return y.map(|y| if_positive(x[0], y, zero)),
        Function::Unless => return y.map(|y| if_positive(x[0], zero, y)),
    };
    chain(value, slopes, x)
}
