//! `answer`: the runtime-assembled model as a program, beside which the report measures generated code.

use crate::args::AnswerArgs;
use crate::failure::Failure;
use crate::scene;

/// Answers requests with the runtime-assembled model.
pub(crate) fn answer(args: &AnswerArgs) -> Result<(), Failure> {
    let mut model = scene::read(&args.model)?;
    model.counts_work = true;
    // Whoever asks has heard of a failure.
    gyro_assembled::child::main(&model, &args.form, &args.precision);
    Ok(())
}
