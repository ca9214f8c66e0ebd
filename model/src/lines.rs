//! Straight lines through the rows of a table: a motion whose velocity jumps.

use crate::scalar::Scalar;

/// A motion along straight lines through given points, on beyond the first and the last one.
///
/// Where the slope changes, at a *kink*, the velocity of the motion jumps: an impact. Between two kinks the motion is
/// `x + v (t − t0) + ½ a (t − t0)²` with an acceleration a of zero. These four numbers are inputs of the model, which
/// a run sets at each kink; by the acceleration it asks how the mechanism answers.
#[derive(Clone, Debug, PartialEq)]
pub struct Lines {
    /// Where the table was read, for messages and documentation.
    pub source: String,
    /// Times, s, ascending, and values. At least two.
    pub rows: Vec<[f64; 2]>,
    /// Indices into [`crate::Model::inputs`] of t0, x, v and a.
    pub inputs: [usize; 4],
}

impl Lines {
    /// The straight lines through these points; the inputs are not known yet.
    ///
    /// # Errors
    /// Says what is wrong with the points: a slope that cannot be computed.
    pub(crate) fn through(source: String, points: &[(f64, f64)]) -> Result<Self, String> {
        let rows: Vec<[f64; 2]> = points.iter().map(|&(t, x)| [t, x]).collect();
        let lines = Self { source, rows, inputs: [0; 4] };
        if lines.rows.windows(2).all(|pair| slope(pair).is_finite()) {
            Ok(lines)
        } else {
            Err("neighbouring rows are too close or too far apart for a line".to_owned())
        }
    }

    /// The line that holds from a time on: where it begins, s, its value there and its slope.
    pub fn piece(&self, t: f64) -> [f64; 3] {
        let after = self.rows.partition_point(|[time, _]| *time <= t).clamp(1, self.rows.len() - 1);
        let pair = &self.rows[after - 1..=after];
        [pair[0][0], pair[0][1], slope(pair)]
    }

    /// The motion over any scalar.
    pub(crate) fn at<D: Scalar>(&self, t: D) -> D {
        let [from, place, rate] = self.piece(t.re());
        (t - from) * rate + place
    }
}

fn slope(pair: &[[f64; 2]]) -> f64 {
    (pair[1][1] - pair[0][1]) / (pair[1][0] - pair[0][0])
}
