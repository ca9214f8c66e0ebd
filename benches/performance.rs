//! The paper's scene, all kernels in turns in one process: `cargo bench --bench performance`.
//!
//! Prints one line for each kernel, its cells separated by tabs: what, who, flops, ns, ratio to the floor. `cargo xtask
//! performance` makes the tables of docs/performance.md of it. With `--count` nothing is timed: each kernel is called
//! [`CALLS`] times within a function that callgrind can be told, in the order of the lines.

use gyro_benches::{Clock, Kernel, Scene, counted, interleaved, kernels, runs};
use std::io::{IsTerminal, Write, stderr, stdout};
use std::time::Duration;

/// Rounds of single kernels, and the time of one kernel in each.
const ROUNDS: usize = 201;
const SLICE: (Duration, Clock) = (Duration::from_micros(500), Clock::Wall);

/// The same of whole runs, of which the longest takes seconds.
const ROUNDS_OF_RUNS: usize = 5;
const SLICE_OF_RUNS: (Duration, Clock) = (Duration::from_millis(100), Clock::Processor);

/// Calls for callgrind.
const CALLS: u64 = 100;

fn main() -> std::io::Result<()> {
    let is_asked = |option: &str| std::env::args().any(|argument| argument == option);
    let scene = Scene::new();
    if is_asked("--count") {
        kernels(&scene).iter_mut().for_each(|kernel| counted(kernel, CALLS));
        return Ok(());
    }
    print(&mut kernels(&scene), ROUNDS, SLICE)?;
    print(&mut runs(&scene), ROUNDS_OF_RUNS, SLICE_OF_RUNS)
}

fn print(kernels: &mut [Kernel<'_>], rounds: usize, slice: (Duration, Clock)) -> std::io::Result<()> {
    let is_watched = stderr().is_terminal();
    let figures = interleaved(kernels, rounds, slice, |round| {
        if is_watched {
            // Whoever watches loses nothing if this fails.
            let _ = write!(stderr(), "\rround {} of {rounds} ", round + 1);
        }
    });
    if is_watched {
        let _ = writeln!(stderr());
    }
    for (Kernel { what, side, flops, .. }, figure) in kernels.iter().zip(figures) {
        let flops = flops.map_or(String::new(), |flops| flops.to_string());
        writeln!(stdout(), "{what}\t{side}\t{flops}\t{:.2}\t{:.3}", figure.ns, figure.ratio)?;
    }
    Ok(())
}
