//! Linearisation beside runs of one kind.

use super::contract::{Begun, COLUMNS, Linear, MotionBuilder, OperatingPoint};
use super::independent::Closing;
use super::linearise::{by_duals, by_jacobian};
use crate::approach::Approach;
use crate::offers::Offers;
use crate::pivots;
use crate::touch::Touch;
use gyro_sim::{Dual, JointJacobian, JointLayout, JointSpace, Kinematics, Partition, Real};

/// Runs of other builders, with all that is examined about them.
#[derive(Clone, Copy, Debug)]
pub struct Examined<B, L> {
    /// What begins the runs.
    pub runs: B,
    /// What linearises.
    pub linearised: L,
}

/// How a mechanism is linearised.
pub trait Linearise<M: Partition<Scalar: Real>> {
    /// As [`MotionBuilder::linearise`].
    fn linearise(&self, mechanism: &M, at: &OperatingPoint<'_, M::State>) -> Option<Linear>;
}

/// Not at all, for what has no joint form.
#[derive(Clone, Copy, Debug)]
pub struct Nothing;

/// With the mechanism in dual numbers.
#[derive(Clone, Copy, Debug)]
pub struct ByDuals<D>(pub D);

/// By its generated Jacobian, and outputs in dual numbers.
#[derive(Clone, Copy, Debug)]
pub struct ByJacobian<D>(pub D);

impl<M: Partition<Scalar: Real>> Linearise<M> for Nothing {
    fn linearise(&self, _: &M, _: &OperatingPoint<'_, M::State>) -> Option<Linear> {
        None
    }
}

impl<M, D> Linearise<M> for ByDuals<D>
where
    M: Partition<Scalar: Real> + JointSpace,
    D: JointSpace<Scalar = Dual<M::Scalar, COLUMNS>> + Clone,
{
    fn linearise(&self, mechanism: &M, at: &OperatingPoint<'_, M::State>) -> Option<Linear> {
        by_duals(mechanism, &self.0, at)
    }
}

impl<M, D> Linearise<M> for ByJacobian<D>
where
    M: Partition<Scalar: Real> + JointJacobian,
    D: Closing<Scalar = Dual<M::Scalar, COLUMNS>> + Clone,
{
    fn linearise(&self, mechanism: &M, at: &OperatingPoint<'_, M::State>) -> Option<Linear> {
        by_jacobian(mechanism, &self.0, at)
    }
}

impl<M, B, L> MotionBuilder<M> for Examined<B, L>
where
    M: Partition<Scalar: Real> + Kinematics,
    B: MotionBuilder<M>,
    L: Linearise<M>,
{
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, contacts: &[Touch]) -> Begun<M> {
        self.runs.begin(mechanism, approach, y, contacts)
    }

    fn offers(&self) -> Offers {
        self.runs.offers()
    }

    fn smallest_pivot(&self, mechanism: &M, t: f64, y: &M::State) -> Option<f64> {
        Some(pivots::smallest(mechanism, t, y))
    }

    fn joint_layout<'a>(&self, mechanism: &'a M) -> Option<&'a JointLayout<'a>> {
        self.runs.joint_layout(mechanism)
    }

    fn linearise(&self, mechanism: &M, at: &OperatingPoint<'_, M::State>) -> Option<Linear> {
        self.linearised.linearise(mechanism, at)
    }
}
