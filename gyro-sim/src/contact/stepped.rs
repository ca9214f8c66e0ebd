//! Motions with contacts in steps of fixed length, for small machines.

use super::equations::{Contacts, Forced};
use super::guards::guards;
use super::settle::{Change, Ledger, Record};
use super::{Contact, Error, Phase};
use crate::contract::Storage;
use crate::correct::{check_finite, check_time};
use crate::{Real, Rk4};

/// A motion with contacts by RK4 in steps of fixed length, whose time and state are the caller's: what a
/// microcontroller has place and time for. What happens in a step is decided at its end, as
/// [`Hybrid::step`](super::Hybrid::step) does: of order one in the step.
///
/// The work of a step is bounded. It evaluates the accelerations four times, or 9 + 5 N times while something is held.
/// Where something has happened, deciding what follows takes 4 + 4 N more at most, and 2ᴺ and 3ᴺ solutions of N
/// equations. Surfaces ask for more: what they rest on is projected after each step, and what follows an event is found
/// by iteration, of a bounded number of rounds.
///
/// Joints of loops are not closed: that is the caller's, by [`CloseLoops`](crate::CloseLoops).
#[derive(Clone, Debug)]
pub struct Stepped<D, S, T, const N: usize> {
    equations: Contacts<D, T, N>,
    rk4: Rk4<S>,
    scratch: [S; 2],
    ledger: Ledger<T, N>,
    is_begun: bool,
}

impl<D, S: Storage<T>, T: Real, const N: usize> Stepped<D, S, T, N> {
    /// A motion of states like this one.
    pub fn new(dynamics: D, contacts: [Contact<T>; N], y: &S) -> Self {
        Self {
            equations: Contacts::new(dynamics, contacts),
            rk4: Rk4::new(y),
            scratch: [y.clone(), y.clone()],
            ledger: Ledger::new(),
            is_begun: false,
        }
    }

    /// What each contact does.
    pub fn phases(&self) -> &[Phase; N] {
        &self.equations.phases
    }

    /// What contacts have done so far.
    pub fn record(&self) -> &Record<T> {
        &self.ledger.record
    }

    /// What each contact has done when it was last decided which contacts hold.
    pub fn changes(&self) -> &[Change<T>; N] {
        &self.ledger.changes
    }

    /// To be called when the model or the state has been changed: which contacts hold is decided anew.
    pub fn system_has_changed(&mut self) {
        self.is_begun = false;
    }

    /// The forces of the contacts on their coordinates, in the positive direction: reactions and friction.
    pub fn forces<M>(&mut self, model: &M, t: T, y: &S) -> [T; N]
    where
        D: Forced<M, Scalar = T, State = S>,
    {
        self.equations.forces(model, (t, y), &mut self.scratch[0]).forces
    }

    /// Advances `y` from `t` by `n_steps` steps of length `h`.
    ///
    /// # Errors
    /// [`Error::Jammed`] if the forces of contacts are not determined; of the solver,
    /// [`NotFinite`](crate::Error::NotFinite) if the state is not finite afterwards, and
    /// [`InvalidEndTime`](crate::Error::InvalidEndTime) if time or step are not finite.
    pub fn advance<M>(&mut self, model: &M, t: T, h: T, n_steps: u32, y: &mut S) -> Result<(), Error>
    where
        D: Forced<M, Scalar = T, State = S>,
    {
        let end = t + h * T::constant(f64::from(n_steps));
        check_time(t, end)?;
        if !self.is_begun {
            self.settle(model, t, y)?;
            self.is_begun = true;
        }
        for step in 0..n_steps {
            let [begin, end] = [step, step + 1].map(|step| t + h * T::constant(f64::from(step)));
            let places = self.equations.places(model, (begin, y));
            self.ledger.begin(places.map(|[_, rate]| rate));
            self.rk4.step(&self.equations, model, begin, h, y);
            let held = self.equations.phases.map(Phase::is_held);
            if held.contains(&true) && self.equations.iterates(model) {
                let ends = self.equations.ends();
                self.equations.hold(model, (end, y), (&held, &ends), &mut self.scratch);
            }
            let guards = guards(&self.equations, model, (end, y), &mut self.scratch[1]);
            if guards.as_ref().iter().any(|guard| *guard < T::constant(0.0)) {
                self.settle(model, end, y)?;
            } else {
                self.ledger.pass();
                self.equations.turn(model, (end, y));
            }
        }
        match self.equations.jam.take() {
            Some(jam) => Err(self.equations.jammed(end, &jam)),
            None => Ok(check_finite(end, y.as_ref())?),
        }
    }

    fn settle<M>(&mut self, model: &M, t: T, y: &mut S) -> Result<(), Error>
    where
        D: Forced<M, Scalar = T, State = S>,
    {
        self.ledger.settle(&mut self.equations, (model, t), y, None, &mut self.scratch)
    }
}
