//! Forces, inputs and drivers, each against an integration of its own or a closed form.

use gyro_reference::{AxisForce, AxisSample, OneAxis, SampledInput, Side, Tether};
use gyro_runner::{Between, Input, JointSample, Settings};
use gyro_sim_suite::{
    Run, as_paged, check, coordinate, fed, generated, model, output, pair, played, simulate, times,
};

/// Coordinates (rad, m) and rates at the model files' steps.
const MOTION: f64 = 1e-9;

/// Work and energy, J, of order one to ten.
const ENERGY: f64 = 1e-9;

/// Dry friction turns round within a few milliseconds, and a stop throws a body back within a hundredth of a second:
/// each step spans a larger part of that.
const SUDDEN: f64 = 1e-8;

/// Coordinate and rate of a joint against a motion about one axis.
fn check_axis(what: &str, run: &Run, index: usize, allowed: f64, reference: &[AxisSample]) {
    check(what, run, allowed, |k, sample| {
        let ((position, rate), expected) = (coordinate(sample, index), &reference[k]);
        (vec![position, rate], vec![expected.position, expected.rate])
    });
}

/// The model file's disc reaches a hundred radians a second, and its Euler parameters turn half as fast: steps are
/// shorter than it asks for.
fn torsion() -> Run {
    let model = model("torsion");
    let settings = Settings { step: 5e-5, correct_every: Some(2.5e-4), ..as_paged(&model, 0.2) };
    simulate(&generated("torsion"), &model, &settings)
}

#[test]
fn a_torsional_spring_over_three_turns() {
    let run = torsion();
    let reference = OneAxis::torsion().solve(&times(&run));
    assert!(reference[0].position > 3.0 * std::f64::consts::TAU);
    check_axis("torsion", &run, 0, MOTION, &reference);
    check("torsion: energy and work", &run, ENERGY, |k, sample| {
        (vec![sample.energy(), sample.work], vec![reference[k].energy, reference[k].work])
    });
}

#[test]
fn friction() {
    let run = played(&generated("friction"), &model("friction"));
    let disc = OneAxis {
        inertia: 0.02,
        forces: vec![
            AxisForce::Spring { stiffness: 0.5, free: 0.0 },
            AxisForce::Coulomb { level: 0.05, rate: 0.1 },
        ],
        start: 2.0,
        rate: 0.0,
    };
    let reference = disc.solve(&times(&run));
    check_axis("dry friction", &run, 0, SUDDEN, &reference);
    assert!(reference.windows(2).any(|pair| pair[0].rate * pair[1].rate < 0.0), "it never turns round");
    check("ball in a viscous socket", &run, MOTION, |_, sample| {
        let JointSample::Orientation { rate, .. } = sample.coordinates[1] else { panic!("an orientation") };
        let slower = (-0.04 / 0.05 * sample.t).exp();
        (rate.to_vec(), [3.0, -2.0, 1.0].map(|w| w * slower).to_vec())
    });
    check("carriage on a viscous rail", &run, MOTION, |_, sample| {
        let (position, rate) = coordinate(sample, 2);
        let slower = (-0.5 / 2.0 * sample.t).exp();
        (vec![position, rate], vec![12.0 * (1.0 - slower), 3.0 * slower])
    });
    check("friction: work", &run, SUDDEN, |k, sample| {
        let lost = |exponent: f64| 1.0 - (-2.0 * exponent * sample.t).exp();
        let expected = reference[k].work - 0.5 * 0.05 * 14.0 * lost(0.8) - 0.5 * 2.0 * 9.0 * lost(0.25);
        (vec![sample.work], vec![expected])
    });
}

fn stop(limit: f64, side: Side, [stiffness, damping, softness]: [f64; 3]) -> AxisForce {
    AxisForce::Stop { limit, side, stiffness, damping, softness }
}

#[test]
fn end_stops() {
    let run = played(&generated("stops"), &model("stops"));
    let hammer = OneAxis {
        inertia: 0.5,
        forces: vec![
            AxisForce::Motor(-0.5 * 9.81),
            stop(0.0, Side::Lower, [4000.0, 5.0, 0.01]),
            stop(0.8, Side::Upper, [3000.0, 2.0, 0.02]),
        ],
        start: 0.5,
        rate: 4.0,
    };
    check_axis("hammer between stops", &run, 0, SUDDEN, &hammer.solve(&times(&run)));
    let disc = OneAxis {
        inertia: 0.02,
        forces: vec![stop(15.7, Side::Upper, [50.0, 0.1, 0.05]), stop(-9.5, Side::Lower, [40.0, 0.0, 0.05])],
        start: 0.0,
        rate: 12.0,
    };
    let reference = disc.solve(&times(&run));
    check_axis("disc that meets its stop after two turns and a half", &run, 1, SUDDEN, &reference);
    assert!(reference.iter().any(|s| s.position > 15.0) && reference.iter().any(|s| s.rate < -1.0));
}

#[test]
fn a_motor_that_is_fed_from_a_table() {
    let rows = vec![[0.1, 0.0], [0.3, 0.5], [0.55, -0.8], [0.8, 0.2]];
    let (mechanism, model) = (generated("motor"), model("motor"));
    let settings = as_paged(&model, 0.05);
    let input = Input::new(0, rows.clone(), Between::Linear);
    let (samples, outcome) = fed(&mechanism, &model, &settings, vec![input]);
    let run = Run { samples, summary: outcome.unwrap_or_else(|failure| panic!("{failure}")) };
    let disc = OneAxis { inertia: 0.02, forces: vec![AxisForce::Damper(0.03)], start: 0.0, rate: -2.0 };
    let reference = disc.solve_with_input(&times(&run), &SampledInput { rows, step: settings.step });
    check_axis("motor", &run, 0, MOTION, &reference);
    check("motor: work", &run, ENERGY, |k, sample| (vec![sample.work], vec![reference[k].work]));
    assert!(run.summary.energy_drift <= ENERGY, "{:?}", run.summary);
}

#[test]
fn a_spring_and_damper_between_two_points() {
    let run = played(&generated("tether"), &model("tether"));
    let tether = Tether {
        mass: 0.5,
        stiffness: 40.0,
        damping: 0.3,
        free_length: 0.6,
        gravity: [0.0, 0.0, -9.81],
        position: [0.5, -0.2, -0.4],
        velocity: [0.3, 1.5, -0.2],
    };
    let reference = tether.solve(&times(&run));
    check("tether", &run, MOTION, |k, sample| {
        let (pose, velocity) = (sample.bodies[0].pose, sample.bodies[0].velocity);
        let found = [&pose[..3], &velocity[..3], &[sample.work]].concat();
        let expected = &reference[k];
        (found, [&expected.position[..], &expected.velocity, &[expected.work]].concat())
    });
}

#[test]
fn loads_in_both_frames() {
    let run = played(&generated("loads"), &model("loads"));
    // (0.3 · 0.2 − 0.01) / 0.02 rad/s², and 5 · 3/5 / 2 m/s².
    let uniform = |rate: f64, acceleration: f64, t: f64| {
        pair([rate * t + 0.5 * acceleration * t * t, rate + acceleration * t, acceleration])
    };
    check("loads", &run, MOTION, |_, sample| {
        let [(angle, spin), (x, speed)] = [coordinate(sample, 0), coordinate(sample, 1)];
        let [disc, carriage] = [uniform(1.0, 2.5, sample.t), uniform(-1.0, 1.5, sample.t)];
        (vec![angle, spin, x, speed], vec![disc.0, disc.1, carriage.0, carriage.1])
    });
    assert!(run.summary.energy_drift <= ENERGY, "{:?}", run.summary);
}

/// The natural cubic spline through the rows of `cam.csv` with its derivatives, by its two inner second derivatives.
fn lift(t: f64) -> [f64; 3] {
    let (times, values) = ([0.0, 0.5, 1.2, 2.0], [0.0, 0.08, 0.05, 0.1]);
    let h: [f64; 3] = std::array::from_fn(|k| times[k + 1] - times[k]);
    let slope: [f64; 3] = std::array::from_fn(|k| (values[k + 1] - values[k]) / h[k]);
    // h₀ m₀ + 2 (h₀ + h₁) m₁ + h₁ m₂ = 6 (slope₁ − slope₀), and so on; m₀ = m₃ = 0.
    let (a, b, c) = (2.0 * (h[0] + h[1]), h[1], 2.0 * (h[1] + h[2]));
    let (p, q) = (6.0 * (slope[1] - slope[0]), 6.0 * (slope[2] - slope[1]));
    let determinant = a * c - b * b;
    let m = [0.0, (p * c - b * q) / determinant, (a * q - b * p) / determinant, 0.0];
    let k = usize::from(t >= 0.5) + usize::from(t >= 1.2);
    let (before, after) = (times[k + 1] - t, t - times[k]);
    let ends = [values[k] / h[k] - m[k] * h[k] / 6.0, values[k + 1] / h[k] - m[k + 1] * h[k] / 6.0];
    [
        (m[k] * before.powi(3) + m[k + 1] * after.powi(3)) / (6.0 * h[k])
            + ends[0] * before
            + ends[1] * after,
        (m[k + 1] * after * after - m[k] * before * before) / (2.0 * h[k]) - ends[0] + ends[1],
        (m[k] * before + m[k + 1] * after) / h[k],
    ]
}

/// 0.1 t² (1 + sin(3 t + 0.5)) − 0.2 with its derivatives.
fn push(t: f64) -> [f64; 3] {
    let (sin, cos) = (3.0 * t + 0.5).sin_cos();
    let (square, factor) = ([0.1 * t * t, 0.2 * t, 0.2], [1.0 + sin, 3.0 * cos, -9.0 * sin]);
    [
        square[0] * factor[0] - 0.2,
        square[1] * factor[0] + square[0] * factor[1],
        square[2] * factor[0] + 2.0 * square[1] * factor[1] + square[0] * factor[2],
    ]
}

#[test]
fn drivers_by_a_table_and_by_sums_and_products() {
    let mechanism = generated("cam");
    let run = played(&mechanism, &model("cam"));
    check("cam", &run, MOTION, |_, sample| {
        let [lift, push] = [lift(sample.t), push(sample.t)];
        let forces = [0.5 * (lift[2] + 9.81), 0.25 * (push[2] + 9.81)];
        let power = forces[0] * lift[1] + forces[1] * push[1];
        let [(x, x_rate), (z, z_rate)] = [coordinate(sample, 0), coordinate(sample, 1)];
        let asked = ["lift_force", "push_force", "powers"].map(|name| output(&mechanism, sample, name));
        let found = [vec![x, x_rate, z, z_rate], asked.concat()].concat();
        (found, vec![lift[0], lift[1], push[0], push[1], forces[0], forces[1], 0.0, power])
    });
    assert!(run.summary.energy_drift <= ENERGY, "{:?}", run.summary);
}

#[test]
fn a_spring_without_turns_is_noticed() {
    // The check must be able to fail: wound up by half a turn only, or a little stiffer.
    let run = torsion();
    let right = OneAxis::torsion();
    let stiffer = vec![AxisForce::Spring { stiffness: 0.5000001, free: 0.0 }, AxisForce::Damper(0.01)];
    for wrong in [
        OneAxis { start: right.start - 3.0 * std::f64::consts::TAU, ..right.clone() },
        OneAxis { forces: stiffer, ..right },
    ] {
        let reference = wrong.solve(&times(&run));
        let noticed = || check_axis("torsion", &run, 0, MOTION, &reference);
        assert!(std::panic::catch_unwind(std::panic::AssertUnwindSafe(noticed)).is_err());
    }
}
