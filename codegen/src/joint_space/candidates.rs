//! The forms of u̇, the derivatives of the rates, that are compared.

use super::axis_dynamics::AxisTree;
use super::axis_loops;
use super::coordinates::Coordinates;
use super::dynamics::{self, JointDynamics, MAX_FACTORED, NORMAL_FORM};
use super::layout::LinkCoordinates;
use super::planar;
use crate::derive::system::System;
use crate::effort::Effort;
use crate::expr::definitions::{Expansion, Values};
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::expr::vector::Vec3;
use crate::simplify::cheapest::FinalPasses;
use crate::simplify::normal_form::Reduction;
use crate::solve::cancellation::{self, Near, Trials};
use crate::solve::gram_schmidt;

/// How far from the start coordinates of loops are tried: rad, or sizes of the mechanism.
const NEAR: f64 = 0.3;

/// A form of u̇ and what it is called, in symbols that are yet to be expanded.
pub type Candidate = (&'static str, Vec<ExprId>);

/// The forms of u̇. Those on the bodies' spins are useful where a maximal state provides the angular velocities.
#[derive(Debug)]
pub struct Candidates {
    /// What u̇ is the solution of, angular velocities made of rates.
    pub balance: JointDynamics,
    /// By elimination.
    pub eliminated: Vec<Candidate>,
    /// The same in joint coordinates.
    written: Vec<(String, Vec<ExprId>)>,
    /// The shortest of them in joint coordinates, for what has to be short rather than accurate: the Jacobian. In small
    /// trees that in the bodies' frames too, whose derivatives may be shorter.
    pub shortest: Vec<Vec<ExprId>>,
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
        let armatures = coordinates.armatures(&mut system.graph);
        let (loads, along) = (&coordinates.loads, (along.as_slice(), armatures.as_slice()));
        let rows = coordinates.remaining_rows(system);
        let spins = dynamics::spins(system, links);
        let balance = JointDynamics::new(system, links, &spins, loads, along, (embedding, rows.clone()));
        let mut reductions = Vec::new();
        let mut eliminated = vec![("recursion", balance.recursion(system))];
        let tries_all = system.effort == Effort::Full;
        if tries_all && embedding.n_unknowns <= MAX_FACTORED && rows.rows.is_empty() {
            eliminated.push((NORMAL_FORM, balance.factored(system, unit, &mut reductions)));
        }
        let independent = rows.yielding.is_empty();
        if let Some(found) = independent.then(|| planar::accelerations(system, coordinates)).flatten() {
            eliminated.push((planar::PLANAR, found));
        }
        let n_in_bodies = eliminated.len();
        if let Some(tree) = AxisTree::new(system, coordinates, &coordinates.invariant) {
            if coordinates.closure.rows.is_empty() {
                eliminated.extend(tree.forms(system));
            } else if independent
                && axis_loops::is_small(&tree, coordinates)
                && coordinates.cut_armatures.is_empty()
            {
                eliminated
                    .push((axis_loops::WITH_ROWS, axis_loops::accelerations(system, &tree, coordinates)));
            }
        }
        eliminated.iter_mut().for_each(|(_, roots)| coordinates.put_alone(roots));
        let written = expanded(system, &coordinates.in_joints, &eliminated);
        let in_bodies = (embedding.n_unknowns <= MAX_FACTORED).then(|| written[..n_in_bodies].to_vec());
        let compared = std::iter::once(written.clone()).chain(in_bodies);
        let mut shortest: Vec<_> =
            compared.map(|forms| FinalPasses::of(false).cheapest(&mut system.graph, forms).roots).collect();
        shortest.dedup();
        let spins = spins_at_hand(system, coordinates);
        let on_spins = JointDynamics::new(system, links, &spins, loads, along, (embedding, rows.clone()));
        let mut eliminated_on_spins = vec![("recursion on the bodies' spins", on_spins.recursion(system))];
        let is_small = (2..=gram_schmidt::MAX_RATES).contains(&embedding.n_unknowns) && rows.rows.is_empty();
        let mut by_gram_schmidt = is_small.then(|| ("Gram–Schmidt", balance.by_gram_schmidt(system)));
        let mut by_gram_schmidt_on_spins = (is_small && tries_all)
            .then(|| ("Gram–Schmidt on the bodies' spins", on_spins.by_gram_schmidt(system)));
        let others = eliminated_on_spins.iter_mut().chain(&mut by_gram_schmidt);
        others.chain(&mut by_gram_schmidt_on_spins).for_each(|(_, roots)| coordinates.put_alone(roots));
        Self {
            balance,
            eliminated,
            written,
            shortest,
            eliminated_on_spins,
            by_gram_schmidt,
            by_gram_schmidt_on_spins,
            reductions,
        }
    }

    /// Leaves out the forms that cancellation makes less accurate than Gram–Schmidt, or in large trees than the
    /// recursion in the bodies' frames. `start` is the joint state at the start.
    pub fn retain_accurate(&mut self, system: &mut System, coordinates: &Coordinates, start: &[f64]) {
        if !cancellation::may_matter(system) {
            return;
        }
        let in_joints = &coordinates.in_joints;
        let (keeping, forms) = match &self.by_gram_schmidt {
            Some((_, keeping)) => {
                let keeping = system.expanded(in_joints, keeping);
                let on_spins = expanded(system, in_joints, &self.eliminated_on_spins);
                (keeping, self.written.iter().cloned().chain(on_spins).collect())
            }
            None => (self.written[0].1.clone(), self.written[1..].to_vec()),
        };
        let losing =
            inaccurate(system, (coordinates, start), &forms, &keeping, self.by_gram_schmidt.is_some());
        let keeps = |name: &str| losing.iter().all(|losing| losing != name);
        self.eliminated.retain(|(name, _)| keeps(name));
        self.written.retain(|(name, _)| keeps(name));
        self.eliminated_on_spins.retain(|(name, _)| keeps(name));
    }

    /// Those in terms of rates, in joint coordinates.
    pub fn on_rates(&self, system: &mut System, coordinates: &Coordinates) -> Vec<(String, Vec<ExprId>)> {
        let by_gram_schmidt = expanded(system, &coordinates.in_joints, &self.by_gram_schmidt);
        self.written.iter().cloned().chain(by_gram_schmidt).collect()
    }

    /// All of them, expanded.
    pub fn all(&self, graph: &mut Graph, expansion: &mut Expansion) -> Vec<(String, Vec<ExprId>)> {
        let eliminated = self.eliminated.iter().chain(&self.eliminated_on_spins);
        let all = eliminated.chain(&self.by_gram_schmidt).chain(&self.by_gram_schmidt_on_spins);
        all.map(|(name, roots)| ((*name).to_owned(), expansion.all(graph, roots))).collect()
    }
}

fn expanded<'c>(
    system: &mut System,
    values: &Values,
    candidates: impl IntoIterator<Item = &'c Candidate>,
) -> Vec<(String, Vec<ExprId>)> {
    let mut expansion = Expansion::at(&system.definitions, values);
    let graph = &mut system.graph;
    let expanded = |(name, roots): &Candidate| ((*name).to_owned(), expansion.all(graph, roots));
    candidates.into_iter().map(expanded).collect()
}

/// The names of the forms of u̇ that are less accurate than `keeping`, which may be known to cancel nothing.
fn inaccurate(
    system: &System,
    (coordinates, start): (&Coordinates, &[f64]),
    ways: &[(String, Vec<ExprId>)],
    keeping: &[ExprId],
    is_exact: bool,
) -> Vec<String> {
    let scalars = coordinates.layout.links.iter().flat_map(|link| &link.scalars);
    let angles = scalars.filter(|scalar| scalar.kind.is_angle()).map(|scalar| scalar.place.x).collect();
    let all: Vec<_> = ways.iter().flat_map(|(_, roots)| roots).chain(keeping).copied().collect();
    let places = coordinates.layout.links.iter().filter_map(|link| link.orientation);
    let orientations: Vec<_> =
        places.map(|place| [0, 1, 2, 3].map(|k| Symbol::Coordinate(place.x + k))).collect();
    let near = near_start(system, coordinates, start);
    let trials = Trials::draw(system, &all, &angles, (&orientations, &near));
    let graph = &system.graph;
    let are_accurate = if is_exact {
        ways.iter().map(|(_, way)| trials.is_accurate(graph, way, keeping)).collect()
    } else {
        trials.are_alike(graph, ways.iter().map(|(_, way)| way.as_slice()), keeping)
    };
    let losing = ways.iter().zip(are_accurate).filter(|(_, is_accurate)| !is_accurate);
    losing.map(|((name, _), _)| name.clone()).collect()
}

/// Where coordinates of loops are tried, with the distance from there: most states that are far from one with closed
/// loops are none of the mechanism.
fn near_start(system: &System, coordinates: &Coordinates, start: &[f64]) -> Near {
    if coordinates.closure.rows.is_empty() {
        return Near::new();
    }
    let scalars: Vec<_> = coordinates.layout.scalars().collect();
    let distance = |x: usize| {
        let angle = scalars.iter().any(|scalar| scalar.place.x == x && scalar.kind.is_angle());
        let is_orientation =
            |link: &LinkCoordinates| link.orientation.is_some_and(|p| (p.x..p.x + 4).contains(&x));
        let is_part = coordinates.layout.links.iter().any(is_orientation);
        if angle || is_part { NEAR } else { NEAR * system.model.size() }
    };
    (0..coordinates.layout.n_coordinates).map(|x| (x, (start[x], distance(x)))).collect()
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

#[cfg(test)]
mod tests;
