//! One run beside the yardstick, in turns: whatever slows the machine down for a while slows both down alike.

use crate::Floor;
use std::hint::black_box;
use std::time::Duration;

/// How long a run takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Measured {
    /// How often it was made.
    pub runs: u64,
    /// Median time of the processor, s.
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

/// What the processor has spent on this, s.
fn timed(action: impl FnOnce()) -> f64 {
    let began = processor_time();
    action();
    (processor_time() - began).as_secs_f64()
}

/// What the processor has spent on this thread.
#[cfg(unix)]
pub fn processor_time() -> Duration {
    let time = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::new(u64::try_from(time.tv_sec).unwrap_or(0), u32::try_from(time.tv_nsec).unwrap_or(0))
}

/// Since this was first asked: where there is no such clock, that on the wall has to do.
#[cfg(not(unix))]
pub fn processor_time() -> Duration {
    static BEGAN: std::sync::OnceLock<std::time::Instant> = std::sync::OnceLock::new();
    BEGAN.get_or_init(std::time::Instant::now).elapsed()
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
