//! What bearings bear and sensors read, against Newton's and Euler's laws.

use crate::solved::{RESTING, ROLLING, ROLLING_AND_PITCHING, Solved};
use gyro_reference::{Pendulum, moving_base};
use gyro_sim_suite::{Engine, PAPER, Run, check, generated, model, output, played, simulate, times};

/// Tolerance in N and N·m, and in m/s and m/s² at the tip: forces are of order one.
const REACTION: f64 = 1e-9;

/// Specific force, m/s², and angular rate, rad/s, of the inner ring: angular accelerations are a hundred and forty
/// times the rates, which are good to 1e-8.
const SENSOR: f64 = 1e-7;

/// Power to move the base, W.
const POWER: f64 = 1e-9;

#[test]
fn the_pendulum_hangs_on_its_bearing() {
    let mechanism = generated("pendulum");
    let run = played(&mechanism, &model("pendulum"));
    let reference = Pendulum::slender_rod().solve(&times(&run));
    check("pendulum: bearing", &run, REACTION, |k, sample| {
        let [down, aside] = reference[k].force;
        (output(&mechanism, sample, "bearing"), vec![down, aside, 0.0, 0.0, 0.0, 0.0])
    });
    check("pendulum: tip", &run, REACTION, |k, sample| {
        let now = &reference[k];
        let (sin, cos) = now.angle.sin_cos();
        // From the pivot down the rod, and to the side to which the angle grows.
        let (inwards, sideways) = (now.rate * now.rate, now.acceleration);
        let position = [sin, -cos, 0.0];
        let velocity = [now.rate * cos, now.rate * sin, 0.0, 0.0, 0.0, now.rate];
        let acceleration = [sideways * cos - inwards * sin, sideways * sin + inwards * cos, 0.0];
        // The rod's x axis leads down it, its y axis to the side.
        let felt = [-inwards - 9.81 * cos, sideways + 9.81 * sin, 0.0, 0.0, 0.0, now.rate];
        let names = ["tip", "tip_velocity", "tip_acceleration", "sensor"];
        let mut found = names.map(|name| output(&mechanism, sample, name));
        found[0].truncate(3);
        let expected = [&position[..], &velocity, &acceleration, &[0.0, 0.0, sideways], &felt].concat();
        (found.concat(), expected)
    });
    check("pendulum: energy", &run, REACTION, |k, sample| {
        // The potential is −m g·r on both sides.
        let found: f64 = output(&mechanism, sample, "energies").iter().sum();
        (vec![found], vec![reference[k].energy])
    });
}

fn check_bearings(page: &str, mechanism: &Engine, reference: &Solved) -> Run {
    let run = simulate(mechanism, &model(page), &PAPER);
    let samples = reference.at(&run);
    check(&format!("{page}: bearings"), &run, REACTION, |k, sample| {
        let found = ["alpha_load", "beta_load", "phi_load"].map(|name| output(mechanism, sample, name));
        (found.concat(), moving_base::bearing_reactions(&samples[k]).concat())
    });
    check(&format!("{page}: sensor"), &run, SENSOR, |k, sample| {
        let reading = reference.chain.inertial_reading(&samples[k], 1, [0.01, 0.005, -0.002]);
        (output(mechanism, sample, "sensor"), [reading.specific_force, reading.angular_rate].concat())
    });
    run
}

#[test]
fn the_gyroscope_hangs_on_its_bearings() {
    check_bearings("gyroscope-bearings", &generated("gyroscope-bearings"), &RESTING);
}

#[test]
fn the_gyroscope_on_a_base_that_moves_hangs_on_its_bearings() {
    let mechanism = generated("pitching-bearings");
    let run = check_bearings("pitching-bearings", &mechanism, &ROLLING_AND_PITCHING);
    let reference = ROLLING_AND_PITCHING.at(&run);
    check("pitching-bearings: power", &run, POWER, |k, sample| {
        (output(&mechanism, sample, "powers"), vec![0.0, reference[k].base_power])
    });
}

#[test]
fn a_bearing_on_another_base_bears_something_else() {
    // The check must be able to fail.
    let mechanism = generated("gyroscope-bearings");
    let wrong = || check_bearings("gyroscope-bearings", &mechanism, &ROLLING);
    assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(wrong)).is_err());
}
