//! The statements of a kernel in C.

use crate::expressions::Line;
use crate::names::Names;
use gyro_codegen::tape::{Array, At, Direction, Loop, Place, Run, Shape, arranged};
use gyro_codegen::{Argument, ScheduledKernel, Store, Stored, Variable, tape};
use gyro_program::{Outcome, Signature};
use std::collections::{BTreeMap, BTreeSet};

/// Writes statements.
pub(crate) struct Writer<'a> {
    names: &'a Names<'a>,
    /// The array of what is given beside the state.
    given: &'a str,
    pub(crate) lines: Vec<String>,
    indent: usize,
}

/// The widest line.
const WIDTH: usize = 110;

impl<'a> Writer<'a> {
    pub(crate) fn new(names: &'a Names<'a>, given: &'a str) -> Self {
        Self { names, given, lines: Vec::new(), indent: 1 }
    }

    /// A line, broken at spaces where it is too long.
    pub(crate) fn line(&mut self, text: &str) {
        let indent = "    ".repeat(self.indent);
        let mut line = indent.clone();
        for (n, word) in text.split(' ').enumerate() {
            if n > 0 && line.len() + 1 + word.len() > WIDTH {
                self.lines.push(std::mem::replace(&mut line, format!("{indent}    ")));
            } else if n > 0 {
                line.push(' ');
            }
            line += word;
        }
        self.lines.push(line);
    }

    /// A number with a name.
    fn named(&mut self, name: &str, value: &str) {
        let real = self.names.own("real");
        self.line(&format!("const {real} {name} = {value};"));
    }

    /// Computes what a kernel computes and stores it.
    pub(crate) fn kernel(&mut self, of: &ScheduledKernel, signature: &Signature, stores: &[Store]) {
        let (tape, names) = (&of.tape, self.names);
        let variables: BTreeSet<Variable> = of.variables().copied().collect();
        self.curves(&variables);
        for &variable in &variables {
            if let Variable::Element(..) | Variable::Chart(_) = variable {
                let element = self.element(variable);
                self.named(&names.variable(variable), &element);
            }
        }
        self.arrays(&tape.arrays);
        let variable = |variable| names.variable(variable);
        let line = Line::new(&tape.outside, 't', names, &variable);
        let mut n_fixed = 0;
        for (number, each) in tape.loops.iter().enumerate() {
            self.temporaries(&line, &each.named);
            for &value in &each.fixed {
                self.named(&format!("fixed{n_fixed}"), &line.value(value));
                n_fixed += 1;
            }
            for &([array, row, column], value) in &each.stores {
                self.line(&format!("kept{array}[{row}][{column}] = {};", line.value(value)));
            }
            self.repeated(number, each);
        }
        self.temporaries(&line, &tape.rest);
        self.results(&line, &tape.results, signature, stores);
    }

    /// Values and derivatives of tables' curves.
    fn curves(&mut self, variables: &BTreeSet<Variable>) {
        let tables = variables.iter().filter_map(|variable| match variable {
            Variable::Curve { table, .. } => Some(*table),
            _ => None,
        });
        for table in tables.collect::<BTreeSet<usize>>() {
            let [real, spline] = ["real", "spline"].map(|name| self.names.own(name));
            let [knots, pieces] = ["knots", "pieces"].map(|name| self.names.own(&format!("{name}_{table}")));
            self.line(&format!("{real} table{table}[3];"));
            let n = format!("(int)(sizeof {pieces} / sizeof *{pieces})");
            self.line(&format!("{spline}({knots}, {pieces}, {n}, t, table{table});"));
        }
    }

    /// Where a variable is read that gets a name.
    fn element(&self, variable: Variable) -> String {
        let array = |argument| match argument {
            Argument::State => "y",
            Argument::Joints => "x",
            Argument::Accelerations | Argument::Rows => self.given,
        };
        match variable {
            Variable::Element(argument, place) => format!("{}[{place}]", array(argument)),
            Variable::Chart(place) => format!("charts[{}][{}]", place / 4, place % 4),
            Variable::Row { array, offset, column } => {
                format!("kept{array}[{}][{column}]", evenly(offset, 1))
            }
            Variable::Strided { argument, first, stride } => {
                format!("{}[{}]", array(argument), evenly(first, stride))
            }
            other => self.names.variable(other),
        }
    }

    /// Those that loops fill.
    fn arrays(&mut self, shapes: &[Shape]) {
        let real = self.names.own("real");
        for (array, Shape { rows, columns }) in shapes.iter().enumerate() {
            if *columns > 0 {
                self.line(&format!("{real} kept{array}[{}][{columns}] = {{{{0}}}};", rows.max(&1)));
            }
        }
    }

    fn temporaries(&mut self, line: &Line<'_>, places: &[Place]) {
        for &place in places {
            let (name, value) = line.temporary(place);
            self.named(name, &value);
        }
    }

    fn repeated(&mut self, number: usize, each: &Loop<Variable, f64>) {
        let (count, names) = (each.count, self.names);
        let table = format!("PARTS_{number}");
        let columns = each.table.first().map_or(0, Vec::len);
        if columns > 0 {
            let rows: Vec<String> = each.table.iter().map(|row| row_of(row)).collect();
            let lines = table_of(&format!("{table}[{}][{columns}]", rows.len()), &rows);
            self.lines.extend(lines.iter().map(|line| format!("    {line}")));
        }
        self.line(&match each.direction {
            Direction::Backward => format!("for (int i = {count} - 1; i >= 0; i--) {{"),
            Direction::Forward => format!("for (int i = 0; i < {count}; i++) {{"),
        });
        self.indent += 1;
        let mut locals: BTreeMap<Variable, String> = BTreeMap::new();
        for &variable in each.body.variables().collect::<BTreeSet<_>>() {
            let source = match variable {
                Variable::Factor(column) => names.precision.rounded(format!("{table}[i][{column}]")),
                Variable::Row { .. } | Variable::Strided { .. } | Variable::Kept { .. } => {
                    self.element(variable)
                }
                _ => continue,
            };
            let name = format!("v{}", locals.len());
            self.named(&name, &source);
            locals.insert(variable, name);
        }
        let variable = |variable| locals.get(&variable).cloned().unwrap_or_else(|| names.variable(variable));
        let line = Line::new(&each.body, 'r', names, &variable);
        self.temporaries(&line, &each.body.named);
        for row in &each.rows {
            let at = if let At::Part(offset) = row.at { evenly(offset, 1) } else { "0".to_owned() };
            for (column, &value) in row.values.iter().enumerate() {
                self.line(&format!("kept{}[{at}][{column}] = {};", row.array, line.value(value)));
            }
        }
        self.indent -= 1;
        self.line("}");
    }

    fn results(&mut self, line: &Line<'_>, results: &[Place], signature: &Signature, stores: &[Store]) {
        let value = |store: &Store| match store.value {
            Stored::Result(n) => line.value(results[n]),
            Stored::Element(array, at) => format!("{array}[{at}]"),
        };
        let copied = |store: &Store| match store.value {
            Stored::Result(n) => line.copied(results[n]),
            Stored::Element(array, at) => Some(tape::Copied::of_named(array, at)),
        };
        // What comes in rows, or in two arrays, is not copied in loops.
        let is_plain =
            !matches!(signature.result, Outcome::FillsTwo(_) | Outcome::Vectors | Outcome::Energies);
        let copies = stores.iter().map(|store| (store.place, copied(store).filter(|_| is_plain)));
        let Some(arranged) = arranged(&copies.collect::<Vec<_>>()) else {
            for store in stores {
                let (array, place) = (store.array, store.place);
                let at = match signature.result {
                    Outcome::Vectors => format!("[{}][{}]", place / 4, place % 4),
                    _ => format!("[{place}]"),
                };
                self.line(&format!("{array}{at} = {};", value(store)));
            }
            return;
        };
        let array = stores[0].array;
        for (count, runs) in &arranged.loops {
            self.line(&format!("for (int i = 0; i < {count}; i++) {{"));
            self.indent += 1;
            runs.iter().for_each(|run| self.line(&copy(array, run)));
            self.indent -= 1;
            self.line("}");
        }
        for store in arranged.rest.iter().map(|&n| &stores[n]) {
            self.line(&format!("{array}[{}] = {};", store.place, value(store)));
        }
    }
}

/// A copy in a loop.
fn copy(to: &str, run: &Run) -> String {
    let (place, row) = (evenly(run.place, run.places_apart), evenly(run.row, run.rows_apart));
    let from = match run.from.of {
        Array::Named(array) => format!("{array}[{row}]"),
        Array::Kept { array, column } => format!("kept{array}[{row}][{column}]"),
    };
    let sign = if run.from.is_negative { "-" } else { "" };
    format!("{to}[{place}] = {sign}{from};")
}

/// `i`, `i + 3`, `7 * i`, `7 * i + 3`.
fn evenly(first: usize, apart: usize) -> String {
    let i = if apart == 1 { "i".to_owned() } else { format!("{apart} * i") };
    if first == 0 { i } else { format!("{i} + {first}") }
}

/// A row of a table of constants.
pub(crate) fn row_of(row: &[f64]) -> String {
    let numbers: Vec<String> = row.iter().map(|number| format!("{number:?}")).collect();
    format!("{{{}}}", numbers.join(", "))
}

/// A table of constants by its name and sizes, a row to a line.
pub(crate) fn table_of(declared: &str, rows: &[String]) -> Vec<String> {
    let rows = rows.iter().map(|row| format!("    {row},"));
    [format!("static const double {declared} = {{")]
        .into_iter()
        .chain(rows)
        .chain(["};".to_owned()])
        .collect()
}
