//! What modules have where it is asked for.

use crate::joints::JointLayout;
use gyro_model::Model;

/// The traits.
#[derive(Clone, Copy, Debug)]
pub struct OnRequest {
    pub inverse: bool,
    pub mass_matrix: bool,
    pub derivatives: bool,
    pub regressor: bool,
}

impl OnRequest {
    /// What a module's text has of them.
    pub fn of(text: &str) -> Self {
        let has = |name: &str| text.contains(&format!("gyro_sim::{name} for"));
        Self {
            inverse: has("InverseDynamics"),
            mass_matrix: has("MassMatrix"),
            derivatives: has("DynamicsDerivatives"),
            regressor: has("Regressor"),
        }
    }

    /// The expected text.
    pub fn text(self, model: &Model, name: &str, joints: &JointLayout) -> String {
        let inverse = [
            of_accelerations("inverse_dynamics", "Rates"),
            of_joints("bias_forces", "Rates"),
            of_joints("gravity_forces", "Rates"),
        ];
        let n = joints.n_rates * joints.n_rates;
        let mass_matrix = [
            format!(
                "type MassMatrix = [T; {n}];
                fn mass_buffer(&self) -> Self::MassMatrix {{ [T::constant(0.0); {n}] }}
                fn mass_order(&self) -> &[u16] {{ HOLE_mass_order }}"
            ),
            of_joints("mass_matrix", "MassMatrix"),
            of_joints("mass_factor", "MassMatrix"),
        ];
        let [of_forces, of_accelerations] = [2 * n, 3 * n];
        let derivatives = [
            format!(
                "type InverseDerivatives = [T; {of_forces}];
                type ForwardDerivatives = [T; {of_accelerations}];
                fn inverse_buffer(&self) -> Self::InverseDerivatives {{ [T::constant(0.0); {of_forces}] }}
                fn forward_buffer(&self) -> Self::ForwardDerivatives {{ [T::constant(0.0); {of_accelerations}] }}"
            ),
            self::of_accelerations("inverse_derivatives", "InverseDerivatives"),
            of_joints("forward_derivatives", "ForwardDerivatives"),
        ];
        let n_parameters = 10 * joints.n_rates * model.coordinate_bodies().len();
        let regressor = [
            format!(
                "type Regressor = [T; {n_parameters}];
                fn regressor_buffer(&self) -> Self::Regressor {{ [T::constant(0.0); {n_parameters}] }}"
            ),
            self::of_accelerations("regressor", "Regressor"),
        ];
        let traits = [
            (self.inverse, "InverseDynamics", inverse.concat()),
            (self.mass_matrix, "MassMatrix", mass_matrix.concat()),
            (self.derivatives, "DynamicsDerivatives", derivatives.concat()),
            (self.regressor, "Regressor", regressor.concat()),
        ];
        let written = traits.into_iter().filter(|(is_there, ..)| *is_there);
        written.map(|(_, of, items)| implementation(of, name, &items)).collect()
    }
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
