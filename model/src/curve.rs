//! Curves of one argument that formulas call: through rows of a table, or points of the model file.

use crate::{Model, Spline};

/// A curve with a name.
#[derive(Clone, Debug)]
pub struct Curve {
    /// Its name, which formulas call.
    pub name: String,
    /// Its pieces, with what it is beyond its ends.
    pub spline: Spline,
    /// What it is between its points.
    pub joined: Joined,
    /// What it is beyond its ends.
    pub beyond: Beyond,
    /// The first and the last argument.
    pub ends: [f64; 2],
}

/// What a curve is between its points.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Joined {
    /// The natural cubic spline, twice continuously differentiable.
    #[default]
    Smooth,
    /// Cubics that rise where the points do and fall where they do, with a continuous slope.
    Monotone,
    /// Straight lines.
    Linear,
    /// The value of the point before.
    Steps,
}

/// What a curve is beyond its ends.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Beyond {
    /// It goes on straight, with the slope that it has there.
    #[default]
    Line,
    /// It keeps the value that it has there.
    Hold,
    /// It has no value.
    Error,
}

impl Joined {
    /// All of them by the words of model files.
    pub const ALL: [(&str, Self); 4] = [
        ("smooth", Self::Smooth),
        ("monotone", Self::Monotone),
        ("linear", Self::Linear),
        ("steps", Self::Steps),
    ];
}

impl Beyond {
    /// All of them by the words of model files.
    pub const ALL: [(&str, Self); 3] = [("line", Self::Line), ("hold", Self::Hold), ("error", Self::Error)];
}

impl Curve {
    /// The curve through points `(argument, value)`.
    ///
    /// # Errors
    /// Says what is wrong with the points: fewer than two, arguments that do not ascend, numbers that are not finite or
    /// too far apart.
    pub fn through(
        (name, source): (String, String),
        points: &[(f64, f64)],
        joined: Joined,
        beyond: Beyond,
    ) -> Result<Self, String> {
        if let Some(row) = points.windows(2).position(|pair| pair[0].0 >= pair[1].0) {
            let (before, after) = (points[row].0, points[row + 1].0);
            return Err(format!("arguments must increase, but row {} has {after} after {before}", row + 2));
        }
        let (mut knots, mut pieces) = match joined {
            Joined::Smooth => {
                let Spline { knots, pieces, .. } = Spline::natural(String::new(), points)?;
                (knots, pieces)
            }
            _ => {
                // What is to be said of points is the same.
                Spline::natural(String::new(), points)?;
                let pieces = match joined {
                    Joined::Monotone => monotone(points),
                    Joined::Linear => points.windows(2).map(line).collect(),
                    _ => points.windows(2).map(|pair| [pair[0].1, 0.0, 0.0, 0.0]).collect(),
                };
                (points.iter().map(|point| point.0).collect(), pieces)
            }
        };
        let [first, last] = [points[0], points[points.len() - 1]];
        let width = last.0 - first.0;
        let is_flat = beyond == Beyond::Hold || joined == Joined::Steps;
        if is_flat || joined != Joined::Smooth {
            // Pieces hold from their knots on: at the last point that is what goes on from there.
            let [.., c1, c2, c3] = pieces[pieces.len() - 1];
            let u = last.0 - points[points.len() - 2].0;
            let slope = if is_flat { 0.0 } else { c1 + u * (2.0 * c2 + u * 3.0 * c3) };
            knots.push(last.0 + width);
            pieces.push([last.1, slope, 0.0, 0.0]);
        }
        if is_flat {
            knots.insert(0, first.0 - width);
            pieces.insert(0, [first.1, 0.0, 0.0, 0.0]);
        }
        if !knots.iter().chain(pieces.iter().flatten()).all(|number| number.is_finite()) {
            return Err("neighbouring rows are too close or too far apart for a curve".to_owned());
        }
        let spline = Spline { source, knots, pieces };
        Ok(Self { name, spline, joined, beyond, ends: [first.0, last.0] })
    }

    /// The first and the last argument of a curve that has no value beyond them.
    pub fn domain(&self) -> Option<[f64; 2]> {
        (self.beyond == Beyond::Error).then_some(self.ends)
    }

    /// The arguments at which its value or its slope jumps.
    pub fn corners(&self) -> Vec<f64> {
        let knots =
            self.spline.knots.iter().copied().filter(|knot| (self.ends[0]..=self.ends[1]).contains(knot));
        let is_end = |knot: &f64| self.ends.contains(knot);
        match (self.joined, self.beyond) {
            (Joined::Steps, _) | (Joined::Linear, Beyond::Hold) => knots.collect(),
            (Joined::Linear, _) => knots.filter(|knot| !is_end(knot)).collect(),
            (_, Beyond::Hold) => self.ends.to_vec(),
            _ => Vec::new(),
        }
    }

    /// Whether it has two continuous derivatives wherever it has a value.
    pub fn is_smooth(&self) -> bool {
        self.joined == Joined::Smooth && self.beyond != Beyond::Hold
    }
}

impl Model {
    /// The curve of a name.
    pub fn curve(&self, name: &str) -> Option<&Curve> {
        self.curves.iter().find(|curve| curve.name == name)
    }
}

/// The straight line between two points.
fn line(pair: &[(f64, f64)]) -> [f64; 4] {
    [pair[0].1, (pair[1].1 - pair[0].1) / (pair[1].0 - pair[0].0), 0.0, 0.0]
}

/// Cubics that keep what the points do (F. N. Fritsch and J. Butland, SIAM J. Sci. Stat. Comput. 5 (1984)): the slope
/// at a point is zero where the chords beside it differ in sign, and else their weighted harmonic mean, so that no
/// cubic leaves the region of F. N. Fritsch and R. E. Carlson, SIAM J. Numer. Anal. 17 (1980).
fn monotone(points: &[(f64, f64)]) -> Vec<[f64; 4]> {
    let widths: Vec<f64> = points.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
    let chords: Vec<f64> = points.windows(2).map(|pair| line(pair)[1]).collect();
    let last = chords.len() - 1;
    let inner = |k: usize| {
        let [before, after] = [chords[k - 1], chords[k]];
        if before == 0.0 || after == 0.0 || (before > 0.0) != (after > 0.0) {
            return 0.0;
        }
        let [first, second] = [2.0 * widths[k] + widths[k - 1], widths[k] + 2.0 * widths[k - 1]];
        (first + second) / (first / before + second / after)
    };
    let end = |at: usize, next: usize| {
        let ([h, h_next], [chord, chord_next]) = ([widths[at], widths[next]], [chords[at], chords[next]]);
        let slope = ((2.0 * h + h_next) * chord - h * chord_next) / (h + h_next);
        if chord == 0.0 || (slope > 0.0) != (chord > 0.0) {
            0.0
        } else if (chord > 0.0) != (chord_next > 0.0) && slope.abs() > 3.0 * chord.abs() {
            3.0 * chord
        } else {
            slope
        }
    };
    let slope = |k: usize| match k {
        _ if last == 0 => chords[0],
        0 => end(0, 1),
        k if k > last => end(last, last - 1),
        k => inner(k),
    };
    let piece = |k: usize| {
        let (h, chord, [from, to]) = (widths[k], chords[k], [slope(k), slope(k + 1)]);
        [points[k].1, from, (3.0 * chord - 2.0 * from - to) / h, (from + to - 2.0 * chord) / (h * h)]
    };
    (0..=last).map(piece).collect()
}

#[cfg(test)]
mod tests;
