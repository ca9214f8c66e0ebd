//! What a module must look like around its formulas: everything that the description alone determines.
//!
//! Function bodies are left open as `{ HOLE_name }`, counts that depend on formulas as `INT_name`, and arguments that a
//! body may leave unread as `ANY_name`.

mod definition;
mod indices;
mod mechanism;
mod on_request;
mod partition;
mod pieces;

pub use mechanism::{n_readings, n_state};
pub use partition::Choice;

use crate::joints::{Freedom, JointLayout};
use definition::{constants, definition};
use gyro_model::{Model, Spline};
use indices::indices;
use mechanism::mechanism;
use partition::partition;
use pieces::{buffers, fillings, lines, list};
use std::collections::BTreeSet;

/// What the description leaves to choice.
#[derive(Clone, Debug)]
pub struct Has {
    /// The traits that the module implements, of those that it may leave out.
    pub traits: BTreeSet<&'static str>,
    /// How the coordinate partition is chosen.
    pub choice: Choice,
    /// How accelerations at corrected states are found.
    pub corrected: Corrected,
    /// Whether there is a function of what depends on parameters alone.
    pub parameter_setup: bool,
}

/// How accelerations, and what goes with them, are found at states that satisfy the constraints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Corrected {
    /// Whether the derivative of the state goes on from these accelerations; it is that at any state otherwise.
    pub has_derivative: bool,
    /// Whether accelerations at any state come with multipliers that are cut off.
    pub is_cut: bool,
}

/// The traits that a module may leave out, but for joint coordinates, which their layout shows.
const TRAITS: [&str; 15] = [
    "Partition",
    "Kinematics",
    "Dynamics",
    "Projection",
    "CorrectedDynamics",
    "CorrectedSolution",
    "JointJacobian",
    "ParameterJacobian",
    "JointOutputs",
    "OutputDerivatives",
    "Frames",
    "InverseDynamics",
    "MassMatrix",
    "DynamicsDerivatives",
    "Regressor",
];

impl Has {
    /// What a module's text is to be compared with.
    pub fn of(text: &str) -> Self {
        // A long name stands on a line of its own.
        let is_there = |name: &&str| {
            let of = format!("gyro_sim::{name}");
            text.match_indices(&of).any(|(at, _)| text[at + of.len()..].trim_start().starts_with("for "))
        };
        Self {
            traits: TRAITS.into_iter().filter(is_there).collect(),
            choice: if text.contains("gyro_sim::charts") {
                Choice::Charts
            } else if text.contains("gyro_sim::joint_partition") {
                Choice::Joints
            } else {
                Choice::Pivoting
            },
            corrected: Corrected {
                has_derivative: !text.contains("gyro_sim::Dynamics::derivative(self"),
                is_cut: text.contains("out.copy_from_slice("),
            },
            parameter_setup: text.contains("fn parameter_setup("),
        }
    }

    /// Whether the module implements a trait.
    pub fn implements(&self, name: &str) -> bool {
        self.traits.contains(name)
    }
}

/// The expected text.
pub fn text(
    model: &Model,
    type_name: &str,
    tables: &[Spline],
    has: &Has,
    joints: Option<&JointLayout>,
) -> String {
    let of = |name: &str, text: String| if has.implements(name) { text } else { String::new() };
    let corrected_dynamics = corrected_dynamics(model, type_name, joints.is_some(), has.corrected);
    let of_joints = |text: fn(&Model, &str, &JointLayout) -> String| {
        joints.map(|joints| text(model, type_name, joints)).unwrap_or_default()
    };
    [
        constants(tables),
        definition(model, type_name, has.parameter_setup),
        mechanism(model, type_name),
        of("Partition", partition(model, type_name, has.choice, joints)),
        of("Kinematics", kinematics(type_name)),
        of("Dynamics", dynamics(type_name)),
        of("Projection", projection(type_name)),
        of("CorrectedDynamics", corrected_dynamics),
        of_joints(joint_space),
        of("CorrectedSolution", of_joints(corrected_solution)),
        of("JointJacobian", of_joints(joint_jacobian)),
        of("ParameterJacobian", of_joints(parameter_jacobian)),
        of("JointOutputs", joint_outputs(type_name)),
        of("OutputDerivatives", of_joints(output_derivatives)),
        of("Frames", of_joints(frames)),
        of("InverseDynamics", of_joints(|_, name, _| on_request::inverse_dynamics(name))),
        of("MassMatrix", of_joints(|_, name, joints| on_request::mass_matrix(name, joints))),
        of("DynamicsDerivatives", of_joints(|_, name, joints| on_request::derivatives(name, joints))),
        of("Regressor", of_joints(on_request::regressor)),
        indices(model, joints),
    ]
    .concat()
}

/// `gyroscope_maximal` to `GyroscopeMaximal`; a name that Rust or the module needs otherwise gets an underscore.
pub fn type_name(name: &str) -> String {
    let words = name.split('_').filter(|word| !word.is_empty());
    let name: String = words.map(|word| word[..1].to_uppercase() + &word[1..]).collect();
    if ["Self", "T", "Parameters"].contains(&name.as_str()) { name + "_" } else { name }
}

fn kinematics(name: &str) -> String {
    let patterns =
        lines(["phi_q", "phi_pi"].map(|matrix| {
            format!("fn {matrix}_pattern(&self) -> &[(u16, u16)] {{ HOLE_{matrix}_pattern }}")
        }));
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::Kinematics for {name}<T> {{
            type PhiQ = [T; INT_phi_q];
            type PhiPi = [T; INT_phi_pi];
            {} {patterns} {}
        }}",
        buffers("terms", "Terms", &[("phi_q", "INT_phi_q"), ("phi_pi", "INT_phi_pi")]),
        fillings(&[("phi_q", "PhiQ"), ("phi_pi", "PhiPi"), ("nu", "Rows"), ("gamma", "Rows")]),
    )
}

fn dynamics(name: &str) -> String {
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::Dynamics for {name}<T> {{
            type Accelerations = [T; INT_accelerations];
            fn acceleration_buffer(&self) -> Self::Accelerations {{ [T::constant(0.0); INT_accelerations] }}
            {} {}
            fn derivative(&self, t: T, y: &Self::State, dy: &mut Self::State) {{ HOLE_derivative }}
        }}",
        fillings(&[("accelerations", "Accelerations")]),
        multipliers("multipliers", "Accelerations"),
    )
}

fn projection(name: &str) -> String {
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::Projection for {name}<T> {{
            fn project(
                &self, ANY_t: T, ANY_y: &Self::State, ANY_rows: &Self::Rows, ANY_out: &mut Self::Velocities,
            ) {{ HOLE_project }}
        }}"
    )
}

/// What is not found by way of joint coordinates is what it is at any state.
fn corrected_dynamics(model: &Model, name: &str, has_joints: bool, corrected: Corrected) -> String {
    let n = 6 * model.coordinate_bodies().len();
    let cut = match (has_joints, corrected.is_cut) {
        (true, _) => None,
        (_, false) => Some("gyro_sim::Dynamics::accelerations(self, t, y, out);".to_owned()),
        (_, true) => Some(format!(
            "let mut solved = [T::constant(0.0); INT_accelerations];
            gyro_sim::Dynamics::accelerations(self, t, y, &mut solved);
            out.copy_from_slice(&solved[..{n}]);"
        )),
    };
    let accelerations = match cut {
        None => fillings(&[("corrected_accelerations", "Velocities")]),
        Some(cut) => format!(
            "fn corrected_accelerations(&self, t: T, y: &Self::State, out: &mut Self::Velocities) {{ {cut} }}"
        ),
    };
    let derivative = if has_joints && corrected.has_derivative {
        "HOLE_corrected_derivative"
    } else {
        "gyro_sim::Dynamics::derivative(self, t, y, dy);"
    };
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::CorrectedDynamics for {name}<T> {{
            {accelerations}
            fn corrected_derivative(&self, t: T, y: &Self::State, dy: &mut Self::State) {{ {derivative} }}
        }}"
    )
}

fn corrected_solution(model: &Model, name: &str, _: &JointLayout) -> String {
    let n_solution = 6 * model.coordinate_bodies().len() + model.rows().len();
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::CorrectedSolution for {name}<T> {{
            type Solution = [T; {n_solution}];
            fn solution_buffer(&self) -> Self::Solution {{ [T::constant(0.0); {n_solution}] }}
            {} {} {}
        }}",
        fillings(&[("joint_accelerations_at", "Rates")]),
        multipliers("corrected_multipliers", "Velocities"),
        fillings(&[("corrected_solution", "Solution")]),
    )
}

fn multipliers(name: &str, accelerations: &str) -> String {
    format!(
        "fn {name}(
            &self, ANY_t: T, ANY_y: &Self::State, ANY_accelerations: &Self::{accelerations}, lambda: &mut Self::Rows,
        ) {{ HOLE_{name} }}"
    )
}

fn joint_space(_: &Model, name: &str, joints: &JointLayout) -> String {
    let (n_state, n_rates, n_closure) = (joints.n_state(), joints.n_rates, joints.closure_rows.len());
    let layout = layout(joints);
    let (closure, no_closure) = match n_closure {
        0 => ("", "[]".to_owned()),
        n => (CLOSURE, format!("[T::constant(0.0); {n}]")),
    };
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::JointSpace for {name}<T> {{
            type Joints = [T; {n_state}];
            type Rates = [T; {n_rates}];
            type Closure = [T; {n_closure}];
            fn joint_layout(&self) -> &gyro_sim::JointLayout<'_> {{
                const LAYOUT: gyro_sim::JointLayout<'static> = {layout};
                &LAYOUT
            }}
            fn joint_buffers(&self) -> gyro_sim::JointBuffers<Self> {{
                gyro_sim::JointBuffers {{
                    rates: [T::constant(0.0); {n_rates}],
                    closure: {no_closure}
                }}
            }}
            fn joint_start(&self) -> Self::Joints {{ HOLE_joint_start }}
            fn joint_accelerations(&self, ANY_t: T, ANY_x: &Self::Joints, ANY_out: &mut Self::Rates) {{
                HOLE_joint_accelerations
            }}
            fn joint_derivative(&self, t: T, x: &Self::Joints, dx: &mut Self::Joints) {{ HOLE_joint_derivative }}
            fn to_maximal(&self, ANY_t: T, ANY_x: &Self::Joints, y: &mut Self::State) {{ HOLE_to_maximal }}
            fn to_joints(&self, ANY_t: T, ANY_y: &Self::State, x: &mut Self::Joints) {{ HOLE_to_joints }}
            {closure}
        }}",
    )
}

fn joint_jacobian(model: &Model, name: &str, joints: &JointLayout) -> String {
    let n_state = joints.n_state();
    let [by_state, by_inputs] = [n_state * n_state, n_state * model.inputs.len()];
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::JointJacobian for {name}<T> {{
            type Jacobian = [T; {by_state}];
            type InputJacobian = [T; {by_inputs}];
            {}
            fn joint_jacobian(
                &self, ANY_t: T, ANY_x: &Self::Joints, dfdx: &mut Self::Jacobian, dfdt: &mut Self::Joints,
            ) {{
                HOLE_joint_jacobian
            }}
            fn joint_input_jacobian(&self, ANY_t: T, ANY_x: &Self::Joints, ANY_out: &mut Self::InputJacobian) {{
                HOLE_joint_input_jacobian
            }}
        }}",
        buffers(
            "jacobian_buffers",
            "JacobianBuffers",
            &[("jacobian", &by_state.to_string()), ("input_jacobian", &by_inputs.to_string())],
        ),
    )
}

fn parameter_jacobian(model: &Model, name: &str, joints: &JointLayout) -> String {
    let n = joints.n_state() * model.parameters.len();
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::ParameterJacobian for {name}<T> {{
            type ParameterJacobian = [T; {n}];
            fn parameter_buffer(&self) -> Self::ParameterJacobian {{ [T::constant(0.0); {n}] }}
            fn joint_parameter_jacobian(
                &self, ANY_t: T, ANY_x: &Self::Joints, ANY_out: &mut Self::ParameterJacobian,
            ) {{
                HOLE_joint_parameter_jacobian
            }}
        }}"
    )
}

fn joint_outputs(name: &str) -> String {
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::JointOutputs for {name}<T> {{
            fn joint_outputs(&self, ANY_t: T, ANY_x: &Self::Joints, ANY_out: &mut Self::Outputs) {{ HOLE_joint_outputs }}
        }}"
    )
}

fn output_derivatives(model: &Model, name: &str, joints: &JointLayout) -> String {
    let n_outputs: usize = model.outputs.iter().map(|output| output.kind.columns().len()).sum();
    let n_state = joints.n_coordinates + joints.n_rates;
    let kinds = [
        ("state", "State", n_state),
        ("accelerations", "Accelerations", joints.n_rates),
        ("inputs", "Inputs", model.inputs.len()),
        ("parameters", "Parameters", model.parameters.len()),
    ];
    let types = lines(kinds.map(|(_, ty, n)| format!("type By{ty} = [T; {}];", n_outputs * n)));
    let zeros = list(kinds.map(|(name, _, n)| match n_outputs * n {
        0 => format!("by_{name}: []"),
        n => format!("by_{name}: [T::constant(0.0); {n}]"),
    }));
    let functions = lines(kinds.map(|(name, ty, _)| {
        format!(
            "fn outputs_by_{name}(
                &self, ANY_t: T, ANY_x: &Self::Joints, ANY_accelerations: &Self::Rates, ANY_out: &mut Self::By{ty},
            ) {{ HOLE_outputs_by_{name} }}"
        )
    }));
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::OutputDerivatives for {name}<T> {{
            {types}
            fn output_slopes(&self) -> gyro_sim::OutputSlopes<Self> {{ gyro_sim::OutputSlopes {{ {zeros} }} }}
            {functions}
        }}"
    )
}

fn frames(model: &Model, name: &str, joints: &JointLayout) -> String {
    let frames: Vec<String> = crate::module::frames(model).map(|frame| format!("{:?}", frame.name)).collect();
    let biases = 6 * frames.len();
    let (jacobians, names) = (biases * joints.n_rates, list(frames));
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::Frames for {name}<T> {{
            type FrameJacobians = [T; {jacobians}];
            type FrameBiases = [T; {biases}];
            fn frame_names(&self) -> &[&str] {{ &[{names}] }}
            fn frame_buffers(&self) -> gyro_sim::FrameBuffers<Self> {{
                gyro_sim::FrameBuffers {{
                    jacobians: [T::constant(0.0); {jacobians}],
                    biases: [T::constant(0.0); {biases}]
                }}
            }}
            fn frame_jacobians(&self, ANY_t: T, ANY_x: &Self::Joints, ANY_out: &mut Self::FrameJacobians) {{
                HOLE_frame_jacobians
            }}
            fn frame_biases(&self, ANY_t: T, ANY_x: &Self::Joints, ANY_out: &mut Self::FrameBiases) {{
                HOLE_frame_biases
            }}
        }}"
    )
}

/// Where the numbers of the joint state stand.
fn layout(joints: &JointLayout) -> String {
    let places = list(joints.places.iter().map(|place| {
        let what = match place.of {
            Freedom::Scalar(on) => {
                format!("Scalar {{ joint: {}, coordinate: {} }}", on.joint, on.coordinate)
            }
            Freedom::Turn(on) => format!("Turn {{ joint: {}, coordinate: {} }}", on.joint, on.coordinate),
            Freedom::Orientation { joint } => format!("Orientation {{ joint: {joint} }}"),
            Freedom::Body { moving_body } => format!("Body {{ body: {moving_body} }}"),
        };
        format!("gyro_sim::JointPlace::{what}")
    }));
    let closure_rows = list(&joints.closure_rows);
    format!("gyro_sim::JointLayout {{ places: &[{places}], closure_rows: &[{closure_rows}] }}")
}

/// What mechanisms have whose joint coordinates do not satisfy all rows by themselves.
const CLOSURE: &str = "fn loop_closure(&self, ANY_t: T, ANY_x: &Self::Joints, ANY_out: &mut Self::Closure) {
        HOLE_loop_closure
    }
    fn closure_distances(&self, ANY_t: T, ANY_x: &Self::Joints, ANY_out: &mut Self::Closure) {
        HOLE_closure_distances
    }
    fn close_positions(&self, ANY_t: T, x: &mut Self::Joints) { HOLE_close_positions }
    fn close_velocities(&self, ANY_t: T, x: &mut Self::Joints) { HOLE_close_velocities }";
