//! Kinks of laws: steps under error control end there, and steps of fixed length that go over them are counted.

use super::watch::seen;
use super::{Halt, Run, Sides};
use crate::Input;
use crate::formula::Operation;
use crate::formula::Seen;
use crate::kink::{Kink, Stay};
use crate::motion::{Attempt, Motion};
use crate::sample::Observer;
use gyro_sim::{Partition, Real, Scalar, Turns, events};
use std::convert::Infallible;

/// A step that ends short of a kink leaves this part of the way. The stages of steps that end nearer may see the law
/// beyond it, and its place is known from an attempt across it, no better than that.
const MARGIN: f64 = 1.0 / 1024.0;

/// Nearer than so many roundings of the time there is no way that could be left.
const ROUNDINGS: f64 = 32.0;

/// So many attempts of one step end early for kinks; the rest is left to error control.
const MOST_ATTEMPTS: u32 = 12;

/// Of an attempt whose error is not tolerated this part, and no more, is repeated where a kink shows within it.
const SEEN: f64 = 0.125;

/// Where so many steps within this part of the run have ended at one kink, the motion stays there.
const ENDS: u32 = 64;
const BRIEF: f64 = 1e-3;

/// After so many further steps it is asked whether the rest of the run is within reach.
const STEPS: u64 = 1000;

/// Where laws were at the end of the last step, each between its kinks.
#[derive(Clone, Debug)]
pub(super) struct Laws {
    kinks: Vec<Kink>,
    sees_outputs: bool,
    values: Vec<f64>,
    places: Vec<Option<f64>>,
    /// When a step last began to end at each, s, and how many have since.
    ends: Vec<(f64, u32)>,
    /// Those at which the motion stays: no step ends there any more.
    is_stayed_at: Vec<bool>,
    /// The first of them.
    stay: Option<Stay>,
    /// A time since then and how many steps had been tried.
    since: (f64, u64),
    /// The kink that the last step has led to, and when it comes, s.
    ahead: Option<(usize, f64)>,
}

impl Laws {
    pub(super) fn new(kinks: &[Kink]) -> Self {
        let is_output = |operation: &Operation| matches!(operation, Operation::Seen(Seen::Output(_)));
        Self {
            kinks: kinks.to_vec(),
            sees_outputs: kinks.iter().any(|kink| kink.of.0.iter().any(is_output)),
            values: Vec::new(),
            places: vec![None; kinks.len()],
            ends: vec![(0.0, 0); kinks.len()],
            is_stayed_at: vec![false; kinks.len()],
            stay: None,
            since: (0.0, 0),
            ahead: None,
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.kinks.is_empty()
    }

    /// Takes the values that the arguments have now; how many kinks have been crossed since the last ones.
    fn pass(&mut self, values: Vec<f64>) -> u64 {
        let mut passed = 0;
        for ((kink, place), value) in self.kinks.iter().zip(&mut self.places).zip(&values) {
            let Some(now) = kink.at.place(*value) else { continue };
            passed += u64::from(place.replace(now).is_some_and(|before| before != now));
        }
        self.values = values;
        passed
    }

    /// The kinks at which steps end, and that lie between the last values and these.
    fn between(&self, values: &[f64]) -> Vec<Crossed> {
        let is_sought = |k: &usize| !self.is_stayed_at[*k];
        let all = (0..self.kinks.len()).filter(is_sought);
        let crossed = |k: usize| {
            let level = self.kinks[k].at.next(self.places[k]?, values[k])?;
            Some(Crossed { kink: k, level, value: values[k] })
        };
        all.filter_map(crossed).collect()
    }

    /// Notes that a step has ended at a kink; whether the motion stays there from now on.
    fn note(&mut self, k: usize, t: f64, t_end: f64) -> bool {
        let (since, count) = &mut self.ends[k];
        if t - *since > BRIEF * t_end {
            (*since, *count) = (t, 0);
        }
        *count += 1;
        *count >= ENDS && !std::mem::replace(&mut self.is_stayed_at[k], true)
    }
}

/// A kink that lies between two values of its argument.
struct Crossed {
    kink: usize,
    /// Where it is.
    level: f64,
    /// The later value.
    value: f64,
}

/// What arguments of laws are computed from, besides the state.
struct Sight<'r, 'a, M: Partition<Scalar: Real>> {
    mechanism: &'r M,
    observer: &'r mut Observer<'a, M>,
    turns: &'r Turns<M>,
    read_at: f64,
    inputs: &'r [Input],
    held: Vec<(usize, f64)>,
    sees_outputs: bool,
}

impl<M: Partition<Scalar: Real> + Clone> Sight<'_, '_, M> {
    fn values(&mut self, kinks: &[Kink], t: f64, y: &M::State) -> Vec<f64> {
        let (mechanism, time, mut turns) = (self.mechanism, M::Scalar::constant(t), self.turns.clone());
        turns.update(mechanism, time, M::Scalar::constant(t - self.read_at), y);
        let outputs = if self.sees_outputs { self.observer.outputs(mechanism, time, y) } else { &[] };
        let given = |index: usize| {
            let held = self.held.iter().find(|(input, _)| *input == index).map(|(_, value)| *value);
            held.or_else(|| self.inputs.iter().find(|input| input.index == index).map(|input| input.at(t)))
        };
        let see = |what: Seen| match what {
            Seen::Input(index, default, sign) => sign * given(index).unwrap_or(default),
            Seen::Distance(line) => line.distance(mechanism, y.as_ref())[0],
            Seen::DistanceRate(line) => line.distance(mechanism, y.as_ref())[1],
            other => seen(mechanism, outputs, &turns, time, other).to_f64(),
        };
        kinks.iter().map(|kink| kink.of.value(&see)).collect()
    }
}

/// The parts of a run that kinks have to do with.
struct Parts<'r, 'a, M: Partition<Scalar: Real>> {
    sight: Sight<'r, 'a, M>,
    motion: &'r mut dyn Motion<M>,
    laws: &'r mut Laws,
    y: &'r mut M::State,
    sides: &'r Sides,
}

impl<'a, M: Partition<Scalar: Real> + Clone> Run<'a, M> {
    fn parts(&mut self) -> Parts<'_, 'a, M> {
        let Self { mechanism, motion, laws, turns, observer, y, inputs, controllers, paths, .. } = self;
        let (held, sees_outputs) = (controllers.held().chain(paths.inputs()).collect(), laws.sees_outputs);
        let (read_at, sides) = (self.read_at, &self.sides);
        let mechanism: &M = mechanism;
        let sight = Sight { mechanism, observer, turns, read_at, inputs, held, sees_outputs };
        Parts { sight, motion: &mut **motion, laws, y, sides }
    }

    /// Counts the kinks between the state that was last looked at, at this time, and the one before it.
    pub(super) fn count_kinks(&mut self, t: f64) {
        if !self.laws.is_empty() {
            let Parts { mut sight, laws, y, .. } = self.parts();
            self.summary.kinks_crossed += laws.pass(sight.values(&laws.kinks, t, y));
        }
    }

    /// One step under error control, not beyond a time, nor beyond a kink unless it is a short one across it.
    pub(super) fn step_towards(&mut self, stop: f64, t_end: f64) -> Result<(), Halt> {
        if self.laws.is_empty() {
            return Ok(self.motion.step_towards(self.mechanism, stop, &mut |_| None)?);
        }
        let start = self.motion.time();
        self.look_at(start)?;
        self.count_kinks(start);
        let ahead = self.laws.ahead.take();
        if let Some((kink, _)) = ahead
            && self.laws.note(kink, start, t_end)
            && self.laws.stay.is_none()
        {
            self.laws.stay = Some(Stay { kink, t: start });
            self.laws.since = (start, self.motion.statistics().tried());
        }
        self.refuse_to_crawl(start, t_end)?;
        let least = ROUNDINGS * <M::Scalar as Real>::EPSILON.to_f64() * stop.abs();
        let Parts { mut sight, motion, laws, y, sides } = self.parts();
        let across = ahead.filter(|(kink, at)| *at > start && !laws.is_stayed_at[*kink]);
        let across = across.map(|(_, at)| at + (at - start).max(least));
        let (mechanism, mut attempts) = (sight.mechanism, 0);
        let look = &mut |attempt: &mut dyn Attempt<M>| {
            let [from, to] = attempt.span();
            let is_enough = attempts == MOST_ATTEMPTS;
            let mut values = |theta: f64, kinks: &[Kink], attempt: &mut dyn Attempt<M>| {
                attempt.at(theta, y);
                sides.set(y.as_mut());
                sight.values(kinks, from + theta * (to - from), y)
            };
            let crossed = laws.between(&values(1.0, &laws.kinks, attempt));
            if crossed.is_empty() || is_enough || across.is_some() && attempt.fits() {
                return None;
            }
            attempts += 1;
            let places = crossed.into_iter().map(|Crossed { kink, level, value }| {
                let of = std::slice::from_ref(&laws.kinks[kink]);
                let beyond = |theta: f64| Ok::<_, Infallible>(values(theta, of, attempt)[0] - level);
                let Ok(place) = events::root(beyond, (0.0, laws.values[kink] - level), (1.0, value - level));
                (kink, place * (to - from))
            });
            let (kink, way) = places.min_by(|a, b| a.1.total_cmp(&b.1))?;
            // What is seen at the beginning of an attempt that has gone far astray may not be there.
            if way < SEEN * (to - from) && !attempt.fits() {
                return Some(from + (SEEN * (to - from)).max(4.0 * least));
            }
            laws.ahead = Some((kink, from + way));
            Some(if way > 2.0 * least { from + way * (1.0 - MARGIN) } else { from + 4.0 * least })
        };
        let outcome = motion.step_towards(mechanism, across.map_or(stop, |across| across.min(stop)), look);
        Ok(outcome?)
    }

    /// Notes that a motion which stays at kinks goes on in short steps; fails where that takes the rest of the run out
    /// of reach.
    fn refuse_to_crawl(&mut self, t: f64, t_end: f64) -> Result<(), Halt> {
        let Laws { stay, since: (since, before), .. } = self.laws;
        let tried = self.motion.statistics().tried();
        let Some(stay) = stay.filter(|_| tried >= before + STEPS) else { return Ok(()) };
        self.laws.since = (t, tried);
        let taken = (tried - before) as f64;
        if t - since < BRIEF * t_end {
            self.summary.stay.get_or_insert(stay);
        }
        if (t_end - t) * taken <= (t - since) * self.most_steps.saturating_sub(tried) as f64 {
            return Ok(());
        }
        Err(Halt::Law(format!(
            "since t = {} s the motion stays where a law is not smooth: {}; at t = {t} s it goes on in steps of {:.1e} s, too \
             short for its budget. Friction that holds is a [[contact]]; a law without a jump, by tanh or step, needs no such \
             steps",
            stay.t,
            self.laws.kinks[stay.kink].words,
            (t - since) / taken
        )))
    }
}
