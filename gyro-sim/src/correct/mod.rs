//! Corrections: ways back onto the constraints `Φ = 0` and `Φ_r s + Φ_π' w' = ν` that integration leaves.
//!
//! | correction | what it keeps |
//! |---|---|
//! | [`Partitioning`] | the independent coordinates as they were integrated (eqs. (18) to (20)); any mechanism |
//! | [`ClosedForm`] | the joint coordinates, but for what closes loops; no iteration for trees |
//! | [`CloseLoops`] | in joint coordinates, what generated code keeps; any mechanism that has them |
//! | [`MassWeighted`] | nothing exactly, but it makes the smallest change in the metric of the masses; any mechanism |
//! | [`Baumgarte`] | nothing: its accelerations reduce violations; equations, not a correction |
//! | [`Uncorrected`] | everything: direct integration, and systems that have no constraints |
//! | [`Watched`] | everything, but drift and singular poses are detected |

mod baumgarte;
mod close_loops;
mod closed_form;
mod mass_weighted;
mod partition;

pub use baumgarte::Baumgarte;
pub use close_loops::CloseLoops;
pub use closed_form::ClosedForm;
pub use mass_weighted::MassWeighted;
pub use partition::{Direct, Partitioned, Partitioning};

use crate::scalar::largest_magnitude;
use crate::violation::constraint_violation;
use crate::{Clearance, Error, Lanes, Mechanism, Ode, Partition, Real, Scalar, refer_turns};

/// A way back onto the constraints, for the equations `D` of a model `M`: a correction implements this for the
/// equations that it admits.
pub trait Correction<D: Ode<M>, M = ()> {
    /// Corrects positions and velocities.
    ///
    /// # Errors
    /// [`Error`], with `y` as it was when the failure was noticed.
    fn correct(&mut self, model: &M, t: D::Scalar, y: &mut D::State) -> Result<(), Error>;
    /// Keeps the turn references of a state that is not due for a correction near their angles.
    fn refer_turns(&mut self, _model: &M, _t: D::Scalar, _y: &mut D::State) {}
    /// The largest violation of a position constraint, lengths in units of the mechanism's size.
    fn violation(&mut self, model: &M, t: D::Scalar, y: &D::State) -> D::Scalar;
    /// How often the choice of independent coordinates has changed, where there is one.
    fn switches(&self) -> u64 {
        0
    }
    /// How far a state is from singular poses; `None` where there are none, or where this is not known.
    fn clearance(&self, _model: &M, _t: D::Scalar, _y: &D::State) -> Option<Clearance<D::Scalar>> {
        None
    }
}

/// No correction; admits any equations.
#[derive(Clone, Copy, Debug, Default)]
pub struct Uncorrected;

impl<D: Ode<M>, M> Correction<D, M> for Uncorrected {
    fn correct(&mut self, _: &M, _: D::Scalar, _: &mut D::State) -> Result<(), Error> {
        Ok(())
    }
    fn violation(&mut self, _: &M, _: D::Scalar, _: &D::State) -> D::Scalar {
        D::Scalar::constant(0.0)
    }
}

/// No correction of a mechanism, but its drift is measured, singular poses are detected, and turn references are kept.
/// ([`Uncorrected`] does not know that its system is a mechanism.)
#[derive(Clone, Debug)]
pub struct Watched<M: Mechanism> {
    phi: M::Constraints,
}

impl<M: Mechanism> Watched<M> {
    /// Work space for a mechanism.
    pub fn new(mechanism: &M) -> Self {
        Self { phi: mechanism.buffers().constraints }
    }
}

impl<D, M> Correction<D, M> for Watched<M>
where
    M: Partition<Scalar: Real>,
    D: Ode<M, Scalar = M::Scalar, State = M::State>,
{
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        refer_turns(mechanism, t, y);
        Ok(())
    }
    fn refer_turns(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) {
        refer_turns(mechanism, t, y);
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar {
        mechanism.phi(t, y, &mut self.phi);
        constraint_violation(mechanism, self.phi.as_ref(), |x| x).value
    }
    fn clearance(&self, mechanism: &M, t: M::Scalar, y: &M::State) -> Option<Clearance<M::Scalar>> {
        mechanism.clearance(t, y)
    }
}

/// When a correction is due.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum When {
    /// After this number of steps; 1 means after every step.
    Steps(u32),
    /// After each step that leaves a violation of a position constraint larger than this, lengths in units of the
    /// mechanism's size.
    Violation(f64),
}

impl Default for When {
    fn default() -> Self {
        Self::Steps(1)
    }
}

/// Newton–Raphson converges quadratically from the drift of a few steps: one or two iterations. Ten mean that it does
/// not.
pub(crate) const MAX_ITERATIONS: u32 = 10;

/// A change of more than this many radians, or lengths in units of the mechanism's size, leads to another pose and is
/// refused.
pub(crate) const FARTHEST: f64 = 0.5;

/// The largest coordinate of a mass centre in units of the mechanism's size.
pub(crate) fn reach<M: Mechanism<Scalar: Lanes>>(mechanism: &M, y: &M::State) -> M::Scalar {
    let bodies = y.as_ref().chunks_exact(7).take(mechanism.description().bodies.len());
    largest_magnitude(bodies.flat_map(|body| body.iter().take(3)).copied()) / mechanism.size()
}

/// Refuses start and end times that are not finite: equations that do not depend on time would not reveal them.
pub(crate) fn check_time<T: Real>(t: T, t_end: T) -> Result<(), Error> {
    if t.is_finite() && t_end.is_finite() {
        return Ok(());
    }
    Err(Error::InvalidEndTime { t: t.to_f64(), t_end: t_end.to_f64() })
}

pub(crate) fn check_finite<T: Real>(t: T, state: &[T]) -> Result<(), Error> {
    match (0u16..).zip(state).find(|(_, x)| !x.is_finite()) {
        Some((index, _)) => Err(Error::NotFinite { t: t.to_f64(), index }),
        None => Ok(()),
    }
}
