//! Derivatives of programs by dual numbers.

use crate::atoms::{Atoms, quotient, rate_of_call, sum};
use crate::field::Field;
use crate::program::{Node, Program, Source};
use gyro_model::Spline;

/// The derivative of each node of a program, its nodes' values and the derivatives of what it reads being given; `None`
/// where that is zero by structure.
///
/// Nothing if a second derivative of a table's curve would have to be differentiated.
pub fn rates<F: Field>(
    program: &Program,
    values: &[F],
    tables: &[Spline],
    atoms: &dyn Atoms<F>,
    of_source: &dyn Fn(Source) -> Option<F>,
) -> Option<Vec<Option<F>>> {
    let mut rates: Vec<Option<F>> = Vec::with_capacity(values.len());
    for (node, value) in program.nodes.iter().zip(values) {
        let rate = |id: usize| rates[id].as_ref();
        let times = |id: usize, factor: &F| rate(id).map(|rate| rate.mul(factor));
        let derivative = match *node {
            Node::Constant(_) => None,
            Node::Read(source) => of_source(source),
            Node::Add(a, b) => sum(rate(a).cloned(), rate(b).cloned()),
            Node::Sub(a, b) => sum(rate(a).cloned(), rate(b).map(F::neg)),
            Node::Mul(a, b) => sum(times(a, &values[b]), times(b, &values[a])),
            Node::Neg(a) => rate(a).map(F::neg),
            Node::Div(a, b) => {
                let change = sum(rate(a).cloned(), times(b, value).map(|x| x.neg()));
                quotient(change, &values[b])?
            }
            Node::Call(function, operands) => {
                let (given, moved) = (operands.map(|id| &values[id]), operands.map(rate));
                rate_of_call(function, (given, value), moved, atoms)?
            }
            Node::Curve { table, order, time } => match rate(time) {
                Some(rate) => {
                    // The third derivative is constant but where it jumps.
                    let slopes = atoms.spline(&tables[table], &values[time]);
                    slopes.get(order + 1).map(|slope| slope.mul(rate))
                }
                None => None,
            },
        };
        rates.push(derivative);
    }
    Some(rates)
}

#[cfg(test)]
mod tests;
