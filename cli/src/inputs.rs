//! What `--input` sets the inputs of a model to.

use crate::args::InputSetting;
use crate::failure::Failure;
use crate::{contacts, controllers, files, paths, words};
use gyro_model::{Model, Rational};
use gyro_runner::{Approach, Between, Input};
use std::path::Path;

/// The inputs that the command line gives.
pub(crate) fn inputs(model: &Model, given: &[(String, InputSetting)]) -> Result<Vec<Input>, Failure> {
    let known: Vec<&str> = model.inputs.iter().map(|input| input.name.as_str()).collect();
    let mut inputs: Vec<Input> = Vec::new();
    for (name, setting) in given {
        let index =
            known.iter().position(|other| other == name).ok_or_else(|| unknown(model, name, &known))?;
        if inputs.iter().any(|input| input.index == index) {
            return Err(Failure::Usage(format!("--input gives `{name}` twice")));
        }
        if let Some(controller) = controllers::setting(model, index) {
            let words = format!("--input {name}: the controller `{}` sets this input", controller.name);
            return Err(Failure::Usage(words));
        }
        if let Some(contact) = contacts::acting(model, index) {
            let words = format!("--input {name}: this is the force of the contact `{contact}`");
            return Err(Failure::Usage(words));
        }
        if let Some(owner) = paths::moving(model, index) {
            let words = format!("--input {name}: this is part of the motion of `{owner}`");
            return Err(Failure::Usage(words));
        }
        let followed = paths::followed(model, index);
        if let Some([place, ..]) = followed.filter(|[place, ..]| *place != index) {
            let name_of = &model.inputs[place].name;
            let words = format!(
                "--input {name}: this is a derivative of the motion `{name_of}`: give `{name_of}`, from which it follows"
            );
            return Err(Failure::Usage(words));
        }
        let input = match setting {
            InputSetting::Number(value) => Input::constant(index, *value),
            InputSetting::File(path, said) => {
                let rows = read(path)
                    .map_err(|words| Failure::Usage(format!("--input {name}={}: {words}", path.display())))?;
                Input::new(index, rows, said.unwrap_or_else(|| between(model, index)))
            }
            InputSetting::Rows(rows) => {
                let rows =
                    increasing(rows).map_err(|words| Failure::Usage(format!("--input {name}: {words}")))?;
                Input::new(index, rows, between(model, index))
            }
        };
        check(model, &input).map_err(|words| Failure::Usage(format!("--input {name}: {words}")))?;
        match followed {
            None => inputs.push(input),
            Some(of) if input.rows.len() == 1 || input.between == Between::Smooth => {
                inputs.extend(Input::motion(of, &input.rows));
            }
            Some(_) => {
                let words =
                    format!("--input {name}: a motion follows this input, whose velocity would jump: smooth");
                return Err(Failure::Usage(words));
            }
        }
    }
    Ok(inputs)
}

/// Steps of fixed length hold inputs: what a motion follows would be at rest, and jump.
pub(crate) fn refuse_held_motions(
    model: &Model,
    inputs: &[Input],
    approach: &Approach,
) -> Result<(), Failure> {
    let moves = |input: &&Input| input.rows.len() > 1 && paths::followed(model, input.index).is_some();
    match inputs.iter().find(moves).filter(|_| approach.tolerance.is_none()) {
        None => Ok(()),
        Some(input) => Err(Failure::Usage(format!(
            "a motion follows the input `{}`, which steps of fixed length hold: choose a method with error control, such \
             as --integrator dop853",
            model.inputs[input.index].name
        ))),
    }
}

/// Has motions start where the inputs that they follow do.
pub(crate) fn start_motions(model: &mut Model, inputs: &[Input]) {
    for of in model.followed_inputs().into_iter().map(|(_, of)| of).collect::<Vec<_>>() {
        for input in inputs.iter().filter(|input| of.contains(&input.index)) {
            if let Some(value) = Rational::from_float(input.at(0.0)) {
                model.inputs[input.index].value = value;
            }
        }
    }
}

/// An input as the table in a file has it, between its rows as is said or else as in the model file.
///
/// # Errors
/// A table that cannot be read, or values that the input cannot have.
pub(crate) fn table(
    model: &Model,
    index: usize,
    (path, said): (&Path, Option<Between>),
) -> Result<Input, String> {
    let input = Input::new(index, read(path)?, said.unwrap_or_else(|| between(model, index)));
    check(model, &input)?;
    Ok(input)
}

/// What the model file says an input is between the rows of a table.
fn between(model: &Model, index: usize) -> Between {
    match model.between.get(index).copied().unwrap_or_default() {
        gyro_model::Between::Held => Between::Held,
        gyro_model::Between::Linear => Between::Linear,
        gyro_model::Between::Smooth => Between::Smooth,
    }
}

/// The values of an input make sense if its extremes do: what must hold of a coefficient is a sign or a range of sizes.
fn check(model: &Model, input: &Input) -> Result<(), String> {
    let rows = input.extremes();
    let by = |less: fn(f64, f64) -> bool| {
        rows.iter().copied().reduce(|extreme, row| if less(row[1], extreme[1]) { row } else { extreme })
    };
    let is_nearer = |a: f64, b: f64| a != 0.0 && (b == 0.0 || a.abs() < b.abs());
    for row in [by(|a, b| a < b), by(|a, b| a > b), by(is_nearer)].into_iter().flatten() {
        let [t, value] = row;
        let exact = Rational::from_float(value).ok_or_else(|| format!("{value} is not finite"))?;
        let place = if rows.len() > 1 { format!(" at t = {t} s") } else { String::new() };
        model.check_input(input.index, &exact).map_err(|words| format!("with {value}{place} {words}"))?;
    }
    Ok(())
}

fn unknown(model: &Model, name: &str, known: &[&str]) -> Failure {
    let help = if known.is_empty() {
        format!("the model `{}` has no inputs; the model file names them under [inputs]", model.name)
    } else {
        words::instead(name, known)
    };
    Failure::Usage(format!("--input: unknown input `{name}`: {help}"))
}

/// The rows of a table that a program gives.
fn increasing(rows: &[[f64; 2]]) -> Result<Vec<[f64; 2]>, String> {
    if let Some(row) = rows.iter().find(|row| !row.iter().all(|value| value.is_finite())) {
        return Err(format!("found {row:?} in place of finite numbers"));
    }
    match rows.windows(2).find(|rows| rows[0][0] >= rows[1][0]) {
        Some(rows) => {
            Err(format!("the time {:?} is not after {:?}: times must increase", rows[1][0], rows[0][0]))
        }
        None if rows.is_empty() => Err("it has no rows: give times and values".to_owned()),
        None => Ok(rows.to_vec()),
    }
}

/// The rows of a table in a file.
fn read(path: &Path) -> Result<Vec<[f64; 2]>, String> {
    let text =
        files::input(path, files::LARGEST_TABLE).map_err(|e| format!("the file cannot be read: {e}"))?;
    rows(&text)
}

/// The rows of a table of times and values. A first line without numbers is a header; lines that start with `#` are
/// comments.
fn rows(text: &str) -> Result<Vec<[f64; 2]>, String> {
    let mut table = csv::ReaderBuilder::new()
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .comment(Some(b'#'))
        .from_reader(text.as_bytes());
    let mut rows: Vec<[f64; 2]> = Vec::new();
    for (number, record) in table.records().enumerate() {
        let record = record.map_err(|e| e.to_string())?;
        if number == 0 && record.iter().all(|cell| cell.parse::<f64>().is_err()) {
            continue;
        }
        let line = record.position().map_or(0, |position| line(text, position));
        let row = row(&record).map_err(|words| format!("line {line}: {words}"))?;
        if let Some([before, _]) = rows.last().filter(|last| last[0] >= row[0]) {
            return Err(format!(
                "line {line}: the time {:?} is not after {before:?}: times must increase",
                row[0]
            ));
        }
        rows.push(row);
    }
    if rows.is_empty() { Err("it has no rows: write lines `time,value`".to_owned()) } else { Ok(rows) }
}

/// The line of a record: its position counts the empty lines and comments before it as its own.
fn line(text: &str, position: &csv::Position) -> u64 {
    let start = usize::try_from(position.byte()).unwrap_or(usize::MAX);
    let lines = text.get(start..).unwrap_or_default().lines();
    position.line() + lines.take_while(|line| line.is_empty() || line.starts_with('#')).count() as u64
}

fn row(record: &csv::StringRecord) -> Result<[f64; 2], String> {
    if record.len() != 2 {
        let found = words::count(record.len() as u64, "column");
        return Err(format!("found {found}: two were expected, time and value"));
    }
    let number = |k: usize| match record[k].parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!("found `{}` in place of a finite number", &record[k])),
    };
    Ok([number(0)?, number(1)?])
}

#[cfg(test)]
mod tests;
