//! What is gathered of all scenarios in one pass, in memory that their number does not change.

use super::super::loaded::Loaded;
use super::cloud::{self, Column};
use super::figures::{self, Map};
use super::linear::Linear;
use crate::words::{count, number, table};
use gyro_sweep::{Indices, IndicesOf, Sampling};
use std::collections::BTreeMap;
use std::error::Error;

/// Scenarios that statistics are of, at most: of more every second, third and so on.
const SAMPLE: u64 = 10_000;
/// Points of a plot, at most.
const POINTS: usize = 300;
/// Points of a map, at most.
const CELLS: u64 = 250_000;
/// Kinds of error that are told apart.
const KINDS: usize = 20;

/// Some points, a map, indices, and what failed.
#[derive(Debug)]
pub(super) struct Gathered {
    scenarios: u64,
    failed: u64,
    /// How often each error has come, numbers left out of its words.
    pub(super) errors: BTreeMap<String, u64>,
    /// Every how many scenarios one is in the sample.
    pub(super) stride: u64,
    /// What varies and what is kept of these.
    sample: Vec<Vec<f64>>,
    indices: Option<Indices>,
    /// Of each point of a grid of two axes its kept numbers.
    cells: Option<Vec<Vec<f64>>>,
    extremes: Vec<[f64; 2]>,
    pub(super) linear: Option<Linear>,
}

impl Gathered {
    pub(super) fn new(loaded: &Loaded) -> Self {
        let study = &loaded.study;
        let plan = &study.plan;
        let is_map = plan.axes.len() == 2
            && plan.axes.iter().all(|axis| axis.targets.len() == 1)
            && plan.grid() <= CELLS
            && !study.numbers.is_empty();
        let is_saltelli = plan.sampling == Sampling::Saltelli && !study.numbers.is_empty();
        Self {
            scenarios: 0,
            failed: 0,
            errors: BTreeMap::new(),
            stride: plan.scenarios().div_ceil(SAMPLE).max(1),
            sample: Vec::new(),
            indices: is_saltelli.then(|| Indices::new(study.numbers.len(), plan.draws.len())),
            cells: is_map.then(Vec::new),
            extremes: vec![[f64::INFINITY, f64::NEG_INFINITY]; study.numbers.len()],
            linear: Linear::new(loaded),
        }
    }

    pub(super) fn add(&mut self, k: u64, values: &[f64], numbers: &[f64], error: Option<&str>) {
        self.scenarios += 1;
        let (numbers, slopes) = numbers.split_at(self.extremes.len());
        if let Some(linear) = &mut self.linear {
            linear.add(k, values, numbers, slopes);
        }
        if let Some(words) = error {
            self.failed += 1;
            let kind = kind(words);
            if self.errors.contains_key(&kind) || self.errors.len() < KINDS {
                *self.errors.entry(kind).or_default() += 1;
            }
        }
        if k.is_multiple_of(self.stride) {
            self.sample.push([values, numbers].concat());
        }
        if let Some(indices) = &mut self.indices {
            indices.add(numbers);
        }
        if let Some(cells) = self.cells.as_mut().filter(|cells| (cells.len() as u64) < CELLS) {
            cells.push(numbers.to_vec());
        }
        for ([low, high], number) in self.extremes.iter_mut().zip(numbers) {
            (*low, *high) = (low.min(*number), high.max(*number));
        }
    }

    pub(super) fn indices(&self) -> Option<Vec<IndicesOf>> {
        self.indices.as_ref().map(Indices::finish)
    }

    /// The figures that the study has something for, with their names.
    pub(super) fn figures(&self, loaded: &Loaded) -> Result<Vec<(&'static str, String)>, Box<dyn Error>> {
        let study = &loaded.study;
        let mut drawn = Vec::new();
        if let Some(cells) = &self.cells {
            let [slow, fast] = [0, 1].map(|k| {
                let axis = &study.plan.axes[k];
                let values: Vec<f64> = axis.rows.iter().map(|row| row[0]).collect();
                (study.targets[axis.targets[0]].clone(), values)
            });
            drawn.push(("map", figures::maps(&Map { slow, fast, numbers: &study.numbers, cells })?));
        }
        if let Some(indices) = self.indices() {
            drawn.push(("indices", figures::bars(&draws(loaded), &study.numbers, &indices)?));
        }
        if !study.numbers.is_empty() && self.cells.is_none() && !study.targets.is_empty() {
            let [targets, numbers] = self.columns(loaded, self.sample.len().div_ceil(POINTS).max(1));
            drawn.push(("scatter", cloud::scatter(&targets, &numbers)));
        }
        Ok(drawn)
    }

    /// What varies and what is kept, of every so many scenarios of the sample.
    pub(super) fn columns<'a>(&self, loaded: &'a Loaded, every: usize) -> [Vec<Column<'a>>; 2] {
        let of = |names: &'a [(String, String)], first: usize| {
            let column = |(k, name)| Column {
                name,
                values: self.sample.iter().step_by(every).map(|row| row[first + k]).collect(),
            };
            names.iter().enumerate().map(column).collect::<Vec<_>>()
        };
        let study = &loaded.study;
        [of(&study.targets, 0), of(&study.numbers, study.targets.len())]
    }

    /// A few lines for the terminal.
    pub(super) fn text(&self, loaded: &Loaded) -> String {
        let mut text = String::new();
        let rows = loaded.study.numbers.iter().zip(&self.extremes).map(|((name, unit), [low, high])| {
            vec![name.clone(), format!("from {} to {} {unit}", number(*low, 5), number(*high, 5))]
        });
        text += &table(&rows.collect::<Vec<_>>());
        if let Some((title, rows)) = self.linear.as_ref().and_then(|linear| linear.rows(loaded)) {
            text += &format!("{title}:\n{}", table(&rows));
        }
        if self.failed > 0 {
            text += &format!("{} of {} failed\n", self.failed, count(self.scenarios, "scenario"));
            for (kind, times) in &self.errors {
                text += &format!("  {times} x {kind}\n");
            }
        }
        text
    }
}

/// What is drawn together is one draw: its names.
pub(super) fn draws(loaded: &Loaded) -> Vec<String> {
    let name = |target: &usize| loaded.study.targets[*target].0.clone();
    let names = |draw: &gyro_sweep::Draw| match draw {
        gyro_sweep::Draw::Alone { target, .. } => name(target),
        gyro_sweep::Draw::Together { targets, .. } => targets.iter().map(name).collect::<Vec<_>>().join(", "),
    };
    loaded.study.plan.draws.iter().map(names).collect()
}

/// An error without its numbers, which differ from scenario to scenario.
fn kind(words: &str) -> String {
    let is_number = |word: &str| {
        let word = word.trim_start_matches(['(', '[', '-', '+', '.']);
        word.starts_with(|c: char| c.is_ascii_digit())
    };
    words.split(' ').map(|word| if is_number(word) { "…" } else { word }).collect::<Vec<_>>().join(" ")
}
