//! How near a pose is to a singular one.

use gyro_sim::{Kinematics, Real, Scalar};

/// The smallest pivot of Φ_q, joint rows and normalisations, by full pivoting (Golub and Van Loan, *Matrix
/// Computations*, section 3.4.8); lengths in units of the mechanism's size.
pub(crate) fn smallest<M: Kinematics<Scalar: Real>>(mechanism: &M, t: f64, y: &M::State) -> f64 {
    let mut values = mechanism.terms().phi_q;
    mechanism.phi_q(Scalar::constant(t), y, &mut values);
    let size = mechanism.size().to_f64();
    let n_columns = 7 * mechanism.description().bodies.len();
    let n_rows = mechanism.buffers().constraints.as_ref().len();
    let n_joint_rows = n_rows - mechanism.description().bodies.len();
    let mut matrix = vec![vec![0.0; n_columns]; n_rows];
    for ((row, column), value) in mechanism.phi_q_pattern().iter().zip(values.as_ref()) {
        let (row, column) = (usize::from(*row), usize::from(*column));
        let is_length = row < n_joint_rows && mechanism.description().rows[row].is_length;
        let row_scale = if is_length { 1.0 / size } else { 1.0 };
        let column_scale = if column % 7 < 3 { size } else { 1.0 };
        matrix[row][column] = value.to_f64() * row_scale * column_scale;
    }
    eliminate(matrix)
}

fn eliminate(mut matrix: Vec<Vec<f64>>) -> f64 {
    let mut smallest = f64::INFINITY;
    while let Some((row, column, pivot)) = largest(&matrix) {
        smallest = smallest.min(pivot.abs());
        if pivot == 0.0 {
            break;
        }
        let pivot_row = matrix.swap_remove(row);
        for row in &mut matrix {
            let factor = row[column] / pivot;
            row.iter_mut().zip(&pivot_row).for_each(|(element, above)| *element -= factor * above);
            row[column] = 0.0;
        }
    }
    smallest
}

fn largest(matrix: &[Vec<f64>]) -> Option<(usize, usize, f64)> {
    let elements =
        matrix.iter().enumerate().flat_map(|(r, row)| row.iter().enumerate().map(move |(c, x)| (r, c, *x)));
    elements.max_by(|a, b| a.2.abs().total_cmp(&b.2.abs()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dependent_rows_leave_no_pivot() {
        assert!(eliminate(vec![vec![1.0, 2.0, 3.0], vec![2.0, 4.0, 6.0]]) < 1e-15);
        assert_eq!(eliminate(vec![vec![0.0, 2.0, 0.0], vec![0.5, 0.0, 0.0]]), 0.5);
    }
}
