//! The correction by way of joint coordinates: there and back. Trees need no iteration for it.

use super::{CloseLoops, Correction, check_finite};
use crate::violation::constraint_violation;
use crate::{Error, JointSpace, Ode, Real, refer_turns};

/// Joint coordinates and their rates are kept, but for what closes loops, and all else follows from them.
#[derive(Clone, Debug)]
pub struct ClosedForm<M: JointSpace> {
    joints: M::Joints,
    loops: CloseLoops<M>,
    before: M::State,
    phi: M::Constraints,
}

impl<M: JointSpace<Scalar: Real>> ClosedForm<M> {
    /// Work space for a mechanism.
    pub fn new(mechanism: &M) -> Self {
        Self {
            joints: mechanism.joint_start(),
            loops: CloseLoops::new(mechanism),
            before: mechanism.start(),
            phi: mechanism.buffers().constraints,
        }
    }

    /// Corrects positions and velocities. The work, which follows the velocities in the state, is left as it is.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if the state is not finite, and what [`CloseLoops::correct`] returns.
    pub fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        self.before.as_mut().copy_from_slice(y.as_ref());
        mechanism.to_joints(t, y, &mut self.joints);
        let closed = self.loops.correct(mechanism, t, &mut self.joints);
        mechanism.to_maximal(t, &self.joints, y);
        let n_bodies = mechanism.description().bodies.len();
        let kept = y.as_mut().iter_mut().zip(self.before.as_ref()).skip(13 * n_bodies);
        kept.for_each(|(element, before)| *element = *before);
        let bodies = y.as_mut().chunks_exact_mut(7).zip(self.before.as_ref().chunks_exact(7));
        bodies.take(n_bodies).for_each(|(body, before)| keep_side(&mut body[3..], &before[3..]));
        refer_turns(mechanism, t, y);
        // Angles are continued from these: what is not finite must not stay among them.
        check_finite(t, y.as_ref()).and(closed).inspect_err(|_| self.joints = mechanism.joint_start())
    }
}

/// Of the two that stand for the same orientation, takes the Euler parameters that are nearer to those before.
fn keep_side<T: Real>(p: &mut [T], before: &[T]) {
    let zero = T::constant(0.0);
    let along = p.iter().zip(before).fold(zero, |sum, (a, b)| T::fused(*a, *b, sum));
    if along < zero {
        p.iter_mut().for_each(|e| *e = -*e);
    }
}

impl<D, M> Correction<D, M> for ClosedForm<M>
where
    M: JointSpace<Scalar: Real>,
    D: Ode<M, Scalar = M::Scalar, State = M::State>,
{
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        self.correct(mechanism, t, y)
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar {
        mechanism.phi(t, y, &mut self.phi);
        constraint_violation(mechanism, self.phi.as_ref(), |x| x).value
    }
}
