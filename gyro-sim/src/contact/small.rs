//! A few equations; and states by their indices, without a panic.

use crate::Real;

/// A pivot of less than this part of its diagonal depends on the others.
const DEPENDENT: f64 = 1e-10;

/// What is added to the diagonal, as a part of it, and how often at most it is taken back.
const EVENLY: f64 = 1e-4;
const ITERATIONS: usize = 12;

/// A number to which something is decided, but not less than what rounding leaves of it in this precision.
pub(super) fn not_below_rounding<T: Real>(limit: f64) -> T {
    let (limit, rounding) = (T::constant(limit), T::constant(ROUNDINGS) * T::EPSILON);
    if limit > rounding { limit } else { rounding }
}

/// So many roundings are in what is decided.
const ROUNDINGS: f64 = 64.0;

/// The larger of two numbers.
pub(super) fn larger<T: Real>(a: T, b: T) -> T {
    if b > a { b } else { a }
}

/// An element of a state; zero if there is none of this index.
pub(super) fn at<T: Real>(y: &[T], index: usize) -> T {
    y.get(index).copied().unwrap_or(T::constant(0.0))
}

/// Sets an element of a state, if there is one of this index.
pub(super) fn set<T>(y: &mut [T], index: usize, value: T) {
    if let Some(place) = y.get_mut(index) {
        *place = value;
    }
}

/// The same where W is of surfaces that touch at more points than carry: that solution is approached of which no part
/// is large. A little is added to the diagonal, and taken back by iteration.
pub(super) fn spread<T: Real, const N: usize>(
    matrix: &[[T; N]; N],
    right: &[T; N],
    chosen: &[bool; N],
) -> [T; N] {
    let zero = T::constant(0.0);
    let mut more = *matrix;
    for (k, row) in more.iter_mut().enumerate() {
        row[k] = row[k] + T::constant(EVENLY) * row[k].abs();
    }
    let (mut found, mut rest, mut last) = ([zero; N], *right, T::constant(f64::INFINITY));
    for _ in 0..ITERATIONS {
        let change = solve(&more, &rest, chosen);
        let next: [T; N] = core::array::from_fn(|k| found[k] + change[k]);
        let left: [T; N] = core::array::from_fn(|i| {
            (0..N).filter(|k| chosen[*k]).fold(right[i], |sum, k| sum - matrix[i][k] * next[k])
        });
        let size = (0..N).filter(|k| chosen[*k]).fold(zero, |most, k| larger(most, left[k].abs()));
        if size >= last {
            break;
        }
        (found, rest, last) = (next, left, size);
    }
    found
}

/// Solves `W x = b` for the unknowns that are chosen, W being symmetric and positive semidefinite; the others, and
/// those that depend on chosen ones, are zero. By elimination with the largest pivots on the diagonal.
pub(super) fn solve<T: Real, const N: usize>(
    matrix: &[[T; N]; N],
    right: &[T; N],
    chosen: &[bool; N],
) -> [T; N] {
    let (zero, dependent) = (T::constant(0.0), not_below_rounding(DEPENDENT));
    let (mut w, mut x) = (*matrix, *right);
    let mut order = [0; N];
    let mut n = 0;
    let mut is_left = *chosen;
    loop {
        let mut best: Option<(usize, T)> = None;
        for k in (0..N).filter(|k| is_left[*k]) {
            let share = w[k][k] / matrix[k][k];
            if share > dependent && best.is_none_or(|(_, largest)| share > largest) {
                best = Some((k, share));
            }
        }
        // Indices that have been kept are compared with N, so that the compiler knows them to be within bounds.
        let Some((pivot, _)) = best.filter(|(pivot, _)| *pivot < N) else { break };
        is_left[pivot] = false;
        set(&mut order, n, pivot);
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
    for k in (0..N).rev().filter(|k| *k < n) {
        let row = order[k];
        if row < N {
            let later = order.iter().take(n).skip(k + 1).filter(|i| **i < N);
            let known = later.fold(x[row], |sum, &i| sum - w[row][i] * solution[i]);
            solution[row] = known / w[row][row];
        }
    }
    solution
}
