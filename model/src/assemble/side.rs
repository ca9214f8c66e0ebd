//! On which side of the poses where branches meet a mechanism closes.
//!
//! Where as many equations as unknowns place a mechanism, the determinant of their Jacobian changes its sign where two
//! of its branches meet: it is one sign for each of the two ways to close a triangle. With more unknowns than equations
//! the Jacobian's rows span a subspace, whose orientation is carried along a path by `det(J_k J_{k+1}ᵀ)`.

use nalgebra::{DMatrix, DVector};

use super::projection::{Configuration, System};

/// Part of a row that is not in the span of the others, below which it depends on them.
const INDEPENDENT: f64 = 1e-7;

/// Rotation of a body between two poses of the path, rad: rows of small steps are at acute angles.
const STEP: f64 = 0.2;

/// Below this cosine between row spaces the poses are so nearly where branches meet that the guess chooses none.
const UNDECIDED: f64 = 1e-6;

/// Steps in which the gap of the guess is closed along its branch.
const PARTS: usize = 40;

/// Whether two configurations are on one side, the second one satisfying the equations.
pub(super) fn is_same(system: &System<'_>, guess: &Configuration, closed: &Configuration) -> bool {
    let rows = independent_rows(&system.jacobian(closed));
    let space = |at: &Configuration| row_space(&system.jacobian(at).select_rows(&rows));
    let far = system.scaled_difference(closed, guess).amax();
    let count = (far / STEP).ceil().clamp(1.0, 100.0);
    let mut sign = 1.0;
    let Some(mut before) = space(guess) else { return true };
    let mut done = 0.0;
    while done < count {
        done += 1.0;
        let Some(here) = space(&system.between(guess, closed, done / count)) else { return true };
        let cosine = before.0.tr_mul(&here.0).determinant() * before.1 * here.1;
        if cosine.abs() < UNDECIDED {
            return true;
        }
        sign *= cosine.signum();
        before = here;
    }
    sign > 0.0
}

/// Closes the gap of the guess little by little, along the path on which the equations are missed by an ever smaller
/// part of what they miss at the guess: it stays on one side as long as it does not come to where branches meet.
pub(super) fn close_gradually(system: &System<'_>, guess: &Configuration) -> Configuration {
    let missed: DVector<f64> = system.residual(guess);
    let mut at = guess.clone();
    for part in (0..PARTS).rev() {
        at = system.project_onto(&at, &(&missed * (part as f64 / PARTS as f64)));
    }
    system.project(&at)
}

/// An orthonormal basis of the rows' span, in columns, with the sign of the rows' determinant in it.
fn row_space(rows: &DMatrix<f64>) -> Option<(DMatrix<f64>, f64)> {
    let qr = rows.transpose().qr();
    let diagonal = qr.r().diagonal();
    let is_regular = diagonal.iter().all(|x| x.is_finite() && *x != 0.0);
    is_regular.then(|| (qr.q(), diagonal.iter().map(|x| x.signum()).product()))
}

/// The first rows that are independent of the ones before them.
fn independent_rows(jacobian: &DMatrix<f64>) -> Vec<usize> {
    let mut basis: Vec<DVector<f64>> = Vec::new();
    let mut rows = Vec::new();
    for row in 0..jacobian.nrows() {
        let mut left = jacobian.row(row).transpose();
        let size = left.norm();
        for _ in 0..2 {
            basis.iter().for_each(|unit| left -= unit * unit.dot(&left));
        }
        if left.norm() > INDEPENDENT * size {
            basis.push(left.normalize());
            rows.push(row);
        }
    }
    rows
}
