//! Scenarios are run: in this process, or by a program of which all but a few lines are here.
//!
//! The program reads a [`Job`] from standard input and then, until the input ends, a [`Unit`] at a time; of each block
//! it writes the record to standard output. A scenario that fails is a row with its error; no scenario ends the
//! program.

mod joint;
pub(crate) mod packs;
pub(crate) mod sensitive;
mod variational;
mod watch;
pub(crate) mod whole;

use crate::keep::sample_times;
use crate::plan::{Source, Target};
use crate::record::Block;
use crate::{Keep, Keeper, Plan};
use gyro_runner::protocol::read;
use gyro_runner::{Approach, Input, Settings, Start, scheduled};
use nanoserde::{DeBin, SerBin};
pub use packs::packs;
pub use sensitive::{packs_sensitive, whole_sensitive};
use std::io::{self, BufRead, BufWriter, Write};
use std::process::ExitCode;
use std::time::{Duration, Instant};
pub use whole::whole;

/// Makes something, such as a mechanism, of the values of parameters.
type Making<N, M> = Box<dyn Fn(&[N]) -> M>;

/// What is to be run: all that a program needs to know of a study.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub struct Job {
    /// What varies.
    pub plan: Plan,
    /// What is kept.
    pub keep: Keep,
    /// When to step, to correct and to sample.
    pub settings: Settings,
    /// By which method.
    pub approach: Approach,
    /// The parameters' values where they do not vary.
    pub parameters: Vec<f64>,
    /// Where a scenario starts for which nothing else is said, with the inputs that do not vary.
    pub start: Start,
    /// Scenarios in a block.
    pub block: u32,
    /// For estimates of errors: the mechanism's size, m, and whether the energy's balance has to close.
    pub measure: Option<(f64, bool)>,
}

/// Blocks to be run.
#[derive(Clone, Debug, Default, PartialEq, SerBin, DeBin)]
pub struct Unit {
    /// Their numbers.
    pub blocks: Vec<u64>,
    /// Where their scenarios start, or why they cannot; empty where all start alike.
    #[nserde(proxy = "Starts")]
    pub starts: Vec<Result<Start, String>>,
    /// How far each of these has been moved: [`Keep::moved`].
    pub moved: Vec<Vec<f64>>,
    /// For sensitivities the derivatives of each of these starts.
    pub slopes: Vec<StartSlopes>,
}

/// The derivatives of a start.
#[derive(Clone, Debug, PartialEq, SerBin, DeBin)]
pub enum StartSlopes {
    /// Those of its positions, velocities and turn references by one direction after the other, times the direction's
    /// [scale](Plan::scale).
    Of(Vec<f64>),
    /// Why there are none.
    Impossible(String),
}

/// As they are handed over.
#[derive(SerBin, DeBin)]
struct Starts(Vec<Outset>);

#[derive(Clone, SerBin, DeBin)]
#[expect(clippy::large_enum_variant, reason = "almost all are starts")]
enum Outset {
    At(Start),
    Impossible(String),
}

impl From<&Vec<Result<Start, String>>> for Starts {
    fn from(starts: &Vec<Result<Start, String>>) -> Self {
        let outset = |start: &Result<Start, String>| match start {
            Ok(start) => Outset::At(start.clone()),
            Err(words) => Outset::Impossible(words.clone()),
        };
        Self(starts.iter().map(outset).collect())
    }
}

impl From<&Starts> for Vec<Result<Start, String>> {
    fn from(starts: &Starts) -> Self {
        let result = |outset: &Outset| match outset {
            Outset::At(start) => Ok(start.clone()),
            Outset::Impossible(words) => Err(words.clone()),
        };
        starts.0.iter().map(result).collect()
    }
}

impl Job {
    /// The first scenario of a block, and how many it has.
    pub fn range(&self, block: u64) -> (u64, u32) {
        let first = block * u64::from(self.block);
        let left = self.plan.scenarios().saturating_sub(first);
        (first, u32::try_from(left).unwrap_or(u32::MAX).min(self.block))
    }

    /// How many blocks there are.
    pub fn blocks(&self) -> u64 {
        self.plan.scenarios().div_ceil(u64::from(self.block))
    }

    /// The times of a scenario's samples, s.
    pub fn times(&self) -> Vec<f64> {
        sample_times(&scheduled(&self.settings, &self.approach))
    }

    /// The parameters of a scenario with these values.
    fn write_parameters(&self, values: &[f64], parameters: &mut Vec<f64>) {
        parameters.clone_from(&self.parameters);
        for (target, value) in self.plan.targets.iter().zip(values) {
            if let Target::Parameter(index) = target {
                parameters[*index] = *value;
            }
        }
    }
}

/// Where some scenarios start: for each of them one, or nothing where all start alike.
#[derive(Clone, Copy)]
pub(crate) struct Outsets<'u> {
    starts: &'u [Result<Start, String>],
    moved: &'u [Vec<f64>],
    slopes: &'u [StartSlopes],
}

impl Outsets<'_> {
    /// Takes the first ones away.
    fn take(&mut self, count: usize) -> Self {
        fn first<'u, T>(of: &mut &'u [T], count: usize) -> &'u [T] {
            let (own, rest) = of.split_at(count.min(of.len()));
            *of = rest;
            own
        }
        Self {
            starts: first(&mut self.starts, count),
            moved: first(&mut self.moved, count),
            slopes: first(&mut self.slopes, count),
        }
    }
}

/// What runs scenarios one after the other.
pub(crate) trait Runs {
    /// Runs scenarios that follow each other and appends what is kept of them.
    fn run(&mut self, block: &mut Block, from: Outsets<'_>);

    /// Runs the blocks of a unit and tells of them in their order.
    fn run_blocks(&mut self, blocks: Blocks<'_>, unit: &Unit, tell: &mut Tell<'_>) -> io::Result<()> {
        let mut rest = Outsets { starts: &unit.starts, moved: &unit.moved, slopes: &unit.slopes };
        for mut block in blocks {
            let own = rest.take(block.count as usize);
            self.run(&mut block, own);
            tell(block)?;
        }
        Ok(())
    }
}

/// Blocks without numbers: what is to be run.
pub(crate) type Blocks<'a> = &'a mut dyn Iterator<Item = Block>;

/// Hears of blocks that have been run.
pub(crate) type Tell<'a> = dyn FnMut(Block) -> io::Result<()> + 'a;

/// What runs the scenarios of a job.
pub struct Scenarios {
    job: &'static Job,
    runs: Box<dyn Runs>,
}

impl std::fmt::Debug for Scenarios {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Scenarios").field("job", self.job).finish_non_exhaustive()
    }
}

impl Scenarios {
    pub(crate) fn new(job: &'static Job, runs: impl Runs + 'static) -> Self {
        Self { job, runs: Box::new(runs) }
    }

    /// Runs the blocks of a unit and tells of them in their order.
    ///
    /// # Errors
    /// Those of `tell`.
    pub fn run(&mut self, unit: &Unit, tell: &mut dyn FnMut(Block) -> io::Result<()>) -> io::Result<()> {
        let mut blocks = unit.blocks.iter().map(|block| {
            let (first, count) = self.job.range(*block);
            Block { first, count, ..Block::default() }
        });
        self.runs.run_blocks(&mut blocks, unit, tell)
    }
}

/// Reads the job, then units; answers with records.
fn serve(begin: impl FnOnce(&'static Job) -> Scenarios) -> ExitCode {
    match answer(begin, &mut io::stdin().lock(), &mut io::stdout().lock()) {
        Ok(()) => ExitCode::SUCCESS,
        // Nobody is left to be told if standard error is closed.
        Err(error) => {
            let _ = writeln!(io::stderr(), "{error}");
            ExitCode::FAILURE
        }
    }
}

/// Short blocks are handed over together: to wake a reader takes longer than a scenario.
const SEND_EVERY: Duration = Duration::from_millis(20);

fn answer(
    begin: impl FnOnce(&'static Job) -> Scenarios,
    input: &mut impl BufRead,
    output: &mut impl Write,
) -> io::Result<()> {
    let Some(job) = read::<Job>(input)? else { return Ok(()) };
    // One job for the life of the program.
    let mut scenarios = begin(Box::leak(Box::new(job)));
    let mut output = BufWriter::with_capacity(1 << 16, output);
    while let Some(unit) = read::<Unit>(input)? {
        let mut sent = Instant::now();
        scenarios.run(&unit, &mut |block| {
            output.write_all(&block.encode())?;
            if sent.elapsed() < SEND_EVERY {
                return Ok(());
            }
            sent = Instant::now();
            output.flush()
        })?;
        output.flush()?;
    }
    Ok(())
}

/// What scenarios of a job have in common.
pub(crate) struct Common {
    job: &'static Job,
    source: Source<'static>,
    keeper: Keeper<'static>,
    values: Vec<f64>,
    parameters: Vec<f64>,
    /// What varies of the inputs.
    inputs: Vec<Input>,
    has_inputs: bool,
}

impl Common {
    fn new(job: &'static Job) -> Self {
        Self {
            job,
            source: Source::new(&job.plan),
            keeper: Keeper::new(&job.keep, job.times().len()),
            values: vec![0.0; job.plan.targets.len()],
            parameters: Vec::new(),
            inputs: Vec::new(),
            has_inputs: job.plan.targets.iter().any(|of| matches!(of, Target::Input(_) | Target::Table(_))),
        }
    }

    /// Takes up scenario k.
    fn draw(&mut self, k: u64) {
        self.source.write(k, &mut self.values);
        self.job.write_parameters(&self.values, &mut self.parameters);
        if self.has_inputs {
            self.inputs = self.job.plan.inputs(&self.values);
        }
    }
}

/// Notes an error of a row. It is one line, as tables have it.
fn note(block: &mut Block, row: u32, words: &str) {
    block.errors.push((row, words.split_whitespace().collect::<Vec<_>>().join(" ")));
}

#[cfg(test)]
mod tests;
