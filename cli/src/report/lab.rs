//! A scene and the programs that compute it.

use super::curve::{Curve, Engine, Outcome, Point, Setting, Treatment, who};
use super::truth::{INTERVALS, Truth};
use crate::args::Precision;
use crate::failure::Failure;
use crate::nested::{self, Session};
use crate::runs::Runs;
use crate::{contacts, files, scene};
use gyro_assembled::Recursive;
use gyro_codegen::Functions;
use gyro_model::Model;
use gyro_runner::protocol::Request;
use gyro_runner::{
    Approach, Coordinates, Correction, Event, Integrator, Sample, Settings, Start, Summary, Timing,
};
use std::path::{Path, PathBuf};

/// A scene, how long it is followed, and what computes it.
#[derive(Debug)]
pub(crate) struct Lab {
    pub(crate) model: Model,
    /// The model file.
    pub(crate) path: PathBuf,
    /// The model file's name, as its reference and its report are called.
    pub(crate) name: String,
    pub(crate) t_end: f64,
    pub(crate) start: Start,
    parameters: Vec<f64>,
    /// The generated programs for `f64` and `f32`.
    programs: [PathBuf; 2],
    assembled: PathBuf,
    sessions: Vec<((Engine, Precision), Session)>,
    has_joint_coordinates: bool,
}

/// A run that was made.
#[derive(Debug)]
pub(crate) struct Run {
    pub(crate) samples: Vec<Sample>,
    pub(crate) summary: Summary,
    pub(crate) timing: Option<Timing>,
}

/// When to sample, how to step, and how long to measure.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Plan {
    pub(crate) settings: Settings,
    pub(crate) approach: Approach,
    pub(crate) measure_for: Option<f64>,
}

impl Lab {
    /// Reads a model file and compiles what computes it.
    pub(crate) fn new(path: &Path, assembled: &Path) -> Result<Self, Failure> {
        let model = scene::read_counting_work(path)?;
        let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let module = gyro_codegen::generate_functions(&files::shown(path), &model, &Functions::of_solvers())
            .map_err(|e| Failure::Usage(e.to_string()))?;
        if module.implements("JointSpace") {
            contacts::refuse_shared_reactions(&model)?;
        } else {
            contacts::refuse(&model, "a report of a mechanism without joint coordinates")?;
        }
        // From event to event there are runs of one kind alone.
        let touching =
            (model.has_rigid_contacts()).then(|| Runs::with(Coordinates::Joint, Correction::None).touching());
        let program = |precision| nested::program(&model, &module, precision, touching);
        let programs = [program(Precision::F64)?, program(Precision::F32)?];
        let lab = Self::with_programs(model, path, name, programs, assembled)?;
        Ok(Self { has_joint_coordinates: module.implements("JointSpace"), ..lab })
    }

    /// The same scene, to be changed.
    pub(crate) fn again(&self) -> Result<Self, Failure> {
        let programs = self.programs.clone();
        let lab = Self::with_programs(
            self.model.clone(),
            &self.path,
            self.name.clone(),
            programs,
            &self.assembled,
        )?;
        Ok(Self { has_joint_coordinates: self.has_joint_coordinates, ..lab })
    }

    /// The same scene with one of its numbers made a parameter, in `f64`.
    pub(crate) fn variant(&self, model: Model, parameters: Vec<f64>) -> Result<Self, Failure> {
        let name = format!("{}_map", self.model.name);
        let model = Model { name, ..model };
        let module = gyro_codegen::generate_functions("map.toml", &model, &Functions::of_solvers())
            .map_err(|e| Failure::Usage(e.to_string()))?;
        let program = nested::program(&model, &module, Precision::F64, None)?;
        let programs = [program.clone(), program];
        let lab = Self::with_programs(model, &self.path, self.name.clone(), programs, &self.assembled)?;
        Ok(Self { parameters, has_joint_coordinates: self.has_joint_coordinates, ..lab })
    }

    fn with_programs(
        model: Model,
        path: &Path,
        name: String,
        programs: [PathBuf; 2],
        assembled: &Path,
    ) -> Result<Self, Failure> {
        let found = model.assemble().map_err(|e| Failure::Usage(format!("{}: {e}", path.display())))?;
        let start = scene::start(&model, &found);
        let parameters = model.parameters.iter().map(|p| gyro_model::to_f64(&p.value)).collect();
        Ok(Self {
            t_end: model.simulation.t_end,
            path: path.to_path_buf(),
            name,
            start,
            parameters,
            programs,
            assembled: assembled.to_path_buf(),
            sessions: Vec::new(),
            has_joint_coordinates: false,
            model,
        })
    }

    pub(crate) fn set_parameters(&mut self, parameters: Vec<f64>) {
        self.parameters = parameters;
    }

    /// Whether generated code of the model has joint coordinates.
    pub(crate) fn has_joint_coordinates(&self) -> bool {
        self.has_joint_coordinates
    }

    /// The reference solution, or what has to do in its place.
    pub(crate) fn truth(&mut self) -> Result<Truth, Failure> {
        if self.touches() {
            return self.rigid_truth();
        }
        // References are of the mechanism by itself.
        let is_alone = self.is_shipped() && self.start.controllers.is_empty();
        if let Some(reference) = gyro_reference::scene(&self.name).filter(|_| is_alone) {
            return Ok(Truth::of_reference(&self.model, &reference, self.t_end));
        }
        let is_tree = Recursive::<f64>::supports(&self.model).is_ok();
        let engine = if is_tree { Engine::Recursive } else { Engine::Dense };
        let correction = Correction::Partition;
        let curve = Curve {
            engine,
            precision: Precision::F64,
            integrator: Integrator::Dop853,
            treatment: Treatment::Maximal(correction),
        };
        let setting = Setting::Tolerance(TIGHT);
        let run = self
            .run((engine, Precision::F64), &self.plan(&curve, setting, 10_000_000, None))
            .map_err(Failure::Run)?;
        let source = format!(
            "the runtime-assembled model ({}) by dop853 at a tolerance of {TIGHT:e}, because this model file has no \
             reference solution: errors below {FLOOR:e} are not \
             known and are shown as that",
            who(engine)
        );
        Ok(Truth::of_samples(&self.model, (source, FLOOR), &run.samples))
    }

    /// What rigid stops and friction that sticks have in the place of a reference: generated code alone follows them.
    fn rigid_truth(&mut self) -> Result<Truth, Failure> {
        let curve = Curve {
            engine: Engine::Generated,
            precision: Precision::F64,
            integrator: Integrator::Dop853,
            treatment: Treatment::Joint,
        };
        let plan = self.plan(&curve, Setting::Tolerance(TIGHT), 10_000_000, None);
        let run = self.run((Engine::Generated, Precision::F64), &plan).map_err(Failure::Run)?;
        let source = format!(
            "the generated code itself by dop853 at a tolerance of {TIGHT:e}, from event to event, because nothing else \
             follows rigid stops and friction that sticks: errors below {FLOOR:e} are not known and are shown as that"
        );
        Ok(Truth::of_samples(&self.model, (source, FLOOR), &run.samples))
    }

    /// Whether it has rigid stops or friction that sticks: runs are in joint coordinates, by explicit methods.
    pub(crate) fn touches(&self) -> bool {
        !self.start.contacts.is_empty()
    }

    /// A model file of this name elsewhere is another scene.
    fn is_shipped(&self) -> bool {
        files::shown(&self.path) == format!("models/{}.toml", self.name)
    }

    /// A run of a curve.
    pub(crate) fn plan(
        &self,
        curve: &Curve,
        setting: Setting,
        budget: u64,
        measure_for: Option<f64>,
    ) -> Plan {
        let (step, every) = match setting {
            Setting::Tolerance(_) => (self.t_end, INTERVALS),
            // Samples are taken where a step ends.
            Setting::Steps(n) => (self.t_end / n as f64, common(n, INTERVALS)),
        };
        let settings = Settings {
            t_end: self.t_end,
            step,
            correct_every: None,
            sample_every: self.t_end / every as f64,
        };
        Plan { settings, approach: curve.approach(setting, budget), measure_for }
    }

    /// What is asked of whoever makes a run.
    pub(crate) fn request(&self, plan: &Plan) -> Request {
        Request {
            settings: plan.settings,
            approach: plan.approach,
            parameters: self.parameters.clone(),
            start: self.start.clone(),
            measure_for: plan.measure_for,
        }
    }

    /// Makes a run, or returns the reason why it is not complete.
    pub(crate) fn run(&mut self, who: (Engine, Precision), plan: &Plan) -> Result<Run, String> {
        let request = self.request(plan);
        let session = self.session(who)?;
        let mut samples = Vec::new();
        let answer = session.ask(&request, |event| {
            if let Event::Sample(sample) = event {
                samples.push(sample.clone());
            }
        });
        match answer {
            Ok((summary, timing)) => Ok(Run { samples, summary, timing }),
            Err(failure) => {
                let words = failure.words();
                // A program that is gone answers nothing any more.
                if words.contains("ended without an answer") {
                    self.sessions.retain(|(whose, _)| *whose != who);
                }
                Err(words)
            }
        }
    }

    fn session(&mut self, who: (Engine, Precision)) -> Result<&mut Session, String> {
        let at = match self.sessions.iter().position(|(whose, _)| *whose == who) {
            Some(at) => at,
            None => {
                let session = self.open(who).map_err(|failure| failure.words())?;
                self.sessions.push((who, session));
                self.sessions.len() - 1
            }
        };
        Ok(&mut self.sessions[at].1)
    }

    fn open(&self, (engine, precision): (Engine, Precision)) -> Result<Session, Failure> {
        let form = match engine {
            Engine::Generated => {
                let program = usize::from(precision == Precision::F32);
                return Session::open(&self.programs[program], &[]);
            }
            Engine::Recursive => "recursive",
            Engine::Careful => "careful",
            Engine::Dense => "dense",
        };
        let model = self.path.to_string_lossy();
        let arguments = ["answer", &model, form, precision.name()];
        Session::open(&self.assembled, &arguments)
    }

    /// A point of a curve.
    pub(crate) fn point(
        &mut self,
        truth: &Truth,
        curve: &Curve,
        setting: Setting,
        limits: (u64, f64),
    ) -> Point {
        let plan = self.plan(curve, setting, limits.0, Some(limits.1));
        let t_end = self.t_end;
        let outcome = self.run((curve.engine, curve.precision), &plan).map(|run| {
            let timing = run.timing.unwrap_or_default();
            let errors = truth.errors(&run.samples, t_end);
            Outcome {
                error: truth.judge(&errors),
                errors,
                measured: timing.measured.seconds,
                seconds: timing.measured.seconds,
                ratio: timing.measured.ratio,
                statistics: timing.statistics,
                position_violation: run.summary.position_violation,
                velocity_violation: run.summary.velocity_violation,
                energy_drift: run.summary.energy_drift,
            }
        });
        Point { curve: *curve, setting, outcome }
    }
}

/// The tolerance where there is no reference solution.
const TIGHT: f64 = 1e-13;

/// What such a run may be off by itself: tolerances are of single steps.
const FLOOR: f64 = 1e-11;

/// The greatest common divisor.
fn common(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { common(b, a % b) }
}
