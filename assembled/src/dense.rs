//! The paper's plain form: eq. (17) built whole and solved by dense LU.

use crate::assembled::Solver;
use crate::lowered::Lowered;
use crate::number::Number;
use crate::partition;
use gyro_model::Model;
use nalgebra::{DMatrix, DVector};

/// Builds the dense matrix of eq. (17) and solves it by LU with partial pivoting, on the heap, at every evaluation.
///
/// The partition is the paper's too: the dense Jacobian of all constraints, eqs. (11) and (12), whose columns full
/// pivoting divides into dependent and independent ones. The coordinates are chosen anew when the volume of Φ_u has
/// fallen below half of that of the best choice: see [`Solver::follow`] for what it counts.
#[derive(Clone, Copy, Debug)]
pub struct Saddle;

impl<T: Number> Solver<T> for Saddle {
    /// Columns of Φ_q, ascending.
    type Independent = Vec<usize>;

    fn new(_: &Model, _: &Lowered<T>) -> Self {
        Self
    }

    fn accelerations(&self, lowered: &Lowered<T>, y: &[T], out: &mut [T]) {
        out.copy_from_slice(&solve(lowered, y).as_slice()[..lowered.n_v()]);
    }

    fn accelerations_and_multipliers(&self, lowered: &Lowered<T>, y: &[T], out: &mut [T], lambda: &mut [T]) {
        let solution = solve(lowered, y);
        let (accelerations, multipliers) = solution.as_slice().split_at(lowered.n_v());
        out.copy_from_slice(accelerations);
        lambda.copy_from_slice(multipliers);
    }

    fn independent(&self, lowered: &Lowered<T>, y: &[T]) -> Vec<usize> {
        partition::best(lowered, y).independent
    }

    fn follow(&self, lowered: &Lowered<T>, y: &[T], choice: &mut Vec<usize>) -> u32 {
        partition::follow(lowered, y, choice)
    }

    fn newton_step(&self, lowered: &Lowered<T>, choice: &Vec<usize>, y: &mut [T]) -> Result<(), T> {
        partition::newton_step(lowered, choice, y)
    }

    fn solve_velocities(&self, lowered: &Lowered<T>, choice: &Vec<usize>, y: &mut [T]) -> Result<(), T> {
        partition::solve_velocities(lowered, choice, y)
    }
}

/// Accelerations and multipliers; not finite where the matrix is singular.
fn solve<T: Number>(lowered: &Lowered<T>, y: &[T]) -> DVector<T> {
    let (n_v, n_rows) = (lowered.n_v(), lowered.n_rows());
    let mut right = DVector::zeros(n_v + n_rows);
    let (force, gamma) = right.as_mut_slice().split_at_mut(n_v);
    lowered.applied_force(y, force);
    lowered.gamma(y, gamma);
    matrix(lowered, y)
        .lu()
        .solve(&right)
        .unwrap_or_else(|| DVector::from_element(n_v + n_rows, T::zero() / T::zero()))
}

/// `[M 0 Φ_rᵀ; 0 J' Φ_π'ᵀ; Φ_r Φ_π' 0]`, velocities ordered `(s, w')` body after body.
fn matrix<T: Number>(lowered: &Lowered<T>, y: &[T]) -> DMatrix<T> {
    let n_v = lowered.n_v();
    let mut matrix = DMatrix::zeros(n_v + lowered.n_rows(), n_v + lowered.n_rows());
    for (slot, body) in lowered.bodies.iter().enumerate() {
        let at = 6 * slot;
        (at..at + 3).for_each(|k| matrix[(k, k)] = body.mass);
        matrix.fixed_view_mut::<3, 3>(at + 3, at + 3).copy_from(&body.inertia);
    }
    lowered.phi_pi(y, |row, column, value| {
        matrix[(n_v + row, column)] = value;
        matrix[(column, n_v + row)] = value;
    });
    matrix
}
