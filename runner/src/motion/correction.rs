//! Corrections of whatever maximal system is integrated, as one type.

use crate::approach::{Approach, Correction as Keeping};
use gyro_sim::{
    Clearance, Correction, Equations, Error, Exact, MassWeighted, Mechanism, Ode, Partition, Partitioning,
    Real, Scalar, Watched,
};

/// Boxed corrections, so that integrators are not compiled anew for each.
pub(super) trait Keeps<M: Mechanism> {
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error>;
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar;
    fn switches(&self) -> u64;
}

/// All of them admit exact equations, and those that `maximal` chooses for them.
impl<M: Mechanism, C: Correction<Exact, M>> Keeps<M> for C {
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        Correction::<Exact, M>::correct(self, mechanism, t, y)
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar {
        Correction::<Exact, M>::violation(self, mechanism, t, y)
    }
    fn switches(&self) -> u64 {
        Correction::<Exact, M>::switches(self)
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
        gyro_sim::refer_turns(mechanism, t, y);
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
    M: Partition<Scalar: Real> + Equations + 'static,
{
    Ok(Boxed(match approach.correction {
        Keeping::Partition => return Ok(partitioning(mechanism, y)),
        Keeping::MassWeighted => Box::new(MassWeighted::new(mechanism)),
        Keeping::None | Keeping::Baumgarte(_) => Box::new(Watched::new(mechanism)),
        Keeping::ClosedForm => {
            return Err("the closed form is for generated code with joint coordinates".to_owned());
        }
    }))
}

pub(super) fn partitioning<M: Partition<Scalar: Real> + 'static>(mechanism: &M, y: &M::State) -> Boxed<M> {
    Boxed(Box::new(Partitioning::new(mechanism, Scalar::constant(0.0), y)))
}
