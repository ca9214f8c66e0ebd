//! Scenarios as whole runs, as `simulate` makes them.

use super::{Common, Job, Outsets, Runs, note, serve};
use crate::keep::Keeper;
use crate::record::Block;
use gyro_runner::motion::MotionBuilder;
use gyro_runner::{
    Approach, Event, Failure, Measure, Sample, Settings, Start, Summary, closely, companions, judge, run_by,
};
use gyro_sim::{Partition, Real};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::process::ExitCode;

/// Runs scenarios with the mechanism that `build` makes of parameters, and the builder beside it.
pub fn whole<M: Partition<Scalar: Real> + Clone + 'static, K: MotionBuilder<M>>(
    build: impl Fn(&[f64]) -> (M, K),
) -> ExitCode {
    serve(|job| begin(job, build))
}

pub(super) fn begin<M: Partition<Scalar: Real> + Clone + 'static, K: MotionBuilder<M>>(
    job: &'static Job,
    build: impl Fn(&[f64]) -> (M, K),
) -> impl Runs {
    Whole { common: Common::new(job), build }
}

struct Whole<B> {
    common: Common,
    build: B,
}

impl<M, K, B> Runs for Whole<B>
where
    M: Partition<Scalar: Real> + Clone + 'static,
    K: MotionBuilder<M>,
    B: Fn(&[f64]) -> (M, K),
{
    fn run(&mut self, block: &mut Block, from: Outsets<'_>) {
        let common = &mut self.common;
        for row in 0..block.count {
            common.draw(block.first + u64::from(row));
            common.keeper.moved = from.moved.get(row as usize).cloned().unwrap_or_default();
            let outcome = match from.starts.get(row as usize) {
                Some(Err(words)) => Err(words.clone()),
                Some(Ok(start)) => scenario(common, &self.build, start.clone()),
                None => scenario(common, &self.build, common.job.start.clone()),
            };
            common.keeper.finish(outcome.is_ok(), &mut block.numbers);
            if let Err(words) = outcome {
                note(block, row, &words);
            }
        }
    }
}

/// Runs one; a fault of the program's own is an error of this scenario alone.
fn scenario<M, K>(common: &mut Common, build: impl Fn(&[f64]) -> (M, K), start: Start) -> Result<(), String>
where
    M: Partition<Scalar: Real> + Clone + 'static,
    K: MotionBuilder<M>,
{
    let Common { job, keeper, parameters, inputs: varied, .. } = common;
    let mut inputs = job.start.inputs.clone();
    inputs.extend_from_slice(varied);
    let start = Start { inputs, ..start };
    let run = || {
        let (mut mechanism, builder) = build(parameters);
        match job.measure {
            None => run_kept(&mut mechanism, &builder, (&job.settings, &job.approach), &start, keeper),
            Some(measure) => run_judged(job, measure, (&mut mechanism, &builder), &start, keeper),
        }
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

fn run_kept<M: Partition<Scalar: Real> + Clone + 'static>(
    mechanism: &mut M,
    builder: &dyn MotionBuilder<M>,
    plan: (&Settings, &Approach),
    start: &Start,
    keeper: &mut Keeper<'_>,
) -> Result<(), Failure> {
    let tell = |event: Event<'_>| {
        if let Event::Sample(sample) = event {
            keeper.sample(sample);
        }
        Ok(())
    };
    run_by(mechanism, builder, plan, start, tell).map(|_| ())
}

type Samples = (Vec<Sample>, Summary);

fn run_judged<M: Partition<Scalar: Real> + Clone + 'static>(
    job: &Job,
    (size, is_balanced): (f64, bool),
    (mechanism, builder): (&mut M, &dyn MotionBuilder<M>),
    start: &Start,
    keeper: &mut Keeper<'_>,
) -> Result<(), Failure> {
    let mut run = |settings: &Settings, approach: &Approach| -> Result<Samples, Failure> {
        let mut samples = Vec::new();
        let tell = |event: Event<'_>| {
            if let Event::Sample(sample) = event {
                samples.push(sample.clone());
            }
            Ok(())
        };
        let summary = run_by(mechanism, builder, (settings, approach), start, tell)?;
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
