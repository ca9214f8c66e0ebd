//! Parts of a kernel that are alike up to constants, signs and variables: links of a chain, legs, cells. They are found
//! in its graph and written once, as a loop; what differs stays straight-line code.
//!
//! Terms are coloured by what is around them (`colours`); variables of one colour, in their order, say which term of
//! the next part corresponds to a term of this one (`shift`), and terms that correspond are an orbit (`orbits`). Orbits
//! are put into loops (`loops`), numbers go from one to the next in the columns of arrays (`columns`), and where
//! signs differ from part to part the opposite is computed (`signs`). `rolled` puts all of it together.

mod colours;
mod columns;
mod loops;
mod orbits;
mod rolled;
mod shift;
mod signs;
mod terms;

pub use loops::Direction;
pub use rolled::{Local, Repeat, Repetition, Rolled, Shape};

use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::schedule::Operations;
use crate::expr::symbol::Symbol;
use columns::{Columns, Element};
use loops::Loops;
use orbits::Orbits;
use rolled::Rolling;
use shift::Shift;
use signs::Signs;
use terms::{Place, Terms};

/// Kernels with fewer operations stay straight-line.
const LEAST_OPERATIONS: usize = 3000;

/// Parts that are worth a loop.
const LEAST_PARTS: usize = 4;

/// Steps from term to term by which colours are compared, and after how many variables of one colour a part repeats;
/// the way that leaves the shortest text is taken.
const WAYS: [(usize, usize); 5] = [(2, 1), (1, 1), (3, 1), (2, 2), (2, 3)];

/// A text that is so many times shorter is short enough to try no other way.
const SHORT: usize = 5;

/// A kernel with loops, if it is long and loops make its text shorter by half. `element` says in which argument a
/// variable is, and where.
pub fn rolled(
    graph: &Graph,
    roots: &[ExprId],
    element: &dyn Fn(Symbol) -> Option<Element>,
) -> Option<Rolled> {
    rolled_from(LEAST_OPERATIONS, graph, roots, element)
}

/// The same from so many operations on.
fn rolled_from(
    n_least: usize,
    graph: &Graph,
    roots: &[ExprId],
    element: &dyn Fn(Symbol) -> Option<Element>,
) -> Option<Rolled> {
    let n_operations = Operations::count(graph, roots).total();
    if n_operations < n_least {
        return None;
    }
    let terms = Terms::of(graph, roots);
    let element = |place: Place| match graph.node(terms.all[place].id) {
        Node::Symbol(symbol) => element(*symbol),
        _ => None,
    };
    let mut shortest: Option<Rolled> = None;
    for way in WAYS {
        let least = shortest.as_ref().map_or(n_operations.div_ceil(2), Rolled::n_written);
        if SHORT * least < n_operations {
            break;
        }
        let found = in_one_way(graph, &terms, (roots, &element), way);
        shortest = found.filter(|rolled| rolled.n_written() < least).or(shortest);
    }
    shortest
}

fn in_one_way(
    graph: &Graph,
    terms: &Terms,
    (roots, element): (&[ExprId], &dyn Fn(Place) -> Option<Element>),
    way: (usize, usize),
) -> Option<Rolled> {
    let shift = Shift::find(graph, terms, way);
    let orbits = &Orbits::of(terms, &shift, LEAST_PARTS);
    let loops = &Loops::plan(terms, orbits)?;
    let columns = &Columns::of(terms, orbits, loops, element)?;
    let signs = &Signs::solve(terms, orbits, loops, columns)?;
    let rolling = Rolling { source: graph, terms, orbits, loops, columns, signs };
    Some(rolling.rolled(roots))
}

#[cfg(test)]
mod tests;
