use super::*;
use crate::expr::evaluate::evaluate;
use crate::expr::symbol::Symbol;
use gyro_program::elementary::{Parity, Properties};

/// Points at which all functions exist.
const POINTS: [[f64; 2]; 3] = [[0.3, 0.9], [0.8, 0.2], [0.6, 0.6]];

#[test]
fn what_the_table_says_holds_of_the_values() {
    for function in Function::ALL {
        let Properties { name, parity, at_zero, .. } = function.properties();
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

fn exists(function: Function, at: [f64; 2]) -> bool {
    !value(function, at).is_nan()
}

#[test]
fn conditions_keep_what_is_not_taken_out() {
    for taken in [1.5, -2.0, f64::INFINITY] {
        for (condition, is_positive) in
            [(0.1, true), (f64::INFINITY, true), (0.0, false), (-0.0, false), (-3.0, false)]
        {
            let (when, unless) = if is_positive { (taken, 0.0) } else { (0.0, taken) };
            assert_eq!(value(Function::When, [condition, taken]), when, "{condition}");
            assert_eq!(value(Function::Unless, [condition, taken]), unless, "{condition}");
            let other = if is_positive { Function::Unless } else { Function::When };
            assert_eq!(value(other, [condition, f64::NAN]), 0.0, "{condition}");
            assert_eq!(slopes_at(other, [condition, f64::NAN], 0.0), [0.0, 0.0], "{condition}");
        }
        assert!(value(Function::When, [f64::NAN, taken]).is_nan());
        assert!(value(Function::Unless, [f64::NAN, taken]).is_nan());
    }
}

#[test]
fn slopes_of_expressions_are_those_of_numbers() {
    for function in Function::ALL {
        let mut graph = Graph::new();
        let operands = [0, 1].map(|k| graph.symbol(Symbol::Coordinate(k)));
        let call = graph.call(function, operands);
        let slopes = slopes(&mut graph, function, operands, call);
        for point in POINTS.into_iter().chain(POINTS.map(|[x, y]| [-x, y])).filter(|&at| exists(function, at))
        {
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
