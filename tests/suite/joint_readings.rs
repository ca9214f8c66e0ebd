//! What the joints show of a planted pose is what was planted, turns and all.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use gyro_assembled::{Careful, Dense};
use gyro_model::{JointStart, Start};
use gyro_sim::{JointCoordinate, Turns, violation};
use gyro_sim_suite::{Check, Engine, Random, for_each_generated, model, posed, state_of};

const STATES: usize = 200;

/// Rates, rad/s.
const RATE: f64 = 100.0;

/// Angles of up to ten radians and rates of up to a hundred pass through Euler parameters and back.
const ROUNDING: f64 = 1e-13;

/// Rotations add up from the root to the third body.
const RATE_ROUNDING: f64 = RATE * 1e-14;

fn worst(found: &[f64], planted: &[f64]) -> f64 {
    assert_eq!(found.len(), planted.len());
    found.iter().zip(planted).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn agrees(found: JointCoordinate<f64>, planted: &JointStart) -> bool {
    match found {
        JointCoordinate::Angle { position, rate } => {
            worst(&[position], &planted.position) <= ROUNDING * 10.0
                && worst(&[rate], &planted.rate) <= RATE_ROUNDING
        }
        JointCoordinate::Orientation { position, rate } => {
            // p and −p are one orientation.
            let opposite = position.map(|e| -e);
            worst(&position, &planted.position).min(worst(&opposite, &planted.position)) <= ROUNDING
                && worst(&rate, &planted.rate) <= RATE_ROUNDING
        }
        JointCoordinate::None => planted.position.is_empty() && planted.rate.is_empty(),
    }
}

fn check_pose<M: Engine<f64>>(what: &str, mechanism: &M, start: &Start) {
    let mut values = [&start.q[..], &start.v[..]].concat();
    values.resize(mechanism.start().as_ref().len(), 0.0);
    let y = state_of(mechanism, &values);
    // The turn of an angle is known to whoever starts the run; a third of a turn off still names it.
    let nearest: Vec<f64> = start.joints.iter().map(|joint| joint.position[0] + 2.0).collect();
    let turns = Turns::new(mechanism, &y, &nearest);
    for (joint, planted) in start.joints.iter().enumerate() {
        let found = turns.joint(mechanism, joint);
        assert!(agrees(found, planted), "{what}, joint {joint}: {found:?}, planted {planted:?}");
    }
    let (mut phi, mut residual) = (mechanism.constraints(), mechanism.rows());
    mechanism.phi(0.0, &y, &mut phi);
    mechanism.velocity_residual(0.0, &y, &mut residual);
    let n_rows = residual.as_ref().len();
    assert!(violation(mechanism, &phi.as_ref()[..n_rows]).value <= ROUNDING, "{what}: {phi:?}");
    assert!(violation(mechanism, residual.as_ref()).value <= RATE * ROUNDING, "{what}: {residual:?}");
}

struct Planted;

impl Check<f64> for Planted {
    fn check<M: Engine<f64>>(&mut self, page: &str, mechanism: &M) {
        let (model, mut random) = (model(page), Random::new(3));
        for index in 0..STATES {
            let start = posed(&model, RATE, &mut random).assemble().unwrap();
            check_pose(&format!("{page}, pose {index}"), mechanism, &start);
        }
    }
}

#[test]
fn generated_mechanisms_show_what_was_planted() {
    for_each_generated(&mut Planted);
}

#[test]
fn the_twins_show_what_was_planted() {
    for page in gyro_sim_suite::pages() {
        Planted.check(&page, &Careful::new(&model(&page)).unwrap());
        Planted.check(&page, &Dense::new(&model(&page)).unwrap());
    }
}

#[test]
fn another_turn_is_another_angle() {
    // The check must be able to fail.
    let turn = std::f64::consts::TAU;
    let found = JointCoordinate::Angle { position: 1.0 + turn, rate: 2.0 };
    assert!(!agrees(found, &JointStart { position: vec![1.0], rate: vec![2.0] }));
    assert!(agrees(found, &JointStart { position: vec![1.0 + turn], rate: vec![2.0] }));
}
