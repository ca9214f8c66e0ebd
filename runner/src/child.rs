//! The program that the command line compiles around a generated mechanism: all but its five lines.

use crate::protocol::{Reply, Request, sample_line};
use crate::{Event, Failure, run};
use gyro_sim::Partition;
use std::io::{self, BufWriter, Write};
use std::process::ExitCode;

/// Reads a request from standard input, runs the mechanism that `build` makes of the request's parameters, and writes
/// the samples to standard output as they come.
///
/// The exit code says whether the run was complete; the last line says why not.
pub fn main<M: Partition>(build: impl FnOnce(&[f64]) -> M) -> ExitCode {
    let mut output = BufWriter::new(io::stdout().lock());
    let outcome = answer(build, &mut output);
    let last = match &outcome {
        Ok(reply) | Err(reply) => writeln!(output, "{}", reply.to_line()).and_then(|()| output.flush()),
    };
    if outcome.is_ok() && last.is_ok() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn answer<M: Partition>(build: impl FnOnce(&[f64]) -> M, output: &mut impl Write) -> Result<Reply, Reply> {
    let text = io::read_to_string(io::stdin()).map_err(failed)?;
    let request = Request::parse(&text).map_err(failed)?;
    let mechanism = build(&request.parameters);
    let told = |event: Event<'_>| match event {
        Event::Sample(sample) => writeln!(output, "{}", sample_line(sample)),
        Event::Progress(t) => {
            writeln!(output, "{}", Reply::Progress(t).to_line())?;
            output.flush()
        }
    };
    let summary = run(&mechanism, &request.settings, &request.start, told).map_err(|f: Failure| failed(f))?;
    Ok(Reply::Done(summary))
}

fn failed(why: impl std::fmt::Display) -> Reply {
    Reply::Failed(why.to_string())
}
