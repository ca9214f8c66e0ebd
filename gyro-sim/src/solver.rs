//! From a method and a correction to a motion.

mod passages;
mod past;
mod poses;

use crate::correct::{check_finite, check_time};
use crate::integrate::{Embedded, Method, Work};
use crate::{Correction, Error, Ode, Real, Storage, When};
use core::cmp::Ordering;
use passages::Nearness;
pub use passages::Passage;
use past::Past;
use poses::{Approach, Watch};

/// What a solver is to keep to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Control {
    /// Error tolerated in each step, relative to each element's size.
    pub relative: f64,
    /// Error tolerated in each step besides, in the element's own unit.
    pub absolute: f64,
    /// Length of the first step that is tried, s; zero to have it guessed.
    pub first_step: f64,
    /// Steps are not made shorter than this, s; rounding of the time sets a limit of its own.
    pub smallest_step: f64,
    /// Steps are not made longer than this, s.
    pub largest_step: f64,
    /// Number of steps, rejected ones included, after which the solver gives up.
    pub budget: u64,
    /// When to correct.
    pub when: When,
}

impl Default for Control {
    fn default() -> Self {
        Self {
            relative: 1e-8,
            absolute: 1e-8,
            first_step: 0.0,
            smallest_step: 0.0,
            largest_step: f64::INFINITY,
            budget: 10_000_000,
            when: When::Steps(1),
        }
    }
}

impl Control {
    /// Both tolerances set to one number.
    #[must_use]
    pub fn with_tolerance(self, tolerance: f64) -> Self {
        Self { relative: tolerance, absolute: tolerance, ..self }
    }
}

/// What a run has cost and met.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Statistics {
    /// Steps that were kept.
    pub accepted: u64,
    /// Steps that were tried again with a shorter one.
    pub rejected: u64,
    /// Corrections made.
    pub corrections: u64,
    /// Evaluations of the system.
    pub work: Work,
    /// Accepted steps of explicit methods whose length was at the limit of stability rather than set by accuracy.
    pub limited_by_stability: u64,
    /// The fastest rate |λ| of the system that a step has seen, 1/s; explicit methods only.
    pub fastest_rate: f64,
    /// The shortest accepted step, s, those left aside that were cut to end where they were told to.
    pub shortest_step: f64,
    /// The longest accepted step, s.
    pub longest_step: f64,
    /// Accepted steps that were extrapolated over a singular pose.
    pub leaps: u64,
    /// Singular poses that steps of fixed length have passed so near that they may have gone on in another way than the motion does.
    pub passages: u64,
    /// The first of them.
    pub first_passage: Option<Passage>,
}

/// A motion under way: a method, a correction, the time and the state.
///
/// The mechanism, or whatever the system is, stays the caller's and is handed in at each call.
#[derive(Clone, Debug)]
pub struct Solver<S, T, M, C> {
    method: M,
    correction: C,
    control: Control,
    t: T,
    /// What rounding has taken from `t` so far.
    t_rest: T,
    y: S,
    /// The last step: where it began and its length.
    before: (T, S, T),
    /// What an error may be, element by element.
    weights: S,
    /// The state as it is tried.
    trial: S,
    next_step: T,
    last_error: f64,
    since_correction: u32,
    /// Consecutive steps at the limit of stability, and such as were not since.
    stiff: u32,
    not_stiff: u32,
    /// The last attempt has been kept, and the method does not know yet.
    is_kept: bool,
    /// Whether the method has prepared interpolation within the last step.
    is_prepared: bool,
    /// Whether the state is where the method left it.
    is_untouched: bool,
    /// Whether time and state are known to be finite.
    is_checked: bool,
    /// Where there are singular poses: the states that the last steps have led to.
    past: Past<S, T>,
    /// The state before it was corrected.
    raw: S,
    /// The degree of the polynomial that the last step was extrapolated by, if it was.
    leap: Option<usize>,
    /// Where there is a singular pose ahead that must be stepped over.
    approach: Option<Approach>,
    watch: Watch,
    /// Under steps of fixed length, where there are singular poses: how near they are.
    nearness: Option<Nearness<T>>,
    resumes: bool,
    statistics: Statistics,
}

/// What of the best next step is taken.
const SAFETY: f64 = 0.9;
/// A step is at most so many times as long as the last one, and at least this part of it.
const GROWTH: f64 = 6.0;
const SHRINKAGE: f64 = 0.2;
/// A step this part of the limit of stability is limited by it.
const NEAR_LIMIT: f64 = 0.8;
/// After so many such steps, with no more than that many others among them, the scene is stiff for the method (as in DOPRI5 and
/// DOP853).
const STIFF_STEPS: u32 = 15;
const OTHER_STEPS: u32 = 6;

impl<S: Storage<T>, T: Real, M, C> Solver<S, T, M, C> {
    /// A motion that starts at `y` at time `t`. Where these are not finite the first step is an [`Error`].
    pub fn new(method: M, correction: C, t: T, y: &S) -> Self {
        let zero = T::constant(0.0);
        Self {
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
            stiff: 0,
            not_stiff: 0,
            is_kept: false,
            is_prepared: false,
            is_untouched: false,
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

    /// The same with another control.
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

    /// What the run has cost and met so far.
    pub fn statistics(&self) -> &Statistics {
        &self.statistics
    }

    /// The correction.
    pub fn correction(&self) -> &C {
        &self.correction
    }

    /// Replaces the state, as after an impact or a new measurement.
    pub fn set_state(&mut self, y: &S) {
        self.y.as_mut().copy_from_slice(y.as_ref());
        (self.is_untouched, self.is_checked) = (false, false);
        self.past.forget();
        (self.leap, self.nearness) = (None, None);
    }

    /// The system has changed, as by a new value of an input: nothing that was found out about it holds any longer.
    pub fn system_has_changed(&mut self) {
        self.is_untouched = false;
        self.resumes = false;
        self.past.forget();
        self.leap = None;
    }

    /// One step of length `h`, and a correction if it is due. Nothing is estimated, and nothing tried again: singular poses that it passes
    /// are counted ([`Statistics::passages`]).
    ///
    /// # Errors
    /// [`Error`], with state and time as they were before.
    pub fn step<O>(&mut self, system: &O, h: T) -> Result<(), Error>
    where
        O: Ode<Scalar = T, State = S>,
        M: Method<O>,
        C: Correction<O>,
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
                self.keep::<O>(after, h, (is_corrected, None));
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
    pub fn advance<O>(&mut self, system: &O, h: T, n: u32) -> Result<(), Error>
    where
        O: Ode<Scalar = T, State = S>,
        M: Method<O>,
        C: Correction<O>,
    {
        (0..n).try_for_each(|_| self.step(system, h))
    }

    /// Corrects the state now, whether that is due or not.
    ///
    /// # Errors
    /// [`Error`], with the state as it was before.
    pub fn correct<O>(&mut self, system: &O) -> Result<(), Error>
    where
        O: Ode<Scalar = T, State = S>,
        C: Correction<O>,
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

    /// Writes the state at a time within the last step, corrected like the states between steps are; at its end and beyond it the
    /// state as it is.
    ///
    /// # Errors
    /// [`Error::NoEnd`] for a time before the last step, or once a later attempt has failed; [`Error`] if the correction fails.
    pub fn interpolate<O>(&mut self, system: &O, t: T, out: &mut S) -> Result<(), Error>
    where
        O: Ode<Scalar = T, State = S>,
        M: Method<O>,
        C: Correction<O>,
    {
        let (start, y, h) = &self.before;
        if t >= self.t {
            out.as_mut().copy_from_slice(self.y.as_ref());
            return Ok(());
        }
        // What the method holds are the slopes of its last attempt.
        if !(self.is_kept || self.leap.is_some()) || !(*start..=self.t).contains(&t) {
            return Err(Error::NoEnd { t: self.t.to_f64(), t_end: t.to_f64() });
        }
        if !(self.is_prepared || self.leap.is_some()) {
            self.method.prepare(system, *start, *h, y, &mut self.statistics.work);
            self.is_prepared = true;
        }
        self.between(t, out);
        match self.correction.correct(system, t, out) {
            // Too near a singular pose for a correction the motion between steps is no less smooth.
            Err(Error::Jump { .. } | Error::Singular { .. } | Error::NoConvergence { .. })
                if self.watch == Watch::Needed =>
            {
                self.between(t, out);
                Ok(())
            }
            outcome => outcome,
        }
    }

    /// The state within the last step as the method has it, or the polynomial that has led to its end.
    fn between<O>(&self, t: T, out: &mut S)
    where
        O: Ode<Scalar = T, State = S>,
        M: Method<O>,
    {
        let (start, _, h) = &self.before;
        match self.leap {
            Some(degree) => self.past.at(t, degree + 1, out),
            None => self.method.between((t - *start) / *h, out),
        }
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

    fn attempt<O>(&mut self, system: &O, h: T)
    where
        O: Ode<Scalar = T, State = S>,
        M: Method<O>,
        C: Correction<O>,
    {
        if self.is_kept {
            self.resumes = self.method.carry() && self.is_untouched;
            self.is_kept = false;
        }
        self.method.attempt(system, self.t, h, &self.y, self.resumes, &mut self.statistics.work);
        self.resumes = true;
    }

    /// Corrects the trial if that is due; returns whether it was.
    fn correct_trial<O>(&mut self, system: &O, t: T) -> Result<bool, Error>
    where
        O: Ode<Scalar = T, State = S>,
        C: Correction<O>,
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
    fn keep<O>(&mut self, after: (T, T), h: T, settled: (bool, Option<T>))
    where
        O: Ode<Scalar = T, State = S>,
        M: Method<O>,
    {
        self.is_untouched = !settled.0 || self.trial.as_ref() == self.method.end().as_ref();
        self.go_on(after, h, settled);
        (self.is_kept, self.is_prepared, self.leap) = (true, false, None);
        self.note::<O>(h.to_f64());
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

    fn note<O>(&mut self, h: f64)
    where
        O: Ode<Scalar = T, State = S>,
        M: Method<O>,
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
        if rate * h > NEAR_LIMIT * M::STABILITY {
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

impl<S: Storage<T>, T: Real, M, C> Solver<S, T, M, C> {
    /// Steps until `t_end`, each as long as the tolerances allow.
    ///
    /// # Errors
    /// [`Error`], with state and time as they were after the last step that was kept.
    pub fn advance_to<O>(&mut self, system: &O, t_end: T) -> Result<(), Error>
    where
        O: Ode<Scalar = T, State = S>,
        M: Embedded<O>,
        C: Correction<O>,
    {
        loop {
            self.step_towards(system, t_end)?;
            if self.t >= t_end {
                return Ok(());
            }
        }
    }

    /// One step, as long as the tolerances allow and not beyond `t_end`.
    ///
    /// # Errors
    /// [`Error`], with state and time as they were before: tolerances that cannot be met, steps that would have to be too short or too
    /// many, a correction that fails however short the step, and a scene that is stiff for the method.
    pub fn step_towards<O>(&mut self, system: &O, t_end: T) -> Result<(), Error>
    where
        O: Ode<Scalar = T, State = S>,
        M: Embedded<O>,
        C: Correction<O>,
    {
        self.try_towards(system, t_end).map_err(|error| self.blame(system, error))
    }

    fn try_towards<O>(&mut self, system: &O, t_end: T) -> Result<(), Error>
    where
        O: Ode<Scalar = T, State = S>,
        M: Embedded<O>,
        C: Correction<O>,
    {
        self.check_control()?;
        self.check_start()?;
        check_time(self.t, t_end)?;
        if t_end <= self.t {
            return Ok(());
        }
        if self.next_step == T::constant(0.0) {
            self.next_step = self.guess_first_step(system, t_end);
        }
        self.watch(system);
        let mut has_failed = false;
        loop {
            if self.approach(system, t_end)? {
                return Ok(());
            }
            let (h, is_last) = self.length(t_end);
            self.check_budget(t_end, h)?;
            self.attempt(system, h);
            self.weigh::<O>();
            let (error, index) = self.method.error(h, &self.weights);
            let error = error.to_f64();
            let failure = if error <= 1.0 {
                let after = if is_last { (t_end, T::constant(0.0)) } else { self.after(h) };
                self.trial.as_mut().copy_from_slice(self.method.end().as_ref());
                match self.settle(system, after.0) {
                    Ok(settled) => {
                        self.keep::<O>(after, h, settled);
                        self.grow::<O>(h, error, has_failed, is_last);
                        return Ok(());
                    }
                    Err(failure) => Some(failure),
                }
            } else if error.is_finite() {
                None
            } else {
                Some(Error::NotFinite { t: self.t.to_f64(), index: short(index) })
            };
            self.statistics.rejected += 1;
            if self.approach.is_none() && self.beyond_pose().is_some() {
                self.approach = Some(Approach::default());
            }
            let factor = if failure.is_some() { SHRINKAGE } else { self.factor::<O>(error, 0.0).min(1.0) };
            self.next_step = h * T::constant(factor);
            has_failed = true;
            if self.next_step.to_f64() < self.shortest() {
                return Err(failure.unwrap_or(Error::StepTooShort {
                    t: self.t.to_f64(),
                    step: self.next_step.to_f64(),
                    index: short(index),
                }));
            }
        }
    }

    fn check_control(&self) -> Result<(), Error> {
        let smallest = 4.0 * T::EPSILON.to_f64();
        let Control { relative, absolute, first_step, smallest_step, largest_step, .. } = self.control;
        let is_met = relative >= smallest && absolute > 0.0 && relative.is_finite() && absolute.is_finite();
        if !is_met {
            return Err(Error::Tolerance { relative, absolute, smallest });
        }
        let lengths = [("first_step", first_step), ("smallest_step", smallest_step)];
        let is_wrong = |length: f64| !(length >= 0.0 && length.is_finite());
        match lengths.into_iter().find(|(_, length)| is_wrong(*length)) {
            Some((setting, value)) => Err(Error::Setting { setting, value }),
            None if largest_step > 0.0 => Ok(()),
            None => Err(Error::Setting { setting: "largest_step", value: largest_step }),
        }
    }

    /// Steps shorter than this do not move the time, or are not wanted.
    fn shortest(&self) -> f64 {
        let rounding = 16.0 * T::EPSILON.to_f64() * libm::fabs(self.t.to_f64());
        rounding.max(self.control.smallest_step).max(f64::MIN_POSITIVE)
    }

    /// The next step, and whether it ends the run.
    fn length(&self, t_end: T) -> (T, bool) {
        let left = t_end - self.t;
        let largest = T::constant(self.control.largest_step);
        let h = if self.next_step > largest { largest } else { self.next_step };
        if left <= h * T::constant(1.01) {
            (left, true)
        } else if left < h + h {
            (left * T::constant(0.5), false)
        } else {
            (h, false)
        }
    }

    fn check_budget(&self, t_end: T, h: T) -> Result<(), Error> {
        let Statistics { accepted, rejected, fastest_rate, .. } = self.statistics;
        let (t, step, taken) = (self.t.to_f64(), h.to_f64(), accepted + rejected);
        let left = self.control.budget.saturating_sub(taken);
        #[expect(
            clippy::cast_precision_loss,
            reason = "a number of steps is compared with a larger or smaller one"
        )]
        let is_out_of_reach = (t_end - self.t).to_f64() / step > left as f64;
        if left == 0 {
            Err(Error::TooManySteps { t, steps: taken })
        } else if self.stiff >= STIFF_STEPS && is_out_of_reach {
            Err(Error::Stiff { t, rate: fastest_rate, step })
        } else {
            Ok(())
        }
    }

    /// What is tolerated of each element, from its larger size at either end of the step.
    fn weigh<O>(&mut self)
    where
        O: Ode<Scalar = T, State = S>,
        M: Embedded<O>,
    {
        let [relative, absolute] = [self.control.relative, self.control.absolute].map(T::constant);
        let ends = self.y.as_ref().iter().zip(self.method.end().as_ref());
        for (weight, (start, end)) in self.weights.as_mut().iter_mut().zip(ends) {
            let (start, end) = (start.abs(), end.abs());
            *weight = T::fused(relative, if end > start { end } else { start }, absolute);
        }
    }

    fn grow<O>(&mut self, h: T, error: f64, has_failed: bool, is_last: bool)
    where
        O: Ode<Scalar = T, State = S>,
        M: Embedded<O>,
    {
        let statistics = &mut self.statistics;
        if !is_last {
            statistics.shortest_step = statistics.shortest_step.min(h.to_f64());
        }
        let factor = self.factor::<O>(error, self.last_error);
        let factor = if has_failed { factor.min(1.0) } else { factor };
        self.last_error = error.max(1e-4);
        let next = h * T::constant(factor);
        // A step that was cut short says little about the next one.
        if !is_last || next > self.next_step {
            self.next_step = next;
        }
    }

    /// By how much to change the step: proportional-integral control (Gustafsson; Hairer and Wanner, *Solving ODEs II*, IV.2), which
    /// keeps step sizes from oscillating at the limit of stability. An error before of zero leaves the proportional part out.
    fn factor<O>(&self, error: f64, before: f64) -> f64
    where
        O: Ode<Scalar = T, State = S>,
        M: Embedded<O>,
    {
        let order = f64::from(M::ERROR_ORDER);
        let damping = 0.2 / order;
        let factor = if before > 0.0 {
            SAFETY * libm::pow(error.max(1e-10), 0.75 * damping - 1.0 / order) * libm::pow(before, damping)
        } else {
            SAFETY * libm::pow(error, -1.0 / order)
        };
        factor.clamp(SHRINKAGE, GROWTH)
    }

    /// A first step by the sizes of the state, of its slope and of the slope's change (Hairer, Nørsett and Wanner, II.4).
    fn guess_first_step<O>(&mut self, system: &O, t_end: T) -> T
    where
        O: Ode<Scalar = T, State = S>,
        M: Embedded<O>,
    {
        system.derivative(self.t, &self.y, &mut self.trial);
        let [relative, absolute] = [self.control.relative, self.control.absolute];
        let scaled = |value: T, y: T| {
            let size = libm::fabs(value.to_f64()) / (absolute + relative * libm::fabs(y.to_f64()));
            if size.is_finite() { size } else { 0.0 }
        };
        let largest = |values: &S| {
            values.as_ref().iter().zip(self.y.as_ref()).map(|(v, y)| scaled(*v, *y)).fold(0.0, f64::max)
        };
        let (state, slope) = (largest(&self.y), largest(&self.trial));
        let left = (t_end - self.t).to_f64();
        let small = if state < 1e-5 || slope < 1e-5 { 1e-6 * left } else { 0.01 * state / slope };
        let small = small.min(left);
        let h = T::constant(small);
        let ahead = self.weights.as_mut().iter_mut().zip(self.y.as_ref()).zip(self.trial.as_ref());
        ahead.for_each(|((ahead, y), slope)| *ahead = T::fused(h, *slope, *y));
        let before = &mut self.before.1;
        system.derivative(self.t + h, &self.weights, before);
        for (change, slope) in before.as_mut().iter_mut().zip(self.trial.as_ref()) {
            *change = *change - *slope;
        }
        self.statistics.work.evaluations += 2;
        let values = self.before.1.as_ref().iter().zip(self.y.as_ref());
        let bend = values.map(|(v, y)| scaled(*v, *y)).fold(0.0, f64::max) / small;
        let order = f64::from(M::ERROR_ORDER);
        let steepest = slope.max(bend);
        let guess = if steepest <= 1e-15 { small * 1e3 } else { libm::pow(0.01 / steepest, 1.0 / order) };
        let guess = guess.min(100.0 * small).min(left);
        T::constant(if guess.is_finite() && guess > 0.0 { guess } else { left * 1e-6 })
    }
}

fn short(index: usize) -> u16 {
    u16::try_from(index).unwrap_or(u16::MAX)
}

#[cfg(test)]
mod tests;
