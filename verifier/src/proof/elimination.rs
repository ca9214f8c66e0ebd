//! Row spaces: whether a vector is a combination of the rows of a matrix, and whether these are independent.
//!
//! Formulas cannot be compared with zero while they are written down, so it is decided beforehand, by numbers of 384
//! bits at a point, which columns are pivots. That is no assumption: the formulas divide by the pivots, and what is
//! divided by zero is not proved.

use super::case::Case;
use super::point::FAR_FROM_ZERO;
use crate::field::{Field, Precision, Real};
use crate::tape::Term;

/// A matrix of full row rank brought to a form in which each row has a one in its pivot, where no later row has
/// anything, with the combinations that its rows are of the matrix's.
pub(super) struct Eliminated<F> {
    rows: Vec<Row<F>>,
    /// How many columns the matrix has; those of the combinations follow them.
    n_columns: usize,
}

struct Row<F> {
    pivot: usize,
    /// What is left of a row, and then how it is made of the rows of the matrix.
    entries: Vec<F>,
}

impl<F: Field> Eliminated<F> {
    /// With the pivots that are chosen from what is left of each row; `None` where there is none.
    fn new(
        context: F::Context,
        matrix: &[Vec<F>],
        mut choose: impl FnMut(&[F]) -> Option<usize>,
    ) -> Option<Self> {
        let n_columns = matrix.first().map_or(0, Vec::len);
        let mut eliminated = Self { rows: Vec::new(), n_columns };
        for (k, row) in matrix.iter().enumerate() {
            let combination = (0..matrix.len()).map(|of| F::integer(context, i64::from(of == k)));
            let rest = eliminated.reduced(row.iter().cloned().chain(combination).collect());
            let pivot = choose(&rest[..n_columns])?;
            let divisor = rest[pivot].clone();
            let entries = rest.iter().map(|entry| entry.div(&divisor)).collect::<Option<_>>()?;
            eliminated.rows.push(Row { pivot, entries });
        }
        Some(eliminated)
    }

    /// What is left of a vector, and of the numbers that follow it.
    fn reduced(&self, mut vector: Vec<F>) -> Vec<F> {
        for Row { pivot, entries } in &self.rows {
            let factor = vector[*pivot].clone();
            for (x, entry) in vector.iter_mut().zip(entries) {
                *x = x.sub(&factor.mul(entry));
            }
        }
        vector
    }

    /// What is left of a vector when a combination of the rows of the matrix is taken away, and the factors of that.
    pub fn split(&self, context: F::Context, vector: &[F]) -> (Vec<F>, Vec<F>) {
        let none = std::iter::repeat_n(F::zero(context), self.rows.len());
        let mut rest = self.reduced(vector.iter().cloned().chain(none).collect());
        let factors = rest.split_off(self.n_columns).iter().map(F::neg).collect();
        (rest, factors)
    }

    /// A vector that the matrix makes these numbers of: zero but for the pivots.
    pub fn solution(&self, context: F::Context, numbers: &[F]) -> Vec<F> {
        let mut vector = vec![F::zero(context); self.n_columns];
        for Row { pivot, entries } in self.rows.iter().rev() {
            let (matrix, combination) = entries.split_at(self.n_columns);
            let sum =
                |a: &[F], b: &[F]| a.iter().zip(b).fold(F::zero(context), |sum, (a, b)| sum.add(&a.mul(b)));
            vector[*pivot] = sum(combination, numbers).sub(&sum(matrix, &vector));
        }
        vector
    }

    /// Numbers that are zero, and exist, where the rows of the matrix are independent.
    pub fn independence(&self, context: F::Context) -> Vec<F> {
        let one = F::one(context);
        self.rows.iter().map(|row| row.entries[row.pivot].sub(&one)).collect()
    }
}

impl<'a> Eliminated<Term<'a>> {
    /// Of formulas; `None` where their rows depend on each other, or exist at no point.
    pub fn of(case: &Case<'a>, matrix: &[Vec<Term<'a>>]) -> Option<Self> {
        let precision = Precision::new();
        let numbers = case.numbers(&precision, &matrix.concat())?;
        let n_columns = matrix.first().map_or(0, Vec::len);
        let rows: Vec<_> = numbers.chunks(n_columns.max(1)).map(<[Real<'_>]>::to_vec).collect();
        let size = |x: &Real<'_>| x.to_f64().abs();
        let largest = numbers.iter().map(size).fold(0.0, f64::max);
        let mut pivots = Vec::new();
        Eliminated::new(&precision, &rows, |rest| {
            let pivot = (0..rest.len()).max_by(|&a, &b| size(&rest[a]).total_cmp(&size(&rest[b])))?;
            pivots.push(pivot);
            (size(&rest[pivot]) > FAR_FROM_ZERO * largest).then_some(pivot)
        })?;
        let mut pivots = pivots.into_iter();
        Self::new(case.point.context, matrix, |_| pivots.next())
    }
}

#[cfg(test)]
mod tests;
