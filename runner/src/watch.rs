//! Events in a run: what is looked for, and what was found.

use crate::Seen;
use crate::formula::Formula;
use gyro_sim::Real;
use gyro_sim::events::Direction;
use nanoserde::{DeBin, SerBin};

/// A formula of numbers of the mechanism that crosses a level.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub struct Watch {
    /// What crosses.
    pub of: Formula,
    /// The level.
    pub level: f64,
    /// Whether crossings from below to the level or above count.
    pub rising: bool,
    /// Whether those from above to the level or below do.
    pub falling: bool,
    /// Whether the run ends at the first one.
    pub stops: bool,
}

impl Watch {
    /// Most of a run.
    pub const MOST: usize = 16;

    fn direction(&self) -> Direction {
        match (self.rising, self.falling) {
            (true, false) => Direction::Rising,
            (false, true) => Direction::Falling,
            _ => Direction::Both,
        }
    }
}

/// Something that has happened at an instant.
#[derive(Clone, Copy, Debug, PartialEq, SerBin, DeBin)]
pub struct Occurrence {
    /// The time, s.
    pub t: f64,
    /// What it was.
    pub what: What,
}

/// What has happened.
#[derive(Clone, Copy, Debug, PartialEq, SerBin, DeBin)]
pub enum What {
    /// A level was crossed.
    Crossed {
        /// Which of [`Start::watches`](crate::Start::watches).
        event: usize,
        /// Whether upwards.
        rises: bool,
    },
    /// A coordinate has hit a stop.
    Hit {
        /// Which of [`Start::contacts`](crate::Start::contacts).
        contact: usize,
        /// Its rate just before, rad/s or m/s.
        before: f64,
        /// Its rate after the impact.
        after: f64,
    },
    /// The velocity of something driven jumps.
    Kinks {
        /// Which of [`Start::paths`](crate::Start::paths).
        path: usize,
        /// The velocity just before, rad/s or m/s.
        before: f64,
        /// That after it.
        after: f64,
    },
    /// A coordinate rests on a stop from now on.
    Rests {
        /// Which contact.
        contact: usize,
    },
    /// A stop has let a coordinate go.
    Leaves {
        /// Which contact.
        contact: usize,
    },
    /// Friction holds a coordinate from now on.
    Sticks {
        /// Which contact.
        contact: usize,
    },
    /// A coordinate that stuck begins to move.
    Slips {
        /// Which contact.
        contact: usize,
    },
}

/// What is looked for in a run, between one step and the next.
#[derive(Clone, Debug)]
pub(crate) struct Watches<T> {
    watches: Vec<Watch>,
    directions: [Direction; Watch::MOST],
    /// The values at the end of the last step.
    last: Option<[T; Watch::MOST]>,
    /// When the run is to end, s.
    pub(crate) end: Option<f64>,
}

impl<T: Real> Watches<T> {
    pub(crate) fn new(watches: &[Watch]) -> Self {
        let direction = |k: usize| watches.get(k).map_or(Direction::Both, Watch::direction);
        Self { watches: watches.to_vec(), directions: std::array::from_fn(direction), last: None, end: None }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.watches.is_empty()
    }

    pub(crate) fn directions(&self) -> [Direction; Watch::MOST] {
        self.directions
    }

    /// What crosses zero; those that do not exist never do.
    pub(crate) fn values(&self, see: impl Fn(Seen) -> T) -> [T; Watch::MOST] {
        std::array::from_fn(|k| {
            self.watches
                .get(k)
                .map_or(T::constant(1.0), |watch| watch.of.value(&see) - T::constant(watch.level))
        })
    }

    /// Crossings by a jump, since the last step's end.
    pub(crate) fn jumped(&self, now: &[T; Watch::MOST]) -> Vec<What> {
        let (zero, Some(last)) = (T::constant(0.0), &self.last) else { return Vec::new() };
        let crossing = |event: usize| {
            let rises = last[event] < zero && now[event] >= zero;
            let falls = last[event] > zero && now[event] <= zero;
            let counts = match self.directions[event] {
                Direction::Rising => rises,
                Direction::Falling => falls,
                Direction::Both => rises || falls,
            };
            counts.then_some(What::Crossed { event, rises })
        };
        (0..self.watches.len()).filter_map(crossing).collect()
    }

    /// The values at the end of the last step, if nothing has changed since.
    pub(crate) fn last(&self) -> Option<[T; Watch::MOST]> {
        self.last
    }

    pub(crate) fn leave_at(&mut self, values: [T; Watch::MOST]) {
        self.last = Some(values);
    }

    /// Notes a crossing; whether the run ends with it.
    pub(crate) fn ends_with(&mut self, occurrence: Occurrence) -> bool {
        let What::Crossed { event, .. } = occurrence.what else { return false };
        let ends = self.watches[event].stops;
        if ends && self.end.is_none() {
            self.end = Some(occurrence.t);
        }
        ends
    }
}
