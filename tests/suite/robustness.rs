//! No number makes a generated mechanism panic: a run that cannot go on says so by an error value.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_sim::{Direct, Error, Partitioned, Real, Turns, violation};
use gyro_sim_suite::{Check, Engine, Random, for_each_generated, state_of};

const STATES: usize = 300;

/// Numbers that arithmetic finds hard, in either precision.
const HARD: [f64; 14] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    0.0,
    -0.0,
    1e300,
    -1e300,
    1e38,
    -1e38,
    1e19,
    1e-300,
    1e-40,
    1e-20,
    -1.0,
];

/// A state of the start's numbers, some of them replaced by hard ones: half of the time a single one, else up to all.
fn hard_state(start: &[f64], random: &mut Random) -> Vec<f64> {
    let mut values = start.to_vec();
    let n_places = if random.signed() < 0.0 { 1 } else { 1 + random.below(values.len()) };
    for _ in 0..n_places {
        let place = random.below(values.len());
        values[place] = HARD[random.below(HARD.len())];
    }
    values
}

/// Calls everything once, through a corrected step and a reading of the turns.
fn exercise<T: Real, M: Engine<T>>(mechanism: &M, y: &M::State) -> Result<(), Error> {
    let t = T::constant(0.0);
    let (mut phi, mut rows) = (mechanism.constraints(), mechanism.rows());
    mechanism.phi(t, y, &mut phi);
    mechanism.velocity_residual(t, y, &mut rows);
    violation(mechanism, rows.as_ref());
    mechanism.gamma(t, y, &mut rows);
    mechanism.nu(t, y, &mut rows);
    let (mut phi_q, mut phi_pi) = (mechanism.phi_q_values(), mechanism.phi_pi_values());
    mechanism.phi_q(t, y, &mut phi_q);
    mechanism.phi_pi(t, y, &mut phi_pi);
    let mut velocities = mechanism.velocities();
    mechanism.applied_force(t, y, &mut velocities);
    let (mut accelerations, mut outputs) = (mechanism.accelerations_buffer(), mechanism.outputs_buffer());
    mechanism.accelerations(t, y, &mut accelerations);
    mechanism.multipliers(t, y, &accelerations, &mut rows);
    mechanism.outputs(t, y, &mut outputs);
    mechanism.energy(t, y);
    let mut turns = Turns::new(mechanism, t, y, &[]);
    turns.update(mechanism, t, T::constant(f64::INFINITY), y);
    for joint in 0..=mechanism.n_joints() {
        turns.coordinate(mechanism, joint, 0);
    }
    let mut solver = Partitioned::new(mechanism, y);
    let mut corrected = y.clone();
    let outcome = solver.correct(mechanism, t, &mut corrected);
    solver.advance(mechanism, t, T::constant(1e-4), 5, &mut y.clone()).and(outcome)
}

/// Counts outcomes; a panic ends the test with the state printed.
#[derive(Default)]
struct Survives {
    errors: [usize; 4],
    survivors: usize,
}

impl<T: Real> Check<T> for Survives {
    fn check<M: Engine<T>>(&mut self, page: &str, mechanism: &M) {
        let start: Vec<f64> = mechanism.start().as_ref().iter().map(|x| x.to_f64()).collect();
        let mut random = Random::new(5);
        for index in 0..STATES {
            let values = hard_state(&start, &mut random);
            let y = state_of(mechanism, &values);
            let run = || exercise(mechanism, &y);
            let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(run))
                .unwrap_or_else(|_| panic!("{page}, state {index} panics: {values:?}"));
            match outcome {
                Ok(()) => self.survivors += 1,
                Err(Error::NotFinite { .. }) => self.errors[0] += 1,
                Err(Error::NoConvergence { .. }) => self.errors[1] += 1,
                Err(Error::Singular { .. }) => self.errors[2] += 1,
                Err(Error::Jump { .. }) => self.errors[3] += 1,
            }
            let is_finite = y.as_ref().iter().all(|x| x.is_finite());
            assert!(is_finite || outcome.is_err(), "{page}, state {index} passes: {values:?}");
        }
    }
}

fn check<T: Real>() {
    let mut survives = Survives::default();
    for_each_generated::<T>(&mut survives);
    println!(
        "not finite, no convergence, singular, jump: {:?}; run through: {}",
        survives.errors, survives.survivors
    );
    // The states must be hard enough, and not all of them hopeless.
    assert!(
        survives.errors[0] > 0 && survives.errors[1] > 0 && survives.survivors > 0,
        "{:?}",
        survives.errors
    );
}

#[test]
fn hard_numbers_in_double_precision() {
    check::<f64>();
}

#[test]
fn hard_numbers_in_single_precision() {
    check::<f32>();
}

/// A step so long that the motion is lost: an error, and one that tells the time.
struct LongSteps;

impl<T: Real> Check<T> for LongSteps {
    fn check<M: Engine<T>>(&mut self, page: &str, mechanism: &M) {
        for step in [1.0, 1e3, 1e30, f64::NAN] {
            let (mut y, mut ends) = (mechanism.start(), mechanism.start());
            let mut solver = Partitioned::new(mechanism, &y);
            let mut direct = Direct::new(&ends);
            let h = T::constant(step);
            for _ in 0..20 {
                // Neither may panic; either may survive a step of a second.
                let partitioned = solver.advance(mechanism, T::constant(2.0), h, 5, &mut y);
                let integrated = direct.advance(mechanism, T::constant(2.0), h, 5, &mut ends);
                for outcome in [partitioned, integrated] {
                    assert!(step > 0.0 || outcome.is_err(), "{page}: a step of {step} s passes");
                }
            }
        }
    }
}

#[test]
fn steps_that_are_too_long() {
    for_each_generated::<f64>(&mut LongSteps);
    for_each_generated::<f32>(&mut LongSteps);
}
