//! Parts of a kernel that are alike up to constants, signs and variables: links of a chain, legs, cells. They are found
//! in its graph and written once, as a loop; what differs stays straight-line code.
//!
//! Terms are coloured by what is around them (`colours`); variables of one colour, in their order, say which term of
//! the next part corresponds to a term of this one (`shift`), and terms that correspond are an orbit (`orbits`). Orbits
//! are cut where a part is interrupted (`segments`) and put into loops (`loops`), numbers go from one to the next in
//! the columns of arrays (`columns`), and where signs differ from part to part the opposite is computed (`signs`).
//! `rolled` puts all of it together.

mod colours;
mod columns;
mod kernel;
mod loops;
mod needs;
mod orbits;
mod recurrence;
mod rolled;
mod segments;
mod shift;
mod signs;
mod terms;

pub use kernel::{At, Before, Local, Repeat, Repetition, Rolled, Row, Shape};
pub use loops::Direction;

use crate::effort::Effort;
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::schedule::Operations;
use crate::expr::symbol::Symbol;
use columns::{Columns, Element};
use loops::{Loops, Planning};
use orbits::Orbits;
use rolled::Rolling;
use shift::{Shift, Way};
use signs::Signs;
use terms::{Place, Terms};

/// A kernel with so many operations gets loops if they make its text so many times shorter. One that fits the
/// instruction cache runs as fast without: there loops are for compilers, and have to be worth it.
const LARGE: Size = Size { n_least: 3000, shorter: 2 };
const SMALL: Size = Size { n_least: 300, shorter: 8 };

/// Parts that are worth a loop.
const LEAST_PARTS: usize = 4;

/// The ways that are tried; the one that leaves the shortest text is taken.
const WAYS: [Way; 6] = [
    Way { n_steps: 2, stride: 1, copies: false },
    Way { n_steps: 2, stride: 3, copies: false },
    Way { n_steps: 2, stride: 1, copies: true },
    Way { n_steps: 1, stride: 1, copies: false },
    Way { n_steps: 3, stride: 1, copies: false },
    Way { n_steps: 2, stride: 2, copies: false },
];

/// A text that is so many times shorter is short enough to try no other way, but if it is longer than this and its
/// parts are several links each.
const SHORT: usize = 5;
const LONG: usize = 4000;

#[derive(Clone, Copy, Debug)]
struct Size {
    n_least: usize,
    shorter: usize,
}

/// A kernel with loops, if it is long and loops make its text shorter. `element` says in which argument a variable is,
/// and where.
pub fn rolled(
    graph: &Graph,
    roots: &[ExprId],
    element: &dyn Fn(Symbol) -> Option<Element>,
    effort: Effort,
) -> Option<Rolled> {
    let n_operations = Operations::count(graph, roots).total();
    let size = [LARGE, SMALL].into_iter().find(|size| n_operations >= size.n_least)?;
    let is_thorough = effort == Effort::Full && n_operations >= LARGE.n_least;
    let n_ways = if is_thorough { WAYS.len() } else { 1 };
    rolled_by(&WAYS[..n_ways], (n_operations, n_operations.div_ceil(size.shorter)), (graph, roots), element)
        .map(Rolled::hastened)
}

/// The same of so many operations in some ways, if its text is shorter than this.
fn rolled_by(
    ways: &[Way],
    (n_operations, longest): (usize, usize),
    (graph, roots): (&Graph, &[ExprId]),
    element: &dyn Fn(Symbol) -> Option<Element>,
) -> Option<Rolled> {
    let terms = Terms::of(graph, roots);
    let mut shortest: Option<(Rolled, Way)> = None;
    for &way in ways {
        let least = match &shortest {
            Some((rolled, of)) => {
                let is_good = rolled.length() < LONG || of.stride == 1;
                if is_good && SHORT * rolled.length() < n_operations {
                    break;
                }
                rolled.length()
            }
            None => longest,
        };
        let found = in_one_way(graph, &terms, element, (way, least));
        shortest = found.filter(|rolled| rolled.length() < least).map(|rolled| (rolled, way)).or(shortest);
    }
    shortest.map(|(rolled, _)| rolled)
}

fn in_one_way(
    graph: &Graph,
    terms: &Terms,
    element: &dyn Fn(Symbol) -> Option<Element>,
    (way, least): (Way, usize),
) -> Option<Rolled> {
    let n_originals = terms.all.len();
    let (terms, shift) = Shift::find(graph, terms, way);
    let terms = &*terms;
    let n_operations = terms.all.iter().filter(|term| term.kind.is_operation()).count();
    let element = |place: Place| match graph.node(terms.all[place].id) {
        Node::Symbol(symbol) => element(*symbol),
        _ => None,
    };
    let rolled = |planning: Planning| {
        let orbits = planning.orbits;
        let loops = &Loops::plan(planning)?;
        // Copies may turn out to be the same again.
        let n_written = (loops.n_written(terms) + n_originals).saturating_sub(terms.all.len());
        if n_written >= least && SHORT * n_written >= n_operations {
            return None;
        }
        let columns = &Columns::of(terms, orbits, loops, &element)?;
        let signs = &Signs::solve(terms, orbits, loops, columns)?;
        Some(Rolling { source: graph, terms, orbits, loops, columns, signs }.rolled())
    };
    let orbits = Orbits::of(terms, &shift, LEAST_PARTS);
    let planning = Planning::aligned(terms, &orbits);
    let whole = rolled(planning.clone());
    if whole.as_ref().is_some_and(|rolled| SHORT * rolled.length() < n_operations) {
        return whole;
    }
    let cut =
        segments::cut(&planning, LEAST_PARTS).and_then(|pieces| rolled(Planning::aligned(terms, &pieces)));
    whole.into_iter().chain(cut).min_by_key(Rolled::length)
}

#[cfg(test)]
mod tests;
