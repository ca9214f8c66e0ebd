//! The partition through joint coordinates against pivoting, which shares no function with it but the constraints: of
//! what the one has corrected the other finds nothing left to correct, on shipped and on random model files.

use crate::on_heap::OnHeap;
use chacha20::ChaCha8Rng;
use gyro_codegen::{Effort, Functions, Group};
use gyro_jit::Independent;
use gyro_model::Model;
use gyro_sim::pivoting::{self, Choice};
use gyro_sim::{CloseLoops, JointSpace, Mechanism, Partition, Partitioning, refer_turns, violation};
use rand::{RngExt, SeedableRng};

/// How far states drift before they are corrected.
const DRIFT: f64 = 1e-6;

/// Whether the partition of a model went through joint coordinates; panics if it is wrong.
fn check(name: &str, model: &Model, seed: u64) -> bool {
    let functions = Functions::of([Group::Kinematics, Group::Partition]);
    let mechanism = gyro_jit::compile::<f64>(model, &functions, Effort::Quick).expect("a mechanism");
    let start = mechanism.start();
    if mechanism.independent(0.0, &start) != Independent::Joints {
        return false;
    }
    let clearance = mechanism.clearance(0.0, &start).map_or(1.0, |clearance| clearance.pivot);
    if clearance < 1e-2 {
        return false;
    }
    let mut dice = ChaCha8Rng::seed_from_u64(seed);
    let n_bodies = mechanism.description().bodies.len();
    let mut y = start.clone();
    for x in y.iter_mut().take(13 * n_bodies) {
        *x += DRIFT * dice.random_range(-1.0..1.0);
    }
    refer_turns(&mechanism, 0.0, &mut y);
    let drifted = y.clone();
    let mut partitioning = Partitioning::new(&mechanism, 0.0, &y);
    partitioning.correct(&mechanism, 0.0, &mut y).unwrap_or_else(|error| panic!("{name}: {error:?}"));

    // What is corrected stays near, Euler parameters on their own side.
    let speed = largest(&start[7 * n_bodies..13 * n_bodies], &[]).max(1.0);
    let length = mechanism.size().max(1.0 / mechanism.size());
    let moved = largest(&y[..13 * n_bodies], &drifted);
    let allowed = 100.0 * DRIFT * speed * length / clearance;
    assert!(moved > 0.0 && moved < allowed, "{name}: a change of {moved:e}, over {allowed:e}");
    let mut phi = mechanism.buffers().constraints;
    mechanism.phi(0.0, &y, &mut phi);
    assert!(violation(&mechanism, &phi).value < 1e-12, "{name}");

    // Of a tree only what its joints hold has changed.
    let layout = mechanism.joint_layout();
    if layout.closure_rows.is_empty() {
        let [mut before, mut after] = [mechanism.joint_start(), mechanism.joint_start()];
        mechanism.to_joints(0.0, &drifted, &mut before);
        mechanism.to_joints(0.0, &y, &mut after);
        let n_coordinates: usize = layout.places.iter().map(|place| place.n_coordinates()).sum();
        let change = largest(&before[..n_coordinates], &after);
        // Euler parameters lose their length, to first order in the drift.
        let allowed = if layout.places.len() == n_coordinates { 1e-12 * length } else { 4.0 * DRIFT };
        assert!(change < allowed, "{name}: coordinates change by {change:e}");
    }

    // The oracle.
    let choice: Choice<OnHeap> = pivoting::independent(&mechanism, 0.0, &y);
    let mut pivoted = y.clone();
    pivoting::newton_step(&mechanism, 0.0, &choice, &mut pivoted).expect("far from singular poses");
    pivoting::solve_velocities(&mechanism, 0.0, &choice, &mut pivoted).expect("far from singular poses");
    let left = largest(&y[..13 * n_bodies], &pivoted);
    let allowed = 1e-12 * speed * length / clearance;
    assert!(left < allowed, "{name}: pivoting changes it by {left:e}, over {allowed:e}");
    true
}

fn largest(a: &[f64], b: &[f64]) -> f64 {
    let differences = a.iter().enumerate().map(|(k, x)| (x - b.get(k).unwrap_or(&0.0)).abs());
    differences.fold(0.0, f64::max)
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn pivoting_finds_nothing_left_on_shipped_models() {
    let mut n_checked = 0;
    for folder in ["../models", "../tests/models"] {
        for entry in std::fs::read_dir(folder).expect("a folder of models") {
            let path = entry.expect("a file").path();
            if path.extension().is_none_or(|extension| extension != "toml") {
                continue;
            }
            let text = std::fs::read_to_string(&path).expect("a model file");
            let mut load = |file: &str| {
                std::fs::read_to_string(path.with_file_name(file)).map_err(|error| error.to_string())
            };
            let name = path.display().to_string();
            let model = gyro_model::read_with(&name, &text, &mut load).expect("a good model file");
            n_checked += u32::from(check(&name, &model, 1));
        }
    }
    assert!(n_checked > 20, "{n_checked} models have such a partition");
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn pivoting_finds_nothing_left_on_random_models() {
    let mut n_checked = 0;
    for seed in 7000..7040 {
        let text = gyro_pages::page(seed);
        let model =
            gyro_model::read_with("page.toml", &text, &mut gyro_pages::load).expect("a correct model file");
        n_checked += u32::from(check(&format!("model file {seed}"), &model, seed));
    }
    assert!(n_checked > 20, "{n_checked} models have such a partition");
}

/// Distances of rows in joint coordinates are not those in maximal ones, but go to zero with them.
#[test]
fn both_are_clear_of_the_same_poses() {
    for name in ["four-bar", "four-bar-in-line"] {
        let text = std::fs::read_to_string(format!("../models/{name}.toml")).expect("a model file");
        let model = gyro_model::read(name, &text).expect("a good model file");
        let functions = Functions::of([Group::Kinematics, Group::Partition]);
        let linkage = gyro_jit::compile::<f64>(&model, &functions, Effort::Quick).expect("a mechanism");
        let (mut x, mut y) = (linkage.joint_start(), linkage.start());
        let mut loops = CloseLoops::new(&linkage);
        let (mut n_compared, mut least) = (0, f64::INFINITY);
        for _ in 0..60 {
            x[0] += 0.02;
            if loops.correct(&linkage, 0.0, &mut x).is_err() {
                break;
            }
            linkage.to_maximal(0.0, &x, &mut y);
            let one = linkage.clearance(0.0, &y).expect("it has a loop").pivot;
            let other = pivoting::clearance_in::<_, OnHeap>(&linkage, 0.0, &y).pivot;
            assert!(one > 0.1 * other && one < 10.0 * other, "{name}: {one:e} {other:e}");
            (n_compared, least) = (n_compared + 1, other.min(least));
        }
        assert!(n_compared > 10, "{name}: {n_compared} poses, as near as {least:e}");
    }
}
