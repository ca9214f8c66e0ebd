//! The kernels: the functions of a generated module that compute something. One table says of each its name, what it
//! computes, when it exists and where its expressions come from; everything else goes by the variants of [`Kernel`],
//! never by the text of a name.

use crate::equations::{Charts, Equations};
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::symbol::Symbol;
use crate::groups::Group;
use crate::joint_space::{Frames, Jacobian, JointSpace, OnRequest, OutputDerivatives, ParameterJacobian};
use crate::simplify::cheapest::{Chosen, FinalPasses};
use crate::simplify::parameter_setup;
use std::collections::BTreeMap;

/// A function of a generated module, in the order of the data sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[allow(missing_docs, reason = "`Kernel::computes` says what each of them is")]
pub enum Kernel {
    ParameterSetup,
    Phi,
    PhiQ,
    PhiPi,
    Nu,
    Gamma,
    VelocityResidual,
    AppliedForce,
    Accelerations,
    Multipliers,
    Project,
    Derivative,
    Energy,
    ReadJoints,
    Outputs,
    ChartVectors,
    NewtonStep,
    SolveVelocities,
    JointAccelerations,
    JointDerivative,
    ToMaximal,
    ToJoints,
    JointAccelerationsAt,
    CorrectedAccelerations,
    CorrectedDerivative,
    CorrectedMultipliers,
    CorrectedSolution,
    JointJacobian,
    JointInputJacobian,
    JointParameterJacobian,
    LoopClosure,
    ClosureDistances,
    ClosePositions,
    CloseVelocities,
    JointOutputs,
    OutputsByState,
    OutputsByAccelerations,
    OutputsByInputs,
    OutputsByParameters,
    FrameJacobians,
    FrameBiases,
    InverseDynamics,
    BiasForces,
    GravityForces,
    MassMatrix,
    MassFactor,
    InverseDerivatives,
    ForwardDerivatives,
    Regressor,
}

/// When a kernel that is asked for exists, and where its expressions come from.
enum Source {
    /// If something depends on parameters alone, which is known once all other kernels are.
    Parameters,
    /// In every module.
    Equations(fn(&Equations) -> Chosen),
    /// If charts cover the mechanism.
    Charts(fn(&Charts) -> Chosen),
    /// If joint coordinates describe the mechanism: in open trees.
    JointSpace(fn(&JointSpace) -> Chosen),
    /// If it is small enough for the derivatives of the joint form, or an open tree.
    Jacobian(fn(&Jacobian) -> Chosen),
    /// Likewise.
    ParameterJacobian(fn(&ParameterJacobian) -> Chosen),
    /// If outputs of a joint state are asked for.
    JointOutputs,
    /// If their derivatives are, and exist.
    OutputDerivatives(fn(&OutputDerivatives) -> Chosen),
    /// If the model file has frames, and they are asked for.
    Frames(fn(&Frames) -> Chosen),
    /// If its group is asked for and joint coordinates describe the mechanism without loops.
    OnRequest(fn(&OnRequest) -> Option<&Chosen>),
}

/// What is known of a kernel.
struct Row {
    kernel: Kernel,
    group: Group,
    /// Its name on the data sheet.
    name: &'static str,
    /// What the data sheet claims that it computes; the verifier proves it.
    computes: &'static str,
    source: Source,
}

const fn row(
    kernel: Kernel,
    group: Group,
    name: &'static str,
    computes: &'static str,
    source: Source,
) -> Row {
    Row { kernel, group, name, computes, source }
}

/// All kernels, a row for each variant of [`Kernel`] in the same order.
#[rustfmt::skip]
const TABLE: &[Row] = &[
    row(Kernel::ParameterSetup, Group::Mechanism, "parameter_setup", "what depends on parameters alone", Source::Parameters),
    row(Kernel::Phi, Group::Mechanism, "phi", "Φ", Source::Equations(|e| e.phi.clone().into())),
    row(Kernel::PhiQ, Group::Kinematics, "phi_q", "Φ_q, non-zeros in (r, p)", Source::Equations(|e| e.phi_q.values().into())),
    row(Kernel::PhiPi, Group::Kinematics, "phi_pi", "(Φ_r, Φ_π'), non-zeros", Source::Equations(|e| e.phi_pi.values().into())),
    row(Kernel::Nu, Group::Kinematics, "nu", "ν", Source::Equations(|e| e.nu.clone().into())),
    row(Kernel::Gamma, Group::Kinematics, "gamma", "γ", Source::Equations(|e| e.gamma.clone().into())),
    row(Kernel::VelocityResidual, Group::Mechanism, "velocity_residual", "Φ_r s + Φ_π' w' − ν", Source::Equations(|e| e.velocity_residual.clone().into())),
    row(Kernel::AppliedForce, Group::Mechanism, "applied_force", "(f, n' − w̃'J'w')", Source::Equations(|e| e.applied_force.clone().into())),
    row(Kernel::Accelerations, Group::Maximal, "accelerations", "(s̈, ẇ'), eq. (17)", Source::Equations(|e| e.solved.clone())),
    row(Kernel::Multipliers, Group::Maximal, "multipliers", "λ, the accelerations being known", Source::Equations(|e| e.lambda.clone().into())),
    row(Kernel::Project, Group::Projection, "project", "(δr, δπ') that changes the rows as given", Source::Equations(|e| e.projection.clone())),
    row(Kernel::Derivative, Group::Maximal, "derivative", "ẏ but for the accelerations: eqs. (14), (16)", Source::Equations(|e| e.rates_but_accelerations().into())),
    row(Kernel::Energy, Group::Mechanism, "energy", "T and V", Source::Equations(|e| vec![e.kinetic, e.potential].into())),
    row(Kernel::ReadJoints, Group::Mechanism, "read_joints", "joint coordinates and rates", Source::Equations(|e| e.readings.clone().into())),
    row(Kernel::Outputs, Group::Mechanism, "outputs", "outputs, the accelerations being known", Source::Equations(|e| e.outputs.clone().into())),
    row(Kernel::ChartVectors, Group::Partition, "chart vectors", "for the choice of independent coordinates", Source::Charts(|c| c.vectors.clone().into())),
    row(Kernel::NewtonStep, Group::Partition, "newton_step", "dependent positions, one Newton step", Source::Charts(|c| c.newton_positions.clone().into())),
    row(Kernel::SolveVelocities, Group::Partition, "solve_velocities", "dependent velocities, eq. (19)", Source::Charts(|c| c.solved_velocities.clone().into())),
    row(Kernel::JointAccelerations, Group::Joint, "joint_accelerations", "u̇ in joint coordinates", Source::JointSpace(|s| s.accelerations.clone())),
    row(Kernel::JointDerivative, Group::Joint, "joint_derivative", "ẋ but for u̇", Source::JointSpace(|s| s.derivative.clone().into())),
    row(Kernel::ToMaximal, Group::Joint, "to_maximal", "(q, v) of a joint state", Source::JointSpace(|s| s.maximal.clone().into())),
    row(Kernel::ToJoints, Group::Joint, "to_joints", "(x, u) of a maximal state", Source::JointSpace(|s| s.reduced.clone().into())),
    row(Kernel::JointAccelerationsAt, Group::Reactions, "joint_accelerations_at", "u̇ at a corrected maximal state", Source::JointSpace(|s| s.accelerations_at.clone())),
    row(Kernel::CorrectedAccelerations, Group::Corrected, "corrected_accelerations", "(s̈, ẇ') at a corrected state", Source::JointSpace(|s| s.corrected.clone())),
    row(Kernel::CorrectedDerivative, Group::Corrected, "corrected_derivative", "ẏ but for the accelerations, there", Source::Equations(|e| e.rates_at_corrected_states().into())),
    row(Kernel::CorrectedMultipliers, Group::Reactions, "corrected_multipliers", "λ at such a state and these accelerations", Source::JointSpace(|s| s.multipliers.clone().into())),
    row(Kernel::CorrectedSolution, Group::Reactions, "corrected_solution", "both", Source::JointSpace(|s| s.solution.clone().into())),
    row(Kernel::JointJacobian, Group::Jacobian, "joint_jacobian", "∂f/∂x and ∂f/∂t of ẋ = f(t, x)", Source::Jacobian(|j| j.by_state_and_time.clone())),
    row(Kernel::JointInputJacobian, Group::Jacobian, "joint_input_jacobian", "∂f/∂(inputs)", Source::Jacobian(|j| j.by_inputs.clone())),
    row(Kernel::JointParameterJacobian, Group::ParameterJacobian, "joint_parameter_jacobian", "∂f/∂(parameters)", Source::ParameterJacobian(|j| j.0.clone())),
    row(Kernel::LoopClosure, Group::Joint, "loop_closure", "Φ of the joints that close loops, in joint coordinates", Source::JointSpace(|s| s.closure.clone().into())),
    row(Kernel::ClosureDistances, Group::Joint, "closure_distances", "squares of distances between the rows of the loops' Jacobian", Source::JointSpace(|s| s.distances.clone().into())),
    row(Kernel::ClosePositions, Group::Joint, "close_positions", "one Newton step of joint coordinates that closes loops", Source::JointSpace(|s| s.closer_coordinates.clone().into())),
    row(Kernel::CloseVelocities, Group::Joint, "close_velocities", "rates that keep loops closed", Source::JointSpace(|s| s.closing_rates.clone().into())),
    row(Kernel::JointOutputs, Group::JointOutputs, "joint_outputs", "outputs of a joint state, u̇ being known", Source::JointOutputs),
    row(Kernel::OutputsByState, Group::OutputDerivatives, "outputs_by_state", "∂(outputs)/∂(x, u), u̇ being held", Source::OutputDerivatives(|o| o.by_state.clone())),
    row(Kernel::OutputsByAccelerations, Group::OutputDerivatives, "outputs_by_accelerations", "∂(outputs)/∂u̇", Source::OutputDerivatives(|o| o.by_accelerations.clone())),
    row(Kernel::OutputsByInputs, Group::OutputDerivatives, "outputs_by_inputs", "∂(outputs)/∂(inputs), u̇ being held", Source::OutputDerivatives(|o| o.by_inputs.clone())),
    row(Kernel::OutputsByParameters, Group::OutputDerivatives, "outputs_by_parameters", "∂(outputs)/∂(parameters), u̇ being held", Source::OutputDerivatives(|o| o.by_parameters.clone())),
    row(Kernel::FrameJacobians, Group::Frames, "frame_jacobians", "∂(ṡ, w')/∂u of frames, row by row", Source::Frames(|f| f.jacobians.clone())),
    row(Kernel::FrameBiases, Group::Frames, "frame_biases", "(s̈, ẇ') of frames at u̇ = 0", Source::Frames(|f| f.biases.clone())),
    row(Kernel::InverseDynamics, Group::Inverse, "inverse_dynamics", "τ = M u̇ + h of given u̇", Source::OnRequest(|r| r.inverse.as_ref())),
    row(Kernel::BiasForces, Group::Inverse, "bias_forces", "h, that is τ at u̇ = 0", Source::OnRequest(|r| r.bias.as_ref())),
    row(Kernel::GravityForces, Group::Inverse, "gravity_forces", "what of h is against gravity", Source::OnRequest(|r| r.gravity.as_ref())),
    row(Kernel::MassMatrix, Group::MassMatrix, "mass_matrix", "M in joint coordinates, row by row", Source::OnRequest(|r| r.mass_matrix.as_ref())),
    row(Kernel::MassFactor, Group::MassMatrix, "mass_factor", "D and L of M = Lᵀ D L", Source::OnRequest(|r| r.mass_factor.as_ref())),
    row(Kernel::InverseDerivatives, Group::Derivatives, "inverse_derivatives", "∂τ/∂(x, u), row by row", Source::OnRequest(|r| r.inverse_derivatives.as_ref())),
    row(Kernel::ForwardDerivatives, Group::Derivatives, "forward_derivatives", "∂u̇/∂(x, u, τ), row by row", Source::OnRequest(|r| r.forward_derivatives.as_ref())),
    row(Kernel::Regressor, Group::Regressor, "regressor", "Y of what inertia and gravity take, Y θ, row by row", Source::OnRequest(|r| r.regressor.as_ref())),
];

const _: () = {
    let mut place = 0;
    while place < TABLE.len() {
        assert!(TABLE[place].kernel as usize == place, "the table has the order of the variants");
        place += 1;
    }
};

impl Kernel {
    /// All kernels, in the order of the data sheet.
    pub fn all() -> impl Iterator<Item = Self> {
        TABLE.iter().map(|row| row.kernel)
    }

    /// Its name on the data sheet.
    pub fn name(self) -> &'static str {
        self.row().name
    }

    /// What the data sheet claims that it computes.
    pub fn computes(self) -> &'static str {
        self.row().computes
    }

    /// The group that it belongs to.
    pub fn group(self) -> Group {
        self.row().group
    }

    fn row(self) -> &'static Row {
        &TABLE[self as usize]
    }

    /// Its expressions, unless the module has no such kernel.
    fn chosen(self, equations: &Equations) -> Option<Chosen> {
        if !equations.functions.has(self.group()) {
            return None;
        }
        let joint_space = equations.joint_space.as_ref();
        match self.row().source {
            Source::Parameters => None,
            Source::Equations(of) => Some(of(equations)),
            Source::Charts(of) => equations.charts.as_ref().map(of),
            Source::JointSpace(of) => joint_space.map(of),
            Source::Jacobian(of) => joint_space?.jacobian.as_ref().map(of),
            Source::ParameterJacobian(of) => joint_space?.parameter_jacobian.as_ref().map(of),
            Source::JointOutputs => joint_space?.outputs.clone(),
            Source::OutputDerivatives(of) => joint_space?.output_derivatives.as_ref().map(of),
            Source::Frames(of) => joint_space?.frames.as_ref().map(of),
            Source::OnRequest(of) => of(&joint_space?.on_request).cloned(),
        }
    }
}

/// The kernels of a module that compute something.
#[derive(Debug)]
pub struct Kernels(BTreeMap<Kernel, Chosen>);

impl Kernels {
    pub fn of(equations: &Equations) -> Self {
        let chosen = Kernel::all().filter_map(|kernel| Some((kernel, kernel.chosen(equations)?)));
        Self(chosen.filter(|(_, chosen)| !chosen.roots.is_empty()).collect())
    }

    /// The passes after all choices: over each kernel by itself, then over all together, from which
    /// [`Kernel::ParameterSetup`] results.
    pub fn finish(&mut self, graph: &mut Graph, passes: FinalPasses) {
        for chosen in self.0.values_mut() {
            chosen.roots = passes.applied(graph, &chosen.roots);
        }
        // Multipliers of loops come with the exact accelerations alone.
        let is_loop_multiplier = |id| matches!(graph.node(id), Node::Symbol(Symbol::LoopMultiplier(_)));
        if graph.reachable(self.roots(Kernel::CorrectedDerivative)).into_iter().any(is_loop_multiplier) {
            self.0.remove(&Kernel::CorrectedDerivative);
        }
        let roots = self.0.values_mut().map(|chosen| &mut chosen.roots);
        let parameter_setup = parameter_setup::separate(graph, roots);
        if !parameter_setup.is_empty() {
            self.0.insert(Kernel::ParameterSetup, parameter_setup.into());
        }
    }

    /// The expressions that a kernel computes; none if the module has no such kernel.
    pub fn roots(&self, kernel: Kernel) -> &[ExprId] {
        self.0.get(&kernel).map_or(&[], |chosen| &chosen.roots)
    }

    /// All of them, in the order of the data sheet.
    pub fn iter(&self) -> impl Iterator<Item = (Kernel, &Chosen)> {
        self.0.iter().map(|(&kernel, chosen)| (kernel, chosen))
    }
}

#[cfg(test)]
mod tests {
    use super::{Kernel, Kernels};
    use crate::Elimination;
    use crate::expr::schedule::Operations;
    use crate::groups::Functions;

    /// Operations of some kernels together.
    fn cost(page: &str, elimination: Elimination, wanted: &[Kernel]) -> usize {
        let model = gyro_model::read("page.toml", page).expect("a model file without mistakes");
        let start = model.assemble().expect("a start");
        let mut equations =
            crate::equations(&model, (elimination, &Functions::usual(), crate::Effort::Full), &start);
        let mut kernels = Kernels::of(&equations);
        kernels.finish(&mut equations.graph, equations.passes);
        let of = |&kernel: &Kernel| Operations::count(&equations.graph, kernels.roots(kernel)).total();
        wanted.iter().map(of).sum()
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
                "damping" => "damping = 0.1\n".to_owned(),
                element => format!("[[force]]\nname = \"f{index}\"\njoint = \"j{index}\"\n{element}\n"),
            };
        }
        page
    }

    /// Torque times rate: a product and a sum for each motor, and one product more where the force is yet to be
    /// computed.
    #[test]
    fn power_is_read_from_joint_coordinates() {
        const MOTOR: &str = "kind = \"motor\"\nvalue = \"u\"";
        const DAMPER: &str = "kind = \"damper\"\ndamping = 0.3";
        let cost = |joints: &[(&str, &str)]| {
            cost(&chain(joints), Elimination::NullSpace, &[Kernel::JointDerivative])
        };
        let check = |joints: &[(&str, &str)], allowed: usize| {
            let cost = cost(joints);
            assert!(cost <= allowed, "{joints:?}: {cost} operations, more than {allowed}");
        };
        check(&[("revolute", MOTOR); 5], 9);
        check(&[("revolute", DAMPER), ("prismatic", "damping"), ("revolute", MOTOR)], 7);
        // ẋ of a spherical joint takes operations of its own.
        let alone = cost(&[("revolute", "damping"), ("spherical", "")]) - 2;
        check(&[("revolute", "damping"), ("spherical", "damping")], alone + 9);
    }

    /// The paper's scene costs about what an analyst's pencil reaches: 17 operations for the joint accelerations, in
    /// benches/.
    #[test]
    fn nothing_is_computed_that_the_paper_s_scene_does_not_need() {
        let page = include_str!("../../models/gyroscope.toml");
        let check = |kernels: &[Kernel], allowed: usize| {
            let cost = cost(page, Elimination::NullSpace, kernels);
            assert!(cost <= allowed, "{kernels:?}: {cost} operations, more than {allowed}");
        };
        check(&[Kernel::JointAccelerations], 19);
        check(&[Kernel::JointAccelerationsAt], 39);
        check(&[Kernel::CorrectedAccelerations], 140);
        check(&[Kernel::CorrectedSolution], 210);
        check(&[Kernel::Accelerations], 407);
        let saddle = cost(page, Elimination::Saddle, &[Kernel::Accelerations]);
        assert!(saddle <= 860, "saddle: {saddle}");
    }
}
