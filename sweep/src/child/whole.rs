//! Scenarios as whole runs, as `simulate` makes them.

use super::{Common, Job, Outsets, Runs, Scenarios, note, serve};
use crate::keep::Keeper;
use crate::record::Block;
use gyro_runner::motion::MotionBuilder;
use gyro_runner::{
    Approach, Event, Failure, Measure, Sample, Settings, Start, Summary, closely, companions, judge, run_by,
};
use gyro_sim::{Partition, Real};
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

/// Runs scenarios with the mechanism that `build` makes of parameters, and the builder beside it.
pub fn whole<M: Partition<Scalar: Real> + Clone + 'static, K: MotionBuilder<M> + 'static>(
    build: impl Fn(&[f64]) -> (M, K) + 'static,
) -> ExitCode {
    serve(|job| Scenarios::new(job, begin(job, by(build))))
}

/// What a run is told of: samples, and how far it is.
type Tell<'a> = &'a mut dyn FnMut(Event<'_>) -> io::Result<()>;

/// Makes a run from a scenario's parameters, schedule, method and start.
pub(crate) type Run = dyn Fn(&[f64], (&Settings, &Approach), &Start, Tell<'_>) -> Result<Summary, Failure>;

/// Runs by the mechanism that `build` makes of parameters, and the builder beside it.
pub(super) fn by<M, K>(build: impl Fn(&[f64]) -> (M, K) + 'static) -> Box<Run>
where
    M: Partition<Scalar: Real> + Clone + 'static,
    K: MotionBuilder<M>,
{
    Box::new(move |parameters, plan, start, tell| {
        let (mut mechanism, builder) = build(parameters);
        run_by(&mut mechanism, &builder, plan, start, tell)
    })
}

pub(crate) fn begin(job: &'static Job, run: Box<Run>) -> impl Runs {
    Whole { common: Common::new(job), run }
}

struct Whole {
    common: Common,
    run: Box<Run>,
}

impl Runs for Whole {
    fn run(&mut self, block: &mut Block, from: Outsets<'_>) {
        let common = &mut self.common;
        for row in 0..block.count {
            common.draw(block.first + u64::from(row));
            common.keeper.moved = from.moved.get(row as usize).cloned().unwrap_or_default();
            let outcome = match from.starts.get(row as usize) {
                Some(Err(words)) => Err(words.clone()),
                Some(Ok(start)) => scenario(common, &*self.run, start.clone()),
                None => scenario(common, &*self.run, common.job.start.clone()),
            };
            common.keeper.finish(outcome.is_ok(), &mut block.numbers);
            if let Err(words) = outcome {
                note(block, row, &words);
            }
        }
    }
}

/// Runs one; a fault of the program's own is an error of this scenario alone.
fn scenario(common: &mut Common, run: &Run, start: Start) -> Result<(), String> {
    let Common { job, keeper, parameters, inputs: varied, .. } = common;
    let mut inputs = job.start.inputs.clone();
    inputs.extend_from_slice(varied);
    let start = Start { inputs, ..start };
    let run = || match job.measure {
        None => run_kept(job, parameters, run, &start, keeper),
        Some(measure) => run_judged(job, measure, (parameters, run), &start, keeper),
    };
    match catch_unwind(AssertUnwindSafe(run)) {
        Ok(outcome) => outcome.map_err(words),
        Err(_) => Err("the program panicked: this is a mistake in gyro-sim".to_owned()),
    }
}

fn words(failure: Failure) -> String {
    match failure {
        Failure::Run { words, .. } => words,
        other => other.to_string(),
    }
}

fn run_kept(
    job: &Job,
    parameters: &[f64],
    run: &Run,
    start: &Start,
    keeper: &mut Keeper<'_>,
) -> Result<(), Failure> {
    let mut tell = |event: Event<'_>| {
        if let Event::Sample(sample) = event {
            keeper.sample(sample);
        }
        Ok(())
    };
    run(parameters, (&job.settings, &job.approach), start, &mut tell).map(|_| ())
}

type Samples = (Vec<Sample>, Summary);

fn run_judged(
    job: &Job,
    (size, is_balanced): (f64, bool),
    (parameters, run): (&[f64], &Run),
    start: &Start,
    keeper: &mut Keeper<'_>,
) -> Result<(), Failure> {
    let run = |settings: &Settings, approach: &Approach| -> Result<Samples, Failure> {
        let mut samples = Vec::new();
        let mut tell = |event: Event<'_>| {
            if let Event::Sample(sample) = event {
                samples.push(sample.clone());
            }
            Ok(())
        };
        let summary = run(parameters, (settings, approach), start, &mut tell)?;
        Ok((samples, summary))
    };
    let (samples, summary) = run(&job.settings, &job.approach)?;
    samples.iter().for_each(|sample| keeper.sample(sample));
    let measure = Measure { tolerance: job.approach.tolerance, size, is_balanced };
    for (settings, approach) in companions(&job.settings, &job.approach) {
        let settings = closely(&settings, &approach);
        if let Ok((others, other)) = run(&settings, &Approach { patience: None, ..approach }) {
            keeper.estimate = judge((&samples, &summary), (&others, &other), &measure).relative;
            break;
        }
    }
    Ok(())
}
