//! Models, states and dense linear algebra in `f64`.

use crate::atoms::Elementary;
use crate::point::Point;
use crate::textbook::{Evaluation, Sparse, Textbook};
use chacha20::ChaCha8Rng;
use gyro_model::Model;
use rand::{RngExt, SeedableRng};
use std::path::Path;

const ALL_JOINTS: &str = "../tests/models/all-joints.toml";
const ARMATURE: &str = "../tests/models/armature.toml";
const RAFT: &str = "src/textbook/tests/raft.toml";

/// States of each model.
const STATES: u64 = 4;

/// Shipped model files whose numbers leave nothing of difference quotients and absolute residuals in `f64`: rates of
/// 1e5 rad/s, a mass ratio of 1e12, a base at 20 Hz, torques of 1e3 N·m on bodies of 1e-6 kg·m². Their textbook is that
/// of the other gyroscopes.
const BEYOND_DIFFERENCES: [&str; 5] = [
    "gyroscope-fast",
    "gyroscope-heavy-rotor",
    "gyroscope-overdamped",
    "gyroscope-rolling-base",
    "gyroscope-stiff",
];

/// All models of the folder `models/` but those, one of every kind of joint, one with armatures, and one of what
/// they lack.
pub fn models() -> Vec<Model> {
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let entries = std::fs::read_dir(here.join("../models")).expect("the folder of models");
    let pages = entries.map(|entry| entry.expect("an entry").path());
    let pages = pages.filter(|path| path.extension().is_some_and(|extension| extension == "toml"));
    let pages =
        pages.filter(|path| !BEYOND_DIFFERENCES.iter().any(|name| path.file_stem() == Some(name.as_ref())));
    let mut pages: Vec<_> = pages.chain([ALL_JOINTS, ARMATURE, RAFT].map(|page| here.join(page))).collect();
    pages.sort();
    pages.iter().map(|path| read(path)).collect()
}

/// A model file of what the shipped models lack.
pub fn raft() -> Model {
    read(&Path::new(env!("CARGO_MANIFEST_DIR")).join(RAFT))
}

fn read(path: &Path) -> Model {
    let page = std::fs::read_to_string(path).expect("a model file");
    let mut table =
        |name: &str| std::fs::read_to_string(path.with_file_name(name)).map_err(|error| error.to_string());
    gyro_model::read_with(&path.display().to_string(), &page, &mut table)
        .unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

/// Calls `check` with some states of each model at which only |p| = 1 holds.
pub fn for_each_state(mut check: impl FnMut(&str, &Textbook, &Point<f64>)) {
    for model in models() {
        let textbook = Textbook::new(&model);
        for seed in 0..STATES {
            check(&format!("{} seed {seed}", model.name), &textbook, &random_point(&textbook, seed));
        }
    }
}

/// Calls `check` with some states of each model on the constraints.
pub fn for_each_motion(mut check: impl FnMut(&str, &Textbook, &Point<f64>)) {
    for model in models() {
        let textbook = Textbook::new(&model);
        for seed in 0..STATES {
            let mut point = random_point(&textbook, seed);
            project(&textbook, &mut point);
            check(&format!("{} seed {seed}", model.name), &textbook, &point);
        }
    }
}

pub fn at<'a>(textbook: &'a Textbook, point: &'a Point<f64>) -> Evaluation<'a, f64> {
    textbook.at(point, &Elementary).expect("axes have lengths")
}

/// The start, moved at random: off the constraints but for |p| = 1.
pub fn random_point(textbook: &Textbook, seed: u64) -> Point<f64> {
    let model = textbook.model;
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut signed = |size: f64| size * random.random_range(-1.0..1.0);
    let start = model.assemble().expect("a start");
    let (n, size) = (textbook.moving_bodies.len(), model.size());
    let mut state = [start.q.clone(), start.v.clone()].concat();
    for moving_body in 0..n {
        state[7 * moving_body..7 * moving_body + 3].iter_mut().for_each(|r| *r += signed(0.1 * size));
        state[7 * moving_body + 3..7 * moving_body + 7].iter_mut().for_each(|e| *e += signed(0.1));
        let velocities = &mut state[7 * n + 6 * moving_body..7 * n + 6 * moving_body + 6];
        velocities[..3].iter_mut().for_each(|s| *s += signed(size));
        velocities[3..].iter_mut().for_each(|w| *w += signed(1.0));
    }
    normalise(&mut state, n);
    state.extend(model.has_work().then_some(0.0));
    state.extend(start.states.iter().map(|state| state + signed(0.1)));
    let turns = textbook.turns.iter().map(|turn| start.joints[turn.joint].position[turn.coordinate]);
    state.extend(turns.map(|turn| turn + signed(0.1)));
    let values =
        |named: &[gyro_model::Parameter]| named.iter().map(|p| gyro_model::to_f64(&p.value)).collect();
    let (parameters, inputs) = (values(&model.parameters), values(&model.inputs));
    Point { context: (), t: signed(0.05).abs(), state, parameters, inputs }
}

pub fn normalise(state: &mut [f64], n_bodies: usize) {
    for moving_body in 0..n_bodies {
        let p = &mut state[7 * moving_body + 3..7 * moving_body + 7];
        let length = p.iter().map(|e| e * e).sum::<f64>().sqrt();
        p.iter_mut().for_each(|e| *e /= length);
    }
}

/// Moves a point to the nearest that satisfies Φ = 0 and Φ_r s + Φ_π' w' = ν: Newton steps of least length.
fn project(textbook: &Textbook, point: &mut Point<f64>) {
    let n = textbook.moving_bodies.len();
    for _ in 0..20 {
        let (phi, phi_q) = (at(textbook, point).phi().expect("Φ"), at(textbook, point).phi_q().expect("Φ_q"));
        least_change(&dense(&phi_q), &phi).iter().zip(&mut point.state).for_each(|(change, q)| *q -= change);
    }
    let worst = at(textbook, point).phi().expect("Φ").iter().fold(0.0, |worst, row| row.abs().max(worst));
    assert!(worst < 1e-13, "{}: Newton ends at {worst:e}", textbook.model.name);
    normalise(&mut point.state, n);
    let evaluation = at(textbook, point);
    let (residual, phi_pi) =
        (evaluation.velocity_residual().expect("residual"), evaluation.phi_pi().expect("Φ_π'"));
    let change = least_change(&dense(&phi_pi), &residual);
    change.iter().zip(&mut point.state[7 * n..]).for_each(|(change, v)| *v -= change);
}

/// A matrix by rows, its zeros written out.
pub fn dense(matrix: &Sparse<f64>) -> Vec<Vec<f64>> {
    let entry = |row: usize, column: usize| matrix.rows[row].get(&column).copied().unwrap_or(0.0);
    let row = |row| (0..matrix.n_columns).map(|column| entry(row, column)).collect();
    (0..matrix.rows.len()).map(row).collect()
}

/// The shortest x of `a x = b`.
fn least_change(a: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    let square = a.iter().map(|row| a.iter().map(|other| dot(row, other)).collect()).collect();
    let weights = solve(square, b);
    let n_columns = a.first().map_or(0, Vec::len);
    (0..n_columns).map(|k| a.iter().zip(&weights).map(|(row, weight)| row[k] * weight).sum()).collect()
}

/// Accelerations and multipliers: eq. (17) solved densely.
pub fn accelerations(textbook: &Textbook, point: &Point<f64>) -> (Vec<f64>, Vec<f64>) {
    let evaluation = at(textbook, point);
    let (mass, phi_pi) = (dense(&evaluation.mass_matrix()), dense(&evaluation.phi_pi().expect("Φ_π'")));
    let (n, rows) = (mass.len(), phi_pi.len());
    let mut matrix = vec![vec![0.0; n + rows]; n + rows];
    for (row, values) in mass.iter().enumerate() {
        matrix[row][..n].copy_from_slice(values);
    }
    for (row, values) in phi_pi.iter().enumerate() {
        matrix[n + row][..n].copy_from_slice(values);
        values.iter().enumerate().for_each(|(column, value)| matrix[column][n + row] = *value);
    }
    let right = [evaluation.applied_force().expect("forces"), evaluation.gamma().expect("γ")].concat();
    let mut solution = solve(matrix, &right);
    let lambda = solution.split_off(n);
    (solution, lambda)
}

/// Elimination with partial pivoting, the solution improved once.
fn solve(matrix: Vec<Vec<f64>>, right: &[f64]) -> Vec<f64> {
    let first = eliminate(matrix.clone(), right);
    let rest: Vec<f64> = matrix.iter().zip(right).map(|(row, b)| b - dot(row, &first)).collect();
    let change = eliminate(matrix, &rest);
    first.iter().zip(change).map(|(x, change)| x + change).collect()
}

fn eliminate(mut matrix: Vec<Vec<f64>>, right: &[f64]) -> Vec<f64> {
    let mut x = right.to_vec();
    let n = x.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| matrix[i][k].abs().total_cmp(&matrix[j][k].abs())).expect("a row");
        matrix.swap(k, pivot);
        x.swap(k, pivot);
        let lead = matrix[k].clone();
        for row in k + 1..n {
            let factor = matrix[row][k] / lead[k];
            matrix[row].iter_mut().zip(&lead).for_each(|(a, b)| *a -= factor * b);
            x[row] -= factor * x[k];
        }
    }
    for k in (0..n).rev() {
        let known: f64 = (k + 1..n).map(|j| matrix[k][j] * x[j]).sum();
        x[k] = (x[k] - known) / matrix[k][k];
    }
    x
}

pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The derivative at zero by central differences of fourth order.
pub fn derivative(step: f64, f: impl Fn(f64) -> Vec<f64>) -> Vec<f64> {
    let quotient = |step: f64| -> Vec<f64> {
        f(step).iter().zip(f(-step)).map(|(plus, minus)| (plus - minus) / (2.0 * step)).collect()
    };
    quotient(step).iter().zip(quotient(2.0 * step)).map(|(near, far)| (4.0 * near - far) / 3.0).collect()
}

/// The point a time later on the way that the point's own motion takes, to second order.
pub fn later(textbook: &Textbook, point: &Point<f64>, accelerations: &[f64], dt: f64) -> Point<f64> {
    let evaluation = at(textbook, point);
    let n = textbook.moving_bodies.len();
    let rates = [evaluation.position_rates(), accelerations.to_vec()].concat();
    let mut later = point.clone();
    later.state.iter_mut().zip(&rates).for_each(|(y, rate)| *y += dt * rate);
    let others = evaluation.other_rates().expect("rates");
    let first = point.state.len() - others.len();
    later.state[first..].iter_mut().zip(others).for_each(|(other, rate)| *other += dt * rate);
    normalise(&mut later.state, n);
    later.t += dt;
    later
}

/// Fails unless the numbers agree to a tolerance relative to the largest of them, or to 1.
pub fn assert_close(what: &str, a: &[f64], b: &[f64], tolerance: f64) {
    assert_eq!(a.len(), b.len(), "{what}: lengths");
    let size = a.iter().chain(b).fold(1.0_f64, |size, x| size.max(x.abs()));
    for (k, (a, b)) in a.iter().zip(b).enumerate() {
        assert!((a - b).abs() <= tolerance * size, "{what} [{k}]: {a} and {b} of {size}");
    }
}
