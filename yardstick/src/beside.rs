//! One run beside the yardstick, in turns: whatever slows the machine down for a while slows both down alike.

use crate::Floor;
use nanoserde::{DeBin, SerBin};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// How long a run takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, SerBin, DeBin)]
pub struct Measured {
    /// How often it was made.
    pub runs: u64,
    /// Median time, s.
    pub seconds: f64,
    /// Median over the turns of that time over the yardstick's in the same turn.
    pub ratio: f64,
}

/// Turns of a run that is over at once.
const TURNS: usize = 9;

/// In each turn a run is repeated until it has taken about this long, s: the yardstick's own time.
const SLICE: f64 = 1e-3;

/// Measures a run, for about `budget` but at least once. The first of several is not counted: it warms up.
///
/// A slice is shorter than what a system lets a program run without a break: on a busy machine most slices are whole,
/// and the median is one of these.
///
/// # Errors
/// That of the run.
pub fn beside<E>(budget: Duration, run: impl FnMut() -> Result<(), E>) -> Result<Measured, E> {
    let (floor, began) = (black_box(Floor::paper()), Instant::now());
    in_turns(budget, || began.elapsed().as_secs_f64(), || floor.second(), run)
}

/// The same beside any yardstick, by a clock that gives the time in s.
fn in_turns<E>(
    budget: Duration,
    now: impl Fn() -> f64,
    mut yardstick: impl FnMut(),
    mut run: impl FnMut() -> Result<(), E>,
) -> Result<Measured, E> {
    let timed = |action: &mut dyn FnMut()| {
        let began = now();
        action();
        now() - began
    };
    let mut yardstick = || timed(&mut yardstick);
    yardstick();
    let mut failure = None;
    let mut repeated = |times: u64| {
        timed(&mut || {
            for _ in 0..times {
                if let Err(error) = run() {
                    failure.get_or_insert(error);
                    return;
                }
            }
        })
    };
    let first = repeated(1);
    let times = (SLICE / first.max(1e-9)).ceil().max(1.0);
    let turns = (budget.as_secs_f64() / (times * first + SLICE)).floor().min(TURNS as f64);
    let mut turns: Vec<[f64; 2]> = (0..turns as usize)
        .map(|_| {
            let floor = yardstick();
            let seconds = repeated(times as u64) / times;
            [seconds, seconds / floor]
        })
        .collect();
    if turns.is_empty() {
        turns.push([first, first / yardstick()]);
    }
    let runs = if turns.len() == 1 { 1 } else { turns.len() as u64 * times as u64 };
    let of = |which: usize| median(turns.iter().map(|turn| turn[which]).collect());
    match failure {
        None => Ok(Measured { runs, seconds: of(0), ratio: of(1) }),
        Some(error) => Err(error),
    }
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[cfg(test)]
mod tests;
