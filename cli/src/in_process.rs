//! Runs of generated mechanisms in this process, compiled there or interpreted.

use crate::args::Precision;
use crate::failure::Failure;
use crate::proof::{self, Proof};
use crate::runs::Runs;
use crate::scene::Scene;
use crate::{interrupt, progress};
use gyro_codegen::Functions;
use gyro_jit::{Compiled, Input, Native, compile_scheduled};
use gyro_runner::{Event, Summary};
use gyro_sim::Real;
use std::io;

/// Generates, compiles and runs; `tell` hears of samples and progress. What runs is proved beside it.
///
/// A run that fails for a reason which a linearisation explains is made again with one, of which the reason is all that
/// is heard, as runs of compiled programs are.
pub(crate) fn simulate(
    scene: &Scene,
    tell: &mut dyn FnMut(Event<'_>),
    proof: &mut Option<Proof>,
) -> Result<Summary, Failure> {
    *proof = None;
    explained(scene, tell, |runs, tell| match scene.precision {
        Precision::F32 => run_in::<f32>(scene, runs, tell, &mut None),
        Precision::F64 => run_in::<f64>(scene, runs, tell, proof),
    })
}

/// The same with whatever makes a run of a kind.
pub(crate) fn explained(
    scene: &Scene,
    tell: &mut dyn FnMut(Event<'_>),
    mut run: impl FnMut(Option<Runs>, &mut dyn FnMut(Event<'_>)) -> Result<Outcome, Failure>,
) -> Result<Summary, Failure> {
    let runs = Runs::of(scene);
    match run(runs, tell)? {
        Err(gyro_runner::Failure::Unexplained(words)) => {
            let is_companion = scene.has_companions && !scene.approach.examine;
            if !is_companion {
                run(runs.map(Runs::examined), &mut |_| ())?.map_err(failed)?;
            }
            Err(Failure::Run(words))
        }
        outcome => outcome.map_err(failed),
    }
}

fn failed(failure: gyro_runner::Failure) -> Failure {
    match failure {
        gyro_runner::Failure::Refused(words) => Failure::Usage(words),
        failure => Failure::Run(failure.to_string()),
    }
}

/// How a run ends.
pub(crate) type Outcome = Result<Summary, gyro_runner::Failure>;

fn run_in<T: Native + Real>(
    scene: &Scene,
    runs: Option<Runs>,
    tell: &mut dyn FnMut(Event<'_>),
    proof: &mut Option<Proof>,
) -> Result<Outcome, Failure> {
    let functions = functions(runs);
    // Of single precision the text is proved where it is generated; machine code is compared in double precision only.
    let proves = scene.proves && T::BITS == 64 && proof.is_none();
    let begun = proves.then(|| Proof::begin(scene, &functions));
    let mut mechanism = compiled::<T>(scene, &functions, begun.as_ref())?;
    *proof = begun.or_else(|| proof.take());
    let _interruptible = interrupt::Run::begin();
    let outcome = follow(scene, runs, &mut mechanism, &mut interrupt::interruptible(tell));
    match outcome {
        Err(gyro_runner::Failure::Output(_)) if interrupt::was_interrupted() => Err(interrupt::failure()),
        outcome => Ok(outcome),
    }
}

/// What is compiled for runs of a kind.
pub(crate) fn functions(runs: Option<Runs>) -> Functions {
    runs.map_or_else(Functions::of_solvers, Runs::functions)
}

/// Makes a run of a scene by a mechanism that has its functions.
pub(crate) fn follow<T: Native + Real>(
    scene: &Scene,
    runs: Option<Runs>,
    mechanism: &mut Compiled<T>,
    tell: &mut dyn FnMut(Event<'_>) -> io::Result<()>,
) -> Outcome {
    for (index, value) in scene.parameters().into_iter().enumerate() {
        mechanism.set_parameter(index, T::constant(value));
    }
    let runs = of_runs(scene, runs);
    gyro_jit::simulate(mechanism, runs, (&scene.settings, &scene.approach), &scene.start, tell)
}

/// What is known of these runs of a scene beside their plan.
pub(crate) fn of_runs(scene: &Scene, runs: Option<Runs>) -> gyro_jit::Runs {
    gyro_jit::Runs {
        joint_space: scene.offers.joint_space,
        is_examined: runs.is_some_and(Runs::is_examined),
        is_for_all: runs.is_none(),
    }
}

/// Generates and compiles these functions; a proof under way hears of what is compiled.
pub(crate) fn compiled<T: Native>(
    scene: &Scene,
    functions: &Functions,
    proof: Option<&Proof>,
) -> Result<Compiled<T>, Failure> {
    let _spinner = progress::deriving(&scene.page);
    let usage = |words: String| Failure::Usage(words);
    let scheduled = gyro_codegen::schedule(&scene.page, functions, scene.effort);
    let scheduled = scheduled.map_err(|error| usage(error.to_string()))?;
    let mut given = proof::Compiled::default();
    let mut told = |input: Input<'_>| given.hear(input);
    let told = proof.map(|_| &mut told as &mut dyn FnMut(Input<'_>));
    let compiled =
        compile_scheduled(&scene.page, scheduled, told).map_err(|error| usage(error.to_string()))?;
    if let Some(proof) = proof {
        proof.compare_with(given);
    }
    Ok(compiled)
}
