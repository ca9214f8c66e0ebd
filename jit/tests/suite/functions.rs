//! Every elementary function goes the whole way from a tape to numbers, whether model files reach it or not.

use super::kernels::{check, check_pairs};
use super::proof::Given;
use gyro_codegen::tape::{Operation, Place};
use gyro_codegen::{Effort, Functions, Scheduled};
use gyro_program::elementary::Function;

/// The mechanism with another function in the place of the hyperbolic tangent. Its second operand, if it has one, is
/// the first number of the tape.
fn replaced(scheduled: &Scheduled, function: Function) -> Scheduled {
    let mut replaced = scheduled.clone();
    let operations = replaced.kernels.values_mut().flat_map(|kernel| &mut kernel.tape.outside.operations);
    for operation in operations {
        if let Operation::Call(called @ Function::Tanh, operands) = operation {
            *called = function;
            if function.arity() == 2 {
                operands[1] = Place(0);
            }
        }
    }
    replaced
}

#[test]
fn functions_are_interpreted_compiled_and_read_back_alike() {
    let text = include_str!("../../../tests/models/friction.toml");
    let model = gyro_model::read("friction", text).unwrap();
    let functions = Functions::usual();
    let module =
        gyro_codegen::generate_by_effort("friction.toml", &model, &functions, Effort::Quick).unwrap();
    let scheduled = gyro_codegen::schedule(&model, &functions, Effort::Quick).unwrap();
    assert!(module.code.contains(".tanh()"));
    for function in Function::ALL {
        let scheduled = replaced(&scheduled, function);
        check::<f64>(function.name(), &model, &scheduled);
        check::<f32>(function.name(), &model, &scheduled);
        check_pairs(function.name(), &model, &scheduled);
        // The text of what has two operands would be another one.
        if function.arity() == 1 {
            let mut module = module.clone();
            module.code = module.code.replace(".tanh()", &format!(".{}()", function.name()));
            let given = Given::of_scheduled(model.clone(), module, scheduled);
            assert_eq!(given.is_accepted(), Ok(given.n_functions()), "{}", function.name());
        }
    }
}
