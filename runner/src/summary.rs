//! How good a run was.

use crate::Sample;
use crate::companion::rate;
use crate::kink::Stay;
use gyro_sim::Statistics;
use nanoserde::{DeBin, SerBin};

/// The figures of a whole run.
#[derive(Clone, Copy, Debug, Default, PartialEq, SerBin, DeBin)]
pub struct Summary {
    /// Steps of the integrator.
    pub steps: u64,
    /// How often independent coordinates were chosen anew, counted joint by joint.
    pub chart_switches: u64,
    /// Worst position violation of all samples.
    pub position_violation: f64,
    /// Worst velocity violation of all samples, 1/s.
    pub velocity_violation: f64,
    /// Worst `|pᵀp − 1|` of all samples.
    pub norm_violation: f64,
    /// Worst `|E − E₀ − work|` of all samples over the largest kinetic energy or change of potential energy of any, or
    /// over what they would be if the fastest coordinate were as fast as the tolerance.
    pub energy_drift: f64,
    /// Seconds spent stepping and correcting, without samples and their output.
    pub run_time_s: f64,
    /// How often a kink of a law has been crossed.
    pub kinks_crossed: u64,
    /// The first kink that the motion has stayed at, under error control.
    pub stay: Option<Stay>,
    /// What the steps have cost and met.
    pub statistics: Statistics,
    /// The smallest pivot of the constraint Jacobian at any sample; `None` if it was not requested, or the engine does
    /// not tell.
    pub smallest_pivot: Option<f64>,
}

/// Follows violations and energy from sample to sample.
#[derive(Clone, Debug, Default)]
pub struct Tracker {
    first: Option<Sample>,
    position_violation: f64,
    velocity_violation: f64,
    norm_violation: f64,
    energy_error: f64,
    energy_scale: f64,
    /// The largest rate of any coordinate, rad/s or m/s.
    fastest: f64,
    rounding: f64,
}

/// An energy of so many roundings is none.
const ROUNDINGS: f64 = 1e3;

impl Tracker {
    /// Takes the next sample into account; `rounding` is what rounding makes of the energies that are in play there, J.
    pub fn add(&mut self, sample: &Sample, rounding: f64) {
        let first = self.first.get_or_insert_with(|| sample.clone());
        let error = energy_error(first, sample).abs();
        let scale = sample.kinetic.max((sample.potential - first.potential).abs());
        self.position_violation = self.position_violation.max(sample.position_violation);
        self.velocity_violation = self.velocity_violation.max(sample.velocity_violation);
        self.norm_violation = self.norm_violation.max(sample.norm_violation);
        self.energy_error = self.energy_error.max(error);
        self.energy_scale = self.energy_scale.max(scale);
        let rates = sample.coordinates.iter().map(|joint| norm(&rate(joint)));
        let speeds = sample.bodies.iter().map(|body| norm(&body.velocity));
        self.fastest = rates.chain(speeds).fold(self.fastest, f64::max);
        self.rounding = self.rounding.max(rounding);
    }

    /// Writes what was seen into a summary. What is slower than `rest`, rad/s or m/s, may rest as well: the energy that
    /// is held against its error is then that of a motion as fast as this.
    pub fn finish(&self, summary: &mut Summary, rest: f64) {
        summary.position_violation = self.position_violation;
        summary.velocity_violation = self.velocity_violation;
        summary.norm_violation = self.norm_violation;
        // Where nothing moves, what rounding makes of that is not a drift, and neither is 0/0.
        let floor = ROUNDINGS * self.rounding;
        summary.energy_drift = if self.energy_error <= floor && self.energy_scale <= floor {
            0.0
        } else {
            // Energy goes with the square of the rates.
            let slower = if self.fastest > 0.0 { (rest / self.fastest).max(1.0).powi(2) } else { 1.0 };
            self.energy_error / (self.energy_scale * slower).max(floor)
        };
    }
}

fn norm(vector: &[f64]) -> f64 {
    vector.iter().map(|x| x * x).sum::<f64>().sqrt()
}

/// `E − E₀ − work` since the first sample, J. Kinetic and potential parts are subtracted apart, so that a large
/// potential does not drown the difference.
pub fn energy_error(first: &Sample, sample: &Sample) -> f64 {
    (sample.kinetic - first.kinetic) + (sample.potential - first.potential) - (sample.work - first.work)
}

#[cfg(test)]
mod tests;
