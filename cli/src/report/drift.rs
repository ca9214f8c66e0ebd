//! Long runs at the model file's own settings: what each correction keeps of constraints, energy and motion.

use super::curve::Treatment;
use super::lab::{Lab, Plan};
use super::truth::{INTERVALS, Truth};
use crate::args::Precision;
use crate::report::curve::Engine;
use gyro_runner::{Approach, Coordinates, Correction, Integrator, Settings, energy_error};

/// A long run.
#[derive(Clone, Debug)]
pub(crate) struct Drift {
    pub(crate) treatment: Treatment,
    pub(crate) outcome: Result<Course, String>,
}

/// Quantities over time.
#[derive(Clone, Debug, Default)]
pub(crate) struct Course {
    pub(crate) times: Vec<f64>,
    pub(crate) violations: Vec<f64>,
    /// |E − E₀ − work| over the largest energy that moves.
    pub(crate) energy: Vec<f64>,
    /// Errors of each coordinate at the end, where there is a reference solution.
    pub(crate) errors: Option<Vec<f64>>,
    pub(crate) seconds: f64,
}

/// RK4 by the model file's step and interval of corrections.
pub(crate) fn drift(lab: &mut Lab, treatment: Treatment, t_end: f64, truth: Option<&Truth>) -> Drift {
    let page = &lab.model.simulation;
    let (coordinates, correction) = match treatment {
        Treatment::Joint => (Coordinates::Joint, Correction::None),
        Treatment::Maximal(correction) => (Coordinates::Maximal, correction),
    };
    let approach = Approach { integrator: Integrator::Rk4, coordinates, correction, ..Approach::default() };
    let settings = Settings {
        t_end,
        step: page.step,
        correct_every: Some(page.correct_every),
        sample_every: t_end / INTERVALS as f64,
    };
    let run = lab.run((Engine::Generated, Precision::F64), &Plan { settings, approach, measure_for: None });
    let outcome = run.map(|run| {
        let first = &run.samples[0];
        let moved = |s: &gyro_runner::Sample| s.kinetic.max((s.potential - first.potential).abs());
        let scale = run.samples.iter().map(moved).fold(0.0, f64::max);
        let scale = if scale > 0.0 { scale } else { 1.0 };
        let later = || run.samples.iter().skip(1);
        Course {
            times: later().map(|s| s.t).collect(),
            violations: later().map(|s| s.position_violation).collect(),
            energy: later().map(|s| energy_error(first, s).abs() / scale).collect(),
            errors: truth.map(|truth| truth.errors(&run.samples[run.samples.len() - 1..], t_end)),
            seconds: run.summary.run_time_s,
        }
    });
    Drift { treatment, outcome }
}
