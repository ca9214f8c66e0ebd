//! Extreme and stiff scenes over short spans against solutions in minimal coordinates: a pass through gimbal lock,
//! stiff bearings, ratios of 1e12, a linkage through the pose with all bars in line; and starts and numbers that are
//! wrong.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_reference::{DoubleDouble, Gyroscope as Reference, JointRow, Start as ReferenceStart, scene};
use gyro_runner::{JointSample, Sample, Settings};
use gyro_sim::{
    CorrectedDynamics, Direct, Dynamics, Error, Exact, Joint, JointCoordinate, JointSpace, Mechanism,
    Partition, Partitioned, Rk4, Turns,
};
use gyro_sim_suite::{
    Engine, Random, Run, compiled, coordinate, fed, generated, model, simulate, violated_start,
};

/// Steps between corrections, as in the paper.
const STEPS_PER_CORRECTION: u32 = 5;

/// Samples of a run.
const SAMPLES: u32 = 10;

/// Each coordinate and rate over the largest that it has in the run.
const AGREEMENT: f64 = 1e-8;

/// What stays zero is compared with this instead, rad and rad/s.
const NOTHING: f64 = 1e-6;

/// A model file and how far to follow it in steps of which length, s.
struct Extreme {
    page: &'static str,
    t_end: f64,
    step: f64,
}

/// Steps so long that truncation, not rounding, is most of the error.
const EXTREMES: [Extreme; 10] = [
    Extreme { page: "gyroscope-fast", t_end: 5e-4, step: 5e-8 },
    Extreme { page: "gyroscope-at-rest", t_end: 2.0, step: 5e-4 },
    Extreme { page: "gyroscope-light-rings", t_end: 0.2, step: 5e-5 },
    Extreme { page: "gyroscope-heavy-rotor", t_end: 0.2, step: 5e-5 },
    Extreme { page: "gyroscope-gimbal-lock", t_end: 0.5, step: 1e-4 },
    Extreme { page: "gyroscope-stiff", t_end: 2e-3, step: 2.5e-7 },
    Extreme { page: "gyroscope-overdamped", t_end: 1e-3, step: 1e-7 },
    Extreme { page: "gyroscope-coulomb", t_end: 0.05, step: 5e-6 },
    Extreme { page: "gyroscope-rolling-base", t_end: 0.1, step: 2e-5 },
    Extreme { page: "gyroscope-long", t_end: 1.0, step: 5e-5 },
];

fn extreme(page: &str) -> &'static Extreme {
    EXTREMES.iter().find(|extreme| extreme.page == page).expect("a model file of the list")
}

impl Extreme {
    fn settings(&self) -> Settings {
        let (t_end, step) = (self.t_end, self.step);
        let correct_every = Some(f64::from(STEPS_PER_CORRECTION) * step);
        Settings { t_end, step, correct_every, sample_every: t_end / f64::from(SAMPLES) }
    }
}

/// The reference at some times.
fn expected(page: &str, times: &[f64]) -> Vec<JointRow> {
    scene(page).unwrap_or_else(|| panic!("{page} has no reference")).solve(times)
}

/// All scalar coordinates of a sample, as its reference gives them.
fn row(sample: &Sample) -> JointRow {
    let scalar = |joint: &JointSample| match *joint {
        JointSample::Angle { position, rate } | JointSample::Length { position, rate } => {
            Some((position, rate))
        }
        JointSample::Orientation { .. } => None,
    };
    let (positions, rates) = sample.coordinates.iter().filter_map(scalar).unzip();
    JointRow { t: sample.t, positions, rates, orientations: Vec::new() }
}

/// The worst error of positions and of rates, each over the largest of its coordinate.
fn errors(found: &[JointRow], expected: &[JointRow]) -> [f64; 2] {
    let worst = |values: fn(&JointRow) -> &Vec<f64>| {
        let n = values(&expected[0]).len();
        let of_coordinate = |k: usize| {
            let scale = expected.iter().map(|row| values(row)[k].abs()).fold(0.0, f64::max);
            let scale = if scale == 0.0 { NOTHING } else { scale };
            let error = |(a, b): (&JointRow, &JointRow)| (values(a)[k] - values(b)[k]).abs() / scale;
            found.iter().zip(expected).map(error).fold(0.0, |a: f64, b| if b.is_nan() { b } else { a.max(b) })
        };
        (0..n).map(of_coordinate).fold(0.0, |a: f64, b| if b.is_nan() { b } else { a.max(b) })
    };
    assert_eq!(found.len(), expected.len());
    assert!(found.iter().zip(expected).all(|(a, b)| a.positions.len() == b.positions.len()));
    [worst(|row| &row.positions), worst(|row| &row.rates)]
}

fn assert_near(what: &str, found: &[JointRow], expected: &[JointRow]) {
    let errors = errors(found, expected);
    println!("{what}: positions and rates off by {:.1e}, {:.1e}", errors[0], errors[1]);
    let is_near = errors.iter().all(|error| *error <= AGREEMENT);
    assert!(is_near, "{what}: off by {errors:?}:\n{:?}\n{:?}", found.last(), expected.last());
}

fn followed(extreme: &Extreme) -> Run {
    let (mechanism, model) = (generated(extreme.page), model(extreme.page));
    simulate(&mechanism, &model, &extreme.settings())
}

#[test]
fn extreme_scenes_by_the_partition() {
    for extreme in &EXTREMES {
        let run = followed(extreme);
        let times: Vec<f64> = run.samples.iter().map(|sample| sample.t).collect();
        let found: Vec<JointRow> = run.samples.iter().map(row).collect();
        assert_near(extreme.page, &found, &expected(extreme.page, &times));
    }
}

/// RK4 in joint coordinates, and the partition as a program has it that knows its mechanism: between corrections it
/// integrates by the short way that only corrected states have.
fn check_compiled(extreme: &Extreme) {
    let Extreme { page, t_end, step, .. } = *extreme;
    let mechanism = &generated(page);
    let n_steps = (t_end / step).round() as u32;
    let interval = n_steps / SAMPLES;
    let (mut x, mut y) = (mechanism.joint_start(), mechanism.start());
    let (mut rk4, mut solver) = (Rk4::new(&x), Partitioned::new(mechanism, &y));
    let mut in_joints = x.clone();
    let (mut by_form, mut by_partition) = (Vec::new(), Vec::new());
    for sample in 0..SAMPLES {
        for k in sample * interval..(sample + 1) * interval {
            rk4.step(&Joint, mechanism, f64::from(k) * step, step, &mut x);
            if k % STEPS_PER_CORRECTION == 0 {
                let t = f64::from(k) * step;
                solver.advance(mechanism, t, step, STEPS_PER_CORRECTION, &mut y).expect("it goes on");
            }
        }
        let t = f64::from((sample + 1) * interval) * step;
        // The map takes the turn of an angle from what was there before.
        in_joints.clone_from(&x);
        mechanism.to_joints(t, &y, &mut in_joints);
        by_form.push(joint_row(mechanism, t, &x));
        by_partition.push(joint_row(mechanism, t, &in_joints));
    }
    let times: Vec<f64> = by_form.iter().map(|row| row.t).collect();
    let expected = expected(page, &times);
    assert_near(&format!("{page}, joint coordinates"), &by_form, &expected);
    assert_near(&format!("{page}, corrected states"), &by_partition, &expected);
}

/// A joint state is all coordinates, then all rates, then perhaps work.
fn joint_row<M: JointSpace<Scalar = f64>>(mechanism: &M, t: f64, x: &M::Joints) -> JointRow {
    let n = mechanism.joint_buffers().rates.as_ref().len();
    let (positions, rates) = x.as_ref().split_at(n);
    JointRow { t, positions: positions.to_vec(), rates: rates[..n].to_vec(), orientations: Vec::new() }
}

#[test]
fn extreme_scenes_in_joint_coordinates_and_at_corrected_states() {
    EXTREMES.iter().for_each(check_compiled);
}

#[test]
fn gimbal_lock_is_passed() {
    let run = followed(extreme("gyroscope-gimbal-lock"));
    let (lowest, fastest) = run.samples.iter().fold((0.0_f64, 0.0_f64), |(lowest, fastest), sample| {
        (lowest.min(coordinate(sample, 1).0), fastest.max(coordinate(sample, 0).1))
    });
    assert!(lowest < -2.0 && fastest > 10.0, "it stays away from gimbal lock: {lowest} rad, {fastest} rad/s");
}

#[test]
fn another_scene_does_not_pass() {
    // The check must be able to fail: a rotor a part in 1e7 faster.
    let run = followed(extreme("gyroscope-gimbal-lock"));
    let found: Vec<JointRow> = run.samples.iter().map(row).collect();
    let times: Vec<f64> = found.iter().map(|row| row.t).collect();
    let mut wrong = expected("gyroscope-gimbal-lock", &times);
    wrong.iter_mut().for_each(|row| row.positions[2] *= 1.0 + 1e-7);
    assert!(errors(&found, &wrong)[0] > AGREEMENT);
}

/// Steps, s, for the linkage, and how far its joints may be off, rad: near the pose in line accelerations are quotients
/// of small numbers, and short steps come nearer to it.
const STEPS_IN_LINE: [(f64, f64); 3] = [(5e-3, 1e-5), (1e-3, 1e-6), (1e-4, 1e-4)];

#[test]
fn a_linkage_comes_through_the_pose_in_line_or_says_why_not() {
    let (mechanism, model) = (generated("four-bar-in-line"), model("four-bar-in-line"));
    for (step, allowed) in STEPS_IN_LINE {
        let settings = Settings { t_end: 0.5, step, correct_every: Some(step), sample_every: step };
        let (samples, outcome) = fed(&mechanism, &model, &settings, Vec::new());
        let times: Vec<f64> = samples.iter().map(|sample| sample.t).collect();
        let mut worst = 0.0_f64;
        for (found, expected) in samples.iter().map(row).zip(expected("four-bar-in-line", &times)) {
            for (a, b) in found.positions.iter().zip(&expected.positions) {
                worst = worst.max((a - b).abs());
            }
            assert!(worst <= allowed, "{step} s: {found:?}\n{expected:?}");
        }
        let words = outcome.err().map(|failure| failure.to_string());
        let last = samples.last().expect("a start");
        let (t, crank) = (last.t, coordinate(last, 0).0);
        println!("four-bar in line, {step} s: to {t:.4} s and {crank:.4} rad, off by {worst:.1e}; {words:?}");
        match words {
            None => assert!(samples.iter().any(|sample| coordinate(sample, 0).0 > 0.4), "it never rises"),
            Some(words) => {
                assert!(words.contains("at t = ") && words.contains("joint `"), "{words}");
                assert!(crank.abs() < 0.4, "it stops far from the pose in line: {crank}, {words}");
            }
        }
    }
}

/// Of lengths in terms of the mechanism's size, of Euler parameters in terms of one.
const WRONG: f64 = 1e-3;

/// ‖Φ‖ of corrected states.
const CORRECTED: f64 = 1e-12;

/// After a fifth of a second at the paper's step, rad.
const FOLLOWED: f64 = 1e-9;

fn position_violation(mechanism: &Engine, y: &Vec<f64>) -> f64 {
    let mut phi = mechanism.buffers().constraints;
    mechanism.phi(0.0, y, &mut phi);
    gyro_sim::violation(mechanism, &phi[..mechanism.buffers().rows.len()]).value
}

/// α, β, φ and their rates.
fn joints(mechanism: &Engine, y: &Vec<f64>, nearest: [f64; 3]) -> ([f64; 3], [f64; 3]) {
    let turns = Turns::new(mechanism, 0.0, y, &nearest);
    let of = |joint: usize| match turns.coordinate(mechanism, joint, 0) {
        Some(JointCoordinate::Angle { position, rate }) => (position, rate),
        other => panic!("{other:?}"),
    };
    let pairs = [0, 1, 2].map(of);
    (pairs.map(|(position, _)| position), pairs.map(|(_, rate)| rate))
}

/// The paper's gyroscope from these angles and rates, in 31 digits.
fn reference_from((angles, rates): ([f64; 3], [f64; 3])) -> Reference {
    let [alpha_rate, beta_rate, phi_rate] = rates.map(DoubleDouble::new);
    let angles = angles.map(DoubleDouble::new);
    let spin = phi_rate + alpha_rate * angles[1].sin_cos().0;
    Reference {
        start: ReferenceStart { angles, ring_rates: [alpha_rate, beta_rate], spin },
        ..Reference::paper()
    }
}

#[test]
fn a_wrong_start_is_corrected_by_the_partition_and_not_hidden_by_direct_integration() {
    const STEP: f64 = 1e-4;
    const INTERVALS: u32 = 400;
    let (mechanism, model) = (generated("gyroscope"), model("gyroscope"));
    let wrong = violated_start(&model, WRONG, &mut Random::new(9));
    let before = position_violation(&mechanism, &wrong);
    assert!(before > 0.1 * WRONG && before < 10.0 * WRONG, "{before:e}");

    // Φ̈ = 0 is all that direct integration keeps: what is wrong stays wrong.
    let (mut y, mut direct) = (wrong.clone(), Direct::new(Exact, &wrong));
    direct.advance(&mechanism, 0.0, STEP, 5 * INTERVALS, &mut y).expect("it goes on");
    let after = position_violation(&mechanism, &y);
    assert!(after > 0.5 * before, "direct integration hides what is wrong: {before:e}, then {after:e}");

    // The partition meets the constraints at once and follows the motion from there.
    let mut y = wrong.clone();
    let mut solver = Partitioned::new(&mechanism, &y);
    solver.correct(&mechanism, 0.0, &mut y).expect("it can be corrected");
    let corrected = position_violation(&mechanism, &y);
    let start = joints(&mechanism, &y, [0.0; 3]);
    for interval in 0..INTERVALS {
        solver.advance(&mechanism, f64::from(5 * interval) * STEP, STEP, 5, &mut y).expect("it goes on");
    }
    let end = reference_from(start).solve(&[f64::from(5 * INTERVALS) * STEP])[0];
    let expected = [end.alpha, end.beta, end.phi];
    let (found, _) = joints(&mechanism, &y, expected);
    let error = found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    println!(
        "violation {before:.1e}; direct {after:.1e}; corrected {corrected:.1e}, then off by {error:.1e} rad"
    );
    assert!(corrected <= CORRECTED, "{corrected:e}");
    assert!(error <= FOLLOWED, "{found:?} {expected:?}");
    // It is another motion than that of the right start.
    let right = Reference::paper().solve(&[f64::from(5 * INTERVALS) * STEP])[0];
    assert!((right.alpha - end.alpha).abs() > 100.0 * FOLLOWED);
}

const NO_NUMBERS: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// Both algorithms end in an error.
fn assert_refused<M: Partition<Scalar = f64> + Dynamics + CorrectedDynamics>(what: &str, mechanism: &M) {
    let start = mechanism.start();
    let (mut y, mut z) = (start.clone(), start.clone());
    let by_partition = Partitioned::new(mechanism, &start).advance(mechanism, 0.0, 1e-4, 5, &mut y);
    let directly = Direct::new(Exact, &start).advance(mechanism, 0.0, 1e-4, 5, &mut z);
    for outcome in [by_partition, directly] {
        assert!(matches!(outcome, Err(Error::NotFinite { .. })), "{what}: {outcome:?}, {y:?}");
    }
}

#[test]
fn inputs_that_are_no_numbers_are_an_error() {
    for value in NO_NUMBERS {
        let mut motor = generated("motor");
        assert!(motor.set_input(0, value));
        assert_refused(&format!("a torque of {value}"), &motor);
    }
}

#[test]
fn parameters_that_are_no_numbers_are_an_error() {
    let page = "gyroscope-parameters";
    for (place, parameter) in model(page).parameters.iter().enumerate() {
        for value in NO_NUMBERS {
            let mut mechanism = compiled::<f64>(page);
            assert!(mechanism.set_parameter(place, value));
            assert_refused(&format!("{} = {value}", parameter.name), &mechanism);
        }
    }
}

#[test]
fn states_that_are_no_numbers_are_an_error() {
    for page in ["gyroscope-light-rings", "gyroscope-overdamped", "four-bar-in-line"] {
        let mechanism = generated(page);
        let start = mechanism.start();
        for (place, value) in (0..start.len()).flat_map(|place| NO_NUMBERS.map(|value| (place, value))) {
            let mut y = start.clone();
            y[place] = value;
            let outcome = Partitioned::new(&mechanism, &y).advance(&mechanism, 0.0, 1e-7, 5, &mut y.clone());
            let directly = Direct::new(Exact, &y).advance(&mechanism, 0.0, 1e-7, 5, &mut y);
            assert!(outcome.is_err() && directly.is_err(), "{page}: element {place} = {value} passes");
        }
    }
}
