//! What the joints show of a planted pose is what was planted, turns and all.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use gyro_assembled::Careful;
use gyro_model::{JointStart, Model, Start};
use gyro_sim::{JointCoordinate, Mechanism, Turns, violation};
use gyro_sim_suite::{
    Engine, Random, careful, dense, for_each_generated, is_open, model, posed, state_at, worst,
};

const STATES: usize = 200;

/// Rates, rad/s.
const RATE: f64 = 100.0;

/// Angles of up to ten radians and rates of up to a hundred pass through Euler parameters and back.
const ROUNDING: f64 = 1e-13;

/// Rotations add up from the root to the third body.
const RATE_ROUNDING: f64 = RATE * 1e-14;

/// Whether a joint's coordinate of this index is as planted.
fn agrees(found: JointCoordinate<f64>, planted: &JointStart, index: usize) -> bool {
    match found {
        JointCoordinate::Angle { position, rate } | JointCoordinate::Length { position, rate } => {
            worst(&[position], &planted.position[index..=index]) <= ROUNDING * 10.0
                && worst(&[rate], &planted.rate[index..=index]) <= RATE_ROUNDING
        }
        JointCoordinate::Orientation { position, rate } => {
            // p and −p are one orientation.
            let opposite = position.map(|e| -e);
            worst(&position, &planted.position).min(worst(&opposite, &planted.position)) <= ROUNDING
                && worst(&rate, &planted.rate) <= RATE_ROUNDING
        }
    }
}

fn check_pose(what: &str, mechanism: &Engine, model: &Model, start: &Start) {
    let y = state_at(model, start);
    let joints = start.joints.iter().enumerate();
    let places = joints
        .map(|(joint, planted)| (joint, planted, mechanism.description().joints[joint].coordinates.len()));
    let places: Vec<_> =
        places.flat_map(|(joint, p, n)| (0..n).map(move |index| (joint, p, index))).collect();
    // The turn of an angle is known to whoever starts the run; a third of a turn off still names it.
    let nearest: Vec<f64> = places.iter().map(|(_, planted, index)| planted.position[*index] + 2.0).collect();
    let turns = Turns::new(mechanism, 0.0, &y, &nearest);
    for (joint, planted, index) in places {
        let found = turns.coordinate(mechanism, joint, index).unwrap();
        assert!(agrees(found, planted, index), "{what}, joint {joint}: {found:?}, planted {planted:?}");
    }
    let (mut phi, mut residual) = (mechanism.buffers().constraints, mechanism.buffers().rows);
    mechanism.phi(0.0, &y, &mut phi);
    mechanism.velocity_residual(0.0, &y, &mut residual);
    let n_rows = residual.len();
    assert!(violation(mechanism, &phi[..n_rows]).value <= ROUNDING, "{what}: {phi:?}");
    assert!(violation(mechanism, &residual).value <= RATE * ROUNDING, "{what}: {residual:?}");
}

fn check(page: &str, mechanism: &Engine) {
    let (model, mut random) = (model(page), Random::new(3));
    if !is_open(&model) {
        return;
    }
    for index in 0..STATES {
        let start = posed(&model, RATE, &mut random).assemble().unwrap();
        check_pose(&format!("{page}, pose {index}"), mechanism, &model, &start);
    }
}

#[test]
fn generated_mechanisms_show_what_was_planted() {
    for_each_generated(check);
}

#[test]
fn the_twins_show_what_was_planted() {
    for page in gyro_sim_suite::pages() {
        let model = model(&page);
        if Careful::<f64>::supports(&model).is_ok() {
            check(&page, &careful(&model));
        }
        check(&page, &dense(&model));
    }
}

#[test]
fn another_turn_is_another_angle() {
    // The check must be able to fail.
    let turn = std::f64::consts::TAU;
    let found = JointCoordinate::Angle { position: 1.0 + turn, rate: 2.0 };
    assert!(!agrees(found, &JointStart { position: vec![1.0], rate: vec![2.0] }, 0));
    assert!(agrees(found, &JointStart { position: vec![1.0 + turn], rate: vec![2.0] }, 0));
}
