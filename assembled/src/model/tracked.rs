//! Formulas of what joints measure, and of where frames are, with derivatives: rows by formula.

use crate::model::curves::Curves;
use crate::model::jets::{Jet, jet};
use crate::model::joint::Joint;
use crate::model::measure::{Coordinate, Measure, Term};
use crate::number::{Number, number};
use gyro_model::{Formula, JointCoordinate, Model, Number as PageNumber, Operation, Relative, Seen};

/// A formula of joint coordinates and of where frames are.
#[derive(Clone, Debug)]
pub(crate) struct Tracked<T> {
    formula: Formula,
    curves: Curves,
    /// Of each operation its number, if it is one; zero of others.
    numbers: Vec<T>,
    /// What it depends on, each once.
    pub(crate) terms: Vec<Term<T>>,
    subjects: Vec<Subject>,
}

/// What a formula may be differentiated by.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Subject {
    Coordinate(JointCoordinate),
    /// A number of an output of two frames that tells where the second is.
    Place(usize, usize),
}

impl Subject {
    /// What is measured.
    pub(crate) fn term<T: Number>(self, (joints, pairs): (&[Joint<T>], &[usize])) -> Term<T> {
        let (joint, measure) = match self {
            Self::Coordinate(of) => (of.joint, Coordinate::of(&joints[of.joint], of.coordinate).measure),
            Self::Place(output, number) => {
                let pair = pairs.iter().position(|pair| *pair == output);
                (joints.len() + pair.expect("all that is seen is there"), Measure::of_place(number))
            }
        };
        Term { factor: T::one(), joint, measure }
    }

    /// What is needed to tell a number.
    fn of(seen: Seen) -> Vec<Self> {
        match seen {
            Seen::Coordinate(on) | Seen::Rate(on) => vec![Self::Coordinate(on)],
            Seen::Output { output, number } => match number {
                0..Relative::N_PLACES => vec![Self::Place(output, number)],
                12..15 => vec![Self::Place(output, number - 12)],
                _ => {
                    let [from, to] = rows_about(number - 15);
                    from.chain(to).map(|place| Self::Place(output, place)).collect()
                }
            },
            _ => Vec::new(),
        }
    }
}

/// The rows of R that tell a component of `ω̃ = Ṙ Rᵀ`.
fn rows_about(axis: usize) -> [std::ops::Range<usize>; 2] {
    [1, 2].map(|next| {
        let first = 3 + 3 * ((axis + next) % 3);
        first..first + 3
    })
}

impl<T: Number> Tracked<T> {
    pub(crate) fn new(model: &Model, formula: &Formula, term: impl Fn(Subject) -> Term<T>) -> Self {
        let value = |operation: &Operation| match operation {
            Operation::Number(value) => number(model.value(value)),
            _ => T::zero(),
        };
        let mut subjects: Vec<_> = Vec::new();
        for subject in formula.sees().flat_map(Subject::of) {
            if !subjects.contains(&subject) {
                subjects.push(subject);
            }
        }
        Self {
            formula: formula.clone(),
            curves: Curves::of(model, formula),
            numbers: formula.operations.iter().map(value).collect(),
            terms: subjects.iter().map(|subject| term(*subject)).collect(),
            subjects,
        }
    }

    /// A formula of time alone.
    pub(crate) fn of_time(model: &Model, formula: &Formula) -> Self {
        Self::new(model, formula, |_| unreachable!("the reader allows no coordinates in motions"))
    }

    /// An input has changed.
    pub(crate) fn set_input(&mut self, input: usize, value: T) {
        for (number, operation) in self.numbers.iter_mut().zip(&self.formula.operations) {
            match operation {
                Operation::Number(PageNumber::Input { index, negated }) if *index == input => {
                    *number = if *negated { -value } else { value };
                }
                _ => {}
            }
        }
    }

    /// The value with its derivatives, from those of the subjects in their order and the time.
    pub(crate) fn jet(&self, jets: &[Jet<T>], t: T) -> Jet<T> {
        let zero = T::zero();
        let of = |subject: Subject| {
            let place = self.subjects.iter().position(|known| *known == subject);
            place.map_or([zero; 3], |place| jets[place])
        };
        let rate = |subject: Subject| {
            let [_, rate, second] = of(subject);
            [rate, second, zero]
        };
        jet(&self.formula, &self.curves, |place, operation| match operation {
            Operation::Seen(Seen::Coordinate(on)) => of(Subject::Coordinate(*on)),
            Operation::Seen(Seen::Rate(on)) => rate(Subject::Coordinate(*on)),
            Operation::Seen(Seen::Output { output, number }) => match number {
                0..Relative::N_PLACES => of(Subject::Place(*output, *number)),
                12..15 => rate(Subject::Place(*output, number - 12)),
                _ => {
                    let [from, to] = rows_about(number - 15);
                    from.zip(to).fold([zero; 3], |[value, slope, _], (from, to)| {
                        let [from, to] = [from, to].map(|place| of(Subject::Place(*output, place)));
                        [value + to[1] * from[0], slope + to[2] * from[0] + to[1] * from[1], zero]
                    })
                }
            },
            // The reader allows nothing else.
            Operation::Seen(_) => [t, T::one(), zero],
            _ => [self.numbers[place], zero, zero],
        })
    }

    /// The derivatives by each subject, or by each rate of what is linear in rates.
    pub(crate) fn slopes(&self, jets: &[Jet<T>], by_rates: bool) -> Vec<T> {
        let one = |by: usize| {
            let seeded = jets.iter().enumerate().map(|(place, [value, ..])| {
                [*value, if place == by { T::one() } else { T::zero() }, T::zero()]
            });
            // What is linear in rates is its own derivative by one of them.
            self.jet(&seeded.collect::<Vec<_>>(), T::zero())[usize::from(!by_rates)]
        };
        (0..jets.len()).map(one).collect()
    }

    /// The subjects times their derivatives.
    pub(crate) fn times<'a>(&'a self, slopes: &'a [T], sign: T) -> impl Iterator<Item = Term<T>> + 'a {
        self.terms.iter().zip(slopes).map(move |(term, slope)| Term { factor: sign * *slope, ..*term })
    }
}
