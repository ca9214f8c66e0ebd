//! Numbers of a tape as C, operation for operation.

use crate::names::Names;
use gyro_codegen::tape::{Operation, Place, Tape};
use gyro_codegen::{Variable, tape};
use gyro_program::elementary::Function;
use std::collections::HashMap;

/// How strongly an expression binds, for parentheses.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Unary,
    Call,
}

/// A tape, and how what it reads is called.
pub(crate) struct Line<'a> {
    tape: &'a Tape<Variable, f64>,
    names: &'a Names<'a>,
    variable: &'a dyn Fn(Variable) -> String,
    named: HashMap<Place, String>,
}

impl<'a> Line<'a> {
    /// Names of numbers begin with the letter.
    pub(crate) fn new(
        tape: &'a Tape<Variable, f64>,
        letter: char,
        names: &'a Names<'a>,
        variable: &'a dyn Fn(Variable) -> String,
    ) -> Self {
        let named = tape.named.iter().enumerate().map(|(n, &place)| (place, format!("{letter}{n}")));
        Self { tape, names, variable, named: named.collect() }
    }

    /// The name of a number that has one, and what computes it.
    pub(crate) fn temporary(&self, place: Place) -> (&str, String) {
        (&self.named[&place], self.operation(place).0)
    }

    /// A number as it stands at the end of an assignment.
    pub(crate) fn value(&self, place: Place) -> String {
        self.written(place).0
    }

    /// What a number copies of an array that loops fill.
    pub(crate) fn copied(&self, place: Place) -> Option<tape::Copied> {
        let kept = |variable: &Variable| match *variable {
            Variable::Kept { array, row, column } => Some([array, row, column]),
            _ => None,
        };
        self.tape.copied(place, |place| self.named.contains_key(&place), kept)
    }

    /// In parentheses if it binds less strongly than needed.
    fn bound(&self, place: Place, needed: Binding) -> String {
        let (text, binding) = self.written(place);
        if binding < needed { format!("({text})") } else { text }
    }

    fn written(&self, place: Place) -> (String, Binding) {
        match self.named.get(&place) {
            Some(name) => (name.clone(), Binding::Call),
            None => self.operation(place),
        }
    }

    fn operation(&self, place: Place) -> (String, Binding) {
        use Binding::{Call, Product, Sum, Unary};
        let bound = |place: &Place, needed| self.bound(*place, needed);
        match self.tape.operation(place) {
            Operation::Constant(value) => {
                let text = self.names.precision.constant(*value);
                let binding = if text.starts_with('-') { Unary } else { Call };
                (text, binding)
            }
            Operation::Variable(variable) => ((self.variable)(*variable), Call),
            Operation::Add(a, b) => (format!("{} + {}", bound(a, Sum), bound(b, Product)), Sum),
            Operation::Subtract(a, b) => (format!("{} - {}", bound(a, Sum), bound(b, Product)), Sum),
            Operation::Multiply(a, b) => (format!("{} * {}", bound(a, Product), bound(b, Unary)), Product),
            Operation::Divide(a, b) => (format!("{} / {}", bound(a, Product), bound(b, Unary)), Product),
            Operation::Negate(a) => {
                let of = bound(a, Unary);
                (if of.starts_with('-') { format!("-({of})") } else { format!("-{of}") }, Unary)
            }
            Operation::Fused(a, b, c) => {
                (format!("{} * {} + {}", bound(a, Product), bound(b, Unary), bound(c, Product)), Sum)
            }
            Operation::Call(Function::Curve { curve, order }, [at, _]) => {
                let name = self.names.own(&format!("curve_{curve}"));
                (format!("{name}({order}, {})", self.value(*at)), Call)
            }
            Operation::Call(function, operands) => {
                let operands: Vec<String> =
                    operands[..function.arity()].iter().map(|&operand| self.value(operand)).collect();
                (format!("{}({})", self.names.precision.function(*function), operands.join(", ")), Call)
            }
        }
    }
}
