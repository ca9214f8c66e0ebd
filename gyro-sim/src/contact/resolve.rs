//! Impacts, and which phases follow an event.

use super::equations::{Contacts, Forced, LARGE, Local, bounds};
use super::loads::{Acting, Jam, Loads};
use super::small::{at, not_below_rounding, solve};
use super::{Contact, Error, Phase};
use crate::Real;

/// Inequalities may be violated by this part of what stands in them: they are computed from roots that are rounded.
pub(super) const ROUNDING: f64 = 1e-10;
/// More than this part means that there is no solution.
pub(super) const UNMET: f64 = 1e-6;

/// A stop that is hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hit<T> {
    /// The direction away from the stop: 1 or −1.
    pub(super) outward: T,
    /// The rate at which it is left, at least.
    pub(super) rebound: T,
}

/// The impulses on the stops that are hit, and on those that are rested on; and the rates after them.
pub(super) fn impulses<T: Real, const N: usize>(
    compliance: &[[T; N]; N],
    rates: &[T; N],
    hits: &[Option<Hit<T>>; N],
) -> ([T; N], [T; N]) {
    let (mut hits, zero) = (*hits, T::constant(0.0));
    let (is_met, outcome) = by_newton(compliance, rates, &hits);
    if is_met && work(&outcome, rates) <= zero {
        return outcome;
    }
    // The impulses without rebound are a projection of the rates, which only takes energy.
    for hit in hits.iter_mut().flatten() {
        hit.rebound = zero;
    }
    by_newton(compliance, rates, &hits).1
}

/// What impulses add to the kinetic energy.
pub(super) fn work<T: Real, const N: usize>((impulses, after): &([T; N], [T; N]), before: &[T; N]) -> T {
    let half = T::constant(0.5);
    (0..N).fold(T::constant(0.0), |sum, k| sum + half * impulses[k] * (after[k] + before[k]))
}

/// The impulses that violate the inequalities least, and whether that is rounding.
fn by_newton<T: Real, const N: usize>(
    compliance: &[[T; N]; N],
    rates: &[T; N],
    hits: &[Option<Hit<T>>; N],
) -> (bool, ([T; N], [T; N])) {
    let zero = T::constant(0.0);
    let target = |k: usize| hits[k].map_or(zero, |hit| hit.outward * hit.rebound);
    let right = core::array::from_fn(|k| target(k) - rates[k]);
    let rebounds = hits.iter().flatten().map(|hit| hit.rebound);
    let scale = rates
        .iter()
        .copied()
        .chain(rebounds)
        .fold(zero, |most, rate| if rate.abs() > most { rate.abs() } else { most });
    let [rounding, unmet] = [ROUNDING, UNMET].map(not_below_rounding::<T>);
    let mut best: Option<(T, [T; N], [T; N])> = None;
    let n = hits.iter().flatten().count();
    for combination in 0..1_u32 << n {
        let mut place = 0;
        let active = hits.map(|hit| {
            place += u32::from(hit.is_some());
            // Those that hold most stops come first.
            hit.is_some() && combination >> (place - 1) & 1 == 0
        });
        let impulses = solve(compliance, &right, &active);
        let after: [T; N] = core::array::from_fn(|i| {
            compliance[i].iter().zip(&impulses).fold(rates[i], |sum, (w, impulse)| sum + *w * *impulse)
        });
        let mut worst = zero;
        for k in 0..N {
            let Some(hit) = hits[k] else { continue };
            let pull = -hit.outward * impulses[k] * compliance[k][k];
            let short = hit.outward * (target(k) - after[k]);
            for violation in [pull, short] {
                worst = if violation > worst { violation } else { worst };
            }
        }
        if best.is_none_or(|(least, ..)| worst < least) {
            // What the stops determine is exactly that.
            let is_met = |k: usize| (after[k] - target(k)).abs() <= rounding * scale;
            let after = core::array::from_fn(|k| if active[k] && is_met(k) { target(k) } else { after[k] });
            best = Some((worst, impulses, after));
        }
        if worst <= rounding * scale {
            break;
        }
    }
    let (worst, impulses, after) = best.unwrap_or((zero, [zero; N], *rates));
    (worst <= unmet * scale, (impulses, after))
}

/// What a coordinate at rest may do, in the order in which it is tried.
type Options = ([Phase; 3], usize);

fn options<T: Real>(contact: &Contact<T>, x: T, is_reached: bool) -> Options {
    let (at_lower, at_upper) = (x <= contact.ends[0], x >= contact.ends[1]);
    let (up, down) = if contact.rubs() { (Phase::Up, Phase::Down) } else { (Phase::Free, Phase::Free) };
    match (at_lower, at_upper, is_reached) {
        (true, _, false) => ([Phase::AtLower, up, up], 2),
        (true, _, true) => ([up, Phase::AtLower, up], 2),
        (_, true, false) => ([Phase::AtUpper, down, down], 2),
        (_, true, true) => ([down, Phase::AtUpper, down], 2),
        (_, _, false) => ([Phase::Sticks, up, down], 3),
        (_, _, true) => ([up, down, Phase::Sticks], 3),
    }
}

impl<D, T: Real, const N: usize> Contacts<D, T, N> {
    /// The phases that are consistent with a state; the bounds of some have just been reached.
    ///
    /// # Errors
    /// [`Error::Jammed`] if none are.
    pub(super) fn choose<M>(
        &mut self,
        model: &M,
        (t, y): (T, &D::State),
        reached: &[bool; N],
        scratch: &mut D::State,
    ) -> Result<(), Error>
    where
        D: Forced<M, Scalar = T>,
    {
        let zero = T::constant(0.0);
        let values = y.as_ref();
        let options: [Options; N] = core::array::from_fn(|k| {
            let contact = &self.contacts[k];
            let (x, rate) = (at(values, contact.coordinate), at(values, contact.rate));
            let is_stopped = x <= contact.ends[0] || x >= contact.ends[1];
            if rate == zero && (contact.rubs() || is_stopped) {
                return options(contact, x, reached[k]);
            }
            let phase = match contact.rubs() {
                false => Phase::Free,
                true if rate > zero => Phase::Up,
                true => Phase::Down,
            };
            ([phase; 3], 1)
        });
        if options.iter().all(|(_, n)| *n == 1) {
            self.phases = options.map(|(phases, _)| phases[0]);
            return Ok(());
        }
        let acting = self.contacts.map(|contact| contact.acts());
        let local = self.local(model, (t, y), &acting, scratch);
        let loads = self.loads(model, (t, y), &acting);
        let scale = self.scale(&local, loads.as_ref());
        self.largest = if scale > self.largest { scale } else { self.largest };
        let (scale, [rounding, unmet]) = (self.largest, [ROUNDING, UNMET].map(not_below_rounding::<T>));
        let mut best: Option<(T, [Phase; N])> = None;
        let mut jam = None;
        let mut choice = [0; N];
        loop {
            self.phases = core::array::from_fn(|k| {
                let ([first, ..], _) = options[k];
                options[k].0.get(choice[k]).copied().unwrap_or(first)
            });
            let acting = self.acting(&local, loads.as_ref(), false);
            jam = jam.or(acting.jam);
            let violation = match acting.jam {
                Some(_) => T::constant(f64::INFINITY),
                None => self.violation(&local, &acting, &options, values),
            };
            if best.is_none_or(|(least, _)| violation < least) {
                best = Some((violation, self.phases));
            }
            let is_consistent = violation <= rounding * scale;
            if is_consistent || !next(&mut choice, &options.map(|(_, n)| n)) {
                break;
            }
        }
        let (violation, phases) = best.unwrap_or((zero, self.phases));
        self.phases = phases;
        if violation <= unmet * scale {
            return Ok(());
        }
        let first = options.iter().position(|(_, n)| *n > 1).unwrap_or(0);
        Err(self.jammed(t, &jam.unwrap_or(Jam { contact: first, gain: 0.0 })))
    }

    /// Friction that may jam, or phases none of which are consistent, as an error.
    pub(super) fn jammed(&self, t: T, jam: &Jam) -> Error {
        let index = self.contacts.get(jam.contact).and_then(|contact| u16::try_from(contact.coordinate).ok());
        Error::Jammed { t: t.to_f64(), index: index.unwrap_or(u16::MAX), gain: jam.gain }
    }

    /// The size of the accelerations that are compared.
    fn scale(&self, local: &Local<T, N>, loads: Option<&Loads<T, N>>) -> T {
        let sizes = loads.map_or([T::constant(0.0); N], Loads::sizes);
        (0..N).fold(T::constant(0.0), |sum, k| {
            let Contact { levels, coefficients, .. } = self.contacts[k];
            let level = levels[1] + coefficients[1] * sizes[k];
            sum + local.bias[k].abs() + local.compliance[k][k] * level
        })
    }

    /// By how much the present phases are inconsistent, as an acceleration.
    fn violation(
        &self,
        local: &Local<T, N>,
        Acting { forces, levels, .. }: &Acting<T, N>,
        options: &[Options; N],
        values: &[T],
    ) -> T {
        let zero = T::constant(0.0);
        let accelerations = local.accelerations(forces);
        let mut worst = zero;
        for k in (0..N).filter(|k| options[*k].1 > 1) {
            let contact = &self.contacts[k];
            let [low, high] = bounds(levels[k], self.phases[k]);
            let is_at_upper = at(values, contact.coordinate) >= contact.ends[1];
            let violation = match self.phases[k] {
                phase if phase.is_held() => {
                    // Where the others determine a coordinate's acceleration, as in a loop's dead centre, its own
                    // compliance is rounding, of either sign.
                    let compliance = local.compliance[k][k].abs();
                    let moves = accelerations[k].abs();
                    let beyond = [(low - forces[k]) * compliance, (forces[k] - high) * compliance];
                    beyond.into_iter().fold(moves, |most, x| if x > most { x } else { most })
                }
                Phase::Down => accelerations[k],
                Phase::Free if is_at_upper => accelerations[k],
                _ => -accelerations[k],
            };
            worst = if violation > worst { violation } else { worst };
        }
        worst
    }

    /// Adds what an impulse along a contact changes of all rates, and the work that drivers do meanwhile.
    pub(super) fn push<M>(
        &self,
        model: &M,
        (t, y): (T, &mut D::State),
        impulses: &[T; N],
        scratch: [&mut D::State; 2],
    ) where
        D: Forced<M, Scalar = T>,
    {
        let zero = T::constant(0.0);
        let [base, pushed] = scratch;
        let mut forces = [zero; N];
        self.dynamics.forced(model, t, y, &forces, base);
        // At the rates before all impulses: accelerations depend on rates, but what a force adds does not.
        let before = y.clone();
        let places = self.places(model, (t, &before));
        for k in (0..N).filter(|k| impulses[*k] != zero) {
            forces[k] = T::constant(LARGE);
            self.dynamics.forced(model, t, &before, &forces, pushed);
            forces[k] = zero;
            let part = impulses[k] / T::constant(LARGE);
            let own = self.dynamics.rates(model);
            let changes = pushed.as_ref().iter().zip(base.as_ref()).map(|(pushed, base)| *pushed - *base);
            for (y, change) in y.as_mut().iter_mut().zip(changes).take(own.end).skip(own.start) {
                *y = T::fused(change, part, *y);
            }
            if let Some(place) = self.dynamics.work(model)
                && let Some(work) = y.as_mut().get_mut(place)
            {
                // Less the power of the force itself: that is what the impact takes.
                let own = T::constant(LARGE) * places[k][1];
                let change = at(pushed.as_ref(), place) - at(base.as_ref(), place) - own;
                *work = T::fused(change, part, *work);
            }
        }
    }
}

/// The next of all combinations; the first contact changes first.
fn next<const N: usize>(choice: &mut [usize; N], counts: &[usize; N]) -> bool {
    for (choice, count) in choice.iter_mut().zip(counts) {
        *choice += 1;
        if *choice < *count {
            return true;
        }
        *choice = 0;
    }
    false
}
