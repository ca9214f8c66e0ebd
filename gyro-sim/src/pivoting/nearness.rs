//! How near the rows of the Jacobian are to depending on each other.

use super::elimination::Elimination;
use super::{Extent, Pivot};
use crate::Real;

impl<T: Real, E: Extent> Elimination<T, E> {
    /// One over the norm of the pseudoinverse, `1/√Σσ⁻²` with the singular values σ: no more than the smallest of them,
    /// and that itself near a singular pose. With it the joint's row that is nearest to the span of all others.
    ///
    /// Pivots of an elimination jump where another one is chosen; this is as smooth as the Jacobian. With `J = L Q` it
    /// takes the lengths of the columns of L⁻¹, which are one over the distances of the rows from the span of the
    /// others (Golub and Van Loan, *Matrix Computations*, sections 5.2 and 5.5.2).
    pub(super) fn nearness(mut self) -> Pivot<T> {
        let (rows, n_rows) = (self.triangulate(), self.extent.n_constraints());
        let diagonal = rows.as_ref();
        let (zero, one) = (T::constant(0.0), T::constant(1.0));
        if let Some(row) = diagonal.iter().position(|entry| *entry == zero) {
            return Pivot { value: zero, row: usize::from(self.rows.as_ref()[row]) };
        }
        let (mut sum, mut longest) = (zero, (zero, n_rows));
        for row in 0..n_rows {
            let square = self.column_of_inverse(row, diagonal);
            sum = sum + square;
            if row >= self.n_normalisations && square > longest.0 {
                longest = (square, row);
            }
        }
        let row = self.rows.as_ref().get(longest.1).copied().unwrap_or(0);
        Pivot { value: one / sum.sqrt(), row: row.into() }
    }

    /// Leaves L of `J = L Q` below the diagonal, which is returned, and Householder's vectors on and above it.
    fn triangulate(&mut self) -> E::Rows<T> {
        let zero = T::constant(0.0);
        let mut diagonal = self.extent.rows::<T>();
        for (k, entry) in diagonal.as_mut().iter_mut().enumerate() {
            let (above, below) = self.jacobian.as_mut().split_at_mut(k + 1);
            let vector = &mut above[k].as_mut()[k..];
            let square = vector.iter().fold(zero, |sum, x| T::fused(*x, *x, sum));
            if square == zero {
                continue;
            }
            let length = square.sqrt();
            *entry = if vector[0] > zero { -length } else { length };
            vector[0] = vector[0] - *entry;
            // Half the square of the vector: v² / 2 = |x| (|x| + |x₀|).
            let half = -*entry * vector[0];
            for row in below {
                let row = &mut row.as_mut()[k..];
                let share = row.iter().zip(&*vector).fold(zero, |sum, (x, v)| T::fused(*x, *v, sum)) / half;
                if share != zero {
                    row.iter_mut().zip(&*vector).for_each(|(x, v)| *x = *x - share * *v);
                }
            }
        }
        diagonal
    }

    /// The square of the length of a column of L⁻¹.
    fn column_of_inverse(&self, column: usize, diagonal: &[T]) -> T {
        let (zero, one) = (T::constant(0.0), T::constant(1.0));
        let mut rows = self.extent.rows::<T>();
        let solved = rows.as_mut();
        solved[column] = one / diagonal[column];
        for row in column + 1..self.extent.n_constraints() {
            let known = self.jacobian.as_ref()[row].as_ref()[column..row].iter().zip(&solved[column..row]);
            let sum = known.fold(zero, |sum, (entry, x)| T::fused(*entry, *x, sum));
            solved[row] = -sum / diagonal[row];
        }
        solved[column..].iter().fold(zero, |sum, x| T::fused(*x, *x, sum))
    }
}
