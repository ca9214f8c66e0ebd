//! Every kind of joint, force and output in one mechanism with loops, a coupler and a driver: generated code against
//! the runtime-assembled model.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_model::{Model, to_f64};
use gyro_runner::{Between, Input, JointSample, Sample, Settings};
use gyro_sim_suite::own::all_joints::index;
use gyro_sim_suite::{Engine, Run, compiled, dense, fed, generated, model, simulate, worst};

/// Long enough for all of it to move, at the model file's step.
const SETTINGS: Settings = Settings { t_end: 0.3, step: 1e-3, correct_every: Some(5e-3), sample_every: 0.03 };

/// Coordinates (rad, m), rates, and outputs over their largest: the same algorithm on both sides, but for the order of
/// sums and the choice of independent coordinates.
const AGREEMENT: f64 = 1e-9;

/// Newton's method ends at a few roundings of one.
const VIOLATION: f64 = 1e-12;

/// RK4 at a step of a millisecond, with a stop that sets in over a hundredth of a metre.
const BALANCE: f64 = 1e-8;

fn run(mechanism: &Engine, model: &Model) -> Run {
    let rows = vec![[0.0, 0.02], [0.1, 0.3], [0.2, -0.1]];
    let (samples, outcome) = fed(mechanism, model, &SETTINGS, vec![Input::new(0, rows, Between::Linear)]);
    Run { samples, summary: outcome.unwrap_or_else(|failure| panic!("{failure}")) }
}

/// Coordinates and rates in one list.
fn coordinates(sample: &Sample) -> Vec<f64> {
    let of_joint = |joint: &JointSample| match *joint {
        JointSample::Angle { position, rate } | JointSample::Length { position, rate } => {
            vec![position, rate]
        }
        JointSample::Orientation { position, rate } => [&position[..], &rate].concat(),
    };
    sample.coordinates.iter().flat_map(of_joint).collect()
}

/// The worst differences of coordinates and of outputs, each over the largest of its sample.
fn differences(a: &Run, b: &Run) -> [f64; 2] {
    let relative =
        |a: &[f64], b: &[f64]| worst(a, b) / a.iter().fold(1.0, |largest: f64, x| largest.max(x.abs()));
    let of_samples = a
        .samples
        .iter()
        .zip(&b.samples)
        .map(|(a, b)| [relative(&coordinates(a), &coordinates(b)), relative(&a.outputs, &b.outputs)]);
    of_samples.fold([0.0; 2], |[x, y], [a, b]| [x.max(a), y.max(b)])
}

#[test]
fn both_engines_move_alike() {
    let model = model("all-joints");
    assert_eq!((model.degrees_of_freedom(), model.redundant.len()), (2, 0));
    let (generated, dense) = (generated("all-joints"), dense(&model));
    let (generated, dense) = (run(&generated, &model), run(&dense, &model));
    let found = differences(&generated, &dense);
    println!("all joints: coordinates and outputs differ by {found:?}; {:?}", generated.summary);
    assert!(found.iter().all(|error| *error <= AGREEMENT), "{found:?}");
    assert!(found.iter().any(|error| *error > 0.0), "bit for bit the same: one is compared with itself");
    for run in [&generated, &dense] {
        assert!(run.summary.position_violation <= VIOLATION, "{:?}", run.summary);
        assert!(run.summary.energy_drift <= BALANCE, "{:?}", run.summary);
        assert!(run.last().work.abs() > 1e-3, "the driver and the wind do work");
    }
}

#[test]
fn parameters_change_the_mechanism() {
    // Half the gear's ratio and a heavier puck: what the model file says with other numbers, and the parameters of the
    // generated type.
    let text = ["gear_ratio", "puck_mass"].map(str::to_owned);
    let [ratio, mass] = ["-0.25", "0.9"].map(|x| gyro_model::parse_decimal(x).unwrap());
    let [first, second] = text;
    let model =
        model("all-joints").with_parameters(&[(first, ratio.clone()), (second, mass.clone())]).unwrap();
    let mut mechanism = compiled::<f64>("all-joints");
    for (place, value) in [(index::parameter::GEAR_RATIO, &ratio), (index::parameter::PUCK_MASS, &mass)] {
        assert!(mechanism.set_parameter(place, to_f64(value)));
    }
    let mechanism = Engine::new(mechanism);
    let run = [&mechanism, &dense(&model)].map(|engine| run(engine, &model));
    let found = differences(&run[0], &run[1]);
    println!("all joints, other parameters: {found:?}");
    assert!(found.iter().all(|error| *error <= AGREEMENT), "{found:?}");
    let unchanged = simulate(&generated("all-joints"), &model_as_written(), &SETTINGS);
    assert!(differences(&run[0], &unchanged)[0] > 1e-3, "the parameters change nothing");
}

fn model_as_written() -> Model {
    model("all-joints")
}
