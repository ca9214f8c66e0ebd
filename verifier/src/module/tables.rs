//! Tables of prescribed motions and of curves: the constants at the head of a module.

use crate::refusal::Refusal;
use gyro_model::{Model, Motion, Spline};
use std::slice::from_ref;

/// The tables of a module in their order, and its text without their numbers. Each must be a table of the model, number
/// for number.
///
/// A table can have a hundred thousand rows, which as tokens would take most of the time of a proof. So the arrays
/// `KNOTS_0`, `PIECES_0` and so on are read, and emptied, before the text is parsed. Only numbers, commas, brackets and
/// blanks are taken out, and lines stay where they are; an array that is written otherwise is not emptied, and
/// [`matching`](super::matching) expects empty ones.
pub fn read(model: &Model, text: &str) -> Result<(Vec<Spline>, String), Refusal> {
    let (arrays, emptied) = arrays(text)?;
    let pairs = arrays.chunks(2).enumerate().map(|(k, pair)| match pair {
        [knots, pieces] if knots.is_called("KNOTS", k) && pieces.is_called("PIECES", k) => {
            let same = |table: &&Spline| {
                table.knots.iter().map(from_ref).eq(&knots.rows)
                    && table.pieces.iter().map(<[f64; 4]>::as_slice).eq(&pieces.rows)
            };
            let found = of_model(model).into_iter().find(same).cloned();
            found.ok_or_else(|| knots.refusal("is no table of the model"))
        }
        _ => Err(pair[0].refusal("is out of place")),
    });
    Ok((pairs.collect::<Result<_, _>>()?, emptied))
}

/// All tables of curves that equations call, and those that motions follow.
pub fn of_model(model: &Model) -> Vec<&Spline> {
    let mut tables: Vec<&Spline> = of_curves(model).collect();
    model.drivers.iter().for_each(|driver| collect(&driver.motion, &mut tables));
    for motion in model.bodies.iter().filter_map(|body| body.motion.as_ref()) {
        motion.translation.iter().for_each(|m| collect(m, &mut tables));
        motion.rotations.iter().for_each(|(_, angle)| collect(angle, &mut tables));
    }
    tables
}

/// Whether a table is one of a curve that equations call.
pub fn is_of_curve(model: &Model, table: &Spline) -> bool {
    of_curves(model).any(|curve| (&curve.knots, &curve.pieces) == (&table.knots, &table.pieces))
}

fn of_curves(model: &Model) -> impl Iterator<Item = &Spline> {
    model.curves_of_equations().into_iter().map(|curve| &model.curves[curve].spline)
}

fn collect<'m>(motion: &'m Motion, tables: &mut Vec<&'m Spline>) {
    match motion {
        Motion::Polynomial(_)
        | Motion::Sinusoid { .. }
        | Motion::Lines(_)
        | Motion::Formula(_)
        | Motion::Input(_) => {}
        Motion::Sum(parts) | Motion::Product(parts) => parts.iter().for_each(|part| collect(part, tables)),
        Motion::Table(table) => tables.push(table),
    }
}

/// A constant array of numbers, or of arrays of numbers.
#[derive(Debug, PartialEq)]
struct Array<'t> {
    name: &'t str,
    line: usize,
    /// Its elements; a number is a row of its own.
    rows: Vec<Vec<f64>>,
}

impl Array<'_> {
    fn is_called(&self, what: &str, k: usize) -> bool {
        self.name == format!("{what}_{k}")
    }

    fn refusal(&self, words: &str) -> Refusal {
        Refusal::new(self.line, format!("`{}` {words}", self.name))
    }
}

/// The arrays whose constants begin a line, and the text with nothing but ends of lines in them.
fn arrays(text: &str) -> Result<(Vec<Array<'_>>, String), Refusal> {
    let (mut arrays, mut emptied, mut rest, mut line) = (Vec::new(), String::new(), text, 1);
    while !rest.is_empty() {
        let (this, _) = rest.split_at(rest.find('\n').map_or(rest.len(), |end| end + 1));
        let Some((name, start)) = array_at(this) else {
            emptied += this;
            (rest, line) = (&rest[this.len()..], line + 1);
            continue;
        };
        emptied += &rest[..start];
        let mut numbers = Numbers { rest: &rest[start..], line };
        let rows = numbers.list(&mut |numbers| {
            if numbers.takes('[') { numbers.list(&mut Numbers::number) } else { Ok(vec![numbers.number()?]) }
        })?;
        arrays.push(Array { name, line, rows });
        emptied.extend((line..numbers.line).map(|_| '\n'));
        emptied.push(']');
        (rest, line) = (numbers.rest, numbers.line);
    }
    Ok((arrays, emptied))
}

/// The name of the constant array that a line begins with, and where its elements start.
fn array_at(line: &str) -> Option<(&str, usize)> {
    let (name, rest) = line.strip_prefix("const ")?.split_once(": ")?;
    let is_of_table = name.starts_with("KNOTS_") || name.starts_with("PIECES_");
    let start = line.len() - rest.len() + rest.find("= [")? + "= [".len();
    is_of_table.then_some((name, start))
}

/// What is left of a list of numbers.
struct Numbers<'t> {
    rest: &'t str,
    line: usize,
}

impl Numbers<'_> {
    /// Whether a character comes next, after blanks; it is passed over.
    fn takes(&mut self, wanted: char) -> bool {
        let trimmed = self.rest.trim_start_matches([' ', '\n']);
        let blanks = &self.rest[..self.rest.len() - trimmed.len()];
        self.line += blanks.bytes().filter(|&byte| byte == b'\n').count();
        self.rest = trimmed.strip_prefix(wanted).unwrap_or(trimmed);
        self.rest.len() < trimmed.len()
    }

    /// Elements with commas between them, up to the bracket that closes them.
    fn list<T>(
        &mut self,
        element: &mut impl FnMut(&mut Self) -> Result<T, Refusal>,
    ) -> Result<Vec<T>, Refusal> {
        let mut elements = Vec::new();
        while !self.takes(']') {
            elements.push(element(self)?);
            if !self.takes(',') && !self.rest.starts_with(']') {
                return Err(Refusal::new(self.line, "expected `,` or `]`"));
            }
        }
        Ok(elements)
    }

    /// A decimal with its sign.
    fn number(&mut self) -> Result<f64, Refusal> {
        self.takes('\n');
        let end = self.rest.find([' ', '\n', ',', ']']).unwrap_or(self.rest.len());
        let (text, rest) = self.rest.split_at(end);
        let is_decimal = text.contains(['.', 'e'])
            && text.bytes().all(|byte| byte.is_ascii_digit() || b"-.e".contains(&byte));
        let value = text.parse::<f64>().ok().filter(|value| is_decimal && value.is_finite());
        self.rest = rest;
        value.ok_or_else(|| Refusal::new(self.line, "expected a decimal"))
    }
}

#[cfg(test)]
mod tests;
