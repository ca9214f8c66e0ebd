use super::*;
use crate::atoms::Elementary;
use crate::interpreter::{Environment, value};
use crate::program::Function;

/// Every operation there is, of one variable, against a central difference.
#[test]
fn rates_are_limits_of_differences() {
    let mut program = Program::default();
    let x = program.push(Node::Read(Source::Time), 1);
    let squared = program.push(Node::Mul(x, x), 1);
    let sum = program.push(Node::Add(squared, x), 1);
    let sin = program.push(Node::Call(Function::Sin, [sum; 2]), 1);
    let cos = program.push(Node::Call(Function::Cos, [squared; 2]), 1);
    let tanh = program.push(Node::Call(Function::Tanh, [sin; 2]), 1);
    let minus = program.push(Node::Neg(tanh), 1);
    let difference = program.push(Node::Sub(minus, sum), 1);
    let root = program.push(Node::Call(Function::Sqrt, [sum; 2]), 1);
    let quotient = program.push(Node::Div(difference, root), 1);
    let angle = program.push(Node::Call(Function::Atan2, [quotient, cos]), 1);
    let exponential = program.push(Node::Call(Function::Exp, [angle; 2]), 1);
    let logarithm = program.push(Node::Call(Function::Ln, [exponential; 2]), 1);
    let negative = program.push(Node::Neg(exponential), 1);
    program.push(Node::Call(Function::Abs, [exponential; 2]), 1);
    program.push(Node::Call(Function::Abs, [negative; 2]), 1);
    // What is no number is not taken.
    let nothing = program.push(Node::Call(Function::Ln, [negative; 2]), 1);
    let taken = program.push(Node::Call(Function::When, [exponential, logarithm]), 1);
    let not_taken = program.push(Node::Call(Function::When, [negative, nothing]), 1);
    program.push(Node::Add(taken, not_taken), 1);
    let taken = program.push(Node::Call(Function::Unless, [negative, logarithm]), 1);
    let not_taken = program.push(Node::Call(Function::Unless, [exponential, nothing]), 1);
    program.push(Node::Add(taken, not_taken), 1);
    for order in [0, 1, 2] {
        program.push(Node::Curve { table: 0, order, time: angle }, 1);
    }
    let points = [(-3.0, 1.0), (0.0, -2.0), (1.0, 4.0), (3.0, 0.0)];
    let tables = [Spline::natural(String::new(), &points).expect("a good table")];
    let at = |program: &Program, t: f64| {
        let read = |_: Source| t;
        let environment = Environment { constants: &[], tables: &tables, atoms: &Elementary, read: &read };
        let mut values: Vec<f64> = Vec::new();
        for node in &program.nodes {
            let number = value(node, &|id| &values[id], &environment).expect("a number");
            values.push(number);
        }
        values
    };
    let (t, step) = (0.7, 1e-6);
    let found = rates(&program, &at(&program, t), &tables, &Elementary, &|_| Some(1.0)).expect("derivatives");
    for (id, (after, before)) in at(&program, t + step).iter().zip(at(&program, t - step)).enumerate() {
        let expected = (after - before) / (2.0 * step);
        let rate = found[id].expect("everything moves");
        if id == nothing {
            continue;
        }
        assert!((rate - expected).abs() < 1e-8 * (1.0 + rate.abs()), "{id}: {rate} {expected}");
    }
    let whole = program.push(Node::Call(Function::Floor, [angle; 2]), 1);
    let found = rates(&program, &at(&program, t), &tables, &Elementary, &|_| Some(1.0)).expect("derivatives");
    assert_eq!(found[whole], None);
    let third = program.push(Node::Curve { table: 0, order: 3, time: angle }, 1);
    let values = at(&program, t);
    let found = rates(&program, &values, &tables, &Elementary, &|_| Some(1.0)).expect("derivatives");
    assert_eq!(found[third], None);
}
