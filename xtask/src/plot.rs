//! The plots of a run: joints, residuals, energy.

mod axis;
mod decimate;
mod draw;

use crate::csv::{angle, orientation};
use crate::scene::observed;
use axis::Scale;
use draw::{Page, Panel, Series};
use gyro_model::{JointKind, Model};
use gyro_runner::{Sample, energy_error};

/// The names of the pages.
pub(crate) const NAMES: [&str; 3] = ["motion", "residuals", "energy"];

/// Name and SVG text of each plot.
pub(crate) fn pages(model: &Model, samples: &[Sample]) -> Result<Vec<(&'static str, String)>, String> {
    let [motion, residuals, energy] = NAMES;
    let all = Samples { model, samples };
    let mut pages = Vec::new();
    let rows = all.motion();
    if !rows.is_empty() {
        let title = format!("{}: motion", model.name);
        pages.push((motion, draw::svg(&Page { title, rows })?));
    }
    let title = format!("{}: residuals", model.name);
    pages.push((residuals, draw::svg(&Page { title, rows: all.residuals() })?));
    let title = format!("{}: energy since the start", model.name);
    pages.push((energy, draw::svg(&Page { title, rows: all.energy() })?));
    Ok(pages)
}

struct Samples<'a> {
    model: &'a Model,
    samples: &'a [Sample],
}

impl Samples<'_> {
    /// A row for each joint that moves and for each free body: positions to the left, rates to the right.
    fn motion(&self) -> Vec<Vec<Panel>> {
        let mut rows = Vec::new();
        for (j, joint) in self.model.joints.iter().enumerate() {
            let name = &joint.name;
            match joint.kind {
                JointKind::Revolute => rows.push(vec![
                    self.panel(name, "rad", vec![self.series("", |s| angle(&s.joints[j]).0)]),
                    self.panel(
                        &format!("{name} rate"),
                        "rad/s",
                        vec![self.series("", |s| angle(&s.joints[j]).1)],
                    ),
                ]),
                JointKind::Spherical => rows.push(vec![
                    self.panel(
                        &format!("{name}: Euler parameters"),
                        "",
                        self.many(&EULER, |s, k| orientation(&s.joints[j]).0[k]),
                    ),
                    self.panel(
                        &format!("{name} rate"),
                        "rad/s",
                        self.many(&AXES, |s, k| orientation(&s.joints[j]).1[k]),
                    ),
                ]),
                JointKind::Fixed => {}
            }
        }
        for (b, (_, name)) in observed(self.model).iter().enumerate() {
            rows.extend(self.body(b, name));
        }
        rows
    }

    fn body(&self, b: usize, name: &str) -> [Vec<Panel>; 2] {
        let titled = |what: &str| format!("{name}: {what}");
        [
            vec![
                self.panel(&titled("position"), "m", self.many(&AXES, |s, k| s.bodies[b].pose[k])),
                self.panel(&titled("velocity"), "m/s", self.many(&AXES, |s, k| s.bodies[b].velocity[k])),
            ],
            vec![
                self.panel(
                    &titled("Euler parameters"),
                    "",
                    self.many(&EULER, |s, k| s.bodies[b].pose[3 + k]),
                ),
                self.panel(
                    &titled("angular velocity w'"),
                    "rad/s",
                    self.many(&AXES, |s, k| s.bodies[b].velocity[3 + k]),
                ),
            ],
        ]
    }

    fn residuals(&self) -> Vec<Vec<Panel>> {
        let panel = |title: &str, unit, value: fn(&Sample) -> f64| {
            let series = self.series("", value);
            let remark = if series.values.iter().all(|v| *v == 0.0) { ": exactly zero" } else { "" };
            vec![Panel { scale: Scale::Log, ..self.panel(&format!("{title}{remark}"), unit, vec![series]) }]
        };
        vec![
            panel("constraint violation, lengths over the mechanism's size", "", |s| s.position_violation),
            panel("velocity violation, lengths over the mechanism's size", "1/s", |s| s.velocity_violation),
        ]
    }

    fn energy(&self) -> Vec<Vec<Panel>> {
        let Some(first) = self.samples.first() else { return Vec::new() };
        let mut parts = vec![
            self.series("kinetic", |s| s.kinetic - first.kinetic),
            self.series("potential", |s| s.potential - first.potential),
        ];
        let mut drift = "drift: kinetic + potential";
        if self.model.has_work() {
            parts.push(self.series("work", |s| s.work - first.work));
            drift = "drift: kinetic + potential − work";
        }
        let error = vec![self.series("", |s| energy_error(first, s))];
        vec![vec![self.panel("exchange", "J", parts)], vec![self.panel(drift, "J", error)]]
    }

    fn panel(&self, title: &str, unit: &'static str, series: Vec<Series>) -> Panel {
        let times = self.samples.iter().map(|s| s.t).collect();
        Panel { title: title.to_owned(), unit, scale: Scale::Linear, times, series }
    }

    fn series(&self, name: &'static str, value: impl Fn(&Sample) -> f64) -> Series {
        Series { name, values: self.samples.iter().map(value).collect() }
    }

    fn many(&self, names: &[&'static str], value: impl Fn(&Sample, usize) -> f64) -> Vec<Series> {
        names.iter().enumerate().map(|(k, name)| self.series(name, |s| value(s, k))).collect()
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];
const EULER: [&str; 4] = ["e0", "e1", "e2", "e3"];
