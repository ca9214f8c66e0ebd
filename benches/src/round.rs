//! Measuring in turns: whatever slows the machine down for a while slows all kernels down alike.

use crate::Kernel;
use std::time::{Duration, Instant};

/// What was measured of a kernel.
#[derive(Clone, Copy, Debug)]
pub struct Figure {
    /// Median time of one call, ns.
    pub ns: f64,
    /// Median over the rounds of the time over that of the first kernel in the same round.
    pub ratio: f64,
}

/// Measures all kernels in turns, each for about `slice` in each of `rounds`; `tell` hears which round begins. A first round warms
/// up and decides how often each is called in a slice.
///
/// # Panics
/// If there is no kernel.
pub fn interleaved(
    kernels: &mut [Kernel<'_>],
    rounds: usize,
    slice: Duration,
    mut tell: impl FnMut(usize),
) -> Vec<Figure> {
    let times: Vec<u64> = kernels.iter_mut().map(|kernel| calls_in(kernel, slice)).collect();
    let mut samples: Vec<Vec<f64>> = vec![Vec::with_capacity(rounds); kernels.len()];
    for round in 0..rounds {
        tell(round);
        for ((kernel, times), samples) in kernels.iter_mut().zip(&times).zip(&mut samples) {
            samples.push(ns_of_a_call(kernel, *times));
        }
    }
    let first = samples[0].clone();
    let figure = |samples: &Vec<f64>| {
        let ratios = samples.iter().zip(&first).map(|(ns, first)| ns / first);
        Figure { ns: median(samples.clone()), ratio: median(ratios.collect()) }
    };
    samples.iter().map(figure).collect()
}

/// How many calls take this long; at least one.
fn calls_in(kernel: &mut Kernel<'_>, slice: Duration) -> u64 {
    let mut times = 1;
    loop {
        let ns = ns_of_a_call(kernel, times) * times as f64;
        let wanted = slice.as_nanos() as f64;
        if ns >= wanted / 4.0 {
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
            return ((times as f64 * wanted / ns) as u64).max(1);
        }
        times *= 2;
    }
}

fn ns_of_a_call(kernel: &mut Kernel<'_>, times: u64) -> f64 {
    let began = Instant::now();
    kernel.repeat(times);
    began.elapsed().as_nanos() as f64 / times as f64
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
