//! Chooses the cheapest of several forms of a function, compared after the final passes.

use crate::expr::graph::{ExprId, Graph};
use crate::expr::rounding::{choose, rounds_well};
use crate::expr::schedule::Operations;
use crate::simplify::normal_form::Reduction;
use crate::simplify::reassociate::reassociated;
use crate::simplify::scales::scaled;

/// Longer ways of writing a function are compared as they are.
const MAX_OPERATIONS: usize = 3000;

/// A way of computing a function.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Form {
    /// What it is called.
    pub name: String,
    /// What it takes.
    pub operations: Operations,
    /// Whether it is the one that was emitted.
    pub is_taken: bool,
}

/// The form of a function that was chosen.
#[derive(Clone, Debug, Default)]
pub struct Chosen {
    pub roots: Vec<ExprId>,
    /// The forms that were compared; none if there was a single one.
    pub forms: Vec<Form>,
    /// What the polynomial normal form made of the parts of the form of this name.
    pub reductions: Vec<Reduction>,
}

impl From<Vec<ExprId>> for Chosen {
    fn from(roots: Vec<ExprId>) -> Self {
        Self { roots, ..Self::default() }
    }
}

/// The passes over a function whose form is chosen. Forms are compared by what they cost after them.
#[derive(Clone, Copy, Debug)]
pub struct FinalPasses {
    chooses_scales: bool,
}

impl FinalPasses {
    /// Near a singular pose rounding decides which branch a linkage follows, so functions of mechanisms with loops keep
    /// their scales.
    pub fn of(has_loops: bool) -> Self {
        Self { chooses_scales: !has_loops }
    }

    /// The same expressions, after these passes.
    pub fn applied(self, graph: &mut Graph, roots: &[ExprId]) -> Vec<ExprId> {
        let now = roots;
        let roots = if self.chooses_scales { scaled(graph, now) } else { now.to_vec() };
        let then = reassociated(graph, &roots);
        if then == now || rounds_well(graph, &then, now) { then } else { now.to_vec() }
    }

    /// The candidate that takes the fewest operations after these passes, of those that round well; and what each would
    /// have taken.
    pub fn cheapest(self, graph: &mut Graph, candidates: Vec<(String, Vec<ExprId>)>) -> Chosen {
        let costs: Vec<_> = candidates.iter().map(|(_, roots)| self.cost(graph, roots)).collect();
        let cost = |k: usize| (costs[k].functions, costs[k].total());
        let forms: Vec<_> = candidates.iter().map(|(_, roots)| roots.as_slice()).collect();
        let taken = choose(graph, &forms, cost);
        let form = |(k, (name, _)): (usize, &(String, _))| Form {
            name: name.clone(),
            operations: costs[k],
            is_taken: k == taken,
        };
        let forms = candidates.iter().enumerate().map(form).collect();
        let (_, roots) = candidates.into_iter().nth(taken).expect("it is one of them");
        Chosen { roots, forms, reductions: Vec::new() }
    }

    fn cost(self, graph: &mut Graph, roots: &[ExprId]) -> Operations {
        let now = Operations::recurring(graph, roots);
        if now.total() > MAX_OPERATIONS {
            return now;
        }
        let roots = self.applied(graph, roots);
        Operations::recurring(graph, &roots)
    }
}
