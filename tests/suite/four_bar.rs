//! Closed loops: the planar four-bar linkage against its reduction to one coordinate, redundant rows, a driver, and the
//! pose with all bars in line.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_model::{Model, RowOwner};
use gyro_reference::{Bar, FourBar as Reference, FourBarSample, Pendulum};
use gyro_runner::Settings;
use gyro_sim_suite::{
    Engine, Run, as_paged, check, check_pairs, coordinate, fed, generated, model, output, page, played,
    simulate, times, worst,
};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::sync::LazyLock;

/// Relative energy drift that the truncation error of the step allows.
const DRIFT: f64 = 1e-8;

/// Angles (rad) and rates (rad/s) over ten seconds, in which small errors grow with time.
const MOTION: f64 = 1e-8;

/// Two ways of closing the same loop with the same steps.
const ALIKE: f64 = 1e-8;

/// Newton's method ends at a few roundings of one.
const VIOLATION: f64 = 1e-12;

/// Torque, N·m, and power, W, of the driven crank.
const TORQUE: f64 = 1e-9;

/// Crank and rocker, rad: equal on the branch of the parallelogram, a radian apart on the other one within a tenth of a
/// second.
const BRANCH: f64 = 1e-4;

/// Steps, s, and how far the motion may be off by then, rad: near the pose in line accelerations are a quotient of
/// small numbers.
const STEPS: [(f64, f64); 4] = [(2e-2, 1e-1), (5e-3, 1e-2), (1e-3, 1e-4), (2e-4, 1e-4)];

/// Half the model file's step.
fn settings(model: &Model) -> Settings {
    Settings { step: 1e-4, correct_every: Some(5e-4), ..as_paged(model, 0.1) }
}

static MOTION_OF_CRANK: LazyLock<(Run, Vec<FourBarSample>)> = LazyLock::new(|| {
    let model = model("four-bar");
    let run = simulate(&generated("four-bar"), &model, &settings(&model));
    let reference = Reference::crank_rocker().solve(&times(&run));
    (run, reference)
});

/// Crank and rocker.
fn pivots(reference: &FourBarSample) -> Vec<(f64, f64)> {
    [0, 2].map(|bar| (reference.angles[bar], reference.rates[bar])).to_vec()
}

#[test]
fn a_linkage_without_redundancy_moves_like_its_crank_alone() {
    let (run, reference) = &*MOTION_OF_CRANK;
    check_pairs("four-bar", run, MOTION, |k| pivots(&reference[k]));
    println!("four-bar: {:?}", run.summary);
    assert!(run.summary.energy_drift <= DRIFT, "{:?}", run.summary);
    assert!(run.summary.position_violation <= VIOLATION, "{:?}", run.summary);
    // The crank goes round.
    assert!(reference.iter().any(|sample| sample.angles[0].abs() > TAU));
}

#[test]
fn the_redundant_rows_of_four_revolute_joints_are_named() {
    let model = model("four-bar-revolute");
    let owner = |owner: RowOwner| match owner {
        RowOwner::Joint(joint) => model.joints[joint].name.clone(),
        other => format!("{other:?}"),
    };
    let named: Vec<String> =
        model.redundant.iter().map(|r| format!("{} {}", owner(r.row.owner), r.row.index)).collect();
    println!("redundant rows: {named:?}");
    // Of the joint that closes the loop: the offset along the axes and both tilts.
    assert_eq!(named, ["knee 2", "knee 3", "knee 4"]);
    for redundant in &model.redundant {
        assert!(redundant.shared_with.len() >= 2, "{redundant:?}");
    }
    assert_eq!((model.rows().len(), model.degrees_of_freedom()), (17, 1));
}

#[test]
fn four_revolute_joints_move_alike() {
    let model = model("four-bar-revolute");
    let run = simulate(&generated("four-bar-revolute"), &model, &settings(&model));
    let (other, reference) = &*MOTION_OF_CRANK;
    check_pairs("four revolute joints", &run, MOTION, |k| {
        // Crank and rocker, then elbow and knee.
        let FourBarSample { angles: a, rates: w, .. } = &reference[k];
        let between = [[1, 0], [2, 1]].map(|[j, i]| (a[j] - a[i], w[j] - w[i]));
        [pivots(&reference[k]), between.to_vec()].concat()
    });
    check("four revolute joints and four-bar", &run, ALIKE, |k, sample| {
        let crank = |sample| coordinate(sample, 0).0;
        (vec![crank(sample)], vec![crank(&other.samples[k])])
    });
    println!("four revolute joints: {:?}", run.summary);
    assert!(run.summary.energy_drift <= DRIFT, "{:?}", run.summary);
    assert!(run.summary.position_violation <= VIOLATION, "{:?}", run.summary);
}

#[test]
fn a_driven_crank_takes_the_torque_of_the_reduction() {
    let mechanism = generated("driven-four-bar");
    let run = played(&mechanism, &model("driven-four-bar"));
    let reference = Reference { start: 1.0, rate: 6.6, ..Reference::crank_rocker() };
    check("driven crank", &run, TORQUE, |_, sample| {
        let (sin, cos) = (3.0 * sample.t).sin_cos();
        let angle = 1.0 + 6.0 * sample.t + 0.2 * sin;
        let (rate, acceleration) = (6.0 + 0.6 * cos, -1.8 * sin);
        let torque = reference.crank_torque(angle, rate, acceleration);
        let (x, x_rate) = coordinate(sample, 0);
        let asked = ["torque", "powers"].map(|name| output(&mechanism, sample, name)).concat();
        ([vec![x, x_rate], asked].concat(), vec![angle, rate, torque, 0.0, torque * rate])
    });
    println!("driven crank: {:?}", run.summary);
    assert!(run.summary.energy_drift <= TORQUE, "{:?}", run.summary);
}

/// The linkage `parallelogram` with another rate at the start, as a pendulum.
fn as_pendulum(rate: f64) -> Pendulum {
    let bar = |length, mass, inertia, centre: f64| Bar { length, mass, inertia, centre: [centre, 0.0] };
    let bars = [bar(0.3, 0.5, 4e-3, 0.1), bar(0.5, 0.8, 2e-2, 0.25), bar(0.3, 0.6, 5e-3, 0.15)];
    Pendulum::parallelogram(bars, 9.81, 0.5, rate)
}

/// Runs the parallelogram; it must move as the pendulum as long as it goes, and if it stops before the end, say why.
/// Returns whether it came to the end, and the largest angle of the crank.
fn check_parallelogram(mechanism: &Engine, rate: f64, (step, allowed): (f64, f64)) -> (bool, f64) {
    let text = page("parallelogram").replace("rate = 9\n", &format!("rate = {rate}\n"));
    let model = gyro_model::read("parallelogram.toml", &text).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    let settings = Settings { t_end: 1.0, step, correct_every: Some(step), sample_every: step };
    let (samples, outcome) = fed(mechanism, &model, &settings, Vec::new());
    let times: Vec<f64> = samples.iter().map(|sample| sample.t).collect();
    let reference = as_pendulum(rate).solve(&times);
    let mut error = 0.0_f64;
    for (sample, expected) in samples.iter().zip(&reference) {
        let found = [0, 1].map(|pivot| coordinate(sample, pivot).0);
        error = error.max(worst(&found, &[expected.angle; 2]));
        assert!(
            error <= allowed,
            "{rate} rad/s, {step} s: at {} s {found:?}, not {}",
            sample.t,
            expected.angle
        );
        assert!((found[0] - found[1]).abs() <= BRANCH, "{rate} rad/s, {step} s: at {} s {found:?}", sample.t);
    }
    let angles = samples.iter().map(|sample| coordinate(sample, 0).0);
    let reached = angles.fold(0.0, f64::max);
    let words = outcome.as_ref().err().map(ToString::to_string);
    println!("parallelogram, {rate} rad/s, {step} s: to {reached:.4} rad, off by {error:.1e}, {words:?}");
    if let Some(words) = &words {
        assert!(words.contains("singular pose") || words.contains("cannot be met"), "{words}");
        assert!(
            (reached - FRAC_PI_2).abs() < 0.4,
            "it stops at {reached}, far from the pose in line: {words}"
        );
    }
    (outcome.is_ok(), reached)
}

#[test]
fn the_parallelogram_passes_the_pose_in_line_or_says_why_not() {
    let mechanism = generated("parallelogram");
    // With 8.1 rad/s it would just come there.
    for rate in [8.2, 9.0, 9.3, 11.0] {
        for step in STEPS {
            let (is_through, reached) = check_parallelogram(&mechanism, rate, step);
            assert!(!is_through || reached > FRAC_PI_2, "it never came to the pose in line: {reached}");
        }
    }
    // And where it never comes there it swings on undisturbed.
    for rate in [3.0, 8.0] {
        let (is_through, reached) = check_parallelogram(&mechanism, rate, STEPS[2]);
        assert!(is_through && reached < FRAC_PI_2);
    }
}

#[test]
fn the_other_branch_does_not_pass() {
    // The check must be able to fail: the mechanism, wrongly, folds.
    let (_, reference) = &*MOTION_OF_CRANK;
    let wrong = Reference { branch: gyro_reference::Branch::Right, ..Reference::crank_rocker() };
    let rocker = wrong.solve(&[reference[0].t])[0].angles[2];
    assert!((rocker - reference[0].angles[2]).abs() > 1e3 * BRANCH);
}
