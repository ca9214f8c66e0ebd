//! What a jump in the velocity of something driven does to a mechanism.

use super::lens::Lens;
use crate::path::LARGE;
use gyro_sim::{Mechanism, Scalar};

/// The state after the velocities of what is driven have jumped.
///
/// Accelerations are affine in those of what is driven, f̈, and positions do not depend on them, so an impulse of the
/// drivers changes the velocities by `(∂v̇/∂f̈) Δḟ`: by the mechanism's own constrained mass matrix. Each mechanism is
/// given twice, with f̈ = 0 and with f̈ = Δḟ times a large number: on the lines before and on those after. The drivers'
/// work is that of a constant force while velocities go from the ones to the others: the mean of both ends.
pub(super) fn struck<M: Mechanism, L: Lens<M>>(
    lens: &L,
    (t, y): (M::Scalar, &L::State),
    [before, after]: [[&M; 2]; 2],
) -> L::State {
    let half = M::Scalar::constant(0.5);
    let first = answer(lens, (t, y), before);
    let mut moved = y.clone();
    moved.as_mut().iter_mut().zip(first.as_ref()).for_each(|(y, change)| *y = *y + *change);
    let second = answer(lens, (t, &moved), after);
    let changes = first.as_ref().iter().zip(second.as_ref());
    moved.as_mut().copy_from_slice(y.as_ref());
    moved.as_mut().iter_mut().zip(changes).for_each(|(y, (a, b))| *y = *y + half * (*a + *b));
    moved
}

/// What the large accelerations change of the slopes, less their size.
fn answer<M: Mechanism, L: Lens<M>>(
    lens: &L,
    (t, y): (M::Scalar, &L::State),
    [still, pushed]: [&M; 2],
) -> L::State {
    let (mut change, mut base) = (y.clone(), y.clone());
    lens.derivative(still, t, y, &mut base);
    lens.derivative(pushed, t, y, &mut change);
    let part = M::Scalar::constant(1.0 / LARGE);
    change.as_mut().iter_mut().zip(base.as_ref()).for_each(|(a, b)| *a = (*a - *b) * part);
    change
}
