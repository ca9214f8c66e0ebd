//! What can be begun with which mechanism: the more it implements, the more there is.

use super::contract::{Begun, COLUMNS, Linear, Maximal, Motion, MotionBuilder, OperatingPoint, not_touching};
use super::correction::{Boxed, keeping, partitioning};
use super::independent::Closing;
use super::lens::{Slopes, joint_duals, joints};
use super::linearise::{by_duals, by_jacobian};
use super::moving::{adaptive, explicit};
use crate::approach::{Approach, Coordinates, Correction as Keeping, When};
use crate::failure::describe_in;
use crate::offers::Offers;
use crate::pivots;
use crate::touch::Touch;
use gyro_sim::{
    Baumgarte, ByDuals, CloseLoops, ClosedForm, Corrected, CorrectedDynamics, Dual, Dynamics, Exact, Joint,
    JointJacobian, JointLayout, JointSpace, Partition, Real, Rodas4, Scalar, Watched,
};

/// For whatever can be partitioned.
#[derive(Clone, Copy, Debug)]
pub struct Any;

/// For mechanisms with a projection too.
#[derive(Clone, Copy, Debug)]
pub struct Projecting;

/// For any mechanism whose kernels exist in dual numbers too.
#[derive(Clone, Copy, Debug)]
pub struct WithDuals<D>(pub D);

/// For mechanisms in joint coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Tree<D>(pub D);

/// For mechanisms in joint coordinates with a generated Jacobian.
#[derive(Clone, Copy, Debug)]
pub struct TreeWithJacobian<D>(pub D);

impl<M> MotionBuilder<M> for Any
where
    M: Partition<Scalar: Real> + Dynamics + CorrectedDynamics + 'static,
{
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, contacts: &[Touch]) -> Begun<M> {
        not_touching(contacts)?;
        only_maximal(approach)?;
        only_explicit(approach)?;
        match approach.correction {
            Keeping::Partition => {
                Ok(explicit(Slopes::of(Corrected), partitioning(mechanism, y), approach, y))
            }
            Keeping::None => {
                Ok(explicit(Slopes::of(Exact), Boxed(Box::new(Watched::new(mechanism))), approach, y))
            }
            other => {
                Err(format!("the correction {other} needs a projection, which this mechanism does not have"))
            }
        }
    }
}

impl<M: Maximal + 'static> MotionBuilder<M> for Projecting {
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, contacts: &[Touch]) -> Begun<M> {
        not_touching(contacts)?;
        only_maximal(approach)?;
        only_explicit(approach)?;
        let correction = keeping(mechanism, approach, y)?;
        Ok(maximal(approach, correction, y))
    }

    fn offers(&self) -> Offers {
        Offers { joint_space: false, derivatives: false, ..Offers::ALL }
    }

    fn smallest_pivot(&self, mechanism: &M, t: f64, y: &M::State) -> Option<f64> {
        Some(pivots::smallest(mechanism, t, y))
    }
}

impl<M, D> MotionBuilder<M> for WithDuals<D>
where
    M: Maximal + 'static,
    D: Dynamics<Scalar = Dual<M::Scalar, COLUMNS>> + Clone + 'static,
{
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, contacts: &[Touch]) -> Begun<M> {
        not_touching(contacts)?;
        only_maximal(approach)?;
        let correction = keeping(mechanism, approach, y)?;
        if approach.integrator.is_implicit() {
            return Ok(implicit(approach, self.0.clone(), correction, y));
        }
        Ok(maximal(approach, correction, y))
    }

    fn offers(&self) -> Offers {
        Offers { joint_space: false, ..Offers::ALL }
    }

    fn smallest_pivot(&self, mechanism: &M, t: f64, y: &M::State) -> Option<f64> {
        Some(pivots::smallest(mechanism, t, y))
    }
}

impl<M, D> MotionBuilder<M> for Tree<D>
where
    M: Maximal + JointSpace + 'static,
    D: JointSpace<Scalar = Dual<M::Scalar, COLUMNS>> + Dynamics + Clone + 'static,
{
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, contacts: &[Touch]) -> Begun<M> {
        not_touching(contacts)?;
        if approach.coordinates == Coordinates::Maximal {
            return in_maximal(mechanism, approach, &self.0, y);
        }
        let (x, closing, approach) = in_joints(mechanism, approach, y)?;
        if approach.integrator.is_implicit() {
            let method = Rodas4::new(&x, vec![M::Scalar::constant(0.0); square(x.as_ref())]);
            return Ok(adaptive(joint_duals(&self.0), method, closing, &approach, &x));
        }
        Ok(explicit(Joint, closing, &approach, &x))
    }

    fn offers(&self) -> Offers {
        Offers::ALL
    }

    fn smallest_pivot(&self, mechanism: &M, t: f64, y: &M::State) -> Option<f64> {
        Some(pivots::smallest(mechanism, t, y))
    }

    fn joint_layout<'a>(&self, mechanism: &'a M) -> Option<&'a JointLayout<'a>> {
        Some(mechanism.joint_layout())
    }

    fn linearise(&self, mechanism: &M, at: &OperatingPoint<'_, M::State>) -> Option<Linear> {
        by_duals(mechanism, &self.0, at)
    }
}

impl<M, D> MotionBuilder<M> for TreeWithJacobian<D>
where
    M: Maximal + JointJacobian + 'static,
    D: Closing<Scalar = Dual<M::Scalar, COLUMNS>> + Dynamics + Clone + 'static,
{
    fn begin(&self, mechanism: &M, approach: &Approach, y: &M::State, contacts: &[Touch]) -> Begun<M> {
        not_touching(contacts)?;
        if approach.coordinates == Coordinates::Maximal {
            return in_maximal(mechanism, approach, &self.0, y);
        }
        let (x, closing, approach) = in_joints(mechanism, approach, y)?;
        if approach.integrator.is_implicit() {
            let method = Rodas4::new(&x, mechanism.jacobian_buffers().jacobian);
            return Ok(adaptive(Joint, method, closing, &approach, &x));
        }
        Ok(explicit(Joint, closing, &approach, &x))
    }

    fn offers(&self) -> Offers {
        Offers::ALL
    }

    fn smallest_pivot(&self, mechanism: &M, t: f64, y: &M::State) -> Option<f64> {
        Some(pivots::smallest(mechanism, t, y))
    }

    fn joint_layout<'a>(&self, mechanism: &'a M) -> Option<&'a JointLayout<'a>> {
        Some(mechanism.joint_layout())
    }

    fn linearise(&self, mechanism: &M, at: &OperatingPoint<'_, M::State>) -> Option<Linear> {
        by_jacobian(mechanism, &self.0, at)
    }
}

/// The joint state of a maximal one, its loops closed, what closes them and when.
pub(super) fn in_joints<M: JointSpace<Scalar: Real>>(
    mechanism: &M,
    approach: &Approach,
    y: &M::State,
) -> Result<(M::Joints, CloseLoops<M>, Approach), String> {
    let (mut x, mut closing) = (joints(mechanism, y), CloseLoops::new(mechanism));
    let layout = mechanism.joint_layout();
    let in_words = |error| describe_in(mechanism, Some(layout), error);
    closing.correct(mechanism, Scalar::constant(0.0), &mut x).map_err(in_words)?;
    let has_loops = !layout.closure_rows.is_empty();
    let correction =
        if has_loops && approach.correction != Keeping::None { Keeping::Partition } else { Keeping::None };
    let when = approach.when.or(Some(When::Steps(1)));
    Ok((x, closing, Approach { correction, when, ..*approach }))
}

fn only_maximal(approach: &Approach) -> Result<(), String> {
    match approach.coordinates {
        Coordinates::Maximal => Ok(()),
        Coordinates::Joint => {
            Err("joint coordinates are for generated code of mechanisms that have them".to_owned())
        }
    }
}

fn only_explicit(approach: &Approach) -> Result<(), String> {
    if approach.integrator.is_implicit() {
        return Err("rodas4 needs derivatives, which only generated code has".to_owned());
    }
    Ok(())
}

pub(super) fn square<T>(state: &[T]) -> usize {
    state.len() * state.len()
}

/// Maximal coordinates of mechanisms that have joint coordinates too.
fn in_maximal<M, D>(mechanism: &M, approach: &Approach, duals: &D, y: &M::State) -> Begun<M>
where
    M: Maximal + JointSpace + 'static,
    D: Dynamics<Scalar = Dual<M::Scalar, COLUMNS>> + Clone + 'static,
{
    let correction = match approach.correction {
        Keeping::ClosedForm => Boxed(Box::new(ClosedForm::new(mechanism))),
        _ => keeping(mechanism, approach, y)?,
    };
    if approach.integrator.is_implicit() {
        return Ok(implicit(approach, duals.clone(), correction, y));
    }
    Ok(maximal(approach, correction, y))
}

/// Explicit methods in maximal coordinates.
fn maximal<M>(approach: &Approach, correction: Boxed<M>, y: &M::State) -> Box<dyn Motion<M>>
where
    M: Maximal + 'static,
{
    let slopes = match approach.correction {
        // The projection is as good as it is only with accelerations that are exact off the constraints.
        Keeping::None | Keeping::MassWeighted => Slopes::of(Exact),
        Keeping::Baumgarte(rate) => Slopes::of(Baumgarte { rate: M::Scalar::constant(rate) }),
        _ => Slopes::of(Corrected),
    };
    explicit(slopes, correction, approach, y)
}

/// Rodas in maximal coordinates.
pub(super) fn implicit<M, D>(
    approach: &Approach,
    duals: D,
    correction: Boxed<M>,
    y: &M::State,
) -> Box<dyn Motion<M>>
where
    M: Partition<Scalar: Real> + Dynamics + 'static,
    D: Dynamics<Scalar = Dual<M::Scalar, COLUMNS>> + Clone + 'static,
{
    let method = Rodas4::new(y, vec![M::Scalar::constant(0.0); square(y.as_ref())]);
    let start = duals.start();
    adaptive(ByDuals::new(Exact, duals, start), method, correction, approach, y)
}
