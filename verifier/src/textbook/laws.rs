//! Strengths of forces that are formulas.

use super::formula;
use super::jet::Jet;
use super::pose::Path;
use super::{Evaluation, linear::Vector};
use crate::field::Field;
use gyro_model::{ForceKind, JointCoordinate, Number, OutputKind, Seen};
use std::cell::RefCell;

/// A coordinate or a rate is zero but for rounding if it is smaller, rad or m.
const ROUNDED: f64 = 1e-12;

/// A formula with its derivatives.
pub(super) struct Slopes<F> {
    pub(super) value: Jet<F>,
    /// By each coordinate, or by its rate.
    pub(super) along: Vec<(JointCoordinate, Jet<F>)>,
}

/// What the laws of links and bushings see of their own ends.
pub(super) enum Own<'o, F> {
    Nothing,
    /// The distance of the ends of a link, and its rate.
    Line([&'o Jet<F>; 2]),
    /// The readings of a bushing, and their rates.
    Frames([&'o [Jet<F>; 6]; 2]),
}

impl<F> Clone for Own<'_, F> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<F> Copy for Own<'_, F> {}

impl<F: Field> Evaluation<'_, F> {
    /// A strength; `None` where it is not defined.
    pub(super) fn strength(&self, number: &Number) -> Option<Jet<F>> {
        self.strength_of(number, Own::Nothing)
    }

    /// Three of them.
    pub(super) fn strengths(&self, [x, y, z]: &[Number; 3]) -> Option<Vector<F>> {
        Some(Vector([self.strength(x)?, self.strength(y)?, self.strength(z)?]))
    }

    /// A strength of what sees its own ends.
    pub(super) fn strength_of(&self, number: &Number, own: Own<'_, F>) -> Option<Jet<F>> {
        let Number::Formula(formula) = number else { return Some(self.scope.number(number)) };
        let see = |seen| match (seen, own) {
            (Seen::Length, Own::Line([length, _])) => Some(length.clone()),
            (Seen::LengthRate, Own::Line([_, rate])) => Some(rate.clone()),
            (Seen::Between(k), Own::Frames([places, _])) => Some(places[k].clone()),
            (Seen::BetweenRate(k), Own::Frames([_, rates])) => Some(rates[k].clone()),
            (Seen::Output { output, number }, _) => self.early(output, number).map(Jet::constant),
            (seen, _) => self.sight(seen),
        };
        self.read(&formula.text, &see)
    }

    /// The value of a formula and its derivatives by those numbers that it is asked of, each of which is independent of
    /// the others.
    pub(super) fn slopes(&self, number: &Number, is_meant: impl Fn(Seen) -> bool) -> Option<Slopes<F>> {
        let formula = number.formula()?;
        let value = self.read(&formula.text, &|seen| self.sight(seen))?.frozen();
        let met = RefCell::new(Vec::new());
        self.read(&formula.text, &|seen| {
            if is_meant(seen) && !met.borrow().contains(&seen) {
                met.borrow_mut().push(seen);
            }
            self.sight(seen)
        })?;
        let one = |by: Seen| {
            let see = |seen| {
                let value = self.sight(seen)?.value;
                Some(if seen == by {
                    Jet::moving(value, self.scope.one.value.clone())
                } else {
                    Jet::constant(value)
                })
            };
            let slope = self.read(&formula.text, &see)?.derivative(&self.scope.zero.value).frozen();
            match by {
                Seen::Coordinate(on) | Seen::Rate(on) => Some((on, slope)),
                _ => None,
            }
        };
        let along = met.into_inner().into_iter().map(one).collect::<Option<_>>()?;
        Some(Slopes { value, along })
    }

    /// The value of an output that is a formula, and may see any other.
    pub(super) fn formula_output(&self, text: &str, accelerations: &[F], lambda: &[F]) -> Option<F> {
        let see = |seen| match seen {
            Seen::Output { output, number } => {
                let kind = &self.textbook.model.outputs[output].kind;
                self.output(kind, accelerations, lambda)?.get(number).cloned().map(Jet::constant)
            }
            seen => self.sight(seen),
        };
        self.read(text, &see).map(|value| value.value)
    }

    /// The derivative of a formula along the motion.
    pub(super) fn formula_rate(&self, text: &str, accelerations: &[F]) -> Option<F> {
        let moving = self.on_its_way(accelerations);
        let see = |seen| match seen {
            Seen::Time => Some(self.time(Path::Motion)),
            Seen::Output { output, number } => {
                let frames = self.textbook.model.outputs[output].kind.frames();
                let [first, second] = frames else { return None };
                let poses = [first, second].map(|frame| &moving.still[frame.body]);
                moving.relative([first, second], poses)?.get(number).cloned()
            }
            seen => moving.sight(seen),
        };
        Some(self.read(text, &see)?.derivative(&self.scope.zero.value).value)
    }

    fn read(&self, text: &str, see: formula::See<'_, F>) -> Option<Jet<F>> {
        formula::value(self.textbook.model, &self.scope, see, text)
    }

    /// What can be seen of the state and of time.
    fn sight(&self, seen: Seen) -> Option<Jet<F>> {
        match seen {
            Seen::Time => Some(Jet::constant(self.scope.point.t.clone())),
            Seen::Coordinate(on) => self.coordinate(on, &self.still),
            Seen::Rate(on) => Some(self.coordinate_rate(on)),
            Seen::Output { .. }
            | Seen::Length
            | Seen::LengthRate
            | Seen::Between(_)
            | Seen::BetweenRate(_) => None,
        }
    }

    /// A number of an output of position or velocity, or a state.
    fn early(&self, output: usize, number: usize) -> Option<F> {
        let model = self.textbook.model;
        match &model.outputs[output].kind {
            OutputKind::Inertial(frame) if number >= 3 => {
                let w = self.by_axes(frame, &self.moving[frame.body].w)?;
                Some(w.0[number - 3].value.clone())
            }
            OutputKind::Link { force } => {
                let ForceKind::Link { first, second, .. } = &model.forces[*force].kind else { return None };
                let [from, to] = [first, second].map(|(body, point)| {
                    let (moving, point) = (&self.moving[*body], self.scope.vector(point));
                    (moving.pose.point(&point), moving.velocity(&point))
                });
                let (line, drift) = (to.0 - from.0, to.1 - from.1);
                let length = self.scope.sqrt(&line.dot(&line))?;
                let seen = if number == 1 { length } else { line.dot(&drift) * length.reciprocal()? };
                Some(seen.value)
            }
            OutputKind::Bushing { force } => {
                let ForceKind::Bushing(bushing) = &model.forces[*force].kind else { return None };
                let [places, _] = self.seen_between(bushing)?;
                places.get(number).map(|place| place.value.clone())
            }
            kind @ (OutputKind::Pose(_)
            | OutputKind::Velocity(_)
            | OutputKind::Relative(_)
            | OutputKind::State { .. }) => self.output(kind, &[], &[])?.get(number).cloned(),
            _ => None,
        }
    }
}

impl Evaluation<'_, f64> {
    /// Whether all formulas of forces, states and outputs have finite values and derivatives here, and bushings those
    /// readings that formulas and outputs see.
    pub fn has_smooth_formulas(&self) -> bool {
        let model = self.textbook.model;
        let are_clear = model.forces.iter().enumerate().all(|(index, force)| match &force.kind {
            ForceKind::Bushing(bushing) => !self.is_seen(index) || self.is_clear(bushing),
            _ => true,
        });
        if !are_clear {
            return false;
        }
        let of_forces = model.forces.iter().flat_map(|force| {
            let own = match &force.kind {
                ForceKind::Bushing(bushing) => self.seen_between(bushing),
                _ => None,
            };
            let numbers = force.kind.parts().numbers.into_iter().flat_map(|(_, numbers)| numbers);
            numbers.filter_map(Number::formula).map(move |formula| (formula, own.clone()))
        });
        let of_outputs = model.outputs.iter().filter_map(|output| output.kind.formula());
        let of_states = model.states.iter().filter_map(|state| state.rate.formula());
        of_forces.chain(of_outputs.chain(of_states).map(|formula| (formula, None))).all(|(formula, own)| {
            let see = |by: Seen| {
                let see = |seen| {
                    let of_own = |which: usize, k: usize| Some(own.as_ref()?[which][k].value);
                    let known = match seen {
                        Seen::Output { output, number } => self.early(output, number),
                        Seen::Between(k) => of_own(0, k),
                        Seen::BetweenRate(k) => of_own(1, k),
                        seen => self.sight(seen).map(|jet| jet.value),
                    };
                    // Lengths, accelerations and multipliers are looked at where they come from.
                    let value = known.unwrap_or(1.0);
                    // What a joint state has as zero, the state of the bodies has to rounding.
                    let value = if value.abs() < ROUNDED { 0.0 } else { value };
                    Some(if seen == by { Jet::moving(value, 1.0) } else { Jet::constant(value) })
                };
                self.read(&formula.text, &see)
            };
            let is_finite = |jet: Jet<f64>| jet.value.is_finite() && jet.rate.is_none_or(f64::is_finite);
            formula.sees().all(|by| see(by).is_some_and(is_finite))
        })
    }
}
