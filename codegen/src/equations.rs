//! Everything that a module computes, as final expressions of one graph.

use crate::Elimination;
use crate::derive::dynamics::Dynamics;
use crate::derive::joint_coordinate;
use crate::derive::kinematics::{Kinematics, Matrix, non_zeros};
use crate::derive::outputs::{self, Sources};
use crate::derive::readings;
use crate::derive::system::System;
use crate::expr::definitions::{Definitions, Expansion, Values};
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::expr::vector::{Mat3, Vec4};
use crate::joint_space::JointSpace;
use crate::simplify::cheapest::{Finish, Form};
use crate::simplify::normal_form::vanishes;
use crate::solve::forward_dynamics::Trees;
use crate::solve::partition::Partition;
use crate::solve::saddle;
use gyro_model::{Model, Spline, Start};

/// Non-zeros with their places.
pub type Sparse = Vec<(usize, usize, ExprId)>;

/// The roots of all generated functions.
#[derive(Debug)]
pub struct Equations<'m> {
    pub model: &'m Model,
    pub graph: Graph,
    /// Tables of prescribed motions.
    pub tables: Vec<&'m Spline>,
    /// Joint rows, then normalisations.
    pub phi: Vec<ExprId>,
    pub phi_q: Sparse,
    pub phi_pi: Sparse,
    /// Entries of Φ_π' that are zero for unit Euler parameters and were left out.
    pub n_vanishing: usize,
    pub nu: Vec<ExprId>,
    pub gamma: Vec<ExprId>,
    pub velocity_residual: Vec<ExprId>,
    pub applied_force: Vec<ExprId>,
    /// (s̈, ẇ') of each slot.
    pub accelerations: Vec<ExprId>,
    /// The ways of writing them that were compared.
    pub forms: Vec<Form>,
    /// (δr, δπ') of each slot that change the rows as given.
    pub projection: Vec<ExprId>,
    pub forms_of_projection: Vec<Form>,
    /// Multipliers that are found with the accelerations.
    pub closing: Vec<ExprId>,
    /// All multipliers, the accelerations being known.
    pub lambda: Vec<ExprId>,
    /// (ṙ, ṗ) of each slot.
    pub position_rates: Vec<ExprId>,
    /// Power of non-conservative forces and drivers, where the state carries their work; the accelerations being known.
    pub power: Option<ExprId>,
    /// Rates of the turn references.
    pub turn_rates: Vec<ExprId>,
    pub kinetic: ExprId,
    pub potential: ExprId,
    pub readings: Vec<ExprId>,
    /// The numbers of the outputs, the accelerations being known.
    pub outputs: Vec<ExprId>,
    /// Joint coordinates, where the mechanism is a tree.
    pub joint_space: Option<JointSpace>,
    /// Charts, where the mechanism is a tree that they cover.
    pub charts: Option<Charts>,
    pub finish: Finish,
}

/// The partition by charts.
#[derive(Debug)]
pub struct Charts {
    pub vectors: Vec<ExprId>,
    pub newton_positions: Vec<ExprId>,
    pub solved_velocities: Vec<ExprId>,
}

impl<'m> Equations<'m> {
    pub fn derive(model: &'m Model, elimination: Elimination, start: &Start) -> Self {
        let mut system = System::new(model);
        let kinematics = Kinematics::derive(&mut system);
        let dynamics = Dynamics::derive(&mut system);
        let trees = Trees::of(&mut system, &kinematics);
        let solution = match elimination {
            Elimination::Saddle if system.closing_rows().is_empty() => {
                saddle::solve(&mut system, &kinematics, &dynamics)
            }
            _ => trees.solve(&mut system, &kinematics, &dynamics),
        };
        let sources = Sources { kinematics: &kinematics, dynamics: &dynamics, lambda: &solution.lambda };
        let outputs = outputs::derive(&mut system, &sources);
        let drivers_power = outputs::drivers_power(&mut system, &sources);
        let power = system.graph.add(dynamics.power, drivers_power);
        let turns = model.turn_references();
        let turn_rates: Vec<_> =
            turns.into_iter().map(|turn| joint_coordinate::rate(&mut system, turn)).collect();
        let readings = readings::readings(&mut system);
        let partition = Partition::covers(&system).then(|| Partition::derive(&mut system, &kinematics));
        let position_rates = position_rates(&mut system);
        let doubled = rotations_by_doubles(&mut system);
        let relative = relative_rotations(&mut system, Graph::rotation);
        let mut doubled_relative = relative_rotations(&mut system, Graph::rotation_by_doubles);
        doubled_relative.extend(doubled.clone());
        let definitions = system.definitions.clone();
        let finish = Finish::of(!system.closing_rows().is_empty());
        let mut ways = vec![
            Way::new(&definitions, "rotations of the bodies", Values::default()),
            Way::new(&definitions, "rotations of the bodies, doubled", doubled),
            Way::of_unit_parameters(&definitions, "relative Euler parameters", relative),
            Way::of_unit_parameters(&definitions, "relative Euler parameters, doubled", doubled_relative),
        ];
        if system.slots.len() > MAX_UNDOUBLED {
            ways.retain(|way| way.name.ends_with("doubled"));
        }
        let mut rotations = Rotations { finish, ways };
        let solved: Vec<_> = solution.accelerations.iter().chain(&solution.closing).copied().collect();
        let (mut solved, forms) = rotations.of_unit_parameters(&mut system.graph, &solved);
        let closing = solved.split_off(solution.accelerations.len());
        let joint_space = JointSpace::covers(&system).then(|| {
            let others = system.graph.add(dynamics.power_at_points, drivers_power);
            JointSpace::derive(&mut system, &kinematics, &dynamics, &solved, others, start)
        });
        let euler = euler_parameters(&mut system.graph, system.slots.len());
        let graph = &mut system.graph;
        let mut phi_pi = non_zeros(&rotations.matrix(graph, &kinematics.phi_pi));
        // A product of two vectors of one body does not change as the body turns.
        let n_derived = phi_pi.len();
        phi_pi.retain(|&(.., entry)| !vanishes(graph, &euler, entry));
        let projected = trees.project(graph, &kinematics);
        let (projection, forms_of_projection) = rotations.of_unit_parameters(graph, &projected);
        let all_phi: Vec<_> = kinematics.phi.iter().chain(&kinematics.normalisations).copied().collect();
        let energy = rotations.all(graph, &[dynamics.kinetic, dynamics.potential]);
        let mut equations = Self {
            model,
            phi: rotations.all(graph, &all_phi),
            phi_q: non_zeros(&rotations.matrix(graph, &kinematics.phi_q)),
            n_vanishing: n_derived - phi_pi.len(),
            phi_pi,
            nu: rotations.all(graph, &kinematics.nu),
            gamma: rotations.all(graph, &kinematics.gamma),
            velocity_residual: rotations.all(graph, &kinematics.velocity_residual),
            applied_force: rotations.all(graph, &dynamics.applied_force),
            accelerations: solved,
            forms,
            projection,
            forms_of_projection,
            closing,
            lambda: rotations.all(graph, &solution.lambda),
            position_rates,
            power: model.has_work().then(|| rotations.all(graph, &[power])[0]),
            turn_rates: rotations.all(graph, &turn_rates),
            kinetic: energy[0],
            potential: energy[1],
            readings: rotations.all(graph, &readings),
            outputs: rotations.all(graph, &outputs),
            joint_space,
            charts: partition.map(|partition| Charts::expand(&mut rotations, graph, &partition)),
            tables: system.tables,
            graph: system.graph,
            finish,
        };
        // Of parameters' frames an entry may be zero that is not written as one.
        let Self { phi_q, graph, .. } = &mut equations;
        phi_q.retain(|&(.., entry)| !vanishes(graph, &[], entry));
        equations
    }

    pub fn n_slots(&self) -> usize {
        self.accelerations.len() / 6
    }

    pub fn n_rows(&self) -> usize {
        self.lambda.len()
    }

    pub fn n_state(&self) -> usize {
        13 * self.n_slots() + usize::from(self.power.is_some()) + self.turn_rates.len()
    }
}

/// With more bodies nearly all entries of rotation matrices are used, and 2p is the cheaper way to them: of ten bodies with parallel axes one function
/// takes 3 operations of 1369 more, all others the same.
const MAX_UNDOUBLED: usize = 8;

/// A way of writing rotation matrices.
struct Way<'d> {
    name: &'static str,
    expansion: Expansion<'d>,
    /// Whether it means the same for any p.
    holds_for_any: bool,
}

impl<'d> Way<'d> {
    fn new(definitions: &'d Definitions, name: &'static str, values: Values) -> Self {
        let expansion = Expansion::with_values(definitions, values);
        Self { name, expansion, holds_for_any: true }
    }

    fn of_unit_parameters(definitions: &'d Definitions, name: &'static str, values: Values) -> Self {
        Self { holds_for_any: false, ..Self::new(definitions, name, values) }
    }
}

/// The ways of writing rotation matrices: by Euler parameters or their doubles, of bodies or of one body relative to another.
struct Rotations<'d> {
    ways: Vec<Way<'d>>,
    finish: Finish,
}

impl Rotations<'_> {
    /// The cheapest of those that mean the same for any p.
    fn all(&mut self, graph: &mut Graph, roots: &[ExprId]) -> Vec<ExprId> {
        self.cheapest(graph, roots, |way| way.holds_for_any).0
    }

    fn matrix(&mut self, graph: &mut Graph, matrix: &Matrix) -> Matrix {
        let entries = self.all(graph, &matrix.concat());
        let mut rest = &entries[..];
        let row = |row: &Vec<ExprId>| rest.split_off(..row.len()).unwrap_or_default().to_vec();
        matrix.iter().map(row).collect()
    }

    /// The cheapest of all, and what each would have taken.
    fn of_unit_parameters(&mut self, graph: &mut Graph, roots: &[ExprId]) -> (Vec<ExprId>, Vec<Form>) {
        self.cheapest(graph, roots, |_| true)
    }

    fn cheapest(
        &mut self,
        graph: &mut Graph,
        roots: &[ExprId],
        is_tried: fn(&Way) -> bool,
    ) -> (Vec<ExprId>, Vec<Form>) {
        let ways = self.ways.iter_mut().filter(|way| is_tried(way));
        let candidates = ways.map(|way| (way.name.to_owned(), way.expansion.all(graph, roots))).collect();
        self.finish.cheapest(graph, candidates)
    }
}

impl Charts {
    fn expand(rotations: &mut Rotations<'_>, graph: &mut Graph, partition: &Partition) -> Self {
        let vectors: Vec<_> = partition.chart_vectors.iter().flatten().copied().collect();
        Self {
            vectors: rotations.all(graph, &vectors),
            newton_positions: rotations.all(graph, &partition.positions),
            solved_velocities: rotations.all(graph, &partition.velocities),
        }
    }
}

/// p of each slot: unit vectors.
fn euler_parameters(graph: &mut Graph, n_slots: usize) -> Vec<Vec<ExprId>> {
    (0..n_slots).map(|slot| (0..4).map(|k| graph.symbol(Symbol::Euler { slot, k })).collect()).collect()
}

/// (ṙ, ṗ) of each slot by eqs. (16) and (14).
fn position_rates(system: &mut System) -> Vec<ExprId> {
    let poses: Vec<_> = system.slots.iter().map(|&body| system.poses[body]).collect();
    let rates = poses.iter().flat_map(|pose| {
        let p_rate = system.graph.euler_rate(&pose.p, &pose.w);
        pose.s.into_iter().chain(p_rate)
    });
    rates.collect()
}

/// A(p) of each slot by way of 2p.
fn rotations_by_doubles(system: &mut System) -> Values {
    let mut values = Values::default();
    for (slot, &body) in system.slots.iter().enumerate() {
        let rotation = system.graph.rotation_by_doubles(&system.poses[body].p);
        insert(&mut values, &rotation, |row, column| Symbol::Rotation { slot, row, column });
    }
    values
}

/// `A_iᵀ A_j = A(p_i* p_j)` of each joint: eq. (4) for unit p, in fewer operations where A_i and A_j are not needed anyhow.
fn relative_rotations(system: &mut System, rotation: fn(&mut Graph, &Vec4) -> Mat3) -> Values {
    let mut values = Values::default();
    if !system.closing_rows().is_empty() {
        return values;
    }
    for (joint, frames) in system.joints.clone().iter().enumerate() {
        let p = readings::relative_euler(system, frames);
        let rotation = rotation(&mut system.graph, &p);
        insert(&mut values, &rotation, |row, column| Symbol::Relative { joint, row, column });
    }
    values
}

fn insert(values: &mut Values, rotation: &Mat3, symbol: impl Fn(usize, usize) -> Symbol) {
    for (row, entries) in rotation.iter().enumerate() {
        for (column, &entry) in entries.iter().enumerate() {
            values.insert(symbol(row, column), entry);
        }
    }
}
