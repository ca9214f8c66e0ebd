//! Joint coordinates: what is derived before anything is solved.

use super::alone;
use super::closing_units;
use super::closure::{self, Closure, Directions};
use super::cut_armatures::CutArmature;
use super::determined;
use super::embedding::Embedding;
use super::layout::{Layout, LinkCoordinates};
use super::link_kinematics::{self, LinkKinematics};
use super::loops::{Loops, RemainingRows};
use super::relation::{Determined, Relation};
use super::velocity_rows;
use super::whole_angles::WholeAngles;
use super::{forces, maps};
use crate::derive::Textbook;
use crate::derive::joint_coordinate::Load;
use crate::derive::system::System;
use crate::expr::definitions::{Expansion, Values};
use crate::expr::domains::POINTS;
use crate::expr::evaluate::Program;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::schedule::Operations;
use crate::expr::spatial_vector::SpatialVector;
use crate::expr::symbol::Symbol;
use crate::expr::vector::{UNIT3, Vec3, ZERO3};
use crate::solve::dependence::{self, Yielding};
use crate::solve::gram_schmidt::Armature;
use gyro_model::{JointCoordinate, Model, RowOwner, Start, Tree};
use std::f64::consts::PI;

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
    /// The joints that close loops.
    pub closure: Closure,
    pub loops: Loops,
    /// Where the bodies are, by whole angles.
    pub angles: WholeAngles,
    /// How all rates of the tree follow those of the state.
    pub by_rates: Embedding,
    /// How all rates of the tree accelerate.
    pub embedding: Embedding,
    /// The force along each rate of the tree, and what armatures take if all unknowns are zero.
    pub along: Vec<ExprId>,
    /// The armature along each rate of the tree.
    pub armature: Vec<ExprId>,
    /// The armatures of joints that close loops.
    pub cut_armatures: Vec<CutArmature>,
    /// What else acts on each moving body, at its mass centre, in the frame of its dynamics.
    pub loads: Vec<SpatialVector>,
    /// The accelerations of the rates of bodies that stand alone.
    pub alone: Vec<(usize, ExprId)>,
    /// Sets of atoms of which the squares sum to one.
    pub unit: Vec<Vec<ExprId>>,
}

/// How far from the start coordinates of loops are tried: rad, or sizes of the mechanism. Most states that are far from
/// one with closed loops are none of the mechanism.
const NEAR: f64 = 0.3;

impl Coordinates {
    /// Where the coordinates are when expressions are compared: in trees angles are any, in loops near the start.
    pub fn set_domains(&self, system: &mut System, start: &Start) {
        let mut scratch = system.clone();
        let reduced = maps::reduced(&mut scratch, &self.layout, &self.of_joints);
        let reduced = Expansion::new(&scratch.definitions).all(&mut scratch.graph, &reduced);
        let start = maps::joint_start(&scratch, &self.layout, &reduced, start);
        let orientations = self.layout.links.iter().filter_map(|link| link.orientation);
        let orientations: Vec<_> = orientations.map(|place| place.x).collect();
        let (has_loops, size) = (!self.closure.rows.is_empty(), system.model.size());
        let is_angle = |x: usize| self.layout.scalars().any(|of| of.place.x == x && of.kind.is_angle());
        let is_part = |x: usize| orientations.iter().any(|&first| (first..first + 4).contains(&x));
        let near = |x: usize| match (is_angle(x), is_part(x)) {
            _ if self.layout.states().contains(&x) => (start[x], start[x].abs().max(1.0)),
            (false, false) => (start[x], if has_loops { NEAR * size } else { size }),
            _ if has_loops => (start[x], NEAR),
            (true, _) => (start[x], PI),
            (_, true) => (0.0, 1.0),
        };
        let near = (0..self.layout.n_coordinates).map(|x| (x, near(x))).collect();
        let domains = &mut system.graph.domains;
        domains.set_joints(near, &start[self.layout.n_coordinates..], orientations);
        domains.set_tables(&system.tables);
        let graph = &mut scratch.graph;
        let (symbols, maximal): (Vec<_>, Vec<_>) = self.maximal.iter().unzip();
        let maximal = Expansion::at(&scratch.definitions, &self.in_joints).all(graph, &maximal);
        let program = Program::of(graph, &maximal);
        let at = |point| {
            let values = program.run(|symbol| domains.value(symbol, point));
            symbols.iter().map(|&&symbol| symbol).zip(values).collect()
        };
        domains.known = (0..POINTS).map(at).collect();
    }

    pub fn derive(system: &mut System, textbook: &Textbook) -> Self {
        let (mut known, beside) = coordinates_beside_joints(system.model, &system.tree);
        let turns = turns_to_count(system, &known);
        loop {
            let layout = Layout::of(system, known.clone(), &turns);
            let determined = determined::values(system, &layout);
            let links = links_of(system, &layout, &|_| true);
            let angles = WholeAngles::of(system, &layout, &links, |x| layout.is_held(x));
            let unit = unit_atoms(system, &layout, &angles);
            let rows = closure::rows(system, (&textbook.kinematics.phi, &beside), (&layout, &angles), &unit);
            let held = rows.iter().find_map(|&(row, phi)| {
                let place = closure::held_by(&mut system.graph, &layout, phi)?;
                let scalar = layout.scalars().find(|scalar| scalar.place == place)?;
                Some(Determined { coordinate: scalar.coordinate, by: Relation::Held(row) })
            });
            if let Some(held) = held {
                known.push(held);
                continue;
            }
            return Self::closed(system, textbook, (layout, determined, links, angles, unit, rows));
        }
    }

    fn closed(
        system: &mut System,
        textbook: &Textbook,
        (layout, determined, links, angles, unit, rows): Derived,
    ) -> Self {
        let maximal = maps::of_bodies(system, &layout, &links);
        let maximal = maps::expanded(system, determined.clone(), maximal);
        let in_joints = maps::in_joints(system, &layout, &maximal, &determined, &angles);
        let of_joints = maps::of_joints(system, &layout, &angles);
        let by_rates = Embedding::identity(layout.n_rates).with_determined(system, &layout, &determined);
        let own = velocity_rows::rows(system, (&layout, &angles), &links);
        let closure = Closure::derive(system, rows, (&layout, &angles), (&by_rates, &own), &unit);
        let unheld = WholeAngles::of(system, &layout, &links, |_| false);
        let own = velocity_rows::rows(system, (&layout, &unheld), &links);
        let closure = closure.with_determined(system, &textbook.kinematics.phi, (&layout, &unheld), &own);
        let loops = loops_of(system, &closure);
        let embedding = loops.embedding(&mut system.graph, &closure, layout.n_rates);
        let embedding = embedding.with_determined(system, &layout, &determined);
        let loads = forces::loads(system, (&layout, &angles), &textbook.dynamics.other_loads);
        let is_open = closure.rows.is_empty();
        let alone = is_open.then(|| alone::accelerations(system, (&layout, &links), &loads));
        let invariant = invariant_angles(system, (&layout, &links), &loads, &in_joints);
        let links_of_dynamics = links_of(system, &layout, &|x| !invariant.contains(&x));
        let is_turned =
            |link: &LinkCoordinates| link.scalars.iter().all(|of| !invariant.contains(&of.place.x));
        let loads = layout.links.iter().zip(&links_of_dynamics).map(|(link, link_kinematics)| {
            let load = loads[link.link.body];
            let force = match is_turned(link) {
                true => system.graph.transposed_vec(&system.poses[link.link.body].a, &load.force),
                false => unturned(system, link_kinematics, &load.force),
            };
            (link_kinematics.moving_body, SpatialVector { t: force, rho: load.torque })
        });
        let mut loads: Vec<_> = loads.collect();
        loads.sort_unstable_by_key(|&(moving_body, _)| moving_body);
        let loads = loads.into_iter().map(|(_, load)| load).collect();
        let mut along = forces::along(system, &layout, &angles);
        let armature = forces::armature(system, &layout);
        for ((along, &inertia), motion) in along.iter_mut().zip(&armature).zip(&embedding.rates) {
            let taken = system.graph.mul(inertia, motion.bias);
            *along = system.graph.sub(*along, taken);
        }
        let directions = Directions { layout: &layout, angles: &angles, embedding: &by_rates };
        let cut_armatures = CutArmature::all(system, &directions, &links);
        for cut in &cut_armatures {
            cut.hold_back(&mut system.graph, &embedding, &mut along);
        }
        Self {
            layout,
            links,
            links_of_dynamics,
            invariant,
            maximal,
            in_joints,
            of_joints,
            determined,
            angles,
            by_rates,
            closure,
            loops,
            embedding,
            along,
            armature,
            cut_armatures,
            loads,
            alone: alone.unwrap_or_default(),
            unit,
        }
    }

    /// What resists the unknowns besides the inertia of bodies.
    pub fn armatures(&self, graph: &mut Graph) -> Vec<Armature> {
        let mut all = self.embedding.armatures(&self.armature);
        all.extend(self.cut_armatures.iter().map(|cut| cut.by_unknowns(graph, &self.embedding)));
        all
    }

    /// Φ of the joints that close loops; x, one Newton step nearer to closed loops; u that keep loops closed.
    pub fn closing(&self, system: &mut System) -> [Vec<ExprId>; 4] {
        let Self { layout, closure, loops, .. } = self;
        if closure.rows.is_empty() {
            return Default::default();
        }
        let units = closing_units::units(system, layout, &self.by_rates);
        let scaled = closing_units::in_units(&mut system.graph, closure, &units);
        let loops_in_units = loops_of(system, &scaled);
        let graph = &mut system.graph;
        let least = |graph: &mut Graph, missing: &[ExprId]| -> Vec<_> {
            let changes = loops_in_units.changes(graph, &scaled, missing, layout.n_rates);
            changes.into_iter().zip(&units).map(|(change, &unit)| graph.mul(change, unit)).collect()
        };
        let opposite = |graph: &mut Graph, rows: &[ExprId]| -> Vec<_> {
            rows.iter().map(|&row| graph.neg(row)).collect()
        };
        let missing = opposite(graph, &closure.phi);
        let distances = loops.distances(graph, closure);
        let shifts = least(graph, &missing);
        let missing = opposite(graph, &closure.residual);
        let changes = least(graph, &missing);
        let shifts = maps::coordinate_rates(system, layout, &shifts);
        let turned: Vec<_> = layout
            .turns
            .iter()
            .map(|&(on, x)| (x, system.graph.symbol(Symbol::Angle(system.turn_of(on)))))
            .collect();
        let graph = &mut system.graph;
        let added = |graph: &mut Graph, symbol: Symbol, change: ExprId| {
            let known = graph.symbol(symbol);
            graph.add(known, change)
        };
        let mut x: Vec<_> =
            shifts.into_iter().enumerate().map(|(k, by)| added(graph, Symbol::Coordinate(k), by)).collect();
        turned.into_iter().for_each(|(place, angle)| x[place] = angle);
        let u: Vec<_> =
            changes.into_iter().enumerate().map(|(k, by)| added(graph, Symbol::Rate(k), by)).collect();
        [&closure.phi, &distances, &x, &u].map(|roots| system.expanded(&self.in_joints, roots))
    }

    /// The rows that the unknowns must meet besides, with what they must come to.
    pub fn remaining_rows(&self, system: &mut System) -> RemainingRows {
        let lightness = dependence::lightness(&mut system.graph, system.model);
        let graph = &mut system.graph;
        let mut yielding = self.loops.yielding_of_others();
        yielding.values_mut().for_each(|entry| *entry = graph.mul(lightness, *entry));
        let row = |&row: &usize| {
            let jacobian = self.embedding.projected(graph, &self.closure.jacobian[row]);
            (jacobian, self.closure.gamma[row])
        };
        RemainingRows { rows: self.loops.others.iter().map(row).collect(), yielding }
    }

    /// What rows that depend on each other yield where forces are compared, in terms of a maximal state, by their
    /// places among all rows. Such a row on which no coordinate has an influence depends on nothing else.
    pub fn yielding(&self, system: &mut System) -> Yielding {
        let lightness = dependence::lightness(&mut system.graph, system.model);
        let mut yielding = Yielding::new();
        for set in system.model.dependent_rows() {
            yielding.extend(set.into_iter().map(|row| ((row, row), lightness)));
        }
        let place = |place: usize| self.closure.rows[place];
        let (places, entries): (Vec<_>, Vec<_>) = self.loops.yielding.iter().unzip();
        let entries = Expansion::at(&system.definitions, &self.of_joints).all(&mut system.graph, &entries);
        for (&(k, l), entry) in places.into_iter().zip(entries) {
            yielding.insert((place(k), place(l)), system.graph.mul(lightness, entry));
        }
        yielding
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

    /// Puts the accelerations of bodies that stand alone among those of all rates.
    pub fn put_alone(&self, accelerations: &mut [ExprId]) {
        self.alone.iter().for_each(|&(rate, value)| accelerations[rate] = value);
    }

    /// Bodies that are described in a frame that does not turn with them.
    pub fn invariant_bodies(&self) -> Vec<usize> {
        let links = self.layout.links.iter();
        let invariant =
            links.filter(|link| link.scalars.iter().any(|scalar| self.invariant.contains(&scalar.place.x)));
        invariant.map(|link| link.link.body).collect()
    }
}

/// Of coordinates, with what is needed to close them: layout, values of what is determined, links, angles, sets of
/// atoms of which the squares sum to one, rows.
type Derived = (Layout, Values, Vec<LinkKinematics>, WholeAngles, Vec<Vec<ExprId>>, Vec<(usize, ExprId)>);

/// The angles of cut joints whose whole turns the state counts: those on which something depends and which are no
/// angle of the tree. (A sum of angles may be off by a whole turn.)
fn turns_to_count(system: &mut System, known: &[Determined]) -> Vec<JointCoordinate> {
    let mut turns = system.model.turn_references();
    turns.retain(|turn| system.tree.loop_joints.contains(&turn.joint));
    if turns.is_empty() {
        return turns;
    }
    let layout = Layout::of(system, known.to_vec(), &[]);
    let links = links_of(system, &layout, &|_| true);
    let angles = WholeAngles::of(system, &layout, &links, |_| false);
    turns.retain(|&turn| angles.of_loop(turn).is_none_or(|sum| sum.parts().len() > 1));
    turns
}

/// What couplers and drivers determine, and the owners of the rows that determine no coordinate of the tree.
fn coordinates_beside_joints(model: &Model, tree: &Tree) -> (Vec<Determined>, Vec<RowOwner>) {
    let is_on_tree = |on: JointCoordinate| !tree.loop_joints.contains(&on.joint);
    determined::determined(model, is_on_tree)
}

fn loops_of(system: &mut System, closure: &Closure) -> Loops {
    let rows = system.model.rows();
    let owners: Vec<_> = closure.rows.iter().map(|&row| rows[row].owner).collect();
    let mut groups: Vec<Vec<usize>> = Vec::new();
    for (place, owner) in owners.iter().enumerate() {
        match groups.iter_mut().find(|group| owners[group[0]] == *owner) {
            Some(group) => group.push(place),
            None => groups.push(vec![place]),
        }
    }
    Loops::of(system, closure, &groups)
}

fn links_of(system: &mut System, layout: &Layout, turned: link_kinematics::Turned) -> Vec<LinkKinematics> {
    layout.links.iter().map(|link| LinkKinematics::of(system, link, turned)).collect()
}

/// Angles that turn nothing but a body whose inertia is the same at every angle: a leaf with a single axis, its mass
/// centre on the axis and its inertia symmetric about it, that no load turns across it. The body is then described in a
/// frame that does not turn with it, unless a load is shorter in one that does.
fn invariant_angles(
    system: &mut System,
    (layout, links): (&Layout, &[LinkKinematics]),
    loads: &[Load],
    in_joints: &Values,
) -> Vec<usize> {
    let is_leaf = |body: usize| links.iter().all(|link_kinematics| link_kinematics.parent != Some(body));
    let links = layout.links.iter().zip(links);
    let invariant = links.filter_map(|(link, link_kinematics)| {
        let angles: Vec<_> = link.scalars.iter().filter(|scalar| scalar.kind.is_angle()).collect();
        let [angle] = angles[..] else { return None };
        let turning = link_kinematics.free.iter().find(|free| free.rate == angle.place.u)?;
        let axis = turning.twist.rho;
        let inertia = system.inertia(link_kinematics.moving_body);
        let graph = &mut system.graph;
        let tilde = graph.tilde(&axis);
        let (left, right) = (graph.mat_mul(&tilde, &inertia), graph.mat_mul(&inertia, &tilde));
        let on_axis = graph.cross(&axis, &link_kinematics.on_body) == ZERO3;
        let symmetric = graph.sub_mat(&left, &right) == [ZERO3; 3];
        let Load { force, torque } = loads[link.link.body];
        let turns_along = graph.cross(&axis, &torque) == ZERO3;
        if !(is_leaf(link.link.body) && turns_along && on_axis && symmetric) {
            return None;
        }
        let still = LinkKinematics::of(system, link, &|_| false);
        let ways = [
            unturned(system, &still, &force),
            system.graph.transposed_vec(&system.poses[link.link.body].a, &force),
        ];
        let [still, turning] = ways.map(|force| {
            let written = system.expanded(in_joints, &force);
            Operations::recurring(&system.graph, &written).total()
        });
        (still <= turning).then_some(angle.place.x)
    });
    invariant.collect()
}

/// A global vector in the frame that the body has where its own angles are zero.
fn unturned(system: &mut System, still: &LinkKinematics, vector: &Vec3) -> Vec3 {
    let a = still.parent.map_or(UNIT3, |parent| system.poses[parent].a);
    let on_parent = system.graph.transposed_vec(&a, vector);
    system.graph.transposed_vec(&still.rotation, &on_parent)
}

/// Sets of atoms of which the squares sum to one.
fn unit_atoms(system: &mut System, layout: &Layout, angles: &WholeAngles) -> Vec<Vec<ExprId>> {
    let graph = &mut system.graph;
    let mut unit = Vec::new();
    for link in &layout.links {
        for scalar in link.scalars.iter().filter(|scalar| scalar.kind.is_angle()) {
            let x = scalar.place.x;
            unit.push([Symbol::Cosine(x), Symbol::Sine(x)].map(|symbol| graph.symbol(symbol)).to_vec());
        }
        if let Some(place) = link.orientation {
            unit.push((0..4).map(|k| graph.symbol(Symbol::Unit(place.x + k))).collect());
        }
    }
    for (place, _) in angles.places() {
        unit.push(
            [Symbol::Cosine(place.x), Symbol::Sine(place.x)].map(|symbol| graph.symbol(symbol)).to_vec(),
        );
    }
    unit
}
