//! The variables of a unit: names, units, starts.

use super::dependencies::{Knowns, References, dependencies};
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
    /// What it depends on, if it is an unknown.
    pub(super) depends: Knowns,
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
            unit: told(unit),
            initial: Some("exact"),
            start: Some(start + 0.0),
            ..Variable::new(name, "output", "continuous")
        });
    }
    for (n, (name, unit)) in states.iter().enumerate() {
        variables.push(Variable {
            unit: told(unit).map(|unit| by_time(&unit)),
            initial: Some("calculated"),
            derivative: Some(n + 1),
            ..Variable::new(&format!("der({name})"), "local", "continuous")
        });
    }
    for (input, unit) in model.inputs.iter().zip(&settings.input_units) {
        variables.push(Variable {
            unit: told(unit),
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
            unit: told(unit),
            initial: Some("calculated"),
            ..Variable::new(name, "output", "continuous")
        });
    }
    variables.iter_mut().enumerate().for_each(|(n, variable)| variable.reference = n);
    depend(&mut variables, model, scheduled);
    let is_state = |of: &Variable| model.states.iter().any(|state| state.name == of.name);
    variables.retain(|of| of.reference <= n_states || !(of.causality == "output" && is_state(of)));
    distinct(&mut variables);
    Ok(variables)
}

/// Says of each unknown what it depends on.
fn depend(variables: &mut [Variable], model: &Model, scheduled: &Scheduled) {
    let n_states = scheduled.len(Space::Joints);
    let inputs = 1 + 2 * n_states;
    let parameters = inputs + model.inputs.len();
    let first_output = parameters + model.parameters.len();
    let [derivatives, outputs] =
        dependencies(scheduled, References { time: 0, states: 1, inputs, parameters });
    for variable in variables {
        variable.depends = match (variable.derivative, variable.causality) {
            (Some(of), _) => derivatives[of - 1].clone(),
            (_, "output") if variable.reference <= n_states => Knowns::one(variable.reference),
            (_, "output") => outputs[variable.reference - first_output].clone(),
            _ => continue,
        };
    }
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
            depends: Knowns::default(),
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

/// A unit as importers are told: none of what has none, or of which the model file does not say any.
fn told(unit: &str) -> Option<String> {
    (!matches!(unit, "" | "1")).then(|| unit.to_owned())
}

/// The unit of a derivative by time.
fn by_time(unit: &str) -> String {
    match unit {
        "J" => "W".to_owned(),
        _ => unit.strip_suffix("/s").map_or_else(|| format!("{unit}/s"), |unit| format!("{unit}/s^2")),
    }
}

/// A unit in powers of the base units of FMI: a product of symbols with exponents (`m/s2`, `kg*m^2`, `N.m.s/rad`), of
/// which all that comes after a slash divides. Nothing if a symbol is not known, so that no other unit is taken for it.
pub(super) fn base_units(unit: &str) -> Option<[(&'static str, i32); 4]> {
    // kg, m, s, rad
    let powers = |symbol: &str| match symbol {
        "" => Some([0; 4]),
        "kg" => Some([1, 0, 0, 0]),
        "m" => Some([0, 1, 0, 0]),
        "s" => Some([0, 0, 1, 0]),
        "rad" => Some([0, 0, 0, 1]),
        "N" => Some([1, 1, -2, 0]),
        "J" => Some([1, 2, -2, 0]),
        "W" => Some([1, 2, -3, 0]),
        _ => None,
    };
    let mut sum = [0; 4];
    for (n, quotient) in unit.split('/').enumerate() {
        for factor in quotient.split(['*', '.']) {
            let end = factor.find(|c: char| !c.is_ascii_alphabetic()).unwrap_or(factor.len());
            let (symbol, exponent) = factor.split_at(end);
            let exponent: i32 = match exponent.trim_start_matches('^') {
                "" => 1,
                written => written.parse().ok()?,
            };
            for (sum, power) in sum.iter_mut().zip(powers(symbol)?) {
                *sum += if n == 0 { power * exponent } else { -power * exponent };
            }
        }
    }
    let [kg, m, s, rad] = sum;
    Some([("kg", kg), ("m", m), ("s", s), ("rad", rad)])
}

/// A number as XML has it.
pub(super) fn number(value: f64) -> String {
    format!("{value:?}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyro_model::keys::FORCE;

    #[test]
    fn units_have_the_powers_of_what_they_are_made_of() {
        let table = [
            ("1", [0, 0, 0, 0]),
            ("s", [0, 0, 1, 0]),
            ("1/s", [0, 0, -1, 0]),
            ("m", [0, 1, 0, 0]),
            ("m/s", [0, 1, -1, 0]),
            ("m/s2", [0, 1, -2, 0]),
            ("m/s^2", [0, 1, -2, 0]),
            ("rad", [0, 0, 0, 1]),
            ("rad/s", [0, 0, -1, 1]),
            ("rad/s2", [0, 0, -2, 1]),
            ("rad/s^2", [0, 0, -2, 1]),
            ("kg", [1, 0, 0, 0]),
            ("kg.m2", [1, 2, 0, 0]),
            ("kg*m^2", [1, 2, 0, 0]),
            ("N", [1, 1, -2, 0]),
            ("N/m", [1, 0, -2, 0]),
            ("N*s/m", [1, 0, -1, 0]),
            ("N*m", [1, 2, -2, 0]),
            ("N.m/rad", [1, 2, -2, -1]),
            ("N*m*s/rad", [1, 2, -1, -1]),
            ("N.m.s/rad", [1, 2, -1, -1]),
            ("J", [1, 2, -2, 0]),
            ("W", [1, 2, -3, 0]),
        ];
        for (unit, powers) in table {
            assert_eq!(base_units(unit).map(|base| base.map(|(_, power)| power)), Some(powers), "{unit}");
        }
        for unit in ["N/m^exponent", "deg"] {
            assert_eq!(base_units(unit), None, "{unit}");
        }
    }

    #[test]
    fn all_units_of_forces_and_of_what_changes_with_time_are_known() {
        let keys = FORCE.kinds.iter().flat_map(|kind| kind.keys).filter_map(|key| key.unit());
        let units: Vec<&str> = keys.flat_map(|unit| unit.split(" or ")).collect();
        assert!(units.contains(&"N.m.s/rad") && units.contains(&"J"), "{units:?}");
        for unit in units {
            let [base, rate] = [unit, &by_time(unit)].map(|unit| base_units(unit).expect(unit));
            for ((name, power), (_, of_rate)) in base.into_iter().zip(rate) {
                assert_eq!(of_rate, power - i32::from(name == "s"), "{unit} by time: {name}");
            }
        }
    }
}
