//! No number makes a generated mechanism panic: a run that cannot go on says so by an error value.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_model::Model;
use gyro_sim::{Direct, Dynamics, Error, Exact, Kinematics, Mechanism, Partitioned, Real, Turns, violation};
use gyro_sim_suite::{Engine, Random, for_each_generated, in_single_precision, model, pages};
use std::collections::BTreeSet;

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
fn exercise<T: Real + 'static>(mechanism: &Engine<T>, y: &Vec<T>) -> Result<(), Error> {
    let t = T::constant(0.0);
    let (mut phi, mut rows) = (mechanism.buffers().constraints, mechanism.buffers().rows);
    mechanism.phi(t, y, &mut phi);
    mechanism.velocity_residual(t, y, &mut rows);
    violation(mechanism, &rows);
    mechanism.gamma(t, y, &mut rows);
    mechanism.nu(t, y, &mut rows);
    let (mut phi_q, mut phi_pi) = (mechanism.terms().phi_q, mechanism.terms().phi_pi);
    mechanism.phi_q(t, y, &mut phi_q);
    mechanism.phi_pi(t, y, &mut phi_pi);
    let mut velocities = mechanism.buffers().velocities;
    mechanism.applied_force(t, y, &mut velocities);
    let (mut accelerations, mut outputs) = (mechanism.acceleration_buffer(), mechanism.buffers().outputs);
    mechanism.accelerations(t, y, &mut accelerations);
    mechanism.multipliers(t, y, &accelerations, &mut rows);
    mechanism.outputs(t, y, &mut outputs);
    mechanism.energy(t, y);
    let mut turns = Turns::new(mechanism, t, y, &[]);
    turns.update(mechanism, t, T::constant(f64::INFINITY), y);
    for joint in 0..=mechanism.description().joints.len() {
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

impl Survives {
    fn check<T: Real + 'static>(&mut self, page: &str, mechanism: &Engine<T>) {
        let start: Vec<f64> = mechanism.start().iter().map(|x| x.to_f64()).collect();
        let mut random = Random::new(5);
        for index in 0..STATES {
            let values = hard_state(&start, &mut random);
            let y = values.iter().map(|x| T::constant(*x)).collect();
            let run = || exercise(mechanism, &y);
            let outcome = std::panic::catch_unwind(std::panic::AssertUnwindSafe(run))
                .unwrap_or_else(|_| panic!("{page}, state {index} panics: {values:?}"));
            match outcome {
                Ok(()) => self.survivors += 1,
                Err(Error::NotFinite { .. }) => self.errors[0] += 1,
                Err(Error::NoConvergence { .. }) => self.errors[1] += 1,
                Err(Error::Singular { .. }) => self.errors[2] += 1,
                Err(Error::Jump { .. }) => self.errors[3] += 1,
                Err(other) => panic!("fixed steps do not end in {other:?}"),
            }
            let is_finite = y.iter().all(|x| x.is_finite());
            assert!(is_finite || outcome.is_err(), "{page}, state {index} passes: {values:?}");
        }
    }
}

/// The states must be hard enough, and not all of them hopeless.
fn assert_hard(survives: &Survives) {
    println!(
        "not finite, no convergence, singular, jump: {:?}; run through: {}",
        survives.errors, survives.survivors
    );
    assert!(
        survives.errors[0] > 0 && survives.errors[1] > 0 && survives.survivors > 0,
        "{:?}",
        survives.errors
    );
}

#[test]
fn hard_numbers_in_double_precision() {
    let mut survives = Survives::default();
    for_each_generated(|page, mechanism| survives.check(page, mechanism));
    assert_hard(&survives);
}

#[test]
fn hard_numbers_in_single_precision() {
    let mut survives = Survives::default();
    in_single_precision().iter().for_each(|(page, mechanism)| survives.check(page, mechanism));
    assert_hard(&survives);
}

/// The words by which a model's parts are told apart: kinds of supports, joints, forces, outputs, motions. What is
/// found of rows that depend on others is no part.
fn kinds(model: &Model) -> BTreeSet<String> {
    let text = format!("{:?}", Model { redundant: Vec::new(), ..model.clone() });
    let words = text.split(|c: char| !c.is_alphanumeric());
    words.filter(|word| word.starts_with(char::is_uppercase)).map(str::to_owned).collect()
}

#[test]
fn every_kind_of_part_is_in_a_mechanism_of_single_precision() {
    let all: BTreeSet<String> = pages().iter().flat_map(|page| kinds(&model(page))).collect();
    let single = in_single_precision();
    let found: BTreeSet<String> = single.iter().flat_map(|(page, _)| kinds(&model(page))).collect();
    let missing: Vec<&String> = all.difference(&found).collect();
    assert!(missing.is_empty(), "only in double precision: {missing:?}");
    assert!(single.len() < pages().len());
}

/// A step so long that the motion is lost: an error, and one that tells the time.
fn check_long_steps<T: Real + 'static>(page: &str, mechanism: &Engine<T>) {
    for step in [1.0, 1e3, 1e30, f64::NAN] {
        let (mut y, mut ends) = (mechanism.start(), mechanism.start());
        let mut solver = Partitioned::new(mechanism, &y);
        let mut direct = Direct::new(Exact, &ends);
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

#[test]
fn steps_that_are_too_long() {
    for_each_generated(check_long_steps);
    in_single_precision().iter().for_each(|(page, mechanism)| check_long_steps(page, mechanism));
}
