//! `cargo xtask simulate`.

use crate::args::{Engine, Precision, SimulateArgs};
use crate::failure::Failure;
use crate::progress::Progress;
use crate::scene::Scene;
use crate::{columns, files, json, nested, plot, summary, words};
use gyro_assembled::{Form, QuickLookError, quick_look};
use gyro_model::Model;
use gyro_runner::{Event, Sample, Summary};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Simulates a model, prints a summary and writes its files.
pub(crate) fn simulate(args: &SimulateArgs) -> Result<(), Failure> {
    let scene = Scene::new(args)?;
    let folder = folder(args, &scene.model.name)?;
    let mut samples = Vec::new();
    let run = match run(&scene, &mut samples) {
        Ok(run) => run,
        Err(failure) => return Err(keep_what_there_is(&scene.model, &samples, folder.as_deref(), failure)),
    };
    let written = match &folder {
        Some(folder) => write_files(&scene.model, &samples, folder)?,
        None => Vec::new(),
    };
    let last = samples.last().expect("the start is a sample");
    let text = if args.json {
        format!("{}\n", json::object(&scene, last, &run))
    } else {
        summary::text(&scene, &samples, &run, &written)
    };
    say(&text)
}

/// Whoever closes the pipe has read enough; any other loss of output is a failure.
fn say(text: &str) -> Result<(), Failure> {
    let mut stdout = std::io::stdout();
    match stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Failure::Run(format!("standard output cannot be written: {error}")))
        }
        _ => Ok(()),
    }
}

fn run(scene: &Scene, samples: &mut Vec<Sample>) -> Result<Summary, Failure> {
    let mut progress = Progress::new(scene.settings.t_end);
    let mut tell = |event: Event<'_>| match event {
        Event::Sample(sample) => samples.push(sample.clone()),
        Event::Progress(t) => progress.reached(t),
    };
    let outcome = match scene.engine {
        Engine::Generated => nested::simulate(scene, &mut tell),
        Engine::Assembled => twin(scene, Form::for_model(&scene.model), &mut tell),
        Engine::Dense => twin(scene, Form::Dense, &mut tell),
        Engine::Recursive => twin(scene, Form::Recursive, &mut tell),
    };
    progress.finish();
    outcome
}

/// Runs the runtime-assembled twin in this process.
fn twin(scene: &Scene, form: Form, tell: &mut dyn FnMut(Event<'_>)) -> Result<Summary, Failure> {
    let precision = match scene.precision {
        Precision::F32 => gyro_assembled::Precision::Single,
        Precision::F64 => gyro_assembled::Precision::Double,
    };
    let outcome =
        quick_look(&scene.model, (form, precision), (&scene.settings, &scene.approach), &scene.start, tell);
    outcome.map_err(|error| match error {
        QuickLookError::Start(error) => Failure::Usage(error.to_string()),
        QuickLookError::Run(failure) => Failure::Run(failure.to_string()),
    })
}

/// Where files go, if any are to be written; a place that cannot be used is found out before the run.
fn folder(args: &SimulateArgs, name: &str) -> Result<Option<PathBuf>, Failure> {
    let folder = match &args.out {
        Some(folder) => folder.clone(),
        None if args.json => return Ok(None),
        None => Path::new("out").join(name),
    };
    fs::create_dir_all(&folder)
        .map_err(|e| Failure::Usage(format!("--out: {} cannot be made: {e}", folder.display())))?;
    Ok(Some(folder))
}

fn write_files(model: &Model, samples: &[Sample], folder: &Path) -> Result<Vec<PathBuf>, Failure> {
    let mut written = vec![write_table(model, samples, folder)?];
    for (name, svg) in plot::pages(model, samples).map_err(Failure::Run)? {
        let path = folder.join(format!("{}-{name}.svg", model.name));
        files::write(&path, &svg)?;
        written.push(path);
    }
    Ok(written)
}

fn write_table(model: &Model, samples: &[Sample], folder: &Path) -> Result<PathBuf, Failure> {
    let path = folder.join(format!("{}.csv", model.name));
    files::write(&path, &columns::text(&columns::columns(model, samples)))?;
    Ok(path)
}

/// After a failure in the middle of a run: the samples before it are worth keeping; plots of an earlier run would belie them.
fn keep_what_there_is(model: &Model, samples: &[Sample], folder: Option<&Path>, failure: Failure) -> Failure {
    let (Failure::Run(words), Some(folder), Some(last)) = (&failure, folder, samples.last()) else {
        return failure;
    };
    for name in plot::NAMES {
        // There may be none.
        let _ = fs::remove_file(folder.join(format!("{}-{name}.svg", model.name)));
    }
    match write_table(model, samples, folder) {
        Ok(path) => Failure::Run(format!(
            "{words}\nThe run is incomplete; its {} up to t = {} s are in {}.",
            words::count(samples.len() as u64, "sample"),
            last.t,
            path.display()
        )),
        Err(_) => failure,
    }
}
