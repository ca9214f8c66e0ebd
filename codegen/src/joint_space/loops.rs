//! How rates keep loops closed: `J δ = b` for the rates of each loop, one loop after the other.
//!
//! A loop whose rates are one more than its rows (a four-bar linkage) has a single motion, the vector that is
//! perpendicular to its rows, whichever of its rates would be called independent: then the formulas have no choice and
//! are singular only where the mechanism is. In others some rates are independent and the rest follow from them.

use super::closure::Closure;
use super::embedding::{Embedding, RateMotion};
use crate::expr::graph::{ExprId, Graph};
use crate::solve::lu::Lu;
use std::collections::BTreeSet;

/// The loops of a mechanism, in the order in which they are closed.
#[derive(Debug, Default)]
pub struct Loops(Vec<Loop>);

/// Some rows that are solved together.
#[derive(Debug)]
struct Loop {
    /// Among those of the closure.
    rows: Vec<usize>,
    /// Rates of earlier loops on which the rows depend.
    before: Vec<usize>,
    /// The others.
    own: Vec<usize>,
    solve: Solve,
}

#[derive(Debug)]
enum Solve {
    /// Two rates and a row.
    Pair { row: [ExprId; 2], inverse: ExprId },
    /// Three rates and two rows; their cross product, and the inverse of its square.
    Triple { rows: [[ExprId; 3]; 2], motion: [ExprId; 3], inverse: ExprId },
    /// As many of the own rates as there are rows follow from the rest.
    Square { dependent: Vec<usize>, lu: Lu },
}

impl Loops {
    /// `groups` are the rows of each joint, `values` those of J at the start.
    pub fn of(graph: &mut Graph, closure: &Closure, groups: Vec<Vec<usize>>, values: &[Vec<f64>]) -> Self {
        let mut loops = Self::default();
        let mut left = groups;
        let mut known = BTreeSet::new();
        let columns_of = |rows: &[usize]| -> BTreeSet<usize> {
            let is_entry = |rate: &usize| rows.iter().any(|&row| closure.jacobian[row][*rate] != Graph::ZERO);
            (0..closure.jacobian[0].len()).filter(is_entry).collect()
        };
        while !left.is_empty() {
            let n_own = |rows: &[usize]| columns_of(rows).difference(&known).count();
            let solvable = left.iter().enumerate().filter(|(_, rows)| n_own(rows) >= rows.len());
            let Some((next, _)) = solvable.min_by_key(|(_, rows)| n_own(rows) - rows.len()) else {
                // No loop can be closed by itself: two that share rates are closed together.
                let first = left.remove(0);
                let columns = columns_of(&first);
                let shares = |rows: &Vec<usize>| !columns_of(rows).is_disjoint(&columns);
                let with = left.iter().position(shares).unwrap_or(0);
                assert!(!left.is_empty(), "independent rows have enough rates");
                left[with].extend(first);
                continue;
            };
            let rows = left.remove(next);
            let columns = columns_of(&rows);
            let own: Vec<_> = columns.difference(&known).copied().collect();
            let before: Vec<_> = columns.intersection(&known).copied().collect();
            let others: BTreeSet<_> = left.iter().flat_map(|rows| columns_of(rows)).collect();
            known.extend(&own);
            loops.0.push(Loop::of(graph, closure, (rows, before, own), &others, values));
        }
        loops
    }

    /// How the rates move: `J u̇ = γ` for all values of the unknowns.
    pub fn embedding(&self, graph: &mut Graph, closure: &Closure, n_rates: usize) -> Embedding {
        let mut embedding = Embedding { rates: Vec::new(), n_unknowns: 0 };
        let in_loops: BTreeSet<_> = self.0.iter().flat_map(|closed| closed.own.iter().copied()).collect();
        for rate in 0..n_rates {
            let columns = if in_loops.contains(&rate) { Vec::new() } else { vec![embedding.unknown()] };
            embedding.rates.push(RateMotion { columns, bias: Graph::ZERO });
        }
        for closed in &self.0 {
            closed.embed(graph, closure, &mut embedding);
        }
        embedding
    }

    /// Rates with `J δ = b`: of those that close a loop of a single motion the least, of others the dependent ones.
    pub fn changes(
        &self,
        graph: &mut Graph,
        closure: &Closure,
        rhs: &[ExprId],
        n_rates: usize,
    ) -> Vec<ExprId> {
        let mut changes = vec![Graph::ZERO; n_rates];
        for closed in &self.0 {
            let rhs = closed.rows.iter().map(|&row| {
                closed.before.iter().fold(rhs[row], |rest, &rate| {
                    let taken = graph.mul(closure.jacobian[row][rate], changes[rate]);
                    graph.sub(rest, taken)
                })
            });
            let rhs = rhs.collect();
            for (rate, change) in closed.particular(graph, rhs) {
                changes[rate] = change;
            }
        }
        changes
    }

    /// `Jᵀ λ = f` for forces along the rates that rows of loops can supply.
    pub fn multipliers(&self, graph: &mut Graph, closure: &Closure, forces: &[ExprId]) -> Vec<ExprId> {
        let mut left = forces.to_vec();
        let mut multipliers = vec![Graph::ZERO; closure.rows.len()];
        for closed in self.0.iter().rev() {
            let found = closed.transposed(graph, &left);
            for (&row, &multiplier) in closed.rows.iter().zip(&found) {
                multipliers[row] = multiplier;
                for &rate in &closed.before {
                    let taken = graph.mul(closure.jacobian[row][rate], multiplier);
                    left[rate] = graph.sub(left[rate], taken);
                }
            }
        }
        multipliers
    }
}

impl Loop {
    fn of(
        graph: &mut Graph,
        closure: &Closure,
        (rows, before, own): (Vec<usize>, Vec<usize>, Vec<usize>),
        others: &BTreeSet<usize>,
        values: &[Vec<f64>],
    ) -> Self {
        let entry = |row: usize, rate: usize| closure.jacobian[row][rate];
        let solve = match (&rows[..], &own[..]) {
            (&[row], &[a, b]) if before.is_empty() => {
                let row = [entry(row, a), entry(row, b)];
                let square = graph.dot(&row, &row);
                Solve::Pair { row, inverse: graph.recip(square) }
            }
            (&[first, second], own) if own.len() == 3 && before.is_empty() => {
                let rows = [first, second].map(|row| [0, 1, 2].map(|k| entry(row, own[k])));
                let motion = graph.cross(&rows[0], &rows[1]);
                let square = graph.dot(&motion, &motion);
                Solve::Triple { rows, motion, inverse: graph.recip(square) }
            }
            _ => {
                let dependent = dependent(&rows, &own, others, values);
                let matrix = rows.iter().map(|&row| dependent.iter().map(|&rate| entry(row, rate)).collect());
                let numbers = rows.iter().map(|&row| dependent.iter().map(|&rate| values[row][rate]).collect());
                let (matrix, numbers) = (matrix.collect(), numbers.collect());
                Solve::Square { lu: Lu::new(graph, matrix, numbers), dependent }
            }
        };
        Self { rows, before, own, solve }
    }

    /// Of the own rates, with all independent ones zero.
    fn particular(&self, graph: &mut Graph, rhs: Vec<ExprId>) -> Vec<(usize, ExprId)> {
        let values = match &self.solve {
            Solve::Pair { row, inverse } => {
                let scaled = graph.mul(rhs[0], *inverse);
                graph.scale_vec(scaled, row).to_vec()
            }
            Solve::Triple { rows: [first, second], motion, inverse } => {
                // ((b₁ J₂ − b₂ J₁) × t) / t·t with t = J₁ × J₂.
                let (left, right) = (graph.scale_vec(rhs[0], second), graph.scale_vec(rhs[1], first));
                let difference = graph.sub_vec(&left, &right);
                let least = graph.cross(&difference, motion);
                graph.scale_vec(*inverse, &least).to_vec()
            }
            Solve::Square { dependent, lu } => {
                let solution = lu.solve(graph, rhs);
                return dependent.iter().copied().zip(solution).collect();
            }
        };
        self.own.iter().copied().zip(values).collect()
    }

    /// λ with `Jᵀ λ = f` along the own rates.
    fn transposed(&self, graph: &mut Graph, forces: &[ExprId]) -> Vec<ExprId> {
        match &self.solve {
            Solve::Pair { row, inverse } => {
                let force = [forces[self.own[0]], forces[self.own[1]]];
                let along = graph.dot(row, &force);
                vec![graph.mul(along, *inverse)]
            }
            Solve::Triple { rows: [first, second], motion, inverse } => {
                let force = [0, 1, 2].map(|k| forces[self.own[k]]);
                let (left, right) = (graph.cross(second, motion), graph.cross(motion, first));
                [left, right]
                    .map(|dual| {
                        let along = graph.dot(&dual, &force);
                        graph.mul(along, *inverse)
                    })
                    .to_vec()
            }
            Solve::Square { dependent, lu } => {
                lu.solve_transposed(graph, dependent.iter().map(|&rate| forces[rate]).collect())
            }
        }
    }

    /// Adds the own rates to what is known of the others.
    fn embed(&self, graph: &mut Graph, closure: &Closure, embedding: &mut Embedding) {
        let motion = match &self.solve {
            Solve::Pair { row: [a, b], .. } => Some(vec![*b, graph.neg(*a)]),
            Solve::Triple { motion, .. } => Some(motion.to_vec()),
            Solve::Square { .. } => None,
        };
        if let Some(motion) = motion {
            let (unknown, _) = embedding.unknown();
            for (&rate, factor) in self.own.iter().zip(motion) {
                embedding.rates[rate].columns.push((unknown, factor));
            }
        }
        if let Solve::Square { dependent, .. } = &self.solve {
            for rate in self.own.iter().filter(|rate| !dependent.contains(rate)) {
                let unknown = embedding.unknown();
                embedding.rates[*rate].columns.push(unknown);
            }
        }
        // What is known moves the rows.
        let known: Vec<_> = (0..embedding.n_unknowns).map(Some).chain([None]).collect();
        for unknown in known {
            let rhs = self.rows.iter().map(|&row| {
                let start = if unknown.is_none() { closure.gamma[row] } else { Graph::ZERO };
                let moved = (0..closure.jacobian[row].len()).filter(|rate| self.moves(*rate));
                moved.fold(start, |rest, rate| {
                    let taken = graph.mul(closure.jacobian[row][rate], embedding.rates[rate].part(unknown));
                    graph.sub(rest, taken)
                })
            });
            let rhs: Vec<_> = rhs.collect();
            if rhs.iter().all(|&x| x == Graph::ZERO) {
                continue;
            }
            for (rate, value) in self.particular(graph, rhs) {
                let motion = &mut embedding.rates[rate];
                match unknown {
                    Some(unknown) => motion.columns.push((unknown, value)),
                    None => motion.bias = value,
                }
            }
        }
    }

    /// Whether a rate moves the rows and is given before they are solved.
    fn moves(&self, rate: usize) -> bool {
        match &self.solve {
            Solve::Square { dependent, .. } => {
                !dependent.contains(&rate) && (self.before.contains(&rate) || self.own.contains(&rate))
            }
            _ => false,
        }
    }
}

/// As many rates as there are rows that determine them well at the start; those that no other loop shares first.
fn dependent(rows: &[usize], own: &[usize], others: &BTreeSet<usize>, values: &[Vec<f64>]) -> Vec<usize> {
    /// How much smaller a pivot may be for the sake of a rate that no other loop shares.
    const SHARED: f64 = 1e-2;
    let weight = |rate: usize| if others.contains(&rate) { SHARED } else { 1.0 };
    let mut matrix: Vec<Vec<f64>> = rows.iter().map(|&row| own.iter().map(|&rate| values[row][rate]).collect()).collect();
    let (mut left, mut taken): (Vec<usize>, Vec<usize>) = ((0..rows.len()).collect(), Vec::new());
    while !left.is_empty() {
        let places = left.iter().flat_map(|&row| (0..own.len()).map(move |column| (row, column)));
        let places = places.filter(|(_, column)| !taken.contains(column));
        let size = |&(row, column): &(usize, usize)| matrix[row][column].abs() * weight(own[column]);
        let (row, column) = places.max_by(|a, b| size(a).total_cmp(&size(b))).expect("enough rates");
        left.retain(|&other| other != row);
        taken.push(column);
        for &other in &left {
            let factor = matrix[other][column] / matrix[row][column];
            for k in 0..own.len() {
                matrix[other][k] -= factor * matrix[row][k];
            }
        }
    }
    taken.sort_unstable();
    taken.into_iter().map(|column| own[column]).collect()
}
