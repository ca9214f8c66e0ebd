//! The motion: steps, and what happens at their ends.

use super::equations::{Contacts, Forced};
use super::guards::{Guards, guards};
use super::integrated::Kept;
use super::settle::{Change, Ledger, Next, Record, rounding};
use super::small::at;
use super::{Contact, Error, Phase};
use crate::contract::Storage;
use crate::integrate::Method;
use crate::solver::Mark;
use crate::{Control, Correction, Real, Solver, Statistics, Tried, Uncorrected};

/// A motion with contacts, by any method.
#[derive(Clone, Debug)]
pub struct Hybrid<D, S, T, A, C, const N: usize> {
    pub(super) solver: Solver<Contacts<D, T, N>, S, T, A, Kept<C>>,
    pub(super) mark: Mark<S, T>,
    pub(super) scratch: [S; 2],
    ledger: Ledger<T, N>,
    is_begun: bool,
    /// What the last step has ended at, and its length before it was cut short.
    pending: Option<Pending<T>>,
    /// Why there is no way on from here.
    failure: Option<Error>,
}

/// What is left to be decided at the end of a step.
#[derive(Clone, Copy, Debug)]
enum Pending<T> {
    /// An event, at which the step has ended, and the length that it had.
    Event(Next<T>, T),
    /// What has happened in a step of fixed length.
    Step,
}

/// So many events without a step between them mean that there is no consistent way on.
const MOST_STALLED: u32 = 64;

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
        Self {
            solver: Solver::with_correction(
                Contacts::new(dynamics, contacts),
                method,
                Kept(correction),
                t,
                y,
            ),
            mark: Mark::new(t, y),
            scratch: [y.clone(), y.clone()],
            ledger: Ledger::new(),
            is_begun: false,
            pending: None,
            failure: None,
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
        &self.ledger.record
    }

    /// Statistics of the steps so far; those that an event cut short count as rejected.
    pub fn statistics(&self) -> &Statistics {
        self.solver.statistics()
    }

    /// What each contact has done at the last event, or when it was last decided which contacts hold.
    pub fn changes(&self) -> &[Change<T>; N] {
        &self.ledger.changes
    }

    /// The correction.
    pub fn correction(&self) -> &C {
        &self.solver.correction().0
    }

    /// The equations without contacts.
    pub fn dynamics(&self) -> &D {
        &self.solver.dynamics().dynamics
    }

    /// The equations without contacts, to be changed where they hold data of their own: see
    /// [`Hybrid::system_has_changed`].
    pub fn dynamics_mut(&mut self) -> &mut D {
        &mut self.solver.dynamics_mut().dynamics
    }

    /// Replaces the state; which contacts hold is decided anew.
    pub fn set_state(&mut self, y: &S) {
        self.solver.set_state(y);
        (self.is_begun, self.pending) = (false, None);
    }

    /// The rates have jumped at once to those of this state, as by an impulse of what is driven; besides them nothing
    /// of the state that contacts see may differ. Stops that are touched are resolved together with it when the motion
    /// is [resolved](Hybrid::resolve) or goes on: those rested on push without rebound, those that are hit at the same
    /// time by the rates after the jump. Friction has no part in it.
    pub fn strike(&mut self, y: &S) {
        let before = self.solver.state().as_ref();
        let rates = self.solver.dynamics().contacts.map(|contact| at(before, contact.rate));
        self.ledger.jumped = Some((rates, self.solver.last_step()));
        self.solver.set_state(y);
        self.solver.system_has_changed();
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
        self.solver.dynamics().forces(model, at, &mut self.scratch[0]).forces
    }

    /// The same at a time within the last step, as [`Hybrid::interpolate`] has the state.
    ///
    /// # Errors
    /// As [`Solver::interpolate`].
    pub fn forces_at<M>(&mut self, model: &M, t: T) -> Result<[T; N], crate::Error>
    where
        D: Forced<M, Scalar = T, State = S>,
        A: Method<Contacts<D, T, N>, M>,
        C: Correction<D, M>,
    {
        let mut y = self.solver.state().clone();
        self.interpolate(model, t, &mut y)?;
        Ok(self.solver.dynamics().forces(model, (t, &y), &mut self.scratch[0]).forces)
    }

    /// Goes on until `t_end`, through all events on the way.
    ///
    /// # Errors
    /// [`Error::Solver`], among them [`StepTooShort`](crate::Error::StepTooShort) if events follow each other without
    /// time between them; [`Error::Jammed`] if the forces of contacts are not determined.
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
        let is_event = self.move_towards(model, t_end, |_| None)?;
        self.resolve(model);
        Ok(is_event)
    }

    /// The same, with the state as it is just before the event: the motion within the step can be asked for, and
    /// [`Hybrid::resolve`] decides what happens; `watch` has a say in each attempt, as in [`Solver::step_watched`].
    ///
    /// # Errors
    /// As [`Hybrid::advance_to`].
    pub fn move_towards<M>(
        &mut self,
        model: &M,
        t_end: T,
        watch: impl FnMut(&mut dyn Tried<Contacts<D, T, N>, S, T>) -> Option<T>,
    ) -> Result<bool, Error>
    where
        D: Forced<M, Scalar = T, State = S>,
        A: Method<Contacts<D, T, N>, M>,
        C: Correction<D, M>,
    {
        self.begin(model)?;
        self.solver.step_watched(model, t_end, watch).map_err(|error| self.reason(error))?;
        self.pin(model);
        let h = self.solver.last_step();
        let Some(next) = self.find(model)? else {
            self.ledger.stalled = 0;
            let creeps = self.turn(model);
            let next = |contact| Next { theta: T::constant(1.0), kind: 2, contact };
            self.pending = creeps.map(|contact| Pending::Event(next(contact), h));
            return Ok(creeps.is_some());
        };
        self.end_at(model, h, &next)?;
        let next = self.before(model, next)?;
        let is_step = next.theta > T::constant(0.0) && self.solver.last_step() > rounding(self.mark.time());
        self.ledger.stalled = if is_step { 0 } else { self.ledger.stalled + 1 };
        if self.ledger.stalled > MOST_STALLED {
            let t = self.mark.time().to_f64();
            return Err(crate::Error::StepTooShort { t, step: 0.0, index: 0 }.into());
        }
        self.pending = Some(Pending::Event(next, h));
        Ok(true)
    }

    /// Decides what happens where the last step has ended, and at the start; returns whether there was something to
    /// decide.
    pub fn resolve<M>(&mut self, model: &M) -> bool
    where
        D: Forced<M, Scalar = T, State = S>,
    {
        let is_begun = core::mem::replace(&mut self.is_begun, true);
        match self.pending.take() {
            Some(Pending::Event(next, h)) => self.settle(model, Some((&next, h))),
            Some(Pending::Step) => self.settle(model, None),
            None if !is_begun => self.settle(model, None),
            None => return false,
        }
        true
    }

    /// One step of length `h`; what has happened in it is decided at its end.
    ///
    /// # Errors
    /// [`Error`], with state and time as they were before.
    pub fn step<M>(&mut self, model: &M, h: T) -> Result<(), Error>
    where
        D: Forced<M, Scalar = T, State = S>,
        A: Method<Contacts<D, T, N>, M>,
        C: Correction<D, M>,
    {
        self.move_by(model, h)?;
        self.resolve(model);
        Ok(())
    }

    /// The same, with the state as it is before that: the motion within the step can be asked for, and
    /// [`Hybrid::resolve`] decides what happens.
    ///
    /// # Errors
    /// As [`Hybrid::step`].
    pub fn move_by<M>(&mut self, model: &M, h: T) -> Result<(), Error>
    where
        D: Forced<M, Scalar = T, State = S>,
        A: Method<Contacts<D, T, N>, M>,
        C: Correction<D, M>,
    {
        self.begin(model)?;
        let places = self.solver.dynamics().places(model, (self.solver.time(), self.solver.state()));
        self.ledger.begin(places.map(|[_, rate]| rate));
        self.solver.step(model, h).map_err(|error| self.reason(error))?;
        self.pin(model);
        let guards = self.guards(model);
        let is_passed = guards.as_ref().iter().any(|guard| *guard < T::constant(0.0));
        if !is_passed {
            self.ledger.pass();
            self.turn(model);
        }
        self.pending = is_passed.then_some(Pending::Step);
        Ok(())
    }

    /// Writes the state at a time within the last step, while what happens at its end is not resolved.
    ///
    /// # Errors
    /// As [`Solver::interpolate`].
    pub fn interpolate<M>(&mut self, model: &M, t: T, out: &mut S) -> Result<(), crate::Error>
    where
        D: Forced<M, Scalar = T, State = S>,
        A: Method<Contacts<D, T, N>, M>,
        C: Correction<D, M>,
    {
        self.solver.interpolate(model, t, out)?;
        let equations = self.solver.dynamics();
        let y = self.solver.state();
        for (k, contact) in equations.contacts.iter().enumerate() {
            if equations.is_pinned(k) {
                out.as_mut()[contact.coordinate] = y.as_ref()[contact.coordinate];
                out.as_mut()[contact.rate] = y.as_ref()[contact.rate];
            }
        }
        Ok(())
    }

    /// Corrects the state now, but for coordinates that are held.
    ///
    /// # Errors
    /// As [`Solver::correct`].
    pub fn correct<M>(&mut self, model: &M) -> Result<(), crate::Error>
    where
        D: Forced<M, Scalar = T, State = S>,
        C: Correction<D, M>,
    {
        self.solver.mark(&mut self.mark);
        self.solver.correct(model)?;
        self.pin(model);
        Ok(())
    }

    /// Begins a step where there is a way on.
    fn begin<M>(&mut self, model: &M) -> Result<(), Error>
    where
        D: Forced<M, Scalar = T, State = S>,
    {
        self.resolve(model);
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        self.solver.dynamics().jam.set(None);
        self.solver.mark(&mut self.mark);
        Ok(())
    }

    /// Where friction may jam no step leads on, for this one reason.
    pub(super) fn reason(&self, error: crate::Error) -> Error {
        let equations = self.solver.dynamics();
        match (error, equations.jam.get()) {
            (crate::Error::NotFinite { .. } | crate::Error::StepTooShort { .. }, Some(jam)) => {
                equations.jammed(self.mark.time(), &jam)
            }
            _ => error.into(),
        }
    }

    /// Closing loops moves all coordinates by rounding, but not those that are held; and surfaces that touch neither
    /// part nor slip by what a step's error is.
    pub(super) fn pin<M>(&mut self, model: &M)
    where
        D: Forced<M, Scalar = T, State = S>,
    {
        let (contacts, phases) = (self.solver.dynamics().contacts, self.solver.dynamics().phases);
        let pinned: [bool; N] = core::array::from_fn(|k| self.solver.dynamics().is_pinned(k));
        for (contact, _) in contacts.iter().zip(pinned).filter(|(_, is_pinned)| *is_pinned) {
            self.solver.pin(&self.mark, contact.coordinate);
            self.solver.pin(&self.mark, contact.rate);
        }
        let equations = self.solver.dynamics();
        if equations.iterates(model) && phases.iter().any(|phase| phase.is_held()) {
            let (t, mut y) = (self.solver.time(), self.solver.state().clone());
            let held = phases.map(Phase::is_held);
            equations.hold(model, (t, &mut y), (&held, &equations.ends()), &mut self.scratch);
            self.solver.replace(&y);
        }
    }

    /// Has surfaces that slide go on in the direction that they have now; returns what creeps. As surfaces come to rest
    /// the direction turns ever faster, for ever shorter: that is nothing stiff.
    fn turn<M>(&mut self, model: &M) -> Option<usize>
    where
        D: Forced<M, Scalar = T, State = S>,
    {
        let (t, y) = (self.solver.time(), self.solver.state().clone());
        let equations = self.solver.dynamics_mut();
        let (creeps, stops) = equations.turn(model, (t, &y));
        if stops {
            self.solver.forget_stiffness();
        }
        creeps
    }

    /// Decides what happens at the end of the last step.
    fn settle<M>(&mut self, model: &M, next: Option<(&Next<T>, T)>)
    where
        D: Forced<M, Scalar = T, State = S>,
    {
        let (t, mut y) = (self.solver.time(), self.solver.state().clone());
        let equations = self.solver.dynamics_mut();
        self.failure = self.ledger.settle(equations, (model, t), &mut y, next, &mut self.scratch).err();
        self.solver.set_state(&y);
        self.solver.system_has_changed();
        self.solver.forget_stiffness();
    }

    pub(super) fn guards<M>(&mut self, model: &M) -> Guards<T, N>
    where
        D: Forced<M, Scalar = T, State = S>,
    {
        let (t, y) = (self.solver.time(), self.solver.state());
        guards(self.solver.dynamics(), model, (t, y), &mut self.scratch[1])
    }
}
