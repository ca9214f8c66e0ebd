//! A tree in joint coordinates: what is derived before anything is solved.

use super::determined;
use super::embedding::Embedding;
use super::layout::Layout;
use super::link_kinematics::{self, LinkKinematics};
use super::{dynamics, maps};
use crate::derive::Textbook;
use crate::derive::dynamics::Dynamics;
use crate::derive::system::System;
use crate::expr::definitions::Values;
use crate::expr::graph::ExprId;
use crate::expr::symbol::Symbol;
use crate::expr::vector::ZERO3;

/// Joint coordinates and how they go with the maximal ones.
#[derive(Debug)]
pub struct Coordinates {
    pub layout: Layout,
    /// How each body moves on its carrier.
    pub links: Vec<LinkKinematics>,
    /// The same, but a body whose inertia is symmetric about its axis is described in a frame that does not turn
    /// with it.
    pub links_of_dynamics: Vec<LinkKinematics>,
    /// The angles that turn such bodies, by their places in x.
    pub invariant: Vec<usize>,
    /// Maximal positions and velocities in terms of joint coordinates and rates.
    pub maximal: Values,
    /// Everything in these terms.
    pub in_joints: Values,
    /// Joint coordinates and rates in terms of a maximal state that satisfies the constraints.
    pub of_joints: Values,
    /// The coordinates that are no part of the state, with their rates and the rates' rates.
    pub determined: Values,
    /// How all rates of the tree accelerate.
    pub embedding: Embedding,
    /// The force along each rate of the tree.
    pub along: Vec<ExprId>,
    /// Sets of atoms of which the squares sum to one.
    pub unit: Vec<Vec<ExprId>>,
}

impl Coordinates {
    /// Whether joint coordinates describe the mechanism.
    pub fn cover(system: &System) -> bool {
        system.tree.is_open() && determined::determined(system.model, |_| true).1.is_empty()
    }

    pub fn derive(system: &mut System, textbook: &Textbook) -> Self {
        let (known, _) = determined::determined(system.model, |_| true);
        let layout = Layout::of(system, known);
        let determined = determined::values(system, &layout);
        let embedding = Embedding::of(system, &layout, &determined);
        let links = links_of(system, &layout, &|_| true);
        let maximal = maps::of_bodies(system, &layout, &links);
        let maximal = maps::expanded(system, determined.clone(), maximal);
        let in_joints = maps::in_joints(system, &layout, &maximal, &determined);
        let of_joints = maps::of_joints(system, &layout);
        let invariant = invariant_angles(system, &layout, &links, &textbook.dynamics);
        let links_of_dynamics = links_of(system, &layout, &|x| !invariant.contains(&x));
        let along = dynamics::forces_along(system, &layout);
        let unit = unit_atoms(system, &layout);
        Self {
            layout,
            links,
            links_of_dynamics,
            invariant,
            maximal,
            in_joints,
            of_joints,
            determined,
            embedding,
            along,
            unit,
        }
    }

    /// The accelerations of all rates of the tree, from those of the state.
    pub fn of_tree(&self, system: &mut System, rates_of_rates: &[ExprId]) -> Vec<ExprId> {
        let known = rates_of_rates.iter().enumerate().map(|(rate, &value)| (Symbol::RateOfRate(rate), value));
        let known: Values = known.collect();
        let behind = (self.layout.n_rates..self.layout.n_tree_rates())
            .map(|rate| self.determined[&Symbol::RateOfRate(rate)]);
        let behind: Vec<_> = behind.collect();
        let behind = system.expanded(&known, &behind);
        rates_of_rates.iter().copied().chain(behind).collect()
    }

    /// Bodies that are described in a frame that does not turn with them.
    pub fn invariant_bodies(&self) -> Vec<usize> {
        let links = self.layout.links.iter();
        let invariant =
            links.filter(|link| link.scalars.iter().any(|scalar| self.invariant.contains(&scalar.place.x)));
        invariant.map(|link| link.link.body).collect()
    }

    /// Whether a joint, or a body that nothing holds, has Euler parameters of its own.
    pub fn have_orientations(&self) -> bool {
        self.layout.links.iter().any(|link| link.orientation.is_some())
    }
}

fn links_of(system: &mut System, layout: &Layout, turned: link_kinematics::Turned) -> Vec<LinkKinematics> {
    layout.links.iter().map(|link| LinkKinematics::of(system, link, turned)).collect()
}

/// Angles that turn nothing but a body whose inertia is the same at every angle: a leaf with a single axis, its mass
/// centre on the axis and its inertia symmetric about it, that no load acts on. The body is then described in a frame
/// that does not turn with it.
fn invariant_angles(
    system: &mut System,
    layout: &Layout,
    links: &[LinkKinematics],
    dynamics: &Dynamics,
) -> Vec<usize> {
    let is_leaf = |body: usize| links.iter().all(|link_kinematics| link_kinematics.parent != Some(body));
    let links = layout.links.iter().zip(links);
    let invariant = links.filter_map(|(link, link_kinematics)| {
        let angles: Vec<_> = link.scalars.iter().filter(|scalar| scalar.kind.is_angle()).collect();
        let [angle] = angles[..] else { return None };
        let turning = link_kinematics.free.iter().find(|free| free.rate == angle.place.u)?;
        let axis = turning.twist.rho;
        let load = dynamics.other_loads[link.link.body];
        let unloaded = load.force == ZERO3 && load.torque == ZERO3;
        let inertia = system.inertia(link_kinematics.moving_body);
        let graph = &mut system.graph;
        let tilde = graph.tilde(&axis);
        let (left, right) = (graph.mat_mul(&tilde, &inertia), graph.mat_mul(&inertia, &tilde));
        let on_axis = graph.cross(&axis, &link_kinematics.on_body) == ZERO3;
        let symmetric = graph.sub_mat(&left, &right) == [ZERO3; 3];
        (is_leaf(link.link.body) && unloaded && on_axis && symmetric).then_some(angle.place.x)
    });
    invariant.collect()
}

/// Sets of atoms of which the squares sum to one.
fn unit_atoms(system: &mut System, layout: &Layout) -> Vec<Vec<ExprId>> {
    let graph = &mut system.graph;
    let mut unit = Vec::new();
    for link in &layout.links {
        for scalar in link.scalars.iter().filter(|scalar| scalar.kind.is_angle()) {
            let x = scalar.place.x;
            unit.push([Symbol::Cosine(x), Symbol::Sine(x)].map(|symbol| graph.symbol(symbol)).to_vec());
        }
        if let Some(place) = link.orientation {
            unit.push((0..4).map(|k| graph.symbol(Symbol::Coordinate(place.x + k))).collect());
        }
    }
    unit
}
