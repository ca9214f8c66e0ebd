//! What happens at the end of a step: impacts, rest, sticking, letting go.

use super::equations::{Contacts, Forced};
use super::guards::{Guards, guards, size};
use super::resolve::{Hit, impulses, work};
use super::small::{at, larger, set};
use super::{Contact, Error, Phase, Role};
use crate::Real;

/// A rebound slower than this part of the fastest impact is none.
const SLOWEST: f64 = 1e-12;
/// After so many events without a step between them nothing is held that does not stay.
const PATIENCE: u32 = 8;
/// What slips by less than this part of the fastest rate is tried to be held.
const CREEP: f64 = 1e-8;
/// What is solved of impacts may be off by this part of that.
const SOLVED: f64 = 1e-2;

/// What contacts have done so far.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Record<T> {
    /// Stops that were hit.
    pub impacts: u64,
    /// Coordinates that came to rest on a stop because rebounds had become too slow: see the
    /// [module](super#what-is-solved-when-phases-change).
    pub settled: u64,
    /// Coordinates that friction has caught.
    pub caught: u64,
    /// Coordinates that were let go by stops, or by friction.
    pub released: u64,
    /// What impacts have taken of the kinetic energy, J.
    pub lost: T,
}

/// What a contact has done at an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Change<T> {
    /// The rates before and after an impact on a stop.
    pub hit: Option<[T; 2]>,
    /// The phases before and after.
    pub phases: [Phase; 2],
}

/// An event: when, as a fraction of the step, and which guard, by kind and contact.
#[derive(Clone, Copy, Debug)]
pub(super) struct Next<T> {
    pub(super) theta: T,
    pub(super) kind: usize,
    pub(super) contact: usize,
}

/// What contacts have done, as far as it says what they do next.
#[derive(Clone, Debug)]
pub(super) struct Ledger<T, const N: usize> {
    /// The fastest impact on each contact.
    fastest: [T; N],
    /// The rates at the beginning of a step of fixed length whose end is to be decided.
    began: Option<[T; N]>,
    /// The rates before something driven made them jump, and the length of the last step.
    pub(super) jumped: Option<([T; N], T)>,
    pub(super) record: Record<T>,
    /// At the last event.
    pub(super) changes: [Change<T>; N],
    /// How many events have come without a step between them.
    pub(super) stalled: u32,
}

/// A stop that is hit, rested on or touched, and whether it is the upper one.
type Touched<T> = Option<(Hit<T>, bool)>;

impl<T: Real, const N: usize> Ledger<T, N> {
    pub(super) fn new() -> Self {
        let zero = T::constant(0.0);
        Self {
            fastest: [zero; N],
            began: None,
            jumped: None,
            record: Record { impacts: 0, settled: 0, caught: 0, released: 0, lost: zero },
            changes: [Change { hit: None, phases: [Phase::Free; 2] }; N],
            stalled: 0,
        }
    }

    /// A step of fixed length begins.
    pub(super) fn begin(&mut self, rates: [T; N]) {
        self.began = Some(rates);
    }

    /// It has ended, and nothing has happened in it.
    pub(super) fn pass(&mut self) {
        self.began = None;
    }

    /// Impacts, rates that friction has brought to zero, and the phases after them: at an event, at which a step that
    /// had a length ends, or at the end of a step of fixed length.
    ///
    /// # Errors
    /// [`Error::Jammed`] if no phases are consistent.
    pub(super) fn settle<M, D>(
        &mut self,
        equations: &mut Contacts<D, T, N>,
        (model, t): (&M, T),
        y: &mut D::State,
        next: Option<(&Next<T>, T)>,
        scratch: &mut [D::State; 2],
    ) -> Result<(), Error>
    where
        D: Forced<M, Scalar = T>,
    {
        let zero = T::constant(0.0);
        let Guards(guards) = guards(equations, model, (t, y), &mut scratch[1]);
        let places = equations.places(model, (t, y));
        let size = size(y.as_ref().iter().take(equations.dynamics.rates(model).start));
        let (contacts, phases) = (equations.contacts, equations.phases);
        let jumped = self.jumped.take();
        let length = next.map(|(_, h)| h).or(jumped.map(|(_, h)| h));
        let is_due = |kind: usize, k: usize| {
            guards[kind][k] <= zero
                || next.is_some_and(|(next, _)| next.kind == kind && next.contact == k)
                || length.is_some_and(|h| is_as_good_as_reached(phases[k], places[k], guards[kind][k], h))
                || (matches!(contacts[k].role, Role::Gap | Role::Seen)
                    && kind < 2
                    && guards[kind][k] <= rounding(size))
        };
        let at_lower: [bool; N] = core::array::from_fn(|k| !phases[k].is_held() && is_due(0, k));
        let at_upper: [bool; N] = core::array::from_fn(|k| !phases[k].is_held() && is_due(1, k));
        let reached: [bool; N] =
            core::array::from_fn(|k| phases[k].is_held() && (is_due(0, k) || is_due(1, k)));
        if equations.iterates(model) {
            let fastest = fastest(y.as_ref(), &places) + length.map_or(zero, |h| equations.largest * h);
            equations.slowest = larger(equations.slowest, rounding(fastest));
            equations.creep = larger(equations.slowest, T::constant(CREEP) * fastest);
        }
        // Friction that has brought a coordinate to rest; a jump is none of its doing.
        for (k, contact) in contacts.iter().enumerate() {
            let moves = jumped.is_none() && matches!(phases[k], Phase::Up | Phase::Down);
            let is_it = next.is_some_and(|(next, _)| next.kind == 2 && next.contact == k);
            // Others come to rest with it where they move together, to rounding.
            if moves
                && (is_it || guards[2][k] < zero || at(y.as_ref(), contact.rate).abs() <= equations.slowest)
            {
                set(y.as_mut(), contact.rate, zero);
            }
        }
        // Surfaces that slide are brought to rest where their velocity has no other component.
        let caught: [bool; N] = core::array::from_fn(|k| {
            let is_it = next.is_some_and(|(next, _)| next.kind == 2 && next.contact == k);
            let moves = match contacts[k].role {
                Role::Seen => matches!(phases[k], Phase::Up | Phase::Down),
                _ => phases[k] == Phase::Slides,
            };
            let stops = is_it || guards[2][k] < zero;
            let is_slow = contacts[k].role == Role::Seen && places[k][1].abs() <= equations.slowest;
            jumped.is_none() && moves && (stops || is_slow)
        });
        // What has rested on a stop does not hit it.
        let before: [T; N] = core::array::from_fn(|k| match (contacts[k].role, jumped) {
            (Role::Coordinate, Some((rates, _))) if rates[k] == zero => zero,
            (Role::Coordinate, _) => at(y.as_ref(), contacts[k].rate),
            (_, Some(_)) if phases[k].is_held() => zero,
            _ => places[k][1],
        });
        let touched = [&at_lower, &at_upper];
        let hits = self.hits(equations, (y.as_mut(), &before, size), touched, next.map(|(next, _)| next));
        let chosen = if equations.iterates(model) {
            self.touch(equations, (model, t), y, (&hits, [&caught, &reached], next.is_none()), scratch)
        } else {
            self.collide(equations, (model, t), y, &hits, scratch);
            equations.choose(model, (t, y), &reached, &mut scratch[0])
        };
        let after = equations.places(model, (t, y));
        self.note(&phases, &equations.phases, |k| {
            // What leaves its stop and is taken back to it has not hit another one.
            let is_hit = |(_, is_upper)| if is_upper { before[k] > zero } else { before[k] < zero };
            hits[k].is_some_and(is_hit).then(|| [before[k], after[k][1]])
        });
        self.began = None;
        chosen
    }

    /// The same where surfaces touch, whose friction has impulses: impacts; then what rests neither parts nor slips,
    /// and the phases after that. At the end of a step of fixed length what has passed through is set back.
    fn touch<M, D>(
        &mut self,
        equations: &mut Contacts<D, T, N>,
        (model, t): (&M, T),
        y: &mut D::State,
        (hits, [caught, reached], is_late): (&[Touched<T>; N], [&[bool; N]; 2], bool),
        scratch: &mut [D::State; 2],
    ) -> Result<(), Error>
    where
        D: Forced<M, Scalar = T>,
    {
        let zero = T::constant(0.0);
        let contacts = equations.contacts;
        let mut impulses = [zero; N];
        let rates = equations.places(model, (t, y)).map(|[_, rate]| rate);
        let slowest = equations.slowest;
        let solved = larger(slowest, T::constant(SOLVED) * equations.creep);
        if (0..N).any(|k| hits[k].is_some_and(|(hit, _)| hit.outward * rates[k] < -slowest)) {
            let meets = |k: usize| contacts.get(k).is_some_and(|_| hits[k].is_some());
            let chosen = core::array::from_fn(|k| match contacts[k].slip() {
                Some((gap, _)) => contacts[k].acts() && meets(gap),
                None => meets(k),
            });
            let local = equations.local(model, (t, y), &chosen, &mut scratch[0]);
            let outcome = equations
                .struck(&local, &hits.map(|hit| hit.map(|(hit, _)| hit)))
                .map_err(|jam| equations.jammed(t, &jam))?;
            self.record.lost = self.record.lost - work(&outcome, &local.rates);
            let met = (0..N).filter(|k| chosen[*k]).map(|k| local.bias[k].abs());
            equations.largest = met.fold(equations.largest, larger);
            let [base, pushed] = scratch;
            equations.push(model, (t, y), &outcome.0, [base, pushed]);
            impulses = outcome.0;
        }
        let places = equations.places(model, (t, y));
        let mut rests = [false; N];
        for (k, (contact, hit)) in contacts.iter().zip(hits).enumerate() {
            let Some((Hit { outward, .. }, is_upper)) = *hit else { continue };
            let (push, rate) = (outward * impulses[k], outward * places[k][1]);
            // What leaves again and again, as at the edge of a face, is let go.
            let is_gone = self.stalled > PATIENCE && reached[k] && contact.role == Role::Gap;
            rests[k] = !is_gone && rate.abs() <= if push > zero { solved } else { slowest };
            if contact.role == Role::Coordinate && (rests[k] || rate < zero) {
                set(y.as_mut(), contact.rate, zero);
                set(y.as_mut(), contact.coordinate, contact.ends[usize::from(is_upper)]);
            }
        }
        let still: [bool; N] = core::array::from_fn(|k| {
            contacts[k].slip().is_some_and(|(gap, _)| {
                let [along, across] =
                    [gap + 1, gap + 2].map(|slip| places.get(slip).map_or(zero, |place| place[1]));
                let speed = (along * along + across * across).sqrt();
                let is_caught = caught.get(gap + 1).is_some_and(|caught| *caught);
                let is_slow = speed <= slowest + slowest
                    || (is_caught && (is_late || speed <= larger(equations.vague[k], equations.creep)));
                rests.get(gap).is_some_and(|rests| *rests) && is_slow
            })
        });
        let held = core::array::from_fn(|k| match contacts[k].role {
            Role::Coordinate => equations.phases[k].is_held() || rests[k],
            Role::Seen => equations.phases[k] == Phase::Sticks || rests[k] || caught[k],
            Role::Gap => rests[k],
            Role::Slip { .. } => still[k] && contacts[k].acts(),
        });
        let ends = core::array::from_fn(|k| match hits[k] {
            Some((_, is_upper)) if rests[k] => contacts[k].ends[usize::from(is_upper)],
            _ => T::constant(f64::NAN),
        });
        equations.hold(model, (t, y), (&held, &ends), scratch);
        // What is brought to rest with it rests.
        for contact in contacts.iter().filter(|contact| contact.role == Role::Coordinate && contact.rubs()) {
            if at(y.as_ref(), contact.rate).abs() <= slowest {
                set(y.as_mut(), contact.rate, zero);
            }
        }
        equations.choose_surfaces(model, (t, y), [&rests, &still, reached], &mut scratch[0])
    }

    /// The stops that are hit, those that are rested on and those that are touched.
    fn hits<D>(
        &mut self,
        Contacts { contacts, phases, largest, .. }: &Contacts<D, T, N>,
        (y, rates, size): (&mut [T], &[T; N], T),
        [at_lower, at_upper]: [&[bool; N]; 2],
        next: Option<&Next<T>>,
    ) -> [Touched<T>; N] {
        let (zero, one) = (T::constant(0.0), T::constant(1.0));
        core::array::from_fn(|k| {
            let (outward, is_upper) = match phases[k] {
                Phase::AtLower => (one, false),
                Phase::AtUpper => (-one, true),
                _ if at_lower[k] => (one, false),
                _ if at_upper[k] => (-one, true),
                _ => return None,
            };
            let Contact { restitution, coordinate, ends, .. } = contacts[k];
            let (approach, end) = (-outward * rates[k], ends[usize::from(is_upper)]);
            // Steps of fixed length end beyond.
            if next.is_none() && (at(y, coordinate) - end) * outward < zero {
                set(y, coordinate, end);
            }
            let record = &mut self.record;
            if approach < zero {
                // A flight that is too short to be told from none is taken back; another stop that is touched is not
                // to be passed.
                let is_own = next.is_some_and(|next| next.kind < 2 && next.contact == k);
                let is_taken_back = self.stalled > 0 && is_own;
                record.settled += u64::from(is_taken_back);
                let outward = if is_taken_back { -outward } else { outward };
                return Some((Hit { outward, rebound: zero }, is_upper));
            }
            let fastest = &mut self.fastest[k];
            *fastest = if approach > *fastest { approach } else { *fastest };
            let restitution =
                restitution * self.began.map_or(one, |began| share(-outward * began[k], approach));
            let rebound = restitution * approach;
            // A gap that rounding hides is none.
            let hidden = match contacts[k].role {
                Role::Gap | Role::Seen => (T::constant(2.0) * *largest * rounding(size)).sqrt(),
                _ => zero,
            };
            let is_slow = rebound <= larger(T::constant(SLOWEST) * *fastest, hidden);
            record.settled += u64::from(is_slow && approach > zero && contacts[k].restitution > zero);
            record.impacts += u64::from(approach > zero);
            let rebound = if is_slow { zero } else { rebound };
            Some((Hit { outward, rebound }, is_upper))
        })
    }

    /// Resolves the impacts of coordinates that have reached a stop.
    fn collide<M, D>(
        &mut self,
        equations: &Contacts<D, T, N>,
        (model, t): (&M, T),
        y: &mut D::State,
        hits: &[Touched<T>; N],
        [base, pushed]: &mut [D::State; 2],
    ) where
        D: Forced<M, Scalar = T>,
    {
        let zero = T::constant(0.0);
        let contacts = &equations.contacts;
        let rates = contacts.map(|contact| at(y.as_ref(), contact.rate));
        let mut after = rates;
        if hits.iter().zip(rates).any(|(hit, rate)| hit.is_some() && rate != zero) {
            let local = equations.local(model, (t, y), &hits.map(|hit| hit.is_some()), base);
            let outcome = impulses(&local.compliance, &rates, &hits.map(|hit| hit.map(|(hit, _)| hit)));
            self.record.lost = self.record.lost - work(&outcome, &rates);
            equations.push(model, (t, y), &outcome.0, [base, pushed]);
            after = outcome.1;
        }
        for ((contact, hit), after) in contacts.iter().zip(hits).zip(after) {
            let Some((Hit { outward, .. }, is_upper)) = hit else { continue };
            // Beside fast coordinates what is slow may be left by rounding to go on through its stop.
            let after = if *outward * after < zero { zero } else { after };
            set(y.as_mut(), contact.rate, after);
            // What rests is on the stop, to the last bit.
            if after == zero {
                set(y.as_mut(), contact.coordinate, contact.ends[usize::from(*is_upper)]);
            }
        }
    }

    fn note(&mut self, before: &[Phase; N], now: &[Phase; N], hit: impl Fn(usize) -> Option<[T; 2]>) {
        self.changes = core::array::from_fn(|k| Change { hit: hit(k), phases: [before[k], now[k]] });
        for (before, now) in before.iter().zip(now) {
            self.record.released += u64::from(before.is_held() && !now.is_held());
            self.record.caught += u64::from(!before.is_held() && *now == Phase::Sticks);
        }
    }
}

/// What counts of the rate of an impact that a step has passed: the lesser of those at its beginning and its end. So a
/// stop that is found late gives no energy, and flights shorter than a step are none.
fn share<T: Real>(began: T, ended: T) -> T {
    let zero = T::constant(0.0);
    if began >= ended {
        T::constant(1.0)
    } else if began > zero {
        began / ended
    } else {
        zero
    }
}

/// Whether a coordinate is so near a stop that the time to it is rounding.
fn is_as_good_as_reached<T: Real>(phase: Phase, [place, rate]: [T; 2], gap: T, h: T) -> bool {
    !phase.is_held() && gap.abs() <= rounding(rate.abs() * h + place.abs())
}

/// Some roundings of a number of this size.
pub(super) fn rounding<T: Real>(size: T) -> T {
    T::constant(64.0) * T::EPSILON * size
}

/// The fastest rate of a state, and of contacts.
fn fastest<T: Real, const N: usize>(y: &[T], places: &[[T; 2]; N]) -> T {
    places.iter().fold(size(y.iter()), |most, [_, rate]| larger(most, rate.abs()))
}
