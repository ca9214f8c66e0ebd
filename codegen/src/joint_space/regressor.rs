//! What inertia and gravity take, as a product with the inertial parameters of the bodies (C. Atkeson, C. An and J.
//! Hollerbach, *Estimation of inertial parameters of manipulator loads and links*, International Journal of Robotics
//! Research 5 (1986)): forces are linear in mass, first moment and moments of inertia about a point of the body, here
//! the origin of its frame.

use super::axis_dynamics::{AxisTree, carried};
use super::mass_moments::MassMoments;
use super::motions;
use super::on_request::{IN_BODIES, IN_JOINTS, Parts};
use super::screw_moves::Move;
use crate::derive::system::System;
use crate::expr::differentiate::gradient;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::expr::vector::{UNIT3, Vec3, ZERO3};
use crate::simplify::cheapest::Chosen;

/// Mass, first moment, then the moments of inertia xx, yy, zz, xy, xz and yz.
const PARAMETERS: usize = 10;

/// Rows and columns of the moments of inertia.
const INERTIA: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];

/// Beyond this many rates bodies' own frames are not tried where others suit the joints.
const MAX_COMPARED: usize = 4;

impl Parts<'_> {
    /// Y at these accelerations, row by row.
    pub fn regressor(&self, system: &mut System, given: &[ExprId]) -> Chosen {
        let tree = AxisTree::new(system, self.coordinates, &[]);
        let mut forms = Vec::new();
        if tree.is_none() || given.len() <= MAX_COMPARED {
            forms.push((IN_BODIES, self.by_virtual_power(system, given)));
        }
        if let Some(tree) = tree {
            let columns = tree.regressor(system, given);
            let row = |row: usize| columns.iter().map(move |column| column[row]);
            forms.push((IN_JOINTS, (0..given.len()).flat_map(row).collect()));
        }
        self.cheapest(system, forms)
    }

    /// How much of the power of each rate is that of what a unit of each parameter takes.
    fn by_virtual_power(&self, system: &mut System, given: &[ExprId]) -> Vec<ExprId> {
        let of_tree = self.coordinates.of_tree(system, given);
        let accelerations =
            motions::motions(system, &self.coordinates.links, (&of_tree, motions::Part::All), true);
        let gravity = system.numbers(&system.model.gravity);
        let rates: Vec<_> = (0..given.len()).map(Symbol::Rate).collect();
        let mut rows = vec![Vec::new(); given.len()];
        for moving_body in 0..system.moving_bodies.len() {
            let pose = system.poses[system.moving_bodies[moving_body]];
            let graph = &mut system.graph;
            let velocities: Vec<_> = (0..3)
                .map(|k| Symbol::Velocity { moving_body, k })
                .chain((0..3).map(|k| Symbol::Spin { moving_body, k }))
                .map(|symbol| graph.symbol(symbol))
                .collect();
            let three = |first: usize| [0, 1, 2].map(|k| accelerations[6 * moving_body + first + k]);
            let felt = graph.sub_vec(&three(0), &gravity);
            let wrenches: Vec<[Vec3; 2]> = (0..PARAMETERS)
                .map(|parameter| of_unit(graph, parameter, &felt, (&pose.a, &pose.w, &three(3))))
                .collect();
            let velocities = system.expanded(&self.coordinates.in_joints, &velocities);
            let graph = &mut system.graph;
            let motions: Vec<_> = velocities.iter().map(|&root| gradient(graph, root, &rates)).collect();
            for (rate, row) in rows.iter_mut().enumerate() {
                let motion: Vec<_> = motions.iter().map(|by_rate| by_rate[rate]).collect();
                row.extend(wrenches.iter().map(|wrench| graph.dot_slices(&motion, wrench.as_flattened())));
            }
        }
        rows.concat()
    }
}

/// The force, in the global frame, and the torque, in the body's, that a unit of a parameter takes.
fn of_unit(
    graph: &mut Graph,
    parameter: usize,
    felt: &Vec3,
    (a, spin, spin_rate): (&crate::expr::vector::Mat3, &Vec3, &Vec3),
) -> [Vec3; 2] {
    match parameter {
        0 => [*felt, ZERO3],
        1..4 => {
            let at = UNIT3[parameter - 1];
            let (tangential, centripetal) = (graph.cross(spin_rate, &at), graph.centripetal(spin, &at));
            let swept = graph.add_vec(&tangential, &centripetal);
            let local = graph.transposed_vec(a, felt);
            [graph.mat_vec(a, &swept), graph.cross(&at, &local)]
        }
        _ => {
            let (row, column) = INERTIA[parameter - 4];
            let mut inertia = [ZERO3; 3];
            (inertia[row][column], inertia[column][row]) = (Graph::ONE, Graph::ONE);
            let (momentum, torque) = (graph.mat_vec(&inertia, spin), graph.mat_vec(&inertia, spin_rate));
            let gyroscopic = graph.cross(spin, &momentum);
            [ZERO3, graph.add_vec(&torque, &gyroscopic)]
        }
    }
}

impl AxisTree {
    /// Y by columns, for each body one of each parameter.
    fn regressor(&self, system: &mut System, given: &[ExprId]) -> Vec<Vec<ExprId>> {
        let motions = self.motions(system, given);
        let n_rates = self.embedding.rates.len();
        let graph = &mut system.graph;
        let mut columns =
            vec![vec![Graph::ZERO; self.embedding.n_unknowns]; PARAMETERS * system.moving_bodies.len()];
        for (index, (segment, motion)) in self.segments.iter().zip(&motions).enumerate() {
            let Some(moving_body) = segment.station.moving_body else { continue };
            let from_origin = graph.neg_vec(&segment.frame.origin);
            for parameter in 0..PARAMETERS {
                let moments = unit(graph, parameter).moved(graph, &Move::Shift(from_origin));
                let moments = moments.moved(graph, &Move::Rotation(segment.frame.axes));
                let mut wrench = moments.wrench(graph, motion);
                let (mut forces, mut at) = (vec![Graph::ZERO; n_rates], index);
                loop {
                    let of = &self.segments[at];
                    of.free.iter().for_each(|&(component, rate)| forces[rate] = wrench.component(component));
                    let Some(parent) = of.station.parent else { break };
                    wrench = carried(graph, &of.frame, wrench);
                    at = parent;
                }
                let forces = self.embedding.projected(graph, &forces);
                columns[PARAMETERS * moving_body + parameter] = self.to_global(graph, &forces);
            }
        }
        columns
    }
}

/// A body of which one parameter is one, about the origin of its frame.
fn unit(graph: &mut Graph, parameter: usize) -> MassMoments {
    match parameter {
        0 => MassMoments { mass: Graph::ONE, ..MassMoments::NONE },
        1..4 => MassMoments { first: UNIT3[parameter - 1], ..MassMoments::NONE },
        _ => {
            let (row, column) = INERTIA[parameter - 4];
            let mut inertia = [ZERO3; 3];
            (inertia[row][column], inertia[column][row]) = (Graph::ONE, Graph::ONE);
            MassMoments::of_body(graph, Graph::ZERO, &inertia)
        }
    }
}
