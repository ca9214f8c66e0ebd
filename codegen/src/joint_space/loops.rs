//! How rates keep loops closed: `J δ = b`.
//!
//! A loop whose rates are one more than its rows and belong to no other loop (a four-bar linkage) has a single motion,
//! the vector that is perpendicular to its rows, whichever of its rates would be called independent: all its rates
//! follow from one unknown. The rows of other loops are met by multipliers. Neither has a choice of independent
//! coordinates: the formulas are singular only where the mechanism is.

use super::closure::Closure;
use super::embedding::{Embedding, RateMotion};
use crate::derive::system::System;
use crate::expr::graph::{ExprId, Graph};
use crate::solve::dependence::{self, Yielding};
use crate::solve::ldl::Elimination;
use std::collections::{BTreeMap, BTreeSet};

/// The loops of a mechanism.
#[derive(Debug, Default)]
pub struct Loops {
    single: Vec<Single>,
    /// The rows of all other loops, among those of the closure.
    pub others: Vec<usize>,
    /// What dependent rows among these yield.
    pub yielding: Yielding,
}

/// Rows that unknowns must meet, `J z = γ`, by multipliers.
#[derive(Clone, Debug)]
pub struct RemainingRows {
    pub rows: Vec<(Vec<ExprId>, ExprId)>,
    /// What rows yield to multipliers that depend on others.
    pub yielding: Yielding,
}

/// A loop with a single motion.
#[derive(Debug)]
struct Single {
    /// Among those of the closure.
    rows: Vec<usize>,
    rates: Vec<usize>,
    solve: Solve,
}

#[derive(Debug)]
enum Solve {
    /// Two rates and a row, with the inverse of its square.
    Pair { row: [ExprId; 2], inverse: ExprId },
    /// Three rates and two rows, their cross product, and the inverse of its square.
    Triple { rows: [[ExprId; 3]; 2], motion: [ExprId; 3], inverse: ExprId },
}

impl Loops {
    /// `groups` are the rows of each joint.
    pub fn of(system: &mut System, closure: &Closure, groups: &[Vec<usize>]) -> Self {
        let rates: Vec<_> = groups.iter().map(|rows| closure.rates_of(rows)).collect();
        let mut loops = Self { yielding: yielding(system, closure), ..Self::default() };
        let graph = &mut system.graph;
        let yields = |row: &usize| loops.yielding.contains_key(&(*row, *row));
        let yielding: Vec<_> = groups.iter().map(|rows| rows.iter().any(yields)).collect();
        for (place, rows) in groups.iter().enumerate() {
            let is_alone =
                (0..groups.len()).all(|other| other == place || rates[other].is_disjoint(&rates[place]));
            match Single::of(graph, closure, rows, &rates[place]) {
                Some(single) if is_alone && !yielding[place] => loops.single.push(single),
                _ => loops.others.extend(rows),
            }
        }
        loops
    }

    /// How the rates move: for all values of the unknowns the single loops stay closed, `J u̇ = γ`.
    pub fn embedding(&self, graph: &mut Graph, closure: &Closure, n_rates: usize) -> Embedding {
        let mut embedding = Embedding { rates: Vec::new(), n_unknowns: 0 };
        let mut in_loops = BTreeMap::new();
        for single in &self.single {
            let rhs = single.rows.iter().map(|&row| closure.gamma[row]).collect();
            let motion = single.motion(graph).into_iter().zip(single.least(graph, rhs));
            in_loops.extend(
                single.rates.iter().zip(motion).map(|(&rate, motion)| (rate, (motion, single.rates[0]))),
            );
        }
        let mut unknowns = BTreeMap::new();
        for rate in 0..n_rates {
            let ((factor, bias), first) = in_loops.remove(&rate).unwrap_or(((Graph::ONE, Graph::ZERO), rate));
            let unknown = *unknowns.entry(first).or_insert_with(|| embedding.unknown());
            embedding.rates.push(RateMotion { columns: vec![(unknown, factor)], bias });
        }
        embedding
    }

    /// The least rates with `J δ = b`.
    pub fn changes(
        &self,
        graph: &mut Graph,
        closure: &Closure,
        rhs: &[ExprId],
        n_rates: usize,
    ) -> Vec<ExprId> {
        let mut changes = vec![Graph::ZERO; n_rates];
        for single in &self.single {
            let rhs = single.rows.iter().map(|&row| rhs[row]).collect();
            single
                .rates
                .iter()
                .zip(single.least(graph, rhs))
                .for_each(|(&rate, change)| changes[rate] = change);
        }
        let rhs = self.others.iter().map(|&row| rhs[row]).collect();
        let weights = self.square(graph, closure, rhs).solve_in_order(graph);
        for (&row, weight) in self.others.iter().zip(weights) {
            for (change, &entry) in changes.iter_mut().zip(&closure.jacobian[row]) {
                let part = graph.mul(entry, weight);
                *change = graph.add(*change, part);
            }
        }
        changes
    }

    /// `Jᵀ λ = f` for forces along the rates that rows of loops can supply.
    pub fn multipliers(&self, graph: &mut Graph, closure: &Closure, forces: &[ExprId]) -> Vec<ExprId> {
        let mut multipliers = vec![Graph::ZERO; closure.rows.len()];
        for single in &self.single {
            let forces: Vec<_> = single.rates.iter().map(|&rate| forces[rate]).collect();
            let found = single.transposed(graph, &forces);
            single.rows.iter().zip(found).for_each(|(&row, multiplier)| multipliers[row] = multiplier);
        }
        let rhs = self.others.iter().map(|&row| graph.dot_slices(&closure.jacobian[row], forces)).collect();
        let found = self.square(graph, closure, rhs).solve_in_order(graph);
        self.others.iter().zip(found).for_each(|(&row, multiplier)| multipliers[row] = multiplier);
        multipliers
    }

    /// The squares of the distances of the rows of J, each from the span of those before it.
    pub fn distances(&self, graph: &mut Graph, closure: &Closure) -> Vec<ExprId> {
        let mut distances = vec![Graph::ZERO; closure.rows.len()];
        for single in &self.single {
            let found = single.distances(graph);
            single.rows.iter().zip(found).for_each(|(&row, distance)| distances[row] = distance);
        }
        let none = vec![Graph::ZERO; self.others.len()];
        let found = self.square(graph, closure, none).pivots_in_order(graph);
        self.others.iter().zip(found).for_each(|(&row, distance)| distances[row] = distance);
        distances
    }

    /// By places among the rows of the other loops.
    pub fn yielding_of_others(&self) -> Yielding {
        let place = |row: usize| {
            self.others.iter().position(|&other| other == row).expect("they are met by multipliers")
        };
        self.yielding.iter().map(|(&(k, l), &entry)| ((place(k), place(l)), entry)).collect()
    }

    /// `J Jᵀ w = b` for the rows of the other loops.
    fn square(&self, graph: &mut Graph, closure: &Closure, rhs: Vec<ExprId>) -> Elimination {
        let mut square = BTreeMap::new();
        for (k, &row) in self.others.iter().enumerate() {
            for (l, &other) in self.others[..=k].iter().enumerate() {
                square.insert((k, l), graph.dot_slices(&closure.jacobian[row], &closure.jacobian[other]));
            }
        }
        for ((k, l), yielding) in self.yielding_of_others() {
            let entry = square.entry((k, l)).or_insert(Graph::ZERO);
            *entry = graph.add(*entry, yielding);
        }
        square.retain(|_, entry| *entry != Graph::ZERO);
        Elimination::new(square, rhs)
    }
}

/// Of all rows that depend on each other, by their places among those of the closure.
fn yielding(system: &mut System, closure: &Closure) -> Yielding {
    let mut all = Yielding::new();
    for set in system.model.dependent_rows() {
        let is_own = |place: &usize| set.contains(&closure.rows[*place]);
        let places: Vec<_> = (0..closure.rows.len()).filter(is_own).collect();
        let rows = places.iter().map(|&place| (closure.rows[place], closure.jacobian[place].as_slice()));
        let rows: Vec<_> = rows.collect();
        let own = dependence::yielding(&mut system.graph, system.model, &rows);
        all.extend(own.into_iter().map(|((k, l), entry)| ((places[k], places[l]), entry)));
    }
    all
}

impl Single {
    /// The squares of the distances of the rows, each from the span of those before it.
    fn distances(&self, graph: &mut Graph) -> Vec<ExprId> {
        match &self.solve {
            Solve::Pair { row, .. } => vec![graph.dot_slices(row, row)],
            Solve::Triple { rows: [first, _], motion, .. } => {
                let [first, area] = [first, motion].map(|vector| graph.dot(vector, vector));
                vec![first, graph.div(area, first)]
            }
        }
    }

    /// `None` if the loop has not a single motion, or one for which there is no short formula.
    fn of(graph: &mut Graph, closure: &Closure, rows: &[usize], rates: &BTreeSet<usize>) -> Option<Self> {
        let rates: Vec<_> = rates.iter().copied().collect();
        let entry = |row: usize, rate: usize| closure.jacobian[row][rate];
        let solve = match (rows, &rates[..]) {
            (&[row], &[a, b]) => {
                let row = [entry(row, a), entry(row, b)];
                let square = graph.dot(&row, &row);
                Solve::Pair { row, inverse: graph.recip(square) }
            }
            (&[first, second], &[a, b, c]) => {
                let rows = [first, second].map(|row| [a, b, c].map(|rate| entry(row, rate)));
                let motion = graph.cross(&rows[0], &rows[1]);
                let square = graph.dot(&motion, &motion);
                Solve::Triple { rows, motion, inverse: graph.recip(square) }
            }
            _ => return None,
        };
        Some(Self { rows: rows.to_vec(), rates, solve })
    }

    /// Perpendicular to the rows.
    fn motion(&self, graph: &mut Graph) -> Vec<ExprId> {
        match &self.solve {
            Solve::Pair { row: [a, b], .. } => vec![*b, graph.neg(*a)],
            Solve::Triple { motion, .. } => motion.to_vec(),
        }
    }

    /// The least rates with `J δ = b`.
    fn least(&self, graph: &mut Graph, rhs: Vec<ExprId>) -> Vec<ExprId> {
        match &self.solve {
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
        }
    }

    /// λ with `Jᵀ λ = f`.
    fn transposed(&self, graph: &mut Graph, forces: &[ExprId]) -> Vec<ExprId> {
        match &self.solve {
            Solve::Pair { row, inverse } => {
                let along = graph.dot_slices(row, forces);
                vec![graph.mul(along, *inverse)]
            }
            Solve::Triple { rows: [first, second], motion, inverse } => {
                let duals = [graph.cross(second, motion), graph.cross(motion, first)];
                let supplied = duals.map(|dual| graph.dot_slices(&dual, forces));
                supplied.map(|along| graph.mul(along, *inverse)).to_vec()
            }
        }
    }
}
