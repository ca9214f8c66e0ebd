//! Equations of motion with contacts in their phases.

use super::loads::{Acting, Growth, Jam, Loads, size};
use super::small::{at, set, solve};
use super::{Contact, Phase};
use crate::{Clearance, Correction, Error, Ode, Real};
use core::array::from_fn;
use core::cell::Cell;
use core::ops::Range;

/// Equations under forces along the coordinates of contacts. Accelerations are affine in the forces; positions' slopes
/// do not depend on them.
pub trait Forced<M = ()>: Ode<M> {
    /// Where the rates stand in the state.
    fn rates(&self, model: &M) -> Range<usize>;
    /// Where the work of all forces stands in the state, those of contacts and of what is driven included; `None` where
    /// it is not counted. An impact adds what it makes drivers do.
    fn work(&self, _model: &M) -> Option<usize> {
        None
    }
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
    /// The same, of which the slopes of the [rates](Forced::rates) alone are asked for: all else in `dy` may be
    /// anything.
    fn accelerations(
        &self,
        model: &M,
        t: Self::Scalar,
        y: &Self::State,
        forces: &[Self::Scalar],
        dy: &mut Self::State,
    ) {
        self.forced(model, t, y, forces, dy);
    }
    /// Whether friction may depend on reactions.
    const HAS_REACTIONS: bool = false;
    /// Writes for each contact the reaction, N, in the size of which its friction may grow: a vector that is affine in
    /// the forces. Zero for contacts without.
    fn reactions(
        &self,
        _model: &M,
        _t: Self::Scalar,
        _y: &Self::State,
        _forces: &[Self::Scalar],
        _out: &mut [[Self::Scalar; 3]],
    ) {
    }
}

/// Equations with contacts.
#[derive(Clone, Debug)]
pub struct Contacts<D, T, const N: usize> {
    pub(super) dynamics: D,
    pub(super) contacts: [Contact<T>; N],
    pub(super) phases: [Phase; N],
    /// The largest accelerations that were compared so far: a force that has come to its bound is no scale itself.
    pub(super) largest: T,
    /// Friction that may jam where the equations were evaluated.
    pub(super) jam: Cell<Option<Jam>>,
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
    pub(super) fn new(dynamics: D, contacts: [Contact<T>; N]) -> Self {
        let phases = [Phase::Free; N];
        Self { dynamics, contacts, phases, largest: T::constant(0.0), jam: Cell::new(None) }
    }

    /// The forces of friction on what moves.
    pub(super) fn kinetic_forces(&self) -> [T; N] {
        from_fn(|k| match self.phases[k] {
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
        self.dynamics.accelerations(model, t, y, &forces, scratch);
        let rates = self.contacts.map(|contact| contact.rate);
        let bias = rates.map(|rate| at(scratch.as_ref(), rate));
        let mut compliance = [[zero; N]; N];
        for k in (0..N).filter(|k| chosen[*k]) {
            forces[k] = T::constant(LARGE);
            self.dynamics.accelerations(model, t, y, &forces, scratch);
            forces[k] = zero;
            for (i, rate) in rates.into_iter().enumerate() {
                compliance[i][k] = (at(scratch.as_ref(), rate) - bias[i]) / T::constant(LARGE);
            }
        }
        Local { bias, compliance }
    }

    /// How reactions follow forces; `None` where no friction depends on them.
    pub(super) fn loads<M>(
        &self,
        model: &M,
        (t, y): (T, &D::State),
        chosen: &[bool; N],
    ) -> Option<Loads<T, N>>
    where
        D: Forced<M, Scalar = T>,
    {
        if !D::HAS_REACTIONS || !self.contacts.iter().any(Contact::is_loaded) {
            return None;
        }
        let zero = T::constant(0.0);
        let (mut forces, mut bias) = ([zero; N], [[zero; 3]; N]);
        self.dynamics.reactions(model, t, y, &forces, &mut bias);
        let mut slope = [[[zero; 3]; N]; N];
        for j in (0..N).filter(|j| chosen[*j]) {
            let mut loaded = bias;
            forces[j] = T::constant(LARGE);
            self.dynamics.reactions(model, t, y, &forces, &mut loaded);
            forces[j] = zero;
            for k in 0..N {
                slope[k][j] = from_fn(|i| (loaded[k][i] - bias[k][i]) / T::constant(LARGE));
            }
        }
        Some(Loads { bias, slope })
    }

    /// The forces of all contacts in their present phases, solved together: what is held is not accelerated, and
    /// friction on what moves has its level under the reactions that all forces make.
    pub(super) fn acting(&self, local: &Local<T, N>, loads: Option<&Loads<T, N>>) -> Acting<T, N> {
        let held = self.phases.map(Phase::is_held);
        let forces = local.balance(&held, &self.kinetic_forces());
        let levels = self.contacts.map(|contact| contact.levels[1]);
        let Some(loads) = loads else { return Acting { forces, levels, jam: None } };
        let [zero, one] = [0.0, 1.0].map(T::constant);
        let grows: [T; N] = from_fn(|k| match self.phases[k] {
            Phase::Up | Phase::Down => self.contacts[k].coefficients[0],
            _ => zero,
        });
        // What a unit of friction on a contact adds to all forces: its own, and what holds the others.
        let responses: [[T; N]; N] = from_fn(|j| {
            let mut response = [zero; N];
            if grows[j] > zero {
                let way = if self.phases[j] == Phase::Up { -one } else { one };
                response = solve(&local.compliance, &from_fn(|i| -way * local.compliance[i][j]), &held);
                response[j] = way;
            }
            response
        });
        let slopes = from_fn(|k| from_fn(|j| loads.along(k, &responses[j])));
        match (Growth { coefficients: grows, loads: loads.at(&forces), slopes }).magnitudes() {
            Err(jam) => Acting { forces, levels, jam: Some(jam) },
            Ok(magnitudes) => {
                let forces =
                    from_fn(|i| (0..N).fold(forces[i], |force, j| force + responses[j][i] * magnitudes[j]));
                let loads = loads.at(&forces);
                let levels = from_fn(|k| levels[k] + self.contacts[k].coefficients[1] * size(&loads[k]));
                Acting { forces, levels, jam: None }
            }
        }
    }

    /// The forces of all contacts in their present phases.
    pub(super) fn forces<M>(&self, model: &M, (t, y): (T, &D::State), scratch: &mut D::State) -> Acting<T, N>
    where
        D: Forced<M, Scalar = T>,
    {
        let zero = T::constant(0.0);
        let held = self.phases.map(Phase::is_held);
        let rubbing = from_fn(|k| {
            let contact = &self.contacts[k];
            held[k] || contact.levels[0] > zero || contact.coefficients[0] > zero
        });
        let local = match held.contains(&true) {
            true => self.local(model, (t, y), &rubbing, scratch),
            false => Local { bias: [zero; N], compliance: [[zero; N]; N] },
        };
        let acting = self.acting(&local, self.loads(model, (t, y), &rubbing).as_ref());
        // At later stages of a step that has met a jam nothing is finite any more.
        if acting.jam.is_some_and(|jam| jam.gain >= 1.0) {
            self.jam.set(acting.jam);
        }
        acting
    }
}

impl<T: Real, const N: usize> Local<T, N> {
    /// The accelerations of the coordinates under these forces.
    pub(super) fn accelerations(&self, forces: &[T; N]) -> [T; N] {
        from_fn(|i| {
            self.compliance[i].iter().zip(forces).fold(self.bias[i], |sum, (w, force)| sum + *w * *force)
        })
    }

    /// All forces, those of what is held such that it is not accelerated.
    pub(super) fn balance(&self, held: &[bool; N], others: &[T; N]) -> [T; N] {
        let zero = T::constant(0.0);
        let others = from_fn(|k| if held[k] { zero } else { others[k] });
        let right = self.accelerations(&others).map(|a| -a);
        let found = solve(&self.compliance, &right, held);
        from_fn(|k| if held[k] { found[k] } else { others[k] })
    }
}

impl<M, D, T: Real, const N: usize> Ode<M> for Contacts<D, T, N>
where
    D: Forced<M, Scalar = T>,
{
    type Scalar = T;
    type State = D::State;

    fn derivative(&self, model: &M, t: T, y: &D::State, dy: &mut D::State) {
        let Acting { forces, jam, .. } = self.forces(model, (t, y), dy);
        self.dynamics.forced(model, t, y, &forces, dy);
        if jam.is_some() {
            // No step is to go on from here.
            dy.as_mut().fill(T::constant(f64::NAN));
            return;
        }
        for (contact, phase) in self.contacts.iter().zip(self.phases) {
            if phase.is_held() {
                set(dy.as_mut(), contact.coordinate, T::constant(0.0));
                set(dy.as_mut(), contact.rate, T::constant(0.0));
            }
        }
    }

    fn normalise(&self, model: &M, y: &mut D::State) {
        self.dynamics.normalise(model, y);
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

/// Between which bounds the force on a held coordinate is, by the static level of its friction.
pub(super) fn bounds<T: Real>(level: T, phase: Phase) -> [T; 2] {
    let infinite = T::constant(f64::INFINITY);
    match phase {
        Phase::AtLower => [-level, infinite],
        Phase::AtUpper => [-infinite, level],
        _ => [-level, level],
    }
}
