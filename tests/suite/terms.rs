//! Every term of the equations of motion of every model: what the generator derived against what the runtime-assembled
//! model has typed by hand, on random states that violate the joints.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_assembled::Careful;
use gyro_model::Model;
use gyro_sim::{Dynamics, Kinematics, Mechanism, Projection};
use gyro_sim_suite::{
    Engine, Matrix, Random, careful, dense, difference, fixture_folders, for_each_generated, is_open, model,
    phi_pi, phi_q, state,
};
use nalgebra::{DMatrix, Matrix3, Matrix6};

/// States of each shipped model, and of each model file that only tests need.
const STATES: usize = 1000;
const STATES_OF_TEST_PAGES: usize = 200;

/// No more than this over the square of the number of bodies: linear systems cost as much as its cube.
const STATES_OF_MANY_BODIES: usize = 10_000;

/// Linear systems, the dense one above all, are solved at every fifth.
const SOLVED_EVERY: usize = 5;

/// Time, s: any, for what is driven.
const T: f64 = 0.37;

/// Angular velocities, rad/s: the paper's rotor turns at 100.
const RATE: f64 = 100.0;

/// Two ways of adding up a few dozen products, relative to the largest number of a kind.
const AGREEMENT: f64 = 1e-12;

/// The same where a linear system has been solved in between.
const AGREEMENT_OF_SOLUTIONS: f64 = 1e-10;

/// Roundings by which two solutions of a mechanism with loops may differ for each unit of the condition number of its
/// rows: what a few dozen eliminations lose, and a universal joint in the tree whose axes come to be parallel. Trees
/// that stay trees lose nothing.
const ROUNDINGS: f64 = 1000.0;

/// More than this no state may lose; it is ten times what any of these states loses.
const LOST: f64 = 1e-8;

/// Trees with bodies of very different masses or inertias, and what their states may lose, ten times what is seen: near
/// gimbal lock only the lighter ones are left to take the motion up. (Runtime-assembled models lose more than generated
/// code: `cargo xtask verify --rounding`.)
const UNEVEN: [(&str, f64); 2] = [("gyroscope-heavy-rotor", 5e-7), ("gyroscope-light-rings", LOST)];

/// The largest condition number of states that are looked at: a wrong formula is off by more than is lost then.
const CONDITION: f64 = 1e8;

/// One kind of numbers of one state: they have a unit, and so a scale, in common.
struct Kind {
    name: &'static str,
    values: Vec<f64>,
    /// A scale that the values may cancel below.
    scale: f64,
    agreement: f64,
}

fn kind(name: &'static str, values: Vec<f64>) -> Kind {
    Kind { name, values, scale: 0.0, agreement: AGREEMENT }
}

/// Everything that a mechanism says of a state, kind by kind.
fn terms(mechanism: &Engine, model: &Model, values: &[f64]) -> Vec<Kind> {
    let (t, y) = (T, values.to_vec());
    let mut kinds = Vec::new();
    let mut constraints = mechanism.buffers().constraints;
    mechanism.phi(t, &y, &mut constraints);
    let n_rows = mechanism.buffers().rows.len();
    let (rows, normalisations) = constraints.split_at(n_rows);
    kinds.extend(by_unit(mechanism, ["Φ, lengths", "Φ, pure"], rows));
    // |p| = 1 to rounding: what is left is rounding, of the scale of one.
    kinds.push(Kind { scale: 1.0, ..kind("normalisations", normalisations.to_vec()) });
    let mut out = mechanism.buffers().rows;
    mechanism.nu(t, &y, &mut out);
    kinds.push(kind("ν", out.clone()));
    mechanism.gamma(t, &y, &mut out);
    kinds.extend(by_unit(mechanism, ["γ, lengths", "γ, pure"], &out));
    mechanism.velocity_residual(t, &y, &mut out);
    kinds.extend(by_unit(mechanism, ["velocity, lengths", "velocity, pure"], &out));
    kinds.extend(by_block(["Φ_r of Φ_q", "Φ_p"], 7, &phi_q(mechanism, T, &y)));
    kinds.extend(by_block(["Φ_r", "Φ_π'"], 6, &phi_pi(mechanism, T, &y)));
    let mut force = mechanism.buffers().velocities;
    mechanism.applied_force(t, &y, &mut force);
    let mut forces = halves(["f", "n' − w̃'J'w'"], 6, &force);
    // A body with equal moments has no gyroscopic torque but rounding.
    let moments = model.bodies.iter().flat_map(|body| model.values(&body.inertia));
    forces[1].scale = RATE * RATE * moments.fold(0.0, |largest: f64, x| largest.max(x.abs()));
    kinds.extend(forces);
    kinds.extend(readings_and_energy(mechanism, model, &y));
    kinds
}

/// Readings: sines and cosines, Euler parameters and rates all have values up to 2π or 2 · [`RATE`].
fn readings_and_energy(mechanism: &Engine, model: &Model, y: &Vec<f64>) -> Vec<Kind> {
    let mut readings = mechanism.buffers().readings;
    mechanism.read_joints(T, y, &mut readings);
    let energy = mechanism.energy(T, y);
    let weight: f64 = model.values(&model.gravity).map(f64::abs).iter().sum::<f64>();
    let masses = model.coordinate_bodies().into_iter().map(|body| model.value(&model.bodies[body].mass));
    vec![
        kind("readings", readings),
        kind("kinetic energy", vec![energy.kinetic]),
        Kind {
            scale: weight * masses.sum::<f64>() * mechanism.size(),
            ..kind("potential", vec![energy.potential])
        },
    ]
}

/// A random state with the condition number of its rows, which is one for trees.
fn drawn(mechanism: &Engine, model: &Model, random: &mut Random) -> (Vec<f64>, f64) {
    loop {
        let values = state(mechanism, RATE, random);
        let condition = if is_open(model) { 1.0 } else { condition(mechanism, model, &values) };
        if condition <= CONDITION {
            return (values, condition);
        }
    }
}

/// The condition number of `Φ_π' M⁻¹ Φ_π'ᵀ`, rows of lengths and pure rows scaled so that the largest element of the
/// diagonal is one.
fn condition(mechanism: &Engine, model: &Model, values: &[f64]) -> f64 {
    let rows = phi_pi(mechanism, T, &values.to_vec()).rows;
    let n_columns = 6 * mechanism.description().bodies.len();
    let jacobian = DMatrix::from_fn(rows.len(), n_columns, |row, column| rows[row][column]);
    let mut mobility = DMatrix::zeros(n_columns, n_columns);
    for (moving_body, body) in model.coordinate_bodies().into_iter().enumerate() {
        let body = &model.bodies[body];
        let ([xx, yy, zz, xy, xz, yz], mass) = (model.values(&body.inertia), model.value(&body.mass));
        let inertia = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
        let mut mass_matrix = Matrix6::identity() * mass;
        mass_matrix.fixed_view_mut::<3, 3>(3, 3).copy_from(&inertia);
        let inverse = mass_matrix.try_inverse().expect("masses and inertias are positive");
        mobility.view_mut((6 * moving_body, 6 * moving_body), (6, 6)).copy_from(&inverse);
    }
    let matrix = &jacobian * mobility * jacobian.transpose();
    let is_length = |row: usize| mechanism.description().rows[row].is_length;
    let largest = |row: usize| {
        let alike = (0..matrix.nrows()).filter(|&other| is_length(other) == is_length(row));
        alike.map(|other| matrix[(other, other)]).fold(0.0, f64::max)
    };
    let scaled = matrix.map_with_location(|i, j, x: f64| x / (largest(i) * largest(j)).sqrt());
    let eigenvalues = scaled.symmetric_eigenvalues();
    let (least, largest) = (eigenvalues.min(), eigenvalues.max());
    if least > 0.0 { largest / least } else { f64::INFINITY }
}

/// What follows from eq. (17).
fn solutions(mechanism: &Engine, model: &Model, values: &[f64]) -> Vec<Kind> {
    let y = &values.to_vec();
    let (mut accelerations, mut lambda) = (mechanism.acceleration_buffer(), mechanism.buffers().rows);
    mechanism.accelerations(T, y, &mut accelerations);
    mechanism.multipliers(T, y, &accelerations, &mut lambda);
    let n_velocities = 6 * mechanism.description().bodies.len();
    let mut kinds = halves(["s̈", "ẇ'"], 6, &accelerations[..n_velocities]);
    kinds.extend(by_unit(mechanism, ["λ, forces", "λ, torques"], &lambda));
    kinds.extend(projections(mechanism, y));
    let mut dy = mechanism.start();
    mechanism.derivative(T, y, &mut dy);
    let (q_dot, rest) = dy.split_at(7 * mechanism.description().bodies.len());
    let (v_dot, others) = rest.split_at(n_velocities);
    let (power, turns) = others.split_at(usize::from(model.has_work()));
    kinds.extend(halves(["ṙ", "ṗ"], 7, q_dot));
    kinds.extend(halves(["s̈ of ẏ", "ẇ' of ẏ"], 6, v_dot));
    kinds.push(kind("power", power.to_vec()));
    kinds.push(kind("rates of turn references", turns.to_vec()));
    kinds.extend(outputs(mechanism, y));
    kinds.into_iter().map(|kind| Kind { agreement: AGREEMENT_OF_SOLUTIONS, ..kind }).collect()
}

/// The least motions that change lengths, and pure rows, by numbers anyhow. A displacement is as inexact as the
/// rotations at an arm of the mechanism's size, and the other way round.
fn projections(mechanism: &Engine, y: &Vec<f64>) -> Vec<Kind> {
    let of_rows = |names: [&'static str; 2], is_length: bool| {
        let (mut rows, mut motion) = (mechanism.buffers().rows, mechanism.buffers().velocities);
        for (row, change) in rows.iter_mut().enumerate() {
            *change =
                if mechanism.description().rows[row].is_length == is_length { y[row % y.len()] } else { 0.0 };
        }
        mechanism.project(T, y, &rows, &mut motion);
        let mut kinds = halves(names, 6, &motion);
        let largest = |kind: &Kind| kind.values.iter().fold(0.0, |largest: f64, x| largest.max(x.abs()));
        let scale = largest(&kinds[0]).max(mechanism.size() * largest(&kinds[1]));
        (kinds[0].scale, kinds[1].scale) = (scale, scale / mechanism.size());
        kinds
    };
    let lengths = of_rows(["δr for lengths", "δπ' for lengths"], true);
    lengths.into_iter().chain(of_rows(["δr", "δπ'"], false)).collect()
}

/// Each output by itself, numbers of one unit together. A torque is as inexact as the forces at an arm of the
/// mechanism's size.
fn outputs(mechanism: &Engine, y: &Vec<f64>) -> Vec<Kind> {
    let mut out = mechanism.buffers().outputs;
    mechanism.outputs(T, y, &mut out);
    let unit = |index: usize| {
        (mechanism.description().outputs[index].name, mechanism.description().outputs[index].unit)
    };
    let places: Vec<usize> = (0..mechanism.description().outputs.len()).collect();
    let groups = places.chunk_by(|&a, &b| unit(a) == unit(b));
    let of_group = |group: &[usize]| {
        let forces = places.iter().filter(|&&k| unit(k) == (unit(group[0]).0, "N")).map(|&k| out[k].abs());
        let is_torque = unit(group[0]).1 == "N*m";
        let scale = if is_torque { mechanism.size() * forces.fold(0.0, f64::max) } else { 0.0 };
        Kind { scale, ..kind("outputs", group.iter().map(|&k| out[k]).collect()) }
    };
    groups.map(of_group).collect()
}

/// Rows apart by what they measure.
fn by_unit(mechanism: &Engine, names: [&'static str; 2], rows: &[f64]) -> Vec<Kind> {
    let of = |is_length: bool| {
        let rows = rows
            .iter()
            .enumerate()
            .filter(|(row, _)| mechanism.description().rows[*row].is_length == is_length);
        rows.map(|(_, value)| *value).collect()
    };
    vec![kind(names[0], of(true)), kind(names[1], of(false))]
}

/// Of each body's `stride` numbers the first three, and the rest.
fn halves(names: [&'static str; 2], stride: usize, values: &[f64]) -> Vec<Kind> {
    let of = |range: std::ops::Range<usize>| {
        values.chunks_exact(stride).flat_map(|body| body[range.clone()].to_vec()).collect()
    };
    vec![kind(names[0], of(0..3)), kind(names[1], of(3..stride))]
}

/// Of each row of a Jacobian the columns of positions, and those of orientations.
fn by_block(names: [&'static str; 2], stride: usize, matrix: &Matrix) -> Vec<Kind> {
    matrix.rows.iter().flat_map(|row| halves(names, stride, row)).collect()
}

/// The worst differences seen, kind by kind, and whether any value differed at all.
#[derive(Default)]
struct Worst {
    /// Name, difference and what is allowed.
    kinds: Vec<(&'static str, f64, f64)>,
    differ: bool,
}

impl Worst {
    /// Compares one state; `what` says which. Solutions may differ by `lost` more.
    fn compare(&mut self, (what, lost): (&str, f64), generated: &[Kind], twin: &[Kind]) {
        assert_eq!(generated.len(), twin.len(), "{what}");
        for (a, b) in generated.iter().zip(twin) {
            let error = difference(&a.values, &b.values, a.scale);
            let lost = if a.agreement == AGREEMENT_OF_SOLUTIONS { lost } else { 0.0 };
            assert!(
                error <= a.agreement.max(lost),
                "{what}: {} differs by {error:e}:\n{:?}\n{:?}",
                a.name,
                a.values,
                b.values
            );
            self.differ |= error > 0.0;
            match self.kinds.iter_mut().find(|(name, ..)| *name == a.name) {
                Some((_, worst, _)) => *worst = worst.max(error),
                None => self.kinds.push((a.name, error, a.agreement)),
            }
        }
    }

    /// The worst of what is only added up, and of what is solved for.
    fn summary(&self) -> String {
        let worst = |agreement: f64| {
            let kinds = self.kinds.iter().filter(|(_, _, of)| *of == agreement);
            kinds
                .map(|(name, error, _)| (*error, *name))
                .fold((0.0, "none"), |a, b| if b.0 > a.0 { b } else { a })
        };
        let (terms, solutions) = (worst(AGREEMENT), worst(AGREEMENT_OF_SOLUTIONS));
        format!("{} to {:.1e}, {} to {:.1e}", terms.1, terms.0, solutions.1, solutions.0)
    }
}

/// Compares with both forms of the runtime-assembled model.
fn compare(page: &str, mechanism: &Engine) {
    let model = model(page);
    let careful = Careful::<f64>::supports(&model).ok().map(|()| careful(&model));
    let dense = dense(&model);
    let (mut random, mut to_careful, mut to_dense) = (Random::new(7), Worst::default(), Worst::default());
    let mut most_lost = 0.0_f64;
    let is_shipped = fixture_folders()[0].pages().iter().any(|shipped| shipped == page);
    let n_states = if is_shipped { STATES } else { STATES_OF_TEST_PAGES };
    let n_bodies = model.coordinate_bodies().len();
    for index in 0..n_states.min(STATES_OF_MANY_BODIES / (n_bodies * n_bodies)) {
        let (values, condition) = drawn(mechanism, &model, &mut random);
        let uneven = UNEVEN.iter().find(|(uneven, _)| *uneven == page);
        let lost = uneven.map_or((ROUNDINGS * f64::EPSILON * condition).min(LOST), |(_, lost)| *lost);
        let what = format!("{page}, state {index}: {values:?}");
        let state = (what.as_str(), lost);
        most_lost = most_lost.max(lost);
        let all = |mechanism: &Engine| {
            let mut kinds = terms(mechanism, &model, &values);
            if index % SOLVED_EVERY == 0 {
                kinds.extend(solutions(mechanism, &model, &values));
            }
            kinds
        };
        let generated = all(mechanism);
        if let Some(careful) = &careful {
            to_careful.compare(state, &generated, &all(careful));
        }
        to_dense.compare(state, &generated, &all(&dense));
    }
    let summaries = (to_careful.summary(), to_dense.summary());
    println!("{page}: {}; dense: {}; allowed {most_lost:.0e}", summaries.0, summaries.1);
    let differ = to_dense.differ && (careful.is_none() || to_careful.differ);
    assert!(differ, "{page}: bit for bit the same: one is compared with itself");
}

#[test]
fn generated_terms_of_shipped_pages_agree_with_the_twins() {
    all_agree(0);
}

#[test]
fn generated_terms_of_test_pages_agree_with_the_twins() {
    all_agree(1);
}

/// All model files of a folder.
fn all_agree(folder: usize) {
    let (mut failed, pages) = (Vec::new(), fixture_folders()[folder].pages());
    for_each_generated(|page, mechanism| {
        if !pages.iter().any(|own| own == page) {
            return;
        }
        let agrees = std::panic::AssertUnwindSafe(|| compare(page, mechanism));
        if std::panic::catch_unwind(agrees).is_err() {
            failed.push(page.to_owned());
        }
    });
    assert!(failed.is_empty(), "these do not agree: {failed:?}");
}

#[test]
fn a_wrong_offset_is_noticed() {
    // The check must be able to fail: the runtime-assembled model's rotor is a hundredth of a nanometre off.
    let text = gyro_sim_suite::page("gyroscope").replace("0.000125", "0.00012500001");
    let (right, wrong) = (model("gyroscope"), gyro_model::read("wrong.toml", &text).unwrap());
    let (a, b) = (careful(&right), careful(&wrong));
    let values = state(&a, RATE, &mut Random::new(7));
    let kinds = |mechanism: &Engine| {
        let mut kinds = terms(mechanism, &right, &values);
        kinds.extend(solutions(mechanism, &right, &values));
        kinds
    };
    let (a, b) = (kinds(&a), kinds(&b));
    let is_off = |(a, b): (&Kind, &Kind)| difference(&a.values, &b.values, a.scale) > 10.0 * a.agreement;
    let off: Vec<&str> = a.iter().zip(&b).filter(|(a, b)| is_off((a, b))).map(|(a, _)| a.name).collect();
    for name in ["Φ_p", "Φ_π'", "velocity, lengths", "s̈"] {
        assert!(off.contains(&name), "{name} is not among {off:?}");
    }
}
