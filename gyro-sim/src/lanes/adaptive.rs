//! Steps under error control in lanes: each has a time, a step and an acceptance of its own.
//!
//! Each lane has a [`Solver`] that decides as it does alone; only the attempts that it asks for are computed with those
//! of the other lanes. A lane that has come to its end takes up the next motion while the others go on.

use crate::contract::Storage;
use crate::integrate::{Embedded, Method, Work};
use crate::lanes::MAX_LANES;
use crate::solver::{Attempt, Control};
use crate::{Error, Lanes, Ode, Real, Scalar, Solver, System, Uncorrected};
use core::marker::PhantomData;

/// Integrates the equations `D` of packs with the method `A`; `E` are the equations of one lane, `B` is the method of
/// one lane, and `Z` its state.
#[derive(Clone, Debug)]
pub struct Adaptive<D, S, T: Lanes, A, E, Z, B> {
    dynamics: D,
    method: A,
    /// Of the last attempts: where they began, and their lengths.
    t: T,
    h: T,
    y: S,
    lanes: Motions<E, Z, T::Lane, B>,
    work: Work,
    is_prepared: bool,
}

type Motions<E, Z, T, B> = [Option<Lane<E, Z, T, B>>; MAX_LANES];

/// A motion under way.
#[derive(Clone, Debug)]
struct Lane<E, Z, T, B> {
    solver: Solver<E, Z, T, Slot<Z, T, B>, Uncorrected>,
    /// Whether the last attempt was kept; none before the first.
    is_kept: Option<bool>,
}

/// What has become of a lane's attempt.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Outcome {
    /// The motion has gone on.
    Kept,
    /// The step will be tried again, with another length.
    Repeated,
    /// The motion cannot go on: the lane is free.
    Failed(Error),
}

impl<D, S, T, A, E, Z, B> Adaptive<D, S, T, A, E, Z, B>
where
    S: Storage<T>,
    T: Lanes,
    Z: Storage<T::Lane>,
{
    /// Lanes without motions, for states like this one.
    pub fn new(dynamics: D, method: A, y: &S) -> Self {
        let zero = T::constant(0.0);
        let lanes = [const { None }; MAX_LANES];
        Self {
            dynamics,
            method,
            t: zero,
            h: zero,
            y: y.clone(),
            lanes,
            work: Work::default(),
            is_prepared: false,
        }
    }

    /// Puts a motion that starts at `y` at time zero into a lane.
    pub fn begin(&mut self, lane: usize, dynamics: E, y: &Z, control: Control) {
        let slot = Slot::new(y);
        let solver = Solver::new(dynamics, slot, T::Lane::constant(0.0), y).with_control(control);
        self.lanes[lane] = Some(Lane { solver, is_kept: None });
    }

    /// Takes the motion out of a lane.
    pub fn end(&mut self, lane: usize) {
        self.lanes[lane] = None;
    }

    /// The time of a lane's motion; none in a free lane.
    pub fn time(&self, lane: usize) -> Option<T::Lane> {
        self.lanes[lane].as_ref().map(|lane| lane.solver.time())
    }

    /// An attempt of a step towards `t_end` in all lanes with motions. `one` is the system of a lane, `all` are those
    /// of all lanes.
    pub fn attempt<'a, M: 'a, P>(
        &mut self,
        one: impl Fn(usize) -> &'a M,
        all: &P,
        t_end: T::Lane,
        mut tell: impl FnMut(usize, Outcome),
    ) where
        D: Ode<P, Scalar = T, State = S>,
        A: Embedded<D, P>,
        E: Ode<M, Scalar = T::Lane, State = Z>,
        B: Embedded<E, M>,
    {
        let mut attempts: [Option<Attempt<T::Lane>>; MAX_LANES] = [const { None }; MAX_LANES];
        let (mut carried, mut begun) = (0, 0);
        for (index, attempt) in attempts.iter_mut().enumerate().take(T::COUNT) {
            let Some(lane) = &mut self.lanes[index] else { continue };
            match lane.solver.propose(one(index), t_end) {
                Ok(proposed) => *attempt = proposed,
                Err(error) => {
                    self.lanes[index] = None;
                    tell(index, Outcome::Failed(error));
                    continue;
                }
            }
            carried |= u32::from(lane.is_kept == Some(true)) << index;
            begun |= u32::from(lane.is_kept.is_none()) << index;
        }
        self.gather(&attempts);
        self.compute(all, carried, begun);
        for (index, attempt) in attempts.iter().enumerate() {
            let (Some(lane), Some(attempt)) = (&mut self.lanes[index], attempt) else { continue };
            lane.solver.attempt(one(index), attempt.h);
            lane.solver.method_mut().fill::<D, P, T, A>(&self.method, self.h, index);
            let judged = lane.solver.judge(one(index), attempt);
            lane.is_kept = Some(judged == Ok(true));
            tell(
                index,
                match judged {
                    Ok(true) => Outcome::Kept,
                    Ok(false) => Outcome::Repeated,
                    Err(error) => {
                        self.lanes[index] = None;
                        Outcome::Failed(error)
                    }
                },
            );
        }
    }

    /// Where the attempts begin. Lanes without one repeat what they did last.
    fn gather(&mut self, attempts: &[Option<Attempt<T::Lane>>; MAX_LANES]) {
        let Self { lanes, t, h, y, .. } = self;
        let (times, lengths) = (*t, *h);
        *h = T::from_lanes(|k| attempts[k].as_ref().map_or(lengths.lane(k), |attempt| attempt.h));
        *t = T::from_lanes(|k| lanes[k].as_ref().map_or(times.lane(k), |lane| lane.solver.time()));
        for (i, y) in y.as_mut().iter_mut().enumerate() {
            let before = *y;
            *y = T::from_lanes(|k| match &lanes[k] {
                Some(lane) => lane.solver.state().as_ref()[i],
                None => before.lane(k),
            });
        }
    }

    fn compute<P>(&mut self, all: &P, carried: u32, begun: u32)
    where
        D: Ode<P, Scalar = T, State = S>,
        A: Embedded<D, P>,
    {
        let Self { dynamics, method, t, h, y, work, .. } = self;
        let system = System { dynamics: &*dynamics, model: all };
        if carried | begun != 0 {
            let begun = (begun != 0).then(|| T::mask(begun));
            method.renew(system, *t, y, T::mask(carried), begun);
        }
        method.attempt(System { dynamics: &*dynamics, model: all }, *t, *h, y, true, work);
        self.is_prepared = false;
    }

    /// Writes the states at these times, each within the step that its lane has just kept or at its end. Lanes without
    /// a time have anything.
    pub fn interpolate<P>(&mut self, all: &P, time: impl Fn(usize) -> Option<T::Lane>, out: &mut S)
    where
        D: Ode<P, Scalar = T, State = S>,
        A: Embedded<D, P>,
    {
        let Self { dynamics, method, t, h, y, lanes, work, is_prepared } = self;
        let end = |k: usize| {
            let lane = lanes[k].as_ref()?;
            time(k).is_some_and(|t| t >= lane.solver.time()).then(|| lane.solver.state())
        };
        if (0..T::COUNT).any(|k| time(k).is_some() && end(k).is_none()) {
            if !*is_prepared {
                method.prepare(System { dynamics: &*dynamics, model: all }, *t, *h, y, work);
                *is_prepared = true;
            }
            let theta = (T::from_lanes(|k| time(k).unwrap_or_else(|| t.lane(k))) - *t) / *h;
            method.between(theta, out);
        }
        for (i, out) in out.as_mut().iter_mut().enumerate() {
            let between = *out;
            *out = T::from_lanes(|k| end(k).map_or_else(|| between.lane(k), |y| y.as_ref()[i]));
        }
    }
}

/// The method of one lane: its attempts are computed elsewhere and put here.
#[derive(Clone, Debug)]
struct Slot<Z, T, B> {
    end: Z,
    estimates: [Z; 2],
    rate: [T; 2],
    method: PhantomData<B>,
}

impl<Z: Clone, T: Real, B> Slot<Z, T, B> {
    fn new(y: &Z) -> Self {
        let estimates = [y.clone(), y.clone()];
        Self { end: y.clone(), estimates, rate: [T::constant(0.0); 2], method: PhantomData }
    }

    /// Takes what the attempt has come to in this lane.
    fn fill<D, P, L, A>(&mut self, method: &A, h: L, lane: usize)
    where
        Z: Storage<T>,
        L: Lanes<Lane = T>,
        D: Ode<P, Scalar = L>,
        A: Embedded<D, P>,
    {
        let end = method.end().as_ref();
        let [one, other] = self.estimates.each_mut().map(|part| part.as_mut());
        for (i, to) in self.end.as_mut().iter_mut().enumerate() {
            *to = end[i].lane(lane);
            [one[i], other[i]] = method.estimates(h, i).map(|estimate| estimate.lane(lane));
        }
        self.rate = method.rate().map(|rate| rate.lane(lane));
    }
}

impl<E, M, Z, T, B> Method<E, M> for Slot<Z, T, B>
where
    E: Ode<M, Scalar = T, State = Z>,
    Z: Storage<T>,
    T: Real,
    B: Embedded<E, M>,
{
    const ORDER: u32 = B::ORDER;
    const STABILITY: f64 = B::STABILITY;
    const ERROR_ORDER: u32 = B::ERROR_ORDER;

    fn attempt(&mut self, _: System<'_, E, M>, _: T, _: T, _: &Z, _: bool, _: &mut Work) {}

    fn end(&self) -> &Z {
        &self.end
    }

    fn carry(&mut self) -> bool {
        true
    }

    fn prepare(&mut self, _: System<'_, E, M>, _: T, _: T, _: &Z, _: &mut Work) {}

    fn between(&self, _: T, out: &mut Z) {
        out.as_mut().copy_from_slice(self.end.as_ref());
    }

    fn rate(&self) -> [T; 2] {
        self.rate
    }

    fn error(&self, h: T, weights: &Z) -> (T, usize) {
        let [one, other] = self.estimates.each_ref().map(|part| part.as_ref());
        B::size(h, weights, |i| [one[i], other[i]])
    }
}
