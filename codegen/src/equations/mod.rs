//! Everything that a module computes, as final expressions of one graph: of each quantity the form that was chosen, all
//! symbols expanded.

mod rotations;

pub use rotations::Rotations;

use crate::derive::kinematics::{Matrix, non_zeros};
use crate::derive::system::System;
use crate::derive::{Observed, Textbook};
use crate::effort::Effort;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use crate::groups::Functions;
use crate::joint_space::JointSpace;
use crate::simplify::cheapest::{Chosen, FinalPasses};
use crate::simplify::normal_form::vanishes;
use crate::solve::Solution;
use crate::solve::partition::Partition;
use gyro_model::{Model, Spline};
use gyro_program::{Counts, Group};

/// Non-zeros with their places.
#[derive(Debug)]
pub struct Sparse(pub Vec<(usize, usize, ExprId)>);

impl Sparse {
    pub fn len(&self) -> usize {
        self.0.len()
    }

    pub fn values(&self) -> Vec<ExprId> {
        self.0.iter().map(|entry| entry.2).collect()
    }
}

/// What all generated functions compute. What belongs to functions that are not asked for is empty.
#[derive(Debug)]
pub struct Equations<'m> {
    pub model: &'m Model,
    /// What is asked for and what this needs.
    pub functions: Functions,
    pub graph: Graph,
    /// How long forms are searched for.
    pub effort: Effort,
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
    /// (s̈, ẇ') of each moving body, then the multipliers that are found with them.
    pub solved: Chosen,
    /// (δr, δπ') of each moving body that change the rows as given.
    pub projection: Chosen,
    /// Number of joint rows.
    pub n_rows: usize,
    /// All multipliers, the accelerations being known.
    pub lambda: Vec<ExprId>,
    /// (ṙ, ṗ) of each moving body.
    pub position_rates: Vec<ExprId>,
    /// Power of non-conservative forces and drivers, where the state carries their work; the accelerations being known.
    pub power: Option<ExprId>,
    /// Rates of the states, then of the turn references.
    pub other_rates: Vec<ExprId>,
    pub kinetic: ExprId,
    pub potential: ExprId,
    pub readings: Vec<ExprId>,
    /// The numbers of the outputs, the accelerations being known.
    pub outputs: Vec<ExprId>,
    /// Joint coordinates, where the mechanism is a tree.
    pub joint_space: Option<JointSpace>,
    /// Charts, where the mechanism is a tree that they cover.
    pub charts: Option<Charts>,
    pub passes: FinalPasses,
}

/// An argument of kernels that has many numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Argument {
    /// The maximal state.
    State,
    /// The joint state.
    Joints,
    /// Accelerations, with multipliers of loops behind them; or rates' rates.
    Accelerations,
    /// Changes of rows that are asked for.
    Rows,
}

/// How positions and velocities are split into independent and dependent ones.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PartitionForm {
    /// By charts, which cover the mechanism.
    Charts,
    /// Through joint coordinates.
    Joints,
}

/// The partition by charts.
#[derive(Debug)]
pub struct Charts {
    pub vectors: Vec<ExprId>,
    pub newton_positions: Vec<ExprId>,
    pub solved_velocities: Vec<ExprId>,
}

/// What was derived and solved, in symbols that are yet to be expanded.
#[derive(Debug)]
pub struct Parts {
    pub textbook: Textbook,
    pub solution: Solution,
    pub observed: Observed,
    /// The smallest (δr, δπ') of each moving body that change the rows as given, if they are asked for.
    pub projection: Option<Vec<ExprId>>,
    /// Where charts cover the mechanism.
    pub partition: Option<Partition>,
}

impl<'m> Equations<'m> {
    /// How the partition goes, where it is asked for.
    pub fn partition_form(&self) -> PartitionForm {
        if self.charts.is_some() { PartitionForm::Charts } else { PartitionForm::Joints }
    }

    /// Expands what was derived and solved, each function in the cheapest way. `solved` are the accelerations as they
    /// were chosen before: the forms of joint coordinates are compared with them.
    pub fn choose(
        system: System<'m>,
        mut rotations: Rotations<'_>,
        parts: &Parts,
        solved: Chosen,
        (functions, joint_space): (&Functions, Option<JointSpace>),
    ) -> Self {
        let Parts { textbook: Textbook { kinematics, dynamics }, solution, observed, .. } = parts;
        let System { model, effort, tables, mut graph, moving_bodies, .. } = system;
        let has_kinematics = functions.has(Group::Kinematics);
        let (phi_pi, n_vanishing) = if has_kinematics {
            virtual_jacobian(&mut graph, &mut rotations, &kinematics.phi_pi, moving_bodies.len())
        } else {
            (Sparse(Vec::new()), 0)
        };
        let projection = parts.projection.as_ref().map(|form| rotations.cheapest(&mut graph, form));
        let mut expanded = |roots: &[ExprId]| rotations.expanded(&mut graph, roots);
        let energy = expanded(&[dynamics.kinetic, dynamics.potential]);
        let phi = expanded(&[&kinematics.phi[..], &kinematics.normalisations].concat());
        let phi_q = has_kinematics.then(|| expanded_matrix(&kinematics.phi_q, &mut expanded));
        let mut of_kinematics = |roots: &[ExprId]| if has_kinematics { expanded(roots) } else { Vec::new() };
        let (nu, gamma) = (of_kinematics(&kinematics.nu), of_kinematics(&kinematics.gamma));
        let mut equations = Self {
            model,
            effort,
            functions: functions.clone(),
            phi,
            phi_q: Sparse(phi_q.map_or(Vec::new(), |phi_q| non_zeros(&phi_q))),
            n_vanishing,
            phi_pi,
            nu,
            gamma,
            velocity_residual: expanded(&kinematics.velocity_residual),
            applied_force: expanded(&dynamics.applied_force),
            solved,
            projection: projection.unwrap_or_default(),
            n_rows: kinematics.phi.len(),
            lambda: expanded(&solution.lambda),
            position_rates: observed.position_rates.clone(),
            power: model.has_work().then(|| expanded(&[observed.power])[0]),
            other_rates: expanded(&observed.other_rates),
            kinetic: energy[0],
            potential: energy[1],
            readings: expanded(&observed.readings),
            outputs: expanded(&observed.outputs),
            joint_space,
            charts: parts.partition.as_ref().map(|partition| Charts::expand(partition, &mut expanded)),
            passes: rotations.passes,
            tables,
            graph,
        };
        // Of parameters' frames an entry may be zero that is not written as one.
        let Self { phi_q, graph, .. } = &mut equations;
        phi_q.0.retain(|&(.., entry)| !vanishes(graph, &[], entry));
        equations
    }

    pub fn n_moving_bodies(&self) -> usize {
        self.phi.len() - self.n_rows
    }

    /// Length of (s̈, ẇ') of all moving bodies.
    pub fn n_velocities(&self) -> usize {
        6 * self.n_moving_bodies()
    }

    /// The argument that a variable is an element of, and where, if it is.
    pub fn element(&self, symbol: Symbol) -> Option<(Argument, usize)> {
        let n_bodies = self.n_moving_bodies();
        match symbol {
            Symbol::Position { moving_body, k } => Some((Argument::State, 7 * moving_body + k)),
            Symbol::Euler { moving_body, k } => Some((Argument::State, 7 * moving_body + 3 + k)),
            Symbol::Velocity { moving_body, k } => {
                Some((Argument::State, 7 * n_bodies + 6 * moving_body + k))
            }
            Symbol::Spin { moving_body, k } => {
                Some((Argument::State, 7 * n_bodies + 6 * moving_body + 3 + k))
            }
            Symbol::State(state) => Some((Argument::State, self.first_state() + state)),
            Symbol::Turn(turn) => {
                Some((Argument::State, self.first_state() + self.model.states.len() + turn))
            }
            Symbol::Acceleration { moving_body, k } => Some((Argument::Accelerations, 6 * moving_body + k)),
            Symbol::LoopMultiplier(row) => Some((Argument::Accelerations, self.n_velocities() + row)),
            Symbol::Change(row) => Some((Argument::Rows, row)),
            Symbol::RateOfRate(place) => Some((Argument::Accelerations, place)),
            Symbol::Coordinate(place) => Some((Argument::Joints, place)),
            Symbol::Rate(place) => Some((Argument::Joints, self.n_coordinates() + place)),
            _ => None,
        }
    }

    /// How many things of each kind there are.
    pub fn counts(&self) -> Counts {
        let model = self.model;
        let space = self.joint_space.as_ref();
        let frames = |space: &JointSpace| space.frames.as_ref().map_or(0, |frames| frames.names.len());
        Counts {
            bodies: self.n_moving_bodies(),
            rows: self.n_rows,
            work: usize::from(self.power.is_some()),
            states: model.states.len(),
            turns: self.other_rates.len() - model.states.len(),
            readings: self.readings.len(),
            outputs: self.outputs.len(),
            frames: space.map_or(0, frames),
            inputs: model.inputs.len(),
            parameters: model.parameters.len(),
            phi_q: self.phi_q.len(),
            phi_pi: self.phi_pi.len(),
            accelerations: self.solved.roots.len(),
            coordinates: self.n_coordinates(),
            rates: space.map_or(0, |space| space.layout.n_rates),
            closure: space.map_or(0, |space| space.closure_rows.len()),
        }
    }

    /// Where the states begin in the maximal state.
    fn first_state(&self) -> usize {
        13 * self.n_moving_bodies() + usize::from(self.power.is_some())
    }

    /// Length of x.
    pub fn n_coordinates(&self) -> usize {
        self.joint_space.as_ref().map_or(0, |space| space.layout.n_coordinates)
    }

    /// ẏ without the accelerations.
    pub fn rates_but_accelerations(&self) -> Vec<ExprId> {
        self.position_rates.iter().chain(&self.power).chain(&self.other_rates).copied().collect()
    }

    /// The same where accelerations at corrected states go with it.
    pub fn rates_at_corrected_states(&self) -> Vec<ExprId> {
        self.joint_space.as_ref().map_or(Vec::new(), |_| self.rates_but_accelerations())
    }
}

/// The non-zeros of (Φ_r, Φ_π'), and how many are left out as they vanish: a product of two vectors of one body does
/// not change as the body turns.
fn virtual_jacobian(
    graph: &mut Graph,
    rotations: &mut Rotations<'_>,
    phi_pi: &Matrix,
    n_moving_bodies: usize,
) -> (Sparse, usize) {
    let euler: Vec<Vec<_>> = (0..n_moving_bodies)
        .map(|moving_body| (0..4).map(|k| graph.symbol(Symbol::Euler { moving_body, k })).collect())
        .collect();
    let derived = non_zeros(&expanded_matrix(phi_pi, &mut |roots| rotations.expanded(graph, roots)));
    let n_derived = derived.len();
    let kept = derived.into_iter().filter(|&(.., entry)| !vanishes(graph, &euler, entry));
    let kept: Vec<_> = kept.collect();
    let n_vanishing = n_derived - kept.len();
    (Sparse(kept), n_vanishing)
}

fn expanded_matrix(matrix: &Matrix, expanded: &mut impl FnMut(&[ExprId]) -> Vec<ExprId>) -> Matrix {
    let entries = expanded(&matrix.concat());
    let mut rest = &entries[..];
    let row = |row: &Vec<ExprId>| rest.split_off(..row.len()).unwrap_or_default().to_vec();
    matrix.iter().map(row).collect()
}

impl Charts {
    fn expand(partition: &Partition, expanded: &mut impl FnMut(&[ExprId]) -> Vec<ExprId>) -> Self {
        Self {
            vectors: expanded(&partition.chart_vectors.concat()),
            newton_positions: expanded(&partition.positions),
            solved_velocities: expanded(&partition.velocities),
        }
    }
}
