//! The derivatives of the accelerations of open trees of any number of rates, by the recursion of
//! [`super::axis_derivatives`]: with `τ = M u̇ + h`,
//!
//! ```text
//! ∂u̇/∂z = −M⁻¹ ∂τ/∂z     (u̇ held)
//! ```
//!
//! The recursion moves positions along the rates. Euler parameters p are moved by the rates `½ G(p)ᵀ e`, which are
//! orthogonal to each other and to p: with the derivatives `D` along these, and along p,
//!
//! ```text
//! ∂u̇/∂p = 4 Σ D(½ Gᵀ e_k) (½ Gᵀ e_k)ᵀ + D(p) pᵀ     (|p| = 1)
//! ```

use super::coordinates::Coordinates;
use super::jacobian::{Columns, JointForm, forward};
use super::layout::Place;
use super::on_request::{IN_JOINTS, Parts};
use super::slopes::{against, columns_of};
use crate::derive::system::System;
use crate::expr::definitions::{Definitions, Expansion};
use crate::expr::differentiate::{Derivative, Direction};
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use std::array::from_fn;

impl JointForm<'_> {
    /// ∂u̇ by each variable, in several ways; `None` if there is no recursion.
    pub fn by_recursion(&self, system: &mut System, variables: &[Symbol]) -> Option<Vec<(String, Columns)>> {
        if !self.coordinates.closure.rows.is_empty() {
            return None;
        }
        let parts = Parts::of(system, self.coordinates, self.balance);
        let (tree, order) = (parts.tree.as_ref()?, parts.order());
        let response = parts.response(system, &order);
        let is_of_state = |symbol: &Symbol| matches!(symbol, Symbol::Coordinate(_) | Symbol::Rate(_));
        let others: Vec<_> = variables.iter().copied().filter(|symbol| !is_of_state(symbol)).collect();
        let n = if others.len() < variables.len() { order.len() } else { 0 };
        let mut forces = Columns::new();
        if n > 0 {
            forces = columns_of(n, &parts.by_recursion(system, tree, &response.accelerations));
        }
        forces.extend(forces_by(system, &parts, &response.accelerations, &others));
        let forces = against(&mut system.graph, forces);
        let across = self.across_spheres(&mut system.graph, n);
        let forms = response.of(&mut system.graph, forces).map(|(way, columns)| {
            let (by_place, rest) = columns.split_at(n);
            let (by_rate, by_others) = rest.split_at(n);
            let by_coordinate = self.by_coordinates(&mut system.graph, by_place, &across);
            let mut by_others = by_others.iter();
            let column = |variable: &Symbol| match *variable {
                Symbol::Coordinate(x) => by_coordinate[x].clone(),
                Symbol::Rate(u) => by_rate[u].clone(),
                _ => by_others.next().expect("a column for each of the others").clone(),
            };
            (format!("{IN_JOINTS}, recursion, by {way}"), variables.iter().map(column).collect())
        });
        Some(forms.to_vec())
    }

    /// The derivatives of the accelerations along p, for each p; none if nothing is derived by the state.
    fn across_spheres(&self, graph: &mut Graph, n: usize) -> Columns {
        if n == 0 {
            return Columns::new();
        }
        let definitions = Definitions::default();
        let mut across = Columns::new();
        for place in orientations(self.coordinates) {
            let along: Direction = (place.x..place.x + 4)
                .map(|x| (Symbol::Coordinate(x), graph.symbol(Symbol::Coordinate(x))))
                .collect();
            let mut derivative = Derivative::new(&definitions, along);
            across.push(self.accelerations[0].iter().map(|&root| derivative.of(graph, root)).collect());
        }
        across
    }

    /// By each coordinate, from derivatives along the rates and across the spheres.
    fn by_coordinates(&self, graph: &mut Graph, by_place: &[Vec<ExprId>], across: &Columns) -> Columns {
        let layout = &self.coordinates.layout;
        let mut columns = vec![Vec::new(); layout.n_coordinates];
        if by_place.is_empty() {
            return columns;
        }
        for scalar in layout.scalars() {
            columns[scalar.place.x].clone_from(&by_place[scalar.place.u]);
        }
        for place in layout.links.iter().filter_map(|link| link.position) {
            (0..3).for_each(|k| columns[place.x + k].clone_from(&by_place[place.u + k]));
        }
        for (place, across) in orientations(self.coordinates).zip(across) {
            let p: [_; 4] = from_fn(|k| graph.symbol(Symbol::Coordinate(place.x + k)));
            let four = graph.integer(4);
            let along: [_; 3] =
                from_fn(|k| graph.euler_rate(&p, &from_fn(|l| if k == l { four } else { Graph::ZERO })));
            for (j, &p) in p.iter().enumerate() {
                let weights = [along[0][j], along[1][j], along[2][j], p];
                let entry = |row: usize| {
                    let [a, b, c]: [_; 3] = from_fn(|k| by_place[place.u + k][row]);
                    graph.dot_slices(&weights, &[a, b, c, across[row]])
                };
                columns[place.x + j] = (0..across.len()).map(entry).collect();
            }
        }
        columns
    }
}

/// Where Euler parameters stand.
fn orientations(coordinates: &Coordinates) -> impl Iterator<Item = Place> {
    coordinates.layout.links.iter().filter_map(|link| link.orientation)
}

/// The derivatives of τ at these accelerations by what is no part of the state.
fn forces_by(
    system: &mut System,
    parts: &Parts<'_>,
    accelerations: &[ExprId],
    variables: &[Symbol],
) -> Columns {
    if variables.is_empty() {
        return Columns::new();
    }
    let held = (0..accelerations.len()).map(Symbol::RateOfRate);
    let symbols: Vec<_> = held.clone().map(|rate| system.graph.symbol(rate)).collect();
    let tau = parts.inverse(system, &symbols).roots;
    let (definitions, values) = (Definitions::default(), held.zip(accelerations.iter().copied()).collect());
    let mut at_given = Expansion::with_values(&definitions, values);
    let graph = &mut system.graph;
    let columns = forward(graph, &tau, variables);
    columns.iter().map(|column| at_given.all(graph, column)).collect()
}
