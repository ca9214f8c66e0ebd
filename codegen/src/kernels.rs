//! The kernels of a module: where the expressions of each of its functions come from, and the passes over all of them
//! together.

use crate::equations::Equations;
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::symbol::Symbol;
use crate::simplify::cheapest::{Chosen, FinalPasses};
use crate::simplify::parameter_setup;
use gyro_program::Kernel;
use std::collections::BTreeMap;

/// The expressions of a kernel; nothing of one that the module does not have.
#[rustfmt::skip]
fn chosen(kernel: Kernel, e: &Equations) -> Option<Chosen> {
    if !e.functions.has(kernel.group()) {
        return None;
    }
    let space = e.joint_space.as_ref();
    Some(match kernel {
        // What depends on parameters alone is known once all other kernels are.
        Kernel::ParameterSetup => return None,
        Kernel::Phi => e.phi.clone().into(),
        Kernel::PhiQ => e.phi_q.values().into(),
        Kernel::PhiPi => e.phi_pi.values().into(),
        Kernel::Nu => e.nu.clone().into(),
        Kernel::Gamma => e.gamma.clone().into(),
        Kernel::VelocityResidual => e.velocity_residual.clone().into(),
        Kernel::AppliedForce => e.applied_force.clone().into(),
        Kernel::Accelerations => e.solved.clone(),
        Kernel::Multipliers => e.lambda.clone().into(),
        Kernel::Project => e.projection.clone(),
        Kernel::Derivative => e.rates_but_accelerations().into(),
        Kernel::Energy => vec![e.kinetic, e.potential].into(),
        Kernel::ReadJoints => e.readings.clone().into(),
        Kernel::Outputs => e.outputs.clone().into(),
        Kernel::ChartVectors => e.charts.as_ref()?.vectors.clone().into(),
        Kernel::NewtonStep => e.charts.as_ref()?.newton_positions.clone().into(),
        Kernel::SolveVelocities => e.charts.as_ref()?.solved_velocities.clone().into(),
        Kernel::JointAccelerations => space?.accelerations.clone(),
        Kernel::JointDerivative => space?.derivative.clone().into(),
        Kernel::ToMaximal => space?.maximal.clone().into(),
        Kernel::ToJoints => space?.reduced.clone().into(),
        Kernel::JointAccelerationsAt => space?.accelerations_at.clone(),
        Kernel::CorrectedAccelerations => space?.corrected.clone(),
        Kernel::CorrectedDerivative => e.rates_at_corrected_states().into(),
        Kernel::CorrectedMultipliers => space?.multipliers.clone().into(),
        Kernel::CorrectedSolution => space?.solution.clone().into(),
        Kernel::JointJacobian => space?.jacobian.as_ref()?.by_state_and_time.clone(),
        Kernel::JointInputJacobian => space?.jacobian.as_ref()?.by_inputs.clone(),
        Kernel::JointParameterJacobian => space?.parameter_jacobian.as_ref()?.0.clone(),
        Kernel::LoopClosure => space?.closure.clone().into(),
        Kernel::ClosureDistances => space?.distances.clone().into(),
        Kernel::ClosePositions => space?.closer_coordinates.clone().into(),
        Kernel::CloseVelocities => space?.closing_rates.clone().into(),
        Kernel::JointOutputs => space?.outputs.clone()?,
        Kernel::OutputsByState => space?.output_derivatives.as_ref()?.by_state.clone(),
        Kernel::OutputsByAccelerations => space?.output_derivatives.as_ref()?.by_accelerations.clone(),
        Kernel::OutputsByInputs => space?.output_derivatives.as_ref()?.by_inputs.clone(),
        Kernel::OutputsByParameters => space?.output_derivatives.as_ref()?.by_parameters.clone(),
        Kernel::FrameJacobians => space?.frames.as_ref()?.jacobians.clone(),
        Kernel::FrameBiases => space?.frames.as_ref()?.biases.clone(),
        _ => space?.on_request.forms.get(&kernel)?.clone(),
    })
}

/// The kernels of a module that compute something.
#[derive(Debug)]
pub struct Kernels(BTreeMap<Kernel, Chosen>);

impl Kernels {
    pub fn of(equations: &Equations) -> Self {
        let chosen = Kernel::all().filter_map(|kernel| Some((kernel, chosen(kernel, equations)?)));
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
    use super::Kernels;
    use crate::Elimination;
    use crate::expr::schedule::Operations;
    use crate::groups::Functions;
    use gyro_program::Kernel;

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
