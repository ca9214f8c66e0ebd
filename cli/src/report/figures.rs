//! The figures of a page.

use super::best::front;
use super::chart::{
    Axis, BLACK, BLUE, Chart, GREEN, GREY, Line, Marker, ORANGE, PURPLE, Panel, SKY, Stroke, Style, VERMILION,
};
use super::curve::{Curve, Outcome, Point, Setting, Treatment, who};
use super::drift::Drift;
use super::stability::Map;
use crate::args::Precision;
use crate::report::curve::Engine;
use gyro_runner::{Correction, Integrator};

/// Below rounding nothing is shown, and above one nothing is known.
const ERRORS: (f64, f64) = (1e-16, 2.0);
const TIMES: (f64, f64) = (1e-9, 1e4);

pub(crate) const fn colour(integrator: Integrator) -> &'static str {
    match integrator {
        Integrator::Rk4 => BLUE,
        Integrator::Tsit5 => ORANGE,
        Integrator::Dop853 => GREEN,
        Integrator::Rodas4 => PURPLE,
    }
}

const BY_TOLERANCE: (Marker, Stroke) = (Marker::Disc, Stroke::Solid);
const BY_STEP: (Marker, Stroke) = (Marker::Ring, Stroke::Dashed);

fn style(colour: &'static str, (marker, stroke): (Marker, Stroke)) -> Style {
    Style { colour, stroke, marker }
}

/// What a diagram has along its x axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Work {
    Time,
    Evaluations,
}

impl Work {
    fn of(self, outcome: &Outcome) -> f64 {
        match self {
            Self::Time => 1e3 * outcome.seconds,
            Self::Evaluations => outcome.evaluations(),
        }
    }

    pub(super) fn axis(self) -> Axis {
        match self {
            Self::Time => Axis { label: "CPU time [ms]".to_owned(), limits: TIMES },
            Self::Evaluations => Axis {
                label: "evaluations of the right-hand side (a Jacobian counts as one)".to_owned(),
                limits: (1.0, 1e12),
            },
        }
    }
}

/// Work-precision diagrams of one precision, a panel for each treatment and for each runtime-assembled model.
pub(crate) fn work_precision(
    points: &[Point],
    (precision, work): (Precision, Work),
    scene: &str,
    is_relative: bool,
) -> Chart {
    let mut panels: Vec<(String, Vec<Point>)> = Vec::new();
    for point in points.iter().filter(|point| point.curve.precision == precision) {
        let title = match point.curve.engine {
            Engine::Generated => point.curve.treatment.name(),
            engine => format!("{}, {}", who(engine), point.curve.treatment.name()),
        };
        match panels.iter_mut().find(|(known, _)| *known == title) {
            Some((_, list)) => list.push(point.clone()),
            None => panels.push((title, vec![point.clone()])),
        }
    }
    let panels = panels.into_iter().map(|(title, points)| Panel { title, lines: lines(&points, work) });
    let mut legend: Vec<(String, Style)> = Integrator::ALL
        .iter()
        .map(|integrator| (integrator.to_string(), style(colour(*integrator), (Marker::None, Stroke::Solid))))
        .collect();
    legend.push(("by tolerance".to_owned(), style(GREY, BY_TOLERANCE)));
    legend.push(("by fixed step".to_owned(), style(GREY, BY_STEP)));
    let against = if work == Work::Time { "CPU time" } else { "evaluations" };
    Chart {
        title: format!("{scene}: error against {against}, {}", precision.name()),
        x: work.axis(),
        y: error_axis(is_relative),
        n_columns: 3,
        panels: panels.collect(),
        legend,
    }
}

pub(crate) fn error_axis(is_relative: bool) -> Axis {
    let label = if is_relative { "relative error" } else { "error [rad or m]" };
    Axis { label: label.to_owned(), limits: ERRORS }
}

/// A line for each integrator and kind of setting.
fn lines(points: &[Point], work: Work) -> Vec<Line> {
    let mut lines = Vec::new();
    for &integrator in Integrator::ALL {
        for is_tolerance in [true, false] {
            let of = points.iter().filter(|point| {
                point.curve.integrator == integrator
                    && matches!(point.setting, Setting::Tolerance(_)) == is_tolerance
            });
            let reached: Vec<_> = of
                .filter_map(|point| point.outcome.as_ref().ok())
                .map(|o| (work.of(o), o.error.max(ERRORS.0)))
                .collect();
            if !reached.is_empty() {
                let kind = if is_tolerance { BY_TOLERANCE } else { BY_STEP };
                lines.push(Line { points: reached, style: style(colour(integrator), kind) });
            }
        }
    }
    lines
}

/// The groups of the overview: name, style, and who belongs.
type Group = (&'static str, Style, fn(&Curve) -> bool);

const GROUPS: [Group; 8] = [
    ("generated, joint coordinates", style_of(GREEN, Stroke::Solid), |c| {
        ours(c, Precision::F64) && c.treatment == Treatment::Joint
    }),
    ("generated, maximal, corrected", style_of(BLUE, Stroke::Solid), |c| {
        ours(c, Precision::F64) && c.treatment.is_corrected()
    }),
    ("generated, maximal, Baumgarte or none", style_of(SKY, Stroke::Dotted), |c| {
        ours(c, Precision::F64) && c.treatment != Treatment::Joint && !c.treatment.is_corrected()
    }),
    ("generated f32, joint", style_of(GREEN, Stroke::Dashed), |c| {
        ours(c, Precision::F32) && c.treatment == Treatment::Joint
    }),
    ("generated f32, maximal, corrected", style_of(BLUE, Stroke::Dashed), |c| {
        ours(c, Precision::F32) && c.treatment.is_corrected()
    }),
    ("assembled, recursive", style_of(ORANGE, Stroke::Solid), |c| c.engine == Engine::Recursive),
    ("assembled, careful", style_of(VERMILION, Stroke::Solid), |c| c.engine == Engine::Careful),
    ("assembled, dense", style_of(BLACK, Stroke::Solid), |c| c.engine == Engine::Dense),
];

const fn style_of(colour: &'static str, stroke: Stroke) -> Style {
    Style { colour, stroke, marker: Marker::Disc }
}

fn ours(curve: &Curve, precision: Precision) -> bool {
    curve.engine == Engine::Generated && curve.precision == precision
}

/// The best that each way of computing reaches: all integrators and settings together.
pub(crate) fn overview(points: &[Point], scene: &str, is_relative: bool) -> Chart {
    let (mut lines, mut legend) = (Vec::new(), Vec::new());
    for (name, style, belongs) in GROUPS {
        let of = points
            .iter()
            .filter(|point| belongs(&point.curve))
            .filter_map(|point| point.outcome.as_ref().ok());
        let all: Vec<(f64, f64)> =
            of.map(|o| (1e3 * o.seconds, o.error.max(ERRORS.0))).filter(|(_, e)| *e <= ERRORS.1).collect();
        let points = front(&all);
        if !points.is_empty() {
            lines.push(Line { points, style });
            legend.push((name.to_owned(), style));
        }
    }
    Chart {
        title: format!("{scene}: the best of each way of computing it"),
        x: Work::Time.axis(),
        y: error_axis(is_relative),
        n_columns: 1,
        panels: vec![Panel { title: "fronts of all integrators, tolerances and steps".to_owned(), lines }],
        legend,
    }
}

/// Errors over fixed steps, a panel for each corrected treatment.
pub(crate) fn convergence(points: &[Point], scene: &str, t_end: f64, is_relative: bool) -> Chart {
    let mut panels: Vec<Panel> = Vec::new();
    let corrected = |point: &&Point| {
        ours(&point.curve, Precision::F64)
            && (point.curve.treatment.is_corrected() || point.curve.treatment == Treatment::Joint)
    };
    for point in points.iter().filter(corrected) {
        let (Setting::Steps(n), Ok(outcome)) = (point.setting, &point.outcome) else { continue };
        let title = point.curve.treatment.name();
        let index = panels.iter().position(|panel| panel.title == title).unwrap_or_else(|| {
            panels.push(Panel { title, lines: Vec::new() });
            panels.len() - 1
        });
        let style = style(colour(point.curve.integrator), (Marker::Disc, Stroke::Solid));
        let at = (t_end / n as f64, outcome.error.max(ERRORS.0));
        let lines = &mut panels[index].lines;
        match lines.iter_mut().find(|line| line.style == style) {
            Some(line) => line.points.push(at),
            None => lines.push(Line { points: vec![at], style }),
        }
    }
    let legend =
        Integrator::ALL.iter().map(|i| (i.to_string(), style(colour(*i), (Marker::Disc, Stroke::Solid))));
    Chart {
        title: format!("{scene}: error against the fixed step"),
        x: Axis { label: "step [s]".to_owned(), limits: (1e-12, 1e6) },
        y: error_axis(is_relative),
        n_columns: if panels.len() == 4 { 2 } else { 3 },
        panels,
        legend: legend.collect(),
    }
}

fn treatment_style(treatment: Treatment) -> Style {
    let line = |colour, stroke| Style { colour, stroke, marker: Marker::None };
    match treatment {
        Treatment::Joint => line(BLACK, Stroke::Solid),
        Treatment::Maximal(Correction::Partition) => line(BLUE, Stroke::Solid),
        Treatment::Maximal(Correction::ClosedForm) => line(GREEN, Stroke::Solid),
        Treatment::Maximal(Correction::MassWeighted) => line(VERMILION, Stroke::Solid),
        Treatment::Maximal(Correction::Baumgarte(_)) => line(ORANGE, Stroke::Dashed),
        Treatment::Maximal(Correction::None) => line(PURPLE, Stroke::Dashed),
    }
}

/// What constraints and energy do over a long time.
pub(crate) fn drift(drifts: &[Drift], scene: &str) -> Chart {
    let (mut violations, mut energy, mut legend) = (Vec::new(), Vec::new(), Vec::new());
    for drift in drifts {
        let Ok(course) = &drift.outcome else { continue };
        let style = treatment_style(drift.treatment);
        let over_time = |values: &[f64]| {
            // The largest so far; what is exactly zero has no logarithm.
            let largest = values.iter().scan(DRIFTS.0, |largest, value| {
                *largest = largest.max(*value);
                Some(*largest)
            });
            Line { points: course.times.iter().copied().zip(largest).collect(), style }
        };
        violations.push(over_time(&course.violations));
        energy.push(over_time(&course.energy));
        legend.push((drift.treatment.name(), style));
    }
    Chart {
        title: format!("{scene}: drift over a long time"),
        x: Axis { label: "t [s]".to_owned(), limits: (1e-9, 1e9) },
        y: Axis { label: "violation, energy error (pure numbers)".to_owned(), limits: DRIFTS },
        n_columns: 2,
        panels: vec![
            Panel { title: "worst constraint so far".to_owned(), lines: violations },
            Panel { title: "worst energy error so far".to_owned(), lines: energy },
        ],
        legend,
    }
}

const DRIFTS: (f64, f64) = (1e-18, 1e3);

/// Steps that were tried over a number of the scene, with the limit in theory.
pub(crate) fn stability(maps: &[Map], scene: &str, knob: &str) -> Chart {
    let stable = Style { colour: GREEN, stroke: Stroke::None, marker: Marker::Disc };
    let unstable = Style { colour: VERMILION, stroke: Stroke::None, marker: Marker::Cross };
    let theory = Style { colour: BLACK, stroke: Stroke::Solid, marker: Marker::None };
    let panel = |map: &Map| {
        let trials = |wanted: bool| {
            let columns = map.columns.iter();
            let all = columns.flat_map(|c| c.found.trials.iter().map(move |trial| (c.value, trial)));
            all.filter(|(_, trial)| trial.is_stable == wanted)
                .map(|(value, trial)| (value, trial.step))
                .collect()
        };
        let line = map.columns.iter().filter_map(|column| Some((column.value, column.theory?))).collect();
        Panel {
            title: map.integrator.to_string(),
            lines: vec![
                Line { points: trials(true), style: stable },
                Line { points: trials(false), style: unstable },
                Line { points: line, style: theory },
            ],
        }
    };
    Chart {
        title: format!("{scene}: stable steps"),
        x: Axis { label: knob.to_owned(), limits: (1e-12, 1e12) },
        y: Axis { label: "step [s]".to_owned(), limits: (1e-12, 1e6) },
        n_columns: 3,
        panels: maps.iter().map(panel).collect(),
        legend: vec![
            ("stable run".to_owned(), stable),
            ("unstable run".to_owned(), unstable),
            ("limit in theory, |R(hλ)| = 1".to_owned(), theory),
        ],
    }
}
