//! What a module must look like around its formulas: everything that the description alone determines.
//!
//! Function bodies are left open as `{ HOLE_name }`, counts that depend on formulas as `INT_name`, and arguments that a
//! body may leave unread as `ANY_name`.

mod definition;
mod mechanism;
mod on_request;
mod partition;
mod pieces;

pub use mechanism::{n_readings, n_state};
pub use on_request::OnRequest;
pub use partition::Choice;

use crate::joints::{Freedom, JointLayout};
use definition::{constants, definition};
use gyro_model::{Model, Spline};
use mechanism::mechanism;
use partition::partition;
use pieces::{buffers, fillings, lines, list};

/// What the description leaves to choice.
#[derive(Clone, Copy, Debug)]
pub struct Has {
    /// How the coordinate partition is chosen.
    pub choice: Choice,
    /// The Jacobian of the joint form.
    pub jacobian: bool,
    /// A derivative that goes on from other accelerations, at states that satisfy the constraints.
    pub corrected_derivative: bool,
    /// A function of what depends on parameters alone.
    pub parameter_setup: bool,
    /// What is there only where it is asked for.
    pub on_request: OnRequest,
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
        definition(model, type_name, has.parameter_setup),
        mechanism(model, type_name, joints.is_some() && has.corrected_derivative),
        partition(model, type_name, has.choice, joints),
        equations(model, type_name),
        joints.map(|joints| joint_space(model, type_name, joints, has.jacobian)).unwrap_or_default(),
        joints.map(|joints| has.on_request.text(model, type_name, joints)).unwrap_or_default(),
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
            fn project(
                &self, ANY_t: T, ANY_y: &Self::State, ANY_rows: &Self::Rows, ANY_out: &mut Self::Velocities,
            ) {{ HOLE_project }}
        }}",
        buffers(
            "terms",
            "Terms",
            &[
                ("velocities", &velocities),
                ("phi_q", "INT_phi_q"),
                ("phi_pi", "INT_phi_pi"),
                ("accelerations", "INT_accelerations"),
            ],
        ),
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

fn joint_space(model: &Model, name: &str, joints: &JointLayout, has_jacobian: bool) -> String {
    let n_solution = 6 * model.coordinate_bodies().len() + model.rows().len();
    let (n_state, n_rates, n_closure) = (joints.n_state(), joints.n_rates, joints.closure_rows.len());
    let sizes = [n_state * n_state, n_state * model.inputs.len()];
    let [(jacobian, no_slopes), (input_jacobian, no_input_slopes)] = if has_jacobian {
        sizes.map(|n| (format!("[T; {n}]"), format!("[T::constant(0.0); {n}]")))
    } else {
        sizes.map(|_| ("()".to_owned(), "()".to_owned()))
    };
    let jacobians = "fn joint_jacobian(
            &self, ANY_t: T, ANY_x: &Self::Joints, dfdx: &mut Self::Jacobian, dfdt: &mut Self::Joints,
        ) {
            HOLE_joint_jacobian
        }
        fn joint_input_jacobian(&self, ANY_t: T, ANY_x: &Self::Joints, ANY_out: &mut Self::InputJacobian) {
            HOLE_joint_input_jacobian
        }";
    let jacobians = if has_jacobian { jacobians } else { "" };
    let layout = layout(joints);
    let (closure, no_closure) = match n_closure {
        0 => ("", "[]".to_owned()),
        n => (CLOSURE, format!("[T::constant(0.0); {n}]")),
    };
    format!(
        "impl<T: gyro_sim::Scalar> gyro_sim::JointSpace for {name}<T> {{
            type Joints = [T; {n_state}];
            type Rates = [T; {n_rates}];
            type Solution = [T; {n_solution}];
            type Closure = [T; {n_closure}];
            type Jacobian = {jacobian};
            type InputJacobian = {input_jacobian};
            fn joint_layout(&self) -> &gyro_sim::JointLayout<'_> {{
                const LAYOUT: gyro_sim::JointLayout<'static> = {layout};
                &LAYOUT
            }}
            fn joint_buffers(&self) -> gyro_sim::JointBuffers<Self> {{
                gyro_sim::JointBuffers {{
                    rates: [T::constant(0.0); {n_rates}],
                    solution: [T::constant(0.0); {n_solution}],
                    closure: {no_closure},
                    jacobian: {no_slopes},
                    input_jacobian: {no_input_slopes}
                }}
            }}
            fn joint_start(&self) -> Self::Joints {{ HOLE_joint_start }}
            fn joint_accelerations(&self, ANY_t: T, ANY_x: &Self::Joints, ANY_out: &mut Self::Rates) {{
                HOLE_joint_accelerations
            }}
            fn joint_derivative(&self, t: T, x: &Self::Joints, dx: &mut Self::Joints) {{ HOLE_joint_derivative }}
            fn to_maximal(&self, ANY_t: T, ANY_x: &Self::Joints, y: &mut Self::State) {{ HOLE_to_maximal }}
            fn to_joints(&self, ANY_t: T, ANY_y: &Self::State, x: &mut Self::Joints) {{ HOLE_to_joints }}
            {}
            {}
            {}
            {jacobians}
            {closure}
        }}",
        fillings(&[("joint_accelerations_at", "Rates"), ("corrected_accelerations", "Velocities")]),
        multipliers("corrected_multipliers", "Velocities"),
        fillings(&[("corrected_solution", "Solution")]),
    )
}

/// Where the numbers of the joint state stand.
fn layout(joints: &JointLayout) -> String {
    let places = list(joints.places.iter().map(|place| {
        let what = match place.of {
            Freedom::Scalar(on) => {
                format!("Scalar {{ joint: {}, coordinate: {} }}", on.joint, on.coordinate)
            }
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
