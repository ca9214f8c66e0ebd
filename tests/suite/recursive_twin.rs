//! The recursive form of the runtime-assembled model against its dense form, in every model file that it does.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_assembled::{Dense, Recursive};
use gyro_model::{JointKind, Model, Support, Tree};
use gyro_sim::{Dynamics, Mechanism, Partition};
use gyro_sim_suite::{Random, difference, is_open, model, pages, posed, state_at};

const STATES: usize = 100;

/// Time, s: any, for what is driven.
const T: f64 = 0.37;

/// Rates, rad/s.
const RATE: f64 = 10.0;

/// Relative to the largest number of a kind; both solve linear systems.
const AGREEMENT: f64 = 1e-10;

/// Rounding of positions and velocities, relative to the largest of each row's terms.
const CORRECTED: f64 = 1e-13;

/// How far states are moved off the constraints before a correction.
const VIOLATION: f64 = 1e-4;

/// Random states that meet all constraints at [`T`].
fn consistent(model: &Model, random: &mut Random) -> Vec<f64> {
    let posed = posed(model, RATE, random);
    let start = posed.assemble().expect("any pose of a tree of joints can be assembled");
    let mut y = state_at(&posed, &start);
    let twin = Recursive::<f64>::new(model).expect("it is supported");
    // What is driven has moved on since the start.
    correct(&twin, &mut y);
    y
}

fn correct(twin: &Recursive<f64>, y: &mut Vec<f64>) {
    twin.newton_step(T, &(), y).expect("joint coordinates can be told");
    twin.solve_velocities(T, &(), y).expect("velocities follow");
}

fn supported() -> impl Iterator<Item = (String, Model)> {
    let pages = pages().into_iter().map(|page| (page.clone(), model(&page)));
    pages.filter(|(_, model)| Recursive::<f64>::supports(model).is_ok())
}

#[test]
fn trees_are_supported_and_nothing_else() {
    for page in pages() {
        let model = model(&page);
        let is_tree = is_open(&model) && model.redundant.is_empty() && Tree::of(&model).is_open();
        assert_eq!(Recursive::<f64>::supports(&model).is_ok(), is_tree, "{page}");
    }
    let kinds: Vec<JointKind> = supported().flat_map(|(_, m)| m.joints).map(|joint| joint.kind).collect();
    for kind in [
        JointKind::Revolute,
        JointKind::Spherical,
        JointKind::Fixed,
        JointKind::Universal,
        JointKind::Cylindrical,
        JointKind::Prismatic,
        JointKind::Planar,
        JointKind::Screw,
        JointKind::PointOnLine,
    ] {
        assert!(kinds.contains(&kind), "no model file has {kind:?}");
    }
    let supports: Vec<Support> = supported().flat_map(|(_, m)| m.bodies).map(|body| body.support).collect();
    for support in [Support::Free, Support::Constrained, Support::Fixed, Support::Driven] {
        assert!(supports.contains(&support), "no model file has {support:?}");
    }
}

#[test]
fn accelerations_and_multipliers_are_those_of_the_dense_form() {
    let mut largest = 0.0_f64;
    for (page, model) in supported() {
        let turned_round = reversed(&model);
        for (what, model) in [("as it is", &model), ("joints turned round", &turned_round)] {
            let worst = compare(model, &format!("{page}, {what}"));
            println!("{page}, {what}: {worst:.1e}");
            largest = largest.max(worst);
        }
    }
    assert!(largest > 0.0, "bit for bit the same: one is compared with itself");
}

/// The same joints with their ends exchanged: other mechanisms, as the first body of a joint is the one that leads, but
/// trees too.
fn reversed(model: &Model) -> Model {
    let mut model = model.clone();
    for joint in &mut model.joints {
        std::mem::swap(&mut joint.first, &mut joint.second);
    }
    model
}

/// The worst difference of s̈, ẇ' and λ.
fn compare(model: &Model, what: &str) -> f64 {
    let recursive = Recursive::<f64>::new(model).expect("it is supported");
    let dense = Dense::<f64>::new(model).expect("it does every model");
    let (mut random, mut worst) = (Random::new(7), 0.0_f64);
    for _ in 0..STATES {
        let y = consistent(model, &mut random);
        let (a, b) = (solution(&recursive, &y), solution(&dense, &y));
        for ((a, b), scale) in a.iter().zip(&b).zip(scales(&dense, &y, &b)) {
            let error = difference(a, b, scale);
            assert!(error <= AGREEMENT, "{what}: {error:e} at {y:?}:\n{a:?}\n{b:?}");
            worst = worst.max(error);
        }
    }
    worst
}

/// s̈, ẇ', λ of lengths, λ of angles, and the derivative's.
fn solution<M: Dynamics<Scalar = f64, State = Vec<f64>>>(twin: &M, y: &Vec<f64>) -> [Vec<f64>; 5] {
    let (mut out, mut lambda, mut dy) = (twin.acceleration_buffer(), twin.buffers().rows, twin.start());
    twin.accelerations(T, y, &mut out);
    twin.multipliers(T, y, &out, &mut lambda);
    twin.derivative(T, y, &mut dy);
    let of_bodies = |range: std::ops::Range<usize>| {
        let bodies = out.as_ref().chunks_exact(6).take(twin.description().bodies.len());
        bodies.flat_map(|body| body[range.clone()].to_vec()).collect::<Vec<_>>()
    };
    let of_rows = |is_length: bool| {
        let rows = lambda.as_ref().iter().enumerate();
        rows.filter(|(row, _)| twin.description().rows[*row].is_length == is_length)
            .map(|(_, x)| *x)
            .collect()
    };
    [
        of_bodies(0..3),
        of_bodies(3..6),
        of_rows(true),
        of_rows(false),
        dy[7 * twin.description().bodies.len()..].to_vec(),
    ]
}

/// What each kind of the solution may cancel below: products of rates, the same at an arm of the mechanism's size, and
/// the largest force at such an arm.
fn scales(twin: &Dense<f64>, y: &[f64], solution: &[Vec<f64>; 5]) -> [f64; 5] {
    let largest = |values: &[f64]| values.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
    let velocities = &y[7 * twin.description().bodies.len()..13 * twin.description().bodies.len()];
    let rate = velocities.chunks_exact(6).map(|body| largest(&body[3..])).fold(0.0, f64::max);
    let (turning, size) = (rate * rate, twin.size());
    [size * turning, turning, 0.0, size * largest(&solution[2]), turning]
}

#[test]
fn corrections_meet_the_constraints_and_keep_what_meets_them() {
    for (page, model) in supported() {
        let (twin, mut random) = (Recursive::<f64>::new(&model).expect("it is supported"), Random::new(11));
        for _ in 0..STATES {
            let y = consistent(&model, &mut random);
            assert!(violation(&twin, &y) <= CORRECTED, "{page}: {:e}", violation(&twin, &y));
            let mut kept = y.clone();
            correct(&twin, &mut kept);
            assert!(difference(&kept, &y, 1.0) <= CORRECTED, "{page}: {:e}", difference(&kept, &y, 1.0));
            let mut moved = y.clone();
            moved[..13 * twin.description().bodies.len()]
                .iter_mut()
                .for_each(|x| *x += VIOLATION * random.signed());
            correct(&twin, &mut moved);
            assert!(violation(&twin, &moved) <= CORRECTED, "{page}: {:e}", violation(&twin, &moved));
            let far = difference(&moved, &y, 1.0);
            assert!(far <= 100.0 * VIOLATION, "{page}: moved by {far:e}");
        }
    }
}

/// The worst of Φ and of the velocity residual, over lengths and rates of the state.
fn violation(twin: &Recursive<f64>, y: &Vec<f64>) -> f64 {
    let (mut phi, mut rates) = (twin.buffers().constraints, twin.buffers().rows);
    twin.phi(T, y, &mut phi);
    twin.velocity_residual(T, y, &mut rates);
    let largest = |values: &[f64]| values.iter().fold(1.0, |largest: f64, x| largest.max(x.abs()));
    let (q, v) = y.split_at(7 * twin.description().bodies.len());
    let worst = |values: &[f64]| values.iter().fold(0.0, |worst: f64, x| worst.max(x.abs()));
    (worst(&phi) / largest(q)).max(worst(&rates) / (largest(q) * largest(v)))
}
