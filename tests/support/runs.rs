//! Runs of a mechanism from its model's start, by the loop that the command line uses.

use gyro_model::Model;
use gyro_runner::{Event, JointSample, Sample, Settings, Start, Summary, run};
use gyro_sim::Partition;

/// The paper's settings for one second, section 7.
pub const PAPER: Settings =
    Settings { t_end: 1.0, step: 1e-4, correct_every: Some(5e-4), sample_every: 0.01 };

/// What a run gave.
#[derive(Clone, Debug)]
pub struct Run {
    /// The samples, the start first.
    pub samples: Vec<Sample>,
    /// The worst of all samples.
    pub summary: Summary,
}

impl Run {
    /// The sample at a time.
    ///
    /// # Panics
    /// If there is none.
    pub fn at(&self, t: f64) -> &Sample {
        let at = self.samples.partition_point(|sample| sample.t < t - 1e-9);
        self.samples
            .get(at)
            .filter(|s| (s.t - t).abs() < 1e-9)
            .unwrap_or_else(|| panic!("no sample at {t} s"))
    }

    /// The last sample.
    pub fn last(&self) -> &Sample {
        self.samples.last().expect("a run has a sample at its start")
    }
}

/// The start of a model, with all its bodies observed.
pub fn start_of(model: &Model) -> Start {
    let start = model.assemble().expect("the model has a start");
    let angles = start.joints.iter().map(|joint| match joint.position[..] {
        [angle] => angle,
        _ => 0.0,
    });
    Start {
        angles: angles.collect(),
        observed_bodies: (0..model.coordinate_bodies().len()).collect(),
        positions: start.q,
        velocities: start.v,
    }
}

/// Runs a mechanism of this model.
///
/// # Panics
/// If the run fails.
pub fn simulate<M: Partition>(mechanism: &M, model: &Model, settings: &Settings) -> Run {
    let mut samples = Vec::new();
    let summary = run(mechanism, settings, &start_of(model), |event| {
        if let Event::Sample(sample) = event {
            samples.push(sample.clone());
        }
        Ok(())
    });
    let summary = summary.unwrap_or_else(|failure| panic!("{}: {failure}", model.name));
    Run { samples, summary }
}

/// Angle and rate of a revolute joint.
///
/// # Panics
/// If the joint is of another kind.
pub fn angle(sample: &Sample, joint: usize) -> (f64, f64) {
    match sample.joints[joint] {
        JointSample::Angle { position, rate } => (position, rate),
        other => panic!("joint {joint} is not revolute: {other:?}"),
    }
}
