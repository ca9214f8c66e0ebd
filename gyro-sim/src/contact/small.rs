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

/// `b + W f` for forces of which most are zero.
pub(super) fn plus_product<T: Real, const N: usize>(b: &[T; N], matrix: &[[T; N]; N], f: &[T; N]) -> [T; N] {
    let (mut places, mut n) = ([0; N], 0);
    for k in (0..N).filter(|k| f[*k] != T::constant(0.0)) {
        set(&mut places, n, k);
        n += 1;
    }
    core::array::from_fn(|i| places.iter().take(n).fold(b[i], |sum, &k| sum + at(&matrix[i], k) * at(f, k)))
}

/// The same where W is of surfaces that touch at more points than carry: that solution is approached of which no part
/// is large. A little is added to the diagonal, and taken back by iteration.
pub(super) fn spread<T: Real, const N: usize>(
    matrix: &[[T; N]; N],
    right: &[T; N],
    chosen: &[bool; N],
) -> [T; N] {
    let zero = T::constant(0.0);
    let factors = Factors::new(matrix, chosen, T::constant(EVENLY));
    let (mut found, mut rest, mut last) = ([zero; N], *right, T::constant(f64::INFINITY));
    for _ in 0..ITERATIONS {
        let change = factors.solve(&rest);
        let next: [T; N] = core::array::from_fn(|k| found[k] + change[k]);
        let product = plus_product(&[zero; N], matrix, &next);
        let left: [T; N] = core::array::from_fn(|i| if chosen[i] { right[i] - product[i] } else { zero });
        let size = left.iter().fold(zero, |most, left| larger(most, left.abs()));
        if size >= last {
            break;
        }
        (found, rest, last) = (next, left, size);
    }
    found
}

/// Solves `W x = b` for the unknowns that are chosen, W being symmetric and positive semidefinite; the others, and
/// those that depend on chosen ones, are zero.
pub(super) fn solve<T: Real, const N: usize>(
    matrix: &[[T; N]; N],
    right: &[T; N],
    chosen: &[bool; N],
) -> [T; N] {
    Factors::new(matrix, chosen, T::constant(0.0)).solve(right)
}

/// What elimination with the largest pivots on the diagonal makes of a matrix: factors below these, in the order of the
/// pivots, and what is left above.
struct Factors<T, const N: usize> {
    w: [[T; N]; N],
    order: [usize; N],
    n: usize,
}

impl<T: Real, const N: usize> Factors<T, N> {
    /// Of the rows and columns that are chosen, the diagonal made larger by this part of it.
    fn new(matrix: &[[T; N]; N], chosen: &[bool; N], more: T) -> Self {
        let (zero, dependent) = (T::constant(0.0), not_below_rounding::<T>(DEPENDENT));
        let (mut w, mut own) = ([[zero; N]; N], [zero; N]);
        let (mut left, mut n_left) = ([0; N], 0);
        for k in (0..N).filter(|k| chosen[*k]) {
            for j in (0..N).filter(|j| chosen[*j]) {
                w[k][j] = matrix[k][j];
            }
            w[k][k] = w[k][k] + more * w[k][k].abs();
            own[k] = w[k][k];
            set(&mut left, n_left, k);
            n_left += 1;
        }
        let entry = |w: &[[T; N]; N], row: usize, column| w.get(row).map_or(zero, |row| at(row, column));
        let (mut order, mut n) = ([0; N], 0);
        while n < n_left {
            let mut best: Option<(usize, usize, T)> = None;
            for (place, &k) in left.iter().enumerate().take(n_left).skip(n) {
                let share = entry(&w, k, k) / at(&own, k);
                if share > dependent && best.is_none_or(|(_, _, largest)| share > largest) {
                    best = Some((place, k, share));
                }
            }
            let Some((place, pivot, _)) = best else { break };
            let Some(pivot_row) = w.get(pivot).copied() else { break };
            // Of equal pivots the first is taken.
            let mut moved = pivot;
            for slot in left.iter_mut().take(place + 1).skip(n) {
                moved = core::mem::replace(slot, moved);
            }
            set(&mut order, n, pivot);
            n += 1;
            for &row in left.iter().take(n_left).skip(n) {
                let Some(row) = w.get_mut(row) else { continue };
                let factor = at(row, pivot) / at(&pivot_row, pivot);
                for &column in left.iter().take(n_left).skip(n) {
                    let rest = at(row, column) - factor * at(&pivot_row, column);
                    set(row, column, rest);
                }
                set(row, pivot, factor);
            }
        }
        Self { w, order, n }
    }

    fn solve(&self, right: &[T; N]) -> [T; N] {
        let (mut x, mut solution) = (*right, [T::constant(0.0); N]);
        let rows = || self.order.iter().take(self.n).enumerate();
        for (place, &k) in rows() {
            let Some(row) = self.w.get(k) else { continue };
            let earlier = self.order.iter().take(place);
            let rest = earlier.fold(at(&x, k), |rest, &j| rest - at(row, j) * at(&x, j));
            set(&mut x, k, rest);
        }
        for (place, &k) in rows().rev() {
            let Some(row) = self.w.get(k) else { continue };
            let later = self.order.iter().take(self.n).skip(place + 1);
            let rest = later.fold(at(&x, k), |rest, &j| rest - at(row, j) * at(&solution, j));
            set(&mut solution, k, rest / at(row, k));
        }
        solution
    }
}
