//! Companion runs: what a run is compared with to estimate its error.

use crate::{Approach, Coordinates, Integrator, JointSample, Sample, Settings};

/// The finest tolerance that double precision can resolve in every element.
const FINEST: f64 = 2e-15;

/// Steps that a companion may take before another one is tried.
const PATIENCE: u64 = 2_000_000;

/// Runs to compare with, the best first, in double precision all of them: joint coordinates under error control, which only trees have and
/// where inputs are constant; else the same by finer means.
pub fn companions(settings: &Settings, approach: &Approach, inputs_vary: bool) -> Vec<(Settings, Approach)> {
    let mut companions = Vec::new();
    if !inputs_vary {
        let aim = approach.tolerance.unwrap_or(1e-9).min(1e-9) / 100.0;
        let joint = |integrator, tolerance| Approach {
            integrator,
            tolerance: Some(tolerance),
            coordinates: Coordinates::Joint,
            budget: Some(PATIENCE),
            ..Approach::default()
        };
        companions.push((*settings, joint(Integrator::Dop853, aim.clamp(FINEST, 1e-12))));
        companions.push((*settings, joint(Integrator::Rodas4, aim.clamp(1e-12, 1e-9))));
    }
    let finer = match approach.tolerance {
        Some(tolerance) => {
            (*settings, Approach { tolerance: Some((tolerance / 100.0).max(FINEST)), ..*approach })
        }
        None => (Settings { step: settings.step / 4.0, ..*settings }, *approach),
    };
    companions.push(finer);
    companions
}

/// The largest difference of each coordinate's positions over all samples of two runs; of orientations the angle between them.
pub fn differences(samples: &[Sample], others: &[Sample]) -> Vec<f64> {
    let mut worst = vec![0.0; samples.first().map_or(0, |sample| sample.coordinates.len())];
    for (sample, other) in samples.iter().zip(others) {
        for ((worst, one), other) in worst.iter_mut().zip(&sample.coordinates).zip(&other.coordinates) {
            let distance = distance(one, other);
            // What is no number stays.
            *worst = if distance <= *worst || f64::is_nan(*worst) { *worst } else { distance };
        }
    }
    worst
}

fn distance(one: &JointSample, other: &JointSample) -> f64 {
    match (one, other) {
        (JointSample::Angle { position: a, .. }, JointSample::Angle { position: b, .. })
        | (JointSample::Length { position: a, .. }, JointSample::Length { position: b, .. }) => (a - b).abs(),
        (JointSample::Orientation { position: a, .. }, JointSample::Orientation { position: b, .. }) => {
            // p and −p are one orientation.
            let gap = |sign: f64| a.iter().zip(b).map(|(a, b)| (a - sign * b).powi(2)).sum::<f64>().sqrt();
            2.0 * gap(1.0).min(gap(-1.0))
        }
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn orientations_differ_by_an_angle_whatever_their_sign() {
        let turned = |angle: f64, sign: f64| JointSample::Orientation {
            position: [sign * (angle / 2.0).cos(), sign * (angle / 2.0).sin(), 0.0, 0.0],
            rate: [0.0; 3],
        };
        for sign in [1.0, -1.0] {
            let found = distance(&turned(0.3, 1.0), &turned(0.3 + 1e-6, sign));
            assert!((found - 1e-6).abs() < 1e-11, "{found}");
        }
    }
}
