//! The accelerations of the joint coordinates: by a recursion over the tree, or through its reduced mass matrix `Bᵀ M
//! B`.
//!
//! Both work in the bodies' own frames, on what [`LinkKinematics`] says. Gravity enters as an acceleration of the
//! ground.

use super::layout::Layout;
use super::link_kinematics::{Bias, LinkKinematics};
use crate::derive::dynamics::gyroscopic_torque;
use crate::derive::forces::{self, Readings};
use crate::derive::joint_coordinate::Load;
use crate::derive::outputs::time_derivative;
use crate::derive::system::System;
use crate::expr::definitions::Values;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::schedule::Operations;
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use crate::expr::vector::{UNIT3, Vec3, ZERO3};
use crate::simplify::normal_form::{Reduction, normal_form_of};
use crate::solve::articulated_body::{Arm, Basis, EliminatedTree, Excitation, Inertia};
use crate::solve::gram_schmidt::GramSchmidtTree;
use crate::solve::ldl::Elimination;
use crate::solve::motion_subspace::{MotionSubspace, Parent};
use gyro_model::{Attachment, JointCoordinate};
use std::collections::BTreeMap;

/// Beyond this many rates the polynomials of a reduced mass matrix are seldom shorter than the recursion, and take long
/// to work out: they are not tried.
pub const MAX_FACTORED: usize = 4;

/// As the data sheet calls it.
pub const NORMAL_FORM: &str = "normal form";

/// Joint coordinates and rates as they are.
struct OfJoints<'a>(&'a Layout);

impl Readings for OfJoints<'_> {
    fn value(&self, system: &mut System, on: JointCoordinate) -> ExprId {
        let scalar = self.0.scalar(on).expect("joints of a tree have their coordinates");
        system.graph.symbol(Symbol::Coordinate(scalar.place.x))
    }

    fn rate(&self, system: &mut System, on: JointCoordinate) -> ExprId {
        let scalar = self.0.scalar(on).expect("joints of a tree have their coordinates");
        system.graph.symbol(Symbol::Rate(scalar.place.u))
    }
}

/// The force along each rate.
pub fn forces_along(system: &mut System, layout: &Layout) -> Vec<ExprId> {
    let parts = forces::along_coordinates(system, &OfJoints(layout));
    summed_along(system, layout, parts)
}

fn summed_along(system: &mut System, layout: &Layout, parts: Vec<forces::Along>) -> Vec<ExprId> {
    let mut along = vec![Graph::ZERO; layout.n_rates];
    for part in parts {
        let at = layout.scalar(part.on).expect("joints of a tree have their coordinates").place.u;
        along[at] = system.graph.add(along[at], part.force);
    }
    along
}

/// The power of what acts along joint coordinates and stores no energy: force times rate, with nothing of where the
/// bodies are.
pub fn power_along(system: &mut System, layout: &Layout) -> ExprId {
    let mut parts = forces::along_coordinates(system, &OfJoints(layout));
    parts.retain(|part| part.potential.is_none());
    let mut along = summed_along(system, layout, parts);
    add_spherical_friction(system, layout, &mut along);
    let rates: Vec<_> = (0..layout.n_rates).map(|rate| system.graph.symbol(Symbol::Rate(rate))).collect();
    rates.iter().zip(along).fold(Graph::ZERO, |sum, (&rate, force)| {
        let power = system.graph.mul(force, rate);
        system.graph.add(sum, power)
    })
}

/// The rates of a spherical joint are the relative spin that its friction resists.
fn add_spherical_friction(system: &mut System, layout: &Layout, along: &mut [ExprId]) {
    for link in &layout.links {
        let (Attachment::Joint { joint, .. }, Some(place)) = (link.link.attachment, link.orientation) else {
            continue;
        };
        let friction = system.number(&system.model.joints[joint].friction);
        for (k, along) in along[place.u..place.u + 3].iter_mut().enumerate() {
            let rate = system.graph.symbol(Symbol::Rate(place.u + k));
            let drag = system.graph.mul(friction, rate);
            *along = system.graph.sub(*along, drag);
        }
    }
}

/// A tree in joint coordinates, ready to be solved.
#[derive(Debug)]
pub struct JointDynamics {
    /// Rates of each link's free twists, root first.
    rates: Vec<Vec<usize>>,
    subspaces: Vec<MotionSubspace>,
    /// In the bodies' own frames.
    excitation: Excitation,
    n_rates: usize,
}

impl JointDynamics {
    /// `loads` act on each body of the model besides gravity; `along` is the force along each rate.
    pub fn new(
        system: &mut System,
        layout: &Layout,
        links: &[LinkKinematics],
        spins: &[Vec3],
        loads: &[Load],
        along: &[ExprId],
    ) -> Self {
        let subspaces = links.iter().map(|link_kinematics| local_subspace(system, link_kinematics)).collect();
        let gravity = system.numbers(&system.model.gravity);
        let forced = links.iter().map(|link_kinematics| {
            let bias = bias(system, link_kinematics, spins);
            let graph = &mut system.graph;
            let at_joint = graph.transposed_vec(&link_kinematics.rotation, &bias.on_parent);
            let own = SpatialVector { t: graph.add_vec(&at_joint, &bias.on_body), rho: bias.rho };
            let ground = of_ground(system, link_kinematics, &gravity);
            own.plus(&mut system.graph, &ground)
        });
        let forced = forced.collect();
        let bias = (0..spins.len())
            .map(|moving_body| inertial(system, moving_body, &spins[moving_body], loads))
            .collect();
        let rates: Vec<Vec<_>> = links
            .iter()
            .map(|link_kinematics| link_kinematics.free.iter().map(|free| free.rate).collect())
            .collect();
        let along = rates.iter().map(|rates| rates.iter().map(|&rate| along[rate]).collect()).collect();
        let excitation = Excitation { bias, forced, along };
        Self { rates, subspaces, excitation, n_rates: layout.n_rates }
    }

    /// u̇ by the Gram–Schmidt form.
    pub fn by_gram_schmidt(&self, system: &mut System) -> Vec<ExprId> {
        let tree = GramSchmidtTree::new(system, self.subspaces.clone(), Basis::Mixed);
        let response = tree.respond(&mut system.graph, &self.excitation);
        self.scattered(&response.rates)
    }

    /// u̇ by elimination from the leaves to the roots: operations grow linearly with the number of bodies.
    pub fn recursion(&self, system: &mut System) -> Vec<ExprId> {
        let tree = EliminatedTree::new(system, self.subspaces.clone(), Basis::Mixed);
        let response = tree.respond(&mut system.graph, &self.excitation);
        self.scattered(&response.rates)
    }

    /// u̇ by factoring the reduced mass matrix, all entries in polynomial normal form as long as pivots are constant.
    pub fn factored(
        &self,
        system: &mut System,
        unit: &[Vec<ExprId>],
        reductions: &mut Vec<Reduction>,
    ) -> Vec<ExprId> {
        let matrix = self.mass_matrix(system);
        let forces = self.generalised_forces(system);
        let graph = &mut system.graph;
        let mut reduced = |graph: &mut Graph, what, (old, divisors): (&[ExprId], &[bool])| {
            let new = normal_form_of(graph, unit, old, divisors);
            let [before, after] = [old, &new].map(|roots| Operations::recurring(graph, roots).total());
            reductions.push(Reduction { what, before, after });
            new
        };
        let mut elimination = Elimination::new(matrix, forces);
        elimination.rewrite(|old, divisors| reduced(graph, "mass matrix and forces", (old, divisors)));
        for unknown in self.rates.iter().flatten().rev().copied() {
            let is_constant = graph.as_constant(elimination.diagonal(unknown)).is_some();
            elimination.pivot(graph, unknown);
            if is_constant {
                elimination.rewrite(|old, divisors| normal_form_of(graph, unit, old, divisors));
            }
        }
        let solution = elimination.substitute_back(graph);
        reduced(graph, "solution", (&solution, &[]))
    }

    /// The rates' rates that forces along the rates alone bring about, for each column of forces: `M⁻¹ force`.
    pub fn accelerations_of(&self, system: &mut System, columns: &[Vec<ExprId>]) -> Vec<Vec<ExprId>> {
        let tree = EliminatedTree::new(system, self.subspaces.clone(), Basis::Mixed);
        let solved = |forces: &Vec<ExprId>| {
            let along = self.rates.iter().map(|rates| rates.iter().map(|&rate| forces[rate]).collect());
            let none = Excitation::none(self.excitation.bias.len(), self.subspaces.len());
            let excitation = Excitation { along: along.collect(), ..none };
            self.scattered(&tree.respond(&mut system.graph, &excitation).rates)
        };
        columns.iter().map(solved).collect()
    }

    /// The same by factoring the reduced mass matrix; forces in terms of joint coordinates and rates, as `in_joints`
    /// has the rest.
    pub fn factored_accelerations_of(
        &self,
        system: &mut System,
        (in_joints, unit): (&Values, &[Vec<ExprId>]),
        columns: &[Vec<ExprId>],
    ) -> Vec<Vec<ExprId>> {
        let (places, entries): (Vec<_>, Vec<_>) = self.mass_matrix(system).into_iter().unzip();
        let entries = system.expanded(in_joints, &entries);
        let graph = &mut system.graph;
        let matrix = places.into_iter().zip(entries).collect();
        let mut elimination = Elimination::of_several(matrix, columns.to_vec());
        elimination.rewrite(|old, divisors| normal_form_of(graph, unit, old, divisors));
        for unknown in self.rates.iter().flatten().rev().copied() {
            let is_constant = graph.as_constant(elimination.diagonal(unknown)).is_some();
            elimination.pivot(graph, unknown);
            if is_constant {
                elimination.rewrite(|old, divisors| normal_form_of(graph, unit, old, divisors));
            }
        }
        elimination.solutions(graph)
    }

    fn scattered(&self, rates: &[Vec<ExprId>]) -> Vec<ExprId> {
        let mut all = vec![Graph::ZERO; self.n_rates];
        for (places, values) in self.rates.iter().zip(rates) {
            for (&place, &value) in places.iter().zip(values) {
                all[place] = value;
            }
        }
        all
    }

    /// Lower triangle of `Bᵀ M B`: what a unit acceleration of one rate takes along each rate nearer to the root, the
    /// inertia beyond it moving as one body.
    fn mass_matrix(&self, system: &mut System) -> BTreeMap<(usize, usize), ExprId> {
        let mut bodies: Vec<_> =
            (0..self.excitation.bias.len()).map(|moving_body| Inertia::rigid(system, moving_body)).collect();
        let graph = &mut system.graph;
        let mut matrix = BTreeMap::new();
        for (subspace, rates) in self.subspaces.iter().zip(&self.rates).rev() {
            let arm = Arm::on_body(graph, subspace);
            let beyond = bodies[subspace.moving_body].seen_through(graph, &arm);
            for (k, (twist, &rate)) in subspace.free.iter().zip(rates).enumerate() {
                let mut wrench = beyond.times(graph, twist);
                for (other, &other_rate) in subspace.free[..=k].iter().zip(rates) {
                    let entry = other.dot(graph, &wrench);
                    matrix.insert((rate.max(other_rate), rate.min(other_rate)), entry);
                }
                let mut link = subspace;
                while let Some(parent) = link.parent {
                    let carried = parent.wrench(graph, &wrench);
                    let at = self.place_of(parent.moving_body);
                    link = &self.subspaces[at];
                    wrench = Arm::on_body(graph, link).wrench(graph, &carried);
                    for (other, &other_rate) in link.free.iter().zip(&self.rates[at]) {
                        let entry = other.dot(graph, &wrench);
                        matrix.insert((rate.max(other_rate), rate.min(other_rate)), entry);
                    }
                }
            }
            if let Some(parent) = subspace.parent {
                let load = beyond.on_parent(graph, &parent);
                let arm = Arm::on_parent(graph, &parent);
                let load = load.seen_through(graph, &arm);
                bodies[parent.moving_body].add(graph, &load);
            }
        }
        matrix.retain(|_, entry| *entry != Graph::ZERO);
        matrix
    }

    fn place_of(&self, moving_body: usize) -> usize {
        self.subspaces
            .iter()
            .position(|subspace| subspace.moving_body == moving_body)
            .expect("every moving body is a link")
    }

    /// What drives each rate: forces less what the motion at constant rates takes.
    fn generalised_forces(&self, system: &mut System) -> Vec<ExprId> {
        self.left_over(system, &vec![Graph::ZERO; self.n_rates])
    }

    /// The force along each rate that is left over by the motion with these rates' rates.
    pub fn left_over(&self, system: &mut System, rates_of_rates: &[ExprId]) -> Vec<ExprId> {
        let bodies: Vec<_> =
            (0..self.excitation.bias.len()).map(|moving_body| Inertia::rigid(system, moving_body)).collect();
        let graph = &mut system.graph;
        let mut motions = vec![SpatialVector::ZERO; self.excitation.bias.len()];
        for ((subspace, forced), rates) in self.subspaces.iter().zip(&self.excitation.forced).zip(&self.rates)
        {
            let mut motion = *forced;
            if let Some(parent) = subspace.parent {
                let carried = parent.twist(graph, &motions[parent.moving_body]);
                motion = motion.plus(graph, &carried);
            }
            for (twist, &rate) in subspace.free.iter().zip(rates) {
                let own = twist.scaled(graph, rates_of_rates[rate]);
                motion = motion.plus(graph, &own);
            }
            motions[subspace.moving_body] = Arm::on_body(graph, subspace).twist(graph, &motion);
        }
        let mut taken: Vec<_> = (motions.iter().zip(&bodies).zip(&self.excitation.bias))
            .map(|((motion, inertia), bias)| inertia.times(graph, motion).plus(graph, bias))
            .collect();
        let mut forces = vec![Graph::ZERO; self.n_rates];
        for ((subspace, rates), along) in
            self.subspaces.iter().zip(&self.rates).zip(&self.excitation.along).rev()
        {
            let wrench = Arm::on_body(graph, subspace).wrench(graph, &taken[subspace.moving_body]);
            for ((twist, &rate), &along) in subspace.free.iter().zip(rates).zip(along) {
                let resisted = twist.dot(graph, &wrench);
                forces[rate] = graph.sub(along, resisted);
            }
            if let Some(parent) = subspace.parent {
                let carried = parent.wrench(graph, &wrench);
                taken[parent.moving_body] = taken[parent.moving_body].plus(graph, &carried);
            }
        }
        forces
    }
}

/// Translations in the body's own frame.
pub fn local_subspace(system: &System, link_kinematics: &LinkKinematics) -> MotionSubspace {
    let parent =
        link_kinematics.parent.and_then(|body| system.moving_body_of(body)).map(|moving_body| Parent {
            moving_body,
            point: link_kinematics.on_parent,
            relative: link_kinematics.rotation,
            frame: UNIT3,
            carried: link_kinematics.rotation,
        });
    let free = link_kinematics.free.iter().map(|free| free.twist).collect();
    MotionSubspace::of_tree(link_kinematics.moving_body, parent, link_kinematics.on_body, free)
}

/// w' of each moving body, from the rates.
pub fn spins(system: &mut System, links: &[LinkKinematics]) -> Vec<Vec3> {
    let mut spins = vec![ZERO3; system.moving_bodies.len()];
    for link_kinematics in links {
        let of_parent = spin_of(system, link_kinematics.parent, &spins);
        spins[link_kinematics.moving_body] = link_kinematics.spin(&mut system.graph, &of_parent);
    }
    spins
}

/// w' of a carrier.
pub fn spin_of(system: &System, body: Option<usize>, spins: &[Vec3]) -> Vec3 {
    body.map_or(ZERO3, |body| {
        system.moving_body_of(body).map_or(system.poses[body].w, |moving_body| spins[moving_body])
    })
}

pub fn bias(system: &mut System, link_kinematics: &LinkKinematics, spins: &[Vec3]) -> Bias {
    let of_parent = spin_of(system, link_kinematics.parent, spins);
    link_kinematics.bias(&mut system.graph, &of_parent, &spins[link_kinematics.moving_body])
}

/// The acceleration of the joint point and the angular acceleration that a carrier without coordinates imposes,
/// centripetal parts left out, less gravity; in the body's frame.
pub fn of_ground(system: &mut System, link_kinematics: &LinkKinematics, gravity: &Vec3) -> SpatialVector {
    let (linear, angular, a) = match link_kinematics.parent {
        Some(body) if system.moving_body_of(body).is_some() => return SpatialVector::ZERO,
        Some(body) => {
            let pose = system.poses[body];
            (time_derivative(system, &pose.s), time_derivative(system, &pose.w), pose.a)
        }
        None => (ZERO3, ZERO3, UNIT3),
    };
    let graph = &mut system.graph;
    let felt = graph.sub_vec(&linear, gravity);
    let felt = graph.transposed_vec(&a, &felt);
    let tangential = graph.cross(&angular, &link_kinematics.on_parent);
    let at_joint = graph.add_vec(&felt, &tangential);
    SpatialVector {
        t: graph.transposed_vec(&link_kinematics.rotation, &at_joint),
        rho: graph.transposed_vec(&link_kinematics.rotation, &angular),
    }
}

/// What a body at constant velocity takes: `w̃'J'w'`, less the loads on it.
fn inertial(system: &mut System, moving_body: usize, spin: &Vec3, loads: &[Load]) -> SpatialVector {
    let (inertia, body) = (system.inertia(moving_body), system.moving_bodies[moving_body]);
    let (load, a) = (&loads[body], system.poses[body].a);
    let graph = &mut system.graph;
    let gyroscopic = gyroscopic_torque(graph, &inertia, spin);
    let force = graph.transposed_vec(&a, &load.force);
    SpatialVector { t: graph.neg_vec(&force), rho: graph.sub_vec(&gyroscopic, &load.torque) }
}
