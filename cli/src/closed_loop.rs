//! `simulate --linearize` of a model with controllers: the loops closed, without limits and converters.

mod discrete;
mod margins;

use crate::controllers::controllers;
use crate::words::{number, table};
use discrete::{Discrete, Plant};
use gyro_model::Model;
use gyro_runner::motion::{Element, Linear};
use gyro_runner::{Controller, Formula, Operation, Seen};
use gyro_sim::JointPlace;
use margins::Margins;
use nalgebra::{Complex, DMatrix};
use serde_json::{Value, json};
use std::f64::consts::{PI, TAU};

/// What is to be told of closed loops.
#[derive(Clone, Debug)]
struct Closed {
    /// What the poles are multipliers over, s: the least time after which all controllers sample together again.
    period: f64,
    poles: Vec<Complex<f64>>,
    /// For each controller, where it has them.
    margins: Vec<Result<Margins, String>>,
}

fn closed(model: &Model, linear: &Linear) -> Result<Closed, String> {
    let controllers = controllers(model);
    let follows = |formula: &Formula| {
        formula.0.iter().any(|operation| matches!(operation, Operation::Seen(what) if *what != Seen::Time))
    };
    let following = controllers.iter().position(|controller| controller.setpoints.iter().any(follows));
    if let Some(index) = following {
        let name = &model.controllers[index].name;
        return Err(format!("a set point of `{name}` depends on the motion or on an input"));
    }
    let plant = plant(linear, &controllers, model)?;
    let discrete = Discrete::new(&plant, &controllers)?;
    let of = |index: usize| {
        if controllers[index].inputs.len() > 1 {
            return Err("it sets several inputs".to_owned());
        }
        if controllers.iter().any(|other| other.period_s() != controllers[index].period_s()) {
            return Err("controllers have several periods".to_owned());
        }
        Ok(margins::margins(&discrete.opened(index), discrete.period))
    };
    let margins = (0..controllers.len()).map(of).collect();
    Ok(Closed { period: discrete.period, poles: discrete.poles(), margins })
}

/// The plant as the controllers see it: their inputs, and a row of C and D for each number seen.
fn plant(linear: &Linear, controllers: &[Controller], model: &Model) -> Result<Plant, String> {
    let (n, m) = (linear.state.len(), model.inputs.len());
    let inputs: Vec<usize> =
        controllers.iter().flat_map(|c| c.inputs.iter().map(|(index, _)| *index)).collect();
    let mut seen = Vec::new();
    for (controller, what) in controllers.iter().flat_map(|c| c.outputs.iter().map(move |seen| (c, seen))) {
        let row = match *what {
            Seen::Output(index) => (
                linear.outputs_by_state[index * n..(index + 1) * n].to_vec(),
                inputs.iter().map(|input| linear.outputs_by_inputs[index * m + input]).collect(),
            ),
            Seen::Time | Seen::Input(..) | Seen::Distance(_) | Seen::DistanceRate(_) => {
                (vec![0.0; n], vec![0.0; inputs.len()])
            }
            Seen::Coordinate(joint, k) | Seen::Rate(joint, k) => {
                let is_rate = matches!(what, Seen::Rate(..));
                let at = linear.elements.iter().position(|element| is(element, joint, k, is_rate));
                let at = at.ok_or_else(|| {
                    let index = controllers.iter().position(|other| other == controller).unwrap_or(0);
                    format!(
                        "controller `{}` sees a coordinate of `{}`, which is none of the independent ones here: let it see an \
                         [[output]] of the body",
                        model.controllers[index].name, model.joints[joint].name
                    )
                })?;
                let mut row = vec![0.0; n];
                row[at] = 1.0;
                (row, vec![0.0; inputs.len()])
            }
        };
        seen.push(row);
    }
    let by_inputs = DMatrix::from_fn(n, inputs.len(), |row, k| linear.by_inputs[row * m + inputs[k]]);
    Ok(Plant { by_state: DMatrix::from_row_slice(n, n, &linear.by_state), by_inputs, seen })
}

fn is(element: &Element, of_joint: usize, k: usize, is_rate: bool) -> bool {
    let (place, rate) = match element {
        Element::Position { place, .. } => (place, false),
        Element::Rate { place, .. } => (place, true),
        Element::Turn { .. } => return false,
    };
    rate == is_rate
        && matches!(place, JointPlace::Scalar { joint, coordinate }
            if usize::from(*joint) == of_joint && usize::from(*coordinate) == k)
}

/// Poles nearer to the unit circle than this are on it: double ones come with the root of the rounding.
const ROUNDING: f64 = 1e-7;

impl Closed {
    fn stability(&self) -> &'static str {
        match self.poles.iter().map(|pole| pole.norm()).fold(0.0, f64::max) {
            largest if largest < 1.0 - ROUNDING => "stable",
            largest if largest <= 1.0 + ROUNDING => "marginal",
            _ => "unstable",
        }
    }
}

/// The part of `--json`; nothing of a model without controllers.
pub(crate) fn object(model: &Model, linear: &Linear) -> Option<Value> {
    if model.controllers.is_empty() {
        return None;
    }
    Some(match closed(model, linear) {
        Err(words) => json!({ "none": words }),
        Ok(closed) => {
            let margins = model.controllers.iter().zip(&closed.margins).map(|(controller, margins)| {
                let value = match margins {
                    Err(words) => json!({ "none": words }),
                    Ok(margins) => json!({
                        "gain": margins.gain.map(|(gain, _)| gain),
                        "gain_frequency": margins.gain.map(|(_, at)| at),
                        "gain_reduction": margins.reduction.map(|(gain, _)| gain),
                        "gain_reduction_frequency": margins.reduction.map(|(_, at)| at),
                        "phase_deg": margins.phase.map(|(phase, _)| phase * 180.0 / PI),
                        "phase_frequency": margins.phase.map(|(_, at)| at),
                    }),
                };
                (controller.name.clone(), value)
            });
            json!({
                "period": closed.period,
                "poles": closed.poles.iter().map(|pole| [pole.re, pole.im]).collect::<Vec<_>>(),
                "stability": closed.stability(),
                "margins": margins.collect::<serde_json::Map<_, _>>(),
            })
        }
    })
}

const DIGITS: usize = 6;

/// The part of the summary; nothing of a model without controllers.
pub(crate) fn text(model: &Model, linear: &Linear) -> String {
    if model.controllers.is_empty() {
        return String::new();
    }
    let closed = match closed(model, linear) {
        Err(words) => return format!("\nclosed loop: none: {words}\n"),
        Ok(closed) => closed,
    };
    let (period, stability) = (number(closed.period, DIGITS), closed.stability());
    let mut text =
        format!("\nclosed loop, exact over {period} s, without limits and converters: {stability}\n");
    let titles = ["pole", "real", "imaginary", "size", "frequency, Hz", "damping ratio"];
    let mut rows = vec![titles.map(str::to_owned).to_vec()];
    for (index, pole) in closed.poles.iter().enumerate() {
        // z = exp(s · period)
        let s = pole.ln() / closed.period;
        let (frequency, damping) = (number(s.norm() / TAU, DIGITS), number(-s.re / s.norm(), 4));
        let oscillates = pole.im != 0.0;
        let [re, im, size] = [pole.re, pole.im, pole.norm()].map(|x| number(x, DIGITS));
        let frequency = if oscillates { frequency } else { String::new() };
        rows.push(vec![(index + 1).to_string(), re, im, size, frequency, damping]);
    }
    text += &table(&rows);
    for (controller, margins) in model.controllers.iter().zip(&closed.margins) {
        text += &match margins {
            Err(words) => format!("no margins of {}: {words}\n", controller.name),
            Ok(margins) => format!("margins of {}: {}\n", controller.name, in_words(margins)),
        };
    }
    text
}

fn in_words(margins: &Margins) -> String {
    let gain = |(gain, at): (f64, f64)| {
        format!(
            "{} ({} dB) at {} rad/s",
            number(gain, DIGITS),
            number(20.0 * gain.log10(), 4),
            number(at, DIGITS)
        )
    };
    let phase = margins.phase.map_or("none".to_owned(), |(phase, at)| {
        format!("{} deg at {} rad/s", number(phase * 180.0 / PI, DIGITS), number(at, DIGITS))
    });
    let reduction = margins.reduction.map_or(String::new(), |found| format!(", down to {}", gain(found)));
    format!("gain {}{reduction}; phase {phase}", margins.gain.map_or("none".to_owned(), gain))
}
