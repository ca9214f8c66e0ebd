//! What a kernel with loops consists of.

use super::loops::Direction;
use crate::expr::constant::Constant;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::schedule::Operations;
use crate::expr::symbol::Symbol;

/// A number that a loop's body reads: what [`Symbol::Local`] stands for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Local {
    /// An entry of the loop's table in the row of its part.
    Factor(usize),
    /// A row of an array, so many after the part's place.
    Row { array: usize, offset: usize, column: usize },
    /// What the part before has left in the only row of an array.
    Carried { array: usize, column: usize },
    /// An element of an argument, so many apart from part to part.
    Element { first: Symbol, stride: usize },
    /// A number that is computed before, the same for all parts.
    Fixed(usize),
}

/// A loop.
#[derive(Debug)]
pub struct Repeat {
    pub direction: Direction,
    /// How many parts there are.
    pub count: usize,
    /// Constants: a row for each part.
    pub table: Vec<Vec<Constant>>,
    /// What its symbols stand for.
    pub locals: Vec<Local>,
    /// The body's expressions.
    pub graph: Graph,
    /// What it computes for each part, in terms of these, and where that is stored.
    pub rows: Vec<Row<ExprId>>,
    /// Operations of the body.
    pub n_operations: usize,
}

/// Numbers that a loop stores for each part: all of a row of an array.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Row<N> {
    /// Which array.
    pub array: usize,
    /// Which of its rows.
    pub at: At,
    /// The numbers.
    pub values: Vec<N>,
}

/// Which row of an array is that of a part.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    /// So many after the part's number.
    Part(usize),
    /// The only one: each part overwrites what the part before has left.
    Only,
}

/// What is done before a loop: numbers that its body reads.
#[derive(Debug, Default)]
pub struct Before {
    /// Numbers that are the same for all parts, as expressions outside of loops, from this number on.
    pub fixed: Vec<ExprId>,
    /// Array, row and column, and what is stored there.
    pub stores: Vec<([usize; 3], ExprId)>,
}

/// Rows and columns of an array.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// How many rows it has.
    pub rows: usize,
    /// How many numbers a row has.
    pub columns: usize,
}

/// How a function with loops is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Repetition {
    /// Loops, one after the other.
    pub loops: usize,
    /// How often the longest of them goes round.
    pub copies: usize,
    /// Operations of its text; straight-line code has one for each that it does.
    pub written: usize,
    /// Operations that it does: a few more than straight-line code where parts share what others do not.
    pub operations: Operations,
}

/// A kernel with loops.
#[derive(Debug)]
pub struct Rolled {
    /// Expressions outside of loops.
    pub graph: Graph,
    pub arrays: Vec<Shape>,
    /// The loops in order, and what is done before each.
    pub loops: Vec<(Before, Repeat)>,
    pub roots: Vec<ExprId>,
}

impl Rolled {
    /// All that is computed outside of loops.
    pub fn outside_roots(&self) -> Vec<ExprId> {
        let before = self.loops.iter().flat_map(|(before, _)| before.roots());
        before.chain(self.roots.iter().copied()).collect()
    }

    /// What the data sheet says of it.
    pub fn repetition(&self) -> Repetition {
        let copies = self.loops.iter().map(|(_, repeat)| repeat.count).max().unwrap_or(0);
        Repetition { loops: self.loops.len(), copies, written: self.n_written(), operations: self.executed() }
    }

    /// Operations as they are executed.
    pub fn executed(&self) -> Operations {
        let mut sum = Operations::count(&self.graph, &self.outside_roots());
        for (_, repeat) in &self.loops {
            let body = Operations::count(&repeat.graph, &repeat.values());
            sum.additions += repeat.count * body.additions;
            sum.multiplications += repeat.count * body.multiplications;
            sum.divisions += repeat.count * body.divisions;
            sum.functions += repeat.count * body.functions;
        }
        sum
    }

    /// How long its text is: operations, and stores for loops to read.
    pub fn length(&self) -> usize {
        let stores: usize = self.loops.iter().map(|(before, _)| before.stores.len()).sum();
        self.n_written() + stores
    }

    /// How many operations its text has.
    pub fn n_written(&self) -> usize {
        let inside: usize = self.loops.iter().map(|(_, repeat)| repeat.n_operations).sum();
        Operations::count(&self.graph, &self.outside_roots()).total() + inside
    }
}

impl Repeat {
    /// What it computes for each part.
    pub fn values(&self) -> Vec<ExprId> {
        self.rows.iter().flat_map(|row| row.values.iter().copied()).collect()
    }
}

impl Before {
    /// What is computed for it.
    pub fn roots(&self) -> Vec<ExprId> {
        self.fixed.iter().copied().chain(self.stores.iter().map(|(_, value)| *value)).collect()
    }
}
