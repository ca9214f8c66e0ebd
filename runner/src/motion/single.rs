//! Builders for runs of one kind. A program that makes no others is compiled in a fraction of the time: it holds no
//! other equations, no other correction and no dual numbers.

use super::builders::{implicit, in_joints, square};
use super::contract::{Begun, COLUMNS, MotionBuilder, not_touching};
use super::correction::{Boxed, partitioning, watched, weighted};
use super::lens::{Slopes, joint_duals};
use super::moving::{adaptive, explicit};
use super::touching::{touching, touching_by};
use crate::approach::{Approach, Coordinates, Correction as Keeping};
use crate::offers::Offers;
use crate::touch::Touch;
use gyro_sim::{
    Baumgarte, ClosedForm, Corrected, CorrectedDynamics, Dual, Dynamics, Exact, Joint, JointJacobian,
    JointLayout, JointSpace, Kinematics, Partition, Projection, Real, Rodas4, Scalar,
};

/// For runs of one kind.
#[derive(Clone, Copy, Debug)]
pub struct Only<K> {
    /// The kind.
    pub kind: K,
    /// Whether the mechanism has joint coordinates, in which other runs can be made.
    pub joint_space: bool,
}

/// A kind of run.
pub trait Kind<M: Partition<Scalar: Real>> {
    /// Whether it is by implicit methods.
    const IS_IMPLICIT: bool = false;

    /// Whether there may be contacts.
    const TOUCHES: bool = false;

    /// In which coordinates.
    const COORDINATES: Coordinates = Coordinates::Maximal;

    /// Whether runs with this correction are of this kind.
    fn makes(&self, _correction: Keeping) -> bool {
        true
    }
    /// A motion from a maximal state at time zero, or the reason why there is none.
    ///
    /// # Errors
    /// What the mechanism lacks for this approach.
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, contacts: &[Touch]) -> Begun<M>;
    /// As [`MotionBuilder::joint_layout`].
    fn joint_layout<'a>(&self, _mechanism: &'a M) -> Option<&'a JointLayout<'a>> {
        None
    }
}

impl<K: Kind<M>, M: Partition<Scalar: Real>> MotionBuilder<M> for Only<K> {
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, contacts: &[Touch]) -> Begun<M> {
        if !K::TOUCHES {
            not_touching(contacts)?;
        }
        let own = (K::IS_IMPLICIT, K::COORDINATES);
        let asked = (approach.integrator.is_implicit(), approach.coordinates);
        if asked != own || !self.kind.makes(approach.correction) {
            return Err(format!("this program was compiled for other runs than {approach}"));
        }
        self.kind.begin(mechanism, approach, y, contacts)
    }

    /// What a program for all runs offers: advice may lead there.
    fn offers(&self) -> Offers {
        Offers { joint_space: self.joint_space, ..Offers::ALL }
    }

    fn joint_layout<'a>(&self, mechanism: &'a M) -> Option<&'a JointLayout<'a>> {
        self.kind.joint_layout(mechanism)
    }

    fn leaves_to_explain(&self) -> bool {
        self.joint_space
    }
}

/// Maximal coordinates, corrected by the coordinate partition.
#[derive(Clone, Copy, Debug)]
pub struct Partitioned;

impl<M: Partition<Scalar: Real> + CorrectedDynamics + 'static> Kind<M> for Partitioned {
    fn makes(&self, correction: Keeping) -> bool {
        correction == Keeping::Partition
    }

    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, _: &[Touch]) -> Begun<M> {
        Ok(explicit(Slopes::of(Corrected), partitioning(mechanism, y), approach, y))
    }
}

/// Maximal coordinates, not corrected.
#[derive(Clone, Copy, Debug)]
pub struct Direct;

impl<M: Partition<Scalar: Real> + Dynamics + 'static> Kind<M> for Direct {
    fn makes(&self, correction: Keeping) -> bool {
        correction == Keeping::None
    }

    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, _: &[Touch]) -> Begun<M> {
        Ok(explicit(Slopes::of(Exact), watched(mechanism), approach, y))
    }
}

/// Maximal coordinates, corrected by way of joint coordinates.
#[derive(Clone, Copy, Debug)]
pub struct InClosedForm;

impl<M> Kind<M> for InClosedForm
where
    M: Partition<Scalar: Real> + JointSpace + CorrectedDynamics + 'static,
{
    fn makes(&self, correction: Keeping) -> bool {
        correction == Keeping::ClosedForm
    }

    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, _: &[Touch]) -> Begun<M> {
        let correction = Boxed(Box::new(ClosedForm::new(mechanism)));
        Ok(explicit(Slopes::of(Corrected), correction, approach, y))
    }
}

/// Maximal coordinates, kept by the projection that the masses weigh.
#[derive(Clone, Copy, Debug)]
pub struct Projected;

impl<M> Kind<M> for Projected
where
    M: Partition<Scalar: Real> + Kinematics + Projection + Dynamics + 'static,
{
    fn makes(&self, correction: Keeping) -> bool {
        correction == Keeping::MassWeighted
    }

    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, _: &[Touch]) -> Begun<M> {
        Ok(explicit(Slopes::of(Exact), weighted(mechanism), approach, y))
    }
}

/// Maximal coordinates, with Baumgarte's stabilisation.
#[derive(Clone, Copy, Debug)]
pub struct Stabilised;

impl<M: Partition<Scalar: Real> + Projection + Dynamics + 'static> Kind<M> for Stabilised {
    fn makes(&self, correction: Keeping) -> bool {
        matches!(correction, Keeping::Baumgarte(_))
    }

    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, _: &[Touch]) -> Begun<M> {
        let Keeping::Baumgarte(rate) = approach.correction else { unreachable!("it is of this kind") };
        let slopes = Slopes::of(Baumgarte { rate: M::Scalar::constant(rate) });
        Ok(explicit(slopes, watched(mechanism), approach, y))
    }
}

/// Maximal coordinates by implicit methods, in dual numbers; of the corrections the partition or none.
#[derive(Clone, Copy, Debug)]
pub struct Implicit<D>(pub D);

impl<M, D> Kind<M> for Implicit<D>
where
    M: Partition<Scalar: Real> + Dynamics + 'static,
    D: Dynamics<Scalar = Dual<M::Scalar, COLUMNS>> + Clone + 'static,
{
    const IS_IMPLICIT: bool = true;

    fn makes(&self, correction: Keeping) -> bool {
        matches!(correction, Keeping::Partition | Keeping::None)
    }

    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, _: &[Touch]) -> Begun<M> {
        let correction = match approach.correction {
            Keeping::Partition => partitioning(mechanism, y),
            _ => watched(mechanism),
        };
        Ok(implicit(approach, self.0.clone(), correction, y))
    }
}

/// Joint coordinates.
#[derive(Clone, Copy, Debug)]
pub struct InJoints;

impl<M: Partition<Scalar: Real> + JointSpace + 'static> Kind<M> for InJoints {
    const COORDINATES: Coordinates = Coordinates::Joint;

    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, _: &[Touch]) -> Begun<M> {
        let (x, closing, approach) = in_joints(mechanism, approach, y)?;
        Ok(explicit(Joint, closing, &approach, &x))
    }

    fn joint_layout<'a>(&self, mechanism: &'a M) -> Option<&'a JointLayout<'a>> {
        Some(mechanism.joint_layout())
    }
}

/// The same kind of run, with rigid contacts where there are any.
#[derive(Clone, Copy, Debug)]
pub struct Touching<K>(pub K);

/// A kind of run that may have rigid contacts.
pub trait Touched<M: Partition<Scalar: Real>>: Kind<M> {
    /// As [`Kind::begin`], with some contacts.
    ///
    /// # Errors
    /// What the mechanism lacks for this approach.
    fn touch(&self, mechanism: &M, approach: &Approach, y: &M::State, contacts: &[Touch]) -> Begun<M>;
}

impl<M: Partition<Scalar: Real>, K: Touched<M>> Kind<M> for Touching<K> {
    const IS_IMPLICIT: bool = K::IS_IMPLICIT;
    const TOUCHES: bool = true;
    const COORDINATES: Coordinates = K::COORDINATES;

    fn makes(&self, correction: Keeping) -> bool {
        self.0.makes(correction)
    }

    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, contacts: &[Touch]) -> Begun<M> {
        match contacts.is_empty() {
            true => self.0.begin(mechanism, approach, y, contacts),
            false => self.0.touch(mechanism, approach, y, contacts),
        }
    }

    fn joint_layout<'a>(&self, mechanism: &'a M) -> Option<&'a JointLayout<'a>> {
        self.0.joint_layout(mechanism)
    }
}

impl<M> Touched<M> for Partitioned
where
    M: Partition<Scalar: Real> + CorrectedDynamics + JointSpace + Clone + 'static,
{
    fn touch(&self, mechanism: &M, approach: &Approach, y: &M::State, contacts: &[Touch]) -> Begun<M> {
        touching((mechanism, Slopes::of(Corrected)), partitioning(mechanism, y), approach, y, contacts)
    }
}

impl<M> Touched<M> for Direct
where
    M: Partition<Scalar: Real> + Dynamics + JointSpace + Clone + 'static,
{
    fn touch(&self, mechanism: &M, approach: &Approach, y: &M::State, contacts: &[Touch]) -> Begun<M> {
        touching((mechanism, Slopes::of(Exact)), watched(mechanism), approach, y, contacts)
    }
}

impl<M: Partition<Scalar: Real> + JointSpace + Clone + 'static> Touched<M> for InJoints {
    fn touch(&self, mechanism: &M, approach: &Approach, y: &M::State, contacts: &[Touch]) -> Begun<M> {
        let (x, closing, approach) = in_joints(mechanism, approach, y)?;
        touching((mechanism, Joint), closing, &approach, &x, contacts)
    }
}

impl<M: Partition<Scalar: Real> + JointJacobian + Clone + 'static> Touched<M> for ImplicitInJoints {
    fn touch(&self, mechanism: &M, approach: &Approach, y: &M::State, contacts: &[Touch]) -> Begun<M> {
        let (x, closing, approach) = in_joints(mechanism, approach, y)?;
        let method = Rodas4::new(&x, mechanism.jacobian_buffers().jacobian);
        touching_by((mechanism, Joint), method, closing, &approach, &x, contacts)
    }
}

impl<M, D> Touched<M> for ImplicitInJointsByDuals<D>
where
    M: Partition<Scalar: Real> + JointSpace + Clone + 'static,
    D: JointSpace<Scalar = Dual<M::Scalar, COLUMNS>> + Clone + 'static,
{
    fn touch(&self, mechanism: &M, approach: &Approach, y: &M::State, contacts: &[Touch]) -> Begun<M> {
        let (x, closing, approach) = in_joints(mechanism, approach, y)?;
        let method = Rodas4::new(&x, vec![M::Scalar::constant(0.0); square(x.as_ref())]);
        touching_by((mechanism, joint_duals(&self.0)), method, closing, &approach, &x, contacts)
    }
}

/// Joint coordinates by implicit methods, with the generated Jacobian.
#[derive(Clone, Copy, Debug)]
pub struct ImplicitInJoints;

impl<M: Partition<Scalar: Real> + JointJacobian + 'static> Kind<M> for ImplicitInJoints {
    const IS_IMPLICIT: bool = true;
    const COORDINATES: Coordinates = Coordinates::Joint;

    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, _: &[Touch]) -> Begun<M> {
        let (x, closing, approach) = in_joints(mechanism, approach, y)?;
        let method = Rodas4::new(&x, mechanism.jacobian_buffers().jacobian);
        Ok(adaptive(Joint, method, closing, &approach, &x))
    }

    fn joint_layout<'a>(&self, mechanism: &'a M) -> Option<&'a JointLayout<'a>> {
        Some(mechanism.joint_layout())
    }
}

/// Joint coordinates by implicit methods, with a Jacobian by dual numbers.
#[derive(Clone, Copy, Debug)]
pub struct ImplicitInJointsByDuals<D>(pub D);

impl<M, D> Kind<M> for ImplicitInJointsByDuals<D>
where
    M: Partition<Scalar: Real> + JointSpace + 'static,
    D: JointSpace<Scalar = Dual<M::Scalar, COLUMNS>> + Clone + 'static,
{
    const IS_IMPLICIT: bool = true;
    const COORDINATES: Coordinates = Coordinates::Joint;

    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, _: &[Touch]) -> Begun<M> {
        let (x, closing, approach) = in_joints(mechanism, approach, y)?;
        let method = Rodas4::new(&x, vec![M::Scalar::constant(0.0); square(x.as_ref())]);
        Ok(adaptive(joint_duals(&self.0), method, closing, &approach, &x))
    }

    fn joint_layout<'a>(&self, mechanism: &'a M) -> Option<&'a JointLayout<'a>> {
        Some(mechanism.joint_layout())
    }
}
