//! Motions that mathematics knows: each model file of `models/` states its closed form.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_model::Model;
use gyro_runner::{BodySample, Settings};
use gyro_sim_suite::{
    Engine, PAPER, Run, as_paged, careful, coordinate, for_each_generated, generated, model, simulate,
};
use std::f64::consts::{FRAC_PI_4, PI};

/// Relative tolerance on a period: the truncation error of the step is below it.
const PERIOD: f64 = 1e-9;

/// Precession and nutation over a second or two, rad, with the fine steps used here.
const DIRECTION: f64 = 1e-9;

/// The top turns by a hundredth of a radian a step.
const FINE: f64 = 5e-5;

/// The arithmetic-geometric mean, by which `K(k) = π / (2 agm(1, √(1 − k²)))` (Gauss 1799).
fn agm(mut a: f64, mut b: f64) -> f64 {
    while (a - b).abs() > 1e-15 * a {
        (a, b) = ((a + b) / 2.0, (a * b).sqrt());
    }
    a
}

/// The times at which the first joint's angle crosses zero upwards, from the cubic through the angles and rates of the
/// samples on both sides.
fn upward_crossings(run: &Run) -> Vec<f64> {
    let crossing = |pair: &[gyro_runner::Sample]| {
        let [(a, a_rate), (b, b_rate)] = [coordinate(&pair[0], 0), coordinate(&pair[1], 0)];
        let h = pair[1].t - pair[0].t;
        (a < 0.0 && b >= 0.0).then(|| pair[0].t + h * hermite_root([a, h * a_rate, b, h * b_rate]))
    };
    run.samples.windows(2).filter_map(crossing).collect()
}

/// The zero in `[0, 1]` of the cubic with these values and slopes at both ends, by Newton's method.
fn hermite_root([a, a_slope, b, b_slope]: [f64; 4]) -> f64 {
    let (c, d) = (3.0 * (b - a) - 2.0 * a_slope - b_slope, 2.0 * (a - b) + a_slope + b_slope);
    let newton =
        |x: f64, _| x - (a + x * (a_slope + x * (c + x * d))) / (a_slope + x * (2.0 * c + x * 3.0 * d));
    (0..8).fold(a / (a - b), newton)
}

/// The compound pendulum, released from horizontal: two whole swings.
fn check_period(mechanism: &Engine) {
    // The cubic between samples 1 ms apart is good to (1e-3)⁴ · 100 / 384 rad: 1e-13 s.
    let settings = Settings { t_end: 6.0, step: 5e-4, correct_every: Some(2.5e-3), sample_every: 1e-3 };
    let run = simulate(mechanism, &model("compound-pendulum"), &settings);
    let [first, _, third] = upward_crossings(&run)[..] else { panic!("three swings were expected") };
    let period = (third - first) / 2.0;
    let (inertia, weight, arm, k) = (0.4_f64, 1.2 * 9.81, 0.5, FRAC_PI_4.sin());
    let complete_integral = PI / (2.0 * agm(1.0, (1.0 - k * k).sqrt()));
    let expected = 4.0 * (inertia / (weight * arm)).sqrt() * complete_integral;
    println!("period {period}, closed form {expected}, off by {:e}", period / expected - 1.0);
    assert!((period / expected - 1.0).abs() <= PERIOD, "{period} {expected}");
    assert!(
        (first - 0.75 * expected).abs() <= 0.75 * expected * PERIOD,
        "{first}: three quarters, {expected}"
    );
}

#[test]
fn the_pendulum_released_from_horizontal_has_the_period_of_the_elliptic_integral() {
    check_period(&generated("compound-pendulum"));
    check_period(&careful(&model("compound-pendulum")));
}

/// The third axis of a body in the global frame: the last column of A(p), eq. (3).
fn axis(body: &BodySample) -> [f64; 3] {
    let [_, _, _, e0, e1, e2, e3] = body.pose;
    [2.0 * (e1 * e3 + e0 * e2), 2.0 * (e2 * e3 - e0 * e1), 2.0 * (e0 * e0 + e3 * e3) - 1.0]
}

/// The axis of symmetry circles Z at `rate` from `start` on, at a constant tilt.
fn check_cone(mechanism: &Engine, page: &str, rate: f64, start: [f64; 3]) {
    let settings = Settings { t_end: 2.0, step: FINE, ..PAPER };
    let run = simulate(mechanism, &model(page), &settings);
    let [x, y, z] = start;
    let mut worst = 0.0_f64;
    for sample in &run.samples {
        let (sin, cos) = (rate * sample.t).sin_cos();
        let expected = [x * cos - y * sin, x * sin + y * cos, z];
        let axis = axis(&sample.bodies[0]);
        let error = (0..3).map(|k| (axis[k] - expected[k]).abs()).fold(0.0, f64::max);
        assert!(error <= DIRECTION, "{page} at {} s: {axis:?}, should be {expected:?}", sample.t);
        worst = worst.max(error);
    }
    println!("{page}: direction of the axis to {worst:e} of {} samples", run.samples.len());
}

/// The slow root of I cos(θ) Ω² − C ω₃ Ω + m g d = 0, rad/s.
fn steady_precession() -> f64 {
    let (mass_gravity_arm, about_point, spin, cos) =
        (0.5 * 9.81 * 0.04, 3e-4 + 0.5 * 0.04 * 0.04, 5e-4 * 200.0, 0.8);
    let root = f64::sqrt(spin * spin - 4.0 * about_point * cos * mass_gravity_arm);
    2.0 * mass_gravity_arm / (spin + root)
}

/// L / A, rad/s.
fn free_nutation() -> f64 {
    f64::hypot(3e-4 * 10.0, 4e-4 * 10.0) / 3e-4
}

#[test]
fn the_heavy_top_precesses_steadily() {
    let (rate, start) = (steady_precession(), [0.0, -0.6, 0.8]);
    check_cone(&generated("heavy-top"), "heavy-top", rate, start);
    check_cone(&careful(&model("heavy-top")), "heavy-top", rate, start);
}

#[test]
fn the_free_body_nutates() {
    let (rate, start) = (free_nutation(), [-0.6, 0.0, 0.8]);
    check_cone(&generated("free-body"), "free-body", rate, start);
    check_cone(&careful(&model("free-body")), "free-body", rate, start);
}

#[test]
fn the_free_body_flies_straight_and_its_spin_turns_in_its_own_frame() {
    let run = simulate(&generated("free-body"), &model("free-body"), &Settings { t_end: 2.0, ..PAPER });
    for sample in &run.samples {
        let (pose, velocity) = (sample.bodies[0].pose, sample.bodies[0].velocity);
        // ẇ' = (C − A) / A · w3' about z'.
        let (sin, cos) = (10.0 / 3.0 * sample.t).sin_cos();
        let expected = [0.1 * sample.t, -0.2 * sample.t, 0.3 * sample.t, 10.0 * cos, 10.0 * sin, 10.0];
        let found = [pose[0], pose[1], pose[2], velocity[3], velocity[4], velocity[5]];
        let error = (0..6).map(|k| (found[k] - expected[k]).abs()).fold(0.0, f64::max);
        assert!(error <= DIRECTION, "at {} s: {found:?}, should be {expected:?}", sample.t);
    }
}

#[test]
fn a_motion_that_is_a_little_wrong_is_noticed() {
    // The check must be able to fail: the rate of precession is a part in a million off.
    let wrong = || {
        check_cone(&generated("heavy-top"), "heavy-top", steady_precession() * (1.0 + 1e-6), [0.0, -0.6, 0.8])
    };
    assert!(std::panic::catch_unwind(wrong).is_err());
}

/// Over a second at the paper's step.
const DRIFT: f64 = 1e-11;

/// Of tops that turn faster for their size, of a stop that throws a body back within a hundredth of a second, of rings
/// that turn fast in gimbal lock, of springs that give up their energy within milliseconds, of a wheel that hops on its
/// tyre, and of a crank that shakes a gyroscope.
const FAST: [&str; 7] = [
    "spinning-top",
    "stops",
    "gyroscope-gimbal-lock",
    "gyroscope-stiff",
    "gyroscope-overdamped",
    "double-wishbone",
    "gyroscope-four-bar",
];
const DRIFT_OF_FAST: f64 = 1e-10;

/// Of linkages that pass a pose in which their rows depend on each other: on both sides of it accelerations are
/// quotients of small numbers.
const SINGULAR: [&str; 2] = ["parallelogram", "four-bar-in-line"];
const DRIFT_OF_SINGULAR: f64 = 1e-7;

/// Those whose poses are singular twice over, or of seven bars, are followed up to there: `poses.rs` has them pass,
/// under error control.
const UP_TO_POSE: [&str; 2] = ["peaucellier", "two-four-bars"];
const BEFORE_POSE: f64 = 0.2;

/// Thirteen bodies, each of whose steps costs a hundred of the others'.
const LARGE: [&str; 2] = ["stewart-platform", "driven-stewart"];
const OF_LARGE: f64 = 0.1;

/// The paper's second; where a model file asks for shorter steps, as many of those; through the pose in line, the model
/// file's own,
/// as there shorter ones lose more.
fn settings(page: &str, model: &Model) -> Settings {
    let asked = &model.simulation;
    if page == "four-bar-in-line" {
        return as_paged(model, asked.t_end / 100.0);
    }
    if UP_TO_POSE.contains(&page) {
        return Settings { t_end: BEFORE_POSE, ..PAPER };
    }
    if LARGE.contains(&page) {
        return Settings { t_end: OF_LARGE, ..PAPER };
    }
    if asked.step >= PAPER.step {
        return PAPER;
    }
    let t_end = asked.step * (PAPER.t_end / PAPER.step);
    Settings {
        step: asked.step,
        correct_every: Some(asked.correct_every),
        t_end,
        sample_every: t_end / 100.0,
    }
}

/// What gains or loses energy accounts for it, all others keep it. Returns whether the model file does.
fn accounts_for_energy(page: &str, mechanism: &Engine) -> bool {
    let model = model(page);
    let run = simulate(mechanism, &model, &settings(page, &model));
    let (drift, work) = (run.summary.energy_drift, run.last().work);
    println!("{page}: energy drift {drift:e}, work {work:e} J");
    let allowed = match page {
        _ if SINGULAR.contains(&page) => DRIFT_OF_SINGULAR,
        _ if FAST.contains(&page) => DRIFT_OF_FAST,
        _ => DRIFT,
    };
    assert!(model.has_work() || work == 0.0, "{page}: nothing does work");
    assert!(page != "gyroscope-viscous" || work < 0.0, "friction takes energy");
    drift <= allowed
}

#[test]
fn energy_is_accounted_for() {
    let mut failed = Vec::new();
    for_each_generated(|page, mechanism| {
        if !accounts_for_energy(page, mechanism) {
            failed.push(page.to_owned());
        }
    });
    assert!(failed.is_empty(), "energy is lost: {failed:?}");
}
