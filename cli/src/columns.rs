//! Samples as a table of named columns with units.

use crate::paths;
use crate::scene::observed;
use gyro_model::keys::FORCE;
use gyro_model::{
    CoordinateKind, Force, JointCoordinate, JointKind, Model, Number, Output, OutputKind, Parameter,
};
use gyro_runner::{JointSample, Sample, Start, Touch, energy_error};
use std::fmt::Write as _;

/// A quantity that every sample has.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// What it is.
    pub name: String,
    /// Its unit, `1` for a number without one.
    pub unit: &'static str,
    /// One value for each sample.
    pub values: Vec<f64>,
}

/// A joint coordinate as it is shown; they come in the order of [`Sample::coordinates`].
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// The joint's name, and the coordinate's if there are several: `table.x`.
    pub name: String,
    /// Index of the joint.
    pub joint: usize,
    /// What it is; `None` for an orientation.
    pub kind: Option<CoordinateKind>,
}

impl Shown {
    /// Unit of a scalar coordinate.
    pub fn unit(&self) -> &'static str {
        if self.kind.is_some_and(CoordinateKind::is_angle) { "rad" } else { "m" }
    }

    /// Whether it is an orientation, of four Euler parameters and three rates.
    pub fn is_orientation(&self) -> bool {
        self.kind.is_none()
    }

    /// Unit of its rate.
    pub fn rate_unit(&self) -> &'static str {
        if self.kind.is_some_and(CoordinateKind::is_angle) { "rad/s" } else { "m/s" }
    }
}

/// All joint coordinates of a model.
pub fn coordinates(model: &Model) -> Vec<Shown> {
    let mut shown = Vec::new();
    for (joint, described) in model.joints.iter().enumerate() {
        let kinds = described.kind.coordinates();
        if described.kind == JointKind::Spherical {
            shown.push(Shown { name: described.name.clone(), joint, kind: None });
        }
        for kind in kinds {
            let name = match kinds {
                [_] => described.name.clone(),
                _ => format!("{}.{}", described.name, kind.name()),
            };
            shown.push(Shown { name, joint, kind: Some(*kind) });
        }
    }
    shown
}

/// Suffix and unit of each number of an output.
pub(crate) fn output_columns(model: &Model, output: &Output) -> Vec<(&'static str, &'static str)> {
    let columns = output.kind.columns();
    let on = match output.kind {
        OutputKind::Driver { driver } => Some(model.drivers[driver].coordinate),
        OutputKind::Coupler { coupler } => model.couplers[coupler].second,
        OutputKind::Spring { force } => model.forces[force].kind.parts().on.map(|(on, _)| on),
        _ => None,
    };
    let Some(on) = on else { return columns.to_vec() };
    columns.iter().map(|(suffix, unit)| (*suffix, unit_along(model, on, unit))).collect()
}

/// Name and unit of each number of all outputs, in their order.
pub(crate) fn outputs(model: &Model) -> Vec<(String, &'static str)> {
    let named = model.outputs.iter().flat_map(|output| {
        let parts = output_columns(model, output).into_iter();
        parts.map(|(suffix, unit)| {
            let is_single = suffix.is_empty();
            (if is_single { output.name.clone() } else { format!("{}.{suffix}", output.name) }, unit)
        })
    });
    named.collect()
}

/// The value of each input at a sample: as it was set, or else the model file's.
pub(crate) fn inputs_at(model: &Model, start: &Start, sample: &Sample) -> Vec<f64> {
    let value = |(index, input): (usize, &Parameter)| {
        let set = start.inputs.iter().find(|set| set.index == index);
        set.map_or_else(|| gyro_model::to_f64(&input.value), |set| set.at(sample.t))
    };
    let mut values: Vec<f64> = model.inputs.iter().enumerate().map(value).collect();
    let controlled = start.controllers.iter().flat_map(|controller| &controller.inputs);
    let set =
        controlled.map(|(index, _)| *index).chain(start.contacts.iter().flat_map(Touch::inputs).copied());
    set.zip(&sample.controlled).for_each(|(index, value)| values[index] = *value);
    let of_paths = start.paths.iter().flat_map(|path| path.inputs_at(sample.t));
    of_paths.for_each(|(index, value)| values[index] = value);
    values
}

/// Unit of an input, from the first force whose strength it is; none is told of one that nothing uses.
pub(crate) fn input_unit(model: &Model, input: usize) -> &'static str {
    let is_it = |number: &Number| matches!(number, Number::Input { index, .. } if *index == input);
    let unit = |force: &Force| {
        let parts = force.kind.parts();
        let (name, _) = parts.numbers.iter().find(|(_, numbers)| numbers.iter().any(is_it))?;
        let unit = FORCE.kind(parts.word)?.key(name)?.unit()?;
        let unit = parts.on.map_or(unit, |(on, _)| unit_along(model, on, unit));
        Some(match unit {
            "N.m" => "N*m",
            "N.m.s/rad" => "N*m*s/rad",
            "N.s/m" => "N*s/m",
            unit => unit,
        })
    };
    model.forces.iter().find_map(unit).unwrap_or("1")
}

/// The unit along a coordinate: of an angle it is the first of two.
fn unit_along(model: &Model, on: JointCoordinate, unit: &'static str) -> &'static str {
    let (angular, linear) = unit.split_once(" or ").unwrap_or((unit, unit));
    if model.coordinate_kind(on).is_angle() { angular } else { linear }
}

/// The table of a run, in a fixed order: time, inputs, joints, outputs, free bodies, energy, violations, charts.
pub(crate) fn columns(model: &Model, start: &Start, samples: &[Sample]) -> Vec<Column> {
    let mut table = Table { samples, columns: Vec::new() };
    table.add("t", "s", |s| s.t);
    table.add_inputs(model, start);
    for (index, coordinate) in coordinates(model).iter().enumerate() {
        table.add_coordinate(index, coordinate);
    }
    table.add_outputs(model);
    for (index, (_, name)) in observed(model).iter().enumerate() {
        table.add_body(index, name);
    }
    table.add("kinetic energy", "J", |s| s.kinetic);
    table.add("potential energy", "J", |s| s.potential);
    table.add("energy", "J", Sample::energy);
    if model.has_work() {
        table.add("work", "J", |s| s.work);
    }
    if let Some(first) = samples.first() {
        table.add("energy error", "J", |s| energy_error(first, s));
    }
    table.add("constraint violation", "1", |s| s.position_violation);
    table.add("velocity violation", "1/s", |s| s.velocity_violation);
    table.add("norm violation", "1", |s| s.norm_violation);
    #[expect(clippy::cast_precision_loss, reason = "a count")]
    table.add("chart switches", "1", |s| s.chart_switches as f64);
    table.columns
}

/// The table as text: 17 significant digits, so that every number reads back as it was.
pub(crate) fn text(columns: &[Column]) -> String {
    let header: Vec<String> = columns.iter().map(|c| format!("{} [{}]", c.name, c.unit)).collect();
    let mut text = header.join(",");
    text.push('\n');
    for row in 0..columns.first().map_or(0, |c| c.values.len()) {
        for (index, column) in columns.iter().enumerate() {
            let comma = if index == 0 { "" } else { "," };
            let _ = write!(text, "{comma}{:.16e}", column.values[row]);
        }
        text.push('\n');
    }
    text
}

struct Table<'a> {
    samples: &'a [Sample],
    columns: Vec<Column>,
}

impl Table<'_> {
    fn add(&mut self, name: &str, unit: &'static str, value: impl Fn(&Sample) -> f64) {
        let values = self.samples.iter().map(value).collect();
        self.columns.push(Column { name: name.to_owned(), unit, values });
    }

    /// By their names; what has the name of a joint, an output or a body is called an input.
    fn add_inputs(&mut self, model: &Model, start: &Start) {
        let joints = model.joints.iter().map(|joint| &joint.name);
        let taken: Vec<&String> = joints.chain(model.outputs.iter().map(|output| &output.name)).collect();
        let shown = |index: &usize| paths::moving(model, *index).is_none();
        for index in (0..model.inputs.len()).filter(shown) {
            let name = &model.inputs[index].name;
            let name = if taken.contains(&name) { format!("input {name}") } else { name.clone() };
            self.add(&name, input_unit(model, index), |s| inputs_at(model, start, s)[index]);
        }
    }

    fn add_coordinate(&mut self, index: usize, shown: &Shown) {
        let name = &shown.name;
        if shown.kind.is_some() {
            self.add(name, shown.unit(), |s| scalar(&s.coordinates[index]).0);
            self.add(&format!("{name} rate"), shown.rate_unit(), |s| scalar(&s.coordinates[index]).1);
            return;
        }
        for k in 0..4 {
            self.add(&format!("{name} e{k}"), "1", |s| orientation(&s.coordinates[index]).0[k]);
        }
        for (k, axis) in AXES.iter().enumerate() {
            let name = format!("{name} rate {axis}");
            self.add(&name, "rad/s", |s| orientation(&s.coordinates[index]).1[k]);
        }
    }

    fn add_outputs(&mut self, model: &Model) {
        for (index, (name, unit)) in outputs(model).into_iter().enumerate() {
            self.add(&name, if unit.is_empty() { "1" } else { unit }, |s| s.outputs[index]);
        }
    }

    fn add_body(&mut self, body: usize, name: &str) {
        for (k, axis) in AXES.iter().enumerate() {
            self.add(&format!("{name} {axis}"), "m", |s| s.bodies[body].pose[k]);
        }
        for k in 0..4 {
            self.add(&format!("{name} e{k}"), "1", |s| s.bodies[body].pose[3 + k]);
        }
        for (k, axis) in AXES.iter().enumerate() {
            self.add(&format!("{name} velocity {axis}"), "m/s", |s| s.bodies[body].velocity[k]);
        }
        for (k, axis) in AXES.iter().enumerate() {
            let name = format!("{name} angular velocity {axis}'");
            self.add(&name, "rad/s", |s| s.bodies[body].velocity[3 + k]);
        }
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];

/// A scalar coordinate and its rate.
pub(crate) fn scalar(coordinate: &JointSample) -> (f64, f64) {
    match coordinate {
        JointSample::Angle { position, rate } | JointSample::Length { position, rate } => (*position, *rate),
        JointSample::Orientation { .. } => (f64::NAN, f64::NAN),
    }
}

/// Euler parameters and angular velocity of a spherical joint.
pub(crate) fn orientation(coordinate: &JointSample) -> ([f64; 4], [f64; 3]) {
    match coordinate {
        JointSample::Orientation { position, rate } => (*position, *rate),
        JointSample::Angle { .. } | JointSample::Length { .. } => ([f64::NAN; 4], [f64::NAN; 3]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_back_as_they_were() {
        let awkward = vec![0.1, -1.0 / 3.0, 5e-324, f64::MAX, 0.0, 123_456_789.123_456_78];
        let columns = [
            Column { name: "t".to_owned(), unit: "s", values: awkward.clone() },
            Column { name: "alpha rate".to_owned(), unit: "rad/s", values: awkward.clone() },
        ];
        let text = text(&columns);
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("t [s],alpha rate [rad/s]"));
        for (line, value) in lines.zip(awkward) {
            for cell in line.split(',') {
                assert_eq!(cell.parse::<f64>().unwrap().to_bits(), value.to_bits());
            }
        }
    }
}
