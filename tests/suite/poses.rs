//! Singular poses, in which a linkage could go on in more ways than one: passed on the right way under error control,
//! at coarse and fine tolerances alike, or named.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_model::Model;
use gyro_reference::Pendulum;
use gyro_runner::motion::{MotionBuilder, Projecting, WithDuals};
use gyro_runner::{Approach, Coordinates, Correction, Failure, Grade, Integrator, Sample, Settings, Summary};
use gyro_sim::{CloseLoops, JointSpace, Mechanism};
use gyro_sim_suite::{
    Duals, Engine, compiled, coordinate, dense, duals, generated, generated_with_joints, judged, model,
    moved, start_of, worst,
};
use std::f64::consts::{FRAC_PI_2, PI};
use std::fmt::Write as _;

/// Errors of single steps add up over some ten poses, each of which is passed with an error of some ten tolerances, and
/// a linkage that almost comes to rest upright enlarges them: so many tolerances are allowed.
const ADDED_UP: f64 = 2e4;

/// Rounding is enlarged near poses.
const ROUNDING: f64 = 1e-7;

/// Crank and rocker of a parallelogram, rad: equal on its own way, far apart within a tenth of a second on the other.
const BRANCH: f64 = 1e-2;

/// A02 with two cells: where the tip of the first bar is at 10 s, m.
const PUBLISHED: [f64; 2] = [0.328_458_11, 0.944_518_54];

/// A planar revolute joint of bars that lie along their own x axis.
pub(crate) fn hinge(name: &str, first: (&str, f64), second: (&str, f64), angle: &str) -> String {
    let [first, second] =
        [first, second].map(|(body, x)| format!("{{ body = \"{body}\", point = [{x:?}, 0, 0] }}"));
    format!(
        "[[joint]]\nname = \"{name}\"\nkind = \"revolute\"\naxis = [0, 0, 1]\nzero = [1, 0, 0]\nfirst = {first}\nsecond = {second}\n\
         {angle}\n"
    )
}

pub(crate) fn rod(name: &str, length: f64, mass: f64) -> String {
    let inertia = mass * length * length / 12.0;
    format!("[[body]]\nname = \"{name}\"\nmass = {mass:?}\ninertia = [1e-3, {inertia:.9}, {inertia:.9}]\n")
}

pub(crate) const HEAD: &str =
    "format = 1\nname = \"linkage\"\ngravity = [0, -9.81, 0]\n[[body]]\nname = \"ground\"\nfixed = true\n";

pub(crate) fn read(page: &str) -> Model {
    gyro_model::read("linkage.toml", page).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

/// A row of parallelograms, benchmark A02 of the IFToMM technical committee for multibody dynamics (*N-four-bar
/// mechanism*): bars of 1 m and 1 kg, thrown from upright. The first coupler may be longer or shorter by a little.
pub(crate) fn cells(n: usize, speed: f64, excess: f64) -> Model {
    let mut page = HEAD.to_owned();
    for k in 0..=n {
        page += &rod(&format!("bar{k}"), 1.0, 1.0);
        let angle = if k == 0 { format!("angle_deg = 90\nrate = {:?}", -speed) } else { ROUGH_UP.to_owned() };
        page += &hinge(&format!("pivot{k}"), ("ground", k as f64), (&format!("bar{k}"), -0.5), &angle);
    }
    for k in 0..n {
        let length = if k == 0 { 1.0 + excess } else { 1.0 };
        let coupler = format!("coupler{k}");
        page += &rod(&coupler, length, 1.0);
        for (bar, end) in [(k, -0.5), (k + 1, 0.5)] {
            let name = format!("joint{k}_{bar}");
            page += &hinge(&name, (&format!("bar{bar}"), 0.5), (&coupler, end * length), ROUGH_ACROSS);
        }
    }
    read(&page)
}

const ROUGH_UP: &str = "angle_deg = 90\nrough = true";
const ROUGH_ACROSS: &str = "angle_deg = -90\nrough = true";

/// As parallelograms all bars turn as one, couplers not at all.
pub(crate) fn as_pendulum(n: usize, speed: f64) -> Pendulum {
    let n = n as f64;
    let (mass, moment, inertia) = (2.0 * n + 1.0, (n + 1.0) / 2.0 + n, (n + 1.0) / 3.0 + n);
    let distance = moment / mass;
    Pendulum { mass, inertia: inertia - moment * distance, distance, gravity: 9.81, start: PI, rate: speed }
}

pub(crate) fn approach(integrator: Integrator, tolerance: f64, correction: Correction) -> Approach {
    let (coordinates, budget) = (Coordinates::Maximal, Some(20_000));
    Approach {
        integrator,
        tolerance: Some(tolerance),
        coordinates,
        correction,
        budget,
        ..Approach::default()
    }
}

pub(crate) fn run(
    engine: &Engine,
    builder: &dyn MotionBuilder<Engine>,
    (model, t_end): (&Model, f64),
    approach: &Approach,
) -> (Vec<Sample>, Result<Summary, Failure>) {
    let settings = Settings { t_end, step: 1e-3, correct_every: None, sample_every: t_end / 50.0 };
    moved(engine, builder, (&settings, approach), &start_of(model))
}

/// The worst error of the bars' angles, which must not be those of another way on.
pub(crate) fn off_by(
    samples: &[Sample],
    n_bars: usize,
    pendulum: &Pendulum,
    angle: impl Fn(f64) -> f64,
) -> f64 {
    let times: Vec<f64> = samples.iter().map(|sample| sample.t).collect();
    let errors = samples.iter().zip(pendulum.solve(&times)).map(|(sample, expected)| {
        let found: Vec<f64> = (0..n_bars).map(|bar| coordinate(sample, bar).0).collect();
        let spread = worst(&found, &vec![found[0]; n_bars]);
        assert!(spread < BRANCH, "at {} s the bars go different ways: {found:?}", sample.t);
        worst(&found, &vec![angle(expected.angle); n_bars])
    });
    errors.fold(0.0, f64::max)
}

pub(crate) fn pivot_angle(from_gravity: f64) -> f64 {
    FRAC_PI_2 - (from_gravity - PI)
}

#[test]
fn rows_of_parallelograms_pass_at_every_tolerance() {
    use Correction::{MassWeighted, Partition};
    for (n, speed, tolerance, correction) in [
        (1, 0.3, 1e-9, MassWeighted),
        (2, 1.0, 1e-6, Partition),
        (2, 1.0, 1e-9, MassWeighted),
        (2, 1.0, 1e-11, Partition),
        (2, 1.0, 1e-12, Partition),
        (2, 1.0, 1e-12, MassWeighted),
        (3, 2.0, 1e-10, Partition),
    ] {
        let (model, approach) = (cells(n, speed, 0.0), approach(Integrator::Dop853, tolerance, correction));
        let (samples, outcome) = run(&dense(&model), &Projecting, (&model, 3.0), &approach);
        let summary = outcome.unwrap_or_else(|failure| panic!("{n} cells, {approach}: {failure}"));
        let error = off_by(&samples, n + 1, &as_pendulum(n, speed), pivot_angle);
        println!("{n} cells, {approach}: off by {error:.1e}, {:?}", summary.statistics);
        assert!(error < ADDED_UP * tolerance + ROUNDING, "{n} cells, {approach}: {error:e}");
        assert!(summary.statistics.leaps > 0 && summary.statistics.accepted < 1000, "{summary:?}");
    }
}

#[test]
fn the_published_position_is_met() {
    let model = cells(2, 1.0, 0.0);
    let approach = approach(Integrator::Dop853, 1e-9, Correction::Partition);
    let (samples, outcome) = run(&dense(&model), &Projecting, (&model, 10.0), &approach);
    assert!(outcome.is_ok(), "{outcome:?}");
    let (sin, cos) = coordinate(samples.last().expect("it has samples"), 0).0.sin_cos();
    println!("tip at {cos}, {sin}");
    // The last digits are those of the tolerance after 10 poses.
    assert!(worst(&[cos, sin], &PUBLISHED) < 1e-6, "{cos} {sin}");
}

/// What `four-bar-in-line` moves like, by the head of the model file: I = 0.0507 kg.m2, G = 2.7468 N.m, from -60
/// degrees with 12 rad/s.
fn in_line() -> Pendulum {
    Pendulum {
        mass: 1.4,
        inertia: 0.0507 - 1.4 * 0.2 * 0.2,
        distance: 0.2,
        gravity: 9.81,
        start: FRAC_PI_2 - PI / 3.0,
        rate: 12.0,
    }
}

#[test]
fn generated_code_passes_by_every_integrator() {
    let model = model("four-bar-in-line");
    let (engine, builder) =
        (generated("four-bar-in-line"), generated("four-bar-in-line").builder(duals("four-bar-in-line")));
    let pendulum = in_line();
    for (integrator, tolerance, correction) in [
        (Integrator::Dop853, 1e-6, Correction::Partition),
        (Integrator::Dop853, 1e-9, Correction::MassWeighted),
        (Integrator::Dop853, 1e-12, Correction::Partition),
        (Integrator::Dop853, 1e-12, Correction::MassWeighted),
        (Integrator::Tsit5, 1e-6, Correction::MassWeighted),
        (Integrator::Tsit5, 1e-10, Correction::Partition),
        (Integrator::Rodas4, 1e-6, Correction::Partition),
        (Integrator::Rodas4, 1e-7, Correction::MassWeighted),
    ] {
        let approach = approach(integrator, tolerance, correction);
        let (samples, outcome) = run(&engine, &*builder, (&model, 2.0), &approach);
        let summary = outcome.unwrap_or_else(|failure| panic!("{approach}: {failure}"));
        let error = off_by(&samples, 2, &pendulum, |from_gravity| from_gravity - FRAC_PI_2);
        println!("in line, {approach}: off by {error:.1e}, {:?}", summary.statistics);
        assert!(error < ADDED_UP * tolerance + ROUNDING, "{approach}: {error:e}");
    }
}

/// In joint coordinates the clearance is that of the loops' Jacobian.
#[test]
fn joint_coordinates_pass_at_every_tolerance() {
    let in_line = in_line();
    let of_gravity: fn(f64) -> f64 = |from_gravity| from_gravity - FRAC_PI_2;
    let two_cells = generated_with_joints("two-four-bars");
    let one = generated_with_joints("four-bar-in-line");
    for (page, engine, t_end, n_bars, pendulum, angle) in [
        ("four-bar-in-line", one, 2.0, 2, in_line, of_gravity),
        ("two-four-bars", two_cells, 20.0, 3, as_pendulum(2, 1.0), pivot_angle),
    ] {
        let (model, builder) = (model(page), engine.builder(Duals::none()));
        for (integrator, tolerance) in [
            (Integrator::Dop853, 1e-6),
            (Integrator::Dop853, 1e-9),
            (Integrator::Dop853, 1e-12),
            (Integrator::Tsit5, 1e-6),
            (Integrator::Tsit5, 1e-9),
            (Integrator::Rodas4, 1e-6),
        ] {
            let coordinates = Coordinates::Joint;
            let approach = Approach { coordinates, ..approach(integrator, tolerance, Correction::Partition) };
            let (samples, outcome) = run(&engine, &*builder, (&model, t_end), &approach);
            let summary = outcome.unwrap_or_else(|failure| panic!("{page}, {approach}: {failure}"));
            let error = off_by(&samples, n_bars, &pendulum, angle);
            println!("{page}, {approach}: off by {error:.1e}, {:?}", summary.statistics);
            assert!(error < ADDED_UP * tolerance + ROUNDING, "{page}, {approach}: {error:e}");
            assert!(summary.statistics.leaps > 0, "{summary:?}");
        }
    }
}

/// What rounding may do near a pose is counted by how clear of it a state is. Were cells that come into line at once
/// counted as so many times nearer, leaps over the pose would be allowed to be off by as much.
#[test]
fn cells_in_line_at_once_are_about_as_clear_as_one() {
    let cells = compiled::<f64>("two-four-bars");
    let (mut loops, mut x) = (CloseLoops::new(&cells), cells.joint_start());
    for angle in [0.5, 0.1, 0.01, 1e-3] {
        // All bars stand at this angle to the ground, and couplers lie along it.
        for (coordinate, start) in x.iter_mut().zip(cells.joint_start()) {
            *coordinate = if start > 0.0 {
                angle
            } else if start < 0.0 {
                -angle
            } else {
                0.0
            };
        }
        loops.correct(&cells, 0.0, &mut x).expect("bars of one length");
        let mut squares = cells.joint_buffers().closure;
        cells.closure_distances(0.0, &x, &mut squares);
        let least = squares.iter().copied().fold(f64::INFINITY, f64::min).sqrt() / cells.size();
        let clearance = loops.clearance(&cells, 0.0, &x).expect("it has loops").pivot;
        println!("{angle} rad: {clearance:e} where the nearest row is {least:e} away");
        assert!(clearance <= least && clearance > 0.9 * least, "{angle} rad: {clearance:e}, {least:e}");
    }
}

/// Two cells almost come to rest with all bars in line, where little is needed to go on otherwise. At a coarse
/// tolerance the phase is lost, and the verdict says so.
#[test]
fn what_a_coarse_tolerance_loses_is_told() {
    let model = model("two-four-bars");
    let engine = generated_with_joints("two-four-bars");
    let (builder, start) = (engine.builder(Duals::none()), start_of(&model));
    let settings = Settings { t_end: 20.0, step: 1e-3, correct_every: None, sample_every: 0.4 };
    for (integrator, tolerance) in [Integrator::Dop853, Integrator::Tsit5, Integrator::Rodas4]
        .into_iter()
        .flat_map(|integrator| [1e-2, 1e-3, 1e-4].map(|tolerance| (integrator, tolerance)))
    {
        let coordinates = Coordinates::Joint;
        let approach = Approach { coordinates, ..approach(integrator, tolerance, Correction::Partition) };
        let (samples, outcome) = moved(&engine, &*builder, (&settings, &approach), &start);
        let Ok(summary) = outcome else { continue };
        let times: Vec<f64> = samples.iter().map(|sample| sample.t).collect();
        let expected = as_pendulum(2, 1.0).solve(&times);
        let errors = samples.iter().zip(&expected).flat_map(|(sample, expected)| {
            (0..3).map(|bar| (coordinate(sample, bar).0 - pivot_angle(expected.angle)).abs())
        });
        let error = errors.fold(0.0, f64::max);
        let judgement = judged(&engine, &*builder, (&settings, &approach), &start, (&samples, &summary));
        let judgement = judgement.expect("a companion");
        println!("{approach}: off by {error:.1e}, {:?}, {:?}", judgement.grade, judgement.reasons);
        assert!(error < 1e-2 || judgement.grade > Grade::Good, "{approach}: off by {error:e}, called good");
        assert!(error < 1.0 || judgement.grade == Grade::Worthless, "{approach}: off by {error:e}");
    }
}

#[test]
fn without_a_correction_the_pose_is_named() {
    let model = cells(2, 1.0, 0.0);
    for tolerance in [1e-6, 1e-9, 1e-12] {
        let approach = approach(Integrator::Dop853, tolerance, Correction::None);
        let (samples, outcome) = run(&dense(&model), &Projecting, (&model, 5.0), &approach);
        // As far as it comes it is right.
        let error = off_by(&samples, 3, &as_pendulum(2, 1.0), pivot_angle);
        println!("uncorrected, {tolerance:e}: off by {error:.1e}, {outcome:?}");
        assert!(error < ADDED_UP * tolerance + ROUNDING, "{tolerance:e}: {error:e}");
        if let Err(failure) = outcome {
            let words = failure.to_string();
            assert!(words.contains("in a singular pose, where the constraints of joint"), "{words}");
            assert!(words.contains("--correction partition"), "{words}");
        }
    }
}

#[test]
fn what_is_not_quite_a_parallelogram_turns_before_the_pose() {
    for excess in [1e-3, -1e-3, 1e-6] {
        let model = cells(1, 1.0, excess);
        let of = |integrator, tolerance| {
            let approach = approach(integrator, tolerance, Correction::Partition);
            let (samples, outcome) = run(&dense(&model), &Projecting, (&model, 1.0), &approach);
            assert!(outcome.is_ok(), "{excess:e}: {outcome:?}");
            samples
        };
        let (one, other) = (of(Integrator::Dop853, 1e-10), of(Integrator::Tsit5, 1e-8));
        let bars = |sample: &Sample| [0, 1].map(|bar| coordinate(sample, bar).0);
        let apart = one.iter().zip(&other).map(|(a, b)| worst(&bars(a), &bars(b))).fold(0.0, f64::max);
        let [first, second] = bars(one.last().expect("it has samples"));
        println!("{excess:e}: by two methods {apart:.1e} apart, bars at {first} and {second}");
        assert!(apart < 1e-4, "{excess:e}: {apart:e}");
        // Its two ways through the pose have become two ways past it: it goes over from one to the other.
        assert!((first - second).abs() > 0.1, "{excess:e}: {first} {second}");
    }
}

pub(crate) fn rough(angle: f64) -> String {
    let mut text = String::new();
    let _ = write!(text, "angle_deg = {:.6}\nrough = true", angle.to_degrees());
    text
}

/// As many cells as there are generated: `tests/models/two-four-bars.toml`.
#[test]
fn two_cells_pass_for_twenty_seconds_in_both_engines() {
    let page = model("two-four-bars");
    let engines = [("generated", generated("two-four-bars")), ("dense", dense(&page))];
    let rodas = WithDuals(duals("two-four-bars"));
    let kits: [&dyn MotionBuilder<Engine>; 2] = [&rodas, &Projecting];
    for (engine, integrator, tolerance, correction) in [
        (0, Integrator::Dop853, 1e-6, Correction::Partition),
        (0, Integrator::Dop853, 1e-9, Correction::MassWeighted),
        (0, Integrator::Dop853, 1e-12, Correction::Partition),
        (0, Integrator::Rodas4, 1e-6, Correction::Partition),
        (1, Integrator::Dop853, 1e-6, Correction::Partition),
        (1, Integrator::Dop853, 1e-9, Correction::Partition),
        (1, Integrator::Dop853, 1e-12, Correction::MassWeighted),
    ] {
        let (name, approach) = (engines[engine].0, approach(integrator, tolerance, correction));
        let (samples, outcome) = run(&engines[engine].1, kits[engine], (&page, 20.0), &approach);
        let summary = outcome.unwrap_or_else(|failure| panic!("{name}, {approach}: {failure}"));
        let error = off_by(&samples, 3, &as_pendulum(2, 1.0), pivot_angle);
        let at_ten = samples.iter().find(|sample| (sample.t - 10.0).abs() < 1e-9).expect("a sample at 10 s");
        let (sin, cos) = coordinate(at_ten, 0).0.sin_cos();
        println!("{name}, {approach}: off by {error:.1e}, at 10 s {cos}, {sin}, {:?}", summary.statistics);
        let allowed = ADDED_UP * tolerance + ROUNDING;
        assert!(error < allowed, "{name}, {approach}: {error:e}");
        assert!(worst(&[cos, sin], &PUBLISHED) < allowed.max(1e-8), "{name}, {approach}: {cos} {sin}");
        assert!(summary.statistics.leaps > 10, "{summary:?}");
    }
}

#[test]
fn peaucelliers_linkage_passes_its_fold() {
    let page = model("peaucellier");
    let (code, twin) = (generated("peaucellier"), dense(&page));
    for (engine, tolerance, correction) in [
        (&twin, 1e-6, Correction::MassWeighted),
        (&twin, 1e-10, Correction::Partition),
        (&code, 1e-6, Correction::Partition),
        (&code, 1e-9, Correction::MassWeighted),
        (&code, 1e-12, Correction::Partition),
    ] {
        let approach = approach(Integrator::Dop853, tolerance, correction);
        let (samples, outcome) = run(engine, &Projecting, (&page, 0.3), &approach);
        let summary = outcome.unwrap_or_else(|failure| panic!("{approach}: {failure}"));
        for sample in &samples {
            // The end of `upper_out` draws the line at (1 - 0.4²)/0.7 m. Folded into one bar, the other way on, the two
            // would swing about.
            let [x, _, _, e0, _, _, e3] = sample.bodies[4].pose;
            let drawn = x + 0.2 * (e0 * e0 - e3 * e3);
            assert!((drawn - 1.2).abs() < 1e-6, "{approach}: at {} s the line is left: {drawn}", sample.t);
        }
        let long = |sample: &Sample| coordinate(sample, 1).0 - coordinate(sample, 2).0;
        let ends = [&samples[0], samples.last().expect("it has samples")].map(long);
        println!("Peaucellier, {approach}: long bars {ends:?} apart, {:?}", summary.statistics);
        // It has folded and opened the other way round.
        assert!(ends[0] > 0.6 && ends[1] < -0.1 && summary.statistics.leaps > 0, "{ends:?}");
        assert!(summary.energy_drift < 1e3 * tolerance + ROUNDING, "{:e}", summary.energy_drift);
    }
}
