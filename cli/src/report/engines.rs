//! Generated code as rustc compiles it beside the same code compiled in the process: what comes before the first step,
//! what a run takes, and whether its bits are the same.

use super::curve::{Curve, Setting, Treatment};
use super::lab::{Lab, Run};
use super::page::Page;
use crate::args::Precision;
use crate::failure::Failure;
use crate::report::curve::Engine;
use crate::words::number;
use crate::{files, nested, runtime};
use gyro_codegen::{Effort, Functions, Module};
use gyro_runner::protocol::{self, Reply, Request};
use gyro_runner::{Correction, Integrator, Sample, Summary, Timing};
use std::fs;
use std::time::{Instant, SystemTime};

/// Both, of one scene.
#[derive(Clone, Debug)]
pub(crate) struct Engines {
    /// Which run was made.
    pub(crate) curve: Curve,
    /// By rustc, then in the process.
    pub(crate) ways: [Way; 2],
    /// Whether all samples of the run have the same bits.
    pub(crate) is_same: bool,
}

/// One of them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Way {
    /// From the model file to the first step, s. A proof, which both can have, is no part of it.
    pub(crate) before: f64,
    /// What the run takes.
    pub(crate) run: Timing,
}

/// Tolerance of the run.
const TOLERANCE: f64 = 1e-9;

/// How long it is measured, s.
const MEASURED: f64 = 0.5;

/// Steps of the run at most.
const BUDGET: u64 = 1_000_000;

/// Compiles a scene both ways and runs it; why there is nothing to compare, if the run is not complete.
pub(crate) fn engines(lab: &mut Lab) -> Result<Result<Engines, String>, Failure> {
    let treatment = match lab.has_joint_coordinates() {
        true => Treatment::Joint,
        false => Treatment::Maximal(Correction::Partition),
    };
    let curve = Curve {
        engine: Engine::Generated,
        precision: Precision::F64,
        integrator: Integrator::Dop853,
        treatment,
    };
    let plan = lab.plan(&curve, Setting::Tolerance(TOLERANCE), BUDGET, Some(MEASURED));
    let rustc = match lab.run((Engine::Generated, Precision::F64), &plan) {
        Ok(run) => run,
        Err(words) => return Ok(Err(words)),
    };
    let (before, ours) = in_process(lab, &lab.request(&plan))?;
    let ours = match ours {
        Ok(run) => run,
        Err(words) => return Ok(Err(words)),
    };
    let timing = |run: &Run| run.timing.unwrap_or_default();
    let is_same = bits(&rustc.samples) == bits(&ours.samples);
    let ways = [(by_rustc(lab)?, timing(&rustc)), (before, timing(&ours))];
    Ok(Ok(Engines { curve, ways: ways.map(|(before, run)| Way { before, run }), is_same }))
}

/// Samples as they are sent: numbers by their bits.
fn bits(samples: &[Sample]) -> Vec<u8> {
    let mut bytes = Vec::new();
    for sample in samples {
        protocol::write(&mut bytes, &Reply::Sample(sample.clone())).expect("memory takes it");
    }
    bytes
}

/// How long it takes to generate and compile the program of a scene, s: anew, whatever is there.
fn by_rustc(lab: &Lab) -> Result<f64, Failure> {
    let began = Instant::now();
    let file = files::shown(&lab.path);
    let module = gyro_codegen::generate_functions(&file, &lab.model, &Functions::of_solvers())
        .map_err(|error| Failure::Usage(error.to_string()))?;
    let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).unwrap_or_default().as_nanos();
    let module = Module {
        code: format!("{}// Compiled to measure how long that takes: {now}.\n", module.code),
        ..module
    };
    let program = nested::unproved(&module, Precision::F64)?;
    let took = began.elapsed().as_secs_f64();
    // What is left of it is of no use to anybody.
    if let (Some(name), Ok(folder)) = (program.file_name(), runtime::folder()) {
        let _ = fs::remove_dir_all(folder.join("programs").join(name));
    }
    let _ = fs::remove_file(program);
    Ok(took)
}

/// The same in this process, and a run.
fn in_process(lab: &Lab, request: &Request) -> Result<(f64, Result<Run, String>), Failure> {
    let usage = |error: Box<dyn std::error::Error>| Failure::Usage(error.to_string());
    let began = Instant::now();
    let mut mechanism =
        gyro_jit::compile::<f64>(&lab.model, &Functions::of_solvers(), Effort::Full).map_err(usage)?;
    let before = began.elapsed().as_secs_f64();
    for (index, value) in request.parameters.iter().enumerate() {
        mechanism.set_parameter(index, *value);
    }
    let runs = gyro_jit::Runs {
        joint_space: lab.has_joint_coordinates(),
        is_examined: false,
        is_for_all: !lab.touches(),
    };
    let mut replies = Vec::new();
    let outcome = gyro_jit::answer(&mut mechanism, runs, request, &mut replies);
    Ok((before, outcome.map_err(|failure| failure.to_string()).and_then(|summary| run(&replies, summary))))
}

/// A run as its replies tell it.
fn run(mut replies: &[u8], summary: Summary) -> Result<Run, String> {
    let (mut samples, mut timing) = (Vec::new(), None);
    while let Some(reply) = protocol::read(&mut replies).map_err(|error| error.to_string())? {
        match reply {
            Reply::Sample(sample) => samples.push(sample),
            Reply::Timed(timed) => timing = Some(timed),
            _ => (),
        }
    }
    Ok(Run { samples, summary, timing })
}

/// The section of a scene's page.
pub(crate) fn write(engines: &Result<Engines, String>, page: &mut Page) {
    page.heading(2, "With and without a compiler");
    let engines = match engines {
        Ok(engines) => engines,
        Err(words) => return page.text(format!("There is nothing to compare: {words}.")),
    };
    let [rustc, ours] = &engines.ways;
    let names = ["compiled by rustc", "compiled in the process (`--engine in-process`)"];
    let row = |(name, way): (&str, &Way)| {
        let evaluations = way.run.statistics.work.evaluations.max(1);
        #[expect(clippy::cast_precision_loss, reason = "counts of evaluations stay below 2⁵³")]
        let each = 1e9 * way.run.measured.seconds / evaluations as f64;
        let per_run = number(1e3 * way.run.measured.seconds, 3);
        vec![name.to_owned(), number(way.before, 3), per_run, number(each, 3)]
    };
    page.table(
        &["", "from model file to first step, s", "run, ms", "each evaluation and its share of the step, ns"],
        names.into_iter().zip([rustc, ours]).map(row).collect(),
    );
    let ratio = ours.run.measured.ratio / rustc.run.measured.ratio;
    let bits = if engines.is_same { "the same bits" } else { "**other bits**" };
    page.text(format!(
        "All functions of solvers, without a proof. The run, at a tolerance of {TOLERANCE:e} ({}), has {bits} in all \
         samples, and takes {} times as long in the process.",
        engines.curve.name(),
        number(ratio, 3)
    ));
}
