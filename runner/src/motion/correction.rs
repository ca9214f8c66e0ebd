//! Corrections of whatever maximal system is integrated, as one type.

use crate::approach::{Approach, Correction as Keeping};
use gyro_sim::{
    Clearance, Correction, Error, MassWeighted, Maximal, Mechanism, Partition, Partitioning, Projection,
    Scalar, Watched,
};

/// Boxed corrections, so that integrators are not compiled anew for each.
pub(super) trait Keeps<M: Mechanism> {
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error>;
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar;
    fn switches(&self) -> u64;
}

impl<M: Mechanism, C: Correction<M>> Keeps<M> for C {
    fn correct(&mut self, mechanism: &M, t: M::Scalar, y: &mut M::State) -> Result<(), Error> {
        Correction::correct(self, mechanism, t, y)
    }
    fn violation(&mut self, mechanism: &M, t: M::Scalar, y: &M::State) -> M::Scalar {
        Correction::violation(self, mechanism, t, y)
    }
    fn switches(&self) -> u64 {
        Correction::switches(self)
    }
}

pub(super) struct Boxed<M: Mechanism>(pub(super) Box<dyn Keeps<M>>);

impl<M: Partition, O: Maximal<Mechanism = M, Scalar = M::Scalar, State = M::State>> Correction<O>
    for Boxed<M>
{
    fn correct(&mut self, system: &O, t: O::Scalar, y: &mut O::State) -> Result<(), Error> {
        self.0.correct(system.mechanism(), t, y)
    }
    fn refer_turns(&mut self, system: &O, t: O::Scalar, y: &mut O::State) {
        gyro_sim::refer_turns(system.mechanism(), t, y);
    }
    fn violation(&mut self, system: &O, t: O::Scalar, y: &O::State) -> O::Scalar {
        self.0.violation(system.mechanism(), t, y)
    }
    fn switches(&self) -> u64 {
        self.0.switches()
    }
    fn clearance(&self, system: &O, t: O::Scalar, y: &O::State) -> Option<Clearance<O::Scalar>> {
        system.mechanism().clearance(t, y)
    }
}

pub(super) fn keeping<M>(mechanism: &M, approach: &Approach, y: &M::State) -> Result<Boxed<M>, String>
where
    M: Partition + Projection + 'static,
{
    Ok(Boxed(match approach.correction {
        Keeping::Partition => return Ok(partitioning(mechanism, y)),
        Keeping::MassWeighted => Box::new(MassWeighted::new(mechanism)),
        Keeping::None | Keeping::Baumgarte(_) => Box::new(Watched::new(mechanism)),
        Keeping::ClosedForm => return Err("the closed form is for generated code of trees".to_owned()),
    }))
}

pub(super) fn partitioning<M: Partition + 'static>(mechanism: &M, y: &M::State) -> Boxed<M> {
    Boxed(Box::new(Partitioning::new(mechanism, Scalar::constant(0.0), y)))
}
