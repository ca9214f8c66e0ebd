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
/// # Errors
/// That of the run.
pub fn beside<E>(budget: Duration, mut run: impl FnMut() -> Result<(), E>) -> Result<Measured, E> {
    let floor = black_box(Floor::paper());
    let yardstick = || timed(|| floor.second());
    yardstick();
    let mut failure = None;
    let mut repeated = |times: u64| {
        timed(|| {
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

/// How long this takes by the clock, s. A slice is shorter than what a system lets a program run without a break: on a
/// busy machine most slices are whole, and the median is one of these.
fn timed(action: impl FnOnce()) -> f64 {
    let began = Instant::now();
    action();
    began.elapsed().as_secs_f64()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn twice_the_yardstick_is_longer_than_once() {
        let floor = black_box(Floor::paper());
        let second = || {
            floor.second();
            Ok::<(), ()>(())
        };
        let budget = Duration::from_millis(100);
        let one = beside(budget, second).unwrap();
        let two = beside(budget, || second().and_then(|()| second())).unwrap();
        // Twice, give or take what a busy machine does to it.
        let factor = two.ratio / one.ratio;
        assert!(factor > 1.3 && factor < 3.0, "{one:?} {two:?}");
    }

    #[test]
    fn a_run_that_fails_is_not_measured() {
        let mut left = 3;
        let failing = || {
            left -= 1;
            if left == 0 { Err("it fails") } else { Ok(()) }
        };
        assert_eq!(beside(Duration::from_millis(100), failing), Err("it fails"));
    }
}
