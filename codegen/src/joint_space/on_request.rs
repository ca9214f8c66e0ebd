//! The functions that controllers of robots ask for, each in the shortest of its forms: forces for given accelerations,
//! the mass matrix and its factor, derivatives. They are those of trees; where loops are closed, forces along the
//! coordinates of the tree do not tell those of the mechanism.

use super::axis_dynamics::AxisTree;
use super::coordinates::Coordinates;
use super::dynamics::JointDynamics;
use super::maps;
use crate::derive::attraction;
use crate::derive::system::System;
use crate::expr::differentiate::gradient;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::groups::Functions;
use crate::simplify::cheapest::{Chosen, FinalPasses};
use crate::solve::ldl::Elimination;
use gyro_program::{Group, Kernel};
use std::collections::BTreeMap;

/// What was derived of these functions.
#[derive(Debug, Default)]
pub struct OnRequest {
    /// Of each function that is asked for the form that was chosen. u̇ is [`Symbol::RateOfRate`]; matrices are row by
    /// row.
    pub forms: BTreeMap<Kernel, Chosen>,
    /// The rates in the order of which L of the factor is lower triangular: D is on its diagonal.
    pub mass_order: Vec<usize>,
}

/// As the data sheet calls what is derived in these frames.
pub(super) const IN_BODIES: &str = "in the bodies' frames";
pub(super) const IN_JOINTS: &str = "in joint frames";

/// Of a symmetric matrix, without zeros.
pub(super) type Triangle = BTreeMap<(usize, usize), ExprId>;

/// What the forms are derived from.
pub(super) struct Parts<'c> {
    pub coordinates: &'c Coordinates,
    balance: &'c JointDynamics,
    /// In frames that suit the joints, if it is made of turns and displacements.
    pub tree: Option<AxisTree>,
    pub passes: FinalPasses,
}

impl OnRequest {
    pub fn derive(
        system: &mut System,
        coordinates: &Coordinates,
        balance: &JointDynamics,
        functions: &Functions,
    ) -> Self {
        let groups = [Group::Inverse, Group::MassMatrix, Group::Derivatives, Group::Regressor];
        let is_asked = groups.into_iter().any(|group| functions.has(group));
        if !is_asked || !coordinates.closure.rows.is_empty() {
            return Self::default();
        }
        let parts = Parts::of(system, coordinates, balance);
        let mut found = Self::default();
        let n = coordinates.layout.n_rates;
        let given: Vec<_> = (0..n).map(|rate| system.graph.symbol(Symbol::RateOfRate(rate))).collect();
        let forms = &mut found.forms;
        if functions.has(Group::Inverse) {
            forms.insert(Kernel::InverseDynamics, parts.inverse(system, &given));
            forms.insert(Kernel::BiasForces, parts.inverse(system, &vec![Graph::ZERO; n]));
            forms.insert(Kernel::GravityForces, parts.gravity(system));
        }
        if functions.has(Group::MassMatrix) {
            found.mass_order = parts.order();
            forms.insert(Kernel::MassMatrix, parts.mass_matrix(system));
            forms.insert(Kernel::MassFactor, parts.mass_factor(system, &found.mass_order));
        }
        if functions.has(Group::Regressor) {
            forms.insert(Kernel::Regressor, parts.regressor(system, &given));
        }
        if functions.has(Group::Derivatives) {
            forms.insert(Kernel::InverseDerivatives, parts.inverse_slopes(system, &given));
            forms.insert(Kernel::ForwardDerivatives, parts.forward_slopes(system, &parts.order()));
        }
        found
    }
}

impl<'c> Parts<'c> {
    pub fn of(system: &mut System, coordinates: &'c Coordinates, balance: &'c JointDynamics) -> Self {
        let tree = AxisTree::new(system, coordinates, &coordinates.invariant);
        Self { coordinates, balance, tree, passes: FinalPasses::of(false) }
    }

    /// τ at these accelerations.
    pub fn inverse(&self, system: &mut System, given: &[ExprId]) -> Chosen {
        let left = self.balance.left_over(system, given);
        let graph = &mut system.graph;
        let mut forms = vec![(IN_BODIES, left.into_iter().map(|force| graph.neg(force)).collect())];
        forms.extend(self.tree.as_ref().map(|tree| (IN_JOINTS, tree.inverse(system, given))));
        self.cheapest(system, forms)
    }

    /// The force along each rate that holds the mechanism at rest against gravity: the gradient of the potential
    /// `−Σ m g·r`, or that of a central body.
    fn gravity(&self, system: &mut System) -> Chosen {
        let gravity = system.numbers(&system.model.gravity);
        let mut potential = attraction::potential(system);
        for moving_body in 0..system.moving_bodies.len() {
            let mass = system.mass(moving_body);
            let graph = &mut system.graph;
            let r = [0, 1, 2].map(|k| graph.symbol(Symbol::Position { moving_body, k }));
            let along = graph.dot(&gravity, &r);
            let lifted = graph.mul(mass, along);
            potential = graph.sub(potential, lifted);
        }
        let potential = system.expanded(&self.coordinates.in_joints, &[potential])[0];
        let tangents = self.tangents(system);
        let places: Vec<_> = (0..self.coordinates.layout.n_coordinates).map(Symbol::Coordinate).collect();
        let slopes = gradient(&mut system.graph, potential, &places);
        let along = tangents.iter().map(|tangent| system.graph.dot_slices(tangent, &slopes)).collect();
        let mut forms = vec![("gradient of the potential", along)];
        // There gravity is an acceleration of the ground.
        let tree = self.tree.as_ref().filter(|_| system.model.attraction.is_none());
        forms.extend(tree.map(|tree| (IN_JOINTS, tree.gravity(system))));
        self.cheapest(system, forms)
    }

    /// The rates, those of joints that carry others first.
    pub fn order(&self) -> Vec<usize> {
        self.tree.as_ref().map_or_else(|| self.balance.order().to_vec(), AxisTree::order)
    }

    /// The lower triangle of M, in each form.
    pub fn triangles(&self, system: &mut System) -> Vec<(&'static str, Triangle)> {
        let mut forms = vec![(IN_BODIES, self.balance.mass_matrix(system))];
        if let Some(tree) = &self.tree {
            forms.push((IN_JOINTS, tree.global_mass_matrix(&mut system.graph)));
        }
        forms
    }

    fn mass_matrix(&self, system: &mut System) -> Chosen {
        let n = self.coordinates.layout.n_rates;
        let forms = self.triangles(system).into_iter().map(|(name, entries)| {
            let entry = |row: usize, column: usize| {
                entries.get(&(row.max(column), row.min(column))).copied().unwrap_or(Graph::ZERO)
            };
            (
                name,
                (0..n)
                    .flat_map(|row| (0..n).map(move |column| (row, column)))
                    .map(|(r, c)| entry(r, c))
                    .collect(),
            )
        });
        let forms = forms.collect();
        self.cheapest(system, forms)
    }

    /// By elimination from the leaves to the roots: then a rate takes part in the columns of those alone that its joint
    /// is carried by (R. Featherstone, *Efficient factorization of the joint-space inertia matrix for branched
    /// kinematic trees*, International Journal of Robotics Research 24 (2005)).
    fn mass_factor(&self, system: &mut System, order: &[usize]) -> Chosen {
        let n = self.coordinates.layout.n_rates;
        let forms = self.triangles(system).into_iter().map(|(name, entries)| {
            let graph = &mut system.graph;
            let mut elimination = Elimination::of_several(entries, Vec::new());
            let mut factor = vec![Graph::ZERO; n * n];
            for &rate in order.iter().rev() {
                factor[n * rate + rate] = elimination.diagonal(rate);
                elimination.pivot(graph, rate);
            }
            for (rate, other, entry) in elimination.factors() {
                factor[n * rate + other] = entry;
            }
            (name, factor)
        });
        let forms = forms.collect();
        self.cheapest(system, forms)
    }

    /// How the coordinates move along each rate: ẋ if that rate is one and all others zero.
    pub fn tangents(&self, system: &mut System) -> Vec<Vec<ExprId>> {
        let layout = &self.coordinates.layout;
        let unit = |k: usize| -> Vec<_> {
            (0..layout.n_rates).map(|l| if k == l { Graph::ONE } else { Graph::ZERO }).collect()
        };
        (0..layout.n_rates).map(|rate| maps::coordinate_rates(system, layout, &unit(rate))).collect()
    }

    /// The shortest of some forms, in terms of joint coordinates and rates.
    pub fn cheapest(&self, system: &mut System, forms: Vec<(&'static str, Vec<ExprId>)>) -> Chosen {
        let values = &self.coordinates.in_joints;
        let forms = forms.into_iter().map(|(name, roots)| (name.to_owned(), system.expanded(values, &roots)));
        let forms = forms.collect();
        self.passes.cheapest(&mut system.graph, forms)
    }
}

#[cfg(test)]
mod tests;
