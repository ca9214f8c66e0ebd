//! What the text of a module is like: nothing unused, nothing computed twice, counted as its data sheet says.

use crate::module::{Module, SET_UP};
use crate::program::{Node, Program, Source};
use crate::refusal::Refusal;
use gyro_model::Model;
use std::collections::{HashMap, HashSet};

/// Operations of a program: a negation is free.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Sums and differences.
    pub additions: usize,
    /// Products.
    pub multiplications: usize,
    /// Quotients.
    pub divisions: usize,
    /// Calls of sin, cos, tanh, √, atan2.
    pub functions: usize,
}

impl Operations {
    /// Counts them as they are written.
    pub fn of(program: &Program) -> Self {
        let mut operations = Self::default();
        for node in &program.nodes {
            match node {
                Node::Add(..) | Node::Sub(..) => operations.additions += 1,
                Node::Mul(..) => operations.multiplications += 1,
                Node::Div(..) => operations.divisions += 1,
                Node::Call(..) | Node::Atan2(..) => operations.functions += 1,
                Node::Constant(_) | Node::Read(_) | Node::Neg(_) | Node::Curve { .. } => {}
            }
        }
        operations
    }

    /// All but functions.
    pub fn total(self) -> usize {
        self.additions + self.multiplications + self.divisions
    }
}

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
        problems.extend(misdescribed(name, program, module));
    }
    problems.extend(unread(module));
    problems.extend(sheet_problems(model, module));
    problems
}

/// What is set up and never read.
fn unread(module: &Module) -> Option<Refusal> {
    let set_up = module.written.get(SET_UP)?;
    let nodes = module.written.values().flat_map(|program| &program.nodes);
    let read: HashSet<Node> = nodes.copied().filter(|node| matches!(node, Node::Read(_))).collect();
    let is_unread = |&place: &usize| !read.contains(&Node::Read(Source::SetUp(place)));
    let place = (0..set_up.results.len()).find(is_unread)?;
    let line = set_up.lines[set_up.results[place]];
    Some(Refusal::new(line, format!("`{SET_UP}` computes derived[{place}], which nothing reads")))
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
    Call(crate::program::Function, Signed),
    Atan2(Signed, Signed),
}

/// Lines of operations whose value, up to its sign, an earlier one has, with the earlier one's line.
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
            Node::Call(function, a) => (Made::Call(function, values[a]), false),
            Node::Atan2(a, b) => (Made::Atan2(values[a], values[b]), false),
            leaf => (Made::Leaf(leaf), false),
        };
        let fresh = known.len();
        let &mut (class, first) = known.entry(made).or_insert((fresh, line));
        if class != fresh && !matches!(made, Made::Leaf(_)) {
            repeated.push((line, first));
        }
        values.push((class, negated));
    }
    repeated
}

/// A sum with its terms in order and the first one positive.
fn sum((a, minus_a): Signed, (b, minus_b): Signed) -> (Made, bool) {
    let ((a, minus_a), (b, minus_b)) =
        if a <= b { ((a, minus_a), (b, minus_b)) } else { ((b, minus_b), (a, minus_a)) };
    (Made::Sum(a, b, minus_a != minus_b), minus_a)
}

/// Whether the documentation of a function states its operations.
fn misdescribed(name: &str, program: &Program, module: &Module) -> Option<Refusal> {
    let Operations { additions, multiplications, divisions, functions } = Operations::of(program);
    let total = Operations::of(program).total();
    let calls = if functions > 0 { format!(" and {functions} functions") } else { String::new() };
    let expected =
        format!(": {total} operations ({additions} ±, {multiplications} ×, {divisions} ÷){calls}.");
    let doc = module.docs.get(name).map_or("", String::as_str);
    let line = program.lines.first().copied().unwrap_or(0);
    let is_right = program.results.is_empty() || doc.ends_with(&expected);
    (!is_right).then(|| {
        Refusal::new(line, format!("`{name}` has{}, its documentation says `{}`", &expected[1..], doc.trim()))
    })
}

/// What the data sheet says otherwise than it is.
fn sheet_problems(model: &Model, module: &Module) -> Vec<Refusal> {
    // What goes on from other accelerations in the same way has no row of its own.
    let listed = module.written.iter().filter(|(name, _)| *name != "corrected_derivative");
    let expected = listed.map(|(name, program)| row(model, module, name, program));
    // What gives no numbers is not listed.
    let expected: Vec<String> = expected.filter(|row| !row.ends_with("| 0 of 0 |")).collect();
    let rows: Vec<&String> = module.sheet.iter().filter(|line| line.starts_with('|')).skip(2).collect();
    let mut problems = Vec::new();
    for row in &expected {
        let found = rows.iter().filter(|line| without_words(line) == *row).count();
        if found != 1 {
            problems.push(Refusal::new(1, format!("the data sheet has {found} rows `{row}`")));
        }
    }
    if rows.len() != expected.len() {
        problems.push(Refusal::new(
            1,
            format!("the data sheet has {} functions instead of {}", rows.len(), expected.len()),
        ));
    }
    let non_zeros = non_zeros(model, module);
    if !module.sheet.contains(&non_zeros) {
        problems.push(Refusal::new(1, format!("the data sheet does not say `{non_zeros}`")));
    }
    problems
}

/// `| phi_q | 68 | 137 | 0 | 205 | 0 of 77 |`: a row of the data sheet without what it says in words.
fn row(model: &Model, module: &Module, name: &str, program: &Program) -> String {
    let operations = Operations::of(program);
    let is_zero = |id: usize| match program.nodes[id] {
        Node::Constant(place) => module.constants.values[place].literal == 0.0,
        _ => false,
    };
    let zeros = program.results.iter().filter(|&&id| is_zero(id)).count();
    let (n, work) = (model.coordinate_bodies().len(), usize::from(model.has_work()));
    let n_rates = module.joints.as_ref().map_or(0, |joints| joints.n_rates);
    let (name, results) = match name {
        "newton_step" => (name, 7 * n),
        "solve_velocities" => (name, 6 * n),
        "derivative" => (name, program.results.len() - 6 * n),
        "joint_derivative" => (name, program.results.len() - n_rates),
        // Work goes through.
        "to_maximal" | "to_joints" => (name, program.results.len() - work),
        "chart_vectors" => ("chart vectors", program.results.len()),
        _ => (name, program.results.len()),
    };
    format!(
        "| {name} | {} | {} | {} | {} | {zeros} of {results} |",
        operations.additions,
        operations.multiplications,
        operations.divisions,
        operations.total(),
    )
}

/// Nor what the operations were before the last pass.
fn without_words(line: &str) -> String {
    let mut cells: Vec<&str> = line.trim_end_matches(" |").split(" | ").collect();
    if cells.len() > 2 {
        cells.remove(1);
    }
    cells.truncate(6);
    cells.join(" | ") + " |"
}

fn non_zeros(model: &Model, module: &Module) -> String {
    let (n, rows) = (model.coordinate_bodies().len(), model.rows().len());
    format!(
        "* non-zeros: Φ_q {} of {}, (Φ_r, Φ_π') {} of {}",
        module.phi_q_pattern.len(),
        (rows + n) * 7 * n,
        module.phi_pi_pattern.len(),
        rows * 6 * n
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn repetitions_are_found_in_any_order_and_sign() {
        let mut program = Program::default();
        let read = |program: &mut Program, k| program.push(Node::Read(Source::State(k)), 1);
        let (a, b) = (read(&mut program, 0), read(&mut program, 1));
        program.push(Node::Sub(a, b), 2);
        program.push(Node::Add(a, b), 3);
        program.push(Node::Sub(b, a), 4);
        let minus = program.push(Node::Neg(b), 5);
        program.push(Node::Mul(a, b), 6);
        program.push(Node::Mul(minus, a), 7);
        program.push(Node::Div(a, b), 8);
        program.push(Node::Div(b, a), 9);
        assert_eq!(repetitions(&program), [(4, 2), (7, 6)]);
    }
}
