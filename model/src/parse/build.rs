//! Formulas in the making: operations one after another, each once, numbers of the model file put together exactly.

use super::computed::{MOST_WEIGHT, root};
use crate::number::in_range;
use crate::{Curve, Number, Operation, Rational};
use gyro_program::elementary::Function;
use num_traits::Signed;

/// A formula that is being built.
#[derive(Debug, Default)]
pub(super) struct Build {
    operations: Vec<Operation>,
}

impl Build {
    /// The operations that one of them needs, with it as the last, and where each of all of them is among these.
    pub(super) fn up_to(&self, last: usize) -> (Vec<Operation>, Vec<Option<usize>>) {
        reachable(&self.operations, last)
    }

    pub(super) fn exact(&mut self, value: Rational) -> usize {
        self.push(Operation::Number(Number::Exact(value)))
    }

    pub(super) fn integer(&mut self, value: i64) -> usize {
        self.push(Operation::Number(Number::integer(value)))
    }

    pub(super) fn call(&mut self, function: Function, operands: [usize; 2]) -> usize {
        let value = match (self.number(operands[0]), function) {
            (Some(Number::Exact(x)), Function::Abs) => Some(x.abs()),
            (Some(Number::Exact(x)), Function::Floor) => Some(x.floor()),
            _ => None,
        };
        match value {
            Some(value) => self.exact(value),
            None => self.push(Operation::Call(function, operands)),
        }
    }

    pub(super) fn negative(&mut self, a: usize) -> usize {
        match self.number(a) {
            Some(number) => self.push(Operation::Number(-number)),
            None => self.push(Operation::Negative(a)),
        }
    }

    pub(super) fn sum(&mut self, a: usize, b: usize) -> usize {
        self.folded(a, b, |a, b| Some(a + b)).unwrap_or_else(|| match [a, b].map(|x| self.is_zero(x)) {
            [true, _] => b,
            [_, true] => a,
            _ => self.push(Operation::Sum(a, b)),
        })
    }

    pub(super) fn difference(&mut self, a: usize, b: usize) -> usize {
        self.folded(a, b, |a, b| Some(a - b)).unwrap_or_else(|| match [a, b].map(|x| self.is_zero(x)) {
            [true, _] => self.negative(b),
            [_, true] => a,
            _ => self.push(Operation::Difference(a, b)),
        })
    }

    pub(super) fn product(&mut self, a: usize, b: usize) -> usize {
        self.folded(a, b, |a, b| Some(a * b)).unwrap_or_else(|| self.push(Operation::Product(a, b)))
    }

    pub(super) fn quotient(&mut self, a: usize, b: usize) -> usize {
        self.folded(a, b, Number::over).unwrap_or_else(|| self.push(Operation::Quotient(a, b)))
    }

    /// The first where this is greater than zero, the second elsewhere.
    pub(super) fn where_positive(&mut self, margin: usize, [a, b]: [usize; 2]) -> usize {
        if a == b {
            return a;
        }
        if let Some(Number::Exact(margin)) = self.number(margin) {
            return if margin.is_positive() { a } else { b };
        }
        let zero = self.integer(0);
        let taken = if a == zero { zero } else { self.call(Function::When, [margin, a]) };
        let other = if b == zero { zero } else { self.call(Function::Unless, [margin, b]) };
        self.sum(taken, other)
    }

    /// The value of a curve. Where it has none a root has none, and with it the condition.
    pub(super) fn curve(&mut self, (index, curve): (usize, &Curve), x: usize) -> usize {
        let value = self.call(Function::curve(index, 0), [x; 2]);
        let Some(ends) = curve.domain() else { return value };
        let [first, last] = ends.map(|end| self.exact(Rational::from_float(end).expect("it is finite")));
        let (from, to) = (self.difference(x, first), self.difference(last, x));
        let within = self.product(from, to);
        let root = self.root(within);
        let one = self.integer(1);
        let condition = self.sum(one, root);
        self.call(Function::When, [condition, value])
    }

    /// The square root; of a number it is one.
    pub(super) fn root(&mut self, radicand: usize) -> usize {
        match self.number(radicand) {
            Some(Number::Exact(value)) if !value.is_negative() => self.exact(root(&value)),
            _ => self.call(Function::Sqrt, [radicand; 2]),
        }
    }

    pub(super) fn is_negative(&self, place: usize) -> bool {
        matches!(self.number(place), Some(Number::Exact(value)) if value.is_negative())
    }

    pub(super) fn whole_power(&mut self, base: usize, exponent: i32) -> usize {
        let folded = self.number(base).and_then(|number| number.power(exponent)).filter(is_short);
        match (folded, exponent) {
            (Some(number), _) => self.push(Operation::Number(number)),
            (None, 0) => self.integer(1),
            (None, 1) => base,
            (None, _) => self.push(Operation::Power(base, exponent)),
        }
    }

    pub(super) fn general_power(&mut self, base: usize, exponent: usize) -> usize {
        let logarithm = self.call(Function::Ln, [base; 2]);
        let scaled = self.product(exponent, logarithm);
        self.call(Function::Exp, [scaled; 2])
    }

    /// The number at a place, if it is one that arithmetic with parameters can go on with.
    pub(super) fn number(&self, place: usize) -> Option<Number> {
        match &self.operations[place] {
            Operation::Number(Number::Input { .. }) => None,
            Operation::Number(number) => Some(number.clone()),
            _ => None,
        }
    }

    pub(super) fn is_zero(&self, place: usize) -> bool {
        self.number(place).is_some_and(|number| number.is_zero())
    }

    /// An operation on numbers of the model file, done exactly.
    fn folded(&mut self, a: usize, b: usize, of: impl Fn(Number, Number) -> Option<Number>) -> Option<usize> {
        let number = of(self.number(a)?, self.number(b)?).filter(is_short)?;
        Some(self.push(Operation::Number(number)))
    }

    pub(super) fn push(&mut self, operation: Operation) -> usize {
        let known = self.operations.iter().position(|known| *known == operation);
        known.unwrap_or_else(|| {
            self.operations.push(operation);
            self.operations.len() - 1
        })
    }
}

fn is_short(number: &Number) -> bool {
    match number {
        Number::Exact(value) => in_range(value),
        number => number.weight() <= MOST_WEIGHT,
    }
}

/// The operations that the last of them needs, and the new places of all.
fn reachable(operations: &[Operation], last: usize) -> (Vec<Operation>, Vec<Option<usize>>) {
    let mut is_needed = vec![false; operations.len()];
    is_needed[last] = true;
    for place in (0..=last).rev().filter(|&place| place <= last) {
        if is_needed[place] {
            operations[place].operands().for_each(|operand| is_needed[operand] = true);
        }
    }
    let mut places = vec![None; operations.len()];
    let mut kept = Vec::new();
    for (place, operation) in operations.iter().enumerate().filter(|(place, _)| is_needed[*place]) {
        places[place] = Some(kept.len());
        kept.push(operation.moved(|operand| places[operand].expect("what it needs is kept before it")));
    }
    (kept, places)
}
