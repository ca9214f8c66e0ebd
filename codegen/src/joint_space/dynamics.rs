//! The accelerations of the joint coordinates: by a recursion over the tree, or through its reduced mass matrix `Bᵀ M
//! B`.
//!
//! Both work in the bodies' own frames, on what [`LinkKinematics`] says. Gravity enters as an acceleration of the
//! ground.

use super::embedding::Embedding;
use super::link_kinematics::{Bias, LinkKinematics};
use super::loops::RemainingRows;
use super::lower_triangle::{couple, resistance};
use crate::derive::dynamics::gyroscopic_torque;
use crate::derive::outputs::time_derivative;
use crate::derive::system::System;
use crate::expr::definitions::Values;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::schedule::Operations;
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::vector::{UNIT3, Vec3, ZERO3};
use crate::simplify::normal_form::{Reduction, normal_form_of};
use crate::solve::aggregate_joints::AggregateTree;
use crate::solve::articulated_body::{Arm, Basis, EliminatedTree, Excitation, Inertia};
use crate::solve::gram_schmidt::{Armature, GramSchmidtTree};
use crate::solve::ldl::Elimination;
use crate::solve::motion_subspace::{MotionSubspace, Parent};
use std::collections::BTreeMap;

/// Beyond this many rates the polynomials of a reduced mass matrix are seldom shorter than the recursion, and take long
/// to work out: they are not tried.
pub const MAX_FACTORED: usize = 4;

/// As the data sheet calls it.
pub const NORMAL_FORM: &str = "normal form";

/// A tree in joint coordinates, ready to be solved.
#[derive(Debug)]
pub struct JointDynamics {
    /// The unknowns of each link's free twists, root first, numbered in the order in which they occur.
    unknowns: Vec<Vec<usize>>,
    /// Of each unknown its place in the embedding.
    places: Vec<usize>,
    /// With the free twists of each unknown.
    subspaces: Vec<MotionSubspace>,
    /// In the bodies' own frames.
    excitation: Excitation,
    embedding: Embedding,
    /// With the places of unknowns.
    armatures: Vec<Armature>,
    /// Rows that the unknowns must meet besides, `J z = γ`.
    rows: RemainingRows,
}

impl JointDynamics {
    /// `loads` act on each moving body besides gravity, in its frame; `along` is the force along each rate of the tree,
    /// `armatures` are the inertias that the unknowns turn.
    pub fn new(
        system: &mut System,
        links: &[LinkKinematics],
        spins: &[Vec3],
        loads: &[SpatialVector],
        (along, armatures): (&[ExprId], &[Armature]),
        (embedding, rows): (&Embedding, RemainingRows),
    ) -> Self {
        let gravity = system.numbers(&system.model.gravity);
        let mut along = embedding.projected(&mut system.graph, along);
        let (mut places, mut unknowns) = (Vec::new(), Vec::new());
        let mut subspaces = Vec::new();
        let none = Excitation::none(spins.len(), 0);
        let mut excitation = Excitation { bias: Vec::new(), ..none };
        for link_kinematics in links {
            let bias = bias(system, link_kinematics, spins);
            let graph = &mut system.graph;
            let at_joint = graph.transposed_vec(&link_kinematics.rotation, &bias.on_parent);
            let own = SpatialVector { t: graph.add_vec(&at_joint, &bias.on_body), rho: bias.rho };
            let ground = of_ground(system, link_kinematics, &gravity);
            let forced = own.plus(&mut system.graph, &ground);
            let moving = Moving::of(&mut system.graph, link_kinematics, embedding, forced);
            let subspace = MotionSubspace { free: moving.twists, ..local_subspace(system, link_kinematics) };
            subspaces.push(subspace);
            excitation.forced.push(moving.forced);
            // A force along an unknown acts once, on the first joint that it moves.
            excitation.along.push(
                moving
                    .places
                    .iter()
                    .map(|&place| std::mem::replace(&mut along[place], Graph::ZERO))
                    .collect(),
            );
            let number = |place: usize| {
                places.iter().position(|&known| known == place).unwrap_or_else(|| {
                    places.push(place);
                    places.len() - 1
                })
            };
            unknowns.push(moving.places.into_iter().map(number).collect());
        }
        excitation.bias = (0..spins.len())
            .map(|moving_body| inertial(system, moving_body, &spins[moving_body], loads))
            .collect();
        let armatures = armatures.to_vec();
        Self { unknowns, places, subspaces, excitation, embedding: embedding.clone(), armatures, rows }
    }

    /// The unknowns as they occur, root first.
    pub fn order(&self) -> &[usize] {
        &self.places
    }

    /// Whether an unknown moves several joints.
    fn shares_unknowns(&self) -> bool {
        self.unknowns.iter().flatten().count() > self.places.len()
    }

    /// The accelerations of all rates of the tree by the Gram–Schmidt form.
    pub fn by_gram_schmidt(&self, system: &mut System) -> Vec<ExprId> {
        let (subspaces, unknowns) = (self.subspaces.clone(), self.unknowns.clone());
        let number = |&(place, factor): &(usize, ExprId)| Some((self.number(place)?, factor));
        let armatures = self.armatures.iter();
        let armatures = armatures.map(|(inertia, by)| (*inertia, by.iter().filter_map(number).collect()));
        let armatures: Vec<_> = armatures.collect();
        let tree = GramSchmidtTree::of_unknowns(system, subspaces, (unknowns, &armatures), Basis::Mixed);
        let response = tree.respond(&mut system.graph, &self.excitation);
        let found = self.scattered(&response.rates);
        self.embedding.rates_of_rates(&mut system.graph, &found)
    }

    /// The same by elimination from the leaves to the roots: operations grow linearly with the number of bodies.
    pub fn recursion(&self, system: &mut System) -> Vec<ExprId> {
        let tree = self.eliminated(system);
        let found = self.respond(&mut system.graph, &tree, &self.excitation);
        let found = self.closed(&mut system.graph, &tree, found);
        self.embedding.rates_of_rates(&mut system.graph, &found)
    }

    /// What the unknowns become by the multipliers that meet the remaining rows: `M⁻¹ Jᵀ μ` is added, such that
    /// `J z = γ`.
    fn closed(&self, graph: &mut Graph, tree: &Eliminated, mut found: Vec<ExprId>) -> Vec<ExprId> {
        let RemainingRows { rows, yielding } = &self.rows;
        let responses: Vec<_> = rows.iter().map(|(row, _)| self.response_to(graph, tree, row)).collect();
        let mut matrix = BTreeMap::new();
        for (k, (row, _)) in rows.iter().enumerate() {
            for (l, response) in responses[..=k].iter().enumerate() {
                matrix.insert((k, l), graph.dot_slices(row, response));
            }
        }
        for (&place, &entry) in yielding {
            let sum = matrix.entry(place).or_insert(Graph::ZERO);
            *sum = graph.add(*sum, entry);
        }
        matrix.retain(|_, entry| *entry != Graph::ZERO);
        let lacking = rows.iter().map(|(row, gamma)| {
            let rate = graph.dot_slices(row, &found);
            graph.sub(*gamma, rate)
        });
        let lacking = lacking.collect();
        let multipliers = Elimination::new(matrix, lacking).solve_in_order(graph);
        for (response, &multiplier) in responses.iter().zip(&multipliers) {
            for (found, &response) in found.iter_mut().zip(response) {
                let part = graph.mul(response, multiplier);
                *found = graph.add(*found, part);
            }
        }
        found
    }

    fn eliminated(&self, system: &mut System) -> Eliminated {
        let mut subspaces = self.subspaces.clone();
        let resisting = resistance(&mut system.graph, &self.armatures);
        if self.shares_unknowns() || resisting.keys().any(|(row, column)| row != column) {
            let number = |place: usize| self.number(place).expect("the armature turns with a joint");
            let resisting = resisting.into_iter().map(|((row, column), entry)| {
                let (a, b) = (number(row), number(column));
                ((a.max(b), a.min(b)), entry)
            });
            let armature = (self.places.len(), resisting.collect());
            Eliminated::Shared(AggregateTree::new(system, subspaces, self.unknowns.clone(), armature))
        } else {
            for (subspace, unknowns) in subspaces.iter_mut().zip(&self.unknowns) {
                let of = |&unknown: &usize| {
                    let place = self.places[unknown];
                    resisting.get(&(place, place)).copied().unwrap_or(Graph::ZERO)
                };
                subspace.armature = unknowns.iter().map(of).collect();
            }
            Eliminated::Plain(EliminatedTree::new(system, subspaces, Basis::Mixed))
        }
    }

    /// The number of an unknown, as they occur.
    fn number(&self, place: usize) -> Option<usize> {
        self.places.iter().position(|&known| known == place)
    }

    /// The unknowns, by their places in the embedding.
    fn respond(&self, graph: &mut Graph, tree: &Eliminated, excitation: &Excitation) -> Vec<ExprId> {
        match tree {
            Eliminated::Plain(tree) => self.scattered(&tree.respond(graph, excitation).rates),
            Eliminated::Shared(tree) => {
                let found = tree.respond(graph, excitation);
                let mut all = vec![Graph::ZERO; self.embedding.n_unknowns];
                self.places.iter().zip(found).for_each(|(&place, value)| all[place] = value);
                all
            }
        }
    }

    /// The same by factoring the reduced mass matrix, all entries in polynomial normal form as long as pivots are
    /// constant.
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
        self.eliminate(graph, unit, &mut elimination);
        let solution = elimination.substitute_back(graph);
        let found = reduced(graph, "solution", (&solution, &[]));
        self.embedding.rates_of_rates(graph, &found)
    }

    /// The unknowns that forces along them alone bring about, for each column of forces: `M⁻¹ force`.
    pub fn accelerations_of(&self, system: &mut System, columns: &[Vec<ExprId>]) -> Vec<Vec<ExprId>> {
        let tree = self.eliminated(system);
        columns.iter().map(|forces| self.response_to(&mut system.graph, &tree, forces)).collect()
    }

    fn response_to(&self, graph: &mut Graph, tree: &Eliminated, forces: &[ExprId]) -> Vec<ExprId> {
        let mut forces: Vec<_> = self.places.iter().map(|&place| forces[place]).collect();
        // A force along an unknown acts once.
        let mut taken = |&unknown: &usize| std::mem::replace(&mut forces[unknown], Graph::ZERO);
        let along = self.unknowns.iter().map(|unknowns| unknowns.iter().map(&mut taken).collect());
        let none = Excitation::none(self.excitation.bias.len(), self.subspaces.len());
        let excitation = Excitation { along: along.collect(), ..none };
        self.respond(graph, tree, &excitation)
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
        self.eliminate(graph, unit, &mut elimination);
        elimination.solutions(graph)
    }

    /// Eliminates the unknowns, the last one first; what constant pivots leave is simplified.
    fn eliminate(&self, graph: &mut Graph, unit: &[Vec<ExprId>], elimination: &mut Elimination) {
        for unknown in self.places.iter().rev().copied() {
            let is_constant = graph.as_constant(elimination.diagonal(unknown)).is_some();
            elimination.pivot(graph, unknown);
            if is_constant {
                elimination.rewrite(|old, divisors| normal_form_of(graph, unit, old, divisors));
            }
        }
    }

    fn scattered(&self, rates: &[Vec<ExprId>]) -> Vec<ExprId> {
        let mut all = vec![Graph::ZERO; self.embedding.n_unknowns];
        for (unknowns, values) in self.unknowns.iter().zip(rates) {
            for (&unknown, &value) in unknowns.iter().zip(values) {
                all[self.places[unknown]] = value;
            }
        }
        all
    }

    /// Lower triangle of `Bᵀ M B`: what a unit acceleration of one unknown takes along each unknown nearer to the root,
    /// the inertia beyond it moving as one body.
    pub fn mass_matrix(&self, system: &mut System) -> BTreeMap<(usize, usize), ExprId> {
        let mut bodies: Vec<_> =
            (0..self.excitation.bias.len()).map(|moving_body| Inertia::rigid(system, moving_body)).collect();
        let graph = &mut system.graph;
        let mut matrix = resistance(graph, &self.armatures);
        let place = |unknown: usize| self.places[unknown];
        for (subspace, unknowns) in self.subspaces.iter().zip(&self.unknowns).rev() {
            let arm = Arm::on_body(graph, subspace);
            let beyond = bodies[subspace.moving_body].seen_through(graph, &arm);
            for (k, (twist, &unknown)) in subspace.free.iter().zip(unknowns).enumerate() {
                let mut wrench = beyond.times(graph, twist);
                for (l, (other, &other_unknown)) in subspace.free[..=k].iter().zip(unknowns).enumerate() {
                    let entry = other.dot(graph, &wrench);
                    couple(graph, &mut matrix, (place(unknown), place(other_unknown)), entry, k == l);
                }
                let mut link = subspace;
                while let Some(parent) = link.parent {
                    let carried = parent.wrench(graph, &wrench);
                    let at = self.place_of(parent.moving_body);
                    link = &self.subspaces[at];
                    wrench = Arm::on_body(graph, link).wrench(graph, &carried);
                    for (other, &other_unknown) in link.free.iter().zip(&self.unknowns[at]) {
                        let entry = other.dot(graph, &wrench);
                        couple(graph, &mut matrix, (place(unknown), place(other_unknown)), entry, false);
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

    /// What drives each unknown: forces less what the motion at constant rates takes.
    fn generalised_forces(&self, system: &mut System) -> Vec<ExprId> {
        self.left_over(system, &vec![Graph::ZERO; self.embedding.n_unknowns])
    }

    /// The force along each unknown that is left over by the motion with these values of the unknowns.
    pub fn left_over(&self, system: &mut System, found: &[ExprId]) -> Vec<ExprId> {
        let bodies: Vec<_> =
            (0..self.excitation.bias.len()).map(|moving_body| Inertia::rigid(system, moving_body)).collect();
        let graph = &mut system.graph;
        let mut motions = vec![SpatialVector::ZERO; self.excitation.bias.len()];
        let links = self.subspaces.iter().zip(&self.excitation.forced).zip(&self.unknowns);
        for ((subspace, forced), unknowns) in links {
            let mut motion = *forced;
            if let Some(parent) = subspace.parent {
                let carried = parent.twist(graph, &motions[parent.moving_body]);
                motion = motion.plus(graph, &carried);
            }
            for (twist, &unknown) in subspace.free.iter().zip(unknowns) {
                let own = twist.scaled(graph, found[self.places[unknown]]);
                motion = motion.plus(graph, &own);
            }
            motions[subspace.moving_body] = Arm::on_body(graph, subspace).twist(graph, &motion);
        }
        let mut taken: Vec<_> = (motions.iter().zip(&bodies).zip(&self.excitation.bias))
            .map(|((motion, inertia), bias)| inertia.times(graph, motion).plus(graph, bias))
            .collect();
        let mut forces = vec![Graph::ZERO; self.embedding.n_unknowns];
        for ((row, column), entry) in resistance(graph, &self.armatures) {
            let mut take = |row: usize, column: usize| {
                let taken = graph.mul(entry, found[column]);
                forces[row] = graph.sub(forces[row], taken);
            };
            take(row, column);
            if row != column {
                take(column, row);
            }
        }
        for ((subspace, unknowns), along) in
            self.subspaces.iter().zip(&self.unknowns).zip(&self.excitation.along).rev()
        {
            let wrench = Arm::on_body(graph, subspace).wrench(graph, &taken[subspace.moving_body]);
            for ((twist, &unknown), &along) in subspace.free.iter().zip(unknowns).zip(along) {
                let resisted = twist.dot(graph, &wrench);
                let left = graph.sub(along, resisted);
                let all = &mut forces[self.places[unknown]];
                *all = graph.add(*all, left);
            }
            if let Some(parent) = subspace.parent {
                let carried = parent.wrench(graph, &wrench);
                taken[parent.moving_body] = taken[parent.moving_body].plus(graph, &carried);
            }
        }
        forces
    }
}

/// A tree without its unknowns.
enum Eliminated {
    /// Each unknown moves a single joint.
    Plain(EliminatedTree),
    /// Some move several.
    Shared(AggregateTree),
}

/// How a link moves by the unknowns.
struct Moving {
    /// Places of the unknowns that move it, in the embedding.
    places: Vec<usize>,
    twists: Vec<SpatialVector>,
    /// If all unknowns are zero.
    forced: SpatialVector,
}

impl Moving {
    fn of(graph: &mut Graph, link: &LinkKinematics, embedding: &Embedding, forced: SpatialVector) -> Self {
        let mut moving = Self { places: Vec::new(), twists: Vec::new(), forced };
        for free in &link.free {
            let motion = &embedding.rates[free.rate];
            for &(place, factor) in &motion.columns {
                let twist = free.twist.scaled(graph, factor);
                match moving.places.iter().position(|&known| known == place) {
                    Some(at) => moving.twists[at] = moving.twists[at].plus(graph, &twist),
                    None => {
                        moving.places.push(place);
                        moving.twists.push(twist);
                    }
                }
            }
            let given = free.twist.scaled(graph, motion.bias);
            moving.forced = moving.forced.plus(graph, &given);
        }
        moving
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
fn inertial(system: &mut System, moving_body: usize, spin: &Vec3, loads: &[SpatialVector]) -> SpatialVector {
    let (inertia, load) = (system.inertia(moving_body), &loads[moving_body]);
    let graph = &mut system.graph;
    let gyroscopic = gyroscopic_torque(graph, &inertia, spin);
    SpatialVector { t: graph.neg_vec(&load.t), rho: graph.sub_vec(&gyroscopic, &load.rho) }
}
