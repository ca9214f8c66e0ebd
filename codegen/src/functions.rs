//! The functions of a generated module: which expressions each of them computes.

use crate::equations::{Charts, Equations, Sparse};
use crate::graph::{ExprId, Graph, Node};
use crate::joint_space::JointSpace;
use crate::symbol::Symbol;

/// The roots of each function that computes something.
#[derive(Debug)]
pub struct Functions {
    /// Values of [`Symbol::SetUp`].
    pub set_up: Vec<ExprId>,
    pub phi: Vec<ExprId>,
    pub phi_q: Vec<ExprId>,
    pub phi_pi: Vec<ExprId>,
    pub nu: Vec<ExprId>,
    pub gamma: Vec<ExprId>,
    pub velocity_residual: Vec<ExprId>,
    pub applied_force: Vec<ExprId>,
    pub accelerations: Vec<ExprId>,
    pub multipliers: Vec<ExprId>,
    pub project: Vec<ExprId>,
    pub derivative: Vec<ExprId>,
    pub energy: Vec<ExprId>,
    pub read_joints: Vec<ExprId>,
    pub outputs: Vec<ExprId>,
    pub chart_vectors: Vec<ExprId>,
    pub newton_step: Vec<ExprId>,
    pub solve_velocities: Vec<ExprId>,
    pub joint_accelerations: Vec<ExprId>,
    pub joint_derivative: Vec<ExprId>,
    pub to_maximal: Vec<ExprId>,
    pub to_joints: Vec<ExprId>,
    pub joint_accelerations_at: Vec<ExprId>,
    pub corrected_accelerations: Vec<ExprId>,
    pub corrected_multipliers: Vec<ExprId>,
    pub corrected_solution: Vec<ExprId>,
    pub joint_jacobian: Vec<ExprId>,
    pub joint_input_jacobian: Vec<ExprId>,
}

impl Functions {
    pub fn of(equations: &Equations) -> Self {
        let values = |sparse: &Sparse| sparse.iter().map(|entry| entry.2).collect::<Vec<_>>();
        let of_charts = |part: fn(&Charts) -> &Vec<ExprId>| {
            equations.charts.as_ref().map_or_else(Vec::new, |charts| part(charts).clone())
        };
        let of_joints = |part: fn(&JointSpace) -> &Vec<ExprId>| {
            equations.joint_space.as_ref().map_or_else(Vec::new, |space| part(space).clone())
        };
        let jacobian = equations.joint_space.as_ref().and_then(|space| space.jacobian.as_ref());
        let rates = equations.position_rates.iter().chain(&equations.power).chain(&equations.turn_rates);
        Self {
            set_up: Vec::new(),
            phi: equations.phi.clone(),
            phi_q: values(&equations.phi_q),
            phi_pi: values(&equations.phi_pi),
            nu: equations.nu.clone(),
            gamma: equations.gamma.clone(),
            velocity_residual: equations.velocity_residual.clone(),
            applied_force: equations.applied_force.clone(),
            accelerations: equations.accelerations.iter().chain(&equations.closing).copied().collect(),
            multipliers: equations.lambda.clone(),
            project: equations.projection.clone(),
            derivative: rates.copied().collect(),
            energy: vec![equations.kinetic, equations.potential],
            read_joints: equations.readings.clone(),
            outputs: equations.outputs.clone(),
            chart_vectors: of_charts(|charts| &charts.vectors),
            newton_step: of_charts(|charts| &charts.newton_positions),
            solve_velocities: of_charts(|charts| &charts.solved_velocities),
            joint_accelerations: of_joints(|space| &space.accelerations),
            joint_derivative: of_joints(|space| &space.derivative),
            to_maximal: of_joints(|space| &space.maximal),
            to_joints: of_joints(|space| &space.reduced),
            joint_accelerations_at: of_joints(|space| &space.accelerations_at),
            corrected_accelerations: of_joints(|space| &space.corrected),
            corrected_multipliers: of_joints(|space| &space.multipliers),
            corrected_solution: of_joints(|space| &space.solution),
            joint_jacobian: jacobian
                .map(|jacobian| [&jacobian.by_state[..], &jacobian.by_time].concat())
                .unwrap_or_default(),
            joint_input_jacobian: jacobian.map(|jacobian| jacobian.by_inputs.clone()).unwrap_or_default(),
        }
    }

    /// The roots of each function that is called in every step.
    pub fn recurring_mut(&mut self) -> [&mut Vec<ExprId>; 27] {
        [
            &mut self.phi,
            &mut self.phi_q,
            &mut self.phi_pi,
            &mut self.nu,
            &mut self.gamma,
            &mut self.velocity_residual,
            &mut self.applied_force,
            &mut self.accelerations,
            &mut self.multipliers,
            &mut self.project,
            &mut self.derivative,
            &mut self.energy,
            &mut self.read_joints,
            &mut self.outputs,
            &mut self.chart_vectors,
            &mut self.newton_step,
            &mut self.solve_velocities,
            &mut self.joint_accelerations,
            &mut self.joint_derivative,
            &mut self.to_maximal,
            &mut self.to_joints,
            &mut self.joint_accelerations_at,
            &mut self.corrected_accelerations,
            &mut self.corrected_multipliers,
            &mut self.corrected_solution,
            &mut self.joint_jacobian,
            &mut self.joint_input_jacobian,
        ]
    }

    /// Whether part of ẏ depends on multipliers that only the exact accelerations come with.
    pub fn derivative_needs_multipliers(&self, graph: &Graph) -> bool {
        graph
            .reachable(&self.derivative)
            .into_iter()
            .any(|id| matches!(graph.node(id), Node::Symbol(Symbol::Closing(_))))
    }

    /// Name, meaning and roots of each that there is, in the order of the data sheet.
    pub fn list(&self) -> Vec<(&'static str, &'static str, &[ExprId])> {
        let all: [(_, _, &[ExprId]); 28] = [
            ("set_up", "what depends on parameters alone", &self.set_up),
            ("phi", "Φ", &self.phi),
            ("phi_q", "Φ_q, non-zeros in (r, p)", &self.phi_q),
            ("phi_pi", "(Φ_r, Φ_π'), non-zeros", &self.phi_pi),
            ("nu", "ν", &self.nu),
            ("gamma", "γ", &self.gamma),
            ("velocity_residual", "Φ_r s + Φ_π' w' − ν", &self.velocity_residual),
            ("applied_force", "(f, n' − w̃'J'w')", &self.applied_force),
            ("accelerations", "(s̈, ẇ'), eq. (17)", &self.accelerations),
            ("multipliers", "λ, the accelerations being known", &self.multipliers),
            ("project", "(δr, δπ') that changes the rows as given", &self.project),
            ("derivative", "ẏ but for the accelerations: eqs. (14), (16)", &self.derivative),
            ("energy", "T and V", &self.energy),
            ("read_joints", "joint coordinates and rates", &self.read_joints),
            ("outputs", "outputs, the accelerations being known", &self.outputs),
            ("chart vectors", "for the choice of independent coordinates", &self.chart_vectors),
            ("newton_step", "dependent positions, one Newton step", &self.newton_step),
            ("solve_velocities", "dependent velocities, eq. (19)", &self.solve_velocities),
            ("joint_accelerations", "u̇ in joint coordinates", &self.joint_accelerations),
            ("joint_derivative", "ẋ but for u̇", &self.joint_derivative),
            ("to_maximal", "(q, v) of a joint state", &self.to_maximal),
            ("to_joints", "(x, u) of a maximal state", &self.to_joints),
            ("joint_accelerations_at", "u̇ at a corrected maximal state", &self.joint_accelerations_at),
            ("corrected_accelerations", "(s̈, ẇ') at a corrected state", &self.corrected_accelerations),
            (
                "corrected_multipliers",
                "λ at such a state and these accelerations",
                &self.corrected_multipliers,
            ),
            ("corrected_solution", "both", &self.corrected_solution),
            ("joint_jacobian", "∂f/∂x and ∂f/∂t of ẋ = f(t, x)", &self.joint_jacobian),
            ("joint_input_jacobian", "∂f/∂(inputs)", &self.joint_input_jacobian),
        ];
        all.into_iter().filter(|(.., roots)| !roots.is_empty()).collect()
    }
}
