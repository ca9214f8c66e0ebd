//! Singular poses under steps of fixed length: detected and reported.
//!
//! Such steps end where they end: near a pose or in it, with accelerations that are quotients of small numbers, and
//! nothing is tried again. Mostly they come through on the right way. But where a step covers what is left of the way
//! to a pose, or the joints are apart by more than the ways on are, nothing in the state says so, and whoever reads the
//! result must know.

use super::Solver;
use super::poses::{FLOOR, Watch};
use crate::contract::Storage;
#[cfg(feature = "wire")]
use crate::wire::*;
use crate::{Clearance, Correction, Ode, Owner, Real};

/// A singular pose that steps of fixed length have passed so near that the way they have gone on in may be another than
/// the motion's.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "wire", derive(SerBin, DeBin))]
pub struct Passage {
    /// The time of the state nearest to the pose, s.
    pub t: f64,
    /// How clear of the pose that was: [`Clearance::pivot`].
    pub pivot: f64,
    /// Whose constraint depends on others in the pose, where that is known.
    pub owner: Option<Owner>,
}

/// How clear of poses the last state was, and whether a passage is under way.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearness<T> {
    /// Of the last state.
    last: T,
    /// By how much the last step has diminished it.
    fall: T,
    /// Of any state so far.
    widest: T,
    /// Least in the passage under way, if there is one.
    least: Option<T>,
}

/// A pose is near where the clearance is less than this part of what it was at most.
const SMALL: f64 = 0.3;
/// A step of which this part leads to a pose at the pace of the last one may end in it.
const AHEAD: f64 = 2.0;
/// It has been left when the clearance is so many times what it was at least.
const LEFT: f64 = 4.0;

impl<T: Real> Nearness<T> {
    fn at_start(clearance: T) -> Self {
        Self { last: clearance, fall: T::constant(0.0), widest: clearance, least: None }
    }

    /// How near a pose is that is being passed, or that comes within the next step.
    pub(super) fn nearest(&self) -> Option<T> {
        self.least.or_else(|| (self.last <= self.fall * T::constant(AHEAD)).then_some(self.last))
    }

    /// Whether the step to here could have passed a pose, which is a matter of proportion: it has changed the clearance
    /// by as much as was left.
    fn leaps(&self, now: T) -> bool {
        let less = if now < self.last { now } else { self.last };
        (now - self.last).abs() >= less
    }
}

impl<D, S: Storage<T>, T: Real, A, C> Solver<D, S, T, A, C> {
    /// Before the first step of fixed length: whether there are poses to look out for.
    pub(super) fn look_out<M>(&mut self, system: &M)
    where
        D: Ode<M, Scalar = T, State = S>,
        C: Correction<D, M>,
    {
        if self.watch == Watch::Needless || self.nearness.is_some() {
            return;
        }
        let clearance = self.correction.clearance(system, self.t, &self.y);
        self.watch = if clearance.is_some() { Watch::Needed } else { Watch::Needless };
        self.nearness = clearance.map(|clearance| Nearness::at_start(clearance.pivot));
    }

    /// After a step of fixed length: notes a pose that it has come too near to.
    pub(super) fn look_back<M>(&mut self, system: &M)
    where
        D: Ode<M, Scalar = T, State = S>,
        C: Correction<D, M>,
    {
        let Some(mut nearness) = self.nearness else { return };
        let Some(clearance) = self.correction.clearance(system, self.t, &self.y) else { return };
        let now = clearance.pivot;
        if !now.is_finite() {
            // The state has become too large to tell: a passage under way goes on.
            return;
        }
        let is_close = nearness.leaps(now) || self.is_blurred(system, (nearness, now));
        if is_close {
            self.note_pose(&clearance, nearness.least);
        }
        nearness.least = match nearness.least {
            Some(least) if is_close || now < least * T::constant(LEFT) => {
                Some(if now < least { now } else { least })
            }
            _ => is_close.then_some(now),
        };
        nearness.widest = if now > nearness.widest { now } else { nearness.widest };
        (nearness.fall, nearness.last) = (nearness.last - now, now);
        self.nearness = Some(nearness);
    }

    /// Whether near a pose the joints are apart by more than tells the ways on from each other: drifted apart, a
    /// linkage turns before the pose, or elsewhere.
    fn is_blurred<M>(&mut self, system: &M, (nearness, now): (Nearness<T>, T)) -> bool
    where
        D: Ode<M, Scalar = T, State = S>,
        C: Correction<D, M>,
    {
        now < nearness.widest * T::constant(SMALL) && {
            let drift = self.correction.violation(system, self.t, &self.y) + T::EPSILON;
            now * now <= T::constant(FLOOR) * drift
        }
    }

    /// A passage is counted once; the first is kept with its nearest state.
    fn note_pose(&mut self, clearance: &Clearance<T>, least: Option<T>) {
        let passage = Passage { t: self.t.to_f64(), pivot: clearance.pivot.to_f64(), owner: clearance.owner };
        let statistics = &mut self.statistics;
        statistics.passages += u64::from(least.is_none());
        let is_nearest = least.is_none_or(|least| clearance.pivot < least);
        if statistics.passages == 1 && is_nearest {
            statistics.first_passage = Some(passage);
        }
    }
}
