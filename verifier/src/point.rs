//! Where an identity is tested.

use crate::field::Field;
use crate::program::Source;
use gyro_model::{Computation, Model, Number};

/// Values of everything that a mechanism's functions depend on.
#[derive(Clone, Debug)]
pub struct Point<F: Field> {
    /// What new numbers are made of.
    pub context: F::Context,
    /// Time.
    pub t: F,
    /// State: 7 positions (r, p) of each body that has coordinates, with |p| = 1 unless said otherwise; 6 velocities
    /// (s, w') of each; the work if [`Model::has_work`]; [`Model::states`]; one turn reference for each of
    /// [`Model::turn_references`].
    pub state: Vec<F>,
    /// Values of [`Model::parameters`].
    pub parameters: Vec<F>,
    /// Values of [`Model::inputs`].
    pub inputs: Vec<F>,
}

impl<F: Field> Point<F> {
    /// The value of a number of the model file here.
    pub fn number(&self, number: &Number) -> F {
        let signed = |value: &F, negated: bool| if negated { value.neg() } else { value.clone() };
        match number {
            Number::Exact(value) => F::from_rational(self.context, value),
            Number::Parameter { index, negated } => signed(&self.parameters[*index], *negated),
            Number::Input { index, negated } => signed(&self.inputs[*index], *negated),
            Number::Computed(computation) => self.computed(computation),
            Number::Formula(_) => unreachable!("the textbook reads formulas, where something moves"),
        }
    }

    /// Where it divides by zero, which no model file does, it is 0: a module does not exist there either.
    fn computed(&self, computation: &Computation) -> F {
        match computation {
            Computation::Sum(a, b) => self.number(a).add(&self.number(b)),
            Computation::Product(a, b) => self.number(a).mul(&self.number(b)),
            Computation::Quotient(a, b) => {
                let quotient = self.number(a).div(&self.number(b));
                quotient.unwrap_or_else(|| F::zero(self.context))
            }
            Computation::Power(base, exponent) => {
                let base = self.number(base);
                (1..*exponent).fold(base.clone(), |power, _| power.mul(&base))
            }
        }
    }

    /// What a program reads of a point; `None` of what is not the point's.
    pub fn given(&self, source: Source) -> Option<&F> {
        match source {
            Source::Time => Some(&self.t),
            Source::State(k) => self.state.get(k),
            Source::Parameter(k) => self.parameters.get(k),
            Source::Input(k) => self.inputs.get(k),
            Source::ParameterSetup(_)
            | Source::Acceleration(_)
            | Source::Joint(_)
            | Source::Chart(..)
            | Source::Factor(_)
            | Source::Change(_)
            | Source::Motion(_)
            | Source::Before(_) => None,
        }
    }

    /// (r, p) of the body in a moving_body (see [`Model::coordinate_bodies`]).
    pub fn position(&self, moving_body: usize) -> &[F] {
        &self.state[7 * moving_body..7 * moving_body + 7]
    }

    /// (s, w') of the body in a moving_body of a model.
    pub fn velocity(&self, model: &Model, moving_body: usize) -> &[F] {
        let start = 7 * model.coordinate_bodies().len() + 6 * moving_body;
        &self.state[start..start + 6]
    }

    /// A state of one's own, at a place of [`Model::states`].
    pub fn own_state(&self, model: &Model, place: usize) -> &F {
        &self.state[first_state(model) + place]
    }

    /// The turn reference at a place of [`Model::turn_references`].
    pub fn turn_reference(&self, model: &Model, place: usize) -> &F {
        &self.state[first_state(model) + model.states.len() + place]
    }
}

/// Where [`Model::states`] begin in the state.
pub(crate) fn first_state(model: &Model) -> usize {
    13 * model.coordinate_bodies().len() + usize::from(model.has_work())
}
