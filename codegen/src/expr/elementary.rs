//! Values and derivatives of the elementary functions.

use crate::expr::graph::{ExprId, Graph};
use gyro_program::elementary::Function;
use num_traits::Float;

/// The value at some operands; of one operand the second one is of no matter. Those of curves are in
/// `calls`.
pub fn value<F: Float>(function: Function, [x, y]: [F; 2]) -> F {
    match function {
        Function::Sqrt => x.sqrt(),
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tanh => x.tanh(),
        Function::Atan2 => x.atan2(y),
        Function::Exp => x.exp(),
        Function::Ln => x.ln(),
        Function::Abs => x.abs(),
        Function::Floor => x.floor(),
        // Of a condition that is no number nothing is known.
        Function::When | Function::Unless if x.is_nan() => x,
        Function::When => select(x > F::zero(), y),
        Function::Unless => select(x <= F::zero(), y),
        Function::Curve { .. } => F::nan(),
    }
}

fn select<F: Float>(is_taken: bool, x: F) -> F {
    if is_taken { x } else { F::zero() }
}

/// The derivatives by both operands, where the function has this value.
pub fn slopes_at(function: Function, [x, y]: [f64; 2], value: f64) -> [f64; 2] {
    match function {
        Function::Sqrt => [0.5 / value, 0.0],
        Function::Sin => [x.cos(), 0.0],
        Function::Cos => [-x.sin(), 0.0],
        Function::Tanh => [1.0 - value.powi(2), 0.0],
        Function::Atan2 => {
            let square = x * x + y * y;
            [y / square, -x / square]
        }
        Function::Exp => [value, 0.0],
        Function::Ln => [x.recip(), 0.0],
        Function::Abs => [f64::from(i8::from(x > 0.0) - i8::from(x < 0.0)), 0.0],
        Function::Floor => [0.0, 0.0],
        Function::When | Function::Unless => [0.0, self::value(function, [x, 1.0])],
        Function::Curve { .. } => [f64::NAN, 0.0],
    }
}

/// The derivatives by both operands as expressions; `call` is the function of them. What is chosen by a condition
/// changes as it does where it is chosen: elsewhere its own derivative may be infinite, so that nothing may be
/// multiplied by it (see `differentiate`).
pub fn slopes(graph: &mut Graph, function: Function, [a, b]: [ExprId; 2], call: ExprId) -> [ExprId; 2] {
    let slope = match function {
        Function::Sqrt => {
            let half = graph.fraction(1, 2);
            graph.div(half, call)
        }
        Function::Sin => graph.cos(a),
        Function::Cos => {
            let sin = graph.sin(a);
            graph.neg(sin)
        }
        Function::Tanh => {
            let square = graph.mul(call, call);
            graph.sub(Graph::ONE, square)
        }
        Function::Atan2 => {
            let square = graph.dot(&[b, a], &[b, a]);
            let (by_a, by_b) = (graph.div(b, square), graph.div(a, square));
            return [by_a, graph.neg(by_b)];
        }
        Function::Exp => call,
        Function::Ln => graph.recip(a),
        Function::Abs => {
            let opposite = graph.neg(a);
            let (positive, negative) = (graph.when(a, Graph::ONE), graph.when(opposite, Graph::ONE));
            graph.sub(positive, negative)
        }
        Function::Floor => Graph::ZERO,
        Function::Curve { curve, order } => {
            graph.call(Function::Curve { curve, order: order.saturating_add(1) }, [a; 2])
        }
        Function::When | Function::Unless => {
            return [Graph::ZERO, graph.call(function, [a, Graph::ONE])];
        }
    };
    [slope, Graph::ZERO]
}

#[cfg(test)]
mod tests;
