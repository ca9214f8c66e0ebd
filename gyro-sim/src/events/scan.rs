//! The crossings of several functions within one step.

use super::Direction;
use super::root::{dip, root};
use crate::Real;
use core::ops::ControlFlow;

/// A step is looked at in so many parts of equal length.
pub(crate) const PARTS: u8 = 8;

/// Slopes at the ends of a part are taken over this fraction of it.
const NEARBY: f64 = 1.0 / 1024.0;

/// A crossing within a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Found<T> {
    pub(crate) event: usize,
    /// Where, as a fraction of the step.
    pub(crate) theta: T,
    pub(crate) rises: bool,
}

/// Calls `tell` with the crossings within a step in order of time, until it breaks; `values` has the functions at a
/// fraction of the step.
pub(crate) fn scan<T: Real, E, const N: usize>(
    directions: &[Direction; N],
    mut values: impl FnMut(T) -> Result<[T; N], E>,
    mut tell: impl FnMut(Found<T>) -> Result<ControlFlow<()>, E>,
) -> Result<ControlFlow<()>, E> {
    let samples = sampled(&mut values)?;
    for (k, ends) in (0..PARTS).zip(samples.windows(2)) {
        let part = Part::new(k, ends);
        let mut found = [[None; 2]; N];
        for (event, found) in found.iter_mut().enumerate() {
            let swing = swing(&samples, event);
            *found = part.crossings(event, swing, &mut values)?.map(|crossing| {
                crossing.filter(|crossing: &Found<T>| directions[event].admits(crossing.rises))
            });
        }
        while let Some(next) = take_first(&mut found) {
            if tell(next)?.is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
    }
    Ok(ControlFlow::Continue(()))
}

/// The first falling crossing of all functions.
pub(crate) fn first_falling<T: Real, V: AsRef<[T]>, E>(
    mut values: impl FnMut(T) -> Result<V, E>,
) -> Result<Option<Found<T>>, E> {
    let samples = sampled(&mut values)?;
    for (k, ends) in (0..PARTS).zip(samples.windows(2)) {
        let part = Part::new(k, ends);
        let mut first: Option<Found<T>> = None;
        for event in 0..samples[0].as_ref().len() {
            for found in part.crossings(event, swing(&samples, event), &mut values)?.into_iter().flatten() {
                if !found.rises && first.is_none_or(|first| found.theta < first.theta) {
                    first = Some(found);
                }
            }
        }
        if first.is_some() {
            return Ok(first);
        }
    }
    Ok(None)
}

fn place<T: Real>(k: u8) -> T {
    T::constant(f64::from(k) / f64::from(PARTS))
}

/// The functions at both ends of each part.
fn sampled<T: Real, V, E>(values: &mut impl FnMut(T) -> Result<V, E>) -> Result<[V; PARTS as usize + 1], E> {
    Ok([
        values(place(0))?,
        values(place(1))?,
        values(place(2))?,
        values(place(3))?,
        values(place(4))?,
        values(place(5))?,
        values(place(6))?,
        values(place(7))?,
        values(place(8))?,
    ])
}

/// By how much a function varies over the step.
fn swing<T: Real, V: AsRef<[T]>>(samples: &[V], event: usize) -> T {
    let (mut least, mut most) = (samples[0].as_ref()[event], samples[0].as_ref()[event]);
    for sample in samples {
        let value = sample.as_ref()[event];
        least = if value < least { value } else { least };
        most = if value > most { value } else { most };
    }
    most - least
}

/// Takes the earliest crossing; of those at one time that of the first function.
fn take_first<T: Real, const N: usize>(found: &mut [[Option<Found<T>>; 2]; N]) -> Option<Found<T>> {
    let mut first: Option<&mut Option<Found<T>>> = None;
    for next in found.iter_mut().flatten() {
        let Some(crossing) = next else { continue };
        let is_earlier = match &first {
            Some(Some(earliest)) => crossing.theta < earliest.theta,
            _ => true,
        };
        if is_earlier {
            first = Some(next);
        }
    }
    first.and_then(Option::take)
}

/// A part of a step, with the functions at its ends.
struct Part<'a, T, V> {
    place: [T; 2],
    ends: &'a [V],
}

impl<'a, T: Real, V: AsRef<[T]>> Part<'a, T, V> {
    fn new(k: u8, ends: &'a [V]) -> Self {
        Self { place: [place(k), place(k + 1)], ends }
    }

    /// The crossing of a function between values of different signs, or the two of an excursion.
    fn crossings<E>(
        &self,
        event: usize,
        swing: T,
        values: &mut impl FnMut(T) -> Result<V, E>,
    ) -> Result<[Option<Found<T>>; 2], E> {
        let zero = T::constant(0.0);
        let [a, b] = self.place;
        let [fa, fb] = [0, 1].map(|end: usize| self.ends[end].as_ref()[event]);
        let mut value = |theta: T| Ok(values(theta)?.as_ref()[event]);
        if (fa < zero && fb >= zero) || (fa > zero && fb <= zero) {
            let theta = root(&mut value, (a, fa), (b, fb))?;
            return Ok([Some(Found { event, theta, rises: fa < zero }), None]);
        }
        // An excursion shorter than the part: only where the function turns back between values on one side.
        let is_positive = fa > zero && fb > zero;
        let (low, nearest) = (fa.abs(), fb.abs());
        let nearest = if low < nearest { low } else { nearest };
        if !(is_positive || fa < zero && fb < zero) || nearest > swing {
            return Ok([None; 2]);
        }
        let sign = T::constant(if is_positive { 1.0 } else { -1.0 });
        let nearby = T::constant(NEARBY) * (b - a);
        let is_left = (value(a + nearby)? - fa) * sign >= zero || (fb - value(b - nearby)?) * sign <= zero;
        if is_left {
            return Ok([None; 2]);
        }
        let Some((there, depth)) = dip(|theta| Ok(sign * value(theta)?), [a, b])? else {
            return Ok([None; 2]);
        };
        let first = root(&mut value, (a, fa), (there, sign * depth))?;
        let first = Some(Found { event, theta: first, rises: !is_positive });
        if depth == zero {
            return Ok([first, None]);
        }
        let second = root(&mut value, (there, sign * depth), (b, fb))?;
        Ok([first, Some(Found { event, theta: second, rises: is_positive })])
    }
}
