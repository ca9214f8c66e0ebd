//! A smooth curve through the rows of a table: the natural cubic spline.

use num_dual::Dual2_64;

use crate::scalar::Scalar;

/// Natural cubic spline through given points: twice continuously differentiable, also where it goes on as a straight
/// line before the first and after the last point (its second derivative is zero there).
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    /// Where the table was read, for messages and documentation.
    pub source: String,
    /// Times of the points, ascending, s. At least two.
    pub knots: Vec<f64>,
    /// For each interval between knots `[c0, c1, c2, c3]`: value `c0 + c1 u + c2 u² + c3 u³`, `u` from the interval's
    /// first knot. The straight lines beyond the ends are not listed.
    pub pieces: Vec<[f64; 4]>,
}

impl Spline {
    /// The natural cubic spline through points `(time, value)`.
    ///
    /// The second derivatives at the knots solve the tridiagonal system of continuous slopes (de Boor, *A Practical
    /// Guide to Splines*, chapter IV), which is diagonally dominant, so it is solved without pivoting.
    ///
    /// # Errors
    /// Says what is wrong with the points: fewer than two, times that do not ascend, numbers that are not finite.
    pub fn natural(source: String, points: &[(f64, f64)]) -> Result<Self, String> {
        if points.len() < 2 {
            return Err(format!("{} rows are too few for a curve: at least two are needed", points.len()));
        }
        if let Some(row) = points.iter().position(|(t, x)| !t.is_finite() || !x.is_finite()) {
            return Err(format!("row {} holds a number that is not finite", row + 1));
        }
        if let Some(row) = points.windows(2).position(|pair| pair[0].0 >= pair[1].0) {
            let (before, after) = (points[row].0, points[row + 1].0);
            return Err(format!("times must increase, but row {} has {after} s after {before} s", row + 2));
        }
        let curvature = curvatures(points);
        let piece = |(pair, bend): (&[(f64, f64)], &[f64])| {
            let (width, rise) = (pair[1].0 - pair[0].0, pair[1].1 - pair[0].1);
            let slope = rise / width - width * (2.0 * bend[0] + bend[1]) / 6.0;
            [pair[0].1, slope, 0.5 * bend[0], (bend[1] - bend[0]) / (6.0 * width)]
        };
        let pieces: Vec<_> = points.windows(2).zip(curvature.windows(2)).map(piece).collect();
        if !pieces.iter().flatten().all(|c| c.is_finite()) {
            return Err("neighbouring rows are too close or too far apart for a curve".to_owned());
        }
        Ok(Self { source, knots: points.iter().map(|p| p.0).collect(), pieces })
    }

    /// Value, first and second derivative at a time.
    pub fn value(&self, t: f64) -> [f64; 3] {
        let x = self.at(Dual2_64::from_re(t).derivative());
        [x.re, x.v1, x.v2]
    }

    /// Value, first, second and third derivative; the last is that of the piece that begins at a knot, and zero beyond
    /// the ends.
    pub fn jet(&self, t: f64) -> [f64; 4] {
        let [value, slope, bend] = self.value(t);
        let past = self.knots.partition_point(|&knot| knot <= t);
        let third =
            if (1..=self.pieces.len()).contains(&past) { 6.0 * self.pieces[past - 1][3] } else { 0.0 };
        [value, slope, bend, third]
    }

    /// The curve over any scalar.
    pub(crate) fn at<D: Scalar>(&self, t: D) -> D {
        let (first, last) = (self.knots[0], self.knots[self.pieces.len()]);
        let past = self.knots.partition_point(|&knot| knot <= t.re());
        let piece = past.clamp(1, self.pieces.len()) - 1;
        let [c0, c1, c2, c3] = self.pieces[piece];
        if t.re() < first {
            return (t - first) * c1 + c0;
        }
        if t.re() > last {
            let u = last - self.knots[piece];
            let (value, slope) = (c0 + u * (c1 + u * (c2 + u * c3)), c1 + u * (2.0 * c2 + u * 3.0 * c3));
            return (t - last) * slope + value;
        }
        let u = t - self.knots[piece];
        ((u * c3 + c2) * u + c1) * u + c0
    }
}

/// Second derivatives at the points, zero at both ends: elimination and back substitution.
fn curvatures(points: &[(f64, f64)]) -> Vec<f64> {
    let n = points.len();
    let width = |k: usize| points[k + 1].0 - points[k].0;
    let slope = |k: usize| (points[k + 1].1 - points[k].1) / width(k);
    let (mut upper, mut right) = (vec![0.0; n], vec![0.0; n]);
    for k in 1..n - 1 {
        let pivot = 2.0 * (width(k - 1) + width(k)) - width(k - 1) * upper[k - 1];
        upper[k] = width(k) / pivot;
        right[k] = (6.0 * (slope(k) - slope(k - 1)) - width(k - 1) * right[k - 1]) / pivot;
    }
    for k in (1..n - 1).rev() {
        right[k] -= upper[k] * right[k + 1];
    }
    right
}

#[cfg(test)]
mod tests;
