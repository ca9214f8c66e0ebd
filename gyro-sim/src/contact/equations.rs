//! Equations of motion with contacts in their phases.

use super::small::solve;
use super::{Contact, Phase};
use crate::{Clearance, Correction, Error, Ode, Real};
use core::ops::Range;

/// Equations under forces along the coordinates of contacts. Accelerations are affine in the forces; positions' slopes
/// do not depend on them.
pub trait Forced<M = ()>: Ode<M> {
    /// Where the rates stand in the state.
    fn rates(&self, model: &M) -> Range<usize>;
    /// Writes `f(t, y)` under these forces, one for each contact, besides all else that acts: N along a length, N m
    /// along an angle.
    fn forced(
        &self,
        model: &M,
        t: Self::Scalar,
        y: &Self::State,
        forces: &[Self::Scalar],
        dy: &mut Self::State,
    );
}

/// Equations with contacts.
#[derive(Clone, Debug)]
pub struct Contacts<D, T, const N: usize> {
    pub(super) dynamics: D,
    pub(super) contacts: [Contact<T>; N],
    pub(super) phases: [Phase; N],
}

/// Accelerations of the contacts' coordinates: without forces of contacts, and what unit forces add, row by row.
pub(super) struct Local<T, const N: usize> {
    pub(super) bias: [T; N],
    pub(super) compliance: [[T; N]; N],
}

/// So large a force that nothing else counts beside it: what it adds is a unit force's times it, to rounding. A power
/// of two.
pub(super) const LARGE: f64 = 1_099_511_627_776.0;

impl<D, T: Real, const N: usize> Contacts<D, T, N> {
    /// The forces of friction on what moves.
    pub(super) fn kinetic_forces(&self) -> [T; N] {
        core::array::from_fn(|k| match self.phases[k] {
            Phase::Up => -self.contacts[k].levels[0],
            Phase::Down => self.contacts[k].levels[0],
            _ => T::constant(0.0),
        })
    }

    /// The accelerations at a state and what forces along these of the coordinates add.
    pub(super) fn local<M>(
        &self,
        model: &M,
        (t, y): (T, &D::State),
        chosen: &[bool; N],
        scratch: &mut D::State,
    ) -> Local<T, N>
    where
        D: Forced<M, Scalar = T>,
    {
        let zero = T::constant(0.0);
        let mut forces = [zero; N];
        self.dynamics.forced(model, t, y, &forces, scratch);
        let rates = self.contacts.map(|contact| contact.rate);
        let bias = rates.map(|rate| scratch.as_ref()[rate]);
        let mut compliance = [[zero; N]; N];
        for k in (0..N).filter(|k| chosen[*k]) {
            forces[k] = T::constant(LARGE);
            self.dynamics.forced(model, t, y, &forces, scratch);
            forces[k] = zero;
            for (i, rate) in rates.into_iter().enumerate() {
                compliance[i][k] = (scratch.as_ref()[rate] - bias[i]) / T::constant(LARGE);
            }
        }
        Local { bias, compliance }
    }

    /// The forces of all contacts in their present phases.
    pub(super) fn forces<M>(&self, model: &M, (t, y): (T, &D::State), scratch: &mut D::State) -> [T; N]
    where
        D: Forced<M, Scalar = T>,
    {
        let kinetic = self.kinetic_forces();
        let held = self.phases.map(Phase::is_held);
        if !held.contains(&true) {
            return kinetic;
        }
        let rubbing = core::array::from_fn(|k| held[k] || self.contacts[k].levels[0] > T::constant(0.0));
        self.local(model, (t, y), &rubbing, scratch).balance(&held, &kinetic)
    }
}

impl<T: Real, const N: usize> Local<T, N> {
    /// The accelerations of the coordinates under these forces.
    pub(super) fn accelerations(&self, forces: &[T; N]) -> [T; N] {
        core::array::from_fn(|i| {
            self.compliance[i].iter().zip(forces).fold(self.bias[i], |sum, (w, force)| sum + *w * *force)
        })
    }

    /// All forces, those of what is held such that it is not accelerated.
    pub(super) fn balance(&self, held: &[bool; N], others: &[T; N]) -> [T; N] {
        let zero = T::constant(0.0);
        let others = core::array::from_fn(|k| if held[k] { zero } else { others[k] });
        let right = self.accelerations(&others).map(|a| -a);
        let found = solve(&self.compliance, &right, held);
        core::array::from_fn(|k| if held[k] { found[k] } else { others[k] })
    }
}

impl<M, D, T: Real, const N: usize> Ode<M> for Contacts<D, T, N>
where
    D: Forced<M, Scalar = T>,
{
    type Scalar = T;
    type State = D::State;

    fn derivative(&self, model: &M, t: T, y: &D::State, dy: &mut D::State) {
        let forces = self.forces(model, (t, y), dy);
        self.dynamics.forced(model, t, y, &forces, dy);
        for (contact, phase) in self.contacts.iter().zip(self.phases) {
            if phase.is_held() {
                let dy = dy.as_mut();
                (dy[contact.coordinate], dy[contact.rate]) = (T::constant(0.0), T::constant(0.0));
            }
        }
    }
}

/// A correction of the equations without contacts.
#[derive(Clone, Debug)]
pub struct Kept<C>(pub C);

impl<M, D, C, T: Real, const N: usize> Correction<Contacts<D, T, N>, M> for Kept<C>
where
    D: Forced<M, Scalar = T>,
    C: Correction<D, M>,
{
    fn correct(&mut self, model: &M, t: T, y: &mut D::State) -> Result<(), Error> {
        self.0.correct(model, t, y)
    }
    fn refer_turns(&mut self, model: &M, t: T, y: &mut D::State) {
        self.0.refer_turns(model, t, y);
    }
    fn violation(&mut self, model: &M, t: T, y: &D::State) -> T {
        self.0.violation(model, t, y)
    }
    fn switches(&self) -> u64 {
        self.0.switches()
    }
    fn clearance(&self, model: &M, t: T, y: &D::State) -> Option<Clearance<T>> {
        self.0.clearance(model, t, y)
    }
}

/// Between which bounds the force on a held coordinate is.
pub(super) fn bounds<T: Real>(contact: &Contact<T>, phase: Phase) -> [T; 2] {
    let (level, infinite) = (contact.levels[1], T::constant(f64::INFINITY));
    match phase {
        Phase::AtLower => [-level, infinite],
        Phase::AtUpper => [-infinite, level],
        _ => [-level, level],
    }
}
