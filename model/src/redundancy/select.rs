//! Which rows are independent: Gram–Schmidt in a fixed order, at several poses at once, among motions of the trees.

use nalgebra::{DMatrix, DVector};

use super::trees::{Motions, TreeRows};
use crate::{Row, RowOwner};
use std::slice;

/// Part of a row that is not in the span of the others, below which it depends on them. Poses satisfy their equations
/// to about 1e-13; a row that is independent only by a slip of a model file's last digits is not taken for a dependent
/// one.
pub(super) const INDEPENDENT: f64 = 1e-7;

/// Of the rows of one owner the first whose independent part is at least this part of the largest is taken next: so
/// that rounding does not decide between rows that are equally good.
const AS_GOOD: f64 = 0.5;

/// Coefficients below this mean that a row takes no part in a dependency.
pub(super) const TAKES_PART: f64 = 1e-6;

/// Rows that are kept and rows that depend on them, each in ascending order.
#[derive(Debug)]
pub(super) struct Selection {
    pub(super) kept: Vec<usize>,
    pub(super) dropped: Vec<usize>,
}

/// The poses of largest rank.
pub(super) fn generic(poses: &[Motions], groups: &[Vec<usize>]) -> Vec<usize> {
    let ranks: Vec<usize> = poses.iter().map(|pose| kept(slice::from_ref(pose), groups).len()).collect();
    let largest = ranks.iter().copied().max();
    (0..ranks.len()).filter(|&pose| Some(ranks[pose]) == largest).collect()
}

/// Selects rows at poses of one rank, all of the trees among them. Groups of the other rows, one for each owner, come
/// in the order of preference.
pub(super) fn select(poses: &[Motions], trees: &TreeRows, groups: &[Vec<usize>]) -> Selection {
    let mut kept = kept(poses, groups);
    let mut dropped: Vec<usize> =
        groups.iter().flatten().copied().filter(|row| !kept.contains(row)).collect();
    kept.extend(trees.rows());
    kept.sort_unstable();
    dropped.sort_unstable();
    Selection { kept, dropped }
}

/// The independent rows of the groups, as they are found.
fn kept(poses: &[Motions], groups: &[Vec<usize>]) -> Vec<usize> {
    let mut kept = Vec::new();
    let mut bases: Vec<Vec<DVector<f64>>> = vec![Vec::new(); poses.len()];
    for group in groups {
        let mut left = group.clone();
        let part = |row: usize, bases: &[Vec<DVector<f64>>]| -> Vec<DVector<f64>> {
            poses.iter().zip(bases).map(|(pose, basis)| outside(pose.row(row), basis)).collect()
        };
        loop {
            let parts: Vec<_> = left.iter().map(|&row| part(row, &bases)).collect();
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

/// Multipliers that do nothing, at each pose for each dropped row: that of the row is one, those of the kept rows that
/// it is a combination of are the opposite of their coefficients, with rows of length one. They span all such
/// multipliers.
pub(super) fn idle(
    selection: &Selection,
    (poses, trees): (&[Motions], &TreeRows),
    n_rows: usize,
) -> Vec<DMatrix<f64>> {
    let of_trees: Vec<usize> = trees.rows().collect();
    let others: Vec<usize> = selection.kept.iter().copied().filter(|row| !of_trees.contains(row)).collect();
    let at = |pose: &Motions| {
        let mut idle = DMatrix::zeros(selection.dropped.len(), n_rows);
        let by_others = combinations(pose, &others, &selection.dropped);
        let left =
            pose.jacobian.select_rows(&selection.dropped) - &by_others * pose.jacobian.select_rows(&others);
        let by_trees = trees.combinations(pose, left);
        for (coefficients, kept) in [(by_others, &others), (by_trees, &of_trees)] {
            for (column, &row) in coefficients.column_iter().zip(kept) {
                idle.set_column(row, &-column);
            }
        }
        selection.dropped.iter().enumerate().for_each(|(index, &row)| idle[(index, row)] = 1.0);
        idle
    };
    poses.iter().map(at).collect()
}

/// The owners of the kept rows that a dropped row is a combination of.
pub(super) fn owners(idle: &[DMatrix<f64>], (dropped, own): (usize, usize), rows: &[Row]) -> Vec<RowOwner> {
    let mut shared: Vec<RowOwner> = Vec::new();
    for (index, row) in rows.iter().enumerate().filter(|(index, _)| *index != own) {
        let takes_part = idle.iter().any(|idle| idle[(dropped, index)].abs() > TAKES_PART);
        if takes_part && !shared.contains(&row.owner) {
            shared.push(row.owner);
        }
    }
    shared
}

/// Changes of coefficients from pose to pose below this are rounding.
const STAYS: f64 = 1e-5;

/// For each dropped row whether it is another combination of the kept rows at one pose than at another.
///
/// One that is the same everywhere takes nothing from the rank wherever the others keep theirs; of one that changes
/// other rows may have to take the place.
pub(super) fn dependencies_move(selection: &Selection, (poses, trees): (&[Motions], &TreeRows)) -> Vec<bool> {
    let of_trees: Vec<usize> = trees.rows().collect();
    let others: Vec<usize> = selection.kept.iter().copied().filter(|row| !of_trees.contains(row)).collect();
    let at = poses.iter().map(|pose| {
        let unit = combinations(pose, &others, &selection.dropped);
        let long = |row, column| unit[(row, column)] * pose.ratio(selection.dropped[row], others[column]);
        DMatrix::from_fn(unit.nrows(), unit.ncols(), long)
    });
    let at: Vec<_> = at.collect();
    let moves = |row: usize| at.iter().any(|pose| (pose.row(row) - at[0].row(row)).amax() > STAYS);
    (0..selection.dropped.len()).map(|row| !others.is_empty() && moves(row)).collect()
}

/// The coefficients by which kept rows come nearest to each of the others among the motions of the trees.
fn combinations(pose: &Motions, kept: &[usize], rows: &[usize]) -> DMatrix<f64> {
    let [kept_rows, rows] =
        [kept, rows].map(|rows| rows.iter().map(|&row| pose.row(row)).collect::<Vec<_>>());
    if kept.is_empty() || rows.is_empty() {
        return DMatrix::zeros(rows.len(), kept.len());
    }
    let qr = DMatrix::from_columns(&kept_rows).qr();
    let right = qr.q().tr_mul(&DMatrix::from_columns(&rows));
    let solved = qr.r().solve_upper_triangular(&right);
    solved.map_or_else(|| DMatrix::zeros(rows.len(), kept.len()), |found| found.transpose())
}
