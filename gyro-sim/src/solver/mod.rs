//! The solver: equations, a method and a correction combined.

mod adaptive;
mod control;
mod passages;
mod past;
mod poses;
mod rewind;
mod watched;

use crate::contract::Storage;
use crate::correct::{check_finite, check_time};
use crate::integrate::Method;
use crate::{Correction, Error, Ode, Real, System, Uncorrected, When};
#[cfg(feature = "lanes")]
pub(crate) use adaptive::Attempt;
pub use control::{Control, Statistics};
use core::cmp::Ordering;
use passages::Nearness;
pub use passages::Passage;
use past::Past;
use poses::{Approach, Watch};
pub(crate) use rewind::Mark;
pub use watched::Tried;

/// A simulation in progress: equations, a method, a correction, the time and the state.
///
/// The model stays the caller's and is passed at each call.
#[derive(Clone, Debug)]
pub struct Solver<D, S, T, A, C> {
    dynamics: D,
    method: A,
    correction: C,
    control: Control,
    t: T,
    /// Accumulated rounding error of `t` (compensated summation).
    t_rest: T,
    y: S,
    /// The last step: where it began and its length.
    before: (T, S, T),
    /// The tolerated error of each element.
    weights: S,
    /// The state at the end of the step that is being tried.
    trial: S,
    next_step: T,
    last_error: f64,
    since_correction: u32,
    /// Whether the next attempt is of the same step as the last one.
    is_repeated: bool,
    /// Number of steps at the limit of stability, and of others since the last of them.
    stiff: u32,
    not_stiff: u32,
    /// Whether the last attempt was accepted and has not been carried over by the method yet.
    is_kept: bool,
    /// Whether the method has prepared interpolation within the last step.
    is_prepared: bool,
    /// Whether the state is exactly the end of the method's last attempt.
    is_untouched: bool,
    /// Whether the system is another one than that of the method's last attempt.
    has_changed: bool,
    /// Whether time and state are known to be finite.
    is_checked: bool,
    /// For mechanisms with singular poses: the states after the last steps.
    past: Past<S, T>,
    /// The state before it was corrected.
    raw: S,
    /// The degree of the polynomial that the last step was extrapolated by, if it was.
    leap: Option<usize>,
    /// Set while a singular pose lies ahead that must be stepped over.
    approach: Option<Approach>,
    watch: Watch,
    /// With steps of fixed length, for mechanisms with singular poses: the distance to them.
    nearness: Option<Nearness<T>>,
    resumes: bool,
    statistics: Statistics,
}

/// A step longer than this fraction of the stability limit counts as limited by stability.
const NEAR_LIMIT: f64 = 0.8;
/// After so many such steps, with no more than that many others among them, the scene is stiff for the method (as in
/// DOPRI5 and DOP853).
const STIFF_STEPS: u32 = 15;
const OTHER_STEPS: u32 = 6;

impl<D, S: Storage<T>, T: Real, A> Solver<D, S, T, A, Uncorrected> {
    /// A motion that starts at `y` at time `t`, without corrections. If these are not finite, the first step is an
    /// [`Error`].
    pub fn new(dynamics: D, method: A, t: T, y: &S) -> Self {
        Self::with_correction(dynamics, method, Uncorrected, t, y)
    }
}

impl<D, S: Storage<T>, T: Real, A, C> Solver<D, S, T, A, C> {
    /// A motion that starts at `y` at time `t` and is corrected. If these are not finite, the first step is an
    /// [`Error`].
    pub fn with_correction(dynamics: D, method: A, correction: C, t: T, y: &S) -> Self {
        let zero = T::constant(0.0);
        Self {
            dynamics,
            method,
            correction,
            control: Control::default(),
            t,
            t_rest: zero,
            y: y.clone(),
            before: (t, y.clone(), zero),
            weights: y.clone(),
            trial: y.clone(),
            next_step: zero,
            last_error: 1e-4,
            since_correction: 0,
            is_repeated: false,
            stiff: 0,
            not_stiff: 0,
            is_kept: false,
            is_prepared: false,
            is_untouched: false,
            has_changed: false,
            is_checked: false,
            past: Past::new(t, y),
            raw: y.clone(),
            leap: None,
            approach: None,
            watch: Watch::Unknown,
            nearness: None,
            resumes: false,
            statistics: Statistics { shortest_step: f64::INFINITY, ..Statistics::default() },
        }
    }

    /// Replaces the control settings.
    #[must_use]
    pub fn with_control(mut self, control: Control) -> Self {
        self.control = control;
        self.next_step = T::constant(control.first_step);
        self
    }

    /// The time, s.
    pub fn time(&self) -> T {
        self.t
    }

    /// The state.
    pub fn state(&self) -> &S {
        &self.y
    }

    /// Statistics of the run so far.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// The equations that are integrated.
    pub fn dynamics(&self) -> &D {
        &self.dynamics
    }

    /// The equations that are integrated, to be changed where they hold data of their own: see
    /// [`Solver::system_has_changed`].
    pub fn dynamics_mut(&mut self) -> &mut D {
        &mut self.dynamics
    }

    /// The correction.
    pub fn correction(&self) -> &C {
        &self.correction
    }

    #[cfg(feature = "lanes")]
    pub(crate) fn method_mut(&mut self) -> &mut A {
        &mut self.method
    }

    /// Replaces the state, as after an impact or a new measurement.
    pub fn set_state(&mut self, y: &S) {
        self.y.as_mut().copy_from_slice(y.as_ref());
        (self.is_untouched, self.is_checked) = (false, false);
        self.past.forget();
        (self.leap, self.nearness) = (None, None);
    }

    /// To be called when the model or the equations have changed, for example by a new value of an input: what was
    /// computed from them is discarded.
    pub fn system_has_changed(&mut self) {
        (self.is_untouched, self.has_changed) = (false, true);
        self.resumes = false;
        self.past.forget();
        self.leap = None;
    }

    /// One step of length `h`, and a correction if it is due. No error is estimated, and no step is repeated; singular
    /// poses that are passed are counted ([`Statistics::passages`]).
    ///
    /// # Errors
    /// [`Error`], with state and time as they were before.
    pub fn step<M>(&mut self, system: &M, h: T) -> Result<(), Error>
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
        C: Correction<D, M>,
    {
        self.check_start()?;
        if !h.is_finite() {
            return Err(Error::Setting { setting: "step", value: h.to_f64() });
        }
        self.look_out(system);
        self.attempt(system, h);
        let after = self.after(h);
        self.trial.as_mut().copy_from_slice(self.method.end().as_ref());
        match self.correct_trial(system, after.0) {
            Ok(is_corrected) => {
                self.keep::<M>(after, h, (is_corrected, None));
                self.look_back(system);
                Ok(())
            }
            Err(error) => {
                self.resumes = false;
                Err(self.blame(system, error))
            }
        }
    }

    /// `n` steps of length `h`.
    ///
    /// # Errors
    /// [`Error`], with state and time as they were before the step that failed.
    pub fn advance<M>(&mut self, system: &M, h: T, n: u32) -> Result<(), Error>
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
        C: Correction<D, M>,
    {
        (0..n).try_for_each(|_| self.step(system, h))
    }

    /// Corrects the state now, whether a correction is due or not.
    ///
    /// # Errors
    /// [`Error`], with the state as it was before.
    pub fn correct<M>(&mut self, system: &M) -> Result<(), Error>
    where
        D: Ode<M, Scalar = T, State = S>,
        C: Correction<D, M>,
    {
        check_time(self.t, self.t)?;
        self.trial.as_mut().copy_from_slice(self.y.as_ref());
        self.correction
            .correct(system, self.t, &mut self.trial)
            .map_err(|error| self.blame(system, error))?;
        core::mem::swap(&mut self.y, &mut self.trial);
        self.statistics.corrections += 1;
        (self.since_correction, self.is_untouched) = (0, false);
        Ok(())
    }

    /// Writes the state at a time within the last step, corrected like the states between steps are; at its end and
    /// beyond it the state as it is.
    ///
    /// # Errors
    /// [`Error::InvalidEndTime`] for a time before the last step, or once a later attempt has failed; [`Error`] if the
    /// correction fails.
    pub fn interpolate<M>(&mut self, system: &M, t: T, out: &mut S) -> Result<(), Error>
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
        C: Correction<D, M>,
    {
        let start = self.before.0;
        if t >= self.t {
            out.as_mut().copy_from_slice(self.y.as_ref());
            return Ok(());
        }
        // What the method holds are the slopes of its last attempt.
        if !(self.is_kept || self.leap.is_some()) || !(start..=self.t).contains(&t) {
            return Err(Error::InvalidEndTime { t: self.t.to_f64(), t_end: t.to_f64() });
        }
        if self.leap.is_none() {
            self.prepare_interpolation(system);
        }
        self.between(system, t, out);
        match self.correction.correct(system, t, out) {
            // Too near a singular pose for a correction the motion between steps is no less smooth.
            Err(Error::Jump { .. } | Error::Singular { .. } | Error::NoConvergence { .. })
                if self.watch == Watch::Needed =>
            {
                self.between(system, t, out);
                Ok(())
            }
            outcome => outcome,
        }
    }

    /// Prepares the method for states within the last step, once.
    fn prepare_interpolation<M>(&mut self, system: &M)
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
        C: Correction<D, M>,
    {
        if !self.is_prepared {
            let (start, y, h) = &self.before;
            let system = System { dynamics: &self.dynamics, model: system };
            self.method.prepare(system, *start, *h, y, &mut self.statistics.work);
            self.is_prepared = true;
        }
    }

    /// The state within the last step as the method has it, or the polynomial that has led to its end.
    fn between<M>(&self, system: &M, t: T, out: &mut S)
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
    {
        let (start, _, h) = &self.before;
        match self.leap {
            Some(degree) => self.past.at(t, degree + 1, out),
            None => self.method.between((t - *start) / *h, out),
        }
        self.dynamics.normalise(system, out);
    }

    /// Time and state as they were given must be finite; later ones are looked at as they come.
    fn check_start(&mut self) -> Result<(), Error> {
        if !self.is_checked {
            check_time(self.t, self.t)?;
            check_finite(self.t, self.y.as_ref())?;
            self.is_checked = true;
        }
        Ok(())
    }

    /// The time after a step, and what rounding takes from it.
    fn after(&self, h: T) -> (T, T) {
        let step = h + self.t_rest;
        let t = self.t + step;
        (t, step - (t - self.t))
    }

    pub(crate) fn attempt<M>(&mut self, system: &M, h: T)
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
        C: Correction<D, M>,
    {
        if self.is_kept {
            // Slopes of two systems say nothing of the rates of either.
            self.resumes = !self.has_changed && self.method.carry() && self.is_untouched;
            self.is_kept = false;
        }
        self.has_changed = false;
        let system = System { dynamics: &self.dynamics, model: system };
        self.method.attempt(system, self.t, h, &self.y, self.resumes, &mut self.statistics.work);
        self.resumes = true;
    }

    /// Corrects the trial if that is due; returns whether it was.
    fn correct_trial<M>(&mut self, system: &M, t: T) -> Result<bool, Error>
    where
        D: Ode<M, Scalar = T, State = S>,
        C: Correction<D, M>,
    {
        let is_due = match self.control.when {
            When::Steps(steps) => self.since_correction + 1 >= steps,
            When::Violation(limit) => {
                let violation = self.correction.violation(system, t, &self.trial).to_f64();
                // What cannot be compared is corrected too, and so noticed.
                !matches!(violation.partial_cmp(&limit), Some(Ordering::Less | Ordering::Equal))
            }
        };
        if is_due {
            self.correction.correct(system, t, &mut self.trial)?;
            self.statistics.corrections += 1;
        } else {
            self.correction.refer_turns(system, t, &mut self.trial);
        }
        match (0u16..).zip(self.trial.as_ref()).find(|(_, x)| !x.is_finite()) {
            Some((index, _)) => Err(Error::NotFinite { t: t.to_f64(), index }),
            None => Ok(is_due),
        }
    }

    /// Goes on from the trial, where the last attempt has led.
    fn keep<M>(&mut self, after: (T, T), h: T, settled: (bool, Option<T>))
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
    {
        self.is_untouched = !settled.0 || self.trial.as_ref() == self.method.end().as_ref();
        self.go_on(after, h, settled);
        (self.is_kept, self.is_prepared, self.leap) = (true, false, None);
        self.note::<M>(h.to_f64());
    }

    fn go_on(&mut self, (t, t_rest): (T, T), h: T, (is_corrected, pivot): (bool, Option<T>)) {
        self.since_correction = if is_corrected { 0 } else { self.since_correction + 1 };
        (self.before.0, self.before.2) = (self.t, h);
        core::mem::swap(&mut self.before.1, &mut self.y);
        core::mem::swap(&mut self.y, &mut self.trial);
        (self.t, self.t_rest) = (t, t_rest);
        match pivot {
            Some(pivot) => self.past.push(t, pivot, &self.y),
            None => self.past.forget(),
        }
        self.statistics.accepted += 1;
        self.statistics.longest_step = self.statistics.longest_step.max(h.to_f64());
    }

    fn note<M>(&mut self, h: f64)
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
    {
        let statistics = &mut self.statistics;
        let [slope, state] = self.method.rate().map(Real::to_f64);
        let size = self.y.as_ref().iter().fold(0.0, |sum: f64, y| sum + y.to_f64() * y.to_f64());
        let rounding = 100.0 * T::EPSILON.to_f64();
        if !(slope.is_finite() && state > rounding * rounding * size) {
            return;
        }
        let rate = libm::sqrt(slope / state);
        statistics.fastest_rate = statistics.fastest_rate.max(rate);
        if rate * h > NEAR_LIMIT * A::STABILITY {
            statistics.limited_by_stability += 1;
            (self.stiff, self.not_stiff) = (self.stiff + 1, 0);
        } else {
            self.not_stiff += 1;
            if self.not_stiff >= OTHER_STEPS {
                self.stiff = 0;
            }
        }
    }
}

#[cfg(test)]
mod tests;
