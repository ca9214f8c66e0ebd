//! Dense copies of sparse values, and how far two lists of numbers differ.

use crate::Engine;
use gyro_sim::{Kinematics, Mechanism};

/// A dense matrix, row by row.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    /// The rows, all of the same length.
    pub rows: Vec<Vec<f64>>,
}

impl Matrix {
    fn scattered(n_rows: usize, n_columns: usize, pattern: &[(u16, u16)], values: &[f64]) -> Self {
        assert_eq!(pattern.len(), values.len(), "one value for each place of the pattern");
        let mut rows = vec![vec![0.0; n_columns]; n_rows];
        for (&(row, column), &value) in pattern.iter().zip(values) {
            rows[usize::from(row)][usize::from(column)] += value;
        }
        Self { rows }
    }

    /// The product with a column.
    pub fn times(&self, column: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|row| row.iter().zip(column).map(|(a, x)| a * x).sum()).collect()
    }
}

/// Φ_q with respect to (r, p), normalisation rows included.
pub fn phi_q(mechanism: &Engine, t: f64, y: &Vec<f64>) -> Matrix {
    let mut values = mechanism.terms().phi_q;
    mechanism.phi_q(t, y, &mut values);
    let (n_rows, n_columns) =
        (mechanism.buffers().constraints.len(), 7 * mechanism.description().bodies.len());
    Matrix::scattered(n_rows, n_columns, mechanism.phi_q_pattern(), &values)
}

/// (Φ_r, Φ_π').
pub fn phi_pi(mechanism: &Engine, t: f64, y: &Vec<f64>) -> Matrix {
    let mut values = mechanism.terms().phi_pi;
    mechanism.phi_pi(t, y, &mut values);
    let (n_rows, n_columns) = (mechanism.buffers().rows.len(), 6 * mechanism.description().bodies.len());
    Matrix::scattered(n_rows, n_columns, mechanism.phi_pi_pattern(), &values)
}

/// The largest difference of two lists over their largest magnitude, or over `scale` where that is larger; NaN if
/// anything is.
pub fn difference(a: &[f64], b: &[f64], scale: f64) -> f64 {
    assert_eq!(a.len(), b.len(), "lists of the same length are compared");
    let worst = |x: f64, y: f64| if x > y || x.is_nan() { x } else { y };
    let scale = a.iter().chain(b).map(|x| x.abs()).fold(scale, worst);
    let error = a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, worst);
    if error == 0.0 { 0.0 } else { error / scale }
}
