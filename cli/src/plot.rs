//! The plots of a run: joints, outputs, residuals, energy.

pub(crate) mod axis;
mod decimate;
mod draw;

use crate::columns::{self, Shown, orientation, scalar};
use crate::scene::observed;
use axis::Scale;
use draw::{Page, Panel, Series};
use gyro_model::Model;
use gyro_runner::{Sample, energy_error};

/// The names of the pages.
pub(crate) const NAMES: [&str; 4] = ["motion", "outputs", "residuals", "energy"];

/// Name and SVG text of each plot.
pub(crate) fn pages(model: &Model, samples: &[Sample]) -> Result<Vec<(&'static str, String)>, String> {
    let [motion, outputs, residuals, energy] = NAMES;
    let all = Samples { model, samples };
    let mut pages = Vec::new();
    for (name, rows) in [(motion, all.motion()), (outputs, all.outputs())] {
        if !rows.is_empty() {
            let title = format!("{}: {name}", model.name);
            pages.push((name, draw::svg(&Page { title, rows })?));
        }
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
    /// A row for each joint coordinate and for each free body: positions to the left, rates to the right.
    fn motion(&self) -> Vec<Vec<Panel>> {
        let mut rows = Vec::new();
        for (index, shown) in columns::coordinates(self.model).iter().enumerate() {
            rows.push(if shown.kind.is_some() {
                self.scalar(index, shown)
            } else {
                self.orientation(index, &shown.name)
            });
        }
        for (b, (_, name)) in observed(self.model).iter().enumerate() {
            rows.extend(self.body(b, name));
        }
        rows
    }

    fn scalar(&self, index: usize, shown: &Shown) -> Vec<Panel> {
        let (name, rate) = (&shown.name, format!("{} rate", shown.name));
        vec![
            self.panel(name, shown.unit(), vec![self.series("", |s| scalar(&s.coordinates[index]).0)]),
            self.panel(&rate, shown.rate_unit(), vec![self.series("", |s| scalar(&s.coordinates[index]).1)]),
        ]
    }

    fn orientation(&self, index: usize, name: &str) -> Vec<Panel> {
        let (parameters, rate) = (format!("{name}: Euler parameters"), format!("{name} rate"));
        vec![
            self.panel(&parameters, "", self.many(&EULER, |s, k| orientation(&s.coordinates[index]).0[k])),
            self.panel(&rate, "rad/s", self.many(&AXES, |s, k| orientation(&s.coordinates[index]).1[k])),
        ]
    }

    /// A row for each output, a panel for each of its units.
    fn outputs(&self) -> Vec<Vec<Panel>> {
        let mut first = 0;
        let mut rows = Vec::new();
        for output in &self.model.outputs {
            let mut row: Vec<Panel> = Vec::new();
            for (suffix, unit) in columns::output_columns(self.model, output) {
                let series = self.series(suffix, |s| s.outputs[first]);
                first += 1;
                match row.last_mut().filter(|panel| panel.unit == unit) {
                    Some(panel) => panel.series.push(series),
                    None => row.push(self.panel(&output.name, unit, vec![series])),
                }
            }
            row.iter_mut().for_each(shorten);
            rows.push(row);
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

/// Moves what the names of all series begin with into the title: `force_f`, `force_g`, `force_h`.
fn shorten(panel: &mut Panel) {
    let Some((prefix, _)) = panel.series.first().and_then(|series| series.name.split_once('_')) else {
        return;
    };
    let rest: Option<Vec<&str>> =
        panel.series.iter().map(|series| series.name.strip_prefix(prefix)?.strip_prefix('_')).collect();
    if let Some(rest) = rest.filter(|rest| rest.len() > 1) {
        panel.title = format!("{}.{prefix}", panel.title);
        panel.series.iter_mut().zip(rest).for_each(|(series, name)| series.name = name);
    }
}

const AXES: [&str; 3] = ["x", "y", "z"];
const EULER: [&str; 4] = ["e0", "e1", "e2", "e3"];
