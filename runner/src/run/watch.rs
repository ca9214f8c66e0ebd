//! Events within steps.

use super::Run;
use crate::formula::Seen;
use crate::{Occurrence, Watch, What};
use gyro_sim::events::crossings;
use gyro_sim::{Error, JointCoordinate, Mechanism, Partition, Real, Scalar, Turns};
use std::cell::RefCell;
use std::ops::ControlFlow;

/// What is seen of a mechanism: its outputs, and its joints as they were last read.
pub(super) fn seen<M: Mechanism<Scalar: Real>>(
    mechanism: &M,
    outputs: &[M::Scalar],
    turns: &Turns<M>,
    t: M::Scalar,
    what: Seen,
) -> M::Scalar {
    let scalar = |joint, k| match turns.coordinate(mechanism, joint, k) {
        Some(JointCoordinate::Angle { position, rate } | JointCoordinate::Length { position, rate }) => {
            [position, rate]
        }
        _ => [Scalar::constant(f64::NAN); 2],
    };
    match what {
        Seen::Output(index) => outputs[index],
        Seen::Coordinate(joint, k) => scalar(joint, k)[0],
        Seen::Rate(joint, k) => scalar(joint, k)[1],
        Seen::Time => t,
        Seen::Input(..) | Seen::Distance(_) | Seen::DistanceRate(_) => Scalar::constant(f64::NAN),
    }
}

impl<M: Partition<Scalar: Real> + Clone> Run<'_, M> {
    /// What happens at once: what jumped since the last step's end, as an input does that is set anew.
    pub(super) fn watch_jumps(&mut self) -> Result<Vec<Occurrence>, Error> {
        if self.watches.is_empty() {
            return Ok(Vec::new());
        }
        let t = self.motion.time();
        let now = self.watched(t)?;
        let found: Vec<Occurrence> =
            self.watches.jumped(&now).into_iter().map(|what| Occurrence { t, what }).collect();
        self.watches.leave_at(now);
        Ok(self.up_to_the_end(found))
    }

    /// The crossings within the last step, which began at this time.
    pub(super) fn watch_step(&mut self, from: f64) -> Result<Vec<Occurrence>, Error> {
        let to = self.motion.time();
        if self.watches.is_empty() || to <= from {
            return Ok(Vec::new());
        }
        let (directions, begin) = (self.watches.directions(), self.watches.last());
        let (mut found, mut end) = (Vec::new(), None);
        let run = RefCell::new(&mut *self);
        let values = |t: M::Scalar| {
            let t = t.to_f64();
            if let Some(begin) = begin.filter(|_| t <= from) {
                return Ok(begin);
            }
            let values = run.borrow_mut().watched(t)?;
            if t >= to {
                end = Some(values);
            }
            Ok(values)
        };
        let tell = |crossing: gyro_sim::events::Crossing<M::Scalar>| {
            let what = What::Crossed { event: crossing.event, rises: crossing.rises };
            found.push(Occurrence { t: crossing.t.to_f64(), what });
            Ok::<_, Error>(ControlFlow::Continue(()))
        };
        let ends = [from, to].map(M::Scalar::constant);
        let _ = crossings(&directions, ends, values, tell)?;
        if let Some(end) = end {
            self.watches.leave_at(end);
        }
        Ok(self.up_to_the_end(found))
    }

    /// Those up to one with which the run ends.
    fn up_to_the_end(&mut self, mut found: Vec<Occurrence>) -> Vec<Occurrence> {
        if let Some(last) = found.iter().position(|occurrence| self.watches.ends_with(*occurrence)) {
            let end = found[last].t;
            found.retain(|occurrence| occurrence.t <= end);
        }
        found
    }

    /// What is looked for, at a time within the last step.
    fn watched(&mut self, t: f64) -> Result<[M::Scalar; Watch::MOST], Error> {
        self.look_at(t)?;
        let Self { mechanism, watches, turns, observer, y, read_at, .. } = self;
        let (time, dt) = (M::Scalar::constant(t), M::Scalar::constant(t - *read_at));
        let mut turns = turns.clone();
        turns.update(mechanism, time, dt, y);
        let outputs = observer.outputs(mechanism, time, y);
        let values = watches.values(|what| seen(&**mechanism, outputs, &turns, time, what));
        match values.iter().position(|value| !value.is_finite()) {
            Some(_) => Err(Error::NotFinite { t, index: u16::MAX }),
            None => Ok(values),
        }
    }
}
