//! The smallest motion, in the metric of the masses, that changes the rows as asked: eq. (17) whole and dense, without
//! forces.

use crate::dense::matrix;
use crate::model::lowered::Lowered;
use crate::model::place::Moment;
use crate::number::{Number, abs};
use nalgebra::DVector;

/// Writes the change of the velocities' coordinates. All forms alike: by Gaussian elimination with row pivoting, in
/// work space that the first call allocates.
pub(crate) fn project<T: Number>(
    lowered: &Lowered<T>,
    at: Moment<'_, T>,
    rows: &[T],
    work: &mut Vec<T>,
    out: &mut [T],
) {
    if lowered.n_dependent > 0 {
        let n_v = lowered.scene.n_v();
        let right =
            DVector::from_fn(n_v + rows.len(), |k, _| if k < n_v { T::zero() } else { rows[k - n_v] });
        let solved = matrix(lowered, at).lu().solve(&right);
        let change = |k: usize| solved.as_ref().map_or(T::zero() / T::zero(), |solved| solved[k]);
        out.iter_mut().enumerate().for_each(|(k, out)| *out = change(k));
        return;
    }
    let n = lowered.scene.n_v() + lowered.n_rows();
    build(lowered, at, rows, work);
    solve(work, n);
    // The solution has taken the place of the right-hand side.
    for (out, row) in out.iter_mut().zip(work.chunks_exact(n + 1)) {
        *out = row[n];
    }
}

/// `[M 0 Φ_rᵀ; 0 J' Φ_π'ᵀ; Φ_r Φ_π' 0]` by rows, each with its right-hand side at its end.
fn build<T: Number>(lowered: &Lowered<T>, at: Moment<'_, T>, rows: &[T], work: &mut Vec<T>) {
    let n_v = lowered.scene.n_v();
    let stride = n_v + lowered.n_rows() + 1;
    work.clear();
    work.resize((stride - 1) * stride, T::zero());
    for (moving_body, body) in lowered.scene.bodies.iter().enumerate() {
        for i in 0..3 {
            let (linear, angular) = (6 * moving_body + i, 6 * moving_body + 3 + i);
            work[linear * stride + linear] = body.mass;
            (0..3).for_each(|j| work[angular * stride + 6 * moving_body + 3 + j] = body.inertia[(i, j)]);
        }
    }
    lowered.masses_of_rotors(at, |row, column, value| work[row * stride + column] += value);
    lowered.phi_pi(at, |row, column, value| {
        work[(n_v + row) * stride + column] = value;
        work[column * stride + n_v + row] = value;
    });
    for (row, &change) in rows.iter().enumerate() {
        work[(n_v + row + 1) * stride - 1] = change;
    }
}

/// Solves n equations; not finite where the matrix is singular.
fn solve<T: Number>(work: &mut [T], n: usize) {
    let stride = n + 1;
    for k in 0..n {
        let size = |row: usize| abs(work[row * stride + k]);
        let pivot = (k + 1..n).fold(k, |best, row| if size(row) > size(best) { row } else { best });
        let (above, below) = work.split_at_mut((k + 1) * stride);
        let top = &mut above[k * stride..];
        if pivot > k {
            top.swap_with_slice(&mut below[(pivot - k - 1) * stride..(pivot - k) * stride]);
        }
        let inverse = T::one() / top[k];
        top[k..].iter_mut().for_each(|x| *x *= inverse);
        for row in below.chunks_exact_mut(stride) {
            let factor = row[k];
            if factor != T::zero() {
                row[k..].iter_mut().zip(&top[k..]).for_each(|(x, top)| *x -= factor * *top);
            }
        }
    }
    for k in (0..n).rev() {
        let x = work[k * stride + n];
        for row in 0..k {
            let factor = work[row * stride + k];
            work[row * stride + n] -= factor * x;
        }
    }
}
