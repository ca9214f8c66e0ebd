//! The goals of the stiff bearing.

use super::curve::{Curve, Setting, Treatment};
use super::goals::{Goal, Limit};
use super::lab::Lab;
use super::limits::{self, Knob, Spectrum};
use crate::args::Precision;
use crate::failure::Failure;
use crate::report::curve::Engine;
use gyro_runner::{Coordinates, Integrator};

/// A model file, the steps that Rodas may take for its second, the limit of RK4 by the literature, and how much dearer
/// RK4 has to be there.
const BEARINGS: [(&str, f64, f64, Option<f64>); 2] =
    [("gyroscope-stiff", 700.0, 2.267e-4, None), ("gyroscope-overdamped", 70.0, 1.682e-5, Some(80.0))];

/// Tolerance, and error that it may come to.
const TOLERANCE: f64 = 1e-6;

/// Of limits, relative.
const NEAR: f64 = 0.05;

/// Length of the run, s.
const T_END: f64 = 1.0;

/// Time for which runs are repeated, s.
const MEASURE_FOR: f64 = 0.3;

/// The goals of a model file; of most there are none.
pub(crate) fn goals(lab: &mut Lab) -> Result<Vec<Goal>, Failure> {
    let Some((_, steps, literature, dearer)) = BEARINGS.into_iter().find(|(name, ..)| *name == lab.name)
    else {
        return Ok(Vec::new());
    };
    let own = std::mem::replace(&mut lab.t_end, T_END);
    let goals = of_bearing(lab, steps, literature, dearer);
    lab.t_end = own;
    goals
}

fn of_bearing(lab: &mut Lab, steps: f64, literature: f64, dearer: Option<f64>) -> Result<Vec<Goal>, Failure> {
    let truth = lab.truth()?;
    let rodas = Curve {
        engine: Engine::Generated,
        precision: Precision::F64,
        integrator: Integrator::Rodas4,
        treatment: Treatment::Joint,
    };
    let limits = (1_000_000, MEASURE_FOR);
    let by = format!("rodas4, joint coordinates, tolerance {TOLERANCE:e}, {T_END} s");
    let point = lab.point(&truth, &rodas, Setting::Tolerance(TOLERANCE), limits);
    let outcome = point.outcome.map_err(Failure::Run)?;
    let goal = |what: &str, limit, reached, by: &str| Goal {
        what: what.to_owned(),
        limit,
        reached,
        by: by.to_owned(),
        is_time: false,
    };
    let knob = Knob::of(&lab.model);
    let spectrum = Spectrum::new(&lab.model, knob, knob.nominal()).map_err(Failure::Run)?;
    let theory = limits::limit(Integrator::Rk4, &spectrum.eigenvalues);
    let guess = theory.unwrap_or(literature);
    let found = limits::find(lab, Integrator::Rk4, Coordinates::Joint, guess).map_err(Failure::Run)?.limit;
    let accepted = outcome.statistics.accepted as f64;
    let mut goals = vec![
        goal("steps of rodas4 for the stiff bearing", Limit::AtMost(steps), Some(accepted), &by),
        goal("error of that run, rad", Limit::AtMost(TOLERANCE), Some(outcome.error * truth.scale), &by),
        goal(
            "limit of RK4 in theory, s",
            Limit::Near(literature, NEAR * literature),
            theory,
            "|R(hλ)| = 1 at the eigenvalues about the start",
        ),
        goal(
            "limit of RK4 as runs find it, s",
            Limit::Near(guess, NEAR * guess),
            found,
            "bisection of the fixed step",
        ),
    ];
    if let (Some(factor), Some(step)) = (dearer, found) {
        // A whole number of steps, none of them longer than the limit.
        let n = (T_END / step).ceil() as u64;
        let rk4 = Curve { integrator: Integrator::Rk4, ..rodas };
        let point = lab.point(&truth, &rk4, Setting::Steps(n), limits);
        let reached = point.outcome.map(|rk4| rk4.ratio / outcome.ratio).ok();
        let by = format!("rk4 at its largest stable step, {n} steps, over rodas4");
        let dearer = goal("how much dearer RK4 is", Limit::AtLeast(factor), reached, &by);
        goals.push(Goal { is_time: true, ..dearer });
    }
    Ok(goals)
}
