//! What inputs are over time.

use gyro_sim::{Mechanism, Scalar};
use nanoserde::{DeBin, SerBin};

/// What one of the mechanism's inputs is over time: the rows of a table with what is between them, and held beyond its
/// ends; or a motion that goes through the rows, and on straight beyond its ends, with its rate or its acceleration. A
/// table of one row is a constant.
///
/// Under error control equations see the input at every time, and steps end where it is not smooth. Each step of fixed
/// length has the value at its own start, held over the step, as a sampled controller gives it. Each sample has the
/// value at its own time.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub struct Input {
    /// Index among the mechanism's inputs.
    pub index: usize,
    /// Time, s, and value; times ascend.
    pub rows: Vec<[f64; 2]>,
    /// What is between the rows.
    pub between: Between,
    /// Second derivatives at the rows of a smooth input.
    bends: Vec<f64>,
    /// Of a motion, which derivative it is.
    order: Option<u8>,
}

/// What an input is between the rows of its table.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, SerBin, DeBin)]
pub enum Between {
    /// The value of the row before.
    Held,
    /// Straight lines.
    #[default]
    Linear,
    /// The natural cubic spline through the rows.
    Smooth,
}

impl Input {
    /// An input that follows a table.
    pub fn new(index: usize, rows: Vec<[f64; 2]>, between: Between) -> Self {
        let bends = if between == Between::Smooth { bends(&rows) } else { Vec::new() };
        Self { index, rows, between, bends, order: None }
    }

    /// A motion along the smooth curve through some rows, by the inputs of its value, its rate and its acceleration.
    pub fn motion(inputs: [usize; 3], rows: &[[f64; 2]]) -> [Self; 3] {
        let whole = Self::new(inputs[0], rows.to_vec(), Between::Smooth);
        [0, 1, 2].map(|order: u8| Self {
            index: inputs[usize::from(order)],
            order: Some(order),
            ..whole.clone()
        })
    }

    /// An input that does not change.
    pub fn constant(index: usize, value: f64) -> Self {
        Self::new(index, vec![[0.0, value]], Between::Linear)
    }

    /// The value at a time, at a row that of the row; zero for an empty table.
    pub fn at(&self, t: f64) -> f64 {
        if self.order.is_some() {
            let (origin, coefficients) = self.piece(t);
            return cubic(&coefficients, t - origin);
        }
        let after = self.rows.partition_point(|[time, _]| *time <= t);
        match (after.checked_sub(1).and_then(|before| self.rows.get(before)), self.rows.get(after)) {
            (Some([t0, before]), Some([t1, after])) if self.between == Between::Linear => {
                before + (after - before) * ((t - t0) / (t1 - t0))
            }
            (Some(_), Some(_)) => {
                let (origin, coefficients) = self.piece(t);
                cubic(&coefficients, t - origin)
            }
            (Some([_, value]), None) | (None, Some([_, value])) => *value,
            (None, None) => 0.0,
        }
    }

    /// The cubic `c0 + c1 u + c2 u² + c3 u³` that holds from a time on, to the next row, and the time from which its u
    /// counts.
    pub(crate) fn piece(&self, t: f64) -> (f64, [f64; 4]) {
        let Some(order) = self.order else { return self.piece_of_rows(t) };
        let (mut origin, mut coefficients) = self.piece_of_rows(t);
        if let [[first, _], .., [last, _]] = self.rows[..]
            && !(first..last).contains(&t)
        {
            // Straight on, as the curve is not bent at its ends.
            let (end, width) =
                if t < first { (first, 0.0) } else { (last, last - self.rows[self.rows.len() - 2][0]) };
            let (_, [c0, c1, c2, c3]) =
                self.piece_of_rows(if t < first { first } else { self.rows[self.rows.len() - 2][0] });
            let slope = c1 + width * (2.0 * c2 + width * (3.0 * c3));
            (origin, coefficients) = (end, [cubic(&[c0, c1, c2, c3], width), slope, 0.0, 0.0]);
        }
        for _ in 0..order {
            let [_, c1, c2, c3] = coefficients;
            coefficients = [c1, 2.0 * c2, 3.0 * c3, 0.0];
        }
        (origin, coefficients)
    }

    fn piece_of_rows(&self, t: f64) -> (f64, [f64; 4]) {
        let after = self.rows.partition_point(|[time, _]| *time <= t);
        let Some((from, [t1, to])) = after.checked_sub(1).zip(self.rows.get(after)) else {
            let held = if after == 0 { self.rows.first() } else { self.rows.last() };
            return (t, [held.map_or(0.0, |row| row[1]), 0.0, 0.0, 0.0]);
        };
        let [t0, value] = self.rows[from];
        let (width, rise) = (t1 - t0, to - value);
        let coefficients = match self.between {
            Between::Held => [value, 0.0, 0.0, 0.0],
            Between::Linear => [value, rise / width, 0.0, 0.0],
            Between::Smooth => {
                let (bend, next) = (self.bends[from], self.bends[after]);
                let slope = rise / width - width * (2.0 * bend + next) / 6.0;
                [value, slope, 0.5 * bend, (next - bend) / (6.0 * width)]
            }
        };
        (t0, coefficients)
    }

    /// The times at which the input is not smooth: rows at which nothing changes are left out.
    pub(crate) fn knots(&self) -> impl Iterator<Item = f64> {
        let times = self.rows.iter().map(|[t, _]| *t);
        let pieces = times.clone().map(|t| self.piece(t).1);
        let before = std::iter::once([self.rows.first().map_or(0.0, |row| row[1]), 0.0, 0.0, 0.0]);
        let changes = pieces.clone().zip(before.chain(pieces)).map(|(after, before)| match self.between {
            Between::Held => after[0] != before[0],
            Between::Linear => after[1] != before[1],
            Between::Smooth => true,
        });
        times.zip(changes).filter_map(|(t, changes)| changes.then_some(t)).filter(|_| varies(self))
    }

    /// The rows, and of a smooth input the extremes between them.
    pub fn extremes(&self) -> Vec<[f64; 2]> {
        let mut rows = self.rows.clone();
        for pair in self.rows.windows(2).filter(|_| self.between == Between::Smooth) {
            let (origin, [c0, c1, c2, c3]) = self.piece(pair[0][0]);
            // c1 + 2 c2 u + 3 c3 u² = 0, without cancellation.
            let discriminant = c2 * c2 - 3.0 * c1 * c3;
            let sum = -(c2 + discriminant.max(0.0).sqrt().copysign(c2));
            let turns = [sum / (3.0 * c3), c1 / sum].into_iter().filter(|_| discriminant >= 0.0);
            let inside = turns.filter(|u| *u > 0.0 && origin + u < pair[1][0]);
            rows.extend(inside.map(|u| [origin + u, cubic(&[c0, c1, c2, c3], u)]));
        }
        rows
    }
}

fn cubic([c0, c1, c2, c3]: &[f64; 4], u: f64) -> f64 {
    c0 + u * (c1 + u * (c2 + u * c3))
}

/// The second derivatives of the natural cubic spline at its knots: a tridiagonal system, diagonally dominant (de Boor,
/// *A Practical Guide to Splines*, chapter IV).
fn bends(rows: &[[f64; 2]]) -> Vec<f64> {
    let mut bends = vec![0.0; rows.len()];
    let mut ratios = bends.clone();
    let slope = |k: usize| (rows[k + 1][1] - rows[k][1]) / (rows[k + 1][0] - rows[k][0]);
    for k in 1..rows.len().saturating_sub(1) {
        let (before, after) = (rows[k][0] - rows[k - 1][0], rows[k + 1][0] - rows[k][0]);
        let pivot = 2.0 * (before + after) - before * ratios[k - 1];
        ratios[k] = after / pivot;
        bends[k] = (6.0 * (slope(k) - slope(k - 1)) - before * bends[k - 1]) / pivot;
    }
    for k in (1..rows.len().saturating_sub(1)).rev() {
        bends[k] -= ratios[k] * bends[k + 1];
    }
    bends
}

fn varies(input: &Input) -> bool {
    input.rows.windows(2).any(|pair| pair[0][1] != pair[1][1])
}

/// Whether any input changes.
pub fn any_varies(inputs: &[Input]) -> bool {
    inputs.iter().any(varies)
}

/// Sets all inputs to their values at a time.
pub(crate) fn set<M: Mechanism>(mechanism: &mut M, inputs: &[Input], t: f64) {
    for input in inputs {
        mechanism.set_input(input.index, M::Scalar::constant(input.at(t)));
    }
}

#[cfg(test)]
mod tests;
