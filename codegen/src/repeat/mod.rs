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
pub use rolled::{Local, Repeat, Rolled, Shape};

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

/// Steps from term to term by which colours are compared; the way that leaves the shortest text is taken.
const STEPS: [usize; 3] = [2, 1, 3];

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
    let ways = STEPS.into_iter().filter_map(|n_steps| {
        let start = std::time::Instant::now();
        let d = |w: &str| if std::env::var("ROLL").is_ok() { eprintln!("DBG {n_operations} {n_steps} {w} {:.2?}", start.elapsed()) };
        let shift = Shift::find(graph, &terms, n_steps);
        let orbits = Orbits::of(&terms, &shift, LEAST_PARTS);
        let loops = Loops::plan(&terms, &orbits)?;
        d("loops");
        let columns = Columns::of(&terms, &orbits, &loops, &element)?;
        d("columns");
        let signs = Signs::solve(&terms, &orbits, &loops, &columns)?;
        d("signs");
        let rolling = Rolling {
            source: graph,
            terms: &terms,
            orbits: &orbits,
            loops: &loops,
            columns: &columns,
            signs: &signs,
        };
        let rolled = rolling.rolled(roots);
        (2 * rolled.n_written() < n_operations).then_some(rolled)
    });
    ways.min_by_key(Rolled::n_written)
}

#[cfg(test)]
mod tests;
