//! The paper's plain form: eq. (17) built whole and solved by dense LU.

pub(crate) mod partition;

use crate::assembled::{Refusal, Solver};
use crate::error::Unsupported;
use crate::model::lowered::Lowered;
use crate::model::place::Moment;
use crate::number::{Number, number};
use gyro_model::{Model, Tree};
use nalgebra::{DMatrix, DVector};
use partition::row_scale;

/// Builds the dense matrix of eq. (17) and solves it by LU with partial pivoting, on the heap, at every evaluation.
///
/// The partition is the paper's too: the dense Jacobian of all constraints, eqs. (11) and (12), whose columns full
/// pivoting divides into dependent and independent ones. The coordinates are chosen anew when the volume of Φ_u has
/// fallen below half of that of the best choice: see [`Solver::follow`] for what it counts. At velocity level the
/// independent ones of ṙ and of `ṗ = ½ Gᵀ w'`, at the corrected p, keep their values.
///
/// It does every model.
#[derive(Clone, Copy, Debug)]
pub struct Saddle {
    /// Only loops have singular poses.
    has_loops: bool,
}

impl<T: Number> Solver<T> for Saddle {
    /// Columns of Φ_q, ascending.
    type Independent = Vec<usize>;

    fn new(model: &Model, _: &Lowered<T>) -> Result<Self, Unsupported> {
        Ok(Self { has_loops: !Tree::of(model).loop_joints.is_empty() })
    }

    /// The whole solution of eq. (17).
    fn accelerations_len(&self, lowered: &Lowered<T>) -> usize {
        lowered.scene.n_v() + lowered.n_rows()
    }

    fn accelerations(&self, lowered: &Lowered<T>, t: T, y: &[T], out: &mut [T]) {
        out.copy_from_slice(solve(lowered, Moment { t, y }).as_slice());
    }

    fn multipliers(&self, lowered: &Lowered<T>, _: T, _: &[T], accelerations: &[T], lambda: &mut [T]) {
        lambda.copy_from_slice(&accelerations[lowered.scene.n_v()..]);
    }

    fn independent(&self, lowered: &Lowered<T>, t: T, y: &[T]) -> Vec<usize> {
        partition::best(lowered, Moment { t, y }).independent
    }

    fn follow(&self, lowered: &Lowered<T>, t: T, y: &[T], choice: &mut Vec<usize>) -> u32 {
        partition::follow(lowered, Moment { t, y }, choice)
    }

    fn newton_step(
        &self,
        lowered: &Lowered<T>,
        t: T,
        choice: &Vec<usize>,
        y: &mut [T],
    ) -> Result<(), Refusal<T>> {
        partition::newton_step(lowered, t, choice, y)
    }

    fn solve_velocities(
        &self,
        lowered: &Lowered<T>,
        t: T,
        choice: &Vec<usize>,
        y: &mut [T],
    ) -> Result<(), T> {
        partition::solve_velocities(lowered, t, choice, y)
    }

    fn clearance(&self, lowered: &Lowered<T>, t: T, y: &[T]) -> Option<(T, usize)> {
        self.has_loops.then(|| partition::clearance(lowered, Moment { t, y }))
    }
}

/// Accelerations and multipliers; not finite where the matrix is singular.
fn solve<T: Number>(lowered: &Lowered<T>, at: Moment<'_, T>) -> DVector<T> {
    let (n_v, n_rows) = (lowered.scene.n_v(), lowered.n_rows());
    let mut right = DVector::zeros(n_v + n_rows);
    let (force, gamma) = right.as_mut_slice().split_at_mut(n_v);
    lowered.applied_force(at, force);
    lowered.gamma(at, gamma);
    matrix(lowered, at)
        .lu()
        .solve(&right)
        .unwrap_or_else(|| DVector::from_element(n_v + n_rows, T::zero() / T::zero()))
}

/// `[M 0 Φ_rᵀ; 0 J' Φ_π'ᵀ; Φ_r Φ_π' 0]`, velocities ordered `(s, w')` body after body.
pub(crate) fn matrix<T: Number>(lowered: &Lowered<T>, at: Moment<'_, T>) -> DMatrix<T> {
    let n_v = lowered.scene.n_v();
    let mut matrix = DMatrix::zeros(n_v + lowered.n_rows(), n_v + lowered.n_rows());
    for (moving_body, body) in lowered.scene.bodies.iter().enumerate() {
        let at = 6 * moving_body;
        (at..at + 3).for_each(|k| matrix[(k, k)] = body.mass);
        matrix.fixed_view_mut::<3, 3>(at + 3, at + 3).copy_from(&body.inertia);
    }
    lowered.masses_of_rotors(at, |row, column, value| matrix[(row, column)] += value);
    lowered.phi_pi(at, |row, column, value| {
        matrix[(n_v + row, column)] = value;
        matrix[(column, n_v + row)] = value;
    });
    if lowered.n_dependent > 0 {
        yield_dependent(lowered, &mut matrix);
    }
    matrix
}

/// Rows depend on others by combinations N, `Φᵀ N = 0`, of which there are always as many: found as the
/// eigenvectors of `Φ M⁻¹ Φᵀ` that have the least eigenvalues. With `−N Nᵀ` in the corner the matrix is regular;
/// `Nᵀ λ = 0` then, and the rows are met.
fn yield_dependent<T: Number>(lowered: &Lowered<T>, matrix: &mut DMatrix<T>) {
    let (n_v, n_rows) = (lowered.scene.n_v(), lowered.n_rows());
    let scaled = |row: usize, column: usize| matrix[(n_v + column, row)] * row_scale(lowered, column);
    let gradients = DMatrix::from_fn(n_v, n_rows, scaled);
    let Some(responses) = matrix.view((0, 0), (n_v, n_v)).into_owned().lu().solve(&gradients) else { return };
    let by_rows = gradients.tr_mul(&responses);
    if !by_rows.iter().all(|entry| entry.is_finite()) {
        return;
    }
    let size = by_rows.trace() / number(n_rows as f64);
    let eigen = by_rows.symmetric_eigen();
    let mut order: Vec<usize> = (0..n_rows).collect();
    let value = |k: &usize| gyro_sim::Real::to_f64(eigen.eigenvalues[*k]);
    order.sort_by(|a, b| value(a).total_cmp(&value(b)));
    for &k in order.iter().take(lowered.n_dependent) {
        let combination = eigen.eigenvectors.column(k);
        for row in 0..n_rows {
            for other in 0..n_rows {
                let scales = row_scale(lowered, row) * row_scale(lowered, other);
                matrix[(n_v + row, n_v + other)] -= size * combination[row] * combination[other] * scales;
            }
        }
    }
}
