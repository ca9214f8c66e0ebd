//! Packs of lanes against as many scalar runs, in turns in one process: `cargo bench --bench lanes`.
//!
//! Prints one line for each pair, its cells separated by tabs: what, pack, ns of the scalar runs, ns of the pack, how
//! many times as fast it is. Packs gain only with the registers of the machine: `cargo xtask performance` sets `-C
//! target-cpu=native` for this program.

use gyro_benches::{Clock, interleaved, lanes};
use std::io::{Write, stdout};
use std::time::Duration;

const ROUNDS: usize = 101;
const SLICE: (Duration, Clock) = (Duration::from_micros(500), Clock::Wall);

const ROUNDS_OF_RUNS: usize = 9;
const SLICE_OF_RUNS: (Duration, Clock) = (Duration::from_millis(50), Clock::Processor);

fn main() -> std::io::Result<()> {
    let (kernels, runs) = lanes::pairs();
    print(kernels, ROUNDS, SLICE)?;
    print(runs, ROUNDS_OF_RUNS, SLICE_OF_RUNS)
}

fn print(pairs: Vec<lanes::Pair<'_>>, rounds: usize, slice: (Duration, Clock)) -> std::io::Result<()> {
    for mut pair in pairs {
        let figures = interleaved(&mut pair, rounds, slice, |_| ());
        let (what, pack, gain) = (pair[1].what, pair[1].side, 1.0 / figures[1].ratio);
        writeln!(stdout(), "{what}\t{pack}\t{:.2}\t{:.2}\t{gain:.3}", figures[0].ns, figures[1].ns)?;
    }
    Ok(())
}
