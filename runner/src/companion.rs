//! Companion runs: what a run is compared with to estimate its error.

use crate::{Approach, Coordinates, Correction, Integrator, JointSample, Sample, Settings, When};

/// The finest tolerance that double precision can resolve in every element.
const FINEST: f64 = 2e-15;

/// Steps that a companion may take before another one is tried.
const PATIENCE: u64 = 2_000_000;

/// Runs to compare with, the best first, in double precision all of them: joint coordinates under error control, where
/// there are any; else the same by finer means, and with a correction where the run has none or its own comes to no
/// end.
pub fn companions(settings: &Settings, approach: &Approach) -> Vec<(Settings, Approach)> {
    let aim = approach.tolerance.unwrap_or(1e-9).min(1e-9) / 100.0;
    let joint = |integrator, tolerance| Approach {
        integrator,
        tolerance: Some(tolerance),
        coordinates: Coordinates::Joint,
        budget: Some(PATIENCE),
        ..Approach::default()
    };
    let mut companions = vec![
        (*settings, joint(Integrator::Dop853, aim.clamp(FINEST, 1e-12))),
        (*settings, joint(Integrator::Rodas4, aim.clamp(1e-12, 1e-9))),
    ];
    let finer = match approach.tolerance {
        Some(tolerance) => {
            // A run's own budget is none for a finer one.
            let tolerance = Some((tolerance / 100.0).max(FINEST));
            (*settings, Approach { tolerance, budget: Some(PATIENCE), ..*approach })
        }
        None => (
            Settings { step: settings.step / 4.0, ..*settings },
            Approach { budget: None, patience: None, meets_knots: true, ..*approach },
        ),
    };
    let corrected = |correction| {
        let when = Some(When::Steps(1));
        (finer.0, Approach { coordinates: Coordinates::Maximal, correction, when, ..finer.1 })
    };
    let is_corrected = !matches!(approach.correction, Correction::None | Correction::Baumgarte(_));
    // What drifts off the constraints may leave a singular pose in another way than it came, however fine it is.
    companions.extend(is_corrected.then_some(finer));
    companions.extend([Correction::Partition, Correction::MassWeighted].map(corrected));
    companions.extend((!is_corrected).then_some(finer));
    companions
}

/// A companion has so many samples at least, and so many times those of the run while these are not too many: what
/// comes back at each sample of the run is seen to move between them.
const LOOKS: f64 = 1024.0;
const OFTEN: f64 = 13.0;
const MANY: f64 = 100_000.0;

/// A companion's settings with more samples, among them those of the run: the size of a motion is taken from them. So
/// many times as many that it is a prime: a motion with a period that fits into the interval of the run's samples is
/// rarely seen at one phase again. Steps of fixed length are hardly shortened.
pub fn closely(settings: &Settings, approach: &Approach) -> Settings {
    let Settings { t_end, step, sample_every, .. } = *settings;
    let n = (t_end / sample_every).max(1.0);
    let wanted = prime((LOOKS / n).max(OFTEN.min(MANY / n)));
    let most = if approach.tolerance.is_none() { (sample_every / step).floor() } else { LOOKS };
    Settings { sample_every: sample_every / wanted.min(most).max(1.0), ..*settings }
}

/// The least prime, or one, that is no less; of numbers up to a few thousand.
fn prime(least: f64) -> f64 {
    let divides = |number: f64, by: u32| number % f64::from(by) == 0.0;
    let is_prime = |number: f64| (2..64).all(|by| f64::from(by) >= number || !divides(number, by));
    let mut number = least.ceil();
    while !is_prime(number) {
        number += 1.0;
    }
    number
}

/// How far two runs differ in one joint coordinate, at worst over all samples.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Difference {
    /// Of positions; of orientations the angle between them.
    pub position: f64,
    /// Of rates.
    pub rate: f64,
    /// The largest position and the largest rate of the second run; zero the position where it is an orientation.
    pub largest: [f64; 2],
}

impl Difference {
    /// In units of this tolerance, relative and absolute alike, the larger one of position and rate.
    pub fn in_tolerances(&self, tolerance: f64) -> f64 {
        let [position, rate] = self.largest.map(|size| tolerance * (1.0 + size));
        larger(self.position / position, self.rate / rate)
    }
}

/// The differences of all joint coordinates of two runs with the same samples.
pub fn differences(samples: &[Sample], others: &[Sample]) -> Vec<Difference> {
    let mut worst = vec![Difference::default(); samples.first().map_or(0, |sample| sample.coordinates.len())];
    for (sample, other) in samples.iter().zip(others) {
        for ((worst, one), other) in worst.iter_mut().zip(&sample.coordinates).zip(&other.coordinates) {
            worst.position = larger(worst.position, distance(one, other));
            let [rate, other_rate] = [one, other].map(rate);
            worst.rate = larger(worst.rate, gap(&rate, &other_rate));
            let largest = [size(other), gap(&other_rate, &[0.0; 3])];
            worst.largest = core::array::from_fn(|k| larger(worst.largest[k], largest[k]));
        }
    }
    worst
}

/// What is not a number stays.
fn larger(worst: f64, x: f64) -> f64 {
    if x <= worst || worst.is_nan() { worst } else { x }
}

pub(crate) fn gap(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

pub(crate) fn rate(joint: &JointSample) -> [f64; 3] {
    match *joint {
        JointSample::Angle { rate, .. } | JointSample::Length { rate, .. } => [rate, 0.0, 0.0],
        JointSample::Orientation { rate, .. } => rate,
    }
}

pub(crate) fn size(joint: &JointSample) -> f64 {
    match joint {
        JointSample::Angle { position, .. } | JointSample::Length { position, .. } => position.abs(),
        JointSample::Orientation { .. } => 0.0,
    }
}

/// How far a coordinate has gone from its start: of an orientation the angle.
pub(crate) fn departure(start: &JointSample, joint: &JointSample) -> f64 {
    distance(start, joint)
}

pub(crate) fn distance(one: &JointSample, other: &JointSample) -> f64 {
    match (one, other) {
        (JointSample::Angle { position: a, .. }, JointSample::Angle { position: b, .. })
        | (JointSample::Length { position: a, .. }, JointSample::Length { position: b, .. }) => (a - b).abs(),
        (JointSample::Orientation { position: a, .. }, JointSample::Orientation { position: b, .. }) => {
            // p and −p are one orientation.
            let opposite = b.map(|component| -component);
            2.0 * gap(a, b).min(gap(a, &opposite))
        }
        _ => f64::NAN,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_of_any_length_are_looked_at_closely() {
        for t_end in [1e-300, 1e-20, 0.049, 0.05, 1.0, 1e6] {
            let settings = Settings { t_end, step: 1e-3, correct_every: None, sample_every: 0.05 };
            for tolerance in [None, Some(1e-9)] {
                let approach = Approach { tolerance, ..Approach::default() };
                let parts = settings.sample_every / closely(&settings, &approach).sample_every;
                assert!(parts >= 1.0 && (parts - parts.round()).abs() < 1e-9, "{t_end} {tolerance:?}");
            }
        }
    }

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
