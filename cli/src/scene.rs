//! What is to be simulated: a model file with the command line's changes.

use crate::args::{Engine, Precision, SimulateArgs};
use crate::choice::{Chosen, choose};
use crate::failure::Failure;
use crate::progress::Spinner;
use crate::{contacts, controllers, events, files, inputs, kinks, paths, remarks};
use gyro_model::{ForceKind, JointKind, Model, Move, Number, Rational, Support};
use gyro_runner::{
    Approach, Controller, Coordinates, Correction, Input, Offers, Settings, Start, any_varies,
};
use std::path::Path;

/// A run to be made.
#[derive(Clone, Debug)]
pub(crate) struct Scene {
    /// The model as its model file gives it: what code is generated from.
    pub(crate) page: Model,
    /// The model file's name in generated code.
    pub(crate) page_name: String,
    /// The model with the parameters of this run.
    pub(crate) model: Model,
    pub(crate) settings: Settings,
    pub(crate) approach: Approach,
    /// What of it was chosen, and why.
    pub(crate) chosen: Chosen,
    /// What could have been asked for.
    pub(crate) offers: Offers,
    /// Whether all work is accounted for, so that the energy's balance has to close.
    pub(crate) is_balanced: bool,
    pub(crate) start: Start,
    /// How far the assembly has moved what the model file gives of the start.
    pub(crate) moved: Vec<Move>,
    pub(crate) engine: Engine,
    pub(crate) precision: Precision,
    /// How long generated code is searched for short forms.
    pub(crate) effort: gyro_codegen::Effort,
    /// Whether what runs in this process is proved beside it.
    pub(crate) proves: bool,
    /// Whether the run is compared with other ones of the same mechanism.
    pub(crate) has_companions: bool,
    /// How the names of its files begin: a linearisation leaves those of a whole run alone.
    pub(crate) results: String,
}

impl Scene {
    /// Reads the model file, sets parameters, assembles the start and reads the inputs.
    pub(crate) fn new(args: &SimulateArgs) -> Result<Self, Failure> {
        let page = read_counting_work(&args.model)?;
        remarks::report_redundant(&page, &args.model.display().to_string(), args.strict)?;
        Self::of(page, files::shown(&args.model), args)
    }

    /// The same of a model that was read before.
    pub(crate) fn of(page: Model, page_name: String, args: &SimulateArgs) -> Result<Self, Failure> {
        let mut model = with_parameters(&page, &args.set)?;
        events::add(&mut model, &args.event)?;
        contacts::refuse_shared_reactions(&model)?;
        let inputs = inputs::inputs(&model, &args.input)?;
        inputs::start_motions(&mut model, &inputs);
        let start_controllers = controllers::controllers(&model);
        let offers = Offers {
            inputs_vary: any_varies(&inputs) || !start_controllers.is_empty(),
            touches: model.has_rigid_contacts(),
            period: start_controllers.iter().map(Controller::period_s).reduce(f64::min),
            ..offers(args)
        };
        let (approach, chosen) = choose(&model, args, &offers);
        let settings = settings(&model, args, &approach);
        refuse_joint_coordinates(&model, args, &approach)?;
        if let Some(words) = refusal(&offers, &settings, &approach, args) {
            return Err(Failure::Usage(words));
        }
        inputs::refuse_held_motions(&model, &inputs, &approach)?;
        let assembled = model
            .assemble()
            .map_err(|e| Failure::Usage(format!("{}: {e}: {}", args.model.display(), e.help())))?;
        let start = Start { inputs, ..start(&model, &assembled) };
        let moved = assembled.moved;
        Ok(Self {
            page,
            page_name,
            settings,
            approach,
            chosen,
            offers,
            is_balanced: is_balanced(&model, &start.inputs),
            results: format!("{}{}", model.name, if args.linearize.is_some() { "-linearized" } else { "" }),
            model,
            start,
            moved,
            engine: args.engine(),
            precision: args.precision,
            effort: args.effort.into(),
            proves: !args.no_prove,
            has_companions: args.verify,
        })
    }

    /// Values of the parameters in their order.
    pub(crate) fn parameters(&self) -> Vec<f64> {
        self.model.parameters.iter().map(|p| gyro_model::to_f64(&p.value)).collect()
    }

    /// Has it run as is fit for a scene that was found to be stiff at this time.
    pub(crate) fn turn(&mut self, t: f64) {
        self.approach = self.chosen.turn(&self.approach, t);
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

/// Reads and checks a model file; tables of motions are beside it.
pub(crate) fn read(path: &Path) -> Result<Model, Failure> {
    let text = files::read_module(path)?;
    let _spinner = Spinner::new(format!("reading {}", path.display()));
    read_text(&path.display().to_string(), &text, path.parent().unwrap_or(Path::new("")))
}

/// Checks the text of a model file; tables of motions are in `folder`.
pub(crate) fn read_text(file: &str, text: &str, folder: &Path) -> Result<Model, Failure> {
    let mut load = |table: &str| {
        let path = folder.join(table);
        files::input(&path, files::LARGEST_TABLE).map_err(|e| format!("{}: {e}", path.display()))
    };
    gyro_model::read_with(file, text, &mut load).map_err(Failure::ModelFile)
}

/// The same for a run, whose balance of energy needs the work even where the model file leaves it out of the module.
pub(crate) fn read_counting_work(path: &Path) -> Result<Model, Failure> {
    read(path).map(counting_work)
}

/// A model for runs.
pub fn counting_work(model: Model) -> Model {
    Model { counts_work: true, ..model }
}

/// Joint coordinates are for generated code.
fn refuse_joint_coordinates(model: &Model, args: &SimulateArgs, approach: &Approach) -> Result<(), Failure> {
    let asks = match args.coordinates {
        Some(_) => "--coordinates joint",
        None if model.simulation.coordinates.is_some() => "coordinates = \"joint\" in [simulation]",
        None => return Ok(()),
    };
    if approach.coordinates != Coordinates::Joint {
        return Ok(());
    }
    if args.engine().is_generated() {
        return Ok(());
    }
    Err(Failure::Usage(format!(
        "{asks}: runtime-assembled models run in maximal coordinates: for joint coordinates leave out --engine"
    )))
}

fn with_parameters(page: &Model, set: &[(String, Rational)]) -> Result<Model, Failure> {
    for (k, (name, _)) in set.iter().enumerate() {
        if set[..k].iter().any(|(earlier, _)| earlier == name) {
            return Err(Failure::Usage(format!("--set gives `{name}` twice")));
        }
    }
    page.with_parameters(set).map_err(|words| Failure::Usage(format!("--set: {words}")))
}

/// What the engine and the model allow.
fn offers(args: &SimulateArgs) -> Offers {
    let is_generated = args.engine().is_generated();
    let epsilon = match args.precision {
        Precision::F32 => f64::from(f32::EPSILON),
        Precision::F64 => f64::EPSILON,
    };
    Offers { joint_space: is_generated, derivatives: is_generated, epsilon, ..Offers::ALL }
}

/// An input that changes a conservative force while it acts does work that the mechanism does not count.
fn is_balanced(model: &Model, inputs: &[Input]) -> bool {
    let varies = |number: &Number| match number {
        Number::Input { index, .. } => {
            controllers::setting(model, *index).is_some()
                || inputs.iter().any(|input| input.index == *index && any_varies(std::slice::from_ref(input)))
        }
        Number::Exact(_) | Number::Parameter { .. } | Number::Computed(_) | Number::Formula(_) => false,
    };
    !model.forces.iter().any(|force| match &force.kind {
        ForceKind::Spring { stiffness, free, .. } => varies(stiffness) || varies(free),
        ForceKind::Link { stiffness, free_length, .. } => varies(stiffness) || varies(free_length),
        _ => false,
    })
}

/// What cannot be done as it was asked for. Under error control the model file's step is none of the run's.
fn refusal(offers: &Offers, settings: &Settings, approach: &Approach, args: &SimulateArgs) -> Option<String> {
    if args.linearize.is_some() && !offers.joint_space {
        let words =
            "--linearize is about joint coordinates: for mechanisms that have them, and generated code";
        return Some(words.to_owned());
    }
    offers.refusal(&gyro_runner::scheduled(settings, approach), approach)
}

fn settings(model: &Model, args: &SimulateArgs, approach: &Approach) -> Settings {
    let page = &model.simulation;
    let step = args.step.unwrap_or(page.step);
    let correct_every = (approach.coordinates == Coordinates::Maximal
        && approach.correction != Correction::None)
        .then_some(args.correct_every.unwrap_or(page.correct_every));
    let sample_every = match approach.tolerance {
        Some(_) => page.sample_every,
        None => nearest_multiple(page.sample_every, correct_every.unwrap_or(step)),
    };
    Settings {
        t_end: args.linearize.or(args.t_end).unwrap_or(page.t_end),
        step,
        correct_every,
        sample_every: args.every.unwrap_or(sample_every),
    }
}

/// Samples that were not requested at other times fall on corrections (or steps): they shall not shorten a step.
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
        states: assembled.states.clone(),
        turn_references: model
            .turn_references()
            .into_iter()
            .map(|c| position(c.joint, c.coordinate))
            .collect(),
        angles,
        inputs: Vec::new(),
        knots: model.knots(),
        observed_bodies: observed(model).into_iter().map(|(moving_body, _)| moving_body).collect(),
        controllers: controllers::controllers(model),
        watches: events::watches(model),
        kinks: kinks::kinks(model),
        contacts: contacts::contacts(model),
        paths: paths::paths(model),
    }
}

/// Slot and name of each free body.
pub fn observed(model: &Model) -> Vec<(usize, &str)> {
    let bodies = model.coordinate_bodies().into_iter().map(|b| &model.bodies[b]).enumerate();
    bodies
        .filter(|(_, b)| b.support == Support::Free)
        .map(|(moving_body, b)| (moving_body, b.name.as_str()))
        .collect()
}
