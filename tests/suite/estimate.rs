//! What `simulate --verify` says of a run's error is held against the error.
#![allow(clippy::print_stdout, reason = "the measured figures, for runs with --nocapture")]

use gyro_reference::{JointRow, scene};
use gyro_runner::{
    Approach, Coordinates, Integrator, JointSample, Sample, Settings, Start, companions, differences,
};
use gyro_sim_suite::{
    Duals, EXTREME, Engine, duals, extreme, generated, model, moved, rotation, shelves, start_of,
};

/// How far a joint coordinate or its rate is off, and how large it is, both at worst.
#[derive(Clone, Copy, Debug, Default)]
pub struct Deviation {
    pub error: f64,
    pub size: f64,
}

impl Deviation {
    fn add(&mut self, error: f64, size: f64) {
        // What is no number stays.
        self.error = if error <= self.error || self.error.is_nan() { self.error } else { error };
        self.size = self.size.max(size);
    }
}

/// Of each joint coordinate over a run: of positions, then of rates. Orientations differ by an angle.
pub fn deviations(samples: &[Sample], rows: &[JointRow]) -> [Vec<Deviation>; 2] {
    let n = samples.first().map_or(0, |sample| sample.coordinates.len());
    let mut worst = [vec![Deviation::default(); n], vec![Deviation::default(); n]];
    for (sample, row) in samples.iter().zip(rows) {
        let mut scalars = row.positions.iter().zip(&row.rates);
        let mut orientations = row.orientations.iter();
        let [positions, rates] = &mut worst;
        for (joint, (position, rate)) in sample.coordinates.iter().zip(positions.iter_mut().zip(rates)) {
            match *joint {
                JointSample::Angle { position: x, rate: v }
                | JointSample::Length { position: x, rate: v } => {
                    let (expected, slope) = scalars.next().expect("a reference has all joints");
                    position.add((x - expected).abs(), expected.abs());
                    rate.add((v - slope).abs(), slope.abs());
                }
                JointSample::Orientation { position: p, rate: w } => {
                    let expected = orientations.next().expect("a reference has all joints");
                    let (found, is) = (rotation(p).concat(), expected.rotation.concat());
                    position.add(distance(&found, &is) / std::f64::consts::SQRT_2, 0.0);
                    let slope = expected.angular_velocity;
                    rate.add(distance(&w, &slope), distance(&slope, &[0.0; 3]));
                }
            }
        }
    }
    worst
}

fn distance(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}

/// The reference of a page at the times of samples.
pub fn expected(page: &str, settings: &Settings) -> Vec<JointRow> {
    let n = (settings.t_end / settings.sample_every).round() as u32;
    let times: Vec<f64> = (0..=n).map(|k| f64::from(k) * settings.sample_every).collect();
    scene(page).unwrap_or_else(|| panic!("{page} has no reference")).solve(&times)
}

/// The estimate of each coordinate's error as the command line makes it: by the first companion that comes to its end. `run`
/// makes companions.
pub fn estimate(
    samples: &[Sample],
    settings: &Settings,
    approach: &Approach,
    mut run: impl FnMut(&Settings, &Approach) -> Option<Vec<Sample>>,
) -> Option<Vec<f64>> {
    let companions = companions(settings, approach, false);
    let other = companions.iter().find_map(|(settings, approach)| run(settings, approach))?;
    Some(differences(samples, &other))
}
