//! The forms of u̇, the derivatives of the rates, that are compared.

use super::coordinates::Coordinates;
use super::dynamics::{self, JointDynamics, MAX_FACTORED, NORMAL_FORM};
use super::planar;
use crate::derive::system::System;
use crate::expr::definitions::Values;
use crate::expr::graph::ExprId;
use crate::expr::vector::Vec3;
use crate::simplify::cheapest::FinalPasses;
use crate::simplify::normal_form::Reduction;
use crate::solve::cancellation::{self, Trials};
use crate::solve::gram_schmidt;

/// A form of u̇ and what it is called, in symbols that are yet to be expanded.
pub type Candidate = (&'static str, Vec<ExprId>);

/// The forms of u̇. Those on the bodies' spins are useful where a maximal state provides the angular velocities.
#[derive(Debug)]
pub struct Candidates {
    /// What u̇ is the solution of, angular velocities made of rates.
    pub balance: JointDynamics,
    /// By elimination.
    pub eliminated: Vec<Candidate>,
    /// The shortest of them in joint coordinates, for what has to be short rather than accurate: the Jacobian.
    pub shortest: Vec<ExprId>,
    pub eliminated_on_spins: Vec<Candidate>,
    /// By Gram–Schmidt, which cancels nothing, in small trees.
    pub by_gram_schmidt: Option<Candidate>,
    pub by_gram_schmidt_on_spins: Option<Candidate>,
    /// What the normal form made of the parts of the form of this name.
    pub reductions: Vec<Reduction>,
}

impl Candidates {
    pub fn solve(system: &mut System, coordinates: &Coordinates) -> Self {
        let Coordinates { embedding, links_of_dynamics: links, unit, along, .. } = coordinates;
        let loads = &coordinates.loads;
        let rows = coordinates.remaining_rows(&mut system.graph);
        let spins = dynamics::spins(system, links);
        let balance = JointDynamics::new(system, links, &spins, loads, along, (embedding, rows.clone()));
        let mut reductions = Vec::new();
        let mut eliminated = vec![("recursion", balance.recursion(system))];
        if embedding.n_unknowns <= MAX_FACTORED && rows.is_empty() {
            eliminated.push((NORMAL_FORM, balance.factored(system, unit, &mut reductions)));
        }
        if let Some(found) = planar::accelerations(system, coordinates) {
            eliminated.push((planar::PLANAR, found));
        }
        let shortest = expanded(system, &coordinates.in_joints, &eliminated);
        let shortest = FinalPasses::of(false).cheapest(&mut system.graph, shortest).roots;
        let spins = spins_at_hand(system, coordinates);
        let on_spins = JointDynamics::new(system, links, &spins, loads, along, (embedding, rows.clone()));
        let eliminated_on_spins = vec![("recursion on the bodies' spins", on_spins.recursion(system))];
        let is_small = (2..=gram_schmidt::MAX_RATES).contains(&embedding.n_unknowns) && rows.is_empty();
        let by_gram_schmidt = is_small.then(|| ("Gram–Schmidt", balance.by_gram_schmidt(system)));
        let by_gram_schmidt_on_spins =
            is_small.then(|| ("Gram–Schmidt on the bodies' spins", on_spins.by_gram_schmidt(system)));
        Self {
            balance,
            eliminated,
            shortest,
            eliminated_on_spins,
            by_gram_schmidt,
            by_gram_schmidt_on_spins,
            reductions,
        }
    }

    /// Leaves out the forms that cancellation makes less accurate than Gram–Schmidt.
    pub fn retain_accurate(&mut self, system: &mut System, coordinates: &Coordinates) {
        let Some((_, keeping)) = &self.by_gram_schmidt else { return };
        if !cancellation::may_matter(system) {
            return;
        }
        let keeping = system.expanded(&coordinates.in_joints, keeping);
        let eliminated = self.eliminated.iter().chain(&self.eliminated_on_spins);
        let forms = expanded(system, &coordinates.in_joints, eliminated);
        let losing = inaccurate(system, coordinates, &forms, &keeping);
        let keeps = |(name, _): &Candidate| losing.iter().all(|losing| losing != name);
        self.eliminated.retain(keeps);
        self.eliminated_on_spins.retain(keeps);
    }

    /// Those in terms of rates, expanded with the given values.
    pub fn on_rates(&self, system: &mut System, values: &Values) -> Vec<(String, Vec<ExprId>)> {
        expanded(system, values, self.eliminated.iter().chain(&self.by_gram_schmidt))
    }

    /// All of them, expanded with the given values.
    pub fn all(&self, system: &mut System, values: &Values) -> Vec<(String, Vec<ExprId>)> {
        let eliminated = self.eliminated.iter().chain(&self.eliminated_on_spins);
        expanded(
            system,
            values,
            eliminated.chain(&self.by_gram_schmidt).chain(&self.by_gram_schmidt_on_spins),
        )
    }
}

fn expanded<'c>(
    system: &mut System,
    values: &Values,
    candidates: impl IntoIterator<Item = &'c Candidate>,
) -> Vec<(String, Vec<ExprId>)> {
    let expanded = |(name, roots): &Candidate| ((*name).to_owned(), system.expanded(values, roots));
    candidates.into_iter().map(expanded).collect()
}

/// The names of the forms of u̇ that are less accurate than `keeping`, which is known to cancel nothing.
fn inaccurate(
    system: &System,
    coordinates: &Coordinates,
    ways: &[(String, Vec<ExprId>)],
    keeping: &[ExprId],
) -> Vec<String> {
    // Free orientations are not sampled.
    let is_tried = !coordinates.have_orientations();
    let scalars = coordinates.layout.links.iter().flat_map(|link| &link.scalars);
    let angles = scalars.filter(|scalar| scalar.kind.is_angle()).map(|scalar| scalar.place.x).collect();
    let all: Vec<_> = ways.iter().flat_map(|(_, roots)| roots).chain(keeping).copied().collect();
    let trials = Trials::draw(system, &all, &angles);
    let loses = |roots: &[ExprId]| !is_tried || !trials.is_accurate(&system.graph, roots, keeping);
    ways.iter().filter(|(_, roots)| loses(roots)).map(|(name, _)| name.clone()).collect()
}

/// w' of each moving body as a maximal state has it, but of bodies whose frame does not turn with them.
fn spins_at_hand(system: &mut System, coordinates: &Coordinates) -> Vec<Vec3> {
    let own: Vec<_> = system.moving_bodies.iter().map(|&body| system.poses[body].w).collect();
    let mut spins = own.clone();
    for (link, link_kinematics) in coordinates.layout.links.iter().zip(&coordinates.links_of_dynamics) {
        if link.scalars.iter().any(|scalar| coordinates.invariant.contains(&scalar.place.x)) {
            // A leaf: nothing else looks at this frame.
            let of_parent = dynamics::spin_of(system, link_kinematics.parent, &own);
            spins[link_kinematics.moving_body] = link_kinematics.spin(&mut system.graph, &of_parent);
        }
    }
    spins
}
