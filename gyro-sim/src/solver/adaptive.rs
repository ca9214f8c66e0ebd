//! Steps under error control.

use super::poses::Approach;
use super::watched::{Tried, Watched};
use super::{STIFF_STEPS, Solver};
use crate::contract::Storage;
use crate::correct::check_time;
use crate::integrate::Method;
use crate::{Control, Correction, Error, Ode, Real, Statistics};

/// The fraction of the optimal next step that is taken.
const SAFETY: f64 = 0.9;
/// A step is at most this many times as long as the last one, and at least this fraction of it.
const GROWTH: f64 = 6.0;
const SHRINKAGE: f64 = 0.2;

/// An attempt of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Attempt<T> {
    pub(crate) h: T,
    /// Whether it would end the run.
    is_last: bool,
    /// The time after it, and what rounding takes from it.
    after: (T, T),
}

impl<D, S: Storage<T>, T: Real, A, C> Solver<D, S, T, A, C> {
    /// Steps until `t_end`, each as long as the tolerances allow. A time that is not later than the solver's is reached
    /// already: it takes no step. The method must estimate its error; with another the
    /// program does not compile:
    /// ```compile_fail,E0080
    /// # use gyro_sim::{Kutta4, Ode, Solver};
    /// # struct Rest;
    /// # impl Ode for Rest {
    /// #     type Scalar = f64;
    /// #     type State = [f64; 1];
    /// #     fn derivative(&self, _: &(), _: f64, _: &[f64; 1], dy: &mut [f64; 1]) {
    /// #         *dy = [0.0];
    /// #     }
    /// # }
    /// Solver::new(Rest, Kutta4::new(&[0.0]), 0.0, &[0.0]).advance_to(&(), 1.0).unwrap();
    /// ```
    ///
    /// # Errors
    /// [`Error`], with state and time as they were after the last step that was kept.
    pub fn advance_to<M>(&mut self, system: &M, t_end: T) -> Result<(), Error>
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
        C: Correction<D, M>,
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
    /// [`Error`], with state and time as they were before: tolerances that cannot be met, steps that would have to be
    /// too short or too many, a correction that fails however short the step, and a scene that is stiff for the method.
    pub fn step_towards<M>(&mut self, system: &M, t_end: T) -> Result<(), Error>
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
        C: Correction<D, M>,
    {
        self.step_watched(system, t_end, |_| None)
    }

    /// The same, with a say in each attempt before it is judged: where `watch` has a time within the attempt, it is
    /// repeated, not beyond that time. Attempts so repeated count as rejected, and the length that steps have by the
    /// tolerances stays what it is.
    ///
    /// # Errors
    /// As [`Solver::step_towards`].
    pub fn step_watched<M>(
        &mut self,
        system: &M,
        t_end: T,
        watch: impl FnMut(&mut dyn Tried<D, S, T>) -> Option<T>,
    ) -> Result<(), Error>
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
        C: Correction<D, M>,
    {
        self.try_towards(system, t_end, watch).map_err(|error| self.blame(system, error))
    }

    fn try_towards<M>(
        &mut self,
        system: &M,
        t_end: T,
        mut watch: impl FnMut(&mut dyn Tried<D, S, T>) -> Option<T>,
    ) -> Result<(), Error>
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
        C: Correction<D, M>,
    {
        self.is_repeated = false;
        let mut stop = t_end;
        loop {
            let Some(attempt) = self.propose(system, stop)? else { return Ok(()) };
            self.attempt(system, attempt.h);
            let (start, end) = (self.t, attempt.after.0);
            match watch(&mut Watched::new(self, system, (attempt.h, end))) {
                Some(earlier) if start < earlier && earlier < end => {
                    self.statistics.rejected += 1;
                    stop = earlier;
                }
                _ if self.judge(system, &attempt)? => return Ok(()),
                _ => {}
            }
        }
    }

    /// How long the next attempt is to be; none where no attempt is needed.
    pub(crate) fn propose<M>(&mut self, system: &M, t_end: T) -> Result<Option<Attempt<T>>, Error>
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
        C: Correction<D, M>,
    {
        const { assert!(A::ERROR_ORDER > 0, "this method has no error estimate: take steps of fixed length") };
        if !self.is_repeated {
            self.check_control()?;
            self.check_start()?;
            check_time(self.t, t_end)?;
            if t_end <= self.t {
                return Ok(None);
            }
            if self.next_step == T::constant(0.0) {
                self.next_step = self.guess_first_step(system, t_end);
            }
            self.watch(system);
        }
        if self.approach(system, t_end)? {
            return Ok(None);
        }
        let (h, is_last) = self.length(t_end);
        self.check_budget(t_end, h)?;
        let after = if is_last { (t_end, T::constant(0.0)) } else { self.after(h) };
        Ok(Some(Attempt { h, is_last, after }))
    }

    /// Goes on from the end of an attempt, or makes the next one shorter; returns whether it has gone on.
    pub(crate) fn judge<M>(&mut self, system: &M, attempt: &Attempt<T>) -> Result<bool, Error>
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
        C: Correction<D, M>,
    {
        let Attempt { h, is_last, after } = *attempt;
        self.weigh::<M>();
        let (error, index) = self.method.error(h, &self.weights);
        let error = error.to_f64();
        let failure = if error <= 1.0 {
            self.trial.as_mut().copy_from_slice(self.method.end().as_ref());
            match self.settle(system, after.0) {
                Ok(settled) if let Some(shorter) = self.before_pose(system, h, settled.1) => {
                    let shortest = h * T::constant(SHRINKAGE);
                    self.repeat(if shorter < shortest { shortest } else { shorter });
                    return Ok(false);
                }
                Ok(settled) => {
                    self.keep::<M>(after, h, settled);
                    self.grow::<M>(h, error, is_last);
                    return Ok(true);
                }
                Err(failure) => Some(failure),
            }
        } else if error.is_finite() {
            None
        } else {
            Some(Error::NotFinite { t: self.t.to_f64(), index: short(index) })
        };
        if self.approach.is_none() && self.beyond_pose().is_some() {
            self.approach = Some(Approach::default());
        }
        let factor = if failure.is_some() { SHRINKAGE } else { self.factor::<M>(error, 0.0).min(1.0) };
        self.repeat(h * T::constant(factor));
        if self.next_step.to_f64() < self.shortest() {
            return Err(failure.unwrap_or(Error::StepTooShort {
                t: self.t.to_f64(),
                step: self.next_step.to_f64(),
                index: short(index),
            }));
        }
        Ok(false)
    }

    /// The next attempt is of the same step, with this length.
    fn repeat(&mut self, h: T) {
        self.statistics.rejected += 1;
        self.next_step = h;
        self.is_repeated = true;
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

    /// Steps shorter than this do not advance the time, or are excluded by the settings.
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
    pub(super) fn weigh<M>(&mut self)
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
    {
        let [relative, absolute] = [self.control.relative, self.control.absolute].map(T::constant);
        let ends = self.y.as_ref().iter().zip(self.method.end().as_ref());
        for (weight, (start, end)) in self.weights.as_mut().iter_mut().zip(ends) {
            let (start, end) = (start.abs(), end.abs());
            *weight = T::fused(relative, if end > start { end } else { start }, absolute);
        }
    }

    fn grow<M>(&mut self, h: T, error: f64, is_last: bool)
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
    {
        let statistics = &mut self.statistics;
        if !is_last {
            statistics.shortest_step = statistics.shortest_step.min(h.to_f64());
        }
        let factor = self.factor::<M>(error, self.last_error);
        let factor = if core::mem::take(&mut self.is_repeated) { factor.min(1.0) } else { factor };
        self.last_error = error.max(1e-4);
        let next = h * T::constant(factor);
        // A step that was cut short says little about the next one.
        if !is_last || next > self.next_step {
            self.next_step = next;
        }
    }

    /// By how much to change the step: proportional-integral control (Gustafsson; Hairer and Wanner, *Solving ODEs II*,
    /// IV.2), which keeps step sizes from oscillating at the limit of stability. An error before of zero leaves the
    /// proportional part out.
    fn factor<M>(&self, error: f64, before: f64) -> f64
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
    {
        let order = f64::from(A::ERROR_ORDER);
        let damping = 0.2 / order;
        let factor = if before > 0.0 {
            SAFETY * libm::pow(error.max(1e-10), 0.75 * damping - 1.0 / order) * libm::pow(before, damping)
        } else {
            SAFETY * libm::pow(error, -1.0 / order)
        };
        factor.clamp(SHRINKAGE, GROWTH)
    }

    /// A first step by the sizes of the state, of its slope and of the slope's change (Hairer, Nørsett and Wanner,
    /// II.4).
    fn guess_first_step<M>(&mut self, system: &M, t_end: T) -> T
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
    {
        self.dynamics.derivative(system, self.t, &self.y, &mut self.trial);
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
        self.dynamics.derivative(system, self.t + h, &self.weights, before);
        for (change, slope) in before.as_mut().iter_mut().zip(self.trial.as_ref()) {
            *change = *change - *slope;
        }
        self.statistics.work.evaluations += 2;
        let values = self.before.1.as_ref().iter().zip(self.y.as_ref());
        let bend = values.map(|(v, y)| scaled(*v, *y)).fold(0.0, f64::max) / small;
        let order = f64::from(A::ERROR_ORDER);
        let steepest = slope.max(bend);
        let guess = if steepest <= 1e-15 { small * 1e3 } else { libm::pow(0.01 / steepest, 1.0 / order) };
        let guess = guess.min(100.0 * small).min(left);
        T::constant(if guess.is_finite() && guess > 0.0 { guess } else { left * 1e-6 })
    }
}

fn short(index: usize) -> u16 {
    u16::try_from(index).unwrap_or(u16::MAX)
}
