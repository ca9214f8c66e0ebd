//! The program that the command line compiles around a generated mechanism: all but its five lines.

use crate::motion::MotionBuilder;
use crate::protocol::{END, Reply, Request, sample_line};
use crate::{Event, Failure, Settings, Summary, run_by, time_by};
use gyro_sim::{Partition, Ports};
use std::io::{self, BufRead, BufWriter, Write};
use std::process::ExitCode;
use std::time::Duration;

/// Reads requests from standard input, one after the other, runs the mechanism that `build` makes of a request's
/// parameters with the builder beside it, and writes the samples to standard output as they come.
///
/// The exit code says whether the last run was complete; the last line of its answer says why not.
pub fn main<M: Partition + Ports + 'static, K: MotionBuilder<M>>(
    build: impl Fn(&[f64]) -> (M, K),
) -> ExitCode {
    answer_all(|request, output| {
        let (mut mechanism, builder) = build(&request.parameters);
        answer(&mut mechanism, &builder, request, output)
    })
}

/// The same for whatever can answer a request.
pub fn answer_all(mut answer: impl FnMut(&Request, &mut dyn Write) -> Result<Summary, Failure>) -> ExitCode {
    let mut input = io::stdin().lock();
    let mut output = BufWriter::new(io::stdout().lock());
    let mut is_well = true;
    while let Some(text) = request_text(&mut input) {
        let request = text.and_then(|text| Request::parse(&text).map_err(|e| Failure::run(e.to_string())));
        let outcome = request.and_then(|request| answer(&request, &mut output));
        is_well = outcome.is_ok();
        let last = match outcome {
            Ok(summary) => Reply::Done(summary),
            Err(Failure::Refused(words)) => Reply::Refused(words),
            Err(failure) => Reply::Failed(failure.to_string()),
        };
        let told = writeln!(output, "{}", last.to_line()).and_then(|()| output.flush());
        if told.is_err() {
            return ExitCode::FAILURE;
        }
    }
    if is_well { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// The lines up to the end of a request; `None` when nothing comes any more.
fn request_text(input: &mut impl BufRead) -> Option<Result<String, Failure>> {
    let mut text = String::new();
    loop {
        let began = text.len();
        match input.read_line(&mut text) {
            Ok(0) => return (!text.is_empty()).then_some(Ok(text)),
            Ok(_) if text[began..].trim_end() == END => return Some(Ok(text)),
            Ok(_) => (),
            Err(error) => return Some(Err(Failure::Output(error))),
        }
    }
}

/// Runs, and measures if that is asked for: the figures of the run, or in words why there are none.
///
/// # Errors
/// The failure of the run or of its output.
pub fn answer<M: Partition + Ports + 'static>(
    mechanism: &mut M,
    builder: &dyn MotionBuilder<M>,
    request: &Request,
    output: &mut dyn Write,
) -> Result<Summary, Failure> {
    let plan: (&Settings, _) = (&request.settings, &request.approach);
    let told = |event: Event<'_>| match event {
        Event::Sample(sample) => writeln!(output, "{}", sample_line(sample)),
        Event::Linear(linear) => writeln!(output, "{}", Reply::Linear(linear.clone()).to_line()),
        Event::Stopped(t, state) => writeln!(output, "{}", Reply::Stopped(t, state.to_vec()).to_line()),
        Event::Forecast(forecast) => {
            writeln!(output, "{}", Reply::Forecast(forecast).to_line())?;
            output.flush()
        }
        Event::Progress(t) => {
            writeln!(output, "{}", Reply::Progress(t).to_line())?;
            output.flush()
        }
    };
    let summary = run_by(mechanism, builder, plan, &request.start, told)?;
    if let Some(seconds) = request.measure_for {
        let budget = Duration::from_secs_f64(seconds);
        let timing = time_by(mechanism, builder, plan, &request.start, budget)?;
        writeln!(output, "{}", Reply::Timed(timing).to_line())?;
    }
    Ok(summary)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_end_with_a_line_of_their_own_or_with_the_input() {
        let mut input = "settings 1 2\nend\nwhen x\nendless\n".as_bytes();
        let texts: Vec<_> = std::iter::from_fn(|| request_text(&mut input)).map(Result::unwrap).collect();
        assert_eq!(texts, ["settings 1 2\nend\n", "when x\nendless\n"]);
    }
}
