//! Kernels by interpretation of their tapes: in any number type, where speed does not matter.

use crate::engine::{Arguments, Array, Engine, Layout, Shape, reads_curves, write_curves};
use gyro_codegen::tape::{At, Direction, Loop, Operation, Place, Tape};
use gyro_codegen::{Kernel, Scheduled, Variable};
use gyro_sim::Scalar;

/// Interprets the tapes of a mechanism.
#[derive(Clone, Debug)]
pub struct Interpreter {
    pub(crate) layout: Layout,
}

impl<T: Scalar> Engine<T> for Interpreter {
    fn compute(&self, scheduled: &Scheduled, kernel: Kernel, arguments: Arguments<'_, T>) {
        let Some(described) = scheduled.kernels.get(&kernel) else { return };
        let shape = Shape::of(scheduled, kernel);
        let mut work = vec![T::constant(0.0); shape.n_work];
        if reads_curves(scheduled, kernel) {
            write_curves(scheduled, arguments.t, &mut work);
        }
        let tape = &described.tape;
        let mut run = Run { layout: self.layout, shape: &shape, arguments, work, fixed: Vec::new() };
        let mut numbers: Vec<T> = Vec::with_capacity(tape.outside.operations.len());
        for each in &tape.loops {
            run.operations(&tape.outside, (each.after, None), &mut numbers);
            run.fixed.extend(each.fixed.iter().map(|&place| number(&numbers, place)));
            for &([array, row, column], value) in &each.stores {
                run.work[shape.kept(array, row, column)] = number(&numbers, value);
            }
            run.repeat(each);
        }
        run.operations(&tape.outside, (tape.outside.operations.len(), None), &mut numbers);
        let results: Vec<T> = tape.results.iter().map(|&place| number(&numbers, place)).collect();
        for (n, value) in results.into_iter().enumerate() {
            run.arguments.out[described.places.get(n).copied().unwrap_or(n)] = value;
        }
    }
}

/// What numbers are while a kernel is computed.
struct Run<'a, T> {
    layout: Layout,
    shape: &'a Shape,
    arguments: Arguments<'a, T>,
    work: Vec<T>,
    fixed: Vec<T>,
}

fn number<T: Copy>(numbers: &[T], place: Place) -> T {
    numbers[place.0 as usize]
}

/// A part of a loop: its number, and its row of the loop's table.
type Part<'a> = Option<(usize, &'a [f64])>;

impl<T: Scalar> Run<'_, T> {
    fn repeat(&mut self, each: &Loop<Variable, f64>) {
        let mut parts: Vec<usize> = (0..each.count).collect();
        if each.direction == Direction::Backward {
            parts.reverse();
        }
        for part in parts {
            let mut numbers = Vec::with_capacity(each.body.operations.len());
            let end = each.body.operations.len();
            self.operations(&each.body, (end, Some((part, &each.table[part]))), &mut numbers);
            for row in &each.rows {
                let at = if let At::Part(offset) = row.at { part + offset } else { 0 };
                for (column, &value) in row.values.iter().enumerate() {
                    self.work[self.shape.kept(row.array, at, column)] = number(&numbers, value);
                }
            }
        }
    }

    /// Does the operations of a tape that are not yet done, up to one of them.
    fn operations(&self, tape: &Tape<Variable, f64>, (end, part): (usize, Part<'_>), numbers: &mut Vec<T>) {
        for operation in &tape.operations[numbers.len()..end] {
            let at = |place: &Place| number(numbers, *place);
            let value = match operation {
                Operation::Constant(value) => T::constant(*value),
                Operation::Variable(variable) => self.variable(*variable, part),
                Operation::Add(a, b) => at(a) + at(b),
                Operation::Subtract(a, b) => at(a) - at(b),
                Operation::Multiply(a, b) => at(a) * at(b),
                Operation::Divide(a, b) => at(a) / at(b),
                Operation::Negate(a) => -at(a),
                Operation::Fused(a, b, c) => T::fused(at(a), at(b), at(c)),
                Operation::Sqrt(a) => at(a).sqrt(),
                Operation::Sin(a) => at(a).sin(),
                Operation::Cos(a) => at(a).cos(),
                Operation::Tanh(a) => at(a).tanh(),
                Operation::Atan2(y, x) => at(y).atan2(at(x)),
            };
            numbers.push(value);
        }
    }

    fn variable(&self, variable: Variable, part: Part<'_>) -> T {
        let (number, factors) = part.unwrap_or((0, &[]));
        match variable {
            Variable::Time => self.arguments.t,
            Variable::Fixed(place) => self.fixed[place],
            Variable::Factor(column) => T::constant(factors[column]),
            Variable::Row { array, offset, column } => {
                self.work[self.shape.kept(array, number + offset, column)]
            }
            Variable::Strided { argument, first, stride } => {
                self.array(self.shape.array(argument))[first + stride * number]
            }
            other => {
                let (array, place) = self.layout.place(self.shape, other).expect("it is outside of loops");
                self.array(array)[place]
            }
        }
    }

    fn array(&self, array: Array) -> &[T] {
        match array {
            Array::State => self.arguments.state,
            Array::Given => self.arguments.given,
            Array::Own => self.arguments.own,
            Array::Work => &self.work,
            Array::Out => self.arguments.out,
            Array::Tables => unreachable!("factors are read from the tape"),
        }
    }
}
