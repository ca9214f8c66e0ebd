//! A few equations.

use crate::Real;

/// A pivot of less than this part of its diagonal depends on the others.
const DEPENDENT: f64 = 1e-10;

/// Solves `W x = b` for the unknowns that are chosen, W being symmetric and positive semidefinite; the others, and
/// those that depend on chosen ones, are zero. By elimination with the largest pivots on the diagonal.
pub(super) fn solve<T: Real, const N: usize>(
    matrix: &[[T; N]; N],
    right: &[T; N],
    chosen: &[bool; N],
) -> [T; N] {
    let zero = T::constant(0.0);
    let (mut w, mut x) = (*matrix, *right);
    let mut order = [0; N];
    let mut n = 0;
    let mut is_left = *chosen;
    loop {
        let mut best: Option<(usize, T)> = None;
        for k in (0..N).filter(|k| is_left[*k]) {
            let share = w[k][k] / matrix[k][k];
            if share > T::constant(DEPENDENT) && best.is_none_or(|(_, largest)| share > largest) {
                best = Some((k, share));
            }
        }
        let Some((pivot, _)) = best else { break };
        is_left[pivot] = false;
        order[n] = pivot;
        n += 1;
        for row in (0..N).filter(|row| is_left[*row]) {
            let factor = w[row][pivot] / w[pivot][pivot];
            for column in (0..N).filter(|column| is_left[*column]) {
                w[row][column] = w[row][column] - factor * w[pivot][column];
            }
            x[row] = x[row] - factor * x[pivot];
        }
    }
    let mut solution = [zero; N];
    for (k, &row) in order[..n].iter().enumerate().rev() {
        let known = order[k + 1..n].iter().fold(x[row], |sum, &i| sum - w[row][i] * solution[i]);
        solution[row] = known / w[row][row];
    }
    solution
}
