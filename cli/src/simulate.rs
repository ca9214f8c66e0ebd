//! `cargo xtask simulate`.

use crate::args::{Engine, Precision, SimulateArgs};
use crate::failure::Failure;
use crate::folder::Folder;
use crate::progress::Progress;
use crate::proof::{Proof, Standing};
use crate::remarks::say;
use crate::scene::Scene;
use crate::verdict::{self, Outcome, Verdict};
use crate::write::{self, Known};
use crate::{
    columns, events, in_process, interrupt, json, lapse, linearization, nested, plot, remarks, summary, words,
};
use gyro_assembled::{QuickLookError, quick_look};
use gyro_codegen::Module;
use gyro_runner::{Event, Sample, Start, Summary};
use std::path::{Path, PathBuf};

/// Simulates a model, prints a summary and writes its files.
pub(crate) fn simulate(args: &SimulateArgs) -> Result<(), Failure> {
    let mut scene = Scene::new(args)?;
    let opened = folder(args, &scene)?;
    let folder = opened.as_ref().map(Folder::path);
    let mut outcome = Outcome::default();
    let proof = match run(&mut scene, &mut outcome) {
        Ok(proof) => proof,
        Err(Failure::Interrupted(_)) => return Err(keep_the_part(args, &scene, &outcome, folder)?),
        Err(failure) => return Err(keep_what_there_is(&scene, &outcome.samples, folder, failure)),
    };
    let mut written = match folder {
        Some(folder) => write_files(&scene, &outcome, folder)?,
        None => Vec::new(),
    };
    let (standing, module) = settled(proof)?;
    // A linearisation asks for functions of its own, a run for those that a program needs.
    let module = module.filter(|_| args.linearize.is_none());
    match (folder, module) {
        (Some(folder), Some(module)) => {
            let path = module_path(&scene.results, folder);
            write::write(&path, &module.code, Known::Record)?;
            written.push(path);
        }
        // The functions of an earlier run are not those that ran.
        (Some(folder), None) => write::remove(&module_path(&scene.results, folder)),
        (None, _) => {}
    }
    // Whatever becomes of the verdict, the run is told.
    let (verdict, unjudged) = match args.verify.then(|| judged(&scene, &outcome)) {
        Some(Ok(verdict)) => (Some(verdict), None),
        Some(Err(failure)) => (None, Some(failure)),
        None => {
            verdict::doubts(&scene, &outcome).iter().for_each(|words| remarks::warn(words));
            (None, None)
        }
    };
    verdict::happenings(&scene, &outcome).iter().for_each(|words| remarks::warn(words));
    let worthless = unjudged.or_else(|| verdict::worthless(&scene, &outcome, verdict.as_ref()));
    let unjudged = worthless.as_ref().filter(|_| args.verify && verdict.is_none());
    let linear = outcome.linear.as_ref().filter(|_| args.linearize.is_some());
    let text = if args.json {
        let mut object = json::object(&scene, &outcome, (verdict.as_ref(), linear), &written);
        object["proof"] = standing.map(Standing::words).into();
        if let Some(why) = unjudged {
            object["verdict"] = json::unjudged(why);
        }
        format!("{object}\n")
    } else {
        let linear = linear.map_or(String::new(), |linear| linearization::text(&scene.model, linear));
        let verdict = verdict.map(|verdict| verdict::text(&verdict, &outcome));
        let verdict = verdict.or(unjudged.map(verdict::unjudged)).unwrap_or_default();
        summary::text(&scene, (&outcome, standing), &(verdict + &linear), &written)
    };
    say(&text)?;
    worthless.map_or(Ok(()), Err)
}

/// Judges a run by companions that are made as it was.
fn judged(scene: &Scene, outcome: &Outcome) -> Result<Verdict, Failure> {
    verdict::verdict(scene, outcome, |companion| {
        let mut other = Outcome::default();
        run(&mut companion.clone(), &mut other).map(|_| other)
    })
}

/// Runs a scene, prints its summary and writes its table and plots to a folder.
pub(crate) fn simulate_scene(mut scene: Scene, folder: &Path) -> Result<(), Failure> {
    let opened = Folder::open(folder)?;
    let mut outcome = Outcome::default();
    let proof = match run(&mut scene, &mut outcome) {
        Ok(proof) => proof,
        Err(failure) => {
            return Err(keep_what_there_is(&scene, &outcome.samples, Some(opened.path()), failure));
        }
    };
    let written = write_files(&scene, &outcome, opened.path())?;
    let (standing, _) = settled(proof)?;
    say(&summary::text(&scene, (&outcome, standing), "", &written))
}

/// How the functions of a run stand, once its proof has ended or taken too long, and their text.
pub(crate) fn settled(proof: Option<Proof>) -> Result<(Option<Standing>, Option<Module>), Failure> {
    let Some(proof) = proof else { return Ok((None, None)) };
    proof.settle().map(|(standing, module)| (Some(standing), module))
}

/// Runs a scene; what there is up to a failure is kept in the outcome. Gives the proof that was begun beside it.
pub(crate) fn run(scene: &mut Scene, outcome: &mut Outcome) -> Result<Option<Proof>, Failure> {
    let mut proof = None;
    follow(scene, outcome, |scene, tell| match scene.engine {
        Engine::InProcess => in_process::simulate(scene, tell, &mut proof),
        Engine::Generated => nested::simulate(scene, tell),
        Engine::Assembled => assembled(scene, tell),
    })?;
    Ok(proof)
}

/// The same with whatever makes runs. One whose method was chosen and that turns out to be stiff is made again by a
/// method for such scenes; should that fail, as it was.
pub(crate) fn follow(
    scene: &mut Scene,
    outcome: &mut Outcome,
    mut run: impl FnMut(&Scene, &mut dyn FnMut(Event<'_>)) -> Result<Summary, Failure>,
) -> Result<(), Failure> {
    let before = scene.clone();
    let failure = match followed(scene, outcome, &mut run) {
        Err(failure @ Failure::Run(_)) => failure,
        ended => return ended,
    };
    let Some(t) = outcome.stiff else { return Err(failure) };
    scene.turn(t);
    let mut anew = |scene: &Scene| {
        *outcome = Outcome::default();
        followed(scene, outcome, &mut run)
    };
    match anew(scene) {
        Err(Failure::Run(_)) => {
            *scene = before;
            scene.approach.leaves_stiff = false;
            anew(scene)
        }
        ended => ended,
    }
}

fn followed(
    scene: &Scene,
    outcome: &mut Outcome,
    run: &mut impl FnMut(&Scene, &mut dyn FnMut(Event<'_>)) -> Result<Summary, Failure>,
) -> Result<(), Failure> {
    let mut progress = Progress::new(scene.settings.t_end);
    let Outcome { samples, occurrences, linear, stopped, stiff, .. } = outcome;
    let mut tell = |event: Event<'_>| match event {
        Event::Sample(sample) => samples.push(sample.clone()),
        Event::Occurred(found) => occurrences.push(*found),
        Event::Linear(found) => *linear = Some(found.clone()),
        Event::Stopped(t, state) => *stopped = Some((t, state.to_vec())),
        Event::Stiff(t) => *stiff = Some(t),
        Event::Forecast(forecast) => progress.foretold(&forecast),
        Event::Progress(t) => progress.reached(t),
    };
    let summary = run(scene, &mut tell);
    progress.finish();
    outcome.summary = summary.map_err(|failure| {
        let failure = with_link(scene, outcome, failure);
        lapse::with_formula(scene, &outcome.samples, outcome.stopped.as_ref(), failure)
    })?;
    Ok(())
}

/// A failed run where the ends of a link have come together says which link that is.
fn with_link(scene: &Scene, outcome: &Outcome, failure: Failure) -> Failure {
    let (Failure::Run(words), Some((t, state))) = (&failure, &outcome.stopped) else { return failure };
    let (q, v) = state.split_at(7 * scene.model.coordinate_bodies().len());
    match scene.model.closing_link(*t, scene.settings.step, q, v) {
        Some(link) => Failure::Run(format!(
            "{words}\nThe ends of link `{link}` come together at t = {t} s or within a step of it: its force has no direction there."
        )),
        None => failure,
    }
}

/// Runs the runtime-assembled model in this process.
fn assembled(scene: &Scene, tell: &mut dyn FnMut(Event<'_>)) -> Result<Summary, Failure> {
    let precision = match scene.precision {
        Precision::F32 => gyro_assembled::Precision::Single,
        Precision::F64 => gyro_assembled::Precision::Double,
    };
    let plan = (&scene.settings, &scene.approach);
    let _interruptible = interrupt::Run::begin();
    let mut told = interrupt::interruptible(tell);
    quick_look(&scene.model, precision, plan, &scene.start, &mut told).map_err(|error| match error {
        QuickLookError::Run(_) if interrupt::was_interrupted() => interrupt::failure(),
        QuickLookError::Start(error) => Failure::Usage(error.to_string()),
        QuickLookError::Run(refused @ gyro_runner::Failure::Refused(_)) => {
            Failure::Usage(refused.to_string())
        }
        QuickLookError::Run(failure) => Failure::Run(failure.to_string()),
    })
}

/// Where files go, if any are to be written; a place that cannot be used is found out before the run.
fn folder(args: &SimulateArgs, scene: &Scene) -> Result<Option<Folder>, Failure> {
    let folder = match &args.out {
        Some(folder) => folder.clone(),
        None if args.json => return Ok(None),
        None => Path::new("out").join(&scene.model.name),
    };
    let name = &scene.results;
    let opened = Folder::open(&folder)?;
    let files = plot::NAMES.iter().map(|plot| plot_path(name, plot, &folder));
    files
        .chain([table_path(name, &folder), events_path(name, &folder), module_path(name, &folder)])
        .try_for_each(|path| write::check(&path, Known::Record))?;
    Ok(Some(opened))
}

fn plot_path(name: &str, plot: &str, folder: &Path) -> PathBuf {
    folder.join(format!("{name}-{plot}.svg"))
}

fn events_path(name: &str, folder: &Path) -> PathBuf {
    folder.join(format!("{name}-events.csv"))
}

fn module_path(name: &str, folder: &Path) -> PathBuf {
    folder.join(format!("{name}.rs"))
}

fn table_path(name: &str, folder: &Path) -> PathBuf {
    folder.join(format!("{name}.csv"))
}

fn write_files(scene: &Scene, outcome: &Outcome, folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let samples = &outcome.samples;
    let mut written = vec![write_table(scene, samples, folder)?];
    written.extend(write_events(scene, outcome, folder)?);
    let model = &scene.model;
    if samples.len() == 1 {
        // Nothing moves, and plots of an earlier run would belie it.
        remove_plots(scene, folder);
        return Ok(written);
    }
    for (name, svg) in plot::pages(model, samples).map_err(Failure::Run)? {
        let path = plot_path(&scene.results, name, folder);
        write::write(&path, &svg, Known::Record)?;
        written.push(path);
    }
    Ok(written)
}

fn write_table(scene: &Scene, samples: &[Sample], folder: &Path) -> Result<PathBuf, Failure> {
    let path = table_path(&scene.results, folder);
    let columns = columns::columns(&scene.model, &scene.start, samples);
    write::write(&path, columns::text(&columns), Known::Record)?;
    Ok(path)
}

/// Beside the samples, where anything is looked for; an earlier list would belie a run without.
fn write_events(scene: &Scene, outcome: &Outcome, folder: &Path) -> Result<Option<PathBuf>, Failure> {
    let path = events_path(&scene.results, folder);
    let Start { watches, contacts, paths, .. } = &scene.start;
    if watches.is_empty() && contacts.is_empty() && paths.is_empty() {
        write::remove(&path);
        return Ok(None);
    }
    write::write(&path, events::csv(&scene.model, &outcome.occurrences), Known::Record)?;
    Ok(Some(path))
}

fn remove_plots(scene: &Scene, folder: &Path) {
    plot::NAMES.iter().for_each(|name| write::remove(&plot_path(&scene.results, name, folder)));
}

/// After an interruption: the files and the summary of the part that was computed.
fn keep_the_part(
    args: &SimulateArgs,
    scene: &Scene,
    outcome: &Outcome,
    folder: Option<&Path>,
) -> Result<Failure, Failure> {
    let samples = &outcome.samples;
    let Some(last) = samples.last() else { return Ok(interrupt::failure()) };
    let written = match folder {
        Some(folder) => write_files(scene, outcome, folder)?,
        None => Vec::new(),
    };
    if !args.json {
        say(&summary::of_part(scene, last, &written))?;
    }
    let samples = words::count(samples.len() as u64, "sample");
    Ok(Failure::Interrupted(format!(
        "interrupted: the run of {} s is incomplete; it has {samples} up to t = {} s",
        scene.settings.t_end, last.t
    )))
}

/// After a failure in the middle of a run: the samples before it are worth keeping; plots of an earlier run would belie
/// them.
fn keep_what_there_is(scene: &Scene, samples: &[Sample], folder: Option<&Path>, failure: Failure) -> Failure {
    let (Failure::Run(words), Some(folder), Some(last)) = (&failure, folder, samples.last()) else {
        return failure;
    };
    remove_plots(scene, folder);
    match write_table(scene, samples, folder) {
        Ok(path) => Failure::Run(format!(
            "{words}\nThe run is incomplete; its {} up to t = {} s are in {}.",
            words::count(samples.len() as u64, "sample"),
            last.t,
            path.display()
        )),
        Err(_) => failure,
    }
}
