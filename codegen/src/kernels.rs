//! The functions of a generated module: which expressions each of them computes.

use crate::equations::{Charts, Equations, Sparse};
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::symbol::Symbol;
use crate::joint_space::JointSpace;

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

#[cfg(test)]
mod tests {
    use crate::Elimination;
    use crate::equations::Equations;
    use crate::expr::schedule::Operations;
    use crate::kernels::Functions;

    /// Operations of the named functions together.
    fn cost(page: &str, elimination: Elimination, names: &[&str]) -> usize {
        let model = gyro_model::read("page.toml", page).expect("a page without mistakes");
        let start = model.assemble().expect("a start");
        let mut equations = Equations::derive(&model, elimination, &start);
        let mut functions = Functions::of(&equations);
        for roots in functions.recurring_mut() {
            *roots = equations.finish.finished(&mut equations.graph, roots);
        }
        let of = |name: &&str| {
            let functions = functions.list();
            let (.., roots) = functions.iter().find(|(known, ..)| known == name).expect("a function");
            Operations::count(&equations.graph, roots).total()
        };
        names.iter().map(of).sum()
    }

    /// A chain with an element on each joint's coordinate.
    fn chain(joints: &[(&str, &str)]) -> String {
        let mut page =
            "format = 1\nname = \"chain\"\n[inputs]\nu = 0\n[[body]]\nname = \"b0\"\nfixed = true\n"
                .to_owned();
        for (index, (kind, element)) in joints.iter().enumerate() {
            let (carrier, body) = (format!("b{index}"), format!("b{}", index + 1));
            let axis = if *kind == "spherical" {
                String::new()
            } else {
                format!("axis = [{index}, 2, 1]\nzero = [0, 1, -2]\n")
            };
            page += &format!(
                "[[body]]\nname = \"{body}\"\nmass = 1.5\ninertia = [0.2, 0.3, 0.25]\n\
                 [[joint]]\nname = \"j{index}\"\nkind = \"{kind}\"\n{axis}\
                 first = {{ body = \"{carrier}\", point = [0.1, 0, 0.3] }}\n\
                 second = {{ body = \"{body}\", point = [0, 0.2, 0] }}\n"
            );
            page += &match *element {
                "" => String::new(),
                "friction" => "friction = 0.1\n".to_owned(),
                element => format!("[[force]]\nname = \"f{index}\"\njoint = \"j{index}\"\n{element}\n"),
            };
        }
        page
    }

    /// Torque times rate: a product and a sum for each motor, and one product more where the force is yet to be computed.
    #[test]
    fn power_is_read_from_joint_coordinates() {
        const MOTOR: &str = "kind = \"motor\"\nvalue = \"u\"";
        const DAMPER: &str = "kind = \"damper\"\ndamping = 0.3";
        let cost =
            |joints: &[(&str, &str)]| cost(&chain(joints), Elimination::NullSpace, &["joint_derivative"]);
        let check = |joints: &[(&str, &str)], allowed: usize| {
            let cost = cost(joints);
            assert!(cost <= allowed, "{joints:?}: {cost} operations, more than {allowed}");
        };
        check(&[("revolute", MOTOR); 5], 9);
        check(&[("revolute", DAMPER), ("prismatic", "friction"), ("revolute", MOTOR)], 7);
        // ẋ of a spherical joint takes operations of its own.
        let alone = cost(&[("revolute", "friction"), ("spherical", "")]) - 2;
        check(&[("revolute", "friction"), ("spherical", "friction")], alone + 9);
    }

    /// The paper's scene costs about what an analyst's pencil reaches: 17 operations for the joint accelerations, in benches/.
    #[test]
    fn nothing_is_computed_that_the_paper_s_scene_does_not_need() {
        let page = include_str!("../../models/gyroscope.toml");
        let check = |names: &[&str], allowed: usize| {
            let cost = cost(page, Elimination::NullSpace, names);
            assert!(cost <= allowed, "{names:?}: {cost} operations, more than {allowed}");
        };
        check(&["joint_accelerations"], 19);
        check(&["joint_accelerations_at"], 39);
        check(&["corrected_accelerations"], 140);
        check(&["corrected_solution"], 210);
        check(&["accelerations"], 407);
        let saddle = cost(page, Elimination::Saddle, &["accelerations"]);
        assert!(saddle <= 860, "saddle: {saddle}");
    }
}
