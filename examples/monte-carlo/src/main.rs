//! How far apart do gyroscopes precess that were built to the same drawing? Each scenario is the paper's gyroscope with
//! misalignments of its own, drawn within tolerances; eight run in the lanes of one pack, packs run on all cores.
//!
//! ```console
//! $ RUSTFLAGS="-C target-cpu=native" cargo run --release --package monte-carlo -- --count 10000
//! ```

mod ensemble;
mod scenario;
mod spread;

use clap::{Parser, ValueEnum};
use ensemble::Ensemble;
use indicatif::{ProgressBar, ProgressStyle};
use scenario::Scenario;
use spread::Spread;
use std::error::Error;
use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

/// Simulate the paper's gyroscope with random misalignments
#[derive(Debug, Parser)]
struct Args {
    /// Number of scenarios
    #[arg(long, default_value_t = 1024)]
    count: u64,
    /// Seed of the misalignments
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Whether eight scenarios run in one pack, or each alone; the results are the same
    #[arg(long, value_enum, default_value_t = Lanes::On)]
    lanes: Lanes,
    /// Number of threads; all cores if none is given
    #[arg(long, default_value_t = 0)]
    threads: usize,
    /// Where `spread.csv` and `spread.svg` go
    #[arg(long, default_value = "out/monte-carlo")]
    out: PathBuf,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum Lanes {
    On,
    Off,
}

fn main() -> Result<(), Box<dyn Error>> {
    let args = Args::parse();
    let scenarios: Vec<_> = (0..args.count).map(|index| Scenario::drawn(args.seed, index)).collect();
    let bar = ProgressBar::new(args.count).with_style(ProgressStyle::with_template(
        "{wide_bar} {human_pos} of {human_len} scenarios, {eta} left",
    )?);
    let pool = rayon::ThreadPoolBuilder::new().num_threads(args.threads).build()?;
    let began = Instant::now();
    let ensemble = pool.install(|| match args.lanes {
        Lanes::On => Ensemble::in_packs(&scenarios, &bar),
        Lanes::Off => Ensemble::one_by_one(&scenarios, &bar),
    });
    let elapsed = began.elapsed().as_secs_f64();
    bar.finish_and_clear();
    let spread = Spread::of(&ensemble).ok_or("there is no scenario that ran to the end")?;
    std::fs::create_dir_all(&args.out)?;
    spread.write_csv(&args.out.join("spread.csv"))?;
    std::fs::write(args.out.join("spread.svg"), spread.svg()?)?;
    let each = elapsed / args.count as f64;
    let mut out = std::io::stdout();
    writeln!(out, "{} scenarios of one second, {} of them failed", args.count, ensemble.failed())?;
    writeln!(
        out,
        "{:.3} ms each, {:.3} s together on {} threads",
        1e3 * each,
        elapsed,
        pool.current_num_threads()
    )?;
    write!(out, "{spread}")?;
    writeln!(out, "wrote spread.csv and spread.svg to {}", args.out.display())?;
    Ok(())
}
