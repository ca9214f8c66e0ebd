//! Kernels by interpretation of their tapes: in any number type, where speed does not matter.

use crate::engine::{
    self, Arguments, Array, Engine, Input, Layout, NotCompiled, Shape, reads_curves, write_curves,
};
use crate::native::call;
use gyro_codegen::tape::{At, Direction, Loop, Operation, Place, Tape};
use gyro_codegen::{Kernel, Scheduled, Variable};
use gyro_model::Spline;
use gyro_program::elementary::Function;
use gyro_sim::Scalar;
use std::cell::RefCell;
use std::sync::Arc;

/// Interprets the tapes of a mechanism. Clones share what is known of them.
#[derive(Clone, Debug)]
pub struct Interpreter<T> {
    layout: Layout,
    /// By kernel.
    known: Arc<[Option<Known>]>,
    /// Borrowed inside each call and never across.
    room: RefCell<Room<T>>,
}

/// What is the same at every call of a kernel.
#[derive(Debug)]
struct Known {
    shape: Shape,
    reads_curves: bool,
}

/// Numbers while a kernel is computed.
#[derive(Clone, Debug)]
struct Room<T> {
    /// Curves, and arrays of loops.
    work: Vec<T>,
    /// What a loop is given.
    fixed: Vec<T>,
    outside: Vec<T>,
    part: Vec<T>,
    results: Vec<T>,
}

impl<T> Interpreter<T> {
    pub(crate) fn new(scheduled: &Scheduled, layout: Layout) -> Self {
        let known = |kernel: Kernel| {
            scheduled.kernels.contains_key(&kernel).then(|| Known {
                shape: Shape::of(scheduled, kernel),
                reads_curves: reads_curves(scheduled, kernel),
            })
        };
        let [work, fixed, outside, part, results] = [(); 5].map(|()| Vec::new());
        let room = RefCell::new(Room { work, fixed, outside, part, results });
        Self { layout, known: Kernel::all().map(known).collect(), room }
    }

    /// What a mechanism of compiled kernels has where there is nothing to compile them.
    #[cfg_attr(feature = "machine-code", expect(dead_code, reason = "kernels are compiled"))]
    #[expect(clippy::unnecessary_wraps, reason = "a compiler may refuse")]
    pub(crate) fn compile(
        scheduled: &Scheduled,
        layout: Layout,
        _: Option<&mut dyn FnMut(Input<'_>)>,
    ) -> Result<Self, NotCompiled> {
        Ok(Self::new(scheduled, layout))
    }
}

impl<T: Scalar> Engine<T> for Interpreter<T> {
    fn compute(&self, scheduled: &Scheduled, kernel: Kernel, arguments: Arguments<'_, T>) {
        let (Some(described), Some(known)) = (scheduled.kernels.get(&kernel), &self.known[kernel as usize])
        else {
            return;
        };
        let mut room = self.room.borrow_mut();
        let Room { work, fixed, outside: numbers, part, results } = &mut *room;
        [&mut *fixed, &mut *numbers, &mut *results].into_iter().for_each(Vec::clear);
        work.clear();
        work.resize(known.shape.n_work, T::constant(0.0));
        if known.reads_curves {
            write_curves(scheduled, arguments.t, work);
        }
        let (tape, shape) = (&described.tape, &known.shape);
        let curves = &scheduled.curves;
        let mut run = Run { layout: self.layout, curves, shape, arguments, work, fixed };
        for each in &tape.loops {
            run.operations(&tape.outside, (each.after, None), numbers);
            run.fixed.extend(each.fixed.iter().map(|&place| number(numbers, place)));
            for &([array, row, column], value) in &each.stores {
                run.work[shape.kept(array, row, column)] = number(numbers, value);
            }
            run.repeat(each, part);
        }
        run.operations(&tape.outside, (tape.outside.operations.len(), None), numbers);
        // What is written may be what was read.
        results.extend(tape.results.iter().map(|&place| number(numbers, place)));
        for (n, &value) in results.iter().enumerate() {
            run.arguments.out[described.places.get(n).copied().unwrap_or(n)] = value;
        }
    }
}

/// A kernel that is being computed.
struct Run<'a, T> {
    layout: Layout,
    curves: &'a [Spline],
    shape: &'a Shape,
    arguments: Arguments<'a, T>,
    work: &'a mut Vec<T>,
    fixed: &'a mut Vec<T>,
}

fn number<T: Copy>(numbers: &[T], place: Place) -> T {
    numbers[place.0 as usize]
}

/// A part of a loop: its number, and its row of the loop's table.
type Part<'a> = Option<(usize, &'a [f64])>;

impl<T: Scalar> Run<'_, T> {
    fn repeat(&mut self, each: &Loop<Variable, f64>, numbers: &mut Vec<T>) {
        for nth in 0..each.count {
            let part = if each.direction == Direction::Backward { each.count - 1 - nth } else { nth };
            numbers.clear();
            let end = each.body.operations.len();
            self.operations(&each.body, (end, Some((part, &each.table[part]))), numbers);
            for row in &each.rows {
                let at = if let At::Part(offset) = row.at { part + offset } else { 0 };
                for (column, &value) in row.values.iter().enumerate() {
                    self.work[self.shape.kept(row.array, at, column)] = number(numbers, value);
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
                Operation::Call(Function::Curve { curve, order }, [at_x, _]) => {
                    engine::curve(&self.curves[usize::from(*curve)], usize::from(*order), at(at_x))
                }
                Operation::Call(function, operands) => call(*function, operands.map(|place| at(&place))),
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
            Array::Work => self.work,
            Array::Out => self.arguments.out,
            Array::Tables => unreachable!("factors are read from the tape"),
        }
    }
}
