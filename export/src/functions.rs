//! Functions of a mechanism as C: their heads and documentation as the table of all functions has them, their
//! statements as their kernels say.

use crate::kernels::Writer;
use crate::names::Names;
use gyro_codegen::{Origin, Scheduled, ScheduledKernel};
use gyro_program::{Given, Group, Kernel, Outcome, Signature, Space};
use std::iter;

/// A function in C.
#[derive(Debug)]
pub(crate) struct Function {
    /// What it does.
    pub(crate) doc: String,
    /// Its head, without what ends it.
    pub(crate) head: String,
    /// Its statements, a line each.
    pub(crate) body: Vec<String>,
    pub(crate) name: String,
    /// What it takes beside the mechanism.
    pub(crate) arguments: Vec<Argument>,
}

/// An argument of a function: an array, or a number if it has no size.
#[derive(Debug)]
pub(crate) struct Argument {
    pub(crate) name: &'static str,
    pub(crate) size: Option<usize>,
    pub(crate) is_written: bool,
    /// Whether it is an array of rows of four.
    has_rows: bool,
}

/// All functions.
pub(crate) fn functions(scheduled: &Scheduled, names: &Names<'_>) -> Vec<Function> {
    let of_kernel = |kernel| Some(function(scheduled, names, kernel, *scheduled.origins.get(&kernel)?));
    let of_group = |&group: &Group| {
        let first = match (group, &scheduled.joint) {
            (Group::Mechanism, _) => Some(start(names, "start", "", &scheduled.start)),
            (Group::Joint, Some(joint)) => {
                Some(start(names, "joint_start", " in joint coordinates", &joint.start))
            }
            _ => None,
        };
        first.into_iter().chain(Kernel::of(group).filter_map(of_kernel))
    };
    scheduled.groups.iter().flat_map(of_group).collect()
}

/// A function that writes constants.
fn start(names: &Names<'_>, name: &str, which: &str, numbers: &[f64]) -> Function {
    let mut writer = Writer::new(names, "");
    for (n, number) in numbers.iter().enumerate() {
        // A zero has no sign.
        writer.line(&format!("out[{n}] = {};", names.precision.constant(number + 0.0)));
    }
    let doc = format!("Writes the assembled start{which}.");
    finished(names, name.to_owned(), doc, vec![Argument::written("out", numbers.len())], writer.lines)
}

fn function(scheduled: &Scheduled, names: &Names<'_>, kernel: Kernel, origin: Origin) -> Function {
    let signature = kernel.signature();
    let does = signature.does(|first| names.own(first.function()));
    let mut writer = Writer::new(names, signature.given.array().unwrap_or(""));
    let doc = match origin {
        Origin::Kernel => {
            called_first(scheduled, names, kernel, &mut writer);
            let nothing = ScheduledKernel::default();
            let of = scheduled.kernels.get(&kernel).unwrap_or(&nothing);
            writer.kernel(of, signature, &scheduled.stores(kernel));
            format!("{does}: {}.", of.operations)
        }
        Origin::Idle => format!("{does}: there are none."),
        Origin::Other(other) => {
            of_other(scheduled, names, signature, other.signature(), &mut writer);
            format!("{does}.")
        }
    };
    let is_on_charts = signature.given == Given::Charts;
    let name = format!("{}{}", kernel.function(), if is_on_charts { "_on" } else { "" });
    finished(names, name, doc, arguments(scheduled, signature), writer.lines)
}

/// The function whose results a kernel takes, or hands on.
fn called_first(scheduled: &Scheduled, names: &Names<'_>, kernel: Kernel, writer: &mut Writer<'_>) {
    let Some((buffer, first)) = scheduled.called_first(kernel) else { return };
    let n = first.signature().n_results(&scheduled.counts).unwrap_or(0);
    filled_by(names, buffer, n, first.signature(), writer);
}

/// An array, and what fills it.
fn filled_by(names: &Names<'_>, array: &str, n: usize, by: &Signature, writer: &mut Writer<'_>) {
    let (state, _) = by.state.argument().expect("it is a function of a state");
    // C has no arrays without elements.
    writer.line(&format!("{} {array}[{}] = {{0}};", names.own("real"), n.max(1)));
    writer.line(&format!("{}(m, t, {state}, {array});", names.own(by.name)));
}

/// The first results of another function.
fn of_other(
    scheduled: &Scheduled,
    names: &Names<'_>,
    own: &Signature,
    other: &Signature,
    writer: &mut Writer<'_>,
) {
    let (out, _) = own.written()[0];
    let [n, n_solved] = [own, other].map(|of| of.n_results(&scheduled.counts).unwrap_or(0));
    if n == n_solved {
        let (state, _) = own.state.argument().expect("it is a function of a state");
        return writer.line(&format!("{}(m, t, {state}, {out});", names.own(other.name)));
    }
    filled_by(names, "solved", n_solved, other, writer);
    writer.line(&format!("for (int i = 0; i < {n}; i++) {out}[i] = solved[i];"));
}

/// What a function takes beside the mechanism.
fn arguments(scheduled: &Scheduled, signature: &Signature) -> Vec<Argument> {
    let array = |(name, space): (&'static str, Space), is_written| Argument {
        is_written,
        ..Argument::written(name, space.len(&scheduled.counts))
    };
    let has_time = !matches!(signature.result, Outcome::Vectors | Outcome::Derived);
    let time = has_time.then_some(Argument { name: "t", size: None, is_written: false, has_rows: false });
    let n_vectors = scheduled.n_results(Kernel::ChartVectors);
    let vectors = |name| Argument { has_rows: true, ..Argument::written(name, n_vectors) };
    let charts = Argument { is_written: false, ..vectors("charts") };
    let state = signature.state.argument().filter(|_| signature.result != Outcome::Overwrites);
    let told = match signature.given {
        Given::Told(name, space) => Some((name, space)),
        _ => None,
    };
    let returned = match signature.result {
        Outcome::Energies => Some(Argument::written("out", 2)),
        Outcome::Vectors => Some(vectors("out")),
        Outcome::Derived => Some(Argument::written("out", scheduled.n_results(signature.kernel))),
        _ => None,
    };
    let charts = (signature.given == Given::Charts).then_some(charts);
    let read = state.into_iter().chain(told).map(|of| array(of, false));
    let written = signature.written().into_iter().map(|of| array(of, true));
    time.into_iter().chain(charts).chain(read).chain(written).chain(returned).collect()
}

/// A function by its name and documentation, arguments and statements.
fn finished(
    names: &Names<'_>,
    name: String,
    doc: String,
    arguments: Vec<Argument>,
    lines: Vec<String>,
) -> Function {
    let of_mechanism = format!("const {} *m", names.prefix);
    let parameters = arguments.iter().map(|argument| argument.declared(&names.own("real")));
    let parameters: Vec<String> = iter::once(of_mechanism).chain(parameters).collect();
    let all = iter::once("m").chain(arguments.iter().map(|argument| argument.name));
    let unused = all.filter(|name| !lines.iter().any(|line| mentions(line, name)));
    let mut body: Vec<String> = unused.map(|name| format!("    (void){name};")).collect();
    body.extend(lines);
    let head = format!("void {}({})", names.own(&name), parameters.join(", "));
    Function { doc, head, body, name, arguments }
}

/// Whether a line has a name as a word.
fn mentions(line: &str, name: &str) -> bool {
    line.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).any(|word| word == name)
}

impl Argument {
    fn written(name: &'static str, size: usize) -> Self {
        Self { name, size: Some(size), is_written: true, has_rows: false }
    }

    fn declared(&self, real: &str) -> String {
        let name = self.name;
        // What points at rows of constants cannot be passed rows of variables before C23.
        let constant = if self.is_written || self.has_rows { "" } else { "const " };
        match self.size {
            None => format!("{real} {name}"),
            Some(0) => format!("{constant}{real} *{name}"),
            Some(size) if self.has_rows => format!("{constant}{real} {name}[{}][4]", size / 4),
            Some(size) => format!("{constant}{real} {name}[{size}]"),
        }
    }
}
