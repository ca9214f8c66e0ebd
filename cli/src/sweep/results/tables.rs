//! Tables as CSV: 17 digits or as many as a number needs, nothing where there is no number.
//!
//! Lines that begin with `#` say of what the table is; readers are told to skip them (`comment="#"`).

use super::super::loaded::Loaded;
use super::super::store::Head;
use super::{Replaced, column};
use crate::failure::Failure;
use crate::write::unwritable;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// What the table is of, and its columns.
pub(super) fn head(out: &mut impl Write, loaded: &Loaded, head: &Head) -> io::Result<()> {
    writeln!(out, "# study {} ({}), model {}", head.name, head.path, loaded.scene.page.name)?;
    writeln!(out, "# {} scenarios, seed {}", head.scenarios, head.seed)?;
    writeln!(out, "# gyro-sim {}, program {}, job {}", head.commit, head.program, head.job)?;
    let study = &loaded.study;
    let names = study.targets.iter().chain(&study.numbers).chain(&study.slopes).map(column);
    let names = std::iter::once("scenario".to_owned()).chain(names).chain(["error".to_owned()]);
    writeln!(out, "{}", names.map(|name| quoted(&name)).collect::<Vec<_>>().join(","))
}

/// One scenario.
pub(super) fn row(out: &mut impl Write, k: u64, numbers: [&[f64]; 2], error: Option<&str>) -> io::Result<()> {
    write!(out, "{k}")?;
    for number in numbers.into_iter().flatten() {
        cell(out, *number)?;
    }
    writeln!(out, ",{}", quoted(error.unwrap_or_default()))
}

fn cell(out: &mut impl Write, number: f64) -> io::Result<()> {
    out.write_all(b",")?;
    if number.is_nan() { Ok(()) } else { out.write_all(ryu::Buffer::new().format(number).as_bytes()) }
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}

/// The table of whole series, if any are kept for themselves: a row for each sample of each scenario.
pub(super) struct Series<'a> {
    table: Option<Replaced>,
    times: &'a [f64],
    /// How many series there are, and derivatives of them.
    widths: [usize; 2],
}

impl<'a> Series<'a> {
    pub(super) fn open(folder: &Path, loaded: &Loaded, times: &'a [f64]) -> Result<Self, Failure> {
        let study = &loaded.study;
        let widths = [study.series.len(), study.series_slopes.len()];
        if !study.has_series {
            return Ok(Self { table: None, times, widths });
        }
        let mut table = Replaced::open(&folder.join("series.csv"))?;
        let names: Vec<String> =
            study.series.iter().chain(&study.series_slopes).map(|named| quoted(&column(named))).collect();
        let written = writeln!(table.file, "scenario,t [s],{}", names.join(","));
        written.map_err(|e| unwritable(&table.path, "written", &e))?;
        Ok(Self { table: Some(table), times, widths })
    }

    /// The series of a scenario and their derivatives, both sample after sample.
    pub(super) fn row(&mut self, k: u64, numbers: [&[f64]; 2]) -> Result<(), Failure> {
        let Some(table) = &mut self.table else { return Ok(()) };
        let mut write = || -> io::Result<()> {
            for (sample, t) in self.times.iter().enumerate() {
                let [values, slopes] =
                    [0, 1].map(|k| &numbers[k][sample * self.widths[k]..][..self.widths[k]]);
                if values.iter().all(|value| value.is_nan()) {
                    continue;
                }
                write!(table.file, "{k}")?;
                cell(&mut table.file, *t)?;
                values.iter().chain(slopes).try_for_each(|value| cell(&mut table.file, *value))?;
                writeln!(table.file)?;
            }
            Ok(())
        };
        write().map_err(|e| unwritable(&table.path, "written", &e))
    }

    pub(super) fn finish(self) -> Result<Option<PathBuf>, Failure> {
        self.table.map(Replaced::finish).transpose()
    }
}
