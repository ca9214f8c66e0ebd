//! `cargo xtask show`: a page in which a model moves.

mod describe;
mod efforts;
mod laws;
mod live;
pub(crate) mod meshes;
mod touches;

use crate::args::{Change, ShowArgs, SimulateArgs};
use crate::failure::Failure;
use crate::scene::Scene;
use crate::verdict::Outcome;
use crate::write::{self, Known};
use crate::{folder, remarks, simulate, words};
use gyro_model::{Model, Output, OutputKind};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Simulates a model and writes a page in which it moves.
pub(crate) fn show(args: &ShowArgs) -> Result<(), Failure> {
    let Written { path, size, samples, incomplete } = written(args)?;
    let samples = words::count(samples as u64, "sample");
    remarks::say(&format!(
        "wrote {} ({size} kB, {samples}): open it in a browser, from disk\n",
        path.display()
    ))?;
    if let Some(words) = incomplete {
        return Err(Failure::Run(format!("{words}\nThe page shows the run up to there.")));
    }
    if args.open { open(&path) } else { Ok(()) }
}

/// The same for a page that shows the model file's own run, without a word.
pub(crate) fn beside(model: &Path, page: &Path) -> Result<(), Failure> {
    written(&ShowArgs::of(model, page)?).map(|_| ())
}

/// A page that was written.
struct Written {
    path: PathBuf,
    /// In kB.
    size: usize,
    /// How many there are in all runs.
    samples: usize,
    /// Why a run ended early.
    incomplete: Option<String>,
}

fn written(args: &ShowArgs) -> Result<Written, Failure> {
    refuse_other_results(&args.simulate)?;
    let first = Scene::new(&args.simulate)?;
    let name = &first.model.name;
    let file_name = format!("{name}.html");
    let path = match &args.simulate.out {
        Some(out) => folder::file(out, &file_name),
        None => Path::new("out").join(name).join(file_name),
    };
    // A place that cannot be used is found out before the run.
    write::check(&path, Known::Mark(gyro_show::MARK))?;
    let mut looks = vec![meshes::read(&first.model, &args.simulate.model)?];
    let mut scenes = vec![first];
    if !args.compare.is_empty() {
        let changed = changed(&args.simulate, &args.compare);
        let second = Scene::new(&changed)?;
        looks.push(meshes::read(&second.model, &changed.model)?);
        scenes.push(second);
    }
    let names = names(&scenes, &args.compare);
    let live = match (args.live, scenes.first_mut()) {
        (true, Some(scene)) => {
            told(scene, args.reactions);
            Some(live::live(scene)?)
        }
        _ => None,
    };
    let mut shown = Vec::new();
    let mut incomplete = None;
    let mut n_samples = 0;
    for ((mut scene, name), meshes) in scenes.into_iter().zip(names).zip(looks) {
        told(&mut scene, args.reactions);
        let (outcome, failure) = outcome(&mut scene)?;
        incomplete = incomplete.or(failure);
        n_samples += outcome.samples.len();
        shown.push(describe::scene(&scene, name, &outcome, meshes));
    }
    let html = gyro_show::page(&shown[0].mechanism.name.clone(), &shown, live.as_ref());
    write::write(&path, &html, Known::Mark(gyro_show::MARK))?;
    Ok(Written { path, size: html.len().div_ceil(1000), samples: n_samples, incomplete })
}

/// Options of `simulate` that ask for something else than a motion.
fn refuse_other_results(args: &SimulateArgs) -> Result<(), Failure> {
    let asked = [("--json", args.json), ("--verify", args.verify), ("--linearize", args.linearize.is_some())];
    match asked.iter().find(|(_, is_asked)| *is_asked) {
        Some((option, _)) => Err(Failure::Usage(format!("{option} is an option of simulate, not of show"))),
        None => Ok(()),
    }
}

/// The options of the second run: what is changed replaces what the first run has.
fn changed(args: &SimulateArgs, changes: &[Change]) -> SimulateArgs {
    let mut args = args.clone();
    let model =
        changes.iter().find_map(|change| if let Change::Model(path) = change { Some(path) } else { None });
    if let Some(path) = model {
        args.model.clone_from(path);
        args.set.clear();
        args.input.clear();
    }
    for change in changes {
        match change {
            Change::Engine(engine) => args.engine = Some(*engine),
            Change::Model(_) => {}
            Change::Set(name, value) => {
                args.set.retain(|(set, _)| set != name);
                args.set.push((name.clone(), value.clone()));
            }
        }
    }
    args
}

/// By what the runs differ.
fn names(scenes: &[Scene], changes: &[Change]) -> Vec<String> {
    let name = |scene: &Scene| {
        let difference = |change: &Change| match change {
            Change::Engine(_) => Some(scene.engine.name().to_owned()),
            Change::Model(_) => Some(Path::new(&scene.page_name).file_stem()?.to_string_lossy().into_owned()),
            Change::Set(name, _) => {
                let parameter = scene.model.parameters.iter().find(|p| p.name == *name)?;
                Some(format!("{name} = {}", gyro_model::to_f64(&parameter.value)))
            }
        };
        let differences: Vec<String> = changes.iter().filter_map(difference).collect();
        if differences.is_empty() { scene.engine.name().to_owned() } else { differences.join(", ") }
    };
    scenes.iter().map(name).collect()
}

/// Has a run tell what arrows need, in what is run and in what code is made of: what formulas of forces give and, if
/// they are asked for, reactions.
fn told(scene: &mut Scene, has_reactions: bool) {
    for model in [&mut scene.model, &mut scene.page] {
        laws::with_laws(model);
        if has_reactions {
            add_reactions(model);
        }
    }
}

/// Asks for the reaction of each joint that has none among the outputs.
fn add_reactions(model: &mut Model) {
    for joint in 0..model.joints.len() {
        let is_it = |output: &Output| matches!(output.kind, OutputKind::Reaction { joint: j } if j == joint);
        if !model.outputs.iter().any(is_it) {
            let name = format!("reaction_of_{}", model.joints[joint].name);
            model.outputs.push(Output { name, kind: OutputKind::Reaction { joint } });
        }
    }
}

/// Runs a scene with all its bodies observed, free ones first as tables expect; beside what it gave why it ended early.
fn outcome(scene: &mut Scene) -> Result<(Outcome, Option<String>), Failure> {
    scene.start.observed_bodies =
        describe::observed(&scene.model).into_iter().map(|(slot, _)| slot).collect();
    let mut outcome = Outcome::default();
    match simulate::run(scene, &mut outcome) {
        Ok(proof) => simulate::settled(proof).map(|_| (outcome, None)),
        Err(Failure::Run(words)) if outcome.samples.len() > 1 => Ok((outcome, Some(words))),
        Err(failure) => Err(failure),
    }
}

/// Opens a page as a double click would.
fn open(path: &PathBuf) -> Result<(), Failure> {
    let opener = if cfg!(target_os = "macos") { "open" } else { "xdg-open" };
    let mut command = if cfg!(windows) { Command::new("explorer") } else { Command::new(opener) };
    let opened = command.arg(path).stdout(Stdio::null()).stderr(Stdio::null()).status();
    match opened {
        Ok(status) if status.success() || cfg!(windows) => Ok(()),
        _ => Err(Failure::Run("--open: no browser could be opened; the page is written".to_owned())),
    }
}
