//! The runtime-assembled model as a program that answers requests, optimised like the generated one beside which it is
//! measured.

use crate::{BuildError, Careful, Dense, Form, Precision, Recursive};
use gyro_model::Model;
use gyro_runner::protocol::Request;
use gyro_runner::{Failure, Summary, child, motion};
use std::io::Write;
use std::process::ExitCode;

/// Answers requests about a model on standard input and output; see [`gyro_runner::child`].
pub fn main(model: &Model, form: Form, precision: Precision) -> ExitCode {
    child::answer_all(|request, output| match (form, precision) {
        (Form::Careful, Precision::Single) => answer(Careful::<f32>::new(model), request, output),
        (Form::Careful, Precision::Double) => answer(Careful::<f64>::new(model), request, output),
        (Form::Recursive, Precision::Single) => answer(Recursive::<f32>::new(model), request, output),
        (Form::Recursive, Precision::Double) => answer(Recursive::<f64>::new(model), request, output),
        (Form::Dense, Precision::Single) => answer(Dense::<f32>::new(model), request, output),
        (Form::Dense, Precision::Double) => answer(Dense::<f64>::new(model), request, output),
    })
}

/// The same with the names of form and precision: `recursive`, `careful` or `dense`; `f32` or `f64`.
pub fn main_by_names(model: &Model, form: &str, precision: &str) -> ExitCode {
    let form = match form {
        "recursive" => Form::Recursive,
        "careful" => Form::Careful,
        _ => Form::Dense,
    };
    let precision = if precision == "f32" { Precision::Single } else { Precision::Double };
    main(model, form, precision)
}

fn answer<M: motion::Maximal + Clone + 'static>(
    mechanism: Result<M, BuildError>,
    request: &Request,
    output: &mut dyn Write,
) -> Result<Summary, Failure> {
    let mut mechanism = mechanism.map_err(|e| Failure::Refused(e.to_string()))?;
    child::answer(&mut mechanism, &motion::Projecting, request, output)
}
