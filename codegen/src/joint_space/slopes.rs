//! The derivatives of forces and accelerations by positions and rates, of as many rates as there are: by recursion
//! where frames suit the joints, and by differentiating expressions. Positions change along the rates: Euler
//! parameters turn by a small rotation.
//!
//! Where τ = M u̇ + h holds the accelerations' derivatives are those of the forces they take: `∂u̇/∂z = −M⁻¹ ∂τ/∂z`
//! with u̇ held.

use super::axis_derivatives::Entries;
use super::axis_dynamics::AxisTree;
use super::on_request::{IN_JOINTS, Parts, Triangle};
use crate::derive::system::System;
use crate::expr::definitions::{Definitions, Expansion, Values};
use crate::expr::differentiate::{Derivative, Direction, gradient};
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::simplify::cheapest::Chosen;
use crate::solve::ldl::Elimination;

/// Beyond this many rates expressions are not differentiated where there is a recursion: that is longer.
const MAX_DIFFERENTIATED: usize = 4;

/// n × n by positions and n × n by rates, row by row.
type Slopes = [Vec<ExprId>; 2];

/// The columns of a matrix.
type Columns = Vec<Vec<ExprId>>;

/// How a mechanism answers forces along its rates.
pub(super) struct Response<'o> {
    order: &'o [usize],
    mass: Triangle,
    /// `M⁻¹`, row by row.
    inverse: Vec<ExprId>,
    /// u̇ where no forces act but those of the model.
    pub accelerations: Vec<ExprId>,
}

impl Response<'_> {
    /// `M⁻¹` times some columns, in two ways.
    pub fn of(&self, graph: &mut Graph, columns: Columns) -> [(&'static str, Columns); 2] {
        let n = self.order.len();
        let by_inverse = columns
            .iter()
            .map(|column| self.inverse.chunks(n).map(|row| graph.dot_slices(row, column)).collect())
            .collect();
        let by_factor = solved(graph, (&self.mass, self.order), columns);
        [("M⁻¹", by_inverse), ("the factor of M", by_factor)]
    }
}

impl Parts<'_> {
    /// ∂τ/∂(x, u) of given u̇.
    pub fn inverse_slopes(&self, system: &mut System, given: &[ExprId]) -> Chosen {
        let forms = self.slopes(system, given).into_iter();
        let n = given.len();
        let forms =
            forms.map(|(name, slopes)| (name, beside(n, &slopes.each_ref().map(Vec::as_slice)))).collect();
        self.cheapest(system, forms)
    }

    /// ∂u̇/∂(x, u, τ).
    pub fn forward_slopes(&self, system: &mut System, order: &[usize]) -> Chosen {
        let n = order.len();
        let response = self.response(system, order);
        let mut forms = Vec::new();
        for (name, slopes) in self.slopes(system, &response.accelerations) {
            let graph = &mut system.graph;
            let columns = against(graph, columns_of(n, &slopes));
            for (way, columns) in response.of(graph, columns) {
                let [by_place, by_rate] = [0, n].map(|first| {
                    let columns = &columns[first..first + n];
                    (0..n).flat_map(|row| columns.iter().map(move |column| column[row])).collect::<Vec<_>>()
                });
                let all = beside(n, &[&by_place, &by_rate, &response.inverse]);
                forms.push((format!("{name}, by {way}"), all));
            }
        }
        self.passes.cheapest(&mut system.graph, forms)
    }

    /// How the mechanism answers forces.
    pub fn response<'o>(&self, system: &mut System, order: &'o [usize]) -> Response<'o> {
        let bias = self.inverse(system, &vec![Graph::ZERO; order.len()]).roots;
        let (_, mass) = self.triangles(system).pop().expect("there is one form at least");
        let mass = self.expanded(system, mass);
        let graph = &mut system.graph;
        let driving = bias.into_iter().map(|force| graph.neg(force)).collect();
        let accelerations = solved(graph, (&mass, order), vec![driving]).swap_remove(0);
        let inverse = inverse_of(graph, &mass, order);
        Response { order, mass, inverse, accelerations }
    }

    /// In several ways, expanded.
    fn slopes(&self, system: &mut System, given: &[ExprId]) -> Vec<(&'static str, Slopes)> {
        let mut forms = Vec::new();
        if let Some(tree) = &self.tree {
            forms.push((IN_JOINTS, self.by_recursion(system, tree, given)));
        }
        if self.tree.is_none() || given.len() <= MAX_DIFFERENTIATED {
            // u̇ is held.
            let held: Vec<_> =
                (0..given.len()).map(|rate| system.graph.symbol(Symbol::RateOfRate(rate))).collect();
            let tau = self.inverse(system, &held).roots;
            let values = given.iter().enumerate().map(|(rate, &value)| (Symbol::RateOfRate(rate), value));
            let values: Values = values.collect();
            let definitions = Definitions::default();
            let mut at_given = Expansion::with_values(&definitions, values);
            for (name, slopes) in [
                ("from the leaves of τ", self.by_leaves(system, &tau)),
                ("from the roots of τ", self.by_roots(system, &tau)),
            ] {
                forms.push((name, slopes.map(|slopes| at_given.all(&mut system.graph, &slopes))));
            }
        }
        forms
    }

    /// Of what inertia and gravity take by recursion; less those of what else acts.
    pub fn by_recursion(&self, system: &mut System, tree: &AxisTree, given: &[ExprId]) -> Slopes {
        let n = given.len();
        let motions = tree.motions(system, given);
        let slopes = tree.slopes(system, &motions);
        let acting = tree.acting(system);
        let acting = system.expanded(&self.coordinates.in_joints, &acting);
        let acting = self.by_leaves(system, &acting);
        let rigid =
            [slopes.by_place, slopes.by_rate].map(|entries| tree.rows_to_global(&mut system.graph, entries));
        let mut all = rigid.into_iter().zip(acting).map(|(rigid, acting)| {
            let rigid = self.dense(system, n, &rigid);
            let graph = &mut system.graph;
            rigid.into_iter().zip(acting).map(|(a, b)| graph.sub(a, b)).collect()
        });
        [all.next(), all.next()].map(|slopes| slopes.expect("there are two"))
    }

    /// Of expressions in joint coordinates and rates, one expression after the other.
    fn by_roots(&self, system: &mut System, roots: &[ExprId]) -> Slopes {
        let tangents = self.tangents(system);
        let places: Vec<_> = (0..self.coordinates.layout.n_coordinates).map(Symbol::Coordinate).collect();
        let rates: Vec<_> = (0..tangents.len()).map(Symbol::Rate).collect();
        let (graph, mut slopes) = (&mut system.graph, [Vec::new(), Vec::new()]);
        for &root in roots {
            let by_places = gradient(graph, root, &places);
            slopes[0].extend(tangents.iter().map(|tangent| graph.dot_slices(tangent, &by_places)));
            slopes[1].extend(gradient(graph, root, &rates));
        }
        slopes
    }

    /// One variable after the other.
    fn by_leaves(&self, system: &mut System, roots: &[ExprId]) -> Slopes {
        let (definitions, tangents) = (Definitions::default(), self.tangents(system));
        let along = |tangent: &Vec<ExprId>| -> Direction {
            let all = tangent.iter().enumerate().filter(|(_, rate)| **rate != Graph::ZERO);
            all.map(|(x, &rate)| (Symbol::Coordinate(x), rate)).collect()
        };
        let by_place: Vec<Direction> = tangents.iter().map(along).collect();
        let by_rate: Vec<Direction> =
            (0..tangents.len()).map(|rate| Direction::from([(Symbol::Rate(rate), Graph::ONE)])).collect();
        let graph = &mut system.graph;
        [by_place, by_rate].map(|directions| {
            let columns: Vec<Vec<_>> = directions
                .into_iter()
                .map(|direction| {
                    let mut derivative = Derivative::new(&definitions, direction);
                    roots.iter().map(|&root| derivative.of(graph, root)).collect()
                })
                .collect();
            (0..roots.len()).flat_map(|row| columns.iter().map(move |column| column[row])).collect()
        })
    }

    fn dense(&self, system: &mut System, n: usize, entries: &Entries) -> Vec<ExprId> {
        let entry = |place: usize| entries.get(&(place / n, place % n)).copied().unwrap_or(Graph::ZERO);
        let all: Vec<_> = (0..n * n).map(entry).collect();
        system.expanded(&self.coordinates.in_joints, &all)
    }

    fn expanded(&self, system: &mut System, entries: Triangle) -> Triangle {
        let (places, entries): (Vec<_>, Vec<_>) = entries.into_iter().unzip();
        places.into_iter().zip(system.expanded(&self.coordinates.in_joints, &entries)).collect()
    }
}

/// The columns of n × n matrices that are given row by row.
pub(super) fn columns_of(n: usize, matrices: &[Vec<ExprId>]) -> Columns {
    let column = |matrix: &[ExprId], column: usize| (0..n).map(|row| matrix[n * row + column]).collect();
    matrices.iter().flat_map(|matrix| (0..n).map(|k| column(matrix, k))).collect()
}

/// Minus some columns.
pub(super) fn against(graph: &mut Graph, columns: Columns) -> Columns {
    columns.into_iter().map(|column| column.into_iter().map(|entry| graph.neg(entry)).collect()).collect()
}

/// Matrices of n rows beside each other, row by row.
fn beside(n: usize, matrices: &[&[ExprId]]) -> Vec<ExprId> {
    let row = |row: usize| matrices.iter().flat_map(move |matrix| &matrix[n * row..n * (row + 1)]).copied();
    (0..n).flat_map(row).collect()
}

/// `M⁻¹` times some columns, eliminated from the last rate in the order to the first.
fn solved(graph: &mut Graph, (mass, order): (&Triangle, &[usize]), columns: Columns) -> Columns {
    let mut elimination = Elimination::of_several(mass.clone(), columns);
    order.iter().rev().for_each(|&rate| elimination.pivot(graph, rate));
    elimination.solutions(graph)
}

/// `M⁻¹` of `M = Lᵀ D L`, row by row: as `L M⁻¹ = D⁻¹ L⁻ᵀ` is zero below its diagonal, where L is not, each entry
/// follows from those of the rates before it in the order.
fn inverse_of(graph: &mut Graph, mass: &Triangle, order: &[usize]) -> Vec<ExprId> {
    let n = order.len();
    let mut elimination = Elimination::of_several(mass.clone(), Vec::new());
    let mut pivots = vec![Graph::ZERO; n];
    for &rate in order.iter().rev() {
        pivots[rate] = elimination.diagonal(rate);
        elimination.pivot(graph, rate);
    }
    let mut inverse = vec![Graph::ZERO; n * n];
    for (place, &i) in order.iter().enumerate() {
        let row: Vec<_> = elimination.factors().filter(|(rate, ..)| *rate == i).collect();
        for &j in &order[..=place] {
            let mut entry = if i == j { graph.recip(pivots[i]) } else { Graph::ZERO };
            for &(_, k, factor) in &row {
                let part = graph.mul(factor, inverse[n * k + j]);
                entry = graph.sub(entry, part);
            }
            (inverse[n * i + j], inverse[n * j + i]) = (entry, entry);
        }
    }
    inverse
}
