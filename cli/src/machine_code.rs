//! Machine code of a generated module: a library that has each of its functions for `f64`, and what `nm` says of it.

use crate::programs::output;
use gyro_codegen::Kernel;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::Command;

/// How a function of the library is called.
struct Call {
    /// Its name.
    function: &'static str,
    /// What it takes besides the mechanism and the time, and how that is passed on.
    takes: &'static str,
    passes: &'static str,
    returns: &'static str,
}

/// Of each kernel; none of what is called within `set_parameters`.
fn call(kernel: Kernel) -> Option<Call> {
    let [function, takes, passes, returns] = match kernel {
        Kernel::ParameterSetup => return None,
        Kernel::Phi => ["phi", "y: &State, out: &mut <Module as Mechanism>::Constraints", "y, out", ""],
        Kernel::PhiQ => ["phi_q", "y: &State, out: &mut <Module as Kinematics>::PhiQ", "y, out", ""],
        Kernel::PhiPi => ["phi_pi", "y: &State, out: &mut <Module as Kinematics>::PhiPi", "y, out", ""],
        Kernel::Nu => ["nu", "y: &State, out: &mut Rows", "y, out", ""],
        Kernel::Gamma => ["gamma", "y: &State, out: &mut Rows", "y, out", ""],
        Kernel::VelocityResidual => ["velocity_residual", "y: &State, out: &mut Rows", "y, out", ""],
        Kernel::AppliedForce => {
            ["applied_force", "y: &State, out: &mut <Module as Mechanism>::Velocities", "y, out", ""]
        }
        Kernel::Accelerations => ["accelerations", "y: &State, out: &mut Accelerations", "y, out", ""],
        Kernel::Multipliers => {
            ["multipliers", "y: &State, a: &Accelerations, out: &mut Rows", "y, a, out", ""]
        }
        Kernel::Project => [
            "project",
            "y: &State, rows: &Rows, out: &mut <Module as Mechanism>::Velocities",
            "y, rows, out",
            "",
        ],
        Kernel::Derivative => ["derivative", "y: &State, dy: &mut State", "y, dy", ""],
        Kernel::Energy => ["energy", "y: &State", "y", "Energy<f64>"],
        Kernel::ReadJoints => {
            ["read_joints", "y: &State, out: &mut <Module as Mechanism>::Readings", "y, out", ""]
        }
        Kernel::Outputs => ["outputs", "y: &State, out: &mut <Module as Mechanism>::Outputs", "y, out", ""],
        Kernel::ChartVectors => ["independent", "y: &State", "y", "Choice"],
        Kernel::NewtonStep => {
            ["newton_step", "choice: &Choice, y: &mut State", "choice, y", "Result<(), Error>"]
        }
        Kernel::SolveVelocities => {
            ["solve_velocities", "choice: &Choice, y: &mut State", "choice, y", "Result<(), Error>"]
        }
        Kernel::JointAccelerations => ["joint_accelerations", "x: &Joints, out: &mut Rates", "x, out", ""],
        Kernel::JointDerivative => ["joint_derivative", "x: &Joints, dx: &mut Joints", "x, dx", ""],
        Kernel::ToMaximal => ["to_maximal", "x: &Joints, y: &mut State", "x, y", ""],
        Kernel::ToJoints => ["to_joints", "y: &State, x: &mut Joints", "y, x", ""],
        Kernel::JointAccelerationsAt => {
            ["joint_accelerations_at", "y: &State, out: &mut Rates", "y, out", ""]
        }
        Kernel::CorrectedAccelerations => [
            "corrected_accelerations",
            "y: &State, out: &mut <Module as Mechanism>::Velocities",
            "y, out",
            "",
        ],
        Kernel::CorrectedDerivative => ["corrected_derivative", "y: &State, dy: &mut State", "y, dy", ""],
        Kernel::CorrectedMultipliers => [
            "corrected_multipliers",
            "y: &State, a: &<Module as Mechanism>::Velocities, out: &mut Rows",
            "y, a, out",
            "",
        ],
        Kernel::CorrectedSolution => [
            "corrected_solution",
            "y: &State, out: &mut <Module as CorrectedSolution>::Solution",
            "y, out",
            "",
        ],
        Kernel::JointJacobian => [
            "joint_jacobian",
            "x: &Joints, dfdx: &mut <Module as JointJacobian>::Jacobian, dfdt: &mut Joints",
            "x, dfdx, dfdt",
            "",
        ],
        Kernel::JointInputJacobian => [
            "joint_input_jacobian",
            "x: &Joints, out: &mut <Module as JointJacobian>::InputJacobian",
            "x, out",
            "",
        ],
        Kernel::JointParameterJacobian => [
            "joint_parameter_jacobian",
            "x: &Joints, out: &mut <Module as ParameterJacobian>::ParameterJacobian",
            "x, out",
            "",
        ],
        Kernel::LoopClosure => {
            ["loop_closure", "x: &Joints, out: &mut <Module as JointSpace>::Closure", "x, out", ""]
        }
        Kernel::ClosureDistances => {
            ["closure_distances", "x: &Joints, out: &mut <Module as JointSpace>::Closure", "x, out", ""]
        }
        Kernel::ClosePositions => ["close_positions", "x: &mut Joints", "x", ""],
        Kernel::CloseVelocities => ["close_velocities", "x: &mut Joints", "x", ""],
        Kernel::JointOutputs => {
            ["joint_outputs", "x: &Joints, out: &mut <Module as Mechanism>::Outputs", "x, out", ""]
        }
        Kernel::OutputsByState => [
            "outputs_by_state",
            "x: &Joints, a: &Rates, out: &mut <Module as OutputDerivatives>::ByState",
            "x, a, out",
            "",
        ],
        Kernel::OutputsByAccelerations => [
            "outputs_by_accelerations",
            "x: &Joints, a: &Rates, out: &mut <Module as OutputDerivatives>::ByAccelerations",
            "x, a, out",
            "",
        ],
        Kernel::OutputsByInputs => [
            "outputs_by_inputs",
            "x: &Joints, a: &Rates, out: &mut <Module as OutputDerivatives>::ByInputs",
            "x, a, out",
            "",
        ],
        Kernel::OutputsByParameters => [
            "outputs_by_parameters",
            "x: &Joints, a: &Rates, out: &mut <Module as OutputDerivatives>::ByParameters",
            "x, a, out",
            "",
        ],
        Kernel::FrameJacobians => {
            ["frame_jacobians", "x: &Joints, out: &mut <Module as Frames>::FrameJacobians", "x, out", ""]
        }
        Kernel::FrameBiases => {
            ["frame_biases", "x: &Joints, out: &mut <Module as Frames>::FrameBiases", "x, out", ""]
        }
        Kernel::InverseDynamics => {
            ["inverse_dynamics", "x: &Joints, a: &Rates, out: &mut Rates", "x, a, out", ""]
        }
        Kernel::BiasForces => ["bias_forces", "x: &Joints, out: &mut Rates", "x, out", ""],
        Kernel::GravityForces => ["gravity_forces", "x: &Joints, out: &mut Rates", "x, out", ""],
        Kernel::MassMatrix => {
            ["mass_matrix", "x: &Joints, out: &mut <Module as MassMatrix>::MassMatrix", "x, out", ""]
        }
        Kernel::MassFactor => {
            ["mass_factor", "x: &Joints, out: &mut <Module as MassMatrix>::MassMatrix", "x, out", ""]
        }
        Kernel::InverseDerivatives => [
            "inverse_derivatives",
            "x: &Joints, a: &Rates, out: &mut <Module as DynamicsDerivatives>::InverseDerivatives",
            "x, a, out",
            "",
        ],
        Kernel::ForwardDerivatives => [
            "forward_derivatives",
            "x: &Joints, out: &mut <Module as DynamicsDerivatives>::ForwardDerivatives",
            "x, out",
            "",
        ],
        Kernel::Regressor => [
            "regressor",
            "x: &Joints, a: &Rates, out: &mut <Module as Regressor>::Regressor",
            "x, a, out",
            "",
        ],
    };
    Some(Call { function, takes, passes, returns })
}

/// Types of the module that only some of the calls name, with the traits that have them.
const OF_TRAITS: [(&str, &str); 4] = [
    ("Accelerations", "Dynamics>::Accelerations"),
    ("Choice", "Partition>::Independent"),
    ("Joints", "JointSpace>::Joints"),
    ("Rates", "JointSpace>::Rates"),
];

/// The root of a library whose module `mechanism` has this type, with the functions of these kernels: without them
/// nothing would be compiled.
pub fn library(type_name: &str, kernels: &[Kernel]) -> String {
    let mut text = format!(
        "#[allow(warnings, clippy::all)]
mod mechanism;

#[allow(unused_imports)]
use gyro_sim::*;

pub type Module = mechanism::{type_name}<f64>;
type State = <Module as Mechanism>::State;
type Rows = <Module as Mechanism>::Rows;
"
    );
    let calls: Vec<_> = kernels.iter().filter_map(|&kernel| call(kernel)).collect();
    for (name, of) in OF_TRAITS {
        let names = |text: &str| text.contains(&format!("&{name}")) || text.contains(&format!("&mut {name}"));
        if calls.iter().any(|call| names(call.takes) || call.returns == name) {
            text += &format!("type {name} = <Module as {of};\n");
        }
    }
    for Call { function, takes, passes, returns } in calls {
        let returns = if returns.is_empty() { String::new() } else { format!(" -> {returns}") };
        text += &format!(
            "#[inline(never)]\npub fn {function}(module: &Module, t: f64, {takes}){returns} {{ module.{function}(t, {passes}) }}\n"
        );
    }
    text
}

/// Option of rustc for the library: symbols tell whose part a closure is.
pub const SYMBOLS: &str = "-Csymbol-mangling-version=v0";

/// Bytes of each function of a compiled library, with what the compiler has inlined into it and the parts that
/// are compiled apart; none without `nm`.
pub fn bytes(library: &Path) -> Option<BTreeMap<Kernel, u64>> {
    let symbols = output(Command::new("nm").args(["--print-size", "--demangle"]).arg(library)).ok()?;
    Some(sizes(&symbols))
}

fn sizes(symbols: &str) -> BTreeMap<Kernel, u64> {
    let mut sizes = BTreeMap::new();
    for (function, size) in symbols.lines().filter_map(size) {
        let is_called = |kernel: &Kernel| call(*kernel).is_some_and(|call| call.function == function);
        if let Some(kernel) = Kernel::all().find(is_called) {
            *sizes.entry(kernel).or_default() += size;
        }
    }
    sizes
}

/// The function that a symbol is the code, or a part of the code, of, and its size.
fn size(line: &str) -> Option<(&str, u64)> {
    let [_, size, kind, name] = line.splitn(4, ' ').collect::<Vec<_>>().try_into().ok()?;
    // What is compiled apart is named by its closure: `gyro_sim::apart::<.., <.. as ..>::accelerations::{closure#0}>`.
    let function = name.split("::{closure").next()?;
    let last = function.rsplit("::").next()?;
    let size = u64::from_str_radix(size, 16).ok()?;
    matches!(kind, "t" | "T" | "w" | "W").then_some((last, size))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn symbols_count_by_their_last_word() {
        let symbols = "0000000000000000 0000000000000010 T chain::accelerations
0000000000000000 0000000000000100 t <chain::mechanism::Chain2<T> as gyro_sim::mechanism::Dynamics>::accelerations
0000000000000000 0000000000000200 T chain::accelerations_other
0000000000000000 0000000000000001 t gyro_sim::apart::apart::<(f64, f64), <chain::mechanism::Chain2<f64> as gyro_sim::mechanism::Dynamics>::accelerations::{closure#1}>
0000000000000000 0000000000000020 T chain::independent
0000000000000000 0000000000000400 R chain::phi
                 U libm::sin
";
        assert_eq!(
            sizes(symbols),
            BTreeMap::from([(Kernel::Accelerations, 0x111), (Kernel::ChartVectors, 0x20)])
        );
    }

    #[test]
    fn only_what_is_asked_for_is_in_the_library() {
        let text = library("Top", &[Kernel::ParameterSetup, Kernel::Phi]);
        assert!(text.contains("module.phi(t, y, out)") && text.contains("mechanism::Top<f64>"), "{text}");
        assert!(!text.contains("gamma") && !text.contains("type Joints"), "{text}");
    }
}
