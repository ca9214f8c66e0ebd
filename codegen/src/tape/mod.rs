//! Kernels as tapes: operations on numbers in their order, each once, with loops over tables of constants.
//!
//! Whatever a kernel becomes, Rust text or machine code, is made from its tape, operation for operation: what becomes
//! one operation with what (`a b + c`, `a / b`) is decided here, and nowhere else.

mod build;
mod copies;

use crate::expr::constant::Constant;
use crate::expr::symbol::Symbol;
use crate::repeat::Local;
use gyro_program::elementary::Function;

pub use crate::repeat::{At, Direction, Row, Shape};
pub(crate) use build::{looped, straight};
#[cfg(test)]
pub(crate) use copies::LEAST_COPIES;
pub use copies::{Arranged, Array, Copied, Run, Source, arranged};

/// A number of a tape, by the place of the operation that gives it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Place(pub u32);

/// One operation. Operands come before it.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs, reason = "the operations are what they are called")]
pub enum Operation<V, C> {
    Constant(C),
    Variable(V),
    Add(Place, Place),
    Subtract(Place, Place),
    Multiply(Place, Place),
    Divide(Place, Place),
    Negate(Place),
    /// `a b + c`: rounded once where the run time fuses, else twice.
    Fused(Place, Place, Place),
    /// An elementary function; of one operand both are the same.
    Call(Function, [Place; 2]),
}

/// Straight-line operations on variables `V` and constants `C`.
#[derive(Clone, Debug, PartialEq)]
pub struct Tape<V, C> {
    /// The operations, operands first.
    pub operations: Vec<Operation<V, C>>,
    /// Those that have a name in a text, in the order of their numbers.
    pub named: Vec<Place>,
}

/// A loop: its body is done for each part.
#[derive(Clone, Debug, PartialEq)]
pub struct Loop<V, C> {
    /// How many of the operations outside of loops come before it.
    pub after: usize,
    /// Those of them that have a name and come after the loop before.
    pub named: Vec<Place>,
    /// Numbers that its body reads and that are the same for all parts; numbered on from those of the loops before.
    pub fixed: Vec<Place>,
    /// Array, row and column, and what is stored there before the loop begins.
    pub stores: Vec<([usize; 3], Place)>,
    /// In which order the parts are done.
    pub direction: Direction,
    /// How many parts there are.
    pub count: usize,
    /// Constants, a row for each part.
    pub table: Vec<Vec<C>>,
    /// What [`Symbol::Local`] stands for in its body.
    pub(crate) locals: Vec<Local>,
    /// What is done for a part.
    pub body: Tape<V, C>,
    /// Which numbers of the body are stored when it is done, and where.
    pub rows: Vec<Row<Place>>,
}

/// A kernel.
#[derive(Clone, Debug, PartialEq)]
pub struct Kernel<V, C> {
    /// What is done outside of loops.
    pub outside: Tape<V, C>,
    /// The arrays that hand numbers from loop to loop. What is read of them was stored before.
    pub arrays: Vec<Shape>,
    /// The loops, in their order; most kernels have none.
    pub loops: Vec<Loop<V, C>>,
    /// What has a name and comes after all loops.
    pub rest: Vec<Place>,
    /// What the kernel gives.
    pub results: Vec<Place>,
}

/// A tape as the generator has it.
pub(crate) type Exact = Tape<Symbol, Constant>;

impl<V, C> Operation<V, C> {
    /// The operands.
    pub fn operands(&self) -> impl Iterator<Item = Place> + use<V, C> {
        let (a, b, c) = match *self {
            Self::Constant(_) | Self::Variable(_) => (None, None, None),
            Self::Negate(a) => (Some(a), None, None),
            Self::Call(function, [a, b]) => (Some(a), (function.arity() == 2).then_some(b), None),
            Self::Add(a, b) | Self::Subtract(a, b) | Self::Multiply(a, b) | Self::Divide(a, b) => {
                (Some(a), Some(b), None)
            }
            Self::Fused(a, b, c) => (Some(a), Some(b), Some(c)),
        };
        a.into_iter().chain(b).chain(c)
    }

    fn map<W, D>(
        &self,
        variable: &mut impl FnMut(&V) -> W,
        constant: &mut impl FnMut(&C) -> D,
    ) -> Operation<W, D> {
        match self {
            Self::Constant(value) => Operation::Constant(constant(value)),
            Self::Variable(of) => Operation::Variable(variable(of)),
            Self::Add(a, b) => Operation::Add(*a, *b),
            Self::Subtract(a, b) => Operation::Subtract(*a, *b),
            Self::Multiply(a, b) => Operation::Multiply(*a, *b),
            Self::Divide(a, b) => Operation::Divide(*a, *b),
            Self::Negate(a) => Operation::Negate(*a),
            Self::Fused(a, b, c) => Operation::Fused(*a, *b, *c),
            Self::Call(function, operands) => Operation::Call(*function, *operands),
        }
    }
}

impl<V, C> Default for Kernel<V, C> {
    /// One that computes nothing.
    fn default() -> Self {
        let outside = Tape { operations: Vec::new(), named: Vec::new() };
        Self { outside, arrays: Vec::new(), loops: Vec::new(), rest: Vec::new(), results: Vec::new() }
    }
}

impl<V, C> Kernel<V, C> {
    /// The curves that it calls, as often as it calls them.
    pub fn curves(&self) -> impl Iterator<Item = u16> {
        self.outside.curves().chain(self.loops.iter().flat_map(|each| each.body.curves()))
    }
}

impl<V, C> Tape<V, C> {
    /// The operation that gives a number.
    pub fn operation(&self, place: Place) -> &Operation<V, C> {
        &self.operations[place.0 as usize]
    }

    /// The variables that it reads, as often as it reads them.
    pub fn variables(&self) -> impl Iterator<Item = &V> {
        self.operations.iter().filter_map(|operation| match operation {
            Operation::Variable(variable) => Some(variable),
            _ => None,
        })
    }

    /// The curves that it calls, as often as it calls them.
    pub fn curves(&self) -> impl Iterator<Item = u16> {
        self.operations.iter().filter_map(|operation| match operation {
            Operation::Call(Function::Curve { curve, .. }, _) => Some(*curve),
            _ => None,
        })
    }

    /// The same on other variables and constants.
    pub(crate) fn map<W, D>(
        &self,
        mut variable: impl FnMut(&V) -> W,
        mut constant: impl FnMut(&C) -> D,
    ) -> Tape<W, D> {
        let operations = self.operations.iter().map(|operation| operation.map(&mut variable, &mut constant));
        Tape { operations: operations.collect(), named: self.named.clone() }
    }
}

impl Kernel<Symbol, Constant> {
    /// The same with constants rounded to the nearest `f64`, on other variables: those outside of loops, and those of
    /// the body of a loop, with what its symbols stand for.
    pub(crate) fn map<W>(
        &self,
        outside: impl Fn(&Symbol) -> W,
        inside: impl Fn(&[Local], &Symbol) -> W,
    ) -> Kernel<W, f64> {
        let round = |row: &Vec<Constant>| row.iter().map(Constant::to_f64).collect();
        let loops = self.loops.iter().map(|each| Loop {
            after: each.after,
            named: each.named.clone(),
            fixed: each.fixed.clone(),
            stores: each.stores.clone(),
            direction: each.direction,
            count: each.count,
            table: each.table.iter().map(round).collect(),
            locals: each.locals.clone(),
            body: each.body.map(|symbol| inside(&each.locals, symbol), Constant::to_f64),
            rows: each.rows.clone(),
        });
        Kernel {
            loops: loops.collect(),
            outside: self.outside.map(outside, Constant::to_f64),
            arrays: self.arrays.clone(),
            rest: self.rest.clone(),
            results: self.results.clone(),
        }
    }
}

impl<V, C> Kernel<V, C> {
    /// What has a name and is computed before each loop, and after all of them.
    pub(crate) fn parts(&self) -> Vec<Vec<Place>> {
        self.loops.iter().map(|each| each.named.clone()).chain([self.rest.clone()]).collect()
    }

    /// What is read outside of its tape's own operations: by loops, and as results.
    pub(crate) fn roots(&self) -> Vec<Place> {
        self.loops.iter().flat_map(Loop::roots).chain(self.results.iter().copied()).collect()
    }
}

impl<V, C> Loop<V, C> {
    /// The numbers of its body that are stored.
    pub fn values(&self) -> impl Iterator<Item = &Place> + Clone {
        self.rows.iter().flat_map(|row| &row.values)
    }

    /// What is computed for it.
    pub(crate) fn roots(&self) -> impl Iterator<Item = Place> {
        self.fixed.iter().copied().chain(self.stores.iter().map(|(_, value)| *value))
    }
}
