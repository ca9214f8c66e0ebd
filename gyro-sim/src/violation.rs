//! How far a state is off its constraints.

use crate::{Mechanism, Owner, Real, Scalar};

/// The worst violated row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Violation<T> {
    /// Largest absolute row; lengths are divided by the mechanism's size.
    pub value: T,
    /// Whose row it is; `None` for a mechanism without rows.
    pub owner: Option<Owner>,
}

/// The worst of some joint rows: of Φ, or of the velocity residual.
///
/// Rows that are not finite count as worse than any number.
pub fn violation<M: Mechanism<Scalar: Real>>(mechanism: &M, rows: &[M::Scalar]) -> Violation<M::Scalar> {
    let size = mechanism.size();
    let mut worst = Violation { value: M::Scalar::constant(0.0), owner: None };
    for (index, &value) in rows.iter().enumerate() {
        let row = mechanism.row(index);
        let value = if row.is_length { (value / size).abs() } else { value.abs() };
        // Written so that a NaN replaces the worst and is then kept.
        if worst.value.is_finite() && (!value.is_finite() || value > worst.value || worst.owner.is_none()) {
            worst = Violation { value, owner: Some(row.owner) };
        }
    }
    worst
}
