//! Singular poses under steps of fixed length: stepped over from one point of the grid to another, or named.
//!
//! There is no tolerance to meet. A leap is made as soon as it is as good as it gets, and must be good enough to tell the ways on
//! from each other; a pose that no leap leads over is named before it is reached. See [`poses`](super::poses) for the reasons.

use super::Solver;
use super::poses::{Approach, BEYOND, FLOOR, NOISE, WORST};
use crate::integrate::Method;
use crate::{Clearance, Correction, Error, Ode, Real, Storage};

/// Steps on their way over a pose; the last state that is known is where they land.
#[derive(Clone, Copy, Debug)]
pub(super) struct Flight<T> {
    landing: T,
    degree: usize,
}

/// Leaps that are off by no more than this part of the state are made at once, or by so many roundings.
const STRICT: f64 = 1e-10;
const STRICT_EPSILONS: f64 = 64.0;
/// By no more than this part when there is no other chance: the ways on are apart by the whole velocity.
const LOOSE: f64 = 1e-2;
/// Poses are looked at when they are no more than so many steps away.
const AHEAD: f64 = 8.0;
/// Nearer than so many steps any leap is made that tells the ways apart: the steps that would follow see accelerations of any size.
const NEAR: f64 = 2.0;
/// Nearer than this a pose over which no leap leads is named.
const NEAREST: f64 = 1.0;
/// Behind a pose the constraints are off by so many times more than before and by extrapolation at most.
const EXPLAINED: f64 = 10.0;
/// A pose has been passed unseen if the pivot, as it rises, was zero within this part of the step before.
const UNSEEN: f64 = 0.9;
/// Times nearer to each other than this part of a step are one.
const COINCIDENT: f64 = 1e-9;

impl<S: Storage<T>, T: Real, M, C> Solver<S, T, M, C> {
    /// A step of fixed length where there are singular poses.
    pub(super) fn step_watched<O>(&mut self, system: &O, h: T) -> Result<(), Error>
    where
        O: Ode<Scalar = T, State = S>,
        M: Method<O>,
        C: Correction<O>,
    {
        if self.flight.is_none() && !self.take_off(system, h)? {
            return self.step_on(system, h);
        }
        match self.flight {
            Some(flight) => self.fly(system, h, flight),
            None => Ok(()),
        }
    }

    /// How clear of poses the trial is, where there are any.
    pub(super) fn pivot_of_trial<O>(&self, system: &O, t: T) -> Option<T>
    where
        O: Ode<Scalar = T, State = S>,
        C: Correction<O>,
    {
        let is_needed = self.watch == super::Watch::Needed;
        let clearance = is_needed.then(|| self.correction.clearance(system, t, &self.trial)).flatten();
        clearance.map(|clearance| clearance.pivot)
    }

    /// Begins to step over a pose where one is near and states before it tell how; returns whether.
    fn take_off<O>(&mut self, system: &O, h: T) -> Result<bool, Error>
    where
        O: Ode<Scalar = T, State = S>,
        C: Correction<O>,
    {
        let ahead = self.beyond_pose().filter(|(length, _)| *length < h * T::constant(2.0 * AHEAD));
        let Some((length, pivot)) = ahead else {
            self.approach = None;
            return Ok(false);
        };
        let distance = (length / h).to_f64() / 2.0;
        if self.leap_on_grid(system, (h, pivot), distance) {
            self.approach = None;
            return Ok(true);
        }
        if distance < NEAREST { Err(self.singular(system, pivot)) } else { Ok(false) }
    }

    fn singular<O>(&self, system: &O, pivot: T) -> Error
    where
        O: Ode<Scalar = T, State = S>,
        C: Correction<O>,
    {
        let owner = self.correction.clearance(system, self.t, &self.y).and_then(|clearance| clearance.owner);
        Error::Singular { t: self.t.to_f64(), pivot: pivot.to_f64(), owner }
    }

    /// Extrapolates to the first point of the grid that is as far behind the pose as the state is before it; returns whether the
    /// steps up to there are a flight now.
    fn leap_on_grid<O>(&mut self, system: &O, (h, pivot): (T, T), distance: f64) -> bool
    where
        O: Ode<Scalar = T, State = S>,
        C: Correction<O>,
    {
        let length = h * T::constant(libm::ceil(2.0 * distance).max(1.0));
        let landing = self.after(length).0;
        let strict = T::constant(STRICT.max(STRICT_EPSILONS * T::EPSILON.to_f64()));
        for (weight, y) in self.weights.as_mut().iter_mut().zip(self.y.as_ref()) {
            *weight = T::fused(strict, y.abs(), strict);
        }
        let noise = self.rounding(pivot) * T::constant(NOISE);
        let Some((degree, error)) = self.past.best_fit(landing, &self.weights, noise) else { return false };
        let approach = self.approach.get_or_insert_with(Approach::default);
        let before = core::mem::replace(&mut approach.error, error);
        let allowed = if distance < NEAR {
            LOOSE / strict.to_f64()
        } else if error > before {
            WORST
        } else {
            1.0
        };
        if error.is_nan() || error > allowed {
            return false;
        }
        self.past.at(landing, degree, &mut self.trial);
        let off = strict * T::constant(error) + noise;
        let Some(beyond) = self.lands(system, landing, (pivot, off)) else { return false };
        self.past.push(landing, beyond, &self.trial);
        self.past.turn();
        self.flight = Some(Flight { landing, degree });
        self.statistics.leaps += 1;
        true
    }

    /// How clear of poses the trial is, if it lies behind one and the constraints are met there as well as they can be.
    fn lands<O>(&mut self, system: &O, t: T, (pivot, off): (T, T)) -> Option<T>
    where
        O: Ode<Scalar = T, State = S>,
        C: Correction<O>,
    {
        let before = self.correction.violation(system, self.t, &self.y) + T::EPSILON;
        let behind = self.correction.violation(system, t, &self.trial);
        let Clearance { pivot: landing, .. } = self.correction.clearance(system, t, &self.trial)?;
        let is_clear =
            landing > pivot * T::constant(BEYOND) && landing * landing > T::constant(FLOOR) * behind;
        let is_explained = behind <= T::constant(EXPLAINED) * (before + off);
        (is_clear && is_explained).then_some(landing)
    }

    /// A step of a flight, and beyond it where it is longer.
    fn fly<O>(&mut self, system: &O, h: T, flight: Flight<T>) -> Result<(), Error>
    where
        O: Ode<Scalar = T, State = S>,
        M: Method<O>,
        C: Correction<O>,
    {
        let after = self.after(h);
        let left = flight.landing - after.0;
        let rounding = T::EPSILON * T::constant(4.0) * flight.landing.abs();
        let slight = h.abs() * T::constant(COINCIDENT) + rounding;
        if left > slight {
            self.past.at(after.0, flight.degree + 1, &mut self.trial);
            self.glide(after, h, flight);
            return Ok(());
        }
        self.past.newest(&mut self.trial);
        if left.abs() <= slight {
            self.glide(after, h, flight);
            self.flight = None;
            return Ok(());
        }
        let (t, t_rest) = (self.t, self.t_rest);
        self.glide((flight.landing, T::constant(0.0)), flight.landing - t, flight);
        self.flight = None;
        let outcome = self.step_on(system, after.0 - flight.landing);
        if outcome.is_err() {
            (self.t, self.t_rest, self.flight) = (t, t_rest, Some(flight));
            core::mem::swap(&mut self.before.1, &mut self.y);
        }
        outcome
    }

    fn glide(&mut self, after: (T, T), h: T, flight: Flight<T>) {
        self.move_on(after, h);
        (self.is_untouched, self.is_kept, self.resumes) = (false, false, false);
        self.leap = Some(flight.degree);
    }

    /// A pose right behind the start cannot be foreseen, but the pivot has come from zero in less time than the steps took: which way
    /// the motion has gone there nobody knows.
    pub(super) fn refuse_unseen<O>(&self, system: &O, (t, pivot): (T, Option<T>)) -> Result<(), Error>
    where
        O: Ode<Scalar = T, State = S>,
        C: Correction<O>,
    {
        let (Some(pivot), Some([now, before])) = (pivot, self.past.last_two()) else { return Ok(()) };
        let since = now.pivot * (t - now.t);
        let whole = (pivot - now.pivot) * (now.t - before.t);
        if pivot > now.pivot && since < whole * T::constant(UNSEEN) {
            return Err(self.singular(system, now.pivot));
        }
        Ok(())
    }
}
