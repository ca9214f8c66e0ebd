//! The correction of trees that needs no iteration: to joint coordinates and back.

use super::{Correction, Maximal, check_finite};
use crate::violation::constraint_violation;
use crate::{Error, JointSpace, Real, refer_turns};

/// Joint coordinates and their rates are kept, and all else follows from them.
#[derive(Clone, Debug)]
pub struct ClosedForm<M: JointSpace> {
    joints: M::Joints,
    before: M::State,
    phi: M::Constraints,
}

impl<M: JointSpace<Scalar: Real>> ClosedForm<M> {
    /// Work space for a mechanism.
    pub fn new(mechanism: &M) -> Self {
        Self { joints: mechanism.joint_start(), before: mechanism.start(), phi: mechanism.constraints() }
    }

    /// Corrects positions and velocities. The work, which follows the velocities in the state, is left as it is.
    ///
    /// # Errors
    /// [`Error::NotFinite`] if the state is not finite.
    pub fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        self.before.as_mut().copy_from_slice(y.as_ref());
        mechanism.to_joints(t, y, &mut self.joints);
        mechanism.to_maximal(t, &self.joints, y);
        let kept = y.as_mut().iter_mut().zip(self.before.as_ref()).skip(13 * mechanism.n_bodies());
        kept.for_each(|(element, before)| *element = *before);
        refer_turns(mechanism, t, y);
        // Angles are continued from these: what is not finite must not stay among them.
        check_finite(t, y.as_ref()).inspect_err(|_| self.joints = mechanism.joint_start())
    }
}

impl<O: Maximal<Mechanism = M>, M> Correction<O> for ClosedForm<M>
where
    M: JointSpace<Scalar = O::Scalar, State = O::State>,
    O::Scalar: Real,
{
    fn correct(&mut self, system: &O, t: O::Scalar, y: &mut O::State) -> Result<(), Error> {
        self.correct(system.mechanism(), t, y)
    }
    fn violation(&mut self, system: &O, t: O::Scalar, y: &O::State) -> O::Scalar {
        system.mechanism().phi(t, y, &mut self.phi);
        constraint_violation(system.mechanism(), self.phi.as_ref(), |x| x).value
    }
}
