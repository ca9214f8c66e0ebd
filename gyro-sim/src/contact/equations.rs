//! Equations of motion with contacts in their phases.

use super::loads::{Acting, Growth, Jam, Loads, size};
use super::small::{at, plus_product, solve, spread};
use super::{Contact, Phase, Role};
use crate::{Ode, Real};
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
    /// Whether there may be contacts of which the system tells all, or many.
    const HAS_SURFACES: bool = false;
    /// Whether coordinates of contacts may depend on each other, as those of a loop's joints do, or are too many to try
    /// all combinations of what they do.
    fn shares(&self, _model: &M) -> bool {
        false
    }
    /// Writes value, rate and acceleration of these contacts under these forces: of a coordinate
    /// ([`Contact::seen`]), or of two surfaces ([`Contact::surfaces`]) a gap, m, and the velocities of slip, m/s,
    /// whose values are zero. What forces do is dual to that: the power of a force is its product with the rate.
    fn seen(
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
    /// Of surfaces that slide: the components of the direction in which they did, or begin to.
    pub(super) ways: [T; N],
    /// Where they are not faster than this, their direction is for the most part that in which they did.
    pub(super) vague: [T; N],
    /// How fast surfaces slid at the end of the last step, m/s.
    pub(super) paces: [T; N],
    /// How forces of surfaces that touch at several points were divided among these when phases were chosen: where
    /// accelerations leave that open, it stays so.
    pub(super) split: [T; N],
    /// What is at the bound of its friction and does not move, as others hold it: its force stays.
    pub(super) spent: [bool; N],
    /// By how much friction of surfaces that stick may be beyond its bound: more where it is at its bound while nothing
    /// slips, as between bodies that slide down together.
    pub(super) slack: [T; N],
    /// Slower than this nothing slips, m/s; what is no faster than that is tried to be held, m/s; and no force counts
    /// that is smaller than the last, N.
    pub(super) slowest: T,
    pub(super) creep: T,
    pub(super) weakest: T,
    /// Friction that may jam where the equations were evaluated.
    pub(super) jam: Cell<Option<Jam>>,
}

/// Accelerations of the contacts' coordinates: without forces of contacts, and what unit forces add, row by row.
pub(super) struct Local<T, const N: usize> {
    /// The contacts' rates.
    pub(super) rates: [T; N],
    pub(super) bias: [T; N],
    pub(super) compliance: [[T; N]; N],
}

/// So large a force that nothing else counts beside it: what it adds is a unit force's times it, to rounding. A power
/// of two.
pub(super) const LARGE: f64 = 1_099_511_627_776.0;

impl<D, T: Real, const N: usize> Contacts<D, T, N> {
    pub(super) fn new(dynamics: D, contacts: [Contact<T>; N]) -> Self {
        let (phases, zero) = ([Phase::Free; N], T::constant(0.0));
        let [ways, vague, paces, split, slack] = [[zero; N]; 5];
        let [largest, slowest, creep, weakest] = [zero; 4];
        Self {
            dynamics,
            contacts,
            phases,
            largest,
            ways,
            vague,
            paces,
            split,
            spent: [false; N],
            slack,
            slowest,
            creep,
            weakest,
            jam: Cell::new(None),
        }
    }

    /// The equations without contacts.
    pub fn dynamics(&self) -> &D {
        &self.dynamics
    }

    /// Whether the system tells of any contact.
    fn is_told<M>(&self) -> bool
    where
        D: Forced<M, Scalar = T>,
    {
        D::HAS_SURFACES && self.contacts.iter().any(|contact| matches!(contact.role, Role::Gap | Role::Seen))
    }

    /// Whether forces are found by iteration, as they may depend on each other: no combinations are tried.
    pub(super) fn iterates<M>(&self, model: &M) -> bool
    where
        D: Forced<M, Scalar = T>,
    {
        D::HAS_SURFACES && (self.is_told::<M>() || self.dynamics.shares(model))
    }

    /// Whether a coordinate does not move by one bit.
    pub(super) fn is_pinned(&self, k: usize) -> bool {
        self.phases[k].is_held() && self.contacts[k].role == Role::Coordinate && !self.spent[k]
    }

    /// Value and rate of each contact.
    pub(super) fn places<M>(&self, model: &M, (t, y): (T, &D::State)) -> [[T; 2]; N]
    where
        D: Forced<M, Scalar = T>,
    {
        let seen = self.seen(model, (t, y), &[T::constant(0.0); N]);
        from_fn(|k| self.place(k, y.as_ref(), &seen))
    }

    fn place(&self, k: usize, y: &[T], seen: &[[T; 3]; N]) -> [T; 2] {
        let contact = &self.contacts[k];
        match contact.role {
            Role::Coordinate => [at(y, contact.coordinate), at(y, contact.rate)],
            Role::Seen | Role::Gap | Role::Slip { .. } => [seen[k][0], seen[k][1]],
        }
    }

    fn seen<M>(&self, model: &M, (t, y): (T, &D::State), forces: &[T; N]) -> [[T; 3]; N]
    where
        D: Forced<M, Scalar = T>,
    {
        let mut seen = [[T::constant(0.0); 3]; N];
        if self.is_told::<M>() {
            self.dynamics.seen(model, t, y, forces, &mut seen);
        }
        seen
    }

    /// The contacts' rates and accelerations under these forces.
    fn moving<M>(
        &self,
        model: &M,
        (t, y): (T, &D::State),
        forces: &[T; N],
        scratch: &mut D::State,
    ) -> [[T; 2]; N]
    where
        D: Forced<M, Scalar = T>,
    {
        let seen = self.seen(model, (t, y), forces);
        let is_coordinate = |contact: &Contact<T>| contact.role == Role::Coordinate && contact.acts();
        if !self.is_told::<M>() || self.contacts.iter().any(is_coordinate) {
            self.dynamics.accelerations(model, t, y, forces, scratch);
        }
        from_fn(|k| {
            let (contact, [_, rate]) = (&self.contacts[k], self.place(k, y.as_ref(), &seen));
            match contact.role {
                Role::Coordinate => [rate, at(scratch.as_ref(), contact.rate)],
                Role::Seen | Role::Gap | Role::Slip { .. } => [rate, seen[k][2]],
            }
        })
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
        let moving = self.moving(model, (t, y), &forces, scratch);
        let [rates, bias] = [0, 1].map(|which| moving.map(|moving| moving[which]));
        let mut compliance = [[zero; N]; N];
        for k in (0..N).filter(|k| chosen[*k]) {
            forces[k] = T::constant(LARGE);
            let pushed = self.moving(model, (t, y), &forces, scratch);
            forces[k] = zero;
            for i in 0..N {
                compliance[i][k] = (pushed[i][1] - bias[i]) / T::constant(LARGE);
            }
        }
        Local { rates, bias, compliance }
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
    pub(super) fn acting(
        &self,
        local: &Local<T, N>,
        loads: Option<&Loads<T, N>>,
        is_shared: bool,
    ) -> Acting<T, N> {
        let is_held = self.phases.map(Phase::is_held);
        let held = from_fn(|k| is_held[k] && !self.spent[k]);
        let pulls = self.pulls(&local.rates);
        let with_friction;
        let compliance = if self.phases.contains(&Phase::Slides) {
            with_friction = self.with_friction(&local.compliance, &pulls);
            &with_friction
        } else {
            &local.compliance
        };
        let mut forces = from_fn(|k| if is_held[k] { self.split[k] } else { T::constant(0.0) });
        for (force, kinetic) in forces.iter_mut().zip(self.kinetic_forces()) {
            *force = *force + kinetic;
        }
        self.rub(&mut forces, &pulls);
        let right = local.accelerations(&forces).map(|a| -a);
        let solve = |right: &[T; N]| match is_shared {
            true => spread(compliance, right, &held),
            false => solve(compliance, right, &held),
        };
        let change = solve(&right);
        forces = from_fn(|k| if held[k] { forces[k] + change[k] } else { forces[k] });
        self.rub(&mut forces, &pulls);
        let Some(loads) = loads else {
            return Acting { levels: self.levels(&forces, None), forces, jam: None };
        };
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
                response = solve(&from_fn(|i| -way * local.compliance[i][j]));
                response[j] = way;
                self.rub(&mut response, &pulls);
            }
            response
        });
        let slopes = from_fn(|k| from_fn(|j| loads.along(k, &responses[j])));
        match (Growth { coefficients: grows, loads: loads.at(&forces), slopes }).magnitudes() {
            Err(jam) => Acting { levels: self.levels(&forces, None), forces, jam: Some(jam) },
            Ok(magnitudes) => {
                let forces =
                    from_fn(|i| (0..N).fold(forces[i], |force, j| force + responses[j][i] * magnitudes[j]));
                Acting { levels: self.levels(&forces, Some(loads)), forces, jam: None }
            }
        }
    }

    /// The static levels of friction.
    pub(super) fn levels(&self, forces: &[T; N], loads: Option<&Loads<T, N>>) -> [T; N] {
        from_fn(|k| {
            let contact = &self.contacts[k];
            match (contact.slip(), loads) {
                (Some((gap, _)), _) => contact.coefficients[1] * at(forces, gap),
                (None, Some(loads)) if contact.is_loaded() => {
                    contact.levels[1] + contact.coefficients[1] * size(&loads.at_one(k, forces))
                }
                (None, _) => contact.levels[1],
            }
        })
    }

    /// Friction of surfaces that slide, for a push of one.
    pub(super) fn pulls(&self, rates: &[T; N]) -> [T; N] {
        let zero = T::constant(0.0);
        from_fn(|k| {
            let (contact, phase) = (&self.contacts[k], self.phases[k]);
            let Some((gap, is_second)) = contact.slip().filter(|_| phase == Phase::Slides) else {
                return zero;
            };
            let pair = [gap + 1, gap + 2];
            let (slip, was) = (pair.map(|slip| at(rates, slip)), pair.map(|slip| at(&self.ways, slip)));
            let [along, across] = from_fn(|i| slip[i] + self.vague[k] * was[i]);
            let speed = (along * along + across * across).sqrt();
            let way =
                if speed > zero { (if is_second { across } else { along }) / speed } else { self.ways[k] };
            -contact.coefficients[0] * way
        })
    }

    /// What pushes do together with the friction that they cause.
    pub(super) fn with_friction(&self, compliance: &[[T; N]; N], pulls: &[T; N]) -> [[T; N]; N] {
        let mut with = *compliance;
        for (k, contact) in self.contacts.iter().enumerate() {
            if let Some((gap, _)) =
                contact.slip().filter(|(gap, _)| *gap < N && self.phases[k] == Phase::Slides)
            {
                for row in &mut with {
                    row[gap] = row[gap] + pulls[k] * row[k];
                }
            }
        }
        with
    }

    /// Sets the friction of surfaces that slide.
    fn rub(&self, forces: &mut [T; N], pulls: &[T; N]) {
        for (k, contact) in self.contacts.iter().enumerate() {
            if let Some((gap, _)) = contact.slip().filter(|_| self.phases[k] == Phase::Slides) {
                forces[k] = pulls[k] * at(forces, gap);
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
            held[k]
                || contact.levels[0] > zero
                || (contact.coefficients[0] > zero && self.phases[k] != Phase::Free)
        });
        let local = match held.contains(&true) {
            true => self.local(model, (t, y), &rubbing, scratch),
            false => Local { rates: [zero; N], bias: [zero; N], compliance: [[zero; N]; N] },
        };
        let acting = self.acting(&local, self.loads(model, (t, y), &rubbing).as_ref(), self.iterates(model));
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
        plus_product(&self.bias, &self.compliance, forces)
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
