//! Formulas of a model as a run has them.

use gyro_model::{Model, Number, Spline, to_f64};
use gyro_program::elementary::Function;
use gyro_runner::{Formula, Operation, Seen};
use gyro_sim::Elementary;

/// A formula in numbers.
pub(crate) fn formula(model: &Model, of: &gyro_model::Formula) -> Formula {
    formula_of(model, of, |what| seen(model, what))
}

/// The same of what it sees.
pub(crate) fn formula_of(
    model: &Model,
    of: &gyro_model::Formula,
    see: impl Fn(gyro_model::Seen) -> Seen,
) -> Formula {
    use gyro_model::Operation as Of;
    let one = |operation: &Of| match operation {
        Of::Number(number) => operand(model, number),
        Of::Seen(what) => Operation::Seen(see(*what)),
        Of::Negative(a) => Operation::Negative(*a),
        Of::Sum(a, b) => Operation::Sum(*a, *b),
        Of::Difference(a, b) => Operation::Difference(*a, *b),
        Of::Product(a, b) => Operation::Product(*a, *b),
        Of::Quotient(a, b) => Operation::Quotient(*a, *b),
        Of::Power(base, exponent) => Operation::Power(*base, *exponent),
        Of::Call(Function::Curve { curve, .. }, [at, _]) => {
            let Spline { knots, pieces, .. } = model.curves[usize::from(*curve)].spline.clone();
            Operation::Curve { knots, pieces, at: *at }
        }
        Of::Call(function, operands) => Operation::Call(elementary(*function), *operands),
    };
    Formula(of.operations.iter().map(one).collect())
}

/// Both tables of elementary functions have one order, see the test.
fn elementary(function: Function) -> Elementary {
    Elementary::ALL[function.place().expect("curves are none of them")]
}

/// A number of a run that may be a formula, of inputs too.
pub(crate) fn number_in_runs(model: &Model, number: &Number) -> Formula {
    match number.formula() {
        Some(of) => formula(model, of),
        None => Formula(vec![operand(model, number)]),
    }
}

/// A number, or an input as it is then.
fn operand(model: &Model, number: &Number) -> Operation {
    match number {
        Number::Input { index, negated } => {
            let default = to_f64(&model.inputs[*index].value);
            Operation::Seen(Seen::Input(*index, default, if *negated { -1.0 } else { 1.0 }))
        }
        number => Operation::Number(model.value(number)),
    }
}

/// What is seen, as a run has it.
pub(crate) fn seen(model: &Model, seen: gyro_model::Seen) -> Seen {
    match seen {
        gyro_model::Seen::Output { output, number } => {
            let before = model.outputs[..output].iter().map(|output| output.kind.columns().len());
            Seen::Output(before.sum::<usize>() + number)
        }
        gyro_model::Seen::Coordinate(on) => Seen::Coordinate(on.joint, on.coordinate),
        gyro_model::Seen::Rate(on) => Seen::Rate(on.joint, on.coordinate),
        gyro_model::Seen::Time => Seen::Time,
        gyro_model::Seen::Length
        | gyro_model::Seen::LengthRate
        | gyro_model::Seen::Between(_)
        | gyro_model::Seen::BetweenRate(_) => {
            unreachable!("what is between the ends of a force is known in its own law only")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn elementary_functions_are_in_one_order() {
        for function in Function::ALL {
            assert_eq!(format!("{function:?}"), format!("{:?}", elementary(function)));
        }
        assert_eq!(Function::ALL.len(), Elementary::ALL.len());
    }
}
