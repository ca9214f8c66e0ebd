//! On which side of the poses where branches meet a mechanism closes.
//!
//! Where as many equations as unknowns place a mechanism, the determinant of their Jacobian changes its sign where two
//! of its branches meet: it is one sign for each of the two ways to close a triangle. With more unknowns than equations
//! the Jacobian's rows span a subspace, whose orientation is carried along a path by `det(J_k J_{k+1}ᵀ)`. Of equations
//! that depend on each other where they are satisfied, those combinations count that do not.

use nalgebra::{DMatrix, DVector};

use super::projection::{Configuration, System};

/// Singular values below this part of the largest one are zero: the equations depend on each other.
const INDEPENDENT: f64 = 1e-7;

/// Rotation of a body between two poses of the path, rad: rows of small steps are at acute angles.
const STEP: f64 = 0.2;

/// A guess that is nearer than this to the closed pose, rad or parts of the size, is that pose.
const NEAR: f64 = 1e-3;

/// Below this cosine between row spaces the poses are so nearly where branches meet that the guess chooses none.
const UNDECIDED: f64 = 1e-6;

/// Steps in which the gap of the guess is closed along its branch.
const PARTS: usize = 40;

/// Whether two configurations are on one side, the second one satisfying the equations.
pub(super) fn is_same(system: &System<'_>, guess: &Configuration, closed: &Configuration) -> bool {
    let far = system.scaled_difference(closed, guess).amax();
    if far < NEAR {
        return true;
    }
    let combinations = combinations(system.jacobian(closed));
    let space = |at: &Configuration| row_space(&combinations.tr_mul(&system.jacobian(at)));
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

/// Orthonormal combinations of the equations that are independent where they are satisfied, in columns.
fn combinations(jacobian: DMatrix<f64>) -> DMatrix<f64> {
    let svd = jacobian.svd(true, false);
    let least = INDEPENDENT * svd.singular_values.amax();
    let is_independent = |k: &usize| svd.singular_values[*k] > least;
    let independent: Vec<usize> = (0..svd.singular_values.len()).filter(is_independent).collect();
    svd.u.expect("asked for").select_columns(&independent)
}
