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
mod tests {
    use super::*;
    use crate::expr::evaluate::evaluate;
    use crate::expr::symbol::Symbol;
    use gyro_program::elementary::{Parity, Signature};

    /// Points at which all functions exist.
    const POINTS: [[f64; 2]; 3] = [[0.3, 0.9], [0.8, 0.2], [0.6, 0.6]];

    #[test]
    fn what_the_table_says_holds_of_the_values() {
        for function in Function::ALL {
            let Signature { name, parity, at_zero, .. } = function.signature();
            for [x, y] in POINTS {
                let [value, opposite] = [x, -x].map(|x| value(function, [x, y]));
                match parity {
                    Parity::Odd => assert_eq!(opposite, -value, "{name}"),
                    Parity::Even => assert_eq!(opposite, value, "{name}"),
                    Parity::Neither => assert!(opposite.abs() != value.abs(), "{name}"),
                }
            }
            if let Some(at_zero) = at_zero {
                assert_eq!(value(function, [0.0, 0.0]), at_zero as f64, "{name}");
            }
        }
    }

    #[test]
    fn slopes_of_expressions_are_those_of_numbers() {
        for function in Function::ALL {
            let mut graph = Graph::new();
            let operands = [0, 1].map(|k| graph.symbol(Symbol::Coordinate(k)));
            let call = graph.call(function, operands);
            let slopes = slopes(&mut graph, function, operands, call);
            for point in POINTS {
                let at = |symbol| if symbol == Symbol::Coordinate(0) { point[0] } else { point[1] };
                let numbers = slopes_at(function, point, value(function, point));
                for (found, expected) in evaluate(&graph, &slopes, at).into_iter().zip(numbers) {
                    let name = function.name();
                    assert!(
                        (found - expected).abs() < 1e-15 * (1.0 + expected.abs()),
                        "{name}: {found} {expected}"
                    );
                }
            }
        }
    }
}
