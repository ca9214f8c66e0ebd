//! Halving the step divides the error by sixteen: RK4 keeps its order through constraints and corrections.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_reference::{Gyroscope as Reference, Sample};
use gyro_runner::Settings;
use gyro_sim_suite::{Engine, PAPER, careful, coordinate, generated, model, simulate};

/// Truncation dominates: at a tenth of these rounding shows, and at four times these the damping of the nutation, of
/// the fifth order, is as large as its change of phase.
const STEPS: [f64; 3] = [1e-3, 5e-4, 2.5e-4];

/// Observed orders: what follows in the error is a step's turn, up to 0.1 rad, smaller.
const ORDER: std::ops::Range<f64> = 3.9..4.1;

/// The steps between corrections, as in the paper.
const STEPS_PER_CORRECTION: f64 = 5.0;

/// The largest errors of α and φ over the second. (β is nutation alone: the damping shows longer.)
fn errors(mechanism: &Engine, page: &str, reference: &[Sample], settings: &Settings) -> [f64; 2] {
    let run = simulate(mechanism, &model(page), settings);
    let error = |joint: usize| {
        let expected = |sample: &Sample| if joint == 0 { sample.alpha } else { sample.phi };
        let errors =
            reference.iter().map(|sample| (coordinate(run.at(sample.t), joint).0 - expected(sample)).abs());
        errors.fold(0.0, f64::max)
    };
    [0, 2].map(error)
}

fn check(mechanism: &Engine, page: &str, reference: &Reference) {
    let times: Vec<f64> = (0..=50).map(|k| f64::from(k) / 50.0).collect();
    let reference = reference.solve(&times);
    let at = |step: f64| {
        let correct_every = Some(STEPS_PER_CORRECTION * step);
        errors(mechanism, page, &reference, &Settings { step, correct_every, sample_every: 0.02, ..PAPER })
    };
    let errors = STEPS.map(at);
    let order = |pair: &[[f64; 2]]| [0, 1].map(|k| (pair[0][k] / pair[1][k]).log2());
    let orders: Vec<[f64; 2]> = errors.windows(2).map(order).collect();
    println!("{page}: errors {errors:?}, orders {orders:?}");
    assert!(orders.as_flattened().iter().all(|order| ORDER.contains(order)), "{page}: {errors:?} {orders:?}");
}

#[test]
fn generated_mechanisms_converge_with_order_four() {
    check(&generated("gyroscope"), "gyroscope", &Reference::paper());
    let combined = generated("gyroscope-combined-offsets");
    check(&combined, "gyroscope-combined-offsets", &Reference::combined_offsets());
}

#[test]
fn the_twin_converges_with_order_four() {
    let twin = careful(&model("gyroscope"));
    check(&twin, "gyroscope", &Reference::paper());
}
