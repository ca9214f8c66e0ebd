//! Quantiles over scenarios at each sample: how far apart they come.

use super::super::loaded::Loaded;
use super::super::store::Blocks;
use super::figures::{Drawn, bands};
use super::{column, quantiles};
use crate::failure::Failure;
use crate::write::{self, Known};
use gyro_sweep::QUANTILES;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Numbers that are held in memory at once: 128 MB of them.
const AT_ONCE: u64 = 16 << 20;

/// The quantiles of each series at each sample.
#[derive(Debug)]
pub(super) struct Spread {
    times: Vec<f64>,
    names: Vec<(String, String)>,
    /// Series after series.
    rows: Vec<Vec<[f64; QUANTILES.len()]>>,
}

/// Reads the blocks as often as it takes for all numbers of some samples to be in memory; of scenarios that ran to the
/// end.
pub(super) fn spread(folder: &Path, loaded: &Loaded) -> Result<Option<Spread>, Failure> {
    let study = &loaded.study;
    if study.quantiles == 0 {
        return Ok(None);
    }
    let times = super::super::job(loaded).times();
    let each = study.plan.scenarios().max(1) * study.quantiles as u64;
    let at_once = usize::try_from(AT_ONCE / each).unwrap_or(usize::MAX).clamp(1, times.len());
    let mut rows = vec![Vec::with_capacity(times.len()); study.quantiles];
    for first in (0..times.len()).step_by(at_once) {
        let samples = first..(first + at_once).min(times.len());
        let mut columns = vec![Vec::new(); samples.len() * study.quantiles];
        let mut blocks = Blocks::open(folder)?;
        while let Some(block) = blocks.block()? {
            for (_, numbers, _) in block.rows().filter(|(.., error)| error.is_none()) {
                let [.., tracks] = study.keep.apart(numbers, times.len());
                for (place, column) in columns.iter_mut().enumerate() {
                    let (sample, series) = (first + place / study.quantiles, place % study.quantiles);
                    column.push(tracks[sample * study.series.len() + series]);
                }
            }
        }
        for (place, column) in columns.iter_mut().enumerate() {
            rows[place % study.quantiles].push(quantiles(column));
        }
    }
    Ok(Some(Spread { times, names: study.series[..study.quantiles].to_vec(), rows }))
}

impl Spread {
    pub(super) fn write(&self, path: &Path) -> Result<PathBuf, Failure> {
        let mut text = "t [s]".to_owned();
        for (name, unit) in &self.names {
            for q in QUANTILES {
                let _ = write!(text, ",{}", column(&(format!("{name} {:.0} %", 100.0 * q), unit.clone())));
            }
        }
        text.push('\n');
        for (sample, t) in self.times.iter().enumerate() {
            let _ = write!(text, "{t:?}");
            for value in self.rows.iter().flat_map(|rows| rows[sample]) {
                let _ = if value.is_nan() { write!(text, ",") } else { write!(text, ",{value:?}") };
            }
            text.push('\n');
        }
        write::write(path, text, Known::Place)?;
        Ok(path.to_path_buf())
    }

    /// Bands of the quantiles over time, series below series.
    pub(super) fn svg(&self) -> Drawn {
        bands(&self.times, &self.names, &self.rows)
    }
}
