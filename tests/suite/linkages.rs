//! Slider-cranks, Peaucellier's linkage, planets and a differential against their references: all with one coordinate,
//! or with each by itself.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_reference::{AxisForce, OneAxis, Peaucellier, Pendulum, SliderCrank, StewartPlatform};
use gyro_runner::Settings;
use gyro_sim_suite::{Run, check, coordinate, generated, model, output, rotation, simulate, times};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Angles, lengths and their rates, of steps that turn no body by more than a hundredth of a radian.
const MOTION: f64 = 1e-8;
const STEP: f64 = 1e-4;

fn run(page: &str, t_end: f64) -> Run {
    let settings =
        Settings { t_end, step: STEP, correct_every: Some(5.0 * STEP), sample_every: t_end / 10.0 };
    simulate(&generated(page), &model(page), &settings)
}

/// An angle within half a turn of zero.
fn within_half_a_turn(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

#[test]
fn the_spatial_slider_crank_moves_as_its_reference() {
    let run = run("spatial-slider-crank", 0.5);
    let reference = SliderCrank::spatial().solve(&times(&run));
    check("spatial slider-crank", &run, MOTION, |k, sample| {
        let expected = &reference[k];
        let rod = &sample.bodies[1];
        let [x, y, z, e0, e1, e2, e3] = rod.pose;
        let found = [coordinate(sample, 0), coordinate(sample, 4)].map(|(x, rate)| [x, rate]).concat();
        let turned = [rotation([e0, e1, e2, e3]).concat(), vec![x, y, z], rod.velocity.to_vec()].concat();
        let state = expected.rod;
        let rates = [state.velocity, state.angular_velocity].concat();
        let crank = vec![expected.angle, expected.rate, expected.displacement, expected.displacement_rate];
        ([found, turned].concat(), [crank, state.rotation.concat(), state.position.to_vec(), rates].concat())
    });
    assert!(reference.iter().any(|sample| sample.angle > 2.0), "it hardly moves");
}

#[test]
fn peaucelliers_linkage_moves_as_its_reference() {
    let run = run("peaucellier", 0.2);
    let reference = Peaucellier::thrown().solve(&times(&run));
    // Between which bars the joints are, in the order of the model file; the first three are on the ground.
    const BETWEEN: [[usize; 2]; 7] = [[1, 3], [1, 4], [2, 5], [2, 6], [0, 3], [0, 5], [4, 6]];
    check("Peaucellier's linkage", &run, MOTION, |k, sample| {
        let (angles, rates) = (reference[k].angles, reference[k].rates);
        let pivots = [0, 1, 2].map(|bar| (angles[bar], rates[bar]));
        let joints = BETWEEN.map(|[i, j]| (angles[j] - angles[i], rates[j] - rates[i]));
        let of = |(angle, rate): (f64, f64)| [within_half_a_turn(angle), rate];
        let expected: Vec<f64> = pivots.iter().chain(&joints).flat_map(|joint| of(*joint)).collect();
        let found: Vec<f64> = (0..10).flat_map(|joint| of(coordinate(sample, joint))).collect();
        (found, expected)
    });
}

/// The carrier with all that it carries is a pendulum, as sun and planet turn in it in proportion to it.
#[test]
fn the_planetary_train_swings_as_a_pendulum() {
    let run = run("planetary", 0.5);
    let planet = -3.333_333_333_333_333_5;
    let sun = planet / -1.333_333_333_333_333_3;
    let moment = 0.2f64.mul_add(0.105, 0.02);
    let (mass, distance) = (1.7, moment / 1.7);
    let about_axis = 0.005
        + 0.02 * 0.02
        + 0.2 * 0.105 * 0.105
        + 0.0008 * (1.0 + sun) * (1.0 + sun)
        + 0.00015 * (1.0 + planet) * (1.0 + planet);
    let inertia = about_axis - mass * distance * distance;
    let pendulum = Pendulum { mass, inertia, distance, gravity: 9.81, start: 0.1 + FRAC_PI_2, rate: 20.0 };
    let reference = pendulum.solve(&times(&run));
    check("planetary train", &run, MOTION, |k, sample| {
        let (angle, rate) = (reference[k].angle - FRAC_PI_2, reference[k].rate);
        let in_carrier = planet * angle + 0.3;
        let expected = vec![angle, rate, sun / planet * in_carrier, sun * rate, in_carrier, planet * rate];
        ((0..3).flat_map(|joint| <[f64; 2]>::from(coordinate(sample, joint))).collect(), expected)
    });
}

/// The case keeps its rate; the pinion, with both side gears, is braked by the friction of one of them.
#[test]
fn the_differential_turns_as_case_and_pinion_by_themselves() {
    let run = run("differential", 0.5);
    let pinion = OneAxis {
        inertia: 4e-4 + 2.0 * 0.05 * 1.5 * 1.5,
        forces: vec![AxisForce::Damper(0.01 * 1.5 * 1.5)],
        start: 0.3,
        rate: 25.0,
    };
    let reference = pinion.solve(&times(&run));
    check("differential", &run, MOTION, |k, sample| {
        let (angle, rate) = (reference[k].position, reference[k].rate);
        let case = 40.0f64.mul_add(sample.t, 0.1);
        let wheels = [1.5 * angle, 1.5 * rate, 0.1 - 1.5 * angle, -1.5 * rate];
        let expected = [[case, 40.0, angle, rate].to_vec(), wheels.to_vec()].concat();
        ((0..4).flat_map(|joint| <[f64; 2]>::from(coordinate(sample, joint))).collect(), expected)
    });
    assert!(reference[10].rate < 24.0, "friction brakes it");
}

/// The platform of the model file, as long as its legs are driven at a time; and how these lengths accelerate.
fn driven(t: f64) -> (StewartPlatform, [f64; 6]) {
    let middle = [0.34, 0.35, 0.335, 0.345, 0.33, 0.355];
    let leg = |k: usize| {
        let (size, speed) = (0.01 * (k % 3 + 1) as f64, (3 + k % 2) as f64);
        let (sin, cos) = (speed * t + 0.5 * k as f64).sin_cos();
        [0.6 + middle[k] + size * sin, size * speed * cos, -size * speed * speed * sin]
    };
    let of = |order: usize| std::array::from_fn(|k| leg(k)[order]);
    let platform = StewartPlatform::plate_of_ten_kilograms();
    (StewartPlatform { lengths: of(0), rates: of(1), forces: [0.0; 6], ..platform }, of(2))
}

#[test]
fn the_driven_platform_takes_the_forces_of_its_reference() {
    let run = run("driven-stewart", 0.1);
    let mechanism = generated("driven-stewart");
    check("driven Stewart platform", &run, MOTION, |_, sample| {
        let (platform, accelerations) = driven(sample.t);
        let (expected, forces) = (platform.solve(&[0.0])[0], platform.driver_forces(accelerations));
        let plate = &sample.bodies[0];
        let [x, y, z, e0, e1, e2, e3] = plate.pose;
        let found = [rotation([e0, e1, e2, e3]).concat(), vec![x, y, z], plate.velocity.to_vec()].concat();
        let asked = ["force1", "force5"].map(|name| output(&mechanism, sample, name)).concat();
        let of_plate = expected.plate;
        let rates = [of_plate.velocity, of_plate.angular_velocity].concat();
        (
            [found, asked].concat(),
            [of_plate.rotation.concat(), of_plate.position.to_vec(), rates, vec![forces[0], forces[4]]]
                .concat(),
        )
    });
}

#[test]
fn a_linkage_that_is_a_little_different_does_not_pass() {
    // The check must be able to fail: the rod is a millionth longer.
    let wrong = || {
        let run = run("spatial-slider-crank", 0.5);
        let mut other = SliderCrank::spatial();
        other.rod.length *= 1.0 + 1e-6;
        let reference = other.solve(&times(&run));
        check("another rod", &run, MOTION, |k, sample| {
            (vec![coordinate(sample, 0).0], vec![reference[k].angle])
        });
    };
    assert!(std::panic::catch_unwind(wrong).is_err());
}
