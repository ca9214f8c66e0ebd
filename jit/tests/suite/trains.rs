//! Gear trains at random, under gravity: the partition, which takes angles from their turn references, against joint
//! coordinates at a fine tolerance and against pivoting, which reads them off the poses.

use crate::on_heap::OnHeap;
use chacha20::ChaCha8Rng;
use gyro_codegen::{Effort, Functions};
use gyro_sim::pivoting::{self, Choice};
use gyro_sim::{
    Control, Corrected, Dop853, Joint, JointSpace, Mechanism, Partitioned, Rk4, Solver, keep_turns,
    refer_turns,
};
use rand::{RngExt, SeedableRng};
use std::f64::consts::TAU;
use std::fmt::Write as _;

const T_END: f64 = 0.5;
const STEP: f64 = 1e-3;
const STEPS_PER_CORRECTION: u32 = 5;

/// Axes with their zero directions.
const AXES: [&str; 3] = [
    "axis = [0, 0, 1]\nzero = [1, 0, 0]\n",
    "axis = [0, 1, 0]\nzero = [0, 0, 1]\n",
    "axis = [0.6, 0, 0.8]\nzero = [0, 1, 0]\n",
];

/// Shafts, racks and screws, some on others, most of them geared to one before them.
fn page(dice: &mut ChaCha8Rng) -> String {
    let mut text =
        "format = 1\nname = \"train\"\ngravity = [0.3, -1, -9.81]\n[[body]]\nname = \"frame\"\nfixed = true\n"
            .to_owned();
    let mut kinds: Vec<&str> = Vec::new();
    for index in 0..dice.random_range(2..6) {
        let any = if index == 0 { 3 } else { 4 };
        let kind = ["revolute", "revolute", "screw", "prismatic"][dice.random_range(0..any)];
        let shafts: Vec<usize> = (0..index).filter(|&k| kinds[k] == "revolute").collect();
        let on = if !shafts.is_empty() && dice.random_range(0..3) == 0 {
            format!("b{}", shafts[dice.random_range(0..shafts.len())])
        } else {
            "frame".to_owned()
        };
        let mut near = || dice.random_range(-0.05..0.05);
        let places: [f64; 5] = std::array::from_fn(|_| near());
        let [x, y, z, own_x, own_y] = places;
        let (mass, inertia) = (power(dice, -1.0, 1.0).abs(), power(dice, -2.0, 0.0).abs());
        let axis = AXES[dice.random_range(0..AXES.len())];
        let _ = write!(
            text,
            "[[body]]\nname = \"b{index}\"\nmass = {mass}\ninertia = [{inertia}, {}, {}]\n[[joint]]\n\
             name = \"j{index}\"\nkind = \"{kind}\"\n{axis}first = {{ body = \"{on}\", point = [{x}, {y}, {z}] }}\n\
             second = {{ body = \"b{index}\", point = [{own_x}, {own_y}, 0] }}\n",
            1.1 * inertia,
            1.3 * inertia,
        );
        if kind == "screw" {
            let _ = writeln!(text, "lead = {}", power(dice, -2.5, -0.5));
        }
        let is_sliding = kind == "prismatic";
        if index == 0 || dice.random_range(0..4) == 0 {
            let (place, largest) = if is_sliding { ("displacement", 0.0) } else { ("angle", 2.0) };
            let (at, rate) = (power(dice, -1.0, largest), power(dice, -1.0, 1.0));
            let _ = writeln!(text, "{place} = {at}\nrate = {rate}");
        } else {
            let with = dice.random_range(0..index);
            let unit = match (kinds[with] == "prismatic", is_sliding) {
                (false, true) => 0.02,
                (true, false) => 20.0,
                _ => 1.0,
            };
            let (ratio, offset) = (unit * power(dice, -0.7, 0.7), dice.random_range(-3.0..3.0));
            let _ = writeln!(
                text,
                "[[coupler]]\nname = \"c{index}\"\nfirst = {{ joint = \"j{with}\" }}\n\
                 second = {{ joint = \"j{index}\" }}\nratio = {ratio}\noffset = {offset}"
            );
        }
        kinds.push(kind);
    }
    text
}

/// Ten to a power between two, of either sign.
fn power(dice: &mut ChaCha8Rng, low: f64, high: f64) -> f64 {
    let size = 10f64.powf(dice.random_range(low..=high));
    if dice.random_range(0..2) == 0 { size } else { -size }
}

/// The largest difference of coordinates and rates, relative to those beyond one.
fn difference(found: &[f64], expected: &[f64]) -> f64 {
    let of = |(a, b): (&f64, &f64)| (a - b).abs() / b.abs().max(1.0);
    found.iter().zip(expected).map(of).fold(0.0, f64::max)
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn trains_are_as_exact_as_by_pivoting() {
    let mut n_far_better = 0;
    for seed in 0..24 {
        let mut dice = ChaCha8Rng::seed_from_u64(seed);
        let text = page(&mut dice);
        let model = gyro_model::read("train.toml", &text).unwrap_or_else(|e| panic!("{seed}: {e:?}\n{text}"));
        let train = gyro_jit::compile::<f64>(&model, &Functions::all(), Effort::Quick).expect("a mechanism");

        let start = train.joint_start();
        let fine = Control::default().with_tolerance(1e-12);
        let mut exact = Solver::new(Joint, Dop853::new(&start), 0.0, &start).with_control(fine);
        exact.advance_to(&train, T_END).unwrap_or_else(|e| panic!("{seed}: {e:?}\n{text}"));
        let n_numbers = train.joint_layout().n_coordinates() + train.joint_layout().n_rates();
        let off = |y: &Vec<f64>| {
            let mut x = exact.state().clone();
            train.to_joints(T_END, y, &mut x);
            difference(&x[..n_numbers], exact.state())
        };

        let mut y = train.start();
        let mut solver = Partitioned::new(&train, &y);
        let mut pivoted = y.clone();
        let mut choice: Choice<OnHeap> = pivoting::independent(&train, 0.0, &pivoted);
        let mut rk4 = Rk4::new(&pivoted);
        let interval = STEP * f64::from(STEPS_PER_CORRECTION);
        for k in 0..(T_END / interval).round() as u32 {
            let t = f64::from(k) * interval;
            solver.advance(&train, t, STEP, STEPS_PER_CORRECTION, &mut y).unwrap();
            for step in 0..STEPS_PER_CORRECTION {
                rk4.step(&Corrected, &train, t + f64::from(step) * STEP, STEP, &mut pivoted);
            }
            let end = t + interval;
            pivoting::follow(&train, end, &pivoted, &mut choice);
            (0..2).for_each(|_| pivoting::newton_step(&train, end, &choice, &mut pivoted).unwrap());
            pivoting::solve_velocities(&train, end, &choice, &mut pivoted).unwrap();
            refer_turns(&train, end, &mut pivoted);
        }
        let (ours, theirs) = (off(&y), off(&pivoted));
        assert!(
            ours < 1e-6 && ours < 1e-11 + 3.0 * theirs,
            "{seed}: {ours:e}, by pivoting {theirs:e}\n{text}"
        );
        n_far_better += u32::from(theirs > 1e-10 && theirs > 100.0 * ours);
    }
    assert!(n_far_better > 1, "{n_far_better}");
}

/// Between corrections references stay what integration makes of them, as long as no turn is in danger.
#[test]
fn references_that_stray_far_are_brought_back() {
    let text = std::fs::read_to_string("../tests/models/gear-pair.toml").unwrap();
    let model = gyro_model::read("gear-pair", &text).unwrap();
    let train = gyro_jit::compile::<f64>(&model, &Functions::all(), Effort::Quick).expect("a mechanism");
    let start = train.start();
    let [first, second] = [start.len() - 2, start.len() - 1];
    for turns in [-3.0, 0.0, 1e4] {
        let mut y = start.clone();
        let angle = start[first] + turns * TAU;
        (y[first], y[second]) = (angle + 1.5, start[second] - 1.6);
        keep_turns(&train, 0.0, &mut y);
        assert_eq!(y[first], angle + 1.5, "less than a quarter of a turn");
        assert!((y[second] - start[second]).abs() < 1e-14, "more: {} {}", y[second], start[second]);
        assert_eq!(y[..first], start[..first]);
    }
}
