//! What a sweep comes to: a row for each scenario, quantiles, plots and a page.
//!
//! The blocks are read from their file, one after the other: memory does not grow with their number.

mod cloud;
mod figures;
mod gathered;
mod linear;
mod page;
#[cfg(feature = "parquet")]
mod parquet;
mod spread;
mod statistics;
mod tables;

use super::loaded::Loaded;
use super::store::Blocks;
use crate::failure::Failure;
use crate::remarks::say;
use crate::write::{self, Known, unwritable};
use gathered::Gathered;
use gyro_sweep::{Source, quantiles};
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

/// Writes the results of the blocks in a folder.
///
/// # Errors
/// Blocks that are not all there, or a place that cannot be written to.
pub(super) fn write(folder: &Path, loaded: &Loaded) -> Result<(), Failure> {
    let mut gathered = Gathered::new(loaded);
    let mut written = tables(folder, loaded, &mut gathered)?;
    let spread = spread::spread(folder, loaded)?;
    let mut figures = gathered.figures(loaded).map_err(|error| Failure::Run(error.to_string()))?;
    if let Some(spread) = &spread {
        written.push(spread.write(&folder.join("quantiles.csv"))?);
        figures.push(("quantiles", spread.svg().map_err(|error| Failure::Run(error.to_string()))?));
    }
    for (name, svg) in &figures {
        let path = folder.join(format!("{name}.svg"));
        write::write(&path, svg, Known::Place)?;
        written.push(path);
    }
    let path = folder.join("index.html");
    write::write(&path, page::page(loaded, &gathered, &figures), Known::Place)?;
    written.push(path);
    let names: Vec<_> = written.iter().filter_map(|path| path.file_name()?.to_str()).collect();
    say(&format!("{}wrote {} to {}\n", gathered.text(loaded), names.join(", "), folder.display()))
}

/// Writes the tables in one pass, and gathers what figures need.
fn tables(folder: &Path, loaded: &Loaded, gathered: &mut Gathered) -> Result<Vec<PathBuf>, Failure> {
    let mut blocks = Blocks::open(folder)?;
    let (plan, times) = (&loaded.study.plan, super::job(loaded).times());
    let mut source = Source::new(plan);
    let mut values = vec![0.0; plan.targets.len()];
    let path = folder.join("scenarios.csv");
    let mut table = Replaced::open(&path)?;
    tables::head(&mut table.file, loaded, &blocks.head).map_err(|e| unwritable(&path, "written", &e))?;
    #[cfg(feature = "parquet")]
    let mut parquet = parquet::Table::open(&folder.join("scenarios.parquet"), loaded, &blocks.head)?;
    let mut series = tables::Series::open(folder, loaded, &times)?;
    let mut next = 0;
    while let Some(block) = blocks.block()? {
        for (k, numbers, error) in block.rows() {
            source.write(k, &mut values);
            let [numbers, slopes, tracks] = loaded.study.keep.apart(numbers, times.len());
            let written = tables::row(&mut table.file, k, [&values, numbers], error);
            written.map_err(|e| unwritable(&path, "written", &e))?;
            #[cfg(feature = "parquet")]
            parquet.row(k, [&values, numbers], error)?;
            series.row(k, [tracks, slopes])?;
            gathered.add(k, &values, numbers, error);
            next = k + 1;
        }
    }
    if next < plan.scenarios() {
        let words = format!("{} ends with scenario {next}: --resume goes on", blocks.path.display());
        return Err(Failure::Run(words));
    }
    let mut written = vec![table.finish()?];
    #[cfg(feature = "parquet")]
    written.push(parquet.finish()?);
    written.extend(series.finish()?);
    Ok(written)
}

/// A file that is written beside the one that it then replaces; what a killed sweep has left of it is written over.
struct Replaced {
    path: PathBuf,
    beside: PathBuf,
    file: BufWriter<File>,
}

impl Replaced {
    fn open(path: &Path) -> Result<Self, Failure> {
        write::check(path, Known::Place)?;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let beside = path.with_file_name(format!(".{name}.part"));
        let file = File::create(&beside).map_err(|e| unwritable(&beside, "written", &e))?;
        Ok(Self { path: path.to_path_buf(), beside, file: BufWriter::new(file) })
    }

    fn finish(mut self) -> Result<PathBuf, Failure> {
        let done = self.file.flush().and_then(|()| fs::rename(&self.beside, &self.path));
        done.map_err(|e| unwritable(&self.path, "written", &e)).map(|()| self.path.clone())
    }
}

impl Drop for Replaced {
    fn drop(&mut self) {
        // It is there still only after a failure, which is the one to tell.
        let _ = fs::remove_file(&self.beside);
    }
}

/// A column's name with its unit, as the tables of `simulate` have it.
fn column((name, unit): &(String, String)) -> String {
    if unit.is_empty() { name.clone() } else { format!("{name} [{unit}]") }
}
