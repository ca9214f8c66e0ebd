//! Formulas of what is seen of a mechanism: laws of forces, what events watch.

use super::Number;
use crate::{CoordinateUse, JointCoordinate, Seen};
use gyro_program::elementary::Function;

/// Arithmetic with numbers of the model file and numbers of the mechanism, such as `"pan rate * length - 0.3"`: a list
/// of operations, each of earlier ones, of which the last gives the value. What occurs twice is computed once.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Formula {
    /// The text, as the model file has it.
    pub text: String,
    /// The operations, of which there is at least one.
    pub operations: Vec<Operation>,
    /// The names in the text, each with the place of its value; `None` where it is part of another number.
    pub names: Vec<(String, Option<usize>)>,
    /// Where it is not smooth.
    pub kinks: Vec<Kink>,
}

/// Where a formula has a kink or a jump.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kink {
    /// The place, in the words of the model file, such as `length = 1.8`.
    pub words: String,
    /// The operation whose value tells.
    pub of: usize,
    /// At which of its values.
    pub at: Levels,
}

/// At which values of its argument something has a kink or a jump.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Levels {
    /// At zero.
    Zero,
    /// At whole numbers.
    Whole,
    /// At the corners of a curve of the model, by its place: see [`Curve::corners`](crate::Curve::corners).
    Curve(usize),
}

/// An operation of a formula. Operands are the places of earlier ones.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Operation {
    /// A number of the model file.
    Number(Number),
    /// A number of the mechanism.
    Seen(Seen),
    /// The other sign.
    Negative(usize),
    /// The sum of both.
    Sum(usize, usize),
    /// The first less the second.
    Difference(usize, usize),
    /// The product of both.
    Product(usize, usize),
    /// The first divided by the second.
    Quotient(usize, usize),
    /// A whole power, of which the exponent is neither 0 nor 1.
    Power(usize, i32),
    /// An elementary function, or a curve of the model; of one operand both are the same.
    Call(Function, [usize; 2]),
}

impl Formula {
    /// One number of the mechanism, by its name.
    pub fn seen(name: &str, seen: Seen) -> Self {
        let names = vec![(name.trim().to_owned(), Some(0))];
        Self { names, ..Self::smooth(name, vec![Operation::Seen(seen)]) }
    }

    /// Operations, of which there is at least one, without names or kinks.
    pub fn smooth(text: &str, operations: Vec<Operation>) -> Self {
        Self { text: text.to_owned(), operations, names: Vec::new(), kinks: Vec::new() }
    }

    /// Nothing.
    pub(crate) fn zero() -> Self {
        Self::smooth("0", vec![Operation::Number(Number::integer(0))])
    }

    /// It less another.
    #[must_use]
    pub(crate) fn minus(&self, other: &Self) -> Self {
        let text = format!("{} - ({})", self.text, other.text);
        let (first, shift) = (self.operations.len() - 1, self.operations.len());
        let mut operations = self.operations.clone();
        operations.extend(other.operations.iter().map(|operation| operation.moved(|place| place + shift)));
        operations.push(Operation::Difference(first, operations.len() - 1));
        let (mut names, mut kinks) = (self.names.clone(), self.kinks.clone());
        names.extend(other.names.iter().map(|(name, at)| (name.clone(), at.map(|place| place + shift))));
        kinks.extend(other.kinks.iter().map(|kink| Kink { of: kink.of + shift, ..kink.clone() }));
        Self { text, operations, names, kinks }
    }

    /// One of its operations with those that it needs, as a formula.
    #[must_use]
    pub fn up_to(&self, last: usize) -> Self {
        let mut is_needed = vec![false; last + 1];
        is_needed[last] = true;
        for place in (0..=last).rev() {
            if is_needed[place] {
                self.operations[place].operands().for_each(|operand| is_needed[operand] = true);
            }
        }
        let before = is_needed.iter().scan(0, |count, is_needed| {
            let before = *count;
            *count += usize::from(*is_needed);
            Some(before)
        });
        let places: Vec<usize> = before.collect();
        let needed = (0..=last).filter(|place| is_needed[*place]);
        let operations = needed.map(|place| self.operations[place].moved(|operand| places[operand]));
        Self::smooth(&self.text, operations.collect())
    }

    /// The value, given how to compute an operation from the values of earlier ones.
    ///
    /// # Errors
    /// The first that there is of an operation.
    pub fn value<T: Clone, E>(
        &self,
        mut compute: impl FnMut(&Operation, &[T]) -> Result<T, E>,
    ) -> Result<T, E> {
        let mut values: Vec<T> = Vec::with_capacity(self.operations.len());
        for operation in &self.operations {
            values.push(compute(operation, &values)?);
        }
        Ok(values.swap_remove(values.len() - 1))
    }

    /// All numbers of the model file that occur in it.
    pub fn numbers(&self) -> impl Iterator<Item = &Number> {
        self.operations.iter().filter_map(|operation| match operation {
            Operation::Number(number) => Some(number),
            _ => None,
        })
    }

    /// All numbers of the mechanism that occur in it.
    pub fn sees(&self) -> impl Iterator<Item = Seen> {
        self.operations.iter().filter_map(|operation| match operation {
            Operation::Seen(seen) => Some(*seen),
            _ => None,
        })
    }

    /// All curves that it calls, by their places among the model's.
    pub fn curves(&self) -> impl Iterator<Item = usize> {
        self.operations.iter().filter_map(|operation| match operation {
            Operation::Call(Function::Curve { curve, .. }, _) => Some(usize::from(*curve)),
            _ => None,
        })
    }

    /// Those of them whose argument is this number itself.
    pub fn curves_of(&self, seen: Seen) -> impl Iterator<Item = usize> {
        self.operations.iter().filter_map(move |operation| match operation {
            Operation::Call(Function::Curve { curve, .. }, [a, _])
                if self.operations[*a] == Operation::Seen(seen) =>
            {
                Some(usize::from(*curve))
            }
            _ => None,
        })
    }

    /// What it asks of joint coordinates.
    pub fn uses(&self) -> impl Iterator<Item = (JointCoordinate, CoordinateUse)> {
        self.sees().filter_map(|seen| match seen {
            Seen::Coordinate(on) => Some((on, CoordinateUse::Value)),
            Seen::Rate(on) => Some((on, CoordinateUse::Rate)),
            Seen::Output { .. }
            | Seen::Time
            | Seen::Length
            | Seen::LengthRate
            | Seen::Between(_)
            | Seen::BetweenRate(_) => None,
        })
    }
}

impl Operation {
    /// The places of its operands.
    pub fn operands(&self) -> impl Iterator<Item = usize> {
        let two = match *self {
            Self::Number(_) | Self::Seen(_) => [None; 2],
            Self::Negative(a) | Self::Power(a, _) => [Some(a), None],
            Self::Sum(a, b) | Self::Difference(a, b) | Self::Product(a, b) | Self::Quotient(a, b) => {
                [Some(a), Some(b)]
            }
            Self::Call(_, [a, b]) => [Some(a), Some(b)],
        };
        two.into_iter().flatten()
    }

    /// The same with other places of its operands.
    pub(crate) fn moved(&self, to: impl Fn(usize) -> usize) -> Self {
        match *self {
            Self::Negative(a) => Self::Negative(to(a)),
            Self::Power(a, exponent) => Self::Power(to(a), exponent),
            Self::Sum(a, b) => Self::Sum(to(a), to(b)),
            Self::Difference(a, b) => Self::Difference(to(a), to(b)),
            Self::Product(a, b) => Self::Product(to(a), to(b)),
            Self::Quotient(a, b) => Self::Quotient(to(a), to(b)),
            Self::Call(function, operands) => Self::Call(function, operands.map(to)),
            Self::Number(_) | Self::Seen(_) => self.clone(),
        }
    }
}
