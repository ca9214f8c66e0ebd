//! Formulas of what is seen of a mechanism.

use crate::line::Line;
use gyro_sim::{Elementary, Real};
use nanoserde::{DeBin, SerBin};

/// A number that controllers, events and kinks see.
#[derive(Clone, Copy, Debug, PartialEq, SerBin, DeBin)]
pub enum Seen {
    /// Index among the numbers of all outputs.
    Output(usize),
    /// Indices of a joint and of one of its coordinates, which is no orientation.
    Coordinate(usize, usize),
    /// The rate of such a one.
    Rate(usize, usize),
    /// The time.
    Time,
    /// An input, its value where the run does not set it, and a factor of 1 or −1; of kinks and set points.
    Input(usize, f64, f64),
    /// The distance of two points; of kinks alone.
    Distance(Line),
    /// The rate of that; of kinks alone.
    DistanceRate(Line),
}

/// Arithmetic with numbers of the mechanism: operations one after another, of which the last gives the value. There is
/// at least one.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub struct Formula(pub Vec<Operation>);

/// An operation of a formula. Operands are the places of earlier ones.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub enum Operation {
    /// A constant.
    Number(f64),
    /// A number of the mechanism.
    Seen(Seen),
    /// The other sign.
    Negative(usize),
    /// The sum of both.
    Sum(usize, usize),
    /// The first less the second.
    Difference(usize, usize),
    /// The product of both.
    Product(usize, usize),
    /// The first divided by the second.
    Quotient(usize, usize),
    /// A whole power.
    Power(usize, i32),
    /// An elementary function; of one operand both are the same.
    Call(Elementary, [usize; 2]),
    /// A curve, as the run time has it, of one operand.
    Curve {
        /// Arguments at which its pieces begin, and the last one's end.
        knots: Vec<f64>,
        /// Its pieces.
        pieces: Vec<[f64; 4]>,
        /// The operand.
        at: usize,
    },
}

impl Formula {
    /// Its value; not finite where it divides by zero or has the root of a negative number.
    pub fn value<T: Real>(&self, see: &impl Fn(Seen) -> T) -> T {
        if let [Operation::Number(value)] = self.0[..] {
            return T::constant(value);
        }
        let mut values: Vec<T> = Vec::with_capacity(self.0.len());
        for operation in &self.0 {
            values.push(match operation {
                Operation::Number(value) => T::constant(*value),
                Operation::Seen(seen) => see(*seen),
                Operation::Negative(a) => -values[*a],
                Operation::Sum(a, b) => values[*a] + values[*b],
                Operation::Difference(a, b) => values[*a] - values[*b],
                Operation::Product(a, b) => values[*a] * values[*b],
                Operation::Quotient(a, b) => values[*a] / values[*b],
                Operation::Power(base, exponent) => power(values[*base], *exponent),
                Operation::Curve { knots, pieces, at } => {
                    let [value, ..] = values[*at].spline(knots, pieces);
                    value
                }
                Operation::Call(function, operands) => T::call(*function, operands.map(|a| values[a])),
            });
        }
        values.pop().unwrap_or(T::constant(0.0))
    }
}

/// By repeated squaring.
fn power<T: Real>(base: T, exponent: i32) -> T {
    let (mut square, mut power) = (base, T::constant(1.0));
    let mut rest = exponent.unsigned_abs();
    while rest > 0 {
        if rest & 1 == 1 {
            power = power * square;
        }
        square = square * square;
        rest >>= 1;
    }
    if exponent < 0 { T::constant(1.0) / power } else { power }
}
