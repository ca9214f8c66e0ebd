//! Values and derivatives of the elementary functions.

use crate::expr::graph::{ExprId, Graph};
use gyro_program::elementary::Function;
use num_traits::Float;

/// The value at some operands; of one operand the second one is of no matter.
pub fn value<F: Float>(function: Function, [x, y]: [F; 2]) -> F {
    match function {
        Function::Sqrt => x.sqrt(),
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tanh => x.tanh(),
        Function::Atan2 => x.atan2(y),
    }
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
    }
}

/// The derivatives by both operands as expressions; `call` is the function of them.
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
    };
    [slope, Graph::ZERO]
}

#[cfg(test)]
mod tests;
