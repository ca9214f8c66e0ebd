//! How near to zero rounding lets a constraint row come: a row cannot be smaller than the rounding of what it
//! subtracts.
//!
//! A gear's row subtracts angles that grow with every turn, a rod's row positions that may be far from the origin, a
//! row with a large ratio what it multiplies. Each row is judged by its own terms.

use crate::violation::CONVERGED_EPSILONS;
use crate::{Kinematics, Real, Scalar};
use core::f64::consts::TAU;

/// Whether no row of Φ exceeds the rounding of what it subtracts: of its unit (one, or the mechanism's size), of each
/// coordinate times the row's derivative with respect to it, and of the whole turns of each angle that it has.
///
/// Rows that are not finite are not met.
///
/// # Cost
/// One evaluation of Φ_q, and one of Φ for each turn reference.
pub fn is_met<M>(mechanism: &M, t: M::Scalar, y: &M::State, phi: &M::Constraints) -> bool
where
    M: Kinematics<Scalar: Real>,
{
    let mut sizes = mechanism.buffers().constraints;
    add_units(mechanism, sizes.as_mut());
    add_coordinates(mechanism, t, y, sizes.as_mut());
    add_turns(mechanism, t, y, phi.as_ref(), sizes.as_mut());
    let rounding = M::Scalar::EPSILON * M::Scalar::constant(CONVERGED_EPSILONS);
    phi.as_ref().iter().zip(sizes.as_ref()).all(|(row, size)| row.abs() <= rounding * *size)
}

/// Roundings of what it subtracts that a row of angles may have and be left alone.
const SILENT_EPSILONS: f64 = 2.0;

/// Sets rows to zero that the rounding of whole turns hides: to chase it would turn bodies to and fro, by so much in
/// single precision that rows which bend never come to rest.
pub(crate) fn silence<M>(mechanism: &M, t: M::Scalar, y: &M::State, phi: &mut M::Constraints)
where
    M: Kinematics<Scalar: Real>,
{
    let mut sizes = mechanism.buffers().constraints;
    add_turns(mechanism, t, y, phi.as_ref(), sizes.as_mut());
    let rounding = M::Scalar::EPSILON * M::Scalar::constant(SILENT_EPSILONS);
    for (row, size) in phi.as_mut().iter_mut().zip(sizes.as_ref()) {
        if row.abs() <= rounding * *size {
            *row = M::Scalar::constant(0.0);
        }
    }
}

fn add_units<M: Kinematics<Scalar: Real>>(mechanism: &M, sizes: &mut [M::Scalar]) {
    for (row, size) in sizes.iter_mut().enumerate() {
        let is_length = mechanism.description().is_length(row);
        *size = if is_length { mechanism.size() } else { M::Scalar::constant(1.0) };
    }
}

/// `Σ |∂Φ/∂q_j| |q_j|`: what an error of one part in each coordinate amounts to.
fn add_coordinates<M: Kinematics<Scalar: Real>>(
    mechanism: &M,
    t: M::Scalar,
    y: &M::State,
    sizes: &mut [M::Scalar],
) {
    let mut slopes = mechanism.terms().phi_q;
    mechanism.phi_q(t, y, &mut slopes);
    for (&(row, column), slope) in mechanism.phi_q_pattern().iter().zip(slopes.as_ref()) {
        if let (Some(size), Some(q)) = (sizes.get_mut(usize::from(row)), y.as_ref().get(usize::from(column)))
        {
            *size = *size + (*slope * *q).abs();
        }
    }
}

/// What the whole turns of each angle contribute, found by taking them off its turn reference; of an angle on its first
/// turn, one turn. The work done, which is among the last elements too, is in no row.
fn add_turns<M: Kinematics<Scalar: Real>>(
    mechanism: &M,
    t: M::Scalar,
    y: &M::State,
    phi: &[M::Scalar],
    sizes: &mut [M::Scalar],
) {
    let first = 13 * mechanism.description().bodies.len();
    if y.as_ref().len() <= first {
        return;
    }
    let (one, turn) = (M::Scalar::constant(1.0), M::Scalar::constant(TAU));
    let (mut turned, mut without) = (y.clone(), mechanism.buffers().constraints);
    for place in first..y.as_ref().len() {
        let (before, after) = (y.as_ref().get(place), turned.as_mut().get_mut(place));
        let (Some(&before), Some(after)) = (before, after) else { return };
        let turns = (before / turn).round();
        *after = before - turn * if turns.abs() < one { one } else { turns };
        mechanism.phi(t, &turned, &mut without);
        for ((size, phi), without) in sizes.iter_mut().zip(phi).zip(without.as_ref()) {
            *size = *size + (*phi - *without).abs();
        }
        if let Some(after) = turned.as_mut().get_mut(place) {
            *after = before;
        }
    }
}
