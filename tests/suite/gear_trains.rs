//! Gear trains at random, started after up to a million radians: shafts, racks, screws, planets on carriers, motors,
//! ratios of any sign and size. Their masses are balanced, so that each keeps its rate and the motion is known.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_assembled::Dense;
use gyro_model::Model;
use gyro_runner::{Approach, Correction, Integrator, Settings};
use gyro_sim::Real;
use gyro_sim_suite::{Duals, Engine, Random, coordinate, moved, start_of};
use std::f64::consts::{PI, SQRT_2};
use std::fmt::Write as _;

/// What the fastest body turns by in a step, rad; steps to a correction, and in a run.
const TURN: f64 = 0.02;
const STEPS_PER_CORRECTION: f64 = 5.0;
const STEPS: f64 = 50.0;

/// Of Baumgarte's stabilisation, parts of the fastest rate.
const STEERING: f64 = 0.5;

/// What steps lose of a coordinate and of its rate, parts of what the fastest motion makes of it.
const LOST: f64 = 1e-6;

/// Roundings that may add up in a coordinate, and in a rate.
const ROUNDINGS: f64 = 100.0;

/// Axes with their zero directions.
const AXES: [&str; 3] = [
    "axis = [0, 0, 1]\nzero = [1, 0, 0]\n",
    "axis = [0, 1, 0]\nzero = [0, 0, 1]\n",
    "axis = [0.6, 0, 0.8]\nzero = [0, 1, 0]\n",
];

/// Where directions and ends of a shaft are.
#[derive(Clone, Copy)]
struct Shaft {
    kind: &'static str,
    axis: &'static str,
    is_carried: bool,
}

/// Angles and offsets of up to ten to the given power.
fn page_at_random(random: &mut Random, power: f64) -> String {
    let mut text = "format = 1\nname = \"train\"\n[[body]]\nname = \"frame\"\nfixed = true\n".to_owned();
    let mut shafts: Vec<Shaft> = Vec::new();
    for index in 0..2 + random.below(4) {
        let carriers = shafts.iter().enumerate().filter(|(_, s)| s.kind == "revolute" && !s.is_carried);
        let carriers: Vec<usize> = carriers.map(|(carrier, _)| carrier).collect();
        let is_carried = !carriers.is_empty() && random.below(4) == 0;
        let carrier = is_carried.then(|| carriers[random.below(carriers.len())]);
        let kinds = ["revolute", "revolute", "screw", "prismatic"];
        let shaft = match carrier {
            Some(carrier) => Shaft { is_carried, ..shafts[carrier] },
            // The first one is an angle.
            None => Shaft {
                kind: kinds[random.below(if index == 0 { 3 } else { 4 })],
                axis: AXES[random.below(3)],
                is_carried,
            },
        };
        let on = carrier.map_or("frame".to_owned(), |carrier| format!("b{carrier}"));
        let [x, y, z] = random.vector(1.0);
        let (mass, moment) = (between(random, -1.0, 1.0), between(random, -2.0, 0.0));
        let _ = write!(
            text,
            "[[body]]\nname = \"b{index}\"\nmass = {mass}\ninertia = [{moment}, {moment}, {}]\n\
             [[joint]]\nname = \"j{index}\"\nkind = \"{}\"\n{}first = {{ body = \"{on}\", point = [{x}, {y}, {z}] }}\n\
             second = {{ body = \"b{index}\" }}\n",
            1.5 * moment,
            shaft.kind,
            shaft.axis
        );
        if shaft.kind == "screw" {
            let _ = writeln!(text, "lead = {}", sign(random) * between(random, -3.0, 0.0));
        }
        match index {
            0 => first(&mut text, random, power),
            _ => coupler(&mut text, (index, random.below(index)), random, power),
        }
        shafts.push(shaft);
    }
    text
}

/// The start of the first shaft: free, or by a motor.
fn first(text: &mut String, random: &mut Random, power: f64) {
    let (angle, rate) =
        (sign(random) * between(random, -1.0, power), sign(random) * between(random, -1.0, 2.0));
    let _ = if random.below(3) == 0 {
        writeln!(
            text,
            "[[driver]]\nname = \"motor\"\njoint = \"j0\"\nmotion = {{ polynomial = [{angle}, {rate}] }}"
        )
    } else {
        writeln!(text, "angle = {angle}\nrate = {rate}")
    };
}

fn coupler(text: &mut String, (index, with): (usize, usize), random: &mut Random, power: f64) {
    let size = [1.0, SQRT_2, PI, 1.0 / 3.0, between(random, -1.0, 1.0)][random.below(5)];
    let offset = if random.below(3) == 0 { 0.0 } else { sign(random) * between(random, -1.0, power) };
    let _ = writeln!(
        text,
        "[[coupler]]\nname = \"c{index}\"\nfirst = {{ joint = \"j{with}\" }}\nsecond = {{ joint = \"j{index}\" }}\n\
         ratio = {}\noffset = {offset}",
        sign(random) * size
    );
}

fn sign(random: &mut Random) -> f64 {
    random.signed().signum()
}

/// Ten to a power between two.
fn between(random: &mut Random, low: f64, high: f64) -> f64 {
    10_f64.powf(low + (high - low) * 0.5 * (random.signed() + 1.0))
}

/// One that the dense runtime-assembled model can take (its numbers are never dual ones, which Rodas asks for).
fn approach_at_random(random: &mut Random, fastest: f64) -> Approach {
    let integrators = [Integrator::Rk4, Integrator::Tsit5, Integrator::Dop853];
    let corrections = [
        Correction::Partition,
        Correction::MassWeighted,
        Correction::Baumgarte(STEERING * fastest),
        Correction::None,
    ];
    Approach {
        integrator: integrators[random.below(integrators.len())],
        correction: corrections[random.below(corrections.len())],
        ..Approach::default()
    }
}

/// The fastest rate of a body, rad/s or, in units of the size, 1/s.
fn fastest(model: &Model) -> f64 {
    let start = start_of(model);
    let rates =
        start.velocities.iter().enumerate().map(|(k, v)| if k % 6 < 3 { v / model.size() } else { *v });
    rates.fold(0.0, |fastest, rate| fastest.max(rate.abs()))
}

/// What is wrong with a run, if anything.
fn fault<T: Real + 'static>(engine: &Engine<T>, model: &Model, approach: &Approach) -> Option<String> {
    let (start, fastest) = (start_of(model), fastest(model));
    let step = TURN / fastest;
    let t_end = STEPS * step;
    let settings =
        Settings { t_end, step, correct_every: Some(STEPS_PER_CORRECTION * step), sample_every: t_end };
    let (samples, outcome) = moved(engine, &*engine.builder(Duals::none()), (&settings, approach), &start);
    if let Err(failure) = outcome {
        return Some(failure.to_string());
    }
    let (first, last) = (&samples[0], samples.last().unwrap());
    let epsilon = T::EPSILON.to_f64();
    // A coupler's rows are met to the rounding of what they subtract, each by the next.
    let largest = start.angles.iter().fold(1.0, |largest: f64, x| largest.max(x.abs()));
    (0..start.angles.len()).find_map(|k| {
        let ((from, rate), (to, rate_after)) = (coordinate(first, k), coordinate(last, k));
        let moved = rate * t_end;
        let known = LOST * moved.abs() + ROUNDINGS * epsilon * largest;
        let known_rate = (LOST + ROUNDINGS * epsilon) * fastest.max(rate.abs());
        let is_right = (to - from - moved).abs() <= known && (rate_after - rate).abs() <= known_rate;
        (!is_right).then(|| {
            format!("coordinate {k} moves from {from} by {} for {moved}, known to {known:e}; rate {rate} -> {rate_after}", to - from)
        })
    })
}

/// Runs so many trains and lists what is wrong.
fn look(seed: u64, count: usize) -> Vec<String> {
    let mut random = Random::new(seed);
    let mut faults = Vec::new();
    for index in 0..count {
        let is_single = random.below(4) == 0;
        let text = page_at_random(&mut random, if is_single { 3.0 } else { 6.0 });
        let model =
            gyro_model::read("train.toml", &text).unwrap_or_else(|problems| panic!("{problems:?}\n{text}"));
        let approach = approach_at_random(&mut random, fastest(&model));
        let fault = if is_single {
            fault(&Engine::new(Dense::<f32>::new(&model).unwrap()), &model, &approach)
        } else {
            fault(&Engine::new(Dense::<f64>::new(&model).unwrap()), &model, &approach)
        };
        let precision = if is_single { "f32" } else { "f64" };
        faults.extend(fault.map(|words| {
            format!(
                "train {index}, {precision}, {} with {}: {words}\n{text}",
                approach.integrator, approach.correction
            )
        }));
    }
    faults
}

#[test]
fn they_turn_from_any_angle() {
    let faults = look(17, 60);
    assert!(faults.is_empty(), "{} of them do not:\n{}", faults.len(), faults.join("\n"));
}

/// `cargo test --test suite -- --ignored gear_trains --nocapture`: a few minutes.
#[test]
#[ignore = "a study"]
fn thousands_turn_from_any_angle() {
    let faults = look(1, 10_000);
    println!("{} of 10000", faults.len());
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}
