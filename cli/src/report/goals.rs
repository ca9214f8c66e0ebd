//! What the project has set out to reach, and what it has.

use super::best::{best, smallest_error};
use super::curve::{Point, Setting, Treatment};
use crate::args::Precision;
use crate::report::curve::Engine;
use crate::words::number;

/// A goal with the value reached; `None` where nothing was.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Goal {
    pub(crate) what: String,
    pub(crate) limit: Limit,
    pub(crate) reached: Option<f64>,
    /// By what.
    pub(crate) by: String,
    /// Whether a busy machine can miss it.
    pub(crate) is_time: bool,
}

/// What a value may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Limit {
    AtMost(f64),
    AtLeast(f64),
    /// Within so much of a value.
    Near(f64, f64),
}

impl Goal {
    pub(crate) fn is_met(&self) -> bool {
        self.reached.is_some_and(|reached| match self.limit {
            Limit::AtMost(limit) => reached <= limit,
            Limit::AtLeast(limit) => reached >= limit,
            Limit::Near(value, by) => (reached - value).abs() <= by,
        })
    }

    /// Goal, limit, value, by what, met or not.
    pub(crate) fn row(&self) -> Vec<String> {
        let limit = match self.limit {
            Limit::AtMost(limit) => format!("≤ {}", number(limit, 4)),
            Limit::AtLeast(limit) => format!("≥ {}", number(limit, 4)),
            Limit::Near(value, by) => format!("{} ± {}", number(value, 4), number(by, 2)),
        };
        let reached = self.reached.map_or("nothing".to_owned(), |reached| number(reached, 3));
        let verdict = if self.is_met() { "met" } else { "not met" };
        vec![self.what.clone(), limit, reached, self.by.clone(), verdict.to_owned()]
    }
}

/// The columns of [`Goal::row`].
pub(crate) const HEAD: [&str; 5] = ["goal", "limit", "reached", "by", ""];

/// Error, and ratio to the hand-derived second, in joint coordinates and in corrected maximal ones.
const COSTS: [(f64, f64, f64); 3] = [(1e-6, 0.08, 0.35), (1e-9, 0.20, 0.65), (1e-12, 0.45, 1.6)];

/// What `f32` is to reach at its best, in joint coordinates and in corrected maximal ones.
const SINGLE: [f64; 2] = [1e-6, 5e-6];

/// Goals of the paper's scene that the work-precision diagram decides.
pub(crate) fn of_the_paper(points: &[Point], t_end: f64) -> Vec<Goal> {
    let ours = |precision: Precision, is_joint: bool| {
        points.iter().filter(move |point| {
            let treatment = point.curve.treatment;
            let fits = if is_joint { treatment == Treatment::Joint } else { treatment.is_corrected() };
            point.curve.engine == Engine::Generated && point.curve.precision == precision && fits
        })
    };
    let mut goals = Vec::new();
    for (is_joint, coordinates) in [(true, "joint"), (false, "maximal, corrected at every step")] {
        for (target, joint, maximal) in COSTS {
            let chosen = best(ours(Precision::F64, is_joint), target);
            goals.push(Goal {
                what: format!("cost of an error of {target:e}, {coordinates}, over the hand-derived second"),
                limit: Limit::AtMost(if is_joint { joint } else { maximal }),
                reached: chosen.and_then(|point| point.outcome.as_ref().ok()).map(|outcome| outcome.ratio),
                by: chosen.map_or(String::new(), |point| described(point, t_end)),
                is_time: true,
            });
        }
    }
    for ((is_joint, coordinates), limit) in
        [(true, "joint"), (false, "maximal, corrected at every step")].into_iter().zip(SINGLE)
    {
        let reached = smallest_error(ours(Precision::F32, is_joint));
        let by = ours(Precision::F32, is_joint).find(|p| p.outcome.as_ref().ok().map(|o| o.error) == reached);
        goals.push(Goal {
            what: format!("smallest error in `f32`, {coordinates}"),
            limit: Limit::AtMost(limit),
            reached,
            by: by.map_or(String::new(), |point| described(point, t_end)),
            is_time: false,
        });
    }
    goals
}

/// Integrator, correction and setting.
pub(crate) fn described(point: &Point, t_end: f64) -> String {
    let setting = match point.setting {
        Setting::Tolerance(_) | Setting::Steps(_) => point.setting.name(t_end),
    };
    format!("{}, {}, {setting}", point.curve.integrator, point.curve.treatment.name())
}

#[cfg(test)]
mod tests;
