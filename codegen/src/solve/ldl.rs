//! LDLᵀ of a sparse symmetric system of expressions, without pivoting: the caller is responsible for a safe order.

use crate::expr::graph::{ExprId, Graph};
use std::collections::BTreeMap;

/// One column of L with its pivot.
#[derive(Debug)]
struct Column {
    pivot: usize,
    inverse: ExprId,
    below: Vec<(usize, ExprId)>,
}

/// A sparse symmetric system on the way to its solution.
#[derive(Debug)]
pub struct Elimination {
    entries: BTreeMap<(usize, usize), ExprId>,
    /// Right-hand sides, then solutions.
    rhs: Vec<Vec<ExprId>>,
    columns: Vec<Column>,
}

impl Elimination {
    /// The lower triangle of a symmetric matrix, without zeros, and a right-hand side.
    pub fn new(entries: BTreeMap<(usize, usize), ExprId>, rhs: Vec<ExprId>) -> Self {
        Self::of_several(entries, vec![rhs])
    }

    /// The same with several right-hand sides.
    pub fn of_several(entries: BTreeMap<(usize, usize), ExprId>, rhs: Vec<Vec<ExprId>>) -> Self {
        Self { entries, rhs, columns: Vec::new() }
    }

    /// The solution, unknowns eliminated in their order.
    pub fn solve_in_order(mut self, graph: &mut Graph) -> Vec<ExprId> {
        (0..self.rhs[0].len()).for_each(|unknown| self.pivot(graph, unknown));
        self.substitute_back(graph)
    }

    /// D of L D Lᵀ, unknowns eliminated in their order.
    pub fn pivots_in_order(mut self, graph: &mut Graph) -> Vec<ExprId> {
        let count = self.rhs[0].len();
        let pivot = |unknown| {
            let diagonal = self.diagonal(unknown);
            self.pivot(graph, unknown);
            diagonal
        };
        (0..count).map(pivot).collect()
    }

    /// Rewrites all that is yet to be eliminated; of each expression `rewritten` is told whether it is on the diagonal.
    pub fn rewrite(&mut self, rewritten: impl FnOnce(&[ExprId], &[bool]) -> Vec<ExprId>) {
        let old: Vec<_> = self.entries.values().chain(self.rhs.iter().flatten()).copied().collect();
        let is_diagonal: Vec<_> = self.entries.keys().map(|(row, column)| row == column).collect();
        let mut new = rewritten(&old, &is_diagonal).into_iter();
        for (value, new) in self.entries.values_mut().chain(self.rhs.iter_mut().flatten()).zip(&mut new) {
            *value = new;
        }
        self.entries.retain(|_, value| *value != Graph::ZERO);
    }

    pub fn diagonal(&self, unknown: usize) -> ExprId {
        self.entries.get(&(unknown, unknown)).copied().unwrap_or(Graph::ZERO)
    }

    /// The unknowns that share an entry with one, and the entries.
    pub fn neighbours(&self, unknown: usize) -> Vec<(usize, ExprId)> {
        let row = self.entries.range((unknown, 0)..(unknown, unknown)).map(|(&(_, column), &v)| (column, v));
        let column = self.entries.iter().filter(|((r, c), _)| *c == unknown && *r > unknown);
        row.chain(column.map(|(&(row, _), &v)| (row, v))).collect()
    }

    /// K_ij −= l_i K_jp, b_i −= l_i b_p with l_i = K_ip / d.
    pub fn pivot(&mut self, graph: &mut Graph, pivot: usize) {
        let diagonal = self.entries.remove(&(pivot, pivot)).unwrap_or(Graph::ZERO);
        let inverse = graph.recip(diagonal);
        let column = self.neighbours(pivot);
        self.entries.retain(|&(row, column), _| row != pivot && column != pivot);
        let mut below = Vec::new();
        for (position, &(i, value)) in column.iter().enumerate() {
            let factor = graph.mul(value, inverse);
            for &(j, other) in &column[..=position] {
                self.subtract(graph, i.max(j), i.min(j), factor, other);
            }
            for rhs in &mut self.rhs {
                let moved = graph.mul(factor, rhs[pivot]);
                rhs[i] = graph.sub(rhs[i], moved);
            }
            below.push((i, factor));
        }
        self.columns.push(Column { pivot, inverse, below });
    }

    fn subtract(&mut self, graph: &mut Graph, row: usize, column: usize, factor: ExprId, value: ExprId) {
        let product = graph.mul(factor, value);
        let old = self.entries.get(&(row, column)).copied().unwrap_or(Graph::ZERO);
        let new = graph.sub(old, product);
        if new == Graph::ZERO {
            self.entries.remove(&(row, column));
        } else {
            self.entries.insert((row, column), new);
        }
    }

    /// What was eliminated, each with an unknown that was left and the factor of its row: L of `Lᵀ D L`.
    pub fn factors(&self) -> impl Iterator<Item = (usize, usize, ExprId)> {
        let of_column = |column: &Column| {
            column.below.iter().map(|&(i, factor)| (column.pivot, i, factor)).collect::<Vec<_>>()
        };
        self.columns.iter().flat_map(of_column)
    }

    /// The solution of the first right-hand side.
    pub fn substitute_back(self, graph: &mut Graph) -> Vec<ExprId> {
        self.solutions(graph).swap_remove(0)
    }

    /// x_p = b_p / d − Σ l_i x_i, last pivot first.
    pub fn solutions(mut self, graph: &mut Graph) -> Vec<Vec<ExprId>> {
        for rhs in &mut self.rhs {
            for Column { pivot, inverse, below } in self.columns.iter().rev() {
                let mut x = graph.mul(rhs[*pivot], *inverse);
                for &(i, factor) in below {
                    let product = graph.mul(factor, rhs[i]);
                    x = graph.sub(x, product);
                }
                rhs[*pivot] = x;
            }
        }
        self.rhs
    }
}
