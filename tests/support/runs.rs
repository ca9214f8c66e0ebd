//! Runs of a mechanism from its model's start, by the loop that the command line uses.

use crate::Engine;
use gyro_model::{Joint, JointKind, Model, OutputKind};
use gyro_runner::motion::MotionBuilder;
use gyro_runner::{
    Approach, Event, Failure, Input, JointSample, Judgement, Measure, Sample, Settings, Start, Summary,
    balance, companions, judge, run, run_by,
};
use gyro_sim::{Dynamics, Mechanism, Real};

/// The paper's settings for one second, section 7.
pub const PAPER: Settings =
    Settings { t_end: 1.0, step: 1e-4, correct_every: Some(5e-4), sample_every: 0.01 };

/// What a run gave.
#[derive(Clone, Debug)]
pub struct Run {
    /// The samples, the start first.
    pub samples: Vec<Sample>,
    /// The worst of all samples.
    pub summary: Summary,
}

impl Run {
    /// The sample at a time.
    ///
    /// # Panics
    /// If there is none.
    pub fn at(&self, t: f64) -> &Sample {
        let at = self.samples.partition_point(|sample| sample.t < t - 1e-9);
        self.samples
            .get(at)
            .filter(|s| (s.t - t).abs() < 1e-9)
            .unwrap_or_else(|| panic!("no sample at {t} s"))
    }

    /// The last sample.
    pub fn last(&self) -> &Sample {
        self.samples.last().expect("a run has a sample at its start")
    }
}

/// The start of a model, with all its bodies observed.
pub fn start_of(model: &Model) -> Start {
    let start = model.assemble().expect("the model has a start");
    let angles = start.joints.iter().zip(&model.joints).flat_map(|(joint, description)| {
        // An orientation is one coordinate, and no angle.
        let is_spherical = description.kind == JointKind::Spherical;
        if is_spherical { vec![0.0] } else { joint.position.clone() }
    });
    let turns = model.turn_references().into_iter();
    Start {
        angles: angles.collect(),
        states: start.states,
        turn_references: turns.map(|turn| start.joints[turn.joint].position[turn.coordinate]).collect(),
        observed_bodies: (0..model.coordinate_bodies().len()).collect(),
        positions: start.q,
        velocities: start.v,
        ..Start::default()
    }
}

/// Runs a mechanism of this model.
///
/// # Panics
/// If the run fails.
pub fn simulate(mechanism: &Engine, model: &Model, settings: &Settings) -> Run {
    let (samples, outcome) = fed(mechanism, model, settings, Vec::new());
    let summary = outcome.unwrap_or_else(|failure| panic!("{}: {failure}", model.name));
    Run { samples, summary }
}

/// The same with inputs; a run that fails gives the samples up to there.
pub fn fed(
    mechanism: &Engine,
    model: &Model,
    settings: &Settings,
    inputs: Vec<Input>,
) -> (Vec<Sample>, Result<Summary, Failure>) {
    let mut samples = Vec::new();
    let start = Start { inputs, ..start_of(model) };
    let outcome = run(&mut mechanism.clone(), settings, &start, |event| {
        if let Event::Sample(sample) = event {
            samples.push(sample.clone());
        }
        Ok(())
    });
    (samples, outcome)
}

/// A run by any approach: its samples, as far as it came, and how it ended.
pub fn moved<T: Real + 'static>(
    mechanism: &Engine<T>,
    builder: &dyn MotionBuilder<Engine<T>>,
    by: (&Settings, &Approach),
    start: &Start,
) -> (Vec<Sample>, Result<Summary, Failure>) {
    let mut samples = Vec::new();
    let outcome = run_by(&mut mechanism.clone(), builder, by, start, |event| {
        if let Event::Sample(sample) = event {
            samples.push(sample.clone());
        }
        Ok(())
    });
    (samples, outcome)
}

/// What a run is worth as the command line judges it: beside the first companion that comes to its end and whose own
/// balance closes, else beside the first.
pub fn judged(
    mechanism: &Engine,
    builder: &dyn MotionBuilder<Engine>,
    (settings, approach): (&Settings, &Approach),
    start: &Start,
    (samples, summary): (&[Sample], &Summary),
) -> Option<Judgement> {
    let (tolerance, size) = (approach.tolerance, mechanism.size());
    let measure = Measure { tolerance, size, is_balanced: true };
    let mut doubtful = None;
    for (settings, approach) in companions(settings, approach) {
        let (others, outcome) = moved(mechanism, builder, (&settings, &approach), start);
        let Ok(other) = outcome else { continue };
        let judgement = judge((samples, summary), (&others, &other), &measure);
        if balance(&other, true).is_empty() {
            return Some(judgement);
        }
        doubtful = doubtful.or(Some(judgement));
    }
    doubtful
}

/// The settings that a model file asks for, with samples so far apart.
pub fn as_paged(model: &Model, sample_every: f64) -> Settings {
    let asked = &model.simulation;
    Settings { t_end: asked.t_end, step: asked.step, correct_every: Some(asked.correct_every), sample_every }
}

/// Runs the mechanism of a model file as the model file asks, sampled twenty times.
pub fn played(mechanism: &Engine, model: &Model) -> Run {
    simulate(mechanism, model, &as_paged(model, model.simulation.t_end / 20.0))
}

/// Value and rate of a scalar coordinate, counted joint after joint.
///
/// # Panics
/// If it is an orientation.
pub fn coordinate(sample: &Sample, index: usize) -> (f64, f64) {
    match sample.coordinates[index] {
        JointSample::Angle { position, rate } | JointSample::Length { position, rate } => (position, rate),
        other => panic!("coordinate {index} is no number: {other:?}"),
    }
}

/// The numbers of the output of this name.
///
/// # Panics
/// If there is none.
pub fn output(mechanism: &Engine, sample: &Sample, name: &str) -> Vec<f64> {
    let is_asked = |index: &usize| mechanism.description().outputs[*index].name == name;
    let found: Vec<f64> =
        (0..mechanism.description().outputs.len()).filter(is_asked).map(|k| sample.outputs[k]).collect();
    assert!(!found.is_empty(), "there is no output `{name}`");
    found
}

/// λ of all rows at a sample of all bodies.
pub fn multipliers(mechanism: &Engine, model: &Model, sample: &Sample) -> Vec<f64> {
    let mut values: Vec<f64> = sample.bodies.iter().flat_map(|body| body.pose).collect();
    values.extend(sample.bodies.iter().flat_map(|body| body.velocity));
    values.extend(model.has_work().then_some(sample.work));
    let first = |joint: usize| -> usize { model.joints[..joint].iter().map(n_samples).sum() };
    let columns = model.outputs.iter().flat_map(|output| {
        let is_state = matches!(output.kind, OutputKind::State { .. });
        output.kind.columns().iter().map(move |_| is_state)
    });
    values.extend(columns.zip(&sample.outputs).filter(|(is_state, _)| *is_state).map(|(_, value)| *value));
    let turns = model.turn_references().into_iter();
    values.extend(turns.map(|turn| coordinate(sample, first(turn.joint) + turn.coordinate).0));
    let (mut accelerations, mut lambda) = (mechanism.acceleration_buffer(), mechanism.buffers().rows);
    mechanism.accelerations(sample.t, &values, &mut accelerations);
    mechanism.multipliers(sample.t, &values, &accelerations, &mut lambda);
    lambda
}

/// How many coordinates a sample has of a joint: an orientation is one.
fn n_samples(joint: &Joint) -> usize {
    if joint.kind == JointKind::Spherical { 1 } else { joint.kind.coordinates().len() }
}
