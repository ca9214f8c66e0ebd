//! The program that the command line compiles around a generated mechanism: all but its five lines.

use crate::motion::Kit;
use crate::protocol::{Reply, Request, sample_line};
use crate::{Event, Summary, run_by};
use gyro_sim::{Partition, Ports};
use std::io::{self, BufWriter, Write};
use std::process::ExitCode;

/// Reads a request from standard input, runs the mechanism that `build` makes of the request's parameters with the kit beside it, and
/// writes the samples to standard output as they come.
///
/// The exit code says whether the run was complete; the last line says why not.
pub fn main<M: Partition + Ports + 'static, K: Kit<M>>(build: impl FnOnce(&[f64]) -> (M, K)) -> ExitCode {
    let mut output = BufWriter::new(io::stdout().lock());
    let outcome = answer(build, &mut output);
    let is_complete = outcome.is_ok();
    let last = outcome.map_or_else(Reply::Failed, Reply::Done);
    let told = writeln!(output, "{}", last.to_line()).and_then(|()| output.flush());
    if is_complete && told.is_ok() { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The figures of the run, or in words why there are none.
fn answer<M: Partition + Ports + 'static, K: Kit<M>>(
    build: impl FnOnce(&[f64]) -> (M, K),
    output: &mut impl Write,
) -> Result<Summary, String> {
    let text = io::read_to_string(io::stdin()).map_err(|e| e.to_string())?;
    let request = Request::parse(&text).map_err(|e| e.to_string())?;
    let (mut mechanism, kit) = build(&request.parameters);
    let told = |event: Event<'_>| match event {
        Event::Sample(sample) => writeln!(output, "{}", sample_line(sample)),
        Event::Linear(linear) => writeln!(output, "{}", Reply::Linear(linear.clone()).to_line()),
        Event::Progress(t) => {
            writeln!(output, "{}", Reply::Progress(t).to_line())?;
            output.flush()
        }
    };
    run_by(&mut mechanism, &kit, (&request.settings, &request.approach), &request.start, told)
        .map_err(|e| e.to_string())
}
