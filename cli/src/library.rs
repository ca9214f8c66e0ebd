//! What programs that are no command line take from this one, as the Python package does: runs on the engine that
//! compiles in the process. Settings are the options of `simulate`, so what can be asked for, and what is refused, is
//! the same.

use crate::args::{Engine, InputSetting, SimulateArgs};
use crate::columns;
use crate::failure::Failure;
use crate::formulas::{formula, seen};
use crate::in_process;
use crate::invocation::with_suggestion;
use crate::runs::Runs;
use crate::scene::{self, Scene};
use crate::verdict::{self, Outcome};
use crate::verify::proved;
use crate::{Cli, Command, batches, files, json, linearization, remarks, simulate, summary, urdf};
use clap::{CommandFactory, Parser};
use gyro_codegen::{Effort, Functions};
use gyro_jit::{Compiled, Library, Sizes};
use gyro_model::{Model, OutputKind};
use gyro_runner::motion::Linear;
use gyro_runner::{Event, JointSample, Seen, Start};
use gyro_sim::JointPlace;
use gyro_verifier::Depth;
use serde_json::{Value, json};
use std::ffi::OsStr;
use std::io;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

pub use crate::columns::{Column, Shown, coordinates};
pub use crate::scene::counting_work;
pub use crate::scene::observed;

/// Has notes and progress left out.
pub fn be_quiet() {
    remarks::be_quiet();
}

/// Reads and checks the text of a model file; tables are in `folder`.
///
/// # Errors
/// The text has mistakes.
pub fn read_text(file: &str, text: &str, folder: &Path) -> Result<Model, Failure> {
    scene::read_text(file, text, folder)
}

/// The text of a file, such as a model file.
///
/// # Errors
/// It cannot be read.
pub fn text_of(path: &Path) -> Result<String, Failure> {
    files::read_module(path)
}

/// What is to be said of a model: rows that are dropped.
pub fn warnings(model: &Model) -> Vec<String> {
    remarks::dropped(model).into_iter().collect()
}

/// The model file of a robot in the Unified Robot Description Format, by the options of `import`; and what of it has no
/// counterpart there.
///
/// # Errors
/// The file cannot be read, or has mistakes.
pub fn import(path: &Path, options: &[String]) -> Result<(String, Vec<String>), Failure> {
    let file = path.display().to_string();
    match parsed("import", &file, options)? {
        Command::Import(args) => urdf::converted(&args, "gyro_sim.from_urdf"),
        _ => unreachable!("`import` was asked for"),
    }
}

/// Reads the options of a command.
fn parsed(command: &str, file: &str, options: &[String]) -> Result<Command, Failure> {
    let words = ["gyro", command].into_iter().chain(options.iter().map(String::as_str));
    let parsed = Cli::try_parse_from(words.clone().chain(["--", file]));
    parsed.map(|cli| cli.command).map_err(|error| {
        let error = with_suggestion(error, Cli::command(), words.map(OsStr::new));
        let text = error.to_string();
        let words = text.split("\n\nUsage").next().unwrap_or_default().split("\n\nFor more").next();
        Failure::Usage(words.unwrap_or_default().trim_start_matches("error: ").trim_end().to_owned())
    })
}

/// What is asked of a run.
#[derive(Clone, Debug)]
pub struct Request(SimulateArgs);

impl Request {
    /// By options of `simulate`, such as `["--tolerance", "1e-9"]`.
    ///
    /// # Errors
    /// An option is unknown or its value is none.
    pub fn of(file: &str, options: &[String]) -> Result<Self, Failure> {
        match parsed("simulate", file, options)? {
            Command::Simulate(args) => Ok(Self(SimulateArgs { engine: Some(Engine::InProcess), ..args })),
            _ => unreachable!("`simulate` was asked for"),
        }
    }

    /// Sets an input to values at times; a single row is a constant.
    #[must_use]
    pub fn with_input(mut self, name: &str, rows: Vec<[f64; 2]>) -> Self {
        self.0.input.push((name.to_owned(), InputSetting::Rows(rows)));
        self
    }
}

/// What was compiled of one model: each set of functions once.
#[derive(Debug, Default)]
pub struct Kernels(Mutex<Vec<(Functions, Effort, Compiled<f64>)>>);

impl Kernels {
    /// A mechanism with these functions, whose parameters and inputs are the model file's.
    ///
    /// # Errors
    /// As [`gyro_jit::compile`].
    pub fn get(
        &self,
        model: &Model,
        functions: &Functions,
        effort: Effort,
    ) -> Result<Compiled<f64>, Failure> {
        let compile = || gyro_jit::compile(model, functions, effort);
        self.get_by(functions, effort, || compile().map_err(|error| Failure::Usage(error.to_string())))
    }

    fn get_by(
        &self,
        functions: &Functions,
        effort: Effort,
        compile: impl FnOnce() -> Result<Compiled<f64>, Failure>,
    ) -> Result<Compiled<f64>, Failure> {
        let mut all = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((.., compiled)) = all.iter().find(|(f, e, _)| f == functions && *e == effort) {
            return Ok(compiled.clone());
        }
        let compiled = compile()?;
        all.push((functions.clone(), effort, compiled.clone()));
        Ok(compiled)
    }
}

/// A run that was made.
#[derive(Clone, Debug)]
pub struct Run {
    scene: Scene,
    outcome: Outcome,
    kernels: Arc<Kernels>,
}

/// Asked every now and then whether a run is to end.
pub type Stop<'a> = &'a (dyn Fn() -> bool + Sync);

impl Run {
    /// Makes a run of a model.
    ///
    /// # Errors
    /// The request is invalid or the run fails; [`Failure::Interrupted`] once `stop` says so.
    pub fn make(
        (model, file): (&Model, &str),
        request: &Request,
        kernels: &Arc<Kernels>,
        stop: Stop<'_>,
    ) -> Result<Self, Failure> {
        let page = counting_work(model.clone());
        let mut scene = Scene::of(page, file.to_owned(), &request.0)?;
        let outcome = outcome(&mut scene, kernels, stop)?;
        Ok(Self { scene, outcome, kernels: kernels.clone() })
    }

    /// The table of the run, as `simulate` writes it: time, inputs, joints, outputs, free bodies, energies.
    pub fn columns(&self) -> Vec<Column> {
        columns::columns(&self.scene.model, &self.scene.start, &self.outcome.samples)
    }

    /// Names and units of the outputs' numbers.
    pub fn outputs(&self) -> Vec<(String, &'static str)> {
        columns::outputs(&self.scene.model)
    }

    /// Values of the parameters in their order.
    pub fn parameters(&self) -> Vec<f64> {
        self.scene.parameters()
    }

    /// (x, u) in joint coordinates at a sample; `None` where samples do not have all of its numbers.
    pub fn state(&self, sample: usize, places: &[JointPlace]) -> Option<Vec<f64>> {
        let (model, sample) = (&self.scene.model, self.outcome.samples.get(sample)?);
        let shown = coordinates(model);
        let (mut x, mut u) = (Vec::new(), Vec::new());
        for place in places {
            match *place {
                JointPlace::Scalar { joint, coordinate } | JointPlace::Turn { joint, coordinate } => {
                    let own = |(_, shown): &(usize, &Shown)| {
                        shown.joint == usize::from(joint) && !shown.is_orientation()
                    };
                    let (at, _) = shown.iter().enumerate().filter(own).nth(coordinate.into())?;
                    let (position, rate) = columns::scalar(&sample.coordinates[at]);
                    x.push(position);
                    u.extend((place.n_rates() == 1).then_some(rate));
                }
                JointPlace::State { state } => {
                    let is_it = |kind: &OutputKind| matches!(kind, OutputKind::State { state: of } if *of == usize::from(state));
                    let before = model.outputs.iter().take_while(|output| !is_it(&output.kind));
                    let at: usize = before.map(|output| output.kind.columns().len()).sum();
                    x.push(*sample.outputs.get(at)?);
                }
                JointPlace::Orientation { joint } => {
                    let own = |shown: &Shown| shown.joint == usize::from(joint) && shown.is_orientation();
                    match &sample.coordinates[shown.iter().position(own)?] {
                        JointSample::Orientation { position, rate } => {
                            x.extend(position);
                            u.extend(rate);
                        }
                        _ => return None,
                    }
                }
                JointPlace::Body { body } => {
                    let at = observed(model).iter().position(|(moving, _)| *moving == usize::from(body))?;
                    x.extend(sample.bodies[at].pose);
                    u.extend(sample.bodies[at].velocity);
                }
            }
        }
        Some([x, u].concat())
    }

    /// The values of a formula at all samples, of time, parameters, and of what events may see.
    ///
    /// # Errors
    /// It has mistakes.
    pub fn formula(&self, text: &str) -> Result<Vec<f64>, Failure> {
        let model = &self.scene.model;
        let of = formula(model, &model.formula(text).map_err(Failure::Usage)?);
        let columns = self.columns();
        let values =
            |name: &str| columns.iter().find(|column| column.name == name).map(|column| &column.values);
        let visible = model.visible().into_iter().map(|(name, what)| (seen(model, what), values(&name)));
        let visible: Vec<_> = visible.chain([(Seen::Time, values("t"))]).collect();
        let value = |sample: usize| {
            of.value(&|what: Seen| {
                let found = visible.iter().find(|(known, _)| *known == what);
                found.and_then(|(_, values)| values.as_ref()?.get(sample).copied()).unwrap_or(f64::NAN)
            })
        };
        Ok((0..self.outcome.samples.len()).map(value).collect())
    }

    /// What the run was and what it cost, as with `--json`.
    pub fn summary(&self) -> Value {
        json::object(&self.scene, &self.outcome, (None, None), &[])
    }

    /// The summary as text.
    pub fn text(&self) -> String {
        summary::text(&self.scene, (&self.outcome, None), "", &[])
    }

    /// What the run says of itself that is not good.
    pub fn warnings(&self) -> Vec<String> {
        verdict::warnings(&self.scene, &self.outcome)
    }

    /// How far the run can be trusted, as with `--verify`: it is made again and looked at, and compared with others.
    ///
    /// # Errors
    /// [`Failure::Interrupted`] once `stop` says so; the run itself fails.
    pub fn verdict(&self, stop: Stop<'_>) -> Result<Value, Failure> {
        let mut scene = Scene { has_companions: true, ..self.scene.clone() };
        scene.approach.examine = true;
        let outcome = outcome(&mut scene, &self.kernels, stop)?;
        let companion = |scene: &Scene| self::outcome(&mut scene.clone(), &self.kernels, stop);
        let (mut found, text) = match verdict::verdict(&scene, &outcome, companion) {
            Ok(verdict) => {
                let mut object = json::object(&scene, &outcome, (Some(&verdict), None), &[]);
                (object["verdict"].take(), verdict::text(&verdict, &outcome))
            }
            Err(why @ Failure::Unjudged(_)) => (json::unjudged(&why), verdict::unjudged(&why)),
            Err(failure) => return Err(failure),
        };
        found["text"] = json!(text);
        Ok(found)
    }
}

/// Makes the run of a scene.
fn outcome(scene: &mut Scene, kernels: &Kernels, stop: Stop<'_>) -> Result<Outcome, Failure> {
    let mut outcome = Outcome::default();
    simulate::follow(scene, &mut outcome, |scene, tell| {
        in_process::explained(scene, tell, |runs, tell| make(scene, runs, (kernels, stop), tell))
    })?;
    Ok(outcome)
}

fn make(
    scene: &Scene,
    runs: Option<Runs>,
    (kernels, stop): (&Kernels, Stop<'_>),
    tell: &mut dyn FnMut(Event<'_>),
) -> Result<in_process::Outcome, Failure> {
    let functions = in_process::functions(runs);
    let mut mechanism =
        kernels.get_by(&functions, scene.effort, || in_process::compiled(scene, &functions, None))?;
    let mut tell = |event: Event<'_>| {
        tell(event);
        if stop() { Err(io::ErrorKind::Interrupted.into()) } else { Ok(()) }
    };
    match in_process::follow(scene, runs, &mut mechanism, &mut tell) {
        Err(gyro_runner::Failure::Output(_)) => Err(Failure::Interrupted("interrupted".to_owned())),
        outcome => Ok(outcome),
    }
}

/// Names of the elements of a linearised state.
pub fn names(model: &Model, linear: &Linear) -> Vec<String> {
    linearization::names(model, linear)
}

/// Its tables as text.
pub fn text(model: &Model, linear: &Linear) -> String {
    linearization::text(model, linear)
}

/// The module of a model, with what was proved of it in its head: what `generate` writes.
///
/// # Errors
/// The model has none, or the proof refutes it.
pub fn generate(file: &str, model: &Model) -> Result<String, Failure> {
    let module = gyro_codegen::generate_model(file, model).map_err(|e| Failure::Usage(e.to_string()))?;
    Ok(proved(model, module)?.code)
}

/// Has cargo compile these functions for many states at a time, for this very processor if that is asked for; the model
/// is of these sizes.
///
/// # Errors
/// The model has no such functions, cargo is missing, or the proof refutes them.
pub fn batches(
    file: &str,
    model: &Model,
    functions: &Functions,
    sizes: Sizes,
    is_native: bool,
) -> Result<Library, Failure> {
    batches::compiled(file, model, functions, sizes, is_native)
}

/// The proof of all functions of a model, as `verify` has it: whether all is proved, its text and its object.
///
/// # Errors
/// The model has no module.
pub fn verify(file: &str, model: &Model, depth: Depth) -> Result<(bool, String, Value), Failure> {
    let all = Model { functions: Some(vec!["all".to_owned()]), ..model.clone() };
    let module = gyro_codegen::generate_model(file, &all).map_err(|e| Failure::Usage(e.to_string()))?;
    let report = gyro_verifier::verify(&all, &module.code, &module.constants, depth);
    Ok((report.is_proved(), report.to_string(), report.to_json()))
}

/// Where a run of a model starts.
///
/// # Errors
/// It cannot be assembled.
pub fn start(file: &str, model: &Model) -> Result<Start, Failure> {
    let assembled = model.assemble().map_err(|e| Failure::Usage(format!("{file}: {e}: {}", e.help())))?;
    Ok(scene::start(model, &assembled))
}
