//! Every shipped model file has its reference solution and starts as it says: right numbers, joints in the right
//! order.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_model::Model;
use gyro_reference::{JointRow, SceneReference, scene};
use gyro_runner::{Approach, Coordinates, JointSample, Sample, Settings};
use gyro_sim_suite::{
    Duals, Engine, fixture_folders, generated, generated_with_joints, model, moved, rotation, simulate,
    start_of,
};

/// Steps of the model file's own length.
const STEPS: f64 = 20.0;

/// Over one and the value. Most model files take steps of a hundredth of a radian, the torsional spring of several.
const AGREEMENT: f64 = 1e-8;

/// Positions and rates of all joints, orientations as rotation matrices.
fn found(sample: &Sample) -> Vec<f64> {
    let (mut positions, mut rates, mut orientations) = (Vec::new(), Vec::new(), Vec::new());
    for joint in &sample.coordinates {
        match *joint {
            JointSample::Angle { position, rate } | JointSample::Length { position, rate } => {
                positions.push(position);
                rates.push(rate);
            }
            JointSample::Orientation { position, rate } => {
                orientations.extend(rotation(position).concat());
                orientations.extend(rate);
            }
        }
    }
    [positions, rates, orientations].concat()
}

fn expected(row: &JointRow) -> Vec<f64> {
    let orientations =
        row.orientations.iter().flat_map(|o| [&o.rotation.concat()[..], &o.angular_velocity].concat());
    row.positions.iter().chain(&row.rates).copied().chain(orientations).collect()
}

fn settings(model: &Model) -> Settings {
    let step = model.simulation.step;
    Settings { t_end: STEPS * step, step, correct_every: Some(5.0 * step), sample_every: 5.0 * step }
}

/// The worst error of a model file in its first steps; `None` if it has no reference.
fn error(page: &str, reference: &str) -> Option<f64> {
    let (scene, model) = (scene(reference)?, model(page));
    let run = simulate(&generated(page), &model, &settings(&model));
    Some(worst(page, &run.samples, &scene))
}

fn worst(page: &str, samples: &[Sample], scene: &SceneReference) -> f64 {
    let times: Vec<f64> = samples.iter().map(|sample| sample.t).collect();
    let rows = scene.solve(&times);
    let errors = samples.iter().zip(&rows).flat_map(|(sample, row)| {
        let (found, expected) = (found(sample), expected(row));
        assert_eq!(found.len(), expected.len(), "{page}: {found:?} {expected:?}");
        found.into_iter().zip(expected).map(|(a, b)| (a - b).abs() / (1.0 + b.abs())).collect::<Vec<_>>()
    });
    errors.fold(0.0, |worst: f64, x| if x.is_nan() { x } else { worst.max(x) })
}

#[test]
fn every_shipped_page_with_joints_moves_as_its_reference() {
    let mut failed = Vec::new();
    for page in fixture_folders()[0].pages() {
        let Some(error) = error(&page, &page) else {
            assert!(
                model(&page).joints.is_empty(),
                "{page} has no reference: add it to gyro_reference::scene"
            );
            continue;
        };
        println!("{page}: off by {error:.1e}");
        let agrees = error <= AGREEMENT;
        failed.extend((!agrees).then_some(page));
    }
    assert!(failed.is_empty(), "these move otherwise: {failed:?}");
}

#[test]
fn loops_and_driven_joints_move_as_their_references_in_joint_coordinates() {
    for page in [
        "double-wishbone",
        "four-bar-bushing",
        "four-bar-in-line",
        "four-bar-revolute",
        "gyroscope-four-bar",
        "slider-crank",
    ] {
        let engine: Engine = generated_with_joints(page);
        let (scene, model) = (scene(page).expect("it has a reference"), model(page));
        let approach = Approach { coordinates: Coordinates::Joint, ..Approach::default() };
        let by = (&settings(&model), &approach);
        let (samples, outcome) = moved(&engine, &*engine.builder(Duals::none()), by, &start_of(&model));
        let summary = outcome.unwrap_or_else(|failure| panic!("{page}: {failure}"));
        assert_eq!(samples.len(), 5, "{page}: {summary:?}");
        let error = worst(page, &samples, &scene);
        println!("{page} in joint coordinates: off by {error:.1e}");
        assert!(error <= AGREEMENT, "{page}: {error:e}");
    }
}

#[test]
fn another_reference_does_not_pass() {
    // The check must be able to fail, even for scenes that hardly differ.
    let error = error("gyroscope-light-rings", "gyroscope").expect("it has a reference");
    assert!(error > 10.0 * AGREEMENT, "{error:e}");
}
