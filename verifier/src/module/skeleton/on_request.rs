//! What modules have where it is asked for.

use crate::joints::JointLayout;
use gyro_model::Model;

pub fn inverse_dynamics(name: &str) -> String {
    let functions = [
        of_accelerations("inverse_dynamics", "Rates"),
        of_joints("bias_forces", "Rates"),
        of_joints("gravity_forces", "Rates"),
    ];
    implementation("InverseDynamics", name, &functions.concat())
}

pub fn mass_matrix(name: &str, joints: &JointLayout) -> String {
    let n = joints.n_rates * joints.n_rates;
    let items = [
        format!(
            "type MassMatrix = [T; {n}];
            fn mass_buffer(&self) -> Self::MassMatrix {{ [T::constant(0.0); {n}] }}
            fn mass_order(&self) -> &[u16] {{ HOLE_mass_order }}"
        ),
        of_joints("mass_matrix", "MassMatrix"),
        of_joints("mass_factor", "MassMatrix"),
    ];
    implementation("MassMatrix", name, &items.concat())
}

pub fn derivatives(name: &str, joints: &JointLayout) -> String {
    let n = joints.n_rates * joints.n_rates;
    let [of_forces, of_rates] = [2 * n, 3 * n];
    let items = [
        format!(
            "type InverseDerivatives = [T; {of_forces}];
            type ForwardDerivatives = [T; {of_rates}];
            fn inverse_buffer(&self) -> Self::InverseDerivatives {{ [T::constant(0.0); {of_forces}] }}
            fn forward_buffer(&self) -> Self::ForwardDerivatives {{ [T::constant(0.0); {of_rates}] }}"
        ),
        of_accelerations("inverse_derivatives", "InverseDerivatives"),
        of_joints("forward_derivatives", "ForwardDerivatives"),
    ];
    implementation("DynamicsDerivatives", name, &items.concat())
}

pub fn regressor(model: &Model, name: &str, joints: &JointLayout) -> String {
    let n = 10 * joints.n_rates * model.coordinate_bodies().len();
    let items = [
        format!(
            "type Regressor = [T; {n}];
            fn regressor_buffer(&self) -> Self::Regressor {{ [T::constant(0.0); {n}] }}"
        ),
        of_accelerations("regressor", "Regressor"),
    ];
    implementation("Regressor", name, &items.concat())
}

fn implementation(of: &str, name: &str, items: &str) -> String {
    format!("impl<T: gyro_sim::Scalar> gyro_sim::{of} for {name}<T> {{ {items} }}")
}

/// A function of time and joint state.
fn of_joints(name: &str, out: &str) -> String {
    format!("fn {name}(&self, ANY_t: T, ANY_x: &Self::Joints, ANY_out: &mut Self::{out}) {{ HOLE_{name} }}")
}

/// A function of time, joint state and u̇.
fn of_accelerations(name: &str, out: &str) -> String {
    format!(
        "fn {name}(
            &self, ANY_t: T, ANY_x: &Self::Joints, ANY_accelerations: &Self::Rates, ANY_out: &mut Self::{out},
        ) {{ HOLE_{name} }}"
    )
}
