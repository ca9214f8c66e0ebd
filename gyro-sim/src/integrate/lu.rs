//! Gaussian elimination with row pivoting on a square matrix that is stored row by row.

use crate::Real;

/// Replaces a matrix by its factors and writes into `pivots` which row came to stand in each place; returns the
/// smallest pivot's size.
///
/// Pivots are row numbers in the matrix's own number type, because no other buffer of the right length is available in
/// a crate that allocates nothing.
#[inline(always)]
pub(super) fn factorise<T: Real>(matrix: &mut [T], pivots: &mut [T]) -> T {
    let n = pivots.len();
    let mut smallest = T::constant(f64::INFINITY);
    for column in 0..n {
        let mut best = column;
        for row in column + 1..n {
            if matrix[row * n + column].abs() > matrix[best * n + column].abs() {
                best = row;
            }
        }
        pivots[column] = number(best);
        if best != column {
            let (above, below) = matrix.split_at_mut(best * n);
            above[column * n..column * n + n].swap_with_slice(&mut below[..n]);
        }
        let (above, below) = matrix.split_at_mut((column + 1) * n);
        let pivot_row = &above[column * n..];
        let pivot = pivot_row[column];
        // What is not a number counts as smallest.
        smallest = if pivot.abs() >= smallest { smallest } else { pivot.abs() };
        let inverse = T::constant(1.0) / pivot;
        for row in below.chunks_exact_mut(n) {
            let factor = row[column] * inverse;
            row[column] = factor;
            if factor == T::constant(0.0) {
                continue;
            }
            for (element, above) in row[column + 1..].iter_mut().zip(&pivot_row[column + 1..]) {
                *element = T::fused(-factor, *above, *element);
            }
        }
        above[column * n + column] = inverse;
    }
    smallest
}

/// Solves for one right-hand side, in place.
#[inline(always)]
pub(super) fn solve<T: Real>(factors: &[T], pivots: &[T], x: &mut [T]) {
    let n = pivots.len();
    for (row, pivot) in pivots.iter().enumerate() {
        x.swap(row, index(*pivot, n));
    }
    for row in 1..n {
        let (known, rest) = x.split_at_mut(row);
        for (factor, known) in factors[row * n..row * n + row].iter().zip(known.iter()) {
            rest[0] = T::fused(-*factor, *known, rest[0]);
        }
    }
    for row in (0..n).rev() {
        let (rest, known) = x.split_at_mut(row + 1);
        let (row, inverse) = (&factors[row * n + row + 1..row * n + n], factors[row * n + row]);
        let Some(last) = rest.last_mut() else { continue };
        for (factor, known) in row.iter().zip(known.iter()) {
            *last = T::fused(-*factor, *known, *last);
        }
        *last = *last * inverse;
    }
}

#[expect(clippy::cast_precision_loss, reason = "row numbers are small")]
fn number<T: Real>(row: usize) -> T {
    T::constant(row as f64)
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "what was a row number is one")]
fn index<T: Real>(pivot: T, n: usize) -> usize {
    (pivot.to_f64() as usize).min(n - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_system_that_needs_its_rows_exchanged_is_solved() {
        let a = [0.0, 2.0, 1.0, 1.0, 1.0, 1.0, 3.0, -1.0, 0.5];
        let (mut factors, mut pivots) = (a, [0.0; 3]);
        assert!(factorise(&mut factors, &mut pivots) > 0.1);
        let mut x = [7.0, 6.0, 2.5];
        solve(&factors, &pivots, &mut x);
        for (row, right) in a.chunks(3).zip([7.0, 6.0, 2.5]) {
            let left: f64 = row.iter().zip(x).map(|(a, x)| a * x).sum();
            assert!((left - right).abs() < 1e-14, "{left} for {right}");
        }
    }

    #[test]
    fn a_singular_matrix_has_a_pivot_of_zero() {
        assert_eq!(factorise(&mut [1.0, 2.0, 2.0, 4.0], &mut [0.0; 2]), 0.0);
    }
}
