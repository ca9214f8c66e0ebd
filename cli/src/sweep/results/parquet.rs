//! The table of scenarios as Parquet: a row for each, with nothing where there is no number, and in the file's own
//! key-value metadata which study it is of.

use super::super::loaded::Loaded;
use super::super::store::Head;
use super::{Replaced, column};
use crate::failure::Failure;
use crate::write::unwritable;
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::column::writer::ColumnWriter;
use parquet::data_type::ByteArray;
use parquet::errors::Result;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{Type, TypePtr};
use std::fs::File;
use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Rows that are held in memory and written at once.
const GROUP: usize = 1 << 16;

/// The table under way.
pub(super) struct Table {
    replaced: Replaced,
    writer: SerializedFileWriter<BufWriter<File>>,
    scenarios: Vec<i64>,
    /// Column after column: the numbers that there are, and for each row whether there is one.
    numbers: Vec<(Vec<f64>, Vec<i16>)>,
    errors: (Vec<ByteArray>, Vec<i16>),
}

impl Table {
    pub(super) fn open(path: &Path, loaded: &Loaded, head: &Head) -> std::result::Result<Self, Failure> {
        let replaced = Replaced::open(path)?;
        let file = replaced.file.get_ref().try_clone();
        let file = BufWriter::new(file.map_err(|e| unwritable(path, "written", &e))?);
        let study = &loaded.study;
        let names: Vec<String> =
            study.targets.iter().chain(&study.numbers).chain(&study.slopes).map(column).collect();
        let writer = writer(file, &names, loaded, head).map_err(|e| failed(path, &e))?;
        let numbers = vec![(Vec::new(), Vec::new()); names.len()];
        Ok(Self { replaced, writer, scenarios: Vec::new(), numbers, errors: (Vec::new(), Vec::new()) })
    }

    pub(super) fn row(
        &mut self,
        k: u64,
        numbers: [&[f64]; 2],
        error: Option<&str>,
    ) -> std::result::Result<(), Failure> {
        self.scenarios.push(i64::try_from(k).unwrap_or(i64::MAX));
        for ((values, levels), number) in self.numbers.iter_mut().zip(numbers.into_iter().flatten()) {
            levels.push(i16::from(!number.is_nan()));
            values.extend((!number.is_nan()).then_some(*number));
        }
        self.errors.1.push(i16::from(error.is_some()));
        self.errors.0.extend(error.map(ByteArray::from));
        if self.scenarios.len() < GROUP { Ok(()) } else { self.flush() }
    }

    pub(super) fn finish(mut self) -> std::result::Result<PathBuf, Failure> {
        self.flush()?;
        self.writer.close().map_err(|e| failed(&self.replaced.path, &e))?;
        self.replaced.finish()
    }

    fn flush(&mut self) -> std::result::Result<(), Failure> {
        self.group().map_err(|e| failed(&self.replaced.path, &e))
    }

    /// Writes the rows in memory.
    fn group(&mut self) -> Result<()> {
        if self.scenarios.is_empty() {
            return Ok(());
        }
        let mut group = self.writer.next_row_group()?;
        let mut numbers = self.numbers.iter_mut();
        while let Some(mut column) = group.next_column()? {
            match column.untyped() {
                ColumnWriter::Int64ColumnWriter(out) => {
                    out.write_batch(&self.scenarios, None, None)?;
                    self.scenarios.clear();
                }
                ColumnWriter::DoubleColumnWriter(out) => {
                    let (values, levels) = numbers.next().expect("a column for each name");
                    out.write_batch(values, Some(levels), None)?;
                    values.clear();
                    levels.clear();
                }
                ColumnWriter::ByteArrayColumnWriter(out) => {
                    out.write_batch(&self.errors.0, Some(&self.errors.1), None)?;
                    self.errors.0.clear();
                    self.errors.1.clear();
                }
                _ => unreachable!("there are columns of three types"),
            }
            column.close()?;
        }
        group.close().map(|_| ())
    }
}

fn failed(path: &Path, error: &parquet::errors::ParquetError) -> Failure {
    Failure::Run(format!("{} cannot be written: {error}", path.display()))
}

fn writer(
    file: BufWriter<File>,
    names: &[String],
    loaded: &Loaded,
    head: &Head,
) -> Result<SerializedFileWriter<BufWriter<File>>> {
    let leaf = |name: &str, physical, logical| -> Result<TypePtr> {
        let presence = if physical == Physical::INT64 { Repetition::REQUIRED } else { Repetition::OPTIONAL };
        let leaf = Type::primitive_type_builder(name, physical).with_repetition(presence);
        leaf.with_logical_type(logical).build().map(Arc::new)
    };
    let mut fields = vec![leaf("scenario", Physical::INT64, None)?];
    for name in names {
        fields.push(leaf(name, Physical::DOUBLE, None)?);
    }
    fields.push(leaf("error", Physical::BYTE_ARRAY, Some(LogicalType::String))?);
    let schema = Type::group_type_builder("scenarios").with_fields(fields).build()?;
    let noted = [
        ("study", &head.name),
        ("study_file", &head.path),
        ("study_text", &head.study),
        ("model", &loaded.scene.page.name),
        ("seed", &head.seed.to_string()),
        ("gyro_sim", &head.commit),
        ("program", &head.program),
    ];
    let noted = noted.map(|(key, value)| KeyValue::new(key.to_owned(), value.clone())).to_vec();
    let properties = WriterProperties::builder()
        .set_created_by("gyro-sim".to_owned())
        .set_key_value_metadata(Some(noted))
        .build();
    SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties))
}
