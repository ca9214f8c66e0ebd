//! The last passes over a function, when its form is chosen; what forms are compared by.

use crate::closing::closing_rows;
use crate::functions::Functions;
use crate::graph::{ExprId, Graph};
use crate::reassociate::reassociated;
use crate::scales::scaled;
use crate::schedule::Operations;
use crate::sheet::Form;
use crate::system::System;

/// Longer ways of writing a function are compared as they are.
const MAX_OPERATIONS: usize = 3000;

/// What is done at the end.
#[derive(Clone, Copy, Debug)]
pub struct Finish {
    chooses_scales: bool,
}

impl Finish {
    /// Near a singular pose rounding decides how a linkage goes on: there the form stays that was tried on them.
    pub fn of(system: &System) -> Self {
        Self { chooses_scales: closing_rows(system).is_empty() }
    }

    /// Finishes all functions.
    pub fn all(self, graph: &mut Graph, functions: &mut Functions) {
        for roots in functions.recurring_mut() {
            *roots = self.finished(graph, roots);
        }
    }

    fn finished(self, graph: &mut Graph, roots: &[ExprId]) -> Vec<ExprId> {
        let roots = if self.chooses_scales { scaled(graph, roots) } else { roots.to_vec() };
        reassociated(graph, &roots)
    }

    /// The set of roots that takes the fewest operations when it is finished, and what each would have taken.
    pub fn cheapest(
        self,
        graph: &mut Graph,
        candidates: Vec<(String, Vec<ExprId>)>,
    ) -> (Vec<ExprId>, Vec<Form>) {
        let costs: Vec<_> = candidates.iter().map(|(_, roots)| self.cost(graph, roots)).collect();
        let cost = |&k: &usize| (costs[k].functions, costs[k].total());
        let taken = (0..candidates.len()).min_by_key(cost).expect("there is a candidate");
        let form = |(k, (name, _)): (usize, &(String, _))| Form {
            name: name.clone(),
            operations: costs[k],
            is_taken: k == taken,
        };
        let forms = candidates.iter().enumerate().map(form).collect();
        (candidates.into_iter().nth(taken).expect("it is one of them").1, forms)
    }

    fn cost(self, graph: &mut Graph, roots: &[ExprId]) -> Operations {
        let now = Operations::recurring(graph, roots);
        if now.total() > MAX_OPERATIONS {
            return now;
        }
        let roots = self.finished(graph, roots);
        Operations::recurring(graph, &roots)
    }
}
