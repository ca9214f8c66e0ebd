//! The variables of a unit: names, units, starts.

use super::{Settings, Xml};
use crate::Error;
use gyro_codegen::{JointPlace, Scheduled};
use gyro_model::{Model, to_f64};
use gyro_program::Space;
use std::io;

/// A variable of the unit.
pub(super) struct Variable {
    /// Its value reference.
    pub(super) reference: usize,
    pub(super) name: String,
    pub(super) unit: Option<String>,
    pub(super) causality: &'static str,
    pub(super) variability: &'static str,
    pub(super) initial: Option<&'static str>,
    pub(super) start: Option<f64>,
    pub(super) derivative: Option<usize>,
}

/// All variables, in the order of their value references: time, states, derivatives, inputs, parameters, outputs. An
/// output that tells a state of the model file is that state, and no second variable.
pub(super) fn variables(
    model: &Model,
    scheduled: &Scheduled,
    settings: &Settings,
) -> Result<Vec<Variable>, Error> {
    let states = states(model, scheduled);
    let n_states = scheduled.len(Space::Joints);
    let starts = scheduled.joint.as_ref().map_or(&[][..], |joint| &joint.start);
    if states.len() != n_states || starts.len() != n_states {
        return Err(Error(format!("a state of {n_states} numbers, of which {} are known", states.len())));
    }
    let time = Variable {
        unit: Some("s".to_owned()),
        initial: None,
        start: None,
        ..Variable::new("time", "independent", "continuous")
    };
    let mut variables = vec![time];
    for ((name, unit), start) in states.iter().zip(starts) {
        variables.push(Variable {
            unit: Some(unit.clone()),
            initial: Some("exact"),
            start: Some(start + 0.0),
            ..Variable::new(name, "output", "continuous")
        });
    }
    for (n, (name, unit)) in states.iter().enumerate() {
        variables.push(Variable {
            unit: Some(by_time(unit)),
            initial: Some("calculated"),
            derivative: Some(n + 1),
            ..Variable::new(&format!("der({name})"), "local", "continuous")
        });
    }
    for (input, unit) in model.inputs.iter().zip(&settings.input_units) {
        variables.push(Variable {
            unit: Some(unit.clone()),
            start: Some(to_f64(&input.value)),
            ..Variable::new(&input.name, "input", "continuous")
        });
    }
    for parameter in &model.parameters {
        variables.push(Variable {
            initial: Some("exact"),
            start: Some(to_f64(&parameter.value)),
            ..Variable::new(&parameter.name, "parameter", "tunable")
        });
    }
    for (name, unit) in &settings.outputs {
        variables.push(Variable {
            unit: Some(unit.clone()),
            initial: Some("calculated"),
            ..Variable::new(name, "output", "continuous")
        });
    }
    variables.iter_mut().enumerate().for_each(|(n, variable)| variable.reference = n);
    let is_state = |of: &Variable| model.states.iter().any(|state| state.name == of.name);
    variables.retain(|of| of.reference <= n_states || !(of.causality == "output" && is_state(of)));
    distinct(&mut variables);
    Ok(variables)
}

impl Variable {
    fn new(name: &str, causality: &'static str, variability: &'static str) -> Self {
        let name = name.to_owned();
        Self {
            reference: 0,
            name,
            unit: None,
            causality,
            variability,
            initial: None,
            start: None,
            derivative: None,
        }
    }

    pub(super) fn write(&self, xml: &mut Xml) -> io::Result<()> {
        let reference = self.reference.to_string();
        let (start, derivative) = (self.start.map(number), self.derivative.map(|of| of.to_string()));
        let optional = [
            ("initial", self.initial),
            ("unit", self.unit.as_deref()),
            ("derivative", derivative.as_deref()),
            ("start", start.as_deref()),
        ];
        xml.create_element("Float64")
            .with_attributes([
                ("name", self.name.as_str()),
                ("valueReference", reference.as_str()),
                ("causality", self.causality),
                ("variability", self.variability),
            ])
            .with_attributes(optional.into_iter().filter_map(|(name, value)| Some((name, value?))))
            .write_empty()?;
        Ok(())
    }
}

/// Name and unit of each number of the joint state, as the table of a run names them.
pub(crate) fn states(model: &Model, scheduled: &Scheduled) -> Vec<(String, String)> {
    const EULER: [&str; 4] = ["e0", "e1", "e2", "e3"];
    const AXES: [&str; 3] = ["x", "y", "z"];
    let (mut coordinates, mut rates) = (Vec::new(), Vec::new());
    let bodies = model.coordinate_bodies();
    for place in scheduled.joint.iter().flat_map(|joint| &joint.places) {
        let parts = |to: &mut Vec<(String, String)>, name: &str, parts: &[&str], unit: &str| {
            to.extend(parts.iter().map(|part| (format!("{name} {part}"), unit.to_owned())));
        };
        match *place {
            JointPlace::Scalar { joint, coordinate } | JointPlace::Turn { joint, coordinate } => {
                let kinds = model.joints[joint].kind.coordinates();
                let kind = kinds[coordinate];
                let name = match kinds {
                    [_] => model.joints[joint].name.clone(),
                    _ => format!("{}.{}", model.joints[joint].name, kind.name()),
                };
                let [unit, rate] = if kind.is_angle() { ["rad", "rad/s"] } else { ["m", "m/s"] };
                if matches!(place, JointPlace::Scalar { .. }) {
                    rates.push((format!("{name} rate"), rate.to_owned()));
                }
                coordinates.push((name, unit.to_owned()));
            }
            JointPlace::State { state } => {
                coordinates.push((model.states[state].name.clone(), "1".to_owned()))
            }
            JointPlace::Orientation { joint } => {
                let name = &model.joints[joint].name;
                parts(&mut coordinates, name, &EULER, "1");
                parts(&mut rates, &format!("{name} rate"), &AXES, "rad/s");
            }
            JointPlace::Body { body } => {
                let name = &model.bodies[bodies[body]].name;
                parts(&mut coordinates, name, &AXES, "m");
                parts(&mut coordinates, name, &EULER, "1");
                parts(&mut rates, &format!("{name} velocity"), &AXES, "m/s");
                parts(&mut rates, &format!("{name} angular velocity"), &["x'", "y'", "z'"], "rad/s");
            }
        }
    }
    let work = model.has_work().then(|| ("work".to_owned(), "J".to_owned()));
    coordinates.into_iter().chain(rates).chain(work).collect()
}

/// Gives a variable whose name is taken a number.
fn distinct(variables: &mut [Variable]) {
    for n in 0..variables.len() {
        let name = variables[n].name.clone();
        let is_taken = |name: &String| variables[..n].iter().any(|before| before.name == *name);
        let numbered = (2..).map(|k: usize| format!("{name} {k}"));
        let chosen = std::iter::once(name.clone()).chain(numbered).find(|name| !is_taken(name));
        variables[n].name = chosen.expect("there is always a further number");
    }
}

/// The unit of a derivative by time.
fn by_time(unit: &str) -> String {
    match unit {
        "1" => "1/s".to_owned(),
        "J" => "W".to_owned(),
        _ => unit.strip_suffix("/s").map_or_else(|| format!("{unit}/s"), |unit| format!("{unit}/s^2")),
    }
}

/// A unit in powers of the base units of FMI.
pub(super) fn base_units(unit: &str) -> [(&'static str, i32); 4] {
    // kg, m, s, rad
    let powers = |symbol: &str| match symbol {
        "kg" => [1, 0, 0, 0],
        "m" => [0, 1, 0, 0],
        "s" => [0, 0, 1, 0],
        "rad" => [0, 0, 0, 1],
        "N" => [1, 1, -2, 0],
        "J" => [1, 2, -2, 0],
        "W" => [1, 2, -3, 0],
        _ => [0; 4],
    };
    let mut sum = [0; 4];
    for (n, quotient) in unit.split('/').enumerate() {
        for factor in quotient.split('*') {
            let (symbol, exponent) = factor.split_once('^').unwrap_or((factor, "1"));
            let exponent: i32 = exponent.parse().unwrap_or(1);
            for (sum, power) in sum.iter_mut().zip(powers(symbol)) {
                *sum += if n == 0 { power * exponent } else { -power * exponent };
            }
        }
    }
    let [kg, m, s, rad] = sum;
    [("kg", kg), ("m", m), ("s", s), ("rad", rad)]
}

/// A number as XML has it.
pub(super) fn number(value: f64) -> String {
    format!("{value:?}")
}
