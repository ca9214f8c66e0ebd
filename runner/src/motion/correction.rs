//! Corrections of whatever maximal system is integrated, as one type.

use super::contract::Maximal;
use super::lens::Slopes;
use crate::approach::{Approach, Correction as Keeping};
use gyro_sim::{
    Clearance, Correction, Dynamics, Error, Exact, Kinematics, MassWeighted, Mechanism, Ode, Partition,
    Partitioning, Projection, Real, Scalar, Watched,
};

/// Boxed corrections, so that integrators are not compiled anew for each.
pub(super) trait Keeps<M: Mechanism> {
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error>;
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar;
    fn switches(&self) -> u64;
}

/// Those that admit any equations.
impl<M: Mechanism + 'static, C: Correction<Slopes<M>, M>> Keeps<M> for C {
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        Correction::<Slopes<M>, M>::correct(self, mechanism, t, y)
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar {
        Correction::<Slopes<M>, M>::violation(self, mechanism, t, y)
    }
    fn switches(&self) -> u64 {
        Correction::<Slopes<M>, M>::switches(self)
    }
}

/// The projection that the masses weigh. `keeping` is asked for it with exact equations alone.
struct Weighted<M: Mechanism>(MassWeighted<M>);

impl<M> Correction<Slopes<M>, M> for Weighted<M>
where
    M: Partition<Scalar: Real> + Kinematics + Projection + Dynamics + 'static,
{
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        self.0.correct(mechanism, t, y)
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar {
        Correction::<Exact, M>::violation(&mut self.0, mechanism, t, y)
    }
}

pub(super) struct Boxed<M: Mechanism>(pub(super) Box<dyn Keeps<M>>);

impl<M, D> Correction<D, M> for Boxed<M>
where
    M: Partition<Scalar: Real>,
    D: Ode<M, Scalar = M::Scalar, State = M::State>,
{
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        self.0.correct(mechanism, t, y)
    }
    fn refer_turns(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) {
        gyro_sim::keep_turns(mechanism, t, y);
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar {
        self.0.violation(mechanism, t, y)
    }
    fn switches(&self) -> u64 {
        self.0.switches()
    }
    fn clearance(&self, mechanism: &M, t: M::Scalar, y: &M::State) -> Option<Clearance<M::Scalar>> {
        mechanism.clearance(t, y)
    }
}

pub(super) fn keeping<M>(mechanism: &M, approach: &Approach, y: &M::State) -> Result<Boxed<M>, String>
where
    M: Maximal + 'static,
{
    match approach.correction {
        Keeping::Partition => Ok(partitioning(mechanism, y)),
        Keeping::MassWeighted => Ok(weighted(mechanism)),
        Keeping::None | Keeping::Baumgarte(_) => Ok(watched(mechanism)),
        Keeping::ClosedForm => Err("the closed form is for generated code with joint coordinates".to_owned()),
    }
}

pub(super) fn partitioning<M: Partition<Scalar: Real> + 'static>(mechanism: &M, y: &M::State) -> Boxed<M> {
    Boxed(Box::new(Partitioning::new(mechanism, Scalar::constant(0.0), y)))
}

/// The projection that the masses weigh.
pub(super) fn weighted<M>(mechanism: &M) -> Boxed<M>
where
    M: Partition<Scalar: Real> + Kinematics + Projection + Dynamics + 'static,
{
    Boxed(Box::new(Weighted(MassWeighted::new(mechanism))))
}

/// No correction.
pub(super) fn watched<M: Partition<Scalar: Real> + 'static>(mechanism: &M) -> Boxed<M> {
    Boxed(Box::new(Watched::new(mechanism)))
}
