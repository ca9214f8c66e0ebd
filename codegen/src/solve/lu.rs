//! LU of a small square system of expressions. The order of the pivots is chosen by numbers, once; the code has no
//! choice left.

use crate::expr::graph::{ExprId, Graph};

/// A pivot is taken that is at least this part of the largest, if it leaves fewer operations.
const THRESHOLD: f64 = 0.2;

/// The factors of a matrix.
#[derive(Clone, Debug)]
pub struct Lu {
    steps: Vec<Step>,
}

/// A row and a column eliminated.
#[derive(Clone, Debug)]
struct Step {
    row: usize,
    column: usize,
    inverse: ExprId,
    /// Later rows, with what of this one was taken from them.
    below: Vec<(usize, ExprId)>,
    /// Later columns, with the entries of this row.
    right: Vec<(usize, ExprId)>,
}

impl Lu {
    /// `values` are those of the entries where the order of the pivots is chosen.
    pub fn new(graph: &mut Graph, mut matrix: Vec<Vec<ExprId>>, mut values: Vec<Vec<f64>>) -> Self {
        let n = matrix.len();
        let (mut rows, mut columns): (Vec<_>, Vec<_>) = ((0..n).collect(), (0..n).collect());
        let mut steps = Vec::new();
        while !rows.is_empty() {
            let (row, column) = best_pivot(&matrix, &values, &rows, &columns);
            rows.retain(|&other| other != row);
            columns.retain(|&other| other != column);
            let inverse = graph.recip(matrix[row][column]);
            let right: Vec<_> = columns
                .iter()
                .map(|&other| (other, matrix[row][other]))
                .filter(|(_, entry)| *entry != Graph::ZERO)
                .collect();
            let mut below = Vec::new();
            for &other in &rows {
                if matrix[other][column] == Graph::ZERO {
                    continue;
                }
                let factor = graph.mul(matrix[other][column], inverse);
                let value = values[other][column] / values[row][column];
                for &(place, entry) in &right {
                    let taken = graph.mul(factor, entry);
                    matrix[other][place] = graph.sub(matrix[other][place], taken);
                    values[other][place] -= value * values[row][place];
                }
                below.push((other, factor));
            }
            steps.push(Step { row, column, inverse, below, right });
        }
        Self { steps }
    }

    /// `A z = b`.
    pub fn solve(&self, graph: &mut Graph, mut rhs: Vec<ExprId>) -> Vec<ExprId> {
        for step in &self.steps {
            for &(row, factor) in &step.below {
                let taken = graph.mul(factor, rhs[step.row]);
                rhs[row] = graph.sub(rhs[row], taken);
            }
        }
        let mut solution = vec![Graph::ZERO; rhs.len()];
        for step in self.steps.iter().rev() {
            let mut rest = rhs[step.row];
            for &(column, entry) in &step.right {
                let taken = graph.mul(entry, solution[column]);
                rest = graph.sub(rest, taken);
            }
            solution[step.column] = graph.mul(rest, step.inverse);
        }
        solution
    }

    /// `Aᵀ y = c`.
    pub fn solve_transposed(&self, graph: &mut Graph, mut rhs: Vec<ExprId>) -> Vec<ExprId> {
        let mut solution = vec![Graph::ZERO; rhs.len()];
        for step in &self.steps {
            let value = graph.mul(rhs[step.column], step.inverse);
            for &(column, entry) in &step.right {
                let taken = graph.mul(entry, value);
                rhs[column] = graph.sub(rhs[column], taken);
            }
            solution[step.row] = value;
        }
        for step in self.steps.iter().rev() {
            for &(row, factor) in &step.below {
                let taken = graph.mul(factor, solution[row]);
                solution[step.row] = graph.sub(solution[step.row], taken);
            }
        }
        solution
    }
}

/// Of the pivots that are large enough the one that leaves the fewest operations.
fn best_pivot(
    matrix: &[Vec<ExprId>],
    values: &[Vec<f64>],
    rows: &[usize],
    columns: &[usize],
) -> (usize, usize) {
    let places = || rows.iter().flat_map(|&row| columns.iter().map(move |&column| (row, column)));
    let size = |(row, column): (usize, usize)| values[row][column].abs();
    let largest = places().map(size).fold(0.0, f64::max);
    let is_entry = |&(row, column): &(usize, usize)| matrix[row][column] != Graph::ZERO;
    let growth = |(row, column): (usize, usize)| {
        let of_row = columns.iter().filter(|&&other| matrix[row][other] != Graph::ZERO).count();
        let of_column = rows.iter().filter(|&&other| matrix[other][column] != Graph::ZERO).count();
        (of_row - 1) * (of_column - 1)
    };
    let large = places().filter(is_entry).filter(|&place| size(place) >= THRESHOLD * largest);
    large.min_by_key(|&place| growth(place)).expect("a matrix of full rank has a pivot")
}
