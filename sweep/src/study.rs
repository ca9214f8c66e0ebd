//! Study files: which model, what varies, how scenarios are run and what is kept of them.
//!
//! The reader reports every mistake at once, each with its line and what to write instead, in the way of model files.

mod kept;
mod reader;
mod runs;
mod vary;

use crate::plan::{Plan, Sampling, Target};
use crate::{Keep, Quantity};
use gyro_model::{Diagnostic, Diagnostics};
use gyro_runner::Input;
use reader::{Reader, Section};
pub use runs::RunOptions;
use std::ops::Range;
use toml::de::DeTable;

/// A study, checked.
#[derive(Clone, Debug)]
pub struct Study {
    /// Path of the model file as the study writes it.
    pub model: String,
    /// What varies.
    pub plan: Plan,
    /// What is kept.
    pub keep: Keep,
    /// How a scenario is run.
    pub run: RunOptions,
    /// Scenarios in a block.
    pub block: u32,
    /// Name and unit of what varies, in the order of the plan's targets.
    pub targets: Vec<(String, String)>,
    /// Name and unit of what is kept besides series.
    pub numbers: Vec<(String, String)>,
    /// Name and no unit of each derivative that is kept: of each number by each thing that varies, in the units of
    /// both.
    pub slopes: Vec<(String, String)>,
    /// Name and unit of each series.
    pub series: Vec<(String, String)>,
    /// Whether there are series that are kept for themselves, not for quantiles alone.
    pub has_series: bool,
    /// Name and no unit of each derivative of a sample of them.
    pub series_slopes: Vec<(String, String)>,
    /// The series of which quantiles are wanted, by their index; they come first.
    pub quantiles: usize,
}

/// What a model has that a study can name.
#[derive(Clone, Debug, Default)]
pub struct Vocabulary {
    /// What can be varied: names with what they are, their units and their values in the model file.
    pub parameters: Vec<(String, f64)>,
    /// Inputs, likewise.
    pub inputs: Vec<(String, f64)>,
    /// What sets inputs by itself.
    pub setters: Vec<Setter>,
    /// Starts, named as the columns of results: `alpha`, `alpha rate`.
    pub starts: Vec<Named<Target>>,
    /// Starts that are as a driver has them, and the drivers' names.
    pub driven: Vec<(String, String)>,
    /// What the model file gives of starts and lets the assembly move: joints and their coordinates.
    pub rough: Vec<Named<(usize, usize)>>,
    /// What can be kept.
    pub columns: Vec<Named<Quantity>>,
}

/// Something of the model that sets inputs in runs: no study can vary these, and none of such a model has derivatives.
#[derive(Clone, Debug)]
pub struct Setter {
    /// What it is.
    pub kind: SetterKind,
    /// Its name.
    pub name: String,
    /// The indices of the inputs.
    pub inputs: Vec<usize>,
}

/// What sets inputs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SetterKind {
    /// A sampled controller.
    Controller,
    /// A rigid stop or friction that sticks.
    Contact,
    /// A motion along straight lines.
    Lines,
}

/// Something with a name and a unit.
#[derive(Clone, Debug)]
pub struct Named<T> {
    /// The name.
    pub name: String,
    /// The unit.
    pub unit: String,
    /// What it is.
    pub of: T,
}

/// Why a study cannot be read.
#[derive(Debug)]
pub enum Unreadable<E> {
    /// Mistakes in the study.
    Study(Diagnostics),
    /// What is wrong with its model.
    Model(E),
}

/// What stands beside a study file.
pub trait Files {
    /// What is wrong with a model.
    type Error;
    /// What the model at this path has to name.
    ///
    /// # Errors
    /// A model that cannot be read.
    fn model(&mut self, path: &str) -> Result<Vocabulary, Self::Error>;
    /// The input of this index as the table at a path has it.
    ///
    /// # Errors
    /// What is wrong with the table, or with its values for this input.
    fn table(&mut self, input: usize, path: &str) -> Result<Input, String>;
}

/// Scenarios in a block unless the study says otherwise.
const BLOCK: u32 = 64;

const KEYS: [&str; 9] = ["format", "model", "scenarios", "seed", "sampling", "block", "run", "vary", "keep"];

/// Reads a study file. Its name is used in messages only.
///
/// # Errors
/// Every mistake of the study, or what is wrong with its model.
pub fn read<F: Files>(file_name: &str, text: &str, files: &mut F) -> Result<Study, Unreadable<F::Error>> {
    let (document, syntax) = DeTable::parse_recoverable(text);
    let mut mistakes: Vec<Diagnostic> = syntax.iter().map(|error| syntax_mistake(text, error)).collect();
    if mistakes.is_empty() {
        let mut reader = Reader::default();
        let study = page(&mut reader, document.get_ref(), files).map_err(Unreadable::Model)?;
        mistakes = reader.mistakes;
        if let (Some(study), true) = (study, mistakes.is_empty()) {
            return Ok(study);
        }
    }
    Err(Unreadable::Study(Diagnostics::new(file_name, text, mistakes)))
}

fn syntax_mistake(text: &str, error: &toml::de::Error) -> Diagnostic {
    let span = error.span().unwrap_or(0..text.len().min(1));
    let label = "cannot be read".to_owned();
    let help = "write `key = value`, `[table]` or `[[vary]]`".to_owned();
    Diagnostic { span, message: error.message().to_owned(), label, help, related: Vec::new() }
}

fn page<F: Files>(
    reader: &mut Reader,
    table: &DeTable<'_>,
    files: &mut F,
) -> Result<Option<Study>, F::Error> {
    let whole = Section::open(reader, table, 0..0, "a study", &KEYS);
    if let Some(format) = whole.require(reader, "format", "format = 1").and_then(|item| item.whole(reader))
        && format != 1
    {
        whole.wrong(reader, "format", ["this format is not known", "not 1", "write format = 1"]);
    }
    let model = whole.require(reader, "model", "model = \"../models/gyroscope-misalignments.toml\"");
    let Some(model) = model.and_then(|item| item.text(reader)) else { return Ok(None) };
    let vocabulary = files.model(&model)?;
    let run = runs::read(reader, &whole);
    let varied = vary::read(reader, &whole, &vocabulary, files);
    let kept = kept::read(reader, &whole, &vocabulary);
    let sampling = sampling(reader, &whole);
    let seed = whole.get("seed").map_or(Some(1), |item| item.whole(reader));
    let block = whole.get("block").map_or(Some(u64::from(BLOCK)), |item| item.positive(reader));
    let has_draws = !varied.draws.is_empty();
    let repeats = match whole.get("scenarios") {
        None if !has_draws => Some(1),
        None => {
            let example = "scenarios = 1000: how many times the draws are made, for each point of a grid";
            whole.require(reader, "scenarios", example);
            None
        }
        Some(item) => item.positive(reader),
    };
    let (Some(run), Some(kept), Some(sampling), Some(seed), Some(block), Some(repeats)) =
        (run, kept, sampling, seed, block, repeats)
    else {
        return Ok(None);
    };
    let mut kept = kept;
    kept.sensitivities(reader, &whole, (&varied.targets, &varied.names), &run, &vocabulary);
    kept.moves(&varied.targets, vocabulary.rough);
    let plan =
        Plan { seed, sampling, targets: varied.targets, axes: varied.axes, draws: varied.draws, repeats };
    check(reader, &whole, &plan, block);
    let has_series = kept.has_series();
    Ok(Some(Study {
        model,
        plan,
        keep: kept.keep,
        run,
        block: u32::try_from(block).unwrap_or(BLOCK),
        targets: varied.names,
        numbers: kept.numbers,
        has_series,
        slopes: kept.slopes,
        series: kept.series,
        series_slopes: kept.series_slopes,
        quantiles: kept.quantiles,
    }))
}

fn sampling(reader: &mut Reader, whole: &Section<'_>) -> Option<Sampling> {
    let Some(item) = whole.get("sampling") else { return Some(Sampling::Random) };
    item.choice(
        reader,
        &[("random", Sampling::Random), ("sobol", Sampling::Sobol), ("saltelli", Sampling::Saltelli)],
    )
}

/// Scenarios that can be counted: an index is exact in `f64`, and in the points of Sobol's sequence.
const MOST: u64 = 1 << 52;

/// The largest block: a record is one piece of memory.
const LARGEST_BLOCK: u64 = 1 << 16;

/// What only the whole can tell.
fn check(reader: &mut Reader, whole: &Section<'_>, plan: &Plan, block: u64) {
    let needed = plan.dimensions() * if plan.sampling == Sampling::Saltelli { 2 } else { 1 };
    if plan.sampling != Sampling::Random && needed > crate::sobol::DIMENSIONS {
        let message = format!("this takes points of {needed} dimensions");
        whole.wrong(reader, "sampling", [&message, "there are 100", "write sampling = \"random\""]);
    }
    if plan.sampling == Sampling::Saltelli && !plan.axes.is_empty() {
        let help = "draw these from a distribution too, or make one study for each point of the grid";
        whole.wrong(reader, "sampling", ["indices of sensitivity are of what is drawn", "with a grid", help]);
    }
    if plan.sampling == Sampling::Saltelli && plan.draws.is_empty() {
        let help = "draw something from a distribution, such as uniform = [0, 1]";
        whole.wrong(reader, "sampling", ["nothing is drawn", "of what?", help]);
    }
    if plan.scenarios() > MOST {
        let message = format!("there are {} scenarios", plan.scenarios());
        whole.wrong(reader, "scenarios", [&message, "too many", "at most 2^52 can be counted"]);
    }
    if block > LARGEST_BLOCK {
        whole.wrong(reader, "block", ["this block is too large", "above 65536", "write block = 64"]);
    }
}

/// A place in the text.
type Span = Range<usize>;

#[cfg(test)]
mod tests;
