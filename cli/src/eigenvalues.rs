//! Eigenvalues of matrices of any size.

use nalgebra::{Complex, DMatrix};

/// The eigenvalues of a square matrix. One without rows, as of a mechanism that drivers determine, has none; nalgebra's
/// Schur form takes it for a mistake.
pub(crate) fn of(matrix: &DMatrix<f64>) -> Vec<Complex<f64>> {
    match matrix.nrows() {
        0 => Vec::new(),
        _ => matrix.complex_eigenvalues().iter().copied().collect(),
    }
}
