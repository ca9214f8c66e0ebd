//! Which lanes have failed.

use super::{Lanes, all, are_finite};
use crate::{Error, Real};

/// The largest number of lanes in a pack.
pub const MAX_LANES: usize = 8;

/// The errors of the lanes. A lane fails once and keeps the state in which it failed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Failures {
    errors: [Option<Error>; MAX_LANES],
}

impl Failures {
    /// The error of a lane, if it has failed.
    pub fn of(&self, lane: usize) -> Option<Error> {
        self.errors.get(lane).copied().flatten()
    }

    /// How many lanes have failed.
    pub fn count(&self) -> usize {
        self.errors.iter().flatten().count()
    }

    /// The lanes of a pack that have not failed, a bit for each.
    pub(super) fn running<T: Lanes>(&self) -> u32 {
        let failed = (0..).zip(&self.errors).filter(|(_, error)| error.is_some());
        all::<T>() & !failed.fold(0, |bits, (lane, _)| bits | 1 << lane)
    }

    /// Notes the error of each of these lanes.
    pub(super) fn note(&mut self, lanes: u32, error: impl Fn(usize) -> Error) {
        let failed = (0..).zip(&mut self.errors).filter(|(lane, _)| lanes >> lane & 1 == 1);
        failed.for_each(|(lane, entry)| *entry = Some(error(lane)));
    }

    /// Notes an error that is that of all running lanes.
    pub(super) fn note_all<T: Lanes>(&mut self, outcome: Result<(), Error>) {
        if let Err(error) = outcome {
            self.note(self.running::<T>(), |_| error);
        }
    }

    /// Notes the running lanes whose time does not stay finite: a system that time does not enter would not notice.
    pub(super) fn note_invalid_end_time<T: Lanes>(&mut self, t: T, t_end: T) {
        let failed = self.running::<T>() & !T::bits(are_finite(&[t, t_end]));
        let to_f64 = |time: T, lane: usize| time.lane(lane).to_f64();
        self.note(failed, |lane| Error::InvalidEndTime { t: to_f64(t, lane), t_end: to_f64(t_end, lane) });
    }

    /// Notes the running lanes whose state is no longer finite.
    pub(super) fn note_not_finite<T: Lanes>(&mut self, t: T, state: &[T]) {
        let failed = self.running::<T>() & !T::bits(are_finite(state));
        self.note(failed, |lane| {
            let index = (0u16..).zip(state).find(|(_, x)| !x.lane(lane).is_finite());
            Error::NotFinite { t: t.lane(lane).to_f64(), index: index.map_or(0, |(index, _)| index) }
        });
    }
}
