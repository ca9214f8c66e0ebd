//! The program that the command line compiles around a generated mechanism: all but its five lines.

use crate::motion::MotionBuilder;
use crate::protocol::{Reply, Request, read, write};
use crate::{Event, Failure, Settings, Summary, run_by, time_by};
use gyro_sim::{Partition, Real};
use std::io::{self, BufWriter, Write};
use std::process::ExitCode;
use std::time::Duration;

/// Reads requests from standard input, one after the other, runs the mechanism that `build` makes of a request's
/// parameters with the builder beside it, and writes the samples to standard output as they come.
///
/// The exit code says whether the last run was complete; the last line of its answer says why not.
pub fn main<M: Partition<Scalar: Real> + Clone + 'static, K: MotionBuilder<M>>(
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
    while let Some(request) = read(&mut input).transpose() {
        let is_readable = request.is_ok();
        let outcome = request.map_err(Failure::Input).and_then(|request| answer(&request, &mut output));
        is_well = outcome.is_ok();
        let last = match outcome {
            Ok(summary) => Reply::Done(summary),
            Err(Failure::Refused(words)) => Reply::Refused(words),
            Err(Failure::Unexplained(words)) => Reply::Unexplained(words),
            Err(failure) => Reply::Failed(failure.to_string()),
        };
        let told = write(&mut output, &last).and_then(|()| output.flush());
        if told.is_err() || !is_readable {
            return ExitCode::FAILURE;
        }
    }
    if is_well { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

/// Runs, and measures if requested: the figures of the run, or the reason why there are none.
///
/// # Errors
/// The failure of the run or of its output.
pub fn answer<M: Partition<Scalar: Real> + Clone + 'static>(
    mechanism: &mut M,
    builder: &dyn MotionBuilder<M>,
    request: &Request,
    output: &mut dyn Write,
) -> Result<Summary, Failure> {
    let plan: (&Settings, _) = (&request.settings, &request.approach);
    let told = |event: Event<'_>| match event {
        Event::Sample(sample) => write(output, &Reply::Sample(sample.clone())),
        Event::Occurred(found) => write(output, &Reply::Occurred(*found)),
        Event::Linear(linear) => write(output, &Reply::Linear(linear.clone())),
        Event::Stopped(t, state) => write(output, &Reply::Stopped(t, state.to_vec())),
        Event::Stiff(t) => write(output, &Reply::Stiff(t)),
        Event::Forecast(forecast) => write(output, &Reply::Forecast(forecast)).and_then(|()| output.flush()),
        Event::Progress(t) => write(output, &Reply::Progress(t)).and_then(|()| output.flush()),
    };
    let summary = run_by(mechanism, builder, plan, &request.start, told)?;
    if let Some(seconds) = request.measure_for {
        let budget = Duration::from_secs_f64(seconds);
        let timing = time_by(mechanism, builder, plan, &request.start, budget)?;
        write(output, &Reply::Timed(timing))?;
    }
    Ok(summary)
}
