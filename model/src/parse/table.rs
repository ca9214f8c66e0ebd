//! Tables of motions and curves: two columns of a CSV file, of a motion joined by a smooth curve or by straight lines.

use super::names;
use super::reader::Reader;
use super::section::{Item, Section};
use crate::{Lines, Motion, Spline};

/// A table that cannot be used: what is wrong, a few words for the place in the model file, and what to do.
type Refusal = [String; 3];

/// What the first of two columns is called, with examples of names of both.
struct Words {
    first: &'static str,
    names: [&'static str; 2],
}

const OF_MOTIONS: Words = Words { first: "time", names: ["t", "angle"] };
const OF_CURVES: Words = Words { first: "argument", names: ["x", "y"] };

/// The points of the table that a curve names, through the caller's `load`.
pub(super) fn of_curve(
    reader: &mut Reader<'_>,
    item: Item<'_>,
    of_columns: Option<Item<'_>>,
) -> Option<Vec<(f64, f64)>> {
    let columns = of_columns.map(|item| columns(reader, item));
    let path = item.text(reader)?;
    let columns = columns.map_or(Some(None), |columns| columns.map(Some))?;
    let text = reader.load(path).map_err(|reason| not_loaded(path, &reason));
    let points = text.and_then(|text| points(path, &text, columns, &OF_CURVES));
    points.map_err(|words| item.wrong(reader, words)).ok()
}

/// Reads the table that a motion names, through the caller's `load`.
pub(super) fn read(reader: &mut Reader<'_>, section: &Section<'_>, item: Item<'_>) -> Option<Motion> {
    let is_smooth = !section.has("between") || section.word(reader, "between")? == "smooth";
    let columns = section.get("columns").map(|item| columns(reader, item));
    let path = item.text(reader)?;
    let columns = match columns {
        Some(columns) => Some(columns?),
        None => None,
    };
    let motion = reader.load(path).map_err(|reason| not_loaded(path, &reason)).and_then(|text| {
        let points = points(path, &text, columns, &OF_MOTIONS)?;
        let help = "write increasing times, and values of moderate size";
        let motion = if is_smooth {
            Spline::natural(path.to_owned(), &points).map(Motion::Table)
        } else {
            Lines::through(path.to_owned(), &points).map(Motion::Lines)
        };
        motion.map_err(|reason| refusal(path, &reason, help))
    });
    motion.map_err(|words| item.wrong(reader, words)).ok()
}

fn columns<'t>(reader: &mut Reader<'_>, item: Item<'t>) -> Option<[&'t str; 2]> {
    const EXPECTED: &str = "an array of two names";
    let names = item.texts(reader, EXPECTED)?;
    let names = names.into_iter().map(|(_, name)| name).collect::<Vec<_>>().try_into().ok();
    if names.is_none() {
        item.wrong_type(reader, EXPECTED);
    }
    names
}

/// The rows of a table as times, or arguments, and values.
fn points(
    path: &str,
    text: &str,
    columns: Option<[&str; 2]>,
    words: &Words,
) -> Result<Vec<(f64, f64)>, Refusal> {
    let first = words.first;
    let mut table = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(text.as_bytes());
    let broken = |error: csv::Error| {
        refusal(path, &reason(&error), "write a header and rows of the same length, separated by commas")
    };
    let header = table.headers().map_err(broken)?.clone();
    let [time, value] = find_columns(path, &header, columns, words)?;
    let mut points: Vec<(f64, f64)> = Vec::new();
    for record in table.records() {
        let record = record.map_err(broken)?;
        let line = record.position().map_or(0, csv::Position::line);
        let point = (field(path, &record, time, line)?, field(path, &record, value, line)?);
        if points.last().is_some_and(|last| last.0 >= point.0) {
            let reason = format!(
                "line {line}: the {first} {:?} is not after {:?}",
                point.0,
                points[points.len() - 1].0
            );
            let help = format!("sort the rows by {first} and keep one row for each {first}");
            return Err(refusal(path, &reason, &help));
        }
        points.push(point);
    }
    match points.len() {
        0 | 1 => {
            let reason = format!("found {} row{}", points.len(), if points.is_empty() { "s" } else { "" });
            let help = "write a header and at least two rows; a constant needs no table";
            Err(refusal(path, &reason, help))
        }
        _ => Ok(points),
    }
}

fn reason(error: &csv::Error) -> String {
    match error.kind() {
        csv::ErrorKind::UnequalLengths { pos, expected_len, len } => {
            let line = pos.as_ref().map_or(0, csv::Position::line);
            format!("line {line}: the row has length {len}, the header {expected_len}")
        }
        _ => error.to_string(),
    }
}

/// Indices of the two columns; without names there must be two.
fn find_columns(
    path: &str,
    header: &csv::StringRecord,
    columns: Option<[&str; 2]>,
    Words { first, names: [x, y] }: &Words,
) -> Result<[usize; 2], Refusal> {
    let known: Vec<&str> = header.iter().collect();
    if known.is_empty() {
        let help = format!("write a header and at least two rows, such as `{x},{y}`");
        return Err(refusal(path, "it is empty", &help));
    }
    if known.iter().all(|name| name.parse::<f64>().is_ok()) {
        let help = format!("write the names of the columns on the first line, such as `{x},{y}`");
        return Err(refusal(path, "its first line has numbers instead of names", &help));
    }
    let Some(columns) = columns else {
        let help = format!(
            "name the {first} and the value: columns = [\"{x}\", \"{y}\"]; it has {}",
            names::list(&known)
        );
        let reason = format!("it has {} column{}", known.len(), if known.len() == 1 { "" } else { "s" });
        return if known.len() == 2 { Ok([0, 1]) } else { Err(refusal(path, &reason, &help)) };
    };
    let find = |name: &str| {
        let help = || format!("{} in place of {name:?}", names::instead(name, &known));
        known
            .iter()
            .position(|other| *other == name)
            .ok_or_else(|| refusal(path, &format!("it has no column `{name}`"), &help()))
    };
    Ok([find(columns[0])?, find(columns[1])?])
}

fn field(path: &str, record: &csv::StringRecord, column: usize, line: u64) -> Result<f64, Refusal> {
    let text = record.get(column).unwrap_or_default();
    match text.parse::<f64>() {
        Ok(value) if in_range(value) => Ok(value),
        _ => {
            let reason = format!("line {line}: found `{text}` instead of a number");
            Err(refusal(path, &reason, "write finite decimals of moderate size"))
        }
    }
}

/// The sizes that numbers of a model file may have.
fn in_range(value: f64) -> bool {
    value == 0.0 || (1e-100..=1e100).contains(&value.abs())
}

pub(super) fn refusal(path: &str, reason: &str, help: &str) -> Refusal {
    [format!("table `{path}` cannot be used"), reason.to_owned(), help.to_owned()]
}

fn not_loaded(path: &str, reason: &str) -> Refusal {
    let help = "write the path of a CSV file, relative to the folder of the model file";
    [format!("table `{path}` cannot be read"), reason.to_owned(), help.to_owned()]
}
