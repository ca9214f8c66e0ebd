//! How far a state is off its constraints.

use crate::{Mechanism, Owner, Real, RowInfo};

/// The positions count as corrected when no row exceeds this many roundings: of one, or of the largest coordinate in
/// units of the mechanism's size, because a point row is a difference of positions. Where that is not enough, each row
/// is judged by what it subtracts: see [`Partition::is_met`](crate::Partition::is_met).
pub(crate) const CONVERGED_EPSILONS: f64 = 16.0;

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
    worst(joint_rows(mechanism, rows, |x| x))
}

/// The worst of all rows of Φ, normalisations included; `read` gives the number that counts, of a pack of lanes one of
/// them.
pub(crate) fn constraint_violation<M: Mechanism, T: Real>(
    mechanism: &M,
    phi: &[M::Scalar],
    read: impl Fn(M::Scalar) -> T,
) -> Violation<T> {
    let (rows, normalisations) = phi.split_at(phi.len().saturating_sub(mechanism.description().bodies.len()));
    let normalisations = normalisations.iter().map(|&x| read(x).abs()).zip((0u16..).map(Owner::Body));
    worst(joint_rows(mechanism, rows, &read).chain(normalisations))
}

/// The worst of the rows of the closure, which are these of the joint rows.
pub(crate) fn closure_violation<M: Mechanism<Scalar: Real>>(
    mechanism: &M,
    rows: &[u16],
    closure: &[M::Scalar],
) -> Violation<M::Scalar> {
    let size = mechanism.size();
    let described = rows.iter().filter_map(|&row| mechanism.description().rows.get(usize::from(row)));
    worst(closure.iter().zip(described).map(|(&value, row)| measured(value, row, size)))
}

/// Size and owner of each joint row.
fn joint_rows<M: Mechanism, T: Real>(
    mechanism: &M,
    rows: &[M::Scalar],
    read: impl Fn(M::Scalar) -> T,
) -> impl Iterator<Item = (T, Owner)> {
    let size = read(mechanism.size());
    rows.iter().zip(mechanism.description().rows).map(move |(&value, row)| measured(read(value), row, size))
}

fn measured<T: Real>(value: T, row: &RowInfo, size: T) -> (T, Owner) {
    (if row.is_length { (value / size).abs() } else { value.abs() }, row.owner)
}

fn worst<T: Real>(rows: impl Iterator<Item = (T, Owner)>) -> Violation<T> {
    let mut worst = Violation { value: T::constant(0.0), owner: None };
    for (value, owner) in rows {
        // What is not finite replaces the worst and is then kept.
        let worse = !value.is_finite() || value > worst.value || worst.owner.is_none();
        if worst.value.is_finite() && worse {
            worst = Violation { value, owner: Some(owner) };
        }
    }
    worst
}
