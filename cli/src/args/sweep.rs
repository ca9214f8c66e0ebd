//! The arguments of `sweep`.

use clap::{Args, Subcommand, ValueEnum};
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// Run the scenarios of a study on all cores
///
/// Derives and proves the study's model once, runs every scenario and writes a table with a row for each, quantiles
/// and plots. A scenario that fails is a row with its error. A sweep that was interrupted goes on with --resume and
/// ends with the same files. See docs/sweep.md.
#[derive(Debug, Args)]
#[command(
    args_conflicts_with_subcommands = true,
    subcommand_negates_reqs = true,
    after_help = "Examples:
  {program} sweep studies/misaligned-gyroscopes.toml --out out/gyroscopes
  {program} sweep studies/misaligned-gyroscopes.toml --out out/gyroscopes --resume
  {program} sweep studies/misaligned-gyroscopes.toml --only 17
  {program} sweep studies/misaligned-gyroscopes.toml --shard 2/4 --out out/part-2
  {program} sweep merge out/part-1 out/part-2 out/part-3 out/part-4 --out out/gyroscopes"
)]
pub struct SweepArgs {
    #[command(subcommand)]
    pub(crate) command: Option<SweepCommand>,
    /// Study file
    #[arg(value_name = "STUDY", required = true)]
    pub(crate) study: Option<PathBuf>,
    /// Folder of the results [default: out/NAME, by the study's file name]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Go on with the sweep that is in the folder
    #[arg(long)]
    pub(crate) resume: bool,
    /// Run the k-th of n parts: every n-th block, to be put together by `sweep merge`
    #[arg(long, value_name = "K/N", value_parser = shard)]
    pub(crate) shard: Option<Shard>,
    /// Run this scenario alone and write its whole time series, as simulate does
    #[arg(long, value_name = "NUMBER", conflicts_with_all = ["resume", "shard", "estimate"])]
    pub(crate) only: Option<u64>,
    /// Run the first block, say what the whole sweep would cost, and stop
    #[arg(long, conflicts_with = "resume")]
    pub(crate) estimate: bool,
    /// Where scenarios are run, with the same results to the last bit [default: in-process; a sweep of
    /// which more than half a minute is left goes on in programs that rustc compiles]
    #[arg(long, value_enum)]
    pub(crate) engine: Option<SweepEngine>,
    /// Number of threads that run scenarios [default: the number of cores]
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,
    /// Run as a rank of an MPI job: of the nine of `mpirun -n 9 gyro sweep STUDY --mpi` one hands out blocks, and eight
    /// run them
    #[cfg(feature = "mpi")]
    #[arg(long, conflicts_with_all = ["only", "estimate", "threads", "engine"])]
    pub(crate) mpi: bool,
    /// Compile by rustc for this very processor: faster, with other roundings than on machines without its instructions
    #[arg(long, conflicts_with = "engine")]
    pub(crate) native: bool,
}

impl SweepArgs {
    /// Where scenarios are run, if that is asked for.
    pub(crate) fn engine(&self) -> Option<SweepEngine> {
        #[cfg(feature = "mpi")]
        let is_spread = self.mpi;
        #[cfg(not(feature = "mpi"))]
        let is_spread = false;
        if self.native || is_spread { Some(SweepEngine::Generated) } else { self.engine }
    }
}

/// Where scenarios are run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum SweepEngine {
    /// In this process: compiled at once, or interpreted where this program has no compiler
    InProcess,
    /// In programs that rustc compiles, one for each thread: faster, after many seconds
    Generated,
}

#[derive(Debug, Subcommand)]
pub(crate) enum SweepCommand {
    Merge(MergeArgs),
}

/// Put the parts of a sweep together
///
/// The results are those of a sweep that was run in one piece.
#[derive(Debug, Args)]
pub(crate) struct MergeArgs {
    /// Folders of the parts, in any order
    #[arg(value_name = "DIR", required = true)]
    pub(crate) parts: Vec<PathBuf>,
    /// Folder of the results
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
}

/// One of several parts of a sweep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Shard {
    /// From 1.
    pub(crate) number: u64,
    pub(crate) of: u64,
}

impl Shard {
    /// All of it.
    pub(crate) const WHOLE: Self = Self { number: 1, of: 1 };
}

fn shard(text: &str) -> Result<Shard, String> {
    let read = |text: &str| text.trim().parse::<u64>().ok();
    let parts = text.split_once('/').and_then(|(k, n)| Some((read(k)?, read(n)?)));
    match parts {
        Some((number, of)) if (1..=of).contains(&number) => Ok(Shard { number, of }),
        _ => Err("K/N was expected, with K from 1 to N, such as 2/4".to_owned()),
    }
}
