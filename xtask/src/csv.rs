//! Samples as a table of named columns with units.

use gyro_model::{JointKind, Model};
use gyro_runner::{JointSample, Sample, energy_error};
use std::fmt::Write as _;

use crate::scene::observed;

/// A quantity that every sample has.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Column {
    pub(crate) name: String,
    pub(crate) unit: &'static str,
    pub(crate) values: Vec<f64>,
}

/// The table of a run, in a fixed order: time, joints, free bodies, energy, violations, charts.
pub(crate) fn columns(model: &Model, samples: &[Sample]) -> Vec<Column> {
    let mut table = Table { samples, columns: Vec::new() };
    table.add("t", "s", |s| s.t);
    for (index, joint) in model.joints.iter().enumerate() {
        table.add_joint(index, &joint.name, joint.kind);
    }
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

    fn add_joint(&mut self, joint: usize, name: &str, kind: JointKind) {
        match kind {
            JointKind::Revolute => {
                self.add(name, "rad", |s| angle(&s.joints[joint]).0);
                self.add(&format!("{name} rate"), "rad/s", |s| angle(&s.joints[joint]).1);
            }
            JointKind::Spherical => {
                for k in 0..4 {
                    self.add(&format!("{name} e{k}"), "1", |s| orientation(&s.joints[joint]).0[k]);
                }
                for (k, axis) in AXES.iter().enumerate() {
                    let name = format!("{name} rate {axis}");
                    self.add(&name, "rad/s", |s| orientation(&s.joints[joint]).1[k]);
                }
            }
            JointKind::Fixed => {}
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

/// Angle and rate of a revolute joint.
pub(crate) fn angle(joint: &JointSample) -> (f64, f64) {
    match joint {
        JointSample::Angle { position, rate } => (*position, *rate),
        JointSample::Orientation { .. } | JointSample::None => (f64::NAN, f64::NAN),
    }
}

/// Euler parameters and angular velocity of a spherical joint.
pub(crate) fn orientation(joint: &JointSample) -> ([f64; 4], [f64; 3]) {
    match joint {
        JointSample::Orientation { position, rate } => (*position, *rate),
        JointSample::Angle { .. } | JointSample::None => ([f64::NAN; 4], [f64::NAN; 3]),
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
