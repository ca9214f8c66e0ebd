//! What happens at the end of a step: impacts, rest, sticking, letting go.

use super::equations::{Contacts, Forced};
use super::guards::Guards;
use super::hybrid::{Change, Hybrid, Next};
use super::resolve::{Hit, impulses, work};
use super::{Contact, Phase};
use crate::Real;
use crate::contract::Storage;

/// A rebound slower than this part of the fastest impact is none.
const SLOWEST: f64 = 1e-12;

impl<D, S: Storage<T>, T: Real, A, C, const N: usize> Hybrid<D, S, T, A, C, N> {
    /// Impacts, rates that friction has brought to zero, and the phases after them.
    pub(super) fn settle<M>(&mut self, model: &M, next: Option<(&Next<T>, T)>)
    where
        D: Forced<M, Scalar = T, State = S>,
    {
        let zero = T::constant(0.0);
        let Guards(guards) = self.guards(model);
        let mut y = self.solver.state().clone();
        let phases = self.solver.dynamics().phases;
        let contacts = self.solver.dynamics().contacts;
        let is_due = |kind: usize, k: usize| {
            guards[kind][k] <= zero
                || next.is_some_and(|(next, h)| {
                    let is_it = next.kind == kind && next.contact == k;
                    is_it || self.is_as_good_as_reached(&contacts[k], phases[k], guards[kind][k], h)
                })
        };
        let at_lower: [bool; N] = core::array::from_fn(|k| !phases[k].is_held() && is_due(0, k));
        let at_upper: [bool; N] = core::array::from_fn(|k| !phases[k].is_held() && is_due(1, k));
        let reached: [bool; N] =
            core::array::from_fn(|k| phases[k].is_held() && (is_due(0, k) || is_due(1, k)));
        // Friction that has brought a coordinate to rest.
        for (k, contact) in contacts.iter().enumerate() {
            let moves = matches!(phases[k], Phase::Up | Phase::Down);
            let is_it = next.is_some_and(|(next, _)| next.kind == 2 && next.contact == k);
            if moves && (is_it || guards[2][k] < zero) {
                y.as_mut()[contact.rate] = zero;
            }
        }
        let before = contacts.map(|contact| y.as_ref()[contact.rate]);
        let hits = self.hits(&mut y, [&at_lower, &at_upper], next.map(|(next, _)| next));
        self.collide(model, &mut y, &hits);
        let t = self.solver.time();
        let chosen = self.solver.dynamics_mut().choose(model, (t, &y), &reached, &mut self.scratch[0]);
        self.failure = chosen.err();
        self.solver.set_state(&y);
        self.solver.system_has_changed();
        self.note(&phases, |k| {
            let is_hit = hits[k].is_some_and(|(hit, _)| hit.outward * before[k] < zero);
            is_hit.then(|| [before[k], y.as_ref()[contacts[k].rate]])
        });
    }

    /// Whether a coordinate is so near a stop that the time to it is rounding.
    fn is_as_good_as_reached(&self, contact: &Contact<T>, phase: Phase, gap: T, h: T) -> bool {
        let rate = self.solver.state().as_ref()[contact.rate].abs();
        let place = self.solver.state().as_ref()[contact.coordinate].abs();
        !phase.is_held() && gap.abs() <= T::constant(64.0) * T::EPSILON * (rate * h + place)
    }

    /// The stops that are hit, those that are rested on and those that are touched; and which end each is.
    fn hits(
        &mut self,
        y: &mut S,
        [at_lower, at_upper]: [&[bool; N]; 2],
        next: Option<&Next<T>>,
    ) -> [Option<(Hit<T>, usize)>; N] {
        let (zero, one) = (T::constant(0.0), T::constant(1.0));
        let Contacts { contacts, phases, .. } = self.solver.dynamics();
        core::array::from_fn(|k| {
            let (outward, end) = match phases[k] {
                Phase::AtLower => (one, 0),
                Phase::AtUpper => (-one, 1),
                _ if at_lower[k] => (one, 0),
                _ if at_upper[k] => (-one, 1),
                _ => return None,
            };
            let Contact { restitution, coordinate, rate, ends, .. } = contacts[k];
            let approach = -outward * y.as_ref()[rate];
            let (x, record) = (&mut y.as_mut()[coordinate], &mut self.record);
            // Steps of fixed length end beyond.
            if next.is_none() && (*x - ends[end]) * outward < zero {
                *x = ends[end];
            }
            if approach < zero {
                // A flight that is too short to be told from none is taken back; another stop that is touched is not
                // to be passed.
                let is_own = next.is_some_and(|next| next.kind < 2 && next.contact == k);
                let is_taken_back = self.stalled > 0 && is_own;
                record.settled += u64::from(is_taken_back);
                let outward = if is_taken_back { -outward } else { outward };
                return Some((Hit { outward, restitution: zero }, end));
            }
            let fastest = &mut self.fastest[k];
            *fastest = if approach > *fastest { approach } else { *fastest };
            let is_slow = restitution * approach <= T::constant(SLOWEST) * *fastest;
            record.settled += u64::from(is_slow && approach > zero && restitution > zero);
            record.impacts += u64::from(approach > zero);
            Some((Hit { outward, restitution: if is_slow { zero } else { restitution } }, end))
        })
    }

    /// Resolves the impacts of coordinates that have reached a stop.
    fn collide<M>(&mut self, model: &M, y: &mut S, hits: &[Option<(Hit<T>, usize)>; N])
    where
        D: Forced<M, Scalar = T, State = S>,
    {
        let zero = T::constant(0.0);
        let equations = self.solver.dynamics();
        let contacts = &equations.contacts;
        let rates = contacts.map(|contact| y.as_ref()[contact.rate]);
        let mut after = rates;
        if hits.iter().zip(rates).any(|(hit, rate)| hit.is_some() && rate != zero) {
            let t = self.solver.time();
            let [base, pushed] = &mut self.scratch;
            let local = equations.local(model, (t, y), &hits.map(|hit| hit.is_some()), base);
            let outcome = impulses(&local.compliance, &rates, &hits.map(|hit| hit.map(|(hit, _)| hit)));
            self.record.lost = self.record.lost - work(&outcome, &rates);
            equations.push(model, (t, y), &outcome.0, [base, pushed]);
            after = outcome.1;
        }
        for ((contact, hit), after) in contacts.iter().zip(hits).zip(after) {
            let Some((_, end)) = hit else { continue };
            y.as_mut()[contact.rate] = after;
            // What rests is on the stop, to the last bit.
            if after == zero {
                y.as_mut()[contact.coordinate] = contact.ends[*end];
            }
        }
    }

    fn note(&mut self, before: &[Phase; N], hit: impl Fn(usize) -> Option<[T; 2]>) {
        let now = self.solver.dynamics().phases;
        self.changes = core::array::from_fn(|k| Change { hit: hit(k), phases: [before[k], now[k]] });
        for (before, now) in before.iter().zip(now) {
            self.record.released += u64::from(before.is_held() && !now.is_held());
            self.record.caught += u64::from(!before.is_held() && now == Phase::Sticks);
        }
    }
}
