//! Measuring in turns: whatever slows the machine down for a while slows all kernels down alike.

use crate::kernel::Kernel;
use std::time::{Duration, Instant};

/// What was measured of a kernel.
#[derive(Clone, Copy, Debug)]
pub struct Figure {
    /// Median time of one call, ns.
    pub ns: f64,
    /// Median over the rounds of the time over that of the first kernel in the same round.
    pub ratio: f64,
}

/// Which time counts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// That of the day, exact: for slices so short that few are interrupted.
    Wall,
    /// What the processor has spent on this thread, exact to a few milliseconds, where the system tells; else that of
    /// the day.
    Processor,
}

impl Clock {
    /// ns since `began`, or since this thread was.
    fn now(self, began: Instant) -> f64 {
        let wall = began.elapsed().as_nanos() as f64;
        match self {
            Self::Wall => wall,
            Self::Processor => processor_ns().unwrap_or(wall),
        }
    }
}

/// Linux keeps it here, in ns, brought up to date at the scheduler's ticks.
fn processor_ns() -> Option<f64> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    text.split_whitespace().next()?.parse().ok()
}

/// Measures all kernels in turns, each for about `slice` in each of `rounds`; `tell` hears which round begins. A first
/// round warms up and decides how often each is called in a slice.
///
/// # Panics
/// If there is no kernel.
pub fn interleaved(
    kernels: &mut [Kernel<'_>],
    rounds: usize,
    (slice, clock): (Duration, Clock),
    mut tell: impl FnMut(usize),
) -> Vec<Figure> {
    let times: Vec<u64> = kernels.iter_mut().map(|kernel| calls_in(kernel, slice)).collect();
    let mut samples: Vec<Vec<f64>> = vec![Vec::with_capacity(rounds); kernels.len()];
    for round in 0..rounds {
        tell(round);
        for ((kernel, times), samples) in kernels.iter_mut().zip(&times).zip(&mut samples) {
            samples.push(ns_of_a_call(kernel, *times, clock));
        }
    }
    let first = samples[0].clone();
    let figure = |samples: &Vec<f64>| {
        let ratios = samples.iter().zip(&first).map(|(ns, first)| ns / first);
        Figure { ns: median(samples.clone()), ratio: median(ratios.collect()) }
    };
    samples.iter().map(figure).collect()
}

/// Tries at each number of calls: an interruption must not pass for a slow kernel, which would be called too seldom to
/// stay warm.
const TRIES: u32 = 5;

/// How many calls take this long; at least one.
fn calls_in(kernel: &mut Kernel<'_>, slice: Duration) -> u64 {
    let mut times = 1;
    loop {
        let tries = (0..TRIES).map(|_| ns_of_a_call(kernel, times, Clock::Wall));
        let ns = tries.fold(f64::INFINITY, f64::min) * times as f64;
        let wanted = slice.as_nanos() as f64;
        if ns >= wanted / 4.0 {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
            return ((times as f64 * wanted / ns) as u64).max(1);
        }
        times *= 2;
    }
}

/// One in so many calls is made before those that are timed.
const WARMING: u64 = 8;

fn ns_of_a_call(kernel: &mut Kernel<'_>, times: u64, clock: Clock) -> f64 {
    // The others have been in the caches meanwhile.
    kernel.repeat(times / WARMING);
    let began = Instant::now();
    let start = clock.now(began);
    kernel.repeat(times);
    (clock.now(began) - start) / times as f64
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Calls a kernel so many times, under a name that a profiler can be told.
#[inline(never)]
pub fn counted(kernel: &mut Kernel<'_>, times: u64) {
    kernel.repeat(times);
    // Without this the call would be a jump, and nobody would see this function end.
    std::hint::black_box(kernel);
}
