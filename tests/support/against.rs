//! Runs against solutions from elsewhere.

use crate::{Run, coordinate};
use gyro_reference::BodyState;
use gyro_runner::{BodySample, Sample};

/// Times of the samples, s.
pub fn times(run: &Run) -> Vec<f64> {
    run.samples.iter().map(|sample| sample.t).collect()
}

/// Compares lists of numbers, given what each sample shows and what it should, by its index and itself, and prints the
/// largest difference.
///
/// # Panics
/// If any number differs by more than is allowed.
#[allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]
pub fn check(what: &str, run: &Run, allowed: f64, compared: impl Fn(usize, &Sample) -> (Vec<f64>, Vec<f64>)) {
    let errors = run.samples.iter().enumerate().map(|(k, sample)| {
        let (found, expected) = compared(k, sample);
        let error = worst(&found, &expected);
        assert!(error <= allowed, "{what} at {} s: off by {error:e}:\n{found:?}\n{expected:?}", sample.t);
        error
    });
    println!("{what}: off by {:.1e}, {allowed:.0e} allowed", errors.fold(0.0, f64::max));
}

/// Compares positions and rates of the first coordinates.
///
/// # Panics
/// If any differs by more than is allowed.
pub fn check_pairs(what: &str, run: &Run, allowed: f64, expected: impl Fn(usize) -> Vec<(f64, f64)>) {
    let flat = |pairs: &[(f64, f64)]| pairs.iter().flat_map(|&(x, rate)| [x, rate]).collect();
    check(what, run, allowed, |k, sample| {
        let expected = expected(k);
        let found: Vec<_> = (0..expected.len()).map(|index| coordinate(sample, index)).collect();
        (flat(&found), flat(&expected))
    });
}

/// Value and first derivative of three derivatives.
pub fn pair([x, rate, _]: [f64; 3]) -> (f64, f64) {
    (x, rate)
}

/// Position, rotation matrix, velocity and angular velocity in one list.
pub fn body(sample: &BodySample) -> Vec<f64> {
    let [x, y, z, p @ ..] = sample.pose;
    [vec![x, y, z], rotation(p).concat(), sample.velocity.to_vec()].concat()
}

/// The same of a reference solution.
pub fn reference_body(state: &BodyState) -> Vec<f64> {
    let velocities = [state.velocity, state.angular_velocity].concat();
    [state.position.to_vec(), state.rotation.concat(), velocities].concat()
}

/// Components of a force and a torque along three axes.
pub fn along(frame: [[f64; 3]; 3], force: [f64; 3], torque: [f64; 3]) -> [f64; 6] {
    let dot = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let parts = [force, torque].map(|v| frame.map(|axis| dot(axis, v)));
    std::array::from_fn(|k| parts[k / 3][k % 3])
}

/// Vector product.
pub fn cross([a, b, c]: [f64; 3], [x, y, z]: [f64; 3]) -> [f64; 3] {
    [b * z - c * y, c * x - a * z, a * y - b * x]
}

/// A(p) by rows, paper eq. (3).
pub fn rotation([e0, e1, e2, e3]: [f64; 4]) -> [[f64; 3]; 3] {
    let diagonal = |e: f64| 2.0 * (e0 * e0 + e * e) - 1.0;
    [
        [diagonal(e1), 2.0 * (e1 * e2 - e0 * e3), 2.0 * (e1 * e3 + e0 * e2)],
        [2.0 * (e1 * e2 + e0 * e3), diagonal(e2), 2.0 * (e2 * e3 - e0 * e1)],
        [2.0 * (e1 * e3 - e0 * e2), 2.0 * (e2 * e3 + e0 * e1), diagonal(e3)],
    ]
}

/// The largest difference of numbers from what they should be; NaN if any is.
///
/// # Panics
/// If they are not as many.
pub fn worst(found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len(), "{found:?} {expected:?}");
    let largest = |a: f64, b: f64| if a > b || a.is_nan() { a } else { b };
    found.iter().zip(expected).map(|(a, b)| (a - b).abs()).fold(0.0, largest)
}
