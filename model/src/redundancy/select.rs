//! Which rows are independent: Gram–Schmidt in a fixed order, at several poses at once.

use nalgebra::{DMatrix, DVector, RowDVector};

use crate::{Row, RowOwner};

/// Part of a row that is not in the span of the others, below which it depends on them. Poses satisfy their equations
/// to about 1e-13; a row that is independent only by a slip of a model file's last digits is not taken for a dependent
/// one.
pub(super) const INDEPENDENT: f64 = 1e-7;

/// Of the rows of one owner the first whose independent part is at least this part of the largest is taken next: so
/// that rounding does not decide between rows that are equally good.
const AS_GOOD: f64 = 0.5;

/// Coefficients below this mean that a row takes no part in a dependency.
const TAKES_PART: f64 = 1e-6;

/// Rows that are kept and rows that depend on them, each in ascending order.
#[derive(Debug)]
pub(super) struct Selection {
    pub(super) kept: Vec<usize>,
    pub(super) dropped: Vec<usize>,
    /// The Jacobians, rows of length one.
    jacobians: Vec<DMatrix<f64>>,
}

/// The poses of largest rank, by their Jacobians.
pub(super) fn generic(jacobians: &[DMatrix<f64>], groups: &[Vec<usize>]) -> Vec<usize> {
    let rank = |jacobian: &DMatrix<f64>| kept(&[with_unit_rows(jacobian)], groups).len();
    let ranks: Vec<usize> = jacobians.iter().map(rank).collect();
    let largest = ranks.iter().copied().max();
    (0..ranks.len()).filter(|&pose| Some(ranks[pose]) == largest).collect()
}

/// Selects rows at poses of one rank. Groups of rows, one for each owner, come in the order of preference.
pub(super) fn select(jacobians: &[DMatrix<f64>], groups: &[Vec<usize>]) -> Selection {
    let jacobians: Vec<DMatrix<f64>> = jacobians.iter().map(with_unit_rows).collect();
    let mut kept = kept(&jacobians, groups);
    kept.sort_unstable();
    let mut dropped: Vec<usize> =
        groups.iter().flatten().copied().filter(|row| !kept.contains(row)).collect();
    dropped.sort_unstable();
    Selection { kept, dropped, jacobians }
}

/// Rows on zero length stay as they are: nothing that has coordinates is in them.
pub(super) fn with_unit_rows(jacobian: &DMatrix<f64>) -> DMatrix<f64> {
    let mut unit = jacobian.clone();
    for mut row in unit.row_iter_mut() {
        let norm = row.norm();
        if norm > 0.0 {
            row /= norm;
        }
    }
    unit
}

/// The independent rows, as they are found.
fn kept(jacobians: &[DMatrix<f64>], groups: &[Vec<usize>]) -> Vec<usize> {
    let mut kept = Vec::new();
    let mut bases: Vec<Vec<DVector<f64>>> = vec![Vec::new(); jacobians.len()];
    for group in groups {
        let mut left = group.clone();
        loop {
            let parts: Vec<Vec<DVector<f64>>> = left
                .iter()
                .map(|&row| {
                    let each = jacobians.iter().zip(&bases);
                    each.map(|(jacobian, basis)| outside(jacobian.row(row).transpose(), basis)).collect()
                })
                .collect();
            let measure = |k: usize| parts[k].iter().map(DVector::norm_squared).sum::<f64>().sqrt();
            let largest = (0..left.len()).map(measure).fold(0.0, f64::max);
            if largest <= INDEPENDENT {
                break;
            }
            let taken = (0..left.len()).find(|&k| measure(k) >= AS_GOOD * largest).expect("the largest is");
            for (basis, part) in bases.iter_mut().zip(&parts[taken]) {
                extend(basis, part.clone());
            }
            kept.push(left.remove(taken));
        }
    }
    kept
}

/// Adds to an orthonormal basis what a row of length one is outside of it, if it is.
pub(super) fn extend(basis: &mut Vec<DVector<f64>>, row: DVector<f64>) {
    let part = outside(row, basis);
    if part.norm() > INDEPENDENT {
        basis.push(part.normalize());
    }
}

/// The part of a vector that is orthogonal to an orthonormal basis; done twice, as one pass loses digits.
pub(super) fn outside(mut vector: DVector<f64>, basis: &[DVector<f64>]) -> DVector<f64> {
    for _ in 0..2 {
        for unit in basis {
            let along = unit.dot(&vector);
            vector.axpy(-along, unit, 1.0);
        }
    }
    vector
}

/// For each dropped row the owners of the kept rows that it is a combination of.
pub(super) fn dependencies(selection: &Selection, rows: &[Row]) -> Vec<Vec<RowOwner>> {
    let of = |&dropped: &usize| {
        let mut owners: Vec<RowOwner> = Vec::new();
        for jacobian in &selection.jacobians {
            let coefficients = combination(jacobian, &selection.kept, &jacobian.row(dropped).into_owned());
            let part = selection.kept.iter().zip(coefficients.iter()).filter(|(_, c)| c.abs() > TAKES_PART);
            owners.extend(part.map(|(&row, _)| rows[row].owner));
        }
        rows.iter().map(|row| row.owner).fold(Vec::new(), |mut shared, owner| {
            if owners.contains(&owner) && !shared.contains(&owner) {
                shared.push(owner);
            }
            shared
        })
    };
    selection.dropped.iter().map(of).collect()
}

/// The coefficients c of `Σ c_k row_k` that come nearest to a row.
fn combination(jacobian: &DMatrix<f64>, kept: &[usize], row: &RowDVector<f64>) -> DVector<f64> {
    if kept.is_empty() {
        return DVector::zeros(0);
    }
    let qr = jacobian.select_rows(kept).transpose().qr();
    let right = qr.q().tr_mul(&row.transpose());
    qr.r().solve_upper_triangular(&right).unwrap_or_else(|| DVector::zeros(kept.len()))
}
