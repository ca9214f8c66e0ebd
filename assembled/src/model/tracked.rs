//! Formulas of what joints measure, with derivatives: what coordinates are to be that couplers move.

use crate::model::curves::Curves;
use crate::model::jets::{Jet, jet};
use crate::model::measure::Term;
use crate::number::{Number, number};
use gyro_model::{Formula, JointCoordinate, Model, Operation, Seen};

/// A formula of joint coordinates.
#[derive(Clone, Debug)]
pub(crate) struct Tracked<T> {
    formula: Formula,
    curves: Curves,
    /// Of each operation its number, if it is one; zero of others.
    numbers: Vec<T>,
    /// The coordinates, each once.
    pub(crate) terms: Vec<Term<T>>,
    coordinates: Vec<JointCoordinate>,
}

impl<T: Number> Tracked<T> {
    pub(crate) fn new(model: &Model, formula: &Formula, term: impl Fn(JointCoordinate) -> Term<T>) -> Self {
        let value = |operation: &Operation| match operation {
            Operation::Number(value) => number(model.value(value)),
            _ => T::zero(),
        };
        let mut coordinates: Vec<_> = Vec::new();
        for (on, _) in formula.uses() {
            if !coordinates.contains(&on) {
                coordinates.push(on);
            }
        }
        Self {
            formula: formula.clone(),
            curves: Curves::of(model, formula),
            numbers: formula.operations.iter().map(value).collect(),
            terms: coordinates.iter().map(|on| term(*on)).collect(),
            coordinates,
        }
    }

    /// A formula of time alone.
    pub(crate) fn of_time(model: &Model, formula: &Formula) -> Self {
        Self::new(model, formula, |_| unreachable!("the reader allows no coordinates in motions"))
    }

    /// The value with its derivatives, from those of the coordinates in their order and the time.
    pub(crate) fn jet(&self, coordinates: &[Jet<T>], t: T) -> Jet<T> {
        let zero = T::zero();
        jet(&self.formula, &self.curves, |place, operation| match operation {
            Operation::Seen(Seen::Coordinate(on)) => {
                let place = self.coordinates.iter().position(|known| known == on);
                place.map_or([zero; 3], |place| coordinates[place])
            }
            Operation::Seen(Seen::Rate(on)) => {
                let place = self.coordinates.iter().position(|known| known == on);
                place.map_or([zero; 3], |place| [coordinates[place][1], coordinates[place][2], zero])
            }
            // The reader allows nothing else.
            Operation::Seen(_) => [t, T::one(), zero],
            _ => [self.numbers[place], zero, zero],
        })
    }

    /// The derivatives by each coordinate, or by each rate of what is linear in rates.
    pub(crate) fn slopes(&self, coordinates: &[Jet<T>], by_rates: bool) -> Vec<T> {
        let one = |by: usize| {
            let seeded = coordinates.iter().enumerate().map(|(place, [value, ..])| {
                [*value, if place == by { T::one() } else { T::zero() }, T::zero()]
            });
            // What is linear in rates is its own derivative by one of them.
            self.jet(&seeded.collect::<Vec<_>>(), T::zero())[usize::from(!by_rates)]
        };
        (0..coordinates.len()).map(one).collect()
    }

    /// The coordinates times their derivatives.
    pub(crate) fn times<'a>(&'a self, slopes: &'a [T], sign: T) -> impl Iterator<Item = Term<T>> + 'a {
        self.terms.iter().zip(slopes).map(move |(term, slope)| Term { factor: sign * *slope, ..*term })
    }
}
