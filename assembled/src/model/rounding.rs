//! How near to zero rounding lets the rows come: to the rounding of their terms.

use crate::model::lowered::Lowered;
use crate::model::place::Moment;
use crate::number::{Number, abs, number};

/// Roundings of its terms that a row may keep.
const EPSILONS: f64 = 16.0;

/// Roundings of its terms that a row may have and be left alone: to chase them would turn bodies to and fro.
const SILENT_EPSILONS: f64 = 2.0;

impl<T: Number> Lowered<T> {
    /// Sets rows to zero that the rounding of their terms hides.
    pub(crate) fn silence(&self, at: Moment<'_, T>, phi: &mut [T]) {
        let rounding = T::EPSILON * number(SILENT_EPSILONS);
        self.for_each_size(at, |row, size| {
            if abs(phi[row]) <= rounding * size {
                phi[row] = T::zero();
            }
        });
    }

    /// Whether no row exceeds the rounding of what it adds up: a unit, its terms and what is prescribed, and each
    /// coordinate as far as the row changes with it.
    pub(crate) fn is_met(&self, at: Moment<'_, T>, phi: &[T]) -> bool {
        let mut sizes: Vec<T> = phi.iter().map(|_| T::one()).collect();
        for (size, row) in sizes.iter_mut().zip(&self.row_infos) {
            *size = if row.is_length { self.size } else { T::one() };
        }
        self.for_each_size(at, |row, size| sizes[row] += size);
        self.phi_q(at, |row, column, slope| sizes[row] += abs(slope * at.y[column]));
        let rounding = T::EPSILON * number(EPSILONS);
        phi.iter().zip(sizes).all(|(phi, size)| abs(*phi) <= rounding * size)
    }
}
