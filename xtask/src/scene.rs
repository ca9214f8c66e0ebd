//! What is to be simulated: a model page with the command line's changes.

use crate::args::{Engine, Precision, SimulateArgs};
use crate::failure::Failure;
use crate::files;
use gyro_model::{AssemblyError, JointKind, Method, Model, Rational, Support};
use gyro_runner::{Settings, Start};
use std::path::Path;

/// A run to be made.
#[derive(Debug)]
pub(crate) struct Scene {
    /// The model as its page gives it: what code is generated from.
    pub(crate) page: Model,
    /// The page's name in generated code.
    pub(crate) page_name: String,
    /// The model with the parameters of this run.
    pub(crate) model: Model,
    pub(crate) settings: Settings,
    pub(crate) start: Start,
    pub(crate) engine: Engine,
    pub(crate) precision: Precision,
}

impl Scene {
    /// Reads the page, sets parameters and assembles the start.
    pub(crate) fn new(args: &SimulateArgs) -> Result<Self, Failure> {
        let page = read(&args.model)?;
        let model = with_parameters(&page, &args.set)?;
        let settings = settings(&model, args);
        settings.check().map_err(|e| Failure::Usage(e.to_string()))?;
        let start = start(&model).map_err(|e| Failure::Usage(format!("{}: {e}", args.model.display())))?;
        let page_name = files::shown(&args.model);
        Ok(Self { page, page_name, model, settings, start, engine: args.engine, precision: args.precision })
    }

    /// Values of the parameters in their order.
    pub(crate) fn parameters(&self) -> Vec<f64> {
        self.model.parameters.iter().map(|p| gyro_model::to_f64(&p.value)).collect()
    }

    /// The algorithm's name.
    pub(crate) fn method(&self) -> &'static str {
        if self.settings.correct_every.is_some() { "partitioned" } else { "direct" }
    }
}

/// Reads and checks a model page.
pub(crate) fn read(path: &Path) -> Result<Model, Failure> {
    let text = files::read_page(path)?;
    gyro_model::read(&path.display().to_string(), &text).map_err(Failure::Page)
}

fn with_parameters(page: &Model, set: &[(String, Rational)]) -> Result<Model, Failure> {
    for (k, (name, _)) in set.iter().enumerate() {
        if set[..k].iter().any(|(earlier, _)| earlier == name) {
            return Err(Failure::Usage(format!("--set gives `{name}` twice")));
        }
    }
    page.with_parameters(set).map_err(|words| Failure::Usage(format!("--set: {words}")))
}

fn settings(model: &Model, args: &SimulateArgs) -> Settings {
    let page = &model.simulation;
    let method = args.method.map_or(page.method, Method::from);
    let step = args.step.unwrap_or(page.step);
    let correct_every =
        (method == Method::Partitioned).then_some(args.correct_every.unwrap_or(page.correct_every));
    let grid = correct_every.unwrap_or(step);
    Settings {
        t_end: args.t_end.unwrap_or(page.t_end),
        step,
        correct_every,
        sample_every: args.every.unwrap_or_else(|| nearest_multiple(page.sample_every, grid)),
    }
}

/// Samples that nobody asked for at other times fall on corrections (or steps): they shall not shorten a step.
fn nearest_multiple(interval: f64, grid: f64) -> f64 {
    grid * (interval / grid).round().max(1.0)
}

/// The assembled start; free bodies are observed, as no joint shows how they move.
pub(crate) fn start(model: &Model) -> Result<Start, AssemblyError> {
    let assembled = model.assemble()?;
    let angle = |(joint, start): (&gyro_model::Joint, &gyro_model::JointStart)| match joint.kind {
        JointKind::Revolute => start.position[0],
        JointKind::Spherical | JointKind::Fixed => 0.0,
    };
    Ok(Start {
        angles: model.joints.iter().zip(&assembled.joints).map(angle).collect(),
        positions: assembled.q,
        velocities: assembled.v,
        observed_bodies: observed(model).into_iter().map(|(slot, _)| slot).collect(),
    })
}

/// Slot and name of each free body.
pub(crate) fn observed(model: &Model) -> Vec<(usize, &str)> {
    let bodies = model.coordinate_bodies().into_iter().map(|b| &model.bodies[b]).enumerate();
    bodies.filter(|(_, b)| b.support == Support::Free).map(|(slot, b)| (slot, b.name.as_str())).collect()
}
