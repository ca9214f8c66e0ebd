//! The derivatives of the accelerations of open trees of any number of rates, by the recursion of
//! [`super::axis_derivatives`]: with `τ = M u̇ + h`,
//!
//! ```text
//! ∂u̇/∂z = −M⁻¹ ∂τ/∂z     (u̇ held)
//! ```
//!
//! The recursion moves positions along the rates. Euler parameters p are moved by the rates `½ G(p)ᵀ e`, which are
//! orthogonal to each other and to p, along which nothing changes: with the derivatives `D` along these,
//!
//! ```text
//! ∂u̇/∂p = 4 Σ D(½ Gᵀ e_k) (½ Gᵀ e_k)ᵀ / |p|²
//! ```

use super::jacobian::{Columns, JointForm, forward};
use super::on_request::{IN_JOINTS, Parts};
use super::slopes::{against, columns_of};
use crate::derive::system::System;
use crate::expr::definitions::{Definitions, Expansion};
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
        let states = self.coordinates.layout.states();
        let is_of_state = |symbol: &Symbol| match symbol {
            Symbol::Coordinate(x) => !states.contains(x),
            Symbol::Rate(_) => true,
            _ => false,
        };
        let others: Vec<_> = variables.iter().copied().filter(|symbol| !is_of_state(symbol)).collect();
        let n = if others.len() < variables.len() { order.len() } else { 0 };
        let mut forces = Columns::new();
        if n > 0 {
            forces = columns_of(n, &parts.by_recursion(system, tree, &response.accelerations));
        }
        forces.extend(forces_by(system, &parts, &response.accelerations, &others));
        let forces = against(&mut system.graph, forces);
        let forms = response.of(&mut system.graph, forces).map(|(way, columns)| {
            let (by_place, rest) = columns.split_at(n);
            let (by_rate, by_others) = rest.split_at(n);
            let by_coordinate = self.by_coordinates(&mut system.graph, by_place);
            let mut by_others = by_others.iter();
            let column = |variable: &Symbol| match *variable {
                Symbol::Coordinate(x) if !states.contains(&x) => by_coordinate[x].clone(),
                Symbol::Rate(u) => by_rate[u].clone(),
                _ => by_others.next().expect("a column for each of the others").clone(),
            };
            (format!("{IN_JOINTS}, recursion, by {way}"), variables.iter().map(column).collect())
        });
        Some(forms.to_vec())
    }

    /// By each coordinate, from derivatives along the rates.
    fn by_coordinates(&self, graph: &mut Graph, by_place: &[Vec<ExprId>]) -> Columns {
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
        let n_rates = layout.n_rates;
        for place in layout.orientations() {
            let p: [_; 4] = from_fn(|k| graph.symbol(Symbol::Coordinate(place.x + k)));
            let (four, square) = (graph.integer(4), graph.dot(&p, &p));
            let scale = graph.div(four, square);
            let along: [_; 3] =
                from_fn(|k| graph.euler_rate(&p, &from_fn(|l| if k == l { scale } else { Graph::ZERO })));
            for j in 0..p.len() {
                let weights = along.map(|along| along[j]);
                let entry = |row: usize| {
                    let by_place: [_; 3] = from_fn(|k| by_place[place.u + k][row]);
                    graph.dot(&weights, &by_place)
                };
                columns[place.x + j] = (0..n_rates).map(entry).collect();
            }
        }
        columns
    }
}

/// The derivatives of τ at these accelerations by what is no part of the motion.
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
