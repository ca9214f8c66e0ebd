//! A hundred seconds of the paper's scene: the coordinate partition lasts, and what it is there for shows without it.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_assembled::Dense;
use gyro_mechanisms::gyroscope::Gyroscope;
use gyro_reference::{Gyroscope as Reference, Scheme};
use gyro_runner::Settings;
use gyro_sim::integrate::Method;
use gyro_sim::{
    Control, Direct, Error, Exact, Kutta4, MassWeighted, Mechanism, Partition, Partitioned, Solver, Tsit5,
    Turns, When, violation,
};
use gyro_sim_suite::{PAPER, coordinate, generated, model, simulate};
use std::sync::LazyLock;

const T_END: f64 = 100.0;
const STEP: f64 = 1e-4;
const STEPS_PER_CORRECTION: u32 = 5;

/// When a fixed choice of independent coordinates has long spoiled the motion, s.
const T_RUINED: f64 = 40.0;
const STEPS_OF_A_FIXED_CHOICE: u32 = 20;
const CORRECTIONS: u32 = 20_000;

/// Bounds on ‖Φ‖ and on the relative energy drift: rounding over a hundred thousand steps stays well below both.
const VIOLATION: f64 = 1e-12;
const DRIFT: f64 = 1e-10;

/// α, rad: grows with time, 3e-11 after a second, about 2e-9 after a hundred.
const ALPHA: f64 = 5e-9;

/// α by the mass-weighted projection, rad, with RK4 and with Tsitouras's method.
const ALPHA_PROJECTED: [f64; 2] = [5e-11, 5e-11];

/// What a fixed choice does to the energy and to α: a thousand times what the partition is allowed, at least.
const RUINED_DRIFT: f64 = 1e3 * DRIFT;
const RUINED_ALPHA: f64 = 1e3 * ALPHA;

/// α at [`T_RUINED`] and [`T_END`], rad: good to 1e-13 over the whole run, as the reference's own scheme shows, which
/// takes three times as long.
static ALPHAS: LazyLock<[f64; 2]> = LazyLock::new(|| {
    let scheme = Scheme { step: 0.02, columns: 12, tolerance: 1e-14 };
    let solution = Reference::paper().solve_precisely(&[T_RUINED, T_END], &scheme).unwrap();
    [0, 1].map(|k| solution[k].alpha.to_f64())
});

#[test]
fn the_partition_lasts_a_hundred_seconds() {
    let settings = Settings { t_end: T_END, sample_every: 0.1, ..PAPER };
    let run = simulate(&generated("gyroscope"), &model("gyroscope"), &settings);
    let (summary, alpha) = (run.summary, coordinate(run.last(), 0).0);
    let error = (alpha - ALPHAS[1]).abs();
    println!("{summary:?}, error of alpha {error:e} rad");
    assert!(summary.position_violation <= VIOLATION, "violation {:e}", summary.position_violation);
    assert!(summary.energy_drift <= DRIFT, "energy drift {:e}", summary.energy_drift);
    assert!(error <= ALPHA, "alpha is off by {error:e} rad");
    // Each half turn of the rotor is a quarter turn of its Euler parameters: two switches a turn.
    assert_eq!(summary.chart_switches, 3189, "an algorithm has changed");
}

#[test]
fn the_projection_lasts_a_hundred_seconds_with_rk4() {
    projected(Kutta4::new, ALPHA_PROJECTED[0]);
}

#[test]
fn the_projection_lasts_a_hundred_seconds_with_tsit5() {
    projected(Tsit5::new, ALPHA_PROJECTED[1]);
}

/// At the paper's step and with its corrections.
fn projected<A: Method<Exact, Gyroscope<f64>>>(method: impl Fn(&[f64; 39]) -> A, limit: f64) {
    let mechanism = Gyroscope::<f64>::default();
    let y = mechanism.start();
    let control = Control { when: When::Steps(STEPS_PER_CORRECTION), ..Control::default() };
    let correction = MassWeighted::new(&mechanism);
    let mut solver = Solver::with_correction(Exact, method(&y), correction, 0.0, &y).with_control(control);
    solver.advance(&mechanism, STEP, 1_000_000).unwrap();
    let error = (alpha(&mechanism, solver.state(), ALPHAS[1]) - ALPHAS[1]).abs();
    println!("mass-weighted projection: error of alpha {error:e} rad");
    assert!(error <= limit, "{error:e}");
}

/// α of a state, as near as can be to what is expected.
fn alpha(mechanism: &Gyroscope<f64>, y: &[f64; 39], expected: f64) -> f64 {
    match Turns::new(mechanism, 0.0, y, &[expected]).coordinate(mechanism, 0, 0) {
        Some(gyro_sim::JointCoordinate::Angle { position, .. }) => position,
        other => panic!("{other:?}"),
    }
}

#[test]
fn direct_integration_leaves_the_constraints() {
    let settings = Settings { t_end: 10.0, correct_every: None, sample_every: 1.0, ..PAPER };
    let direct = simulate(&generated("gyroscope"), &model("gyroscope"), &settings);
    let [early, late] = [direct.at(1.0), direct.at(10.0)].map(|sample| sample.position_violation);
    println!("direct integration: violation {early:e} after 1 s, {late:e} after 10 s");
    assert!(early > VIOLATION, "{early:e}");
    // With the square of time: 100 times. Ten times would be growth with time alone.
    assert!(late > 30.0 * early, "{early:e} {late:e}");
}

/// The paper's partition, positions and velocities by eqs. (18) and (19), with one choice of independent coordinates
/// for all times, for each joint the Euler parameter that is best at the start; the state at the end. The generated
/// partition keeps the rates about the joints' axes instead, which no choice of Euler parameters can spoil.
fn fixed_choice(mechanism: &Gyroscope<f64>) -> Result<[f64; 39], Error> {
    let paper = Dense::<f64>::new(&model("gyroscope")).unwrap();
    let mut y = mechanism.start();
    let mut corrected = y.to_vec();
    let charts = mechanism.independent(0.0, &y);
    let choice = (0..).zip(charts).map(|(body, special)| 7 * body + 3 + usize::from(special)).collect();
    let mut direct = Direct::new(Exact, &y);
    let mut partitioned = Partitioned::with_independent(&paper, &corrected, choice);
    for interval in 0..CORRECTIONS {
        let step = interval * STEPS_OF_A_FIXED_CHOICE;
        direct.advance(mechanism, f64::from(step) * STEP, STEP, STEPS_OF_A_FIXED_CHOICE, &mut y)?;
        let t = f64::from(step + STEPS_OF_A_FIXED_CHOICE) * STEP;
        corrected.copy_from_slice(&y);
        partitioned.correct_with_current_choice(&paper, t, &mut corrected)?;
        y.copy_from_slice(&corrected);
    }
    Ok(y)
}

#[test]
fn one_fixed_choice_of_independent_coordinates_does_not() {
    let mechanism = Gyroscope::default();
    let y = match fixed_choice(&mechanism) {
        Ok(y) => y,
        Err(error) => return println!("a fixed choice fails: {error}"),
    };
    let energies = (mechanism.energy(T_RUINED, &y), mechanism.energy(0.0, &mechanism.start()));
    let drift = (energies.0.total() - energies.1.total()) / energies.0.kinetic;
    let expected = ALPHAS[0];
    let alpha = alpha(&mechanism, &y, expected);
    println!("a fixed choice: energy drift {drift:e}, error of alpha {:e} rad", alpha - expected);
    assert!(drift.abs() > RUINED_DRIFT, "energy drift {drift:e}");
    assert!((alpha - expected).abs() > RUINED_ALPHA, "alpha {alpha}, should be {expected}");
    // What makes it treacherous: the constraints themselves are met.
    let mut phi = mechanism.buffers().constraints;
    mechanism.phi(T_RUINED, &y, &mut phi);
    assert!(violation(&mechanism, &phi[..15]).value <= VIOLATION);
}
