//! Numbers as model files have them.

use super::merge::on_grid;
use nalgebra::{IsometryMatrix3, UnitQuaternion, Vector3};

pub(super) fn vector(v: &Vector3<f64>) -> String {
    list(v.as_slice())
}

pub(super) fn euler_parameters(pose: &IsometryMatrix3<f64>) -> String {
    let p = UnitQuaternion::from_rotation_matrix(&pose.rotation);
    list(&[p.w, p.i, p.j, p.k])
}

pub(super) fn list(values: &[f64]) -> String {
    let texts: Vec<String> = values.iter().map(|x| format!("{:?}", on_grid(*x) + 0.0)).collect();
    format!("[{}]", texts.join(", "))
}
