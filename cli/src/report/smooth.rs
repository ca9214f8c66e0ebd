//! Stops and friction as the smooth kinds of force have them, beside the rigid ones.
//!
//! A smooth kind has a width: friction is `tanh(ẋ / ε)` of its level, with ε in rad/s or m/s, and a stop is a spring
//! whose impacts last ε s, damped to rebound as its restitution says. Each run by a width is compared with the rigid
//! motion, so that its error is what the width makes of it and what the steps do.

use super::best::{TARGETS, front, smallest_error};
use super::chart::{BLUE, Chart, GREEN, Line, Marker, ORANGE, PURPLE, Panel, SKY, Stroke, Style, VERMILION};
use super::curve::{Curve, Outcome, Point, Setting, Treatment};
use super::figures::{Work, error_axis};
use super::lab::{Lab, Plan};
use super::page::Page;
use super::truth::Truth;
use crate::args::Precision;
use crate::failure::Failure;
use crate::report::curve::Engine;
use crate::words::number;
use gyro_model::{Contact, Force, ForceKind, Model, Number, Parameter, Rational, StopSide};
use gyro_runner::{Approach, Coordinates, Correction, Input, Integrator, JointSample, Settings};
use std::f64::consts::PI;
use std::fmt::Write as _;

/// Widths: rad/s or m/s of friction, s of stops.
const WIDTHS: [f64; 4] = [1e-2, 1e-3, 1e-4, 1e-5];
const TOLERANCES: [f64; 4] = [1e-4, 1e-6, 1e-8, 1e-10];
const INTEGRATORS: [Integrator; 3] = [Integrator::Tsit5, Integrator::Dop853, Integrator::Rodas4];
/// The distance over which a smooth stop builds up, over the width.
const SOFTNESS: f64 = 1e-2;
/// Steps of a run at most.
const BUDGET: u64 = 300_000;
/// The force and the time by which it is found how a coordinate gives way, N or N m, and s.
const PUSH: (f64, f64) = (1.0, 1e-4);

/// Runs by widths.
#[derive(Debug)]
pub(crate) struct Smooth {
    pub(crate) points: Vec<(f64, Point)>,
}

/// All runs with the smooth kinds; nothing of models without contacts.
pub(crate) fn smooth(lab: &mut Lab, truth: &Truth, measure_for: f64) -> Result<Option<Smooth>, Failure> {
    if lab.model.contacts.is_empty() {
        return Ok(None);
    }
    let masses = masses(lab)?;
    let (model, own) = smoothed(&lab.model);
    let mut parameters: Vec<f64> = model.parameters.iter().map(|p| gyro_model::to_f64(&p.value)).collect();
    let mut smoothed = lab.variant(model, parameters.clone())?;
    smoothed.t_end = lab.t_end;
    let mut points = Vec::new();
    for width in WIDTHS {
        for ((place, contact), mass) in own.iter().zip(&lab.model.contacts).zip(&masses) {
            let restitution = lab.model.value(&contact.restitution);
            parameters[*place..place + 4].copy_from_slice(&numbers(width, *mass, restitution));
        }
        smoothed.set_parameters(parameters.clone());
        for integrator in INTEGRATORS {
            let curve = Curve {
                engine: Engine::Generated,
                precision: Precision::F64,
                integrator,
                treatment: Treatment::Joint,
            };
            for tolerance in TOLERANCES {
                let limits = (BUDGET, measure_for);
                points.push((width, smoothed.point(truth, &curve, Setting::Tolerance(tolerance), limits)));
            }
        }
    }
    Ok(Some(Smooth { points }))
}

/// The model with smooth kinds in place of its contacts, and where the four parameters of each contact begin.
fn smoothed(model: &Model) -> (Model, Vec<usize>) {
    let mut model = model.clone();
    let contacts = std::mem::take(&mut model.contacts);
    // The forces of contacts are the last ones.
    model.forces.truncate(model.forces.len() - contacts.len());
    model.inputs.truncate(model.inputs.len() - contacts.len());
    model.between.truncate(model.between.len() - contacts.len());
    let mut own = Vec::new();
    for contact in &contacts {
        let first = model.parameters.len();
        own.push(first);
        for what in ["rate", "stiffness", "damping", "softness"] {
            let name = format!("{}_{what}_when_smooth", contact.name);
            model.parameters.push(Parameter { name, value: Rational::from_integer(1.into()) });
        }
        model.forces.extend(forces(contact, first));
    }
    (model, own)
}

fn forces(contact: &Contact, first: usize) -> Vec<Force> {
    let parameter = |k: usize| Number::Parameter { index: first + k, negated: false };
    let on = contact.on;
    let mut forces = Vec::new();
    if !contact.levels[0].is_zero() {
        let kind = ForceKind::Coulomb { on, level: contact.levels[0].clone(), rate: parameter(0) };
        forces.push(Force { name: format!("{}_friction", contact.name), kind });
    }
    for (side, end) in [StopSide::Lower, StopSide::Upper].into_iter().zip(&contact.ends) {
        let Some(limit) = end.clone() else { continue };
        let [stiffness, damping, softness] = [1, 2, 3].map(parameter);
        let kind = ForceKind::Stop { on, limit, side, stiffness, damping, softness };
        forces.push(Force { name: format!("{}_{side:?}", contact.name).to_lowercase(), kind });
    }
    forces
}

/// Rate of friction; stiffness, damping and softness of stops: an oscillator of this mass that is in touch for half a
/// period and loses what the restitution says.
fn numbers(width: f64, mass: f64, restitution: f64) -> [f64; 4] {
    let stiffness = mass * (PI / width).powi(2);
    let logarithm = -restitution.max(1e-3).ln();
    let ratio = logarithm / PI.hypot(logarithm);
    [width, stiffness, 2.0 * ratio * (stiffness * mass).sqrt(), SOFTNESS * width]
}

/// How heavy the mechanism is along each contact at the start: a force over the acceleration that it adds.
fn masses(lab: &mut Lab) -> Result<Vec<f64>, Failure> {
    let approach = Approach {
        integrator: Integrator::Rk4,
        coordinates: Coordinates::Joint,
        correction: Correction::None,
        ..Approach::default()
    };
    let (force, time) = PUSH;
    let settings = Settings { t_end: time, step: time, correct_every: None, sample_every: time };
    let plan = Plan { settings, approach, measure_for: None };
    let contacts = lab.model.contacts.clone();
    let mut pushed = lab.again()?;
    (pushed.start.contacts, pushed.start.controllers) = (Vec::new(), Vec::new());
    let joints: Vec<usize> = (lab.model.joints.iter())
        .scan(0, |before, joint| {
            let own = *before;
            // An orientation is one sample.
            *before += joint
                .kind
                .coordinates()
                .len()
                .max(usize::from(joint.kind == gyro_model::JointKind::Spherical));
            Some(own)
        })
        .collect();
    let mut rate = |contact: &Contact, force: f64| {
        pushed.start.inputs = vec![Input::constant(contact.input, force)];
        let run = pushed.run((Engine::Generated, Precision::F64), &plan).map_err(Failure::Run)?;
        match run
            .samples
            .last()
            .map(|last| &last.coordinates[joints[contact.on.joint] + contact.on.coordinate])
        {
            Some(JointSample::Angle { rate, .. } | JointSample::Length { rate, .. }) => Ok(*rate),
            _ => Err(Failure::Run(format!("contact `{}` is on no angle or length", contact.name))),
        }
    };
    contacts
        .iter()
        .map(|contact| Ok(2.0 * force * time / (rate(contact, force)? - rate(contact, -force)?)))
        .collect()
}

/// The table of all runs.
pub(crate) fn data(smooth: &Smooth) -> String {
    let mut text = "width,integrator,tolerance,error,seconds,ratio,evaluations,failure\n".to_owned();
    for (width, point) in &smooth.points {
        let Setting::Tolerance(tolerance) = point.setting else { continue };
        let _ = write!(text, "{width:e},{},{tolerance:e},", point.curve.integrator);
        let _ = match &point.outcome {
            Ok(o) => writeln!(text, "{:e},{:e},{:e},{},", o.error, o.seconds, o.ratio, o.evaluations()),
            Err(words) => writeln!(text, ",,,,\"{}\"", words.replace('"', "'")),
        };
    }
    text
}

/// What smooth runs are shown beside: the scene, and its runs from event to event.
#[derive(Clone, Copy)]
pub(crate) struct Beside<'a> {
    pub(crate) name: &'a str,
    pub(crate) t_end: f64,
    pub(crate) is_relative: bool,
    pub(crate) points: &'a [Point],
}

fn rigid<'a>(beside: &Beside<'a>) -> impl Iterator<Item = &'a Point> {
    beside.points.iter().filter(|point| {
        point.curve.precision == Precision::F64 && matches!(point.setting, Setting::Tolerance(_))
    })
}

/// The section of a scene's page.
pub(crate) fn write(smooth: &Smooth, beside: &Beside<'_>, page: &mut Page) {
    page.heading(2, "Rigid and smooth stops and friction");
    page.text(format!(
        "The contacts of the model file, which runs follow from event to event, beside `[[force]]` of kind \"stop\" and \"coulomb\" in \
         their place. Those have a width ε: friction is tanh(rate / ε) of its kinetic level, with ε in rad/s or m/s; \
         impacts on a stop last about ε s, and rebound about as much as its restitution says. They have no static level, and none that \
         depends on a reaction. Errors of both are counted from the rigid motion. Data: `{}-smooth.csv`.",
        beside.name
    ));
    let chart = chart(smooth, beside);
    page.figure(
        format!("{}-smooth.svg", beside.name),
        "Error against CPU time: rigid contacts, and smooth ones of four widths",
        chart.svg(),
    );
    let all = || smooth.points.iter().map(|(_, point)| point);
    let rows = TARGETS.iter().map(|&target| {
        let [rigid, smooth] = [quickest(rigid(beside), target), quickest(all(), target)];
        let cell = |found: Option<(&Point, &Outcome)>| match found {
            None => "not reached".to_owned(),
            Some((point, o)) => format!(
                "{} ms ({}), {}, {}",
                number(1e3 * o.seconds, 3),
                number(o.ratio, 3),
                point.curve.integrator,
                point.setting.name(beside.t_end)
            ),
        };
        let over = match (rigid, smooth) {
            (Some((_, rigid)), Some((_, smooth))) => number(rigid.ratio / smooth.ratio, 3),
            _ => "-".to_owned(),
        };
        vec![format!("{target:e}"), cell(rigid), cell(smooth), over]
    });
    page.table(&["error at most", "rigid", "smooth", "time, rigid over smooth"], rows.collect());
    let least = WIDTHS.map(|width| {
        let own = smooth.points.iter().filter(|(w, _)| *w == width).map(|(_, point)| point);
        let error = smallest_error(own).map_or("no run".to_owned(), |error| number(error, 2));
        format!("{error} with ε = {width:e}")
    });
    page.text(format!("The smallest error of smooth kinds is {}.", least.join(", ")));
}

fn quickest<'a>(points: impl Iterator<Item = &'a Point>, target: f64) -> Option<(&'a Point, &'a Outcome)> {
    let point = super::best::best(points, target)?;
    Some((point, point.outcome.as_ref().ok()?))
}

fn chart(smooth: &Smooth, beside: &Beside<'_>) -> Chart {
    let line = |colour, stroke| Style { colour, stroke, marker: Marker::Disc };
    let (mut lines, mut legend) = (Vec::new(), Vec::new());
    let mut add = |name: String, style: Style, points: Vec<&Point>| {
        let reached = points.into_iter().filter_map(|point| point.outcome.as_ref().ok());
        let all: Vec<(f64, f64)> = reached.map(|o| (1e3 * o.seconds, o.error.max(1e-16))).collect();
        if !all.is_empty() {
            lines.push(Line { points: front(&all), style });
            legend.push((name, style));
        }
    };
    for (integrator, colour) in [(Integrator::Tsit5, GREEN), (Integrator::Dop853, BLUE)] {
        let own = rigid(beside).filter(|point| point.curve.integrator == integrator).collect();
        add(format!("rigid, {integrator}"), line(colour, Stroke::Solid), own);
    }
    for (width, colour) in WIDTHS.into_iter().zip([SKY, ORANGE, VERMILION, PURPLE]) {
        let own = smooth.points.iter().filter(|(w, _)| *w == width).map(|(_, point)| point).collect();
        add(format!("smooth, ε = {width:e}"), line(colour, Stroke::Dashed), own);
    }
    Chart {
        title: format!("{}: rigid and smooth stops and friction", beside.name),
        x: Work::Time.axis(),
        y: error_axis(beside.is_relative),
        n_columns: 1,
        panels: vec![Panel {
            title: "fronts of all tolerances; smooth: of three integrators".to_owned(),
            lines,
        }],
        legend,
    }
}
