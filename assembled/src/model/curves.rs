//! Curves that formulas call, in numbers: evaluated in `f64`, whatever the scalar, as tables of motions are.

use crate::number::{Number, number};
use gyro_model::{Formula, Model, Spline};
use gyro_program::elementary::Function;

/// The curves that a formula calls, by their places among the model's.
#[derive(Clone, Debug)]
pub(crate) struct Curves(Vec<(u16, Spline)>);

impl Curves {
    pub(crate) fn of(model: &Model, formula: &Formula) -> Self {
        let all = (0..)
            .zip(&model.curves)
            .filter(|(place, _)| formula.curves().any(|curve| curve == usize::from(*place)));
        Self(all.map(|(place, curve)| (place, curve.spline.clone())).collect())
    }

    /// Value, first and second derivative of what is a curve.
    pub(crate) fn jet<T: Number>(&self, function: Function, x: T) -> Option<[T; 3]> {
        let Function::Curve { curve, .. } = function else { return None };
        let (_, spline) = self.0.iter().find(|(place, _)| *place == curve)?;
        Some(table(&spline.knots, &spline.pieces, x.to_f64()).map(number))
    }
}

/// Horner's rule for a polynomial and its derivatives.
pub(crate) fn polynomial(coefficients: &[f64], t: f64) -> [f64; 3] {
    coefficients
        .iter()
        .rev()
        .fold([0.0; 3], |[value, slope, bend], c| [value * t + c, slope * t + value, bend * t + 2.0 * slope])
}

/// A spline, which goes on as a straight line beyond its ends.
pub(crate) fn table(knots: &[f64], pieces: &[[f64; 4]], t: f64) -> [f64; 3] {
    let inside = t.clamp(knots[0], knots[pieces.len()]);
    let piece = knots[1..pieces.len()].partition_point(|&knot| knot <= inside);
    let [value, slope, bend] = polynomial(&pieces[piece], inside - knots[piece]);
    if t == inside { [value, slope, bend] } else { [value + slope * (t - inside), slope, 0.0] }
}
