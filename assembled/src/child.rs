//! The runtime-assembled model as a program that answers requests, optimised like the generated one beside which it is
//! measured.

use crate::{BuildError, Careful, Dense, Recursive};
use gyro_model::Model;
use gyro_runner::protocol::Request;
use gyro_runner::{Failure, Summary, child, motion};
use std::io::Write;
use std::process::ExitCode;

/// Answers requests about a model on standard input and output, in the form and the precision of these names:
/// `recursive`, `careful` or `dense`; `f32` or `f64`. See [`gyro_runner::child`].
// Inlined, it is compiled where it is called: most programs never call it.
#[inline]
pub fn main(model: &Model, form: &str, precision: &str) -> ExitCode {
    child::answer_all(|request, output| match (form, precision) {
        ("careful", "f32") => answer(Careful::<f32>::new(model), request, output),
        ("careful", _) => answer(Careful::<f64>::new(model), request, output),
        ("recursive", "f32") => answer(Recursive::<f32>::new(model), request, output),
        ("recursive", _) => answer(Recursive::<f64>::new(model), request, output),
        (_, "f32") => answer(Dense::<f32>::new(model), request, output),
        _ => answer(Dense::<f64>::new(model), request, output),
    })
}

fn answer<M: motion::Maximal + Clone + 'static>(
    mechanism: Result<M, BuildError>,
    request: &Request,
    output: &mut dyn Write,
) -> Result<Summary, Failure> {
    let mut mechanism = mechanism.map_err(|e| Failure::Refused(e.to_string()))?;
    child::answer(&mut mechanism, &motion::Projecting, request, output)
}
