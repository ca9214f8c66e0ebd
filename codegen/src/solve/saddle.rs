//! The solve of eq. (17) whole: an unrolled LDLᵀ factorisation of the saddle matrix, its order chosen here. It squares
//! the condition of the joints' Jacobian, so `null_space` is preferred; this is what that is compared with.
//!
//! Without pivoting at run time the order must be safe by itself: *no multiplier before all six velocities of its child
//! body*. Then every pivot is a composite inertia or minus a joint's effective inverse mass, never a mathematical zero.
//! Within that rule several orders are tried and the one with the fewest operations wins.

use crate::derive::Textbook;
use crate::derive::kinematics::Matrix;
use crate::derive::system::System;
use crate::expr::definitions::Expansion;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::schedule::Operations;
use crate::solve::Solution;
use crate::solve::ldl::Elimination;
use gyro_model::{Attachment, RowOwner};
use std::collections::BTreeMap;

/// `[M Φᵀ; Φ 0] [v̇; λ] = [f; γ]`, expanded: its entries are final expressions.
#[derive(Debug)]
struct Saddle {
    /// Lower triangle, without zeros.
    entries: BTreeMap<(usize, usize), ExprId>,
    rhs: Vec<ExprId>,
}

/// Which of the unknowns that may come next is eliminated first.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Preference {
    /// The one with the fewest neighbours (minimum degree), leaves before roots.
    FewestNeighbours,
    /// Body after body from the leaves: its velocities, then its joint's multipliers.
    LeafToRoot,
    /// Like it, angular velocities and the multipliers of dot-1 rows first.
    LeafToRootRotationsFirst,
    /// All velocities, then the multipliers (Schur complement on λ).
    VelocitiesFirst,
}

const PREFERENCES: [Preference; 4] = [
    Preference::FewestNeighbours,
    Preference::LeafToRoot,
    Preference::LeafToRootRotationsFirst,
    Preference::VelocitiesFirst,
];

/// Solves eq. (17) of a mechanism whose rows are all those of its trees' joints.
pub fn solve(system: &mut System, textbook: &Textbook) -> Solution {
    let Textbook { kinematics, dynamics } = textbook;
    let definitions = std::mem::take(&mut system.definitions);
    let mut expansion = Expansion::new(&definitions);
    let graph = &mut system.graph;
    let phi_pi: Matrix = kinematics.phi_pi.iter().map(|row| expansion.all(graph, row)).collect();
    let (force, gamma) =
        (expansion.all(graph, &dynamics.applied_force), expansion.all(graph, &kinematics.gamma));
    system.definitions = definitions;
    let saddle = Saddle::new(&dynamics.mass_matrix, &phi_pi, &force, &gamma);
    let mut accelerations = saddle.solve(system);
    let lambda = accelerations.split_off(force.len());
    Solution { solved: accelerations, lambda }
}

impl Saddle {
    fn new(mass_matrix: &Matrix, phi_pi: &Matrix, force: &[ExprId], gamma: &[ExprId]) -> Self {
        let n_velocities = mass_matrix.len();
        let mut entries = BTreeMap::new();
        let lower = mass_matrix.iter().enumerate().flat_map(|(row, values)| {
            values.iter().enumerate().take(row + 1).map(move |(column, v)| ((row, column), *v))
        });
        let below = phi_pi.iter().enumerate().flat_map(|(row, values)| {
            values.iter().enumerate().map(move |(column, v)| ((n_velocities + row, column), *v))
        });
        entries.extend(lower.chain(below).filter(|(_, value)| *value != Graph::ZERO));
        Self { entries, rhs: force.iter().chain(gamma).copied().collect() }
    }

    /// Accelerations, then multipliers, by the cheapest safe order.
    fn solve(&self, system: &mut System) -> Vec<ExprId> {
        let keys: Vec<_> = (0..self.rhs.len()).map(|unknown| Place::of(system, unknown)).collect();
        let solutions: Vec<_> =
            PREFERENCES.iter().map(|&p| self.eliminate(&mut system.graph, &keys, p)).collect();
        let cost = |solution: &Vec<ExprId>| Operations::recurring(&system.graph, solution).total();
        solutions.into_iter().min_by_key(cost).expect("there is a preference")
    }

    fn eliminate(&self, graph: &mut Graph, places: &[Place], preference: Preference) -> Vec<ExprId> {
        let mut elimination = Elimination::new(self.entries.clone(), self.rhs.clone());
        let mut remaining: Vec<usize> = (0..places.len()).collect();
        while !remaining.is_empty() {
            let pivot = choose(&elimination, places, &remaining, preference);
            remaining.retain(|&unknown| unknown != pivot);
            elimination.pivot(graph, pivot);
        }
        elimination.substitute_back(graph)
    }
}

/// Where in the mechanism an unknown of eq. (17) belongs.
#[derive(Clone, Copy, Debug)]
struct Place {
    /// Distance from the leaves in the order of elimination: children come before parents.
    from_leaf: usize,
    moving_body: usize,
    is_multiplier: bool,
    is_rotation: bool,
}

impl Place {
    fn of(system: &System, unknown: usize) -> Self {
        let n_velocities = 6 * system.moving_bodies.len();
        let (moving_body, is_multiplier, is_rotation) = if unknown < n_velocities {
            (unknown / 6, false, unknown % 6 >= 3)
        } else {
            let row = system.model.rows()[unknown - n_velocities];
            (child_body(system, row.owner), true, row.unit == gyro_model::RowUnit::Pure)
        };
        let link = system.tree.links.iter().position(|link| link.body == system.moving_bodies[moving_body]);
        let from_leaf = system.tree.links.len() - link.expect("every moving body is a link of the tree");
        Self { from_leaf, moving_body, is_multiplier, is_rotation }
    }
}

/// The moving body of the body that hangs on a row: the child of its joint.
fn child_body(system: &System, owner: RowOwner) -> usize {
    let hangs_on = |attachment: Attachment| match owner {
        RowOwner::Joint(index) => matches!(attachment, Attachment::Joint { joint, .. } if joint == index),
        _ => false,
    };
    let body = match owner {
        RowOwner::Body(body) => body,
        _ => {
            let link = system.tree.links.iter().find(|link| hangs_on(link.attachment));
            link.expect("every joint of a tree leads to a body").body
        }
    };
    system.moving_body_of(body).expect("a body with rows has coordinates")
}

/// The next pivot among those that the safe-order rule admits.
fn choose(elimination: &Elimination, places: &[Place], remaining: &[usize], preference: Preference) -> usize {
    let safe = |unknown: usize| {
        let place = places[unknown];
        let waits =
            |&other: &usize| !places[other].is_multiplier && places[other].moving_body == place.moving_body;
        !place.is_multiplier || !remaining.iter().any(waits)
    };
    let key = |unknown: usize| {
        let place = places[unknown];
        let body = (place.from_leaf, usize::from(place.is_multiplier));
        match preference {
            Preference::FewestNeighbours => (elimination.neighbours(unknown).len(), body.0, body.1),
            Preference::LeafToRoot => (body.0, body.1, 0),
            Preference::LeafToRootRotationsFirst => (body.0, body.1, usize::from(!place.is_rotation)),
            Preference::VelocitiesFirst => (body.1, body.0, 0),
        }
    };
    let admitted = remaining.iter().copied().filter(|&unknown| safe(unknown));
    admitted.min_by_key(|&unknown| (key(unknown), unknown)).expect("a velocity is always safe")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::evaluate::{evaluate, sample};
    use crate::expr::symbol::Symbol;

    const PAGE: &str = include_str!("../../../models/gyroscope.toml");

    /// Every order solves the same system: put back into it, the solution leaves no residual.
    #[test]
    fn every_order_recomposes_the_system() {
        let model = gyro_model::read("gyroscope.toml", PAGE).expect("the model file is good");
        let mut system = System::new(&model);
        let n = 6 * system.moving_bodies.len();
        let n_rows = model.rows().len();
        let mut symbol = |k: usize| system.graph.symbol(Symbol::Parameter(k));
        let mut mass_matrix = vec![vec![Graph::ZERO; n]; n];
        (0..n).for_each(|k| mass_matrix[k][k] = symbol(k));
        // Each row acts on the velocities of its own body and of the body before it, as in a chain.
        let touches = |row: usize, column: usize| (row / 5) * 6 <= column + 6 && column < (row / 5 + 1) * 6;
        let mut entry =
            |row, column| if touches(row, column) { symbol(1000 + 100 * row + column) } else { Graph::ZERO };
        let phi_pi: Matrix =
            (0..n_rows).map(|row| (0..n).map(|column| entry(row, column)).collect()).collect();
        let rhs: Vec<_> = (0..n + n_rows).map(|k| symbol(100 + k)).collect();
        let saddle = Saddle::new(&mass_matrix, &phi_pi, &rhs[..n], &rhs[n..]);
        let places: Vec<_> = (0..n + n_rows).map(|unknown| Place::of(&system, unknown)).collect();
        for preference in PREFERENCES {
            let x = saddle.eliminate(&mut system.graph, &places, preference);
            let value = |symbol| {
                sample(7)(symbol) + if matches!(symbol, Symbol::Parameter(0..100)) { 2.0 } else { 0.0 }
            };
            let x = evaluate(&system.graph, &x, value);
            let mut residual: Vec<f64> = evaluate(&system.graph, &rhs, value);
            for (&(row, column), &entry) in &saddle.entries {
                let entry = evaluate(&system.graph, &[entry], value)[0];
                residual[row] -= entry * x[column];
                if row != column {
                    residual[column] -= entry * x[row];
                }
            }
            let worst = residual.iter().fold(0.0, |worst: f64, r| worst.max(r.abs()));
            let size = x.iter().fold(1.0, |size: f64, x| size.max(x.abs()));
            assert!(worst <= 1e-9 * size, "{preference:?}: {worst} of {size}");
        }
    }

    #[test]
    fn no_multiplier_comes_before_the_velocities_of_its_child() {
        let model = gyro_model::read("gyroscope.toml", PAGE).expect("the model file is good");
        let system = System::new(&model);
        let (n, n_rows) = (6 * system.moving_bodies.len(), model.rows().len());
        let places: Vec<_> = (0..n + n_rows).map(|unknown| Place::of(&system, unknown)).collect();
        let elimination = Elimination::new(BTreeMap::new(), Vec::new());
        for preference in PREFERENCES {
            let mut remaining: Vec<usize> = (0..places.len()).collect();
            while !remaining.is_empty() {
                let pivot = choose(&elimination, &places, &remaining, preference);
                remaining.retain(|&unknown| unknown != pivot);
                let child = |unknown: &usize| {
                    !places[*unknown].is_multiplier
                        && places[*unknown].moving_body == places[pivot].moving_body
                };
                assert!(
                    !places[pivot].is_multiplier || !remaining.iter().any(child),
                    "{preference:?}: {pivot}"
                );
            }
        }
    }
}
