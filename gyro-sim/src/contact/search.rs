//! The event at which a step ends.

use super::Error;
use super::equations::{Contacts, Forced};
use super::guards::{Guards, guards, noise, passed, size};
use super::hybrid::Hybrid;
use super::settle::Next;
use crate::contract::Storage;
use crate::events::{Found, first_falling};
use crate::integrate::Method;
use crate::{Correction, Real};

/// The end of a step is brought to an event by so many further steps at most.
const POLISHES: u32 = 3;

impl<D, S: Storage<T>, T: Real, A, C, const N: usize> Hybrid<D, S, T, A, C, N> {
    /// The first event within the last step.
    pub(super) fn find<M>(&mut self, model: &M) -> Result<Option<Next<T>>, Error>
    where
        D: Forced<M, Scalar = T, State = S>,
        A: Method<Contacts<D, T, N>, M>,
        C: Correction<D, M>,
    {
        let zero = T::constant(0.0);
        let contacts = self.solver.dynamics().contacts;
        let size = size(self.solver.state().as_ref().iter().take(self.dynamics().rates(model).start));
        let solver = &mut self.solver;
        let [y, scratch] = &mut self.scratch;
        let mut values = |theta: T| {
            let t = solver.within(model, theta, y)?;
            Ok::<_, crate::Error>(guards(solver.dynamics(), model, (t, y), scratch))
        };
        let begin = values(zero)?.0;
        let first = first_falling(&mut values)?;
        let mut first =
            first.map(|Found { event, theta, .. }| Next { theta, kind: event / N, contact: event % N });
        // Guards that begin at zero have been passed by no crossing.
        for (kind, contact) in (0..3).flat_map(|kind| (0..N).map(move |contact| (kind, contact))) {
            if begin[kind][contact] <= zero {
                let value = |theta: T| Ok(values(theta)?.0[kind][contact]);
                let noise = noise(&contacts[contact], size, kind, begin[kind][contact]);
                if let Some(theta) = passed(value, noise)?
                    && first.as_ref().is_none_or(|next| theta < next.theta)
                {
                    first = Some(Next { theta, kind, contact });
                }
            }
        }
        Ok(first)
    }

    /// The event at which the step has been ended, or one before it: a step that was taken again is more exact than
    /// what was interpolated, and may have gone through another stop.
    pub(super) fn before<M>(&mut self, model: &M, mut next: Next<T>) -> Result<Next<T>, Error>
    where
        D: Forced<M, Scalar = T, State = S>,
        A: Method<Contacts<D, T, N>, M>,
        C: Correction<D, M>,
    {
        for _ in 0..N {
            let Contacts { contacts, phases, .. } = *self.solver.dynamics();
            let Guards(guards) = self.guards(model);
            let zero = T::constant(0.0);
            let size = size(self.solver.state().as_ref().iter().take(self.dynamics().rates(model).start));
            let is_passed = |kind: usize, k: usize| {
                let is_own = (kind, k) == (next.kind, next.contact);
                !is_own && !phases[k].is_held() && guards[kind][k] < -noise(&contacts[k], size, kind, zero)
            };
            let is_any = (0..2).any(|kind| (0..N).any(|k| is_passed(kind, k)));
            let h = self.solver.last_step();
            match if is_any && next.theta > zero { self.find(model)? } else { None } {
                Some(earlier) if (earlier.kind, earlier.contact) != (next.kind, next.contact) => {
                    self.end_at(model, h, &earlier)?;
                    next = earlier;
                }
                _ => break,
            }
        }
        Ok(next)
    }

    /// Takes the last step again, up to an event: by the method, whose states are better than what it interpolates.
    pub(super) fn end_at<M>(&mut self, model: &M, h: T, next: &Next<T>) -> Result<(), Error>
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
        self.solver.step(model, h).map_err(|error| self.reason(error))?;
        self.pin(model);
        Ok(self.guards(model).0[next.kind][next.contact])
    }
}
