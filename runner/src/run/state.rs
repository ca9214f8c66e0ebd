//! The state that a run starts from.

use super::Start;
use crate::{Failure, describe};
use gyro_sim::{Error, Partition, Scalar};

/// The state of a start: `(q, v)`, then zero work where the mechanism counts work, then the model file's own states and
/// the turn references.
pub(crate) fn state<M: Partition>(mechanism: &M, start: &Start) -> Result<M::State, Failure> {
    let mut state = mechanism.start();
    refuse_misfit(mechanism, state.as_ref().len(), start)?;
    let (known, rest) = state.as_mut().split_at_mut(13 * mechanism.description().bodies.len());
    let (work, others) = rest.split_at_mut(rest.len() - start.n_others());
    work.fill(Scalar::constant(0.0));
    for (element, value) in known.iter_mut().zip(start.positions.iter().chain(&start.velocities)) {
        *element = Scalar::constant(*value);
    }
    for (element, value) in others.iter_mut().zip(start.others()) {
        *element = Scalar::constant(value);
    }
    Ok(state)
}

/// At most the work is left of the state when all else is taken away.
fn refuse_misfit<M: Partition>(mechanism: &M, length: usize, start: &Start) -> Result<(), Failure> {
    let n_bodies = mechanism.description().bodies.len();
    let found = [start.positions.len(), start.velocities.len(), start.n_others()];
    let left = length.checked_sub(found.iter().sum());
    let fits = found[0] == 7 * n_bodies
        && found[1] == 6 * n_bodies
        && left.is_some_and(|left| left <= 1)
        && start.observed_bodies.iter().all(|&body| body < n_bodies);
    if fits {
        return Ok(());
    }
    Err(Failure::Refused(format!(
        "the start has {} positions, {} velocities and {} states and turn references, the mechanism has {n_bodies} bodies and {length} \
         elements of its state",
        found[0], found[1], found[2]
    )))
}

/// In a singular pose accelerations are not defined: better to say so than to integrate what is not finite.
pub(super) fn refuse_singular<M: Partition>(mechanism: &M, start: &M::State) -> Result<(), Failure> {
    let t = Scalar::constant(0.0);
    match mechanism.newton_step(t, &mechanism.independent(t, start), &mut start.clone()) {
        Err(error @ Error::Singular { .. }) => Err(Failure::run(describe(mechanism, error))),
        _ => Ok(()),
    }
}
