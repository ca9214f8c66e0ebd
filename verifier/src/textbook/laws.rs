//! Strengths of forces that are formulas.

use super::formula;
use super::jet::Jet;
use super::{Evaluation, linear::Vector};
use crate::field::Field;
use gyro_model::{ForceKind, Number, OutputKind, Seen};

impl<F: Field> Evaluation<'_, F> {
    /// A strength; `None` where it is not defined.
    pub(super) fn strength(&self, number: &Number) -> Option<Jet<F>> {
        self.strength_along(number, None)
    }

    /// Three of them.
    pub(super) fn strengths(&self, [x, y, z]: &[Number; 3]) -> Option<Vector<F>> {
        Some(Vector([self.strength(x)?, self.strength(y)?, self.strength(z)?]))
    }

    /// A strength of a link, with the distance of its ends and the rate of that.
    pub(super) fn strength_along(&self, number: &Number, line: Option<[&Jet<F>; 2]>) -> Option<Jet<F>> {
        let Number::Formula(formula) = number else { return Some(self.scope.number(number)) };
        let see = |seen| match seen {
            Seen::Time => Some(Jet::constant(self.scope.point.t.clone())),
            Seen::Coordinate(on) => self.coordinate(on, &self.still),
            Seen::Rate(on) => Some(self.coordinate_rate(on)),
            Seen::Output { output, number } => self.early(output, number).map(Jet::constant),
            Seen::Length => line.map(|[length, _]| length.clone()),
            Seen::LengthRate => line.map(|[_, rate]| rate.clone()),
        };
        formula::value(self.textbook.model, &self.scope, &see, &formula.text)
    }

    /// A number of an output of position or velocity.
    fn early(&self, output: usize, number: usize) -> Option<F> {
        let model = self.textbook.model;
        match &model.outputs[output].kind {
            OutputKind::Inertial(frame) => {
                let w = self.by_axes(frame, &self.moving[frame.body].w)?;
                Some(w.0[number - 3].value.clone())
            }
            OutputKind::Link { force } => {
                let ForceKind::Link { first, second, .. } = &model.forces[*force].kind else { return None };
                let [from, to] = [first, second]
                    .map(|(body, point)| self.moving[*body].pose.point(&self.scope.vector(point)));
                let line = to - from;
                self.scope.sqrt(&line.dot(&line)).map(|length| length.value)
            }
            kind => self.output(kind, &[], &[])?.get(number).cloned(),
        }
    }
}
