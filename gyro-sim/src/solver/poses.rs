//! Singular poses under error control: foreseen, stepped over, or named.
//!
//! A motion through a pose where rows become dependent is as smooth as elsewhere. But accelerations are quotients of
//! numbers that vanish there, so that stages, which lie off the constraints, see them of any size, and what corrections
//! know is divided by a pivot once for positions and twice for velocities. So the pose is not stepped through but over:
//! see [`Solver::leap`].

use super::Solver;
use crate::contract::Storage;
use crate::integrate::Method;
use crate::scalar::largest_magnitude;
use crate::{Clearance, Correction, Error, Ode, Owner, Real, System};

/// The way to a singular pose.
#[derive(Clone, Copy, Debug)]
pub(super) struct Approach {
    attempts: u32,
    /// What the last leap that was refused would have been off by.
    error: f64,
}

impl Default for Approach {
    fn default() -> Self {
        Self { attempts: 0, error: f64::INFINITY }
    }
}

/// Whether a system has singular poses that can be detected.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Watch {
    Unknown,
    Needless,
    Needed,
}

/// The nearer a pose the less extrapolation is off, until rounding makes it worse again: then as much as this is
/// tolerated of the last chance.
const WORST: f64 = 100.0;
/// Steps towards a pose go this part of the way, so that states lie close enough together to extrapolate them.
const APPROACH: f64 = 0.35;
/// So many steps lead to any pose that can be passed: each goes the same part of the way.
const LONGEST_APPROACH: u32 = 300;
/// With a pivot below this whatever fails does so because of the pose.
const IN_POSE: f64 = 1e-3;
/// A step is looked into at so many places.
const LOOKS: u32 = 8;
/// It is not where the clearance after it is off what is expected by less than this part of it.
const EXPECTED: f64 = 0.25;
/// A leap ends as clear of the pose as it began, to within this factor: where a pivot vanishes linearly, on the other
/// side.
const BEYOND: f64 = 0.25;
/// A correction may change a step's result by so many times what is tolerated: by more, and the step was not what its
/// error estimate says.
const AGREEMENT: f64 = 10.0;

/// What rounding makes of velocities near a pose, see [`Solver::rounding`], is so many times larger after a correction:
/// an allowance.
const ROUNDINGS: f64 = 64.0;
/// And in states that are extrapolated.
const NOISE: f64 = 8.0;
/// Where that is more than so many times what is tolerated, a pose is not passed.
const MOST_NOISE: f64 = 2e5;
/// The square of the pivot is at least so many times what the constraints are off: by as much as that the ways through
/// a pose are apart.
pub(super) const FLOOR: f64 = 100.0;

impl<D, S: Storage<T>, T: Real, A, C> Solver<D, S, T, A, C> {
    /// In a singular pose there are many ways to fail, for this one reason.
    pub(super) fn blame<M>(&self, system: &M, error: Error) -> Error
    where
        D: Ode<M, Scalar = T, State = S>,
        C: Correction<D, M>,
    {
        let is_symptom = matches!(
            error,
            Error::NotFinite { .. }
                | Error::Singular { owner: None, .. }
                | Error::StepTooShort { .. }
                | Error::TooManySteps { .. }
                | Error::Stiff { .. }
        );
        let clearance = (is_symptom && self.watch == Watch::Needed)
            .then(|| self.correction.clearance(system, self.t, &self.y))
            .flatten();
        let Some(Clearance { pivot, owner }) = clearance else { return error };
        // Under steps of fixed length the pose may be one step away, or some behind.
        let nearest = self.nearness.and_then(|nearness| nearness.nearest());
        match nearest.or_else(|| (pivot < T::constant(IN_POSE)).then_some(pivot)) {
            Some(pivot) => Error::Singular { t: self.t.to_f64(), pivot: pivot.to_f64(), owner },
            None => error,
        }
    }

    /// Begins to remember states where there are singular poses.
    pub(super) fn watch<M>(&mut self, system: &M)
    where
        D: Ode<M, Scalar = T, State = S>,
        C: Correction<D, M>,
    {
        if self.watch == Watch::Needless || self.past.len() > 0 {
            return;
        }
        self.watch = match self.correction.clearance(system, self.t, &self.y) {
            Some(clearance) => {
                self.past.push(self.t, clearance.pivot, &self.y);
                Watch::Needed
            }
            None => Watch::Needless,
        };
    }

    /// Corrects the trial if that is due; returns whether it was, and how clear it is of singular poses where there are
    /// any.
    ///
    /// There it must not be changed by much more than the weights allow: else it was not near the motion, whatever its
    /// error estimate says, but perhaps near another one. And the pose must be farther away than what the constraints
    /// are off: else nothing tells the ways on from each other.
    pub(super) fn settle<M>(&mut self, system: &M, t: T) -> Result<(bool, Option<T>), Error>
    where
        D: Ode<M, Scalar = T, State = S>,
        C: Correction<D, M>,
    {
        if self.watch != Watch::Needed {
            return Ok((self.correct_trial(system, t)?, None));
        }
        self.raw.as_mut().copy_from_slice(self.trial.as_ref());
        let is_corrected = self.correct_trial(system, t)?;
        let Some(Clearance { pivot, owner }) = self.correction.clearance(system, t, &self.trial) else {
            return Ok((is_corrected, None));
        };
        let owner = owner.unwrap_or(Owner::Body(0));
        let drift = self.correction.violation(system, t, &self.trial) + T::EPSILON;
        if pivot * pivot <= T::constant(FLOOR) * drift {
            return Err(Error::Singular { t: t.to_f64(), pivot: pivot.to_f64(), owner: Some(owner) });
        }
        let found = self.change_beyond(self.rounding(pivot) * T::constant(ROUNDINGS));
        // What has drifted over several steps, or came with the start, is not this step's.
        if is_corrected && self.since_correction == 0 && self.past.len() > 1 && found > AGREEMENT {
            let differences =
                self.raw.as_ref().iter().zip(self.trial.as_ref()).map(|(a, b)| (*a - *b).abs().to_f64());
            let change = differences.fold(0.0, f64::max);
            return Err(Error::Jump { t: t.to_f64(), change, limit: change * AGREEMENT / found, owner });
        }
        Ok((is_corrected, Some(pivot)))
    }

    /// How far a step that is to end with this clearance may go, where the motion within it passes a singular pose or
    /// comes close to one.
    ///
    /// Stages near a pose see accelerations of any size, and error estimates need not. So a step whose end is not as
    /// clear as the last two states make expect is looked into: near a pose the clearance falls by half from one look
    /// to the next.
    pub(super) fn before_pose<M>(&mut self, system: &M, h: T, pivot: Option<T>) -> Option<T>
    where
        D: Ode<M, Scalar = T, State = S>,
        A: Method<D, M>,
        C: Correction<D, M>,
    {
        if self.is_expected(h, pivot?) {
            return None;
        }
        let Self { method, dynamics, correction, statistics, y, raw, .. } = self;
        method.prepare(System { dynamics, model: system }, self.t, h, y, &mut statistics.work);
        let mut last = correction.clearance(system, self.t, y)?.pivot;
        for look in 1..=LOOKS {
            let theta = T::constant(f64::from(look) / f64::from(LOOKS));
            method.between(theta, raw);
            let now = correction.clearance(system, self.t + theta * h, raw)?.pivot;
            if now + now < last {
                return Some(T::constant(f64::from(look - 1) / f64::from(LOOKS)) * h);
            }
            last = now;
        }
        None
    }

    /// Whether the clearance after a step is about what those of the last two states lead to.
    fn is_expected(&self, h: T, pivot: T) -> bool {
        let Some([now, before]) = self.past.last_two() else { return false };
        let expected = now.pivot + (now.pivot - before.pivot) / (now.t - before.t) * h;
        let less = if pivot < now.pivot { pivot } else { now.pivot };
        (pivot - expected).abs() < less * T::constant(EXPECTED)
    }

    /// What rounding makes of a state as clear of singular poses as this: positions are known to a rounding over the
    /// pivot, and so velocities, along what the pivot belongs to, to one over its square.
    fn rounding(&self, pivot: T) -> T {
        T::EPSILON * largest_magnitude(self.y.as_ref().iter().copied()) / (pivot * pivot)
    }

    /// By how much a correction has changed the trial, not counting so much of each element: the root mean square in
    /// units of the weights.
    fn change_beyond(&self, rounding: T) -> f64 {
        let (mut sum, mut n) = (0.0, 0.0);
        let ends = self.raw.as_ref().iter().zip(self.trial.as_ref()).zip(self.weights.as_ref());
        for ((raw, corrected), weight) in ends {
            let change = ((*corrected - *raw).abs() - rounding) / *weight;
            let part = change.to_f64().max(0.0);
            (sum, n) = (sum + part * part, n + 1.0);
        }
        libm::sqrt(sum / n)
    }

    /// Where a singular pose lies within the next step, or ahead of one that has failed: steps over it, and returns so,
    /// or shortens the next step to a part of the way there.
    pub(super) fn approach<M>(&mut self, system: &M, t_end: T) -> Result<bool, Error>
    where
        D: Ode<M, Scalar = T, State = S>,
        C: Correction<D, M>,
    {
        let Some((length, pivot)) = self.beyond_pose() else {
            self.approach = None;
            return Ok(false);
        };
        if self.approach.is_none() && length < self.next_step + self.next_step {
            self.approach = Some(Approach::default());
        }
        let longest = length * T::constant(0.5 * APPROACH);
        let Some(approach) = &mut self.approach else { return Ok(false) };
        // Steps that the tolerance keeps short lead to no pose.
        approach.attempts += u32::from(self.next_step > longest);
        let is_too_long = approach.attempts > LONGEST_APPROACH;
        self.weigh_state();
        if is_too_long || self.in_tolerances(self.rounding(pivot) * T::constant(NOISE)) > MOST_NOISE {
            let owner =
                self.correction.clearance(system, self.t, &self.y).and_then(|clearance| clearance.owner);
            return Err(Error::Singular { t: self.t.to_f64(), pivot: pivot.to_f64(), owner });
        }
        if self.leap(system, t_end) {
            self.approach = None;
            return Ok(true);
        }
        if self.next_step > longest {
            self.next_step = longest;
        }
        Ok(false)
    }

    /// Steps over a singular pose that lies within a step that has failed; returns whether it has come through.
    ///
    /// A motion through such a pose is as smooth as elsewhere, but its accelerations are quotients of numbers that
    /// vanish there: the nearer, the fewer digits they have, and off the constraints they are of any size. So the last
    /// states are extrapolated to about as far behind the pose as the motion is before it, and what two polynomials
    /// differ by must be within the tolerance, as must be what the correction changes: the constraints have not been
    /// asked so far, and have to agree.
    fn leap<M>(&mut self, system: &M, t_end: T) -> bool
    where
        D: Ode<M, Scalar = T, State = S>,
        C: Correction<D, M>,
    {
        let Some((length, pivot)) = self.beyond_pose() else { return false };
        let left = t_end - self.t;
        let (length, after) =
            if length < left { (length, self.after(length)) } else { (left, (t_end, T::constant(0.0))) };
        let Some((degree, error)) =
            self.past.best_fit(after.0, &self.weights, self.rounding(pivot) * T::constant(NOISE))
        else {
            return false;
        };
        let before =
            self.approach.as_mut().map_or(0.0, |approach| core::mem::replace(&mut approach.error, error));
        let allowed = if error > before { WORST } else { 1.0 };
        if error.is_nan() || error > allowed {
            return false;
        }
        self.past.at(after.0, degree, &mut self.trial);
        let Ok(settled) = self.settle(system, after.0) else { return false };
        if !settled.1.is_some_and(|landing| landing > pivot * T::constant(BEYOND)) {
            return false;
        }
        self.is_untouched = false;
        self.go_on(after, length, settled);
        (self.is_kept, self.resumes, self.leap) = (false, false, Some(degree));
        self.statistics.leaps += 1;
        self.next_step = length;
        true
    }

    /// What is tolerated of each element by its size: an attempt that came too near the pose may have ended anywhere.
    fn weigh_state(&mut self) {
        let [relative, absolute] = [self.control.relative, self.control.absolute].map(T::constant);
        for (weight, y) in self.weights.as_mut().iter_mut().zip(self.y.as_ref()) {
            *weight = T::fused(relative, y.abs(), absolute);
        }
    }

    /// The same change of all elements: the root mean square in units of the weights.
    fn in_tolerances(&self, change: T) -> f64 {
        let (mut sum, mut n) = (0.0, 0.0);
        for weight in self.weights.as_ref() {
            let part = (change / *weight).to_f64();
            (sum, n) = (sum + part * part, n + 1.0);
        }
        libm::sqrt(sum / n)
    }

    /// The length of a step to behind the pose ahead, if there is one, and how clear of it the state is.
    pub(super) fn beyond_pose(&self) -> Option<(T, T)> {
        let [now, before] = self.past.last_two()?;
        if now.pivot >= before.pivot {
            return None;
        }
        let distance = (now.t - before.t) * now.pivot / (before.pivot - now.pivot);
        Some((distance + distance, now.pivot))
    }
}
