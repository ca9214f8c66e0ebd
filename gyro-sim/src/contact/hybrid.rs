//! The motion: steps, and what happens at their ends.

use super::equations::{Contacts, Forced, Kept};
use super::guards::{Guards, guards, noise, passed};
use super::resolve::{Hit, impulses, work};
use super::{Contact, Phase};
use crate::contract::Storage;
use crate::events::{Found, first_falling};
use crate::integrate::Method;
use crate::solver::Mark;
use crate::{Control, Correction, Error, Real, Solver, Statistics, Uncorrected};

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

/// A motion with contacts, by any method that is explicit.
#[derive(Clone, Debug)]
pub struct Hybrid<D, S, T, A, C, const N: usize> {
    solver: Solver<Contacts<D, T, N>, S, T, A, Kept<C>>,
    mark: Mark<S, T>,
    scratch: [S; 2],
    /// The fastest impact on each contact.
    fastest: [T; N],
    record: Record<T>,
    is_begun: bool,
    /// How many events have come without a step between them.
    stalled: u32,
}

/// A rebound slower than this part of the fastest impact is none.
const SLOWEST: f64 = 1e-12;
/// So many events without a step between them mean that there is no consistent way on.
const MOST_STALLED: u32 = 64;
/// The end of a step is brought to an event by so many further steps at most.
const POLISHES: u32 = 3;

/// An event: when, as a fraction of the step, which guards, by kind and contact, and the slope there by the fraction.
struct Next<T> {
    theta: T,
    kind: usize,
    contact: usize,
}

impl<D, S: Storage<T>, T: Real, A, const N: usize> Hybrid<D, S, T, A, Uncorrected, N> {
    /// A motion that starts at `y` at time `t`, without corrections.
    pub fn new(dynamics: D, contacts: [Contact<T>; N], method: A, t: T, y: &S) -> Self {
        Self::with_correction(dynamics, contacts, method, Uncorrected, t, y)
    }
}

impl<D, S: Storage<T>, T: Real, A, C, const N: usize> Hybrid<D, S, T, A, C, N> {
    /// A motion that starts at `y` at time `t` and is corrected.
    pub fn with_correction(
        dynamics: D,
        contacts: [Contact<T>; N],
        method: A,
        correction: C,
        t: T,
        y: &S,
    ) -> Self {
        let equations = Contacts { dynamics, contacts, phases: [Phase::Free; N] };
        let zero = T::constant(0.0);
        Self {
            solver: Solver::with_correction(equations, method, Kept(correction), t, y),
            mark: Mark::new(t, y),
            scratch: [y.clone(), y.clone()],
            fastest: [zero; N],
            record: Record { impacts: 0, settled: 0, caught: 0, released: 0, lost: zero },
            is_begun: false,
            stalled: 0,
        }
    }

    /// Replaces the control settings.
    #[must_use]
    pub fn with_control(mut self, control: Control) -> Self {
        self.solver = self.solver.with_control(control);
        self
    }

    /// The time, s.
    pub fn time(&self) -> T {
        self.solver.time()
    }

    /// The state.
    pub fn state(&self) -> &S {
        self.solver.state()
    }

    /// What each contact does.
    pub fn phases(&self) -> &[Phase; N] {
        &self.solver.dynamics().phases
    }

    /// What contacts have done so far.
    pub fn record(&self) -> &Record<T> {
        &self.record
    }

    /// Statistics of the steps so far; those that an event cut short count as rejected.
    pub fn statistics(&self) -> &Statistics {
        self.solver.statistics()
    }

    /// Replaces the state; which contacts hold is decided anew.
    pub fn set_state(&mut self, y: &S) {
        self.solver.set_state(y);
        self.is_begun = false;
    }

    /// To be called when the model has changed: which contacts hold is decided anew.
    pub fn system_has_changed(&mut self) {
        self.solver.system_has_changed();
        self.is_begun = false;
    }

    /// The forces of the contacts on their coordinates, in the positive direction: reactions and friction.
    pub fn forces<M>(&mut self, model: &M) -> [T; N]
    where
        D: Forced<M, Scalar = T, State = S>,
    {
        let at = (self.solver.time(), self.solver.state());
        self.solver.dynamics().forces(model, at, &mut self.scratch[0])
    }

    /// Goes on until `t_end`, through all events on the way.
    ///
    /// # Errors
    /// [`Error`] of the solver; [`Error::StepTooShort`] if events follow each other without time between them.
    pub fn advance_to<M>(&mut self, model: &M, t_end: T) -> Result<(), Error>
    where
        D: Forced<M, Scalar = T, State = S>,
        A: Method<Contacts<D, T, N>, M>,
        C: Correction<D, M>,
    {
        while self.time() < t_end {
            self.step_towards(model, t_end)?;
        }
        Ok(())
    }

    /// One step under error control, not beyond `t_end` nor the next event; returns whether it has ended at one.
    ///
    /// # Errors
    /// As [`Hybrid::advance_to`].
    pub fn step_towards<M>(&mut self, model: &M, t_end: T) -> Result<bool, Error>
    where
        D: Forced<M, Scalar = T, State = S>,
        A: Method<Contacts<D, T, N>, M>,
        C: Correction<D, M>,
    {
        self.begin(model);
        self.solver.mark(&mut self.mark);
        self.solver.step_towards(model, t_end)?;
        self.pin();
        let h = self.solver.last_step();
        let Some(next) = self.find(model)? else {
            self.stalled = 0;
            return Ok(false);
        };
        self.stalled = if next.theta > T::constant(0.0) { 0 } else { self.stalled + 1 };
        if self.stalled > MOST_STALLED {
            return Err(Error::StepTooShort { t: self.mark.time().to_f64(), step: 0.0, index: 0 });
        }
        self.end_at(model, h, &next)?;
        self.settle(model, Some((&next, h)));
        Ok(true)
    }

    /// One step of length `h`; what has happened in it is decided at its end.
    ///
    /// # Errors
    /// [`Error`] of the solver, with state and time as they were before.
    pub fn step<M>(&mut self, model: &M, h: T) -> Result<(), Error>
    where
        D: Forced<M, Scalar = T, State = S>,
        A: Method<Contacts<D, T, N>, M>,
        C: Correction<D, M>,
    {
        self.begin(model);
        self.solver.mark(&mut self.mark);
        self.solver.step(model, h)?;
        self.pin();
        let guards = self.guards(model);
        if guards.as_ref().iter().any(|guard| *guard < T::constant(0.0)) {
            self.settle(model, None);
        }
        Ok(())
    }

    fn begin<M>(&mut self, model: &M)
    where
        D: Forced<M, Scalar = T, State = S>,
    {
        if !self.is_begun {
            self.is_begun = true;
            self.settle(model, None);
        }
    }

    /// Closing loops moves all coordinates by rounding, but not those that are held.
    fn pin(&mut self) {
        let (contacts, phases) = (self.solver.dynamics().contacts, self.solver.dynamics().phases);
        for (contact, phase) in contacts.iter().zip(phases) {
            if phase.is_held() {
                self.solver.pin(&self.mark, contact.coordinate);
                self.solver.pin(&self.mark, contact.rate);
            }
        }
    }

    fn guards<M>(&mut self, model: &M) -> Guards<T, N>
    where
        D: Forced<M, Scalar = T, State = S>,
    {
        let (t, y) = (self.solver.time(), self.solver.state());
        guards(self.solver.dynamics(), model, (t, y), &mut self.scratch[1])
    }

    /// The first event within the last step.
    fn find<M>(&mut self, model: &M) -> Result<Option<Next<T>>, Error>
    where
        D: Forced<M, Scalar = T, State = S>,
        A: Method<Contacts<D, T, N>, M>,
        C: Correction<D, M>,
    {
        let zero = T::constant(0.0);
        let contacts = self.solver.dynamics().contacts;
        let solver = &mut self.solver;
        let [y, scratch] = &mut self.scratch;
        let mut values = |theta: T| {
            let t = solver.within(model, theta, y)?;
            Ok::<_, Error>(guards(solver.dynamics(), model, (t, y), scratch))
        };
        let begin = values(zero)?.0;
        let first = first_falling(&mut values)?;
        let mut first =
            first.map(|Found { event, theta, .. }| Next { theta, kind: event / N, contact: event % N });
        // Guards that begin at zero have been passed by no crossing.
        for (kind, contact) in (0..3).flat_map(|kind| (0..N).map(move |contact| (kind, contact))) {
            if begin[kind][contact] <= zero {
                let value = |theta: T| Ok(values(theta)?.0[kind][contact]);
                let noise = noise(&contacts[contact], kind, begin[kind][contact]);
                if let Some(theta) = passed(value, noise)?
                    && first.as_ref().is_none_or(|next| theta < next.theta)
                {
                    first = Some(Next { theta, kind, contact });
                }
            }
        }
        Ok(first)
    }

    /// Takes the last step again, up to an event: by the method, whose states are better than what it interpolates.
    fn end_at<M>(&mut self, model: &M, h: T, next: &Next<T>) -> Result<(), Error>
    where
        D: Forced<M, Scalar = T, State = S>,
        A: Method<Contacts<D, T, N>, M>,
        C: Correction<D, M>,
    {
        let (zero, mut length) = (T::constant(0.0), next.theta * h);
        if length <= zero {
            self.solver.rewind(&self.mark);
            return Ok(());
        }
        // By the secant, from what the guard is a little before.
        let before = length * T::constant(1.0 - 1.0 / 64.0);
        let mut last = (before, self.guard_after(model, before, next)?);
        let mut value = self.guard_after(model, length, next)?;
        for _ in 0..POLISHES {
            let change = value * (length - last.0) / (value - last.1);
            let is_better = change.is_finite() && change.abs() < T::constant(0.1) * length;
            if value == zero || !is_better || change.abs() <= T::EPSILON * length {
                break;
            }
            last = (length, value);
            length = length - change;
            value = self.guard_after(model, length, next)?;
        }
        if value.abs() > last.1.abs() {
            self.guard_after(model, last.0, next)?;
        }
        Ok(())
    }

    /// Takes a step from the mark, and returns a guard at its end.
    fn guard_after<M>(&mut self, model: &M, h: T, next: &Next<T>) -> Result<T, Error>
    where
        D: Forced<M, Scalar = T, State = S>,
        A: Method<Contacts<D, T, N>, M>,
        C: Correction<D, M>,
    {
        self.solver.rewind(&self.mark);
        self.solver.step(model, h)?;
        self.pin();
        Ok(self.guards(model).0[next.kind][next.contact])
    }

    /// Impacts, rates that friction has brought to zero, and the phases after them.
    fn settle<M>(&mut self, model: &M, next: Option<(&Next<T>, T)>)
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
        let hits = self.hits(&mut y, [&at_lower, &at_upper], next.map(|(next, _)| next));
        self.collide(model, &mut y, &hits);
        let t = self.solver.time();
        self.solver.dynamics_mut().choose(model, (t, &y), &reached, &mut self.scratch[0]);
        self.solver.set_state(&y);
        self.solver.system_has_changed();
        self.count(&phases);
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

    fn count(&mut self, before: &[Phase; N]) {
        for (before, now) in before.iter().zip(self.solver.dynamics().phases) {
            self.record.released += u64::from(before.is_held() && !now.is_held());
            self.record.caught += u64::from(!before.is_held() && now == Phase::Sticks);
        }
    }
}
