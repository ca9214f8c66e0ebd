//! What the text of a module is like: nothing unused, nothing computed twice, counted as its data sheet says.

use crate::data_sheet;
use crate::module::{Module, PARAMETER_SETUP};
use crate::program::{Node, Program, Source};
use crate::refusal::Refusal;
use gyro_model::Model;
use std::collections::{HashMap, HashSet};

/// All that is wrong with the structure of a module.
pub fn problems(model: &Model, module: &Module) -> Vec<Refusal> {
    let mut problems = Vec::new();
    for (name, program) in &module.written {
        let unused = program.unused.iter();
        problems.extend(
            unused.map(|(unused, line)| Refusal::new(*line, format!("`{name}`: `{unused}` is not used"))),
        );
        problems.extend(repetitions(program).into_iter().map(|(line, first)| {
            Refusal::new(line, format!("`{name}` computes again what line {first} computes"))
        }));
    }
    problems.extend(unread(module));
    problems.extend(data_sheet::problems(model, module));
    problems
}

/// What is set up and never read.
fn unread(module: &Module) -> Option<Refusal> {
    let parameter_setup = module.written.get(PARAMETER_SETUP)?;
    let nodes = module.written.values().flat_map(|program| &program.nodes);
    let read: HashSet<Node> = nodes.copied().filter(|node| matches!(node, Node::Read(_))).collect();
    let is_unread = |&place: &usize| !read.contains(&Node::Read(Source::ParameterSetup(place)));
    let place = (0..parameter_setup.results.len()).find(is_unread)?;
    let line = parameter_setup.lines[parameter_setup.results[place]];
    Some(Refusal::new(line, format!("`{PARAMETER_SETUP}` computes derived[{place}], which nothing reads")))
}

/// A value up to its sign: which one, and whether it is negated.
type Signed = (usize, bool);

/// What a value is made of, with its sign taken out.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Made {
    Leaf(Node),
    Sum(usize, usize, bool),
    Product(usize, usize),
    Quotient(usize, usize),
    Call(crate::program::Function, [Signed; 2]),
}

/// So many operations for each that a loop may do again: what parts share by chance they compute apart.
const OPERATIONS_A_COPY: usize = 50;

/// Lines of operations whose value, up to its sign, an earlier one has, with the earlier one's line; not the few of
/// loops.
fn repetitions(program: &Program) -> Vec<(usize, usize)> {
    let (mut known, mut repeated) = (HashMap::<Made, (usize, usize)>::new(), Vec::new());
    let mut values: Vec<Signed> = Vec::new();
    for (node, &line) in program.nodes.iter().zip(&program.lines) {
        let (made, negated) = match *node {
            Node::Neg(a) => {
                values.push((values[a].0, !values[a].1));
                continue;
            }
            Node::Add(a, b) => sum(values[a], values[b]),
            Node::Sub(a, b) => sum(values[a], (values[b].0, !values[b].1)),
            Node::Mul(a, b) => {
                let ((a, minus_a), (b, minus_b)) = (values[a], values[b]);
                (Made::Product(a.min(b), a.max(b)), minus_a != minus_b)
            }
            Node::Div(a, b) => (Made::Quotient(values[a].0, values[b].0), values[a].1 != values[b].1),
            Node::Call(function, operands) => (Made::Call(function, operands.map(|a| values[a])), false),
            leaf => (Made::Leaf(leaf), false),
        };
        let fresh = known.len();
        let &mut (class, first) = known.entry(made).or_insert((fresh, line));
        if class != fresh && !matches!(made, Made::Leaf(_)) {
            repeated.push((line, first));
        }
        values.push((class, negated));
    }
    let in_loop = |line: usize| program.loops.iter().any(|&(from, to)| (from..=to).contains(&line));
    let of_loops = |&&(line, first): &&(usize, usize)| in_loop(line) || in_loop(first);
    let n_operations = program.nodes.iter().filter(|node| node.operands().next().is_some()).count();
    if OPERATIONS_A_COPY * repeated.iter().filter(of_loops).count() <= n_operations {
        repeated.retain(|pair| !of_loops(&pair));
    }
    repeated
}

/// A sum with its terms in order and the first one positive.
fn sum((a, minus_a): Signed, (b, minus_b): Signed) -> (Made, bool) {
    let ((a, minus_a), (b, minus_b)) =
        if a <= b { ((a, minus_a), (b, minus_b)) } else { ((b, minus_b), (a, minus_a)) };
    (Made::Sum(a, b, minus_a != minus_b), minus_a)
}

#[cfg(test)]
mod tests;
