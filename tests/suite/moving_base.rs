//! Mechanisms on a base that is moved: motion and work against Newton and Euler along a chain, in 31 digits.

use crate::solved::{ROLLING, ROLLING_AND_PITCHING, Solved};
use gyro_reference::{BaseMotion, Chain, ChainSample, Link, Sinusoid};
use gyro_runner::energy_error;
use gyro_sim_suite::{
    Engine, PAPER, Run, check, check_pairs, coordinate, generated, model, output, played, simulate, times,
};

/// Tolerance on angles, rad; the rotor turns by a hundred radians.
const ANGLES: f64 = 1e-9;

/// Rates, rad/s: the nutation turns at 144 rad/s, a hundred times as much as the angles.
const RATES: f64 = 1e-7;

/// Tolerance on the work and on the energy balance, relative to the kinetic energy.
const WORK: f64 = 1e-9;

/// The carried arm, coordinates and rates, and its reactions, N and N·m.
const ARM: f64 = 1e-9;
const REACTIONS: f64 = 1e-8;

/// Angles and rates of the rings and the rotor, the work of whoever moves the base, and the balance.
fn check_gyroscope(page: &str, mechanism: &Engine, reference: &Solved) -> Run {
    let run = simulate(mechanism, &model(page), &PAPER);
    let reference = reference.at(&run);
    let angles = |k: usize| reference[k].positions.to_vec();
    check(&format!("{page}: angles"), &run, ANGLES, |k, sample| {
        ((0..3).map(|joint| coordinate(sample, joint).0).collect(), angles(k))
    });
    check(&format!("{page}: rates"), &run, RATES, |k, sample| {
        ((0..3).map(|joint| coordinate(sample, joint).1).collect(), reference[k].rates.to_vec())
    });
    check_work(page, &run, reference);
    run
}

/// Both in parts of the kinetic energy at the start.
fn check_work<const N: usize>(what: &str, run: &Run, reference: &[ChainSample<N>]) {
    let (first, scale) = (&run.samples[0], run.samples[0].kinetic);
    check(&format!("{what}: work"), run, WORK, |k, sample| {
        (vec![sample.work / scale], vec![(reference[k].base_work + reference[k].damping_work) / scale])
    });
    check(&format!("{what}: balance"), run, WORK, |_, sample| {
        (vec![energy_error(first, sample) / scale], vec![0.0])
    });
}

#[test]
fn the_gyroscope_on_a_rolling_base() {
    let run = check_gyroscope("driven-gyroscope", &generated("driven-gyroscope"), &ROLLING);
    // The base does work that matters.
    assert!(run.samples.iter().any(|sample| sample.work.abs() > 1e-5 * run.samples[0].kinetic));
}

#[test]
fn the_gyroscope_on_a_base_that_rolls_and_pitches() {
    check_gyroscope("pitching-gyroscope", &generated("pitching-gyroscope"), &ROLLING_AND_PITCHING);
}

#[test]
fn another_motion_of_the_base_does_not_pass() {
    // The check must be able to fail.
    let wrong = || check_gyroscope("pitching-gyroscope", &generated("pitching-gyroscope"), &ROLLING);
    assert!(std::panic::catch_unwind(wrong).is_err());
}

/// The model file `carried`: springs and dampers between what moves and what is moved.
fn arm_and_slider() -> Chain<2> {
    let wave = |amplitude, angular_frequency, phase| Sinusoid { amplitude, angular_frequency, phase };
    let base = BaseMotion {
        translation: [wave(0.1, 3.0, 0.4), wave(0.2, 5.0, 0.0), Sinusoid::default()],
        rotations: vec![([1.0, 0.0, 0.0], wave(0.7, 4.0, 0.2)), ([0.0, 1.0, 2.0], wave(0.5, 6.0, 0.0))],
    };
    let arm = Link {
        before: [0.1, 0.0, 0.2],
        own: [-0.2, 0.1, 0.0],
        mass: 1.5,
        inertia: [0.3, 0.25, 0.2, 0.02, -0.03, 0.01],
        damping: 0.1,
        stiffness: 2.0,
        free: 0.3,
        rate: 2.0,
        ..Link::turning([1.0, 2.0, 2.0])
    };
    let slider = Link {
        before: [0.2, 0.1, 0.1],
        own: [0.0, 0.05, -0.1],
        mass: 0.6,
        inertia: [0.02, 0.03, 0.025, 0.001, 0.002, -0.003],
        damping: 0.5,
        stiffness: 30.0,
        free: 0.1,
        start: 0.05,
        rate: 0.3,
        ..Link::sliding([2.0, -1.0, 2.0])
    };
    Chain { gravity: [1.0, -9.0, 3.0], base, links: [arm, slider] }
}

#[test]
fn springs_and_dampers_on_a_shaken_base() {
    let (mechanism, chain) = (generated("carried"), arm_and_slider());
    let run = played(&mechanism, &model("carried"));
    let reference = chain.solve(&times(&run));
    check_pairs("carried", &run, ARM, |k| {
        (0..2).map(|axis| (reference[k].positions[axis], reference[k].rates[axis])).collect()
    });
    check_work("carried", &run, &reference);
    check("carried: power", &run, REACTIONS, |k, sample| {
        // The chain counts the damper between arm and base apart from whoever moves the base.
        let [rate, speed] = reference[k].rates;
        let dampers = -0.1 * rate * rate - 0.5 * speed * speed;
        (output(&mechanism, sample, "powers"), vec![dampers, reference[k].base_power])
    });
    check("carried: reactions", &run, REACTIONS, |k, sample| {
        let third = |axis: [f64; 3]| axis.map(|x| x / 3.0);
        let [shoulder, slide] = &reference[k].reactions;
        let shoulder = shoulder.in_joint_frame(third([2.0, 1.0, -2.0]), third([1.0, 2.0, 2.0]));
        let slide = slide.in_joint_frame([1.0, 2.0, 0.0].map(|x| x / 5f64.sqrt()), third([2.0, -1.0, 2.0]));
        let found = [output(&mechanism, sample, "shoulder_load"), output(&mechanism, sample, "slide_load")];
        (found.concat(), [shoulder, slide].concat())
    });
    check("carried: inertial sensor", &run, REACTIONS, |k, sample| {
        let reading = chain.inertial_reading(&reference[k], 1, [0.05, -0.02, 0.1]);
        let expected = [reading.specific_force, reading.angular_rate].concat();
        (output(&mechanism, sample, "sensor"), expected)
    });
}
