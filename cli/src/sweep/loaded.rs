//! A study file with its model.

use super::vocabulary::vocabulary;
use crate::args::SimulateArgs;
use crate::failure::Failure;
use crate::scene::{self, Scene};
use crate::verdict::Outcome;
use crate::{args, events, files, inputs, remarks, simulate};
use gyro_model::Model;
use gyro_runner::{Approach, Coordinates, Input};
use gyro_sweep::study::{self, Files, Study, Unreadable, Vocabulary};
use std::path::{Path, PathBuf};

/// A study, its model and how that is run.
#[derive(Debug)]
pub(super) struct Loaded {
    pub(super) study: Study,
    pub(super) scene: Scene,
    /// The study's text.
    pub(super) text: String,
    /// Its path as results show it.
    pub(super) path: String,
    /// Where it is on this machine.
    pub(super) place: PathBuf,
    /// Its name.
    pub(super) name: String,
}

/// The folder of a study, and its model once that is read.
struct Beside<'a> {
    folder: &'a Path,
    model: Option<Model>,
}

impl Files for Beside<'_> {
    type Error = Failure;

    fn model(&mut self, path: &str) -> Result<Vocabulary, Failure> {
        let model = scene::read_counting_work(&self.folder.join(path))?;
        events::refuse_stops(&model, "a study")?;
        Ok(vocabulary(self.model.insert(model)))
    }

    fn table(&mut self, input: usize, path: &str) -> Result<Input, String> {
        let model = self.model.as_ref().expect("inputs are those of a model");
        let (file, said) = args::table(path);
        inputs::table(model, input, (&self.folder.join(file), said))
    }
}

impl Loaded {
    /// Reads a study file and its model.
    ///
    /// # Errors
    /// Mistakes in either.
    pub(super) fn new(path: &Path) -> Result<Self, Failure> {
        let text = files::read_module(path)?;
        Self::of_text(path, text)
    }

    /// The same of a text that stands for the file.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub(super) fn of_text(path: &Path, text: String) -> Result<Self, Failure> {
        let folder = path.parent().unwrap_or(Path::new(""));
        let study = match study::read(&path.display().to_string(), &text, &mut Beside { folder, model: None })
        {
            Ok(study) => study,
            Err(Unreadable::Study(mistakes)) => return Err(Failure::ModelFile(mistakes)),
            Err(Unreadable::Model(failure)) => return Err(failure),
        };
        let mut scene = Scene::new(&arguments(&study, folder.join(&study.model)))?;
        settle(&study, &mut scene)?;
        scene.start.watches.clear();
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let place = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        Ok(Self { study, scene, text, path: files::shown(path), place, name })
    }
}

/// Has all scenarios run by one method: where that is chosen, by the one that the model file's own run takes.
fn settle(study: &Study, scene: &mut Scene) -> Result<(), Failure> {
    if !study.keep.by.is_empty() {
        let asks = "sensitivities are computed in joint coordinates, by explicit methods";
        let Approach { coordinates, integrator, .. } = scene.approach;
        if coordinates != Coordinates::Joint || integrator.is_implicit() {
            let help = "run = { coordinates = \"joint\", integrator = \"dop853\" } in the study";
            return Err(Failure::Usage(format!(
                "{asks}: the run would be by {integrator} in {coordinates} ones; write {help}"
            )));
        }
    } else if scene.approach.leaves_stiff {
        let mut own = Scene { effort: gyro_codegen::Effort::Quick, ..scene.clone() };
        // Why it fails, if it does, scenarios say for themselves.
        let _ = simulate::run(&mut own, &mut Outcome::default());
        (scene.approach, scene.chosen) = (own.approach, own.chosen);
    }
    scene.approach.leaves_stiff = false;
    let chosen = scene.chosen.to_string();
    if !chosen.is_empty() {
        remarks::note(&format!("chosen: {chosen}"));
    }
    Ok(())
}

/// How `simulate` would be asked for a run of the study's model.
fn arguments(study: &Study, model: PathBuf) -> SimulateArgs {
    let run = &study.run;
    SimulateArgs {
        model,
        no_prove: true,
        t_end: run.t_end,
        step: run.step,
        correct_every: run.correct_every,
        integrator: run.integrator,
        tolerance: run.tolerance,
        coordinates: run.coordinates,
        correction: run.correction,
        budget: run.budget,
        every: run.every,
        ..SimulateArgs::default()
    }
}
