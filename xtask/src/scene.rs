//! What is to be simulated: a model page with the command line's changes.

use crate::args::{Engine, Precision, SimulateArgs};
use crate::failure::Failure;
use crate::progress::Spinner;
use crate::{files, inputs, remarks};
use gyro_model::{JointKind, Method, Model, Move, Rational, Support};
use gyro_runner::{Approach, Coordinates, Correction, Settings, Start};
use std::path::Path;

/// A run to be made.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    /// The model as its page gives it: what code is generated from.
    pub(crate) page: Model,
    /// The page's name in generated code.
    pub(crate) page_name: String,
    /// The model with the parameters of this run.
    pub(crate) model: Model,
    pub(crate) settings: Settings,
    pub(crate) approach: Approach,
    pub(crate) start: Start,
    /// How far the assembly has moved what the page gives of the start.
    pub(crate) moved: Vec<Move>,
    pub(crate) engine: Engine,
    pub(crate) precision: Precision,
}

impl Scene {
    /// Reads the page, sets parameters, assembles the start and reads what is fed in.
    pub(crate) fn new(args: &SimulateArgs) -> Result<Self, Failure> {
        let page = read(&args.model)?;
        remarks::report_redundant(&page, &args.model.display().to_string(), args.strict)?;
        let model = with_parameters(&page, &args.set)?;
        let settings = settings(&model, args);
        settings.check().map_err(|e| Failure::Usage(e.to_string()))?;
        let assembled =
            model.assemble().map_err(|e| Failure::Usage(format!("{}: {e}", args.model.display())))?;
        let start = Start { inputs: inputs::inputs(&model, &args.input)?, ..start(&model, &assembled) };
        let page_name = files::shown(&args.model);
        let moved = assembled.moved;
        Ok(Self {
            page,
            page_name,
            settings,
            approach: approach(&model, args),
            model,
            start,
            moved,
            engine: args.engine,
            precision: args.precision,
        })
    }

    /// Values of the parameters in their order.
    pub(crate) fn parameters(&self) -> Vec<f64> {
        self.model.parameters.iter().map(|p| gyro_model::to_f64(&p.value)).collect()
    }

    /// The algorithm's name.
    pub(crate) fn method(&self) -> String {
        match (self.approach.coordinates, self.approach.correction) {
            (Coordinates::Joint, _) => "joint".to_owned(),
            (_, Correction::Partition) => "partitioned".to_owned(),
            (_, Correction::None) => "direct".to_owned(),
            (_, other) => other.to_string(),
        }
    }
}

/// Reads and checks a model page; tables of motions are beside it.
pub(crate) fn read(path: &Path) -> Result<Model, Failure> {
    let text = files::read_page(path)?;
    let _spinner = Spinner::new(format!("reading {}", path.display()));
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut load = |table: &str| {
        let path = folder.join(table);
        files::input(&path, files::LARGEST_TABLE).map_err(|e| format!("{}: {e}", path.display()))
    };
    gyro_model::read_with(&path.display().to_string(), &text, &mut load).map_err(Failure::Page)
}

fn with_parameters(page: &Model, set: &[(String, Rational)]) -> Result<Model, Failure> {
    for (k, (name, _)) in set.iter().enumerate() {
        if set[..k].iter().any(|(earlier, _)| earlier == name) {
            return Err(Failure::Usage(format!("--set gives `{name}` twice")));
        }
    }
    page.with_parameters(set).map_err(|words| Failure::Usage(format!("--set: {words}")))
}

fn approach(model: &Model, args: &SimulateArgs) -> Approach {
    let correction = match (args.correction, args.method.map_or(model.simulation.method, Method::from)) {
        (Some(correction), _) => correction,
        (None, Method::Partitioned) => Correction::Partition,
        (None, Method::Direct) => Correction::None,
    };
    Approach {
        integrator: args.integrator,
        tolerance: args.tolerance,
        coordinates: args.coordinates,
        correction,
        when: args.correct_when,
        budget: args.budget,
        examine: args.verify || args.linearize.is_some(),
    }
}

fn settings(model: &Model, args: &SimulateArgs) -> Settings {
    let page = &model.simulation;
    let method = args.method.map_or(page.method, Method::from);
    let step = args.step.unwrap_or(page.step);
    let is_corrected = match args.correction {
        Some(correction) => correction != Correction::None,
        None => method == Method::Partitioned,
    };
    let correct_every = is_corrected.then_some(args.correct_every.unwrap_or(page.correct_every));
    let grid = correct_every.unwrap_or(step);
    Settings {
        t_end: args.linearize.or(args.t_end).unwrap_or(page.t_end),
        step,
        correct_every,
        sample_every: args.every.unwrap_or_else(|| nearest_multiple(page.sample_every, grid)),
    }
}

/// Samples that nobody asked for at other times fall on corrections (or steps): they shall not shorten a step.
fn nearest_multiple(interval: f64, grid: f64) -> f64 {
    grid * (interval / grid).round().max(1.0)
}

/// Where a run starts; free bodies are observed, as no joint shows how they move.
pub(crate) fn start(model: &Model, assembled: &gyro_model::Start) -> Start {
    let position = |joint: usize, coordinate: usize| assembled.joints[joint].position[coordinate];
    let mut angles = Vec::new();
    for (joint, described) in model.joints.iter().enumerate() {
        if described.kind == JointKind::Spherical {
            angles.push(0.0);
        }
        angles.extend((0..described.kind.coordinates().len()).map(|k| position(joint, k)));
    }
    Start {
        positions: assembled.q.clone(),
        velocities: assembled.v.clone(),
        turn_references: model
            .turn_references()
            .into_iter()
            .map(|c| position(c.joint, c.coordinate))
            .collect(),
        angles,
        inputs: Vec::new(),
        observed_bodies: observed(model).into_iter().map(|(slot, _)| slot).collect(),
    }
}

/// Slot and name of each free body.
pub(crate) fn observed(model: &Model) -> Vec<(usize, &str)> {
    let bodies = model.coordinate_bodies().into_iter().map(|b| &model.bodies[b]).enumerate();
    bodies.filter(|(_, b)| b.support == Support::Free).map(|(slot, b)| (slot, b.name.as_str())).collect()
}
