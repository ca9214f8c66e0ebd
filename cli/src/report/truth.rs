//! The motion that errors are counted from.

use crate::columns;
use gyro_model::{CoordinateKind, Model};
use gyro_reference::{JointRow, SceneReference};
use gyro_runner::{JointSample, Sample};

/// Intervals between the times at which runs are compared.
pub(crate) const INTERVALS: u64 = 100;

/// The coordinates of a mechanism at one time: scalars, then rotations.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Row {
    scalars: Vec<f64>,
    rotations: Vec<[[f64; 3]; 3]>,
}

/// The motion at evenly spaced times, and how errors are counted.
#[derive(Clone, Debug)]
pub(crate) struct Truth {
    /// Where it comes from, in words.
    pub(crate) source: String,
    /// Whether it is independent of all that is judged by it.
    pub(crate) is_independent: bool,
    /// Smaller errors are not known.
    floor: f64,
    rows: Vec<Row>,
    /// Names of the coordinates, scalars first.
    pub(crate) names: Vec<String>,
    /// Which of them are judged.
    pub(crate) is_judged: Vec<bool>,
    /// What an error is divided by: 1 rad or m, or the largest motion where that is small.
    pub(crate) scale: f64,
}

/// Angles that go further are left out where there are others: their errors grow with the turns.
const FAR: f64 = 6.0 * std::f64::consts::PI;

/// Where nothing moves further, errors are relative to the largest motion, rad or m.
const SMALL: f64 = 1e-2;

/// `INTERVALS + 1` times.
pub(crate) fn times(t_end: f64) -> Vec<f64> {
    (0..=INTERVALS).map(|k| t_end * k as f64 / INTERVALS as f64).collect()
}

impl Truth {
    /// From the reference solution of a shipped model file.
    pub(crate) fn of_reference(model: &Model, reference: &SceneReference, t_end: f64) -> Self {
        let rows = reference.solve(&times(t_end)).iter().map(of_reference).collect();
        let source = "the reference solution of this scene (`gyro_reference::scene`): minimal coordinates, derived by hand and integrated in \
                      106 bits apart from everything else";
        Self::new(model, source.to_owned(), 0.0, rows)
    }

    /// From a run whose own error is about `floor`.
    pub(crate) fn of_samples(model: &Model, (source, floor): (String, f64), samples: &[Sample]) -> Self {
        Self::new(model, source, floor, samples.iter().map(of_sample).collect())
    }

    fn new(model: &Model, source: String, floor: f64, rows: Vec<Row>) -> Self {
        let names = names(model);
        let ranges: Vec<f64> = (0..names.len()).map(|k| range(&rows, k)).collect();
        let kinds = columns::coordinates(model);
        let is_angle = |k: usize| {
            let scalars = kinds.iter().filter_map(|shown| shown.kind);
            scalars.map(CoordinateKind::is_angle).nth(k).unwrap_or(false)
        };
        let mut is_judged: Vec<bool> = (0..names.len()).map(|k| !is_angle(k) || ranges[k] <= FAR).collect();
        // What does not move at all is no reason to leave the rest out.
        if !is_judged.iter().zip(&ranges).any(|(is_judged, range)| *is_judged && *range > 0.0) {
            is_judged.fill(true);
        }
        let judged = ranges.iter().zip(&is_judged).filter(|(_, is_judged)| **is_judged);
        let largest = judged.map(|(range, _)| *range).fold(0.0, f64::max);
        let scale = if largest > SMALL || largest == 0.0 { 1.0 } else { largest };
        Self { source, is_independent: floor == 0.0, floor, rows, names, is_judged, scale }
    }

    /// The worst error of each coordinate over samples of a run that has ended at `t_end`; each falls on one of the
    /// times.
    pub(crate) fn errors(&self, samples: &[Sample], t_end: f64) -> Vec<f64> {
        let mut worst = vec![0.0_f64; self.names.len()];
        for sample in samples {
            let index = (sample.t / t_end * INTERVALS as f64).round() as usize;
            let Some(row) = self.rows.get(index) else { continue };
            for (worst, error) in worst.iter_mut().zip(differences(&of_sample(sample), row)) {
                // What is not a number is the worst.
                *worst = if error.is_nan() { f64::INFINITY } else { worst.max(error) };
            }
        }
        worst
    }

    /// The error that is shown, from those of all coordinates.
    pub(crate) fn judge(&self, errors: &[f64]) -> f64 {
        let judged = errors.iter().zip(&self.is_judged).filter(|(_, is_judged)| **is_judged);
        judged.map(|(error, _)| *error).fold(self.floor * self.scale, f64::max) / self.scale
    }

    /// How errors are counted, in words.
    pub(crate) fn measure(&self) -> String {
        let list = |wanted: bool| {
            let names = self.names.iter().zip(&self.is_judged).filter(|(_, is_judged)| **is_judged == wanted);
            names.map(|(name, _)| format!("`{name}`")).collect::<Vec<_>>().join(", ")
        };
        let mut words = format!("the largest of {} at {INTERVALS} times", list(true));
        if self.scale != 1.0 {
            words += &format!(", divided by the largest motion, {}", crate::words::number(self.scale, 3));
        } else {
            words += ", in rad or m";
        }
        let others = list(false);
        if !others.is_empty() {
            words += &format!(
                "; {others} makes more than three turns and is left out (its error is in the CSV file)"
            );
        }
        words
    }
}

fn names(model: &Model) -> Vec<String> {
    let shown = columns::coordinates(model);
    let bodies = crate::scene::observed(model);
    let axes = ["x", "y", "z"];
    let scalars = shown.iter().filter(|shown| shown.kind.is_some()).map(|shown| shown.name.clone());
    let positions = bodies.iter().flat_map(|(_, name)| axes.iter().map(move |axis| format!("{name}.{axis}")));
    let rotations = shown.iter().filter(|shown| shown.kind.is_none()).map(|shown| shown.name.clone());
    let turned = bodies.iter().map(|(_, name)| format!("{name}.orientation"));
    scalars.chain(positions).chain(rotations).chain(turned).collect()
}

fn of_reference(row: &JointRow) -> Row {
    let rotations = row.orientations.iter().map(|orientation| orientation.rotation).collect();
    Row { scalars: row.positions.clone(), rotations }
}

fn of_sample(sample: &Sample) -> Row {
    let (mut scalars, mut rotations) = (Vec::new(), Vec::new());
    for coordinate in &sample.coordinates {
        match coordinate {
            JointSample::Angle { position, .. } | JointSample::Length { position, .. } => {
                scalars.push(*position)
            }
            JointSample::Orientation { position, .. } => rotations.push(rotation(*position)),
        }
    }
    for body in &sample.bodies {
        let [x, y, z, e0, e1, e2, e3] = body.pose;
        scalars.extend([x, y, z]);
        rotations.push(rotation([e0, e1, e2, e3]));
    }
    Row { scalars, rotations }
}

/// Eq. (3).
fn rotation([e0, e1, e2, e3]: [f64; 4]) -> [[f64; 3]; 3] {
    [
        [2.0 * (e0 * e0 + e1 * e1) - 1.0, 2.0 * (e1 * e2 - e0 * e3), 2.0 * (e1 * e3 + e0 * e2)],
        [2.0 * (e1 * e2 + e0 * e3), 2.0 * (e0 * e0 + e2 * e2) - 1.0, 2.0 * (e2 * e3 - e0 * e1)],
        [2.0 * (e1 * e3 - e0 * e2), 2.0 * (e2 * e3 + e0 * e1), 2.0 * (e0 * e0 + e3 * e3) - 1.0],
    ]
}

fn differences<'a>(found: &'a Row, expected: &'a Row) -> impl Iterator<Item = f64> + 'a {
    let scalars = found.scalars.iter().zip(&expected.scalars).map(|(a, b)| (a - b).abs());
    scalars.chain(found.rotations.iter().zip(&expected.rotations).map(|(a, b)| between(a, b)))
}

/// Twice the sine of half the angle between two rotations: ‖A − B‖ is √8 times that sine.
fn between(a: &[[f64; 3]; 3], b: &[[f64; 3]; 3]) -> f64 {
    let square: f64 = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b) * (a - b)).sum();
    (0.5 * square).sqrt()
}

/// How far a coordinate goes from zero; of rotations, from their start.
fn range(rows: &[Row], k: usize) -> f64 {
    let n_scalars = rows.first().map_or(0, |row| row.scalars.len());
    let of = |row: &Row| match k.checked_sub(n_scalars) {
        None => row.scalars[k].abs(),
        Some(k) => row.rotations.get(k).map_or(0.0, |turned| between(turned, &rows[0].rotations[k])),
    };
    rows.iter().map(of).fold(0.0, f64::max)
}

#[cfg(test)]
mod tests;
