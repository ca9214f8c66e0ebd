//! All that is measured of a scene.

use super::curve::{Curve, Point, Setting, Treatment};
use super::drift::{Drift, drift};
#[cfg(feature = "jit")]
use super::engines::{Engines, engines};
use super::explore;
use super::goals::{self, Goal, Limit};
use super::lab::Lab;
use super::limits::Knob;
use super::order::{self, Order};
use super::smooth::{self, Smooth};
use super::stability::{self, Map};
use super::stiff;
use super::truth::Truth;
use crate::args::Precision;
use crate::failure::Failure;
use crate::progress::Count;
use crate::report::curve::Engine;
use gyro_runner::{Correction, Integrator};
use std::path::Path;
use std::time::Instant;

/// How much is measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Effort {
    /// Work-precision runs of the paper's scene, and of other scenes.
    runs: [explore::Effort; 2],
    /// The longest long run, as a multiple of the model file's own length.
    long: f64,
    /// Values of the stability map per decade.
    per_decade: u32,
    /// Whether goals that take long runs are judged.
    is_full: bool,
}

impl Effort {
    pub(crate) const FULL: Self = Self {
        runs: [explore::Effort::FINE, explore::Effort::COARSE],
        long: 100.0,
        per_decade: 2,
        is_full: true,
    };

    pub(crate) const QUICK: Self =
        Self { runs: [explore::Effort::SPARSE; 2], long: 2.0, per_decade: 1, is_full: false };
}

/// A scene and what was measured of it.
#[derive(Debug)]
pub(crate) struct Study {
    pub(crate) lab: Lab,
    pub(crate) truth: Truth,
    pub(crate) points: Vec<Point>,
    pub(crate) orders: Vec<(Integrator, Treatment, Option<Order>)>,
    pub(crate) drifts: Vec<Drift>,
    /// Length of the long runs, s.
    pub(crate) long: f64,
    pub(crate) knob: Knob,
    pub(crate) maps: Vec<Map>,
    /// What could not be determined about stability, as messages.
    pub(crate) troubles: Vec<String>,
    pub(crate) goals: Vec<Goal>,
    /// Of models with contacts: runs with smooth kinds in their place.
    pub(crate) smooth: Option<Smooth>,
    /// rustc beside the engine that needs no compiler.
    #[cfg(feature = "jit")]
    pub(crate) engines: Result<Engines, String>,
    /// Seconds that all this has taken.
    pub(crate) took: f64,
    pub(crate) is_full: bool,
}

/// The model file whose goals are the paper's.
pub(crate) const PAPER: &str = "gyroscope";

/// The α error after a hundred seconds at the paper's step, by the correction.
const KEPT: [(Correction, f64); 2] = [(Correction::MassWeighted, 5e-11), (Correction::Partition, 5e-9)];

/// Seconds of that run.
const LONG_RUN: f64 = 100.0;

/// What a solution for a long run may take, s.
const PATIENCE: f64 = 60.0;

/// Steps of a long run at most: of a tree, and of what is partitioned by pivoting, which is dear.
const MOST_STEPS: [f64; 2] = [2e6, 3e5];

impl Study {
    pub(crate) fn new(
        path: &Path,
        assembled: &Path,
        effort: &Effort,
        progress: &mut Count,
    ) -> Result<Self, Failure> {
        let began = Instant::now();
        let mut lab = Lab::new(path, assembled)?;
        let is_paper = lab.name == PAPER;
        progress.begin(&format!("{}: reference solution", lab.name), 1);
        let truth_began = Instant::now();
        let truth = lab.truth()?;
        let truth_took = truth_began.elapsed().as_secs_f64();
        let points = points(&mut lab, &truth, effort.runs[usize::from(!is_paper)], progress);
        let orders = orders(&lab, &points);
        let (long, drifts) = long_runs(&mut lab, effort, truth_took, progress)?;
        let knob = Knob::of(&lab.model);
        progress.begin(&format!("{}: stability", lab.name), 1);
        let (maps, troubles) = match lab.touches() {
            true => (Vec::new(), Vec::new()),
            false => stability::maps(&lab, knob, effort.per_decade)?,
        };
        progress.begin(&format!("{}: smooth kinds", lab.name), 1);
        let smooth = smooth::smooth(&mut lab, &truth, effort.runs[usize::from(!is_paper)].measure_for)?;
        let mut goals = Vec::new();
        if is_paper {
            goals.extend(goals::of_the_paper(&points, lab.t_end));
        }
        if is_paper && effort.is_full {
            goals.extend(kept(&drifts, long));
            goals.extend(of_orders(&orders));
        }
        if effort.is_full {
            progress.begin(&format!("{}: goals", lab.name), 1);
            goals.extend(stiff::goals(&mut lab)?);
        }
        #[cfg(feature = "jit")]
        let engines = {
            progress.begin(&format!("{}: engines", lab.name), 1);
            engines(&mut lab)?
        };
        let took = began.elapsed().as_secs_f64();
        let is_full = effort.is_full;
        Ok(Self {
            lab,
            truth,
            points,
            orders,
            drifts,
            long,
            knob,
            maps,
            troubles,
            goals,
            smooth,
            #[cfg(feature = "jit")]
            engines,
            took,
            is_full,
        })
    }

    pub(crate) fn is_relative(&self) -> bool {
        self.truth.scale != 1.0
    }
}

/// All runs of the diagrams. What a run may take is measured by the cheapest good one, as scenes differ in length.
fn points(lab: &mut Lab, truth: &Truth, effort: explore::Effort, progress: &mut Count) -> Vec<Point> {
    let curves = explore::curves(lab);
    progress.begin(&format!("{}: runs", lab.name), curves.len() as u64);
    let probe = Curve { integrator: Integrator::Dop853, ..curves[0] };
    let cheap = lab.point(truth, &probe, Setting::Tolerance(1e-6), (1_000_000, effort.measure_for));
    let seconds = cheap.outcome.map_or(0.0, |outcome| outcome.seconds);
    let longest_run = (4.0 * seconds).clamp(effort.longest_run, 6.0 * effort.longest_run);
    let effort = explore::Effort { longest_run, ..effort };
    let mut points = Vec::new();
    for curve in &curves {
        points.extend(explore::explore(lab, truth, curve, &effort));
        progress.advance(1, &curve.name());
    }
    even_out(&mut points);
    points
}

/// Takes out what the machine's speed has varied by in the meantime.
fn even_out(points: &mut [Point]) {
    let outcomes = || points.iter().filter_map(|point| point.outcome.as_ref().ok());
    let mut yardsticks: Vec<f64> = outcomes().map(|outcome| outcome.measured / outcome.ratio).collect();
    yardsticks.sort_by(f64::total_cmp);
    let Some(&yardstick) = yardsticks.get(yardsticks.len() / 2) else { return };
    for outcome in points.iter_mut().filter_map(|point| point.outcome.as_mut().ok()) {
        outcome.seconds = outcome.ratio * yardstick;
    }
}

/// Orders in `f64`, where every step ends on the constraints or there are none.
fn orders(lab: &Lab, points: &[Point]) -> Vec<(Integrator, Treatment, Option<Order>)> {
    let mut orders = Vec::new();
    for treatment in explore::treatments(lab) {
        if treatment != Treatment::Joint && !treatment.is_corrected() {
            continue;
        }
        for &integrator in Integrator::ALL {
            let curve = Curve { engine: Engine::Generated, precision: Precision::F64, integrator, treatment };
            let error = |point: &Point| match (point.setting, &point.outcome) {
                (Setting::Steps(n), Ok(outcome)) => Some((lab.t_end / n as f64, outcome.error)),
                _ => None,
            };
            let errors: Vec<_> =
                points.iter().filter(|point| point.curve == curve).filter_map(error).collect();
            orders.push((integrator, treatment, order::fit(&errors)));
        }
    }
    orders
}

/// Long runs by all treatments, and their length.
fn long_runs(
    lab: &mut Lab,
    effort: &Effort,
    truth_took: f64,
    progress: &mut Count,
) -> Result<(f64, Vec<Drift>), Failure> {
    let treatments = explore::treatments(lab);
    progress.begin(&format!("{}: long runs", lab.name), treatments.len() as u64);
    let most = MOST_STEPS[usize::from(!lab.has_joint_coordinates())] * lab.model.simulation.step;
    let long = (effort.long * lab.t_end).min(most).max(lab.t_end);
    let own = std::mem::replace(&mut lab.t_end, long);
    let truth = match gyro_reference::scene(&lab.name) {
        Some(_) if truth_took * long / own <= PATIENCE => {
            lab.truth().ok().filter(|truth| truth.is_independent)
        }
        _ => None,
    };
    let mut drifts = Vec::new();
    for treatment in treatments {
        drifts.push(drift(lab, treatment, long, truth.as_ref()));
        progress.advance(1, &treatment.name());
    }
    lab.t_end = own;
    Ok((long, drifts))
}

/// Errors of α after the long run.
fn kept(drifts: &[Drift], long: f64) -> Vec<Goal> {
    if long != LONG_RUN {
        return Vec::new();
    }
    let goal = |(correction, limit)| {
        let drift = drifts.iter().find(|drift| drift.treatment == Treatment::Maximal(correction));
        let course = drift.and_then(|drift| drift.outcome.as_ref().ok());
        Goal {
            what: format!("error of α after {LONG_RUN} s at the paper's step, {correction}"),
            limit: Limit::AtMost(limit),
            reached: course.and_then(|course| course.errors.as_ref()?.first().copied()),
            by: "rk4, step 1e-4 s, corrected every 5e-4 s".to_owned(),
            is_time: false,
        }
    };
    KEPT.into_iter().map(goal).collect()
}

fn of_orders(orders: &[(Integrator, Treatment, Option<Order>)]) -> Vec<Goal> {
    let expected = |integrator| match integrator {
        Integrator::Rk4 | Integrator::Rodas4 => 4.0,
        Integrator::Tsit5 => 5.0,
        Integrator::Dop853 => 8.0,
    };
    let corrected =
        orders.iter().filter(|(_, treatment, _)| *treatment == Treatment::Maximal(Correction::Partition));
    corrected
        .map(|(integrator, treatment, order)| Goal {
            what: format!("order of {integrator}, corrected at every step"),
            limit: Limit::Near(expected(*integrator), 0.5),
            reached: order.map(|order| order.order),
            by: treatment.name(),
            is_time: false,
        })
        .collect()
}
