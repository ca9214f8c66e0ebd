//! Curves that formulas call, in numbers: evaluated in `f64`, whatever the scalar, as tables of motions are.

use crate::model::course;
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
        Some(course::table(&spline.knots, &spline.pieces, x.to_f64()).map(number))
    }
}
