//! Gaussian elimination with full pivoting.

use super::{Extent, Pivot, is_noise};
use crate::{Kinematics, Mechanism, Real};

/// The scaled Jacobian with a right side, on its way to an upper triangle.
///
/// Normalisations are its first rows and give the first pivots: they depend on nothing, so that the row that is left
/// over in a singular pose belongs to a joint.
pub(super) struct Elimination<T: Real, E: Extent> {
    pub(super) extent: E,
    pub(super) jacobian: E::Jacobian<T>,
    right: E::Rows<T>,
    /// Which constraint each row was.
    pub(super) rows: E::Places,
    pub(super) n_normalisations: usize,
    /// The columns in the order in which they are eliminated: pivots first.
    pub(super) columns: E::Columns,
}

impl<T: Real, E: Extent> Elimination<T, E> {
    /// The Jacobian of a mechanism, with columns in the given order and zero on the right.
    pub(super) fn of<M>(mechanism: &M, t: T, y: &M::State, extent: E, columns: E::Columns) -> Self
    where
        M: Kinematics<Scalar = T>,
    {
        let mut values = mechanism.terms().phi_q;
        mechanism.phi_q(t, y, &mut values);
        let (size, n_rows) = (mechanism.size(), extent.n_constraints());
        let mut jacobian = extent.jacobian::<T>();
        for (&(row, column), &value) in mechanism.phi_q_pattern().iter().zip(values.as_ref()) {
            let (row, column) = (usize::from(row), usize::from(column));
            let value = if column % 7 < 3 { value * size } else { value };
            let place = (row + mechanism.description().bodies.len()) % n_rows;
            let entry = jacobian.as_mut().get_mut(place).and_then(|row| row.as_mut().get_mut(column));
            if let Some(entry) = entry {
                *entry = scaled(mechanism, row, value);
            }
        }
        let n_normalisations = mechanism.description().bodies.len();
        let mut rows = extent.places();
        for (place, row) in rows.as_mut().iter_mut().enumerate() {
            *row = ((place + n_rows - n_normalisations % n_rows) % n_rows) as u16;
        }
        Self { extent, jacobian, right: extent.rows(), rows, n_normalisations, columns }
    }

    /// Sets the right side; rows that `values` does not reach stay zero.
    pub(super) fn set_right<M: Mechanism<Scalar = T>>(&mut self, mechanism: &M, values: &[T]) {
        for (right, row) in self.right.as_mut().iter_mut().zip(self.rows.as_ref()) {
            let row = usize::from(*row);
            if let Some(value) = values.get(row) {
                *right = scaled(mechanism, row, *value);
            }
        }
    }

    /// Takes the pivots from the first `n_candidates` columns; returns the smallest.
    pub(super) fn reduce(&mut self, n_candidates: usize) -> Pivot<T> {
        let mut least = Pivot { value: T::constant(1.0), row: 0 };
        for k in 0..self.extent.n_constraints() {
            let (row, column) = self.largest(k, n_candidates);
            self.jacobian.as_mut().swap(k, row);
            self.right.as_mut().swap(k, row);
            self.rows.as_mut().swap(k, row);
            self.columns.as_mut().swap(k, column);
            let value = self.entry(k, k).abs();
            if value < least.value || !value.is_finite() {
                least = Pivot { value, row: usize::from(self.rows.as_ref()[k]) };
            }
            if value > T::constant(0.0) {
                self.eliminate(k);
            }
        }
        least
    }

    /// Row and place of the column of the largest entry that is left.
    fn largest(&self, k: usize, n_candidates: usize) -> (usize, usize) {
        let (mut at, mut largest) = ((k, k), T::constant(0.0));
        let end = if k < self.n_normalisations { k + 1 } else { self.extent.n_constraints() };
        for row in k..end {
            for place in k..n_candidates {
                let value = self.entry(row, place).abs();
                if value > largest {
                    (at, largest) = ((row, place), value);
                }
            }
        }
        at
    }

    /// Clears the pivot's column below it.
    fn eliminate(&mut self, k: usize) {
        let pivot = self.entry(k, k);
        let columns = self.columns.as_ref();
        let (above, below) = self.jacobian.as_mut().split_at_mut(k + 1);
        let (upper, column) = (above[k].as_ref(), usize::from(columns[k]));
        let (solved, rest) = self.right.as_mut().split_at_mut(k + 1);
        for (row, right) in below.iter_mut().zip(rest) {
            let row = row.as_mut();
            let factor = row[column] / pivot;
            // Most entries are zero; what is not a number is carried on.
            if factor != T::constant(0.0) {
                for &column in &columns[k + 1..] {
                    let column = usize::from(column);
                    row[column] = row[column] - factor * upper[column];
                }
                *right = *right - factor * solved[k];
            }
        }
    }

    /// Takes from the right what is no more than rounding where pivots are small.
    pub(super) fn leave_noise(&mut self, speed: T) {
        for k in 0..self.extent.n_constraints() {
            if is_noise(self.right.as_ref()[k].abs(), self.entry(k, k).abs(), speed) {
                self.right.as_mut()[k] = T::constant(0.0);
            }
        }
    }

    /// The dependent coordinates in the order of the solution.
    pub(super) fn dependent(&self) -> impl Iterator<Item = usize> {
        self.columns.as_ref().iter().take(self.extent.n_constraints()).map(|column| usize::from(*column))
    }

    /// `Φ_u⁻¹` times the right side.
    pub(super) fn solution(&self) -> E::Rows<T> {
        self.substitute(self.right.clone())
    }

    /// The places of a dependent and an independent coordinate where the former changes fastest with the latter, if
    /// faster than `limit` times.
    pub(super) fn steepest(&self, limit: T) -> Option<(usize, usize)> {
        let (mut at, mut steepest) = (None, limit);
        for independent in self.extent.n_constraints()..self.extent.n_coordinates() {
            let mut column = self.extent.rows();
            for (row, entry) in column.as_mut().iter_mut().enumerate() {
                *entry = self.entry(row, independent);
            }
            for (dependent, slope) in self.substitute(column).as_ref().iter().enumerate() {
                if slope.abs() > steepest {
                    (at, steepest) = (Some((dependent, independent)), slope.abs());
                }
            }
        }
        at
    }

    /// Back substitution through the triangle.
    fn substitute(&self, mut rows: E::Rows<T>) -> E::Rows<T> {
        let x = rows.as_mut();
        for k in (0..self.extent.n_constraints()).rev() {
            x[k] = x[k] / self.entry(k, k);
            for row in 0..k {
                x[row] = x[row] - self.entry(row, k) * x[k];
            }
        }
        rows
    }

    fn entry(&self, row: usize, place: usize) -> T {
        self.jacobian.as_ref()[row].as_ref()[usize::from(self.columns.as_ref()[place])]
    }
}

/// A value of a constraint row, lengths in units of the mechanism's size.
fn scaled<M: Mechanism>(mechanism: &M, row: usize, value: M::Scalar) -> M::Scalar {
    let is_length = mechanism.description().is_length(row);
    if is_length { value / mechanism.size() } else { value }
}
