//! What a module must look like around its formulas: everything that the description alone determines.
//!
//! Function bodies are left open as `{ HOLE_name }`, counts that depend on formulas as `INT_name`, and arguments that a
//! body may leave unread as `ANY_name`.

mod definition;
mod mechanism;
mod partition;
mod pieces;

pub use mechanism::{n_readings, n_state};
pub use partition::Choice;

use crate::joints::JointLayout;
use definition::{constants, definition, setter};
use gyro_model::{Model, Spline};
use mechanism::{mechanism, ode};
use partition::partition;
use pieces::{buffers, fillings, lines, lookup, name_lookup};

/// What the description leaves to choice.
#[derive(Clone, Copy, Debug)]
pub struct Has {
    /// How the coordinate partition is chosen.
    pub choice: Choice,
    /// The Jacobian of the joint form.
    pub jacobian: bool,
    /// A function of what depends on parameters alone.
    pub set_up: bool,
}

/// The expected text.
pub fn text(
    model: &Model,
    type_name: &str,
    tables: &[Spline],
    has: Has,
    joints: Option<&JointLayout>,
) -> String {
    [
        constants(tables),
        definition(model, type_name, has.set_up),
        ode(model, type_name),
        mechanism(model, type_name, joints.is_some()),
        partition(model, type_name, has.choice, joints),
        equations(model, type_name),
        projection(type_name),
        joints.map(|joints| joint_space(model, type_name, joints)).unwrap_or_default(),
        joints
            .filter(|_| has.jacobian)
            .map(|joints| joint_jacobian(model, type_name, joints))
            .unwrap_or_default(),
        ports(model, type_name),
    ]
    .concat()
}

/// `gyroscope_maximal` to `GyroscopeMaximal`; a name that Rust or the module needs otherwise gets an underscore.
pub fn type_name(name: &str) -> String {
    let words = name.split('_').filter(|word| !word.is_empty());
    let name: String = words.map(|word| word[..1].to_uppercase() + &word[1..]).collect();
    if ["Self", "T", "Parameters"].contains(&name.as_str()) { name + "_" } else { name }
}

fn equations(model: &Model, name: &str) -> String {
    let velocities = (6 * model.coordinate_bodies().len()).to_string();
    let patterns =
        lines(["phi_q", "phi_pi"].map(|matrix| {
            format!("fn {matrix}_pattern(&self) -> &[(u16, u16)] {{ HOLE_{matrix}_pattern }}")
        }));
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::Equations for {name}<T> {{
            type Velocities = [T; {velocities}];
            type PhiQ = [T; INT_phi_q];
            type PhiPi = [T; INT_phi_pi];
            type Accelerations = [T; INT_accelerations];
            {} {patterns} {} {}
        }}",
        buffers(&[
            ("velocities", "Velocities", &velocities),
            ("phi_q_values", "PhiQ", "INT_phi_q"),
            ("phi_pi_values", "PhiPi", "INT_phi_pi"),
            ("accelerations_buffer", "Accelerations", "INT_accelerations"),
        ]),
        fillings(&[
            ("phi_q", "PhiQ"),
            ("phi_pi", "PhiPi"),
            ("nu", "Rows"),
            ("gamma", "Rows"),
            ("applied_force", "Velocities"),
            ("accelerations", "Accelerations"),
        ]),
        multipliers("multipliers", "Accelerations"),
    )
}

fn multipliers(name: &str, accelerations: &str) -> String {
    format!(
        "fn {name}(
            &self, ANY_t: T, ANY_y: &Self::State, ANY_accelerations: &Self::{accelerations}, lambda: &mut Self::Rows,
        ) {{ HOLE_{name} }}"
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

fn joint_space(model: &Model, name: &str, joints: &JointLayout) -> String {
    let n_solution = 6 * model.coordinate_bodies().len() + model.rows().len();
    let (n_state, n_rates) = (joints.n_state(), joints.n_rates);
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::JointSpace for {name}<T> {{
            type Joints = [T; {n_state}];
            type Rates = [T; {n_rates}];
            type Solution = [T; {n_solution}];
            fn joint_start(&self) -> Self::Joints {{ HOLE_joint_start }}
            {}
            fn joint_accelerations(&self, ANY_t: T, ANY_x: &Self::Joints, ANY_out: &mut Self::Rates) {{
                HOLE_joint_accelerations
            }}
            fn joint_derivative(&self, t: T, x: &Self::Joints, dx: &mut Self::Joints) {{ HOLE_joint_derivative }}
            fn to_maximal(&self, ANY_t: T, ANY_x: &Self::Joints, y: &mut Self::State) {{ HOLE_to_maximal }}
            fn to_joints(&self, ANY_t: T, ANY_y: &Self::State, x: &mut Self::Joints) {{ HOLE_to_joints }}
            {}
            {}
            {}
        }}",
        buffers(&[
            ("rates", "Rates", &n_rates.to_string()),
            ("solution", "Solution", &n_solution.to_string()),
        ]),
        fillings(&[("joint_accelerations_at", "Rates"), ("corrected_accelerations", "Velocities")]),
        multipliers("corrected_multipliers", "Velocities"),
        fillings(&[("corrected_solution", "Solution")]),
    )
}

fn joint_jacobian(model: &Model, name: &str, joints: &JointLayout) -> String {
    let (n_state, n_inputs) = (joints.n_state().pow(2), joints.n_state() * model.inputs.len());
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::JointJacobian for {name}<T> {{
            type Jacobian = [T; {n_state}];
            type InputJacobian = [T; {n_inputs}];
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
        buffers(&[
            ("joint_jacobian_buffer", "Jacobian", &n_state.to_string()),
            ("input_jacobian_buffer", "InputJacobian", &n_inputs.to_string()),
        ]),
    )
}

/// Numbers of all outputs: name, suffix, unit.
fn columns(model: &Model) -> Vec<(&str, &'static str, &'static str)> {
    let of = |output: &'_ gyro_model::Output| output.kind.columns().to_vec();
    let outputs = model.outputs.iter();
    outputs.flat_map(|o| of(o).into_iter().map(|(suffix, unit)| (o.name.as_str(), suffix, unit))).collect()
}

fn ports(model: &Model, name: &str) -> String {
    let info = |(name, suffix, unit): (&str, &str, &str)| {
        format!("gyro_sim::OutputInfo {{ name: {name:?}, suffix: {suffix:?}, unit: {unit:?} }}")
    };
    let infos: Vec<_> = columns(model).into_iter().map(info).collect();
    let inputs: Vec<_> = model.inputs.iter().map(|input| &input.name).collect();
    let count = infos.len().to_string();
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::Ports for {name}<T> {{
            type Outputs = [T; {count}];
            {} {}
            fn n_outputs(&self) -> usize {{ {count} }}
            {}
            fn n_inputs(&self) -> usize {{ {} }}
            {} {}
        }}",
        buffers(&[("outputs_buffer", "Outputs", &count)]),
        fillings(&[("outputs", "Outputs")]),
        lookup(
            "fn output(&self, index: usize) -> gyro_sim::OutputInfo<'_> OUTPUTS",
            "index",
            "gyro_sim::OutputInfo<'static>",
            &infos,
            &format!("unwrap_or({})", info(("", "", ""))),
        ),
        inputs.len(),
        name_lookup("input_name", "index", "INPUTS", &inputs),
        setter("fn set_input", &model.inputs, ("self", "", "")),
    )
}
