//! Things that can be wrong with a formula.

use gyro_verifier::field::Constant;
use gyro_verifier::module::Module;
use gyro_verifier::program::{Function, Id, Node, Program, Source};

/// One thing wrong.
#[derive(Clone, Debug)]
pub enum Fault {
    /// A sum becomes a difference or the other way round, a negation is lost.
    Sign(Id),
    /// The operands of a difference or quotient change places.
    SwappedOperands(Id),
    /// A sum, difference or product without one of its operands.
    DroppedOperand(Id),
    /// A product becomes a sum.
    Operation(Id),
    /// The next or the one before is read, of the state, the accelerations, the parameters.
    Index(Id),
    /// The value computed before is taken instead of the second operand.
    Neighbour(Id),
    /// Another function.
    Function(Id),
    /// A constant greater by one part in 10^15.
    LastDigit(usize),
    /// Two results change places.
    SwappedResults(usize),
    /// A result is twice as large: a lost factor.
    LostFactor(usize),
    /// A matrix A is transposed: of the body in this slot.
    TransposedRotation(usize),
    /// The velocities of a body are forgotten: a wrong product rule.
    ForgottenVelocities(usize),
    /// γ for accelerations of p instead of those of π': `½ Φ_p Ġᵀ w'` is forgotten.
    ForgottenTerm,
    /// A place of a pattern is one column further.
    Pattern(usize),
    /// A result is stored one place further.
    Store(usize),
}

/// All faults that a module can have, with the function that has it.
pub fn faults(module: &Module) -> Vec<(String, Fault)> {
    let mut faults = Vec::new();
    for (name, program) in &module.programs {
        let mut add = |fault| faults.push((name.clone(), fault));
        for (id, node) in program.nodes.iter().enumerate() {
            of_node(id, node).into_iter().for_each(&mut add);
        }
        let places =
            program.nodes.iter().filter_map(|n| if let Node::Constant(k) = n { Some(*k) } else { None });
        let mut constants: Vec<usize> = places.collect();
        constants.sort_unstable();
        constants.dedup();
        constants.into_iter().map(Fault::LastDigit).for_each(&mut add);
        (1..program.results.len()).map(Fault::SwappedResults).for_each(&mut add);
        (0..program.results.len()).map(Fault::LostFactor).for_each(&mut add);
        (0..program.places.len()).map(Fault::Store).for_each(&mut add);
        let n = module.programs["applied_force"].results.len() / 6;
        (0..n)
            .flat_map(|slot| [Fault::TransposedRotation(slot), Fault::ForgottenVelocities(slot)])
            .for_each(&mut add);
        if name == "gamma" {
            add(Fault::ForgottenTerm);
        }
        if name == "phi_q" {
            (0..module.phi_q_pattern.len()).map(Fault::Pattern).for_each(&mut add);
        }
    }
    faults
}

fn of_node(id: Id, node: &Node) -> Vec<Fault> {
    match node {
        Node::Add(..) => vec![Fault::Sign(id), Fault::DroppedOperand(id), Fault::Neighbour(id)],
        Node::Sub(..) => {
            vec![Fault::Sign(id), Fault::SwappedOperands(id), Fault::DroppedOperand(id), Fault::Neighbour(id)]
        }
        Node::Mul(..) => vec![Fault::Operation(id), Fault::DroppedOperand(id), Fault::Neighbour(id)],
        Node::Div(..) => vec![Fault::SwappedOperands(id), Fault::DroppedOperand(id)],
        Node::Neg(_) => vec![Fault::Sign(id)],
        Node::Read(_) => vec![Fault::Index(id)],
        Node::Call(function, _) if function.arity() == 2 => vec![Fault::SwappedOperands(id)],
        Node::Call(..) => vec![Fault::Function(id)],
        Node::Curve { .. } => vec![Fault::Index(id)],
        Node::Constant(_) => Vec::new(),
    }
}

/// The module with a fault; `None` where the fault changes nothing that could be noticed.
pub fn apply(module: &Module, function: &str, fault: &Fault) -> Option<Module> {
    let mut mutant = module.clone();
    let n = module.programs["applied_force"].results.len() / 6;
    if let Fault::LastDigit(place) = *fault {
        return with_constant(mutant, function, place);
    }
    if let Fault::Pattern(place) = *fault {
        mutant.phi_q_pattern[place].1 += 1;
        return Some(mutant);
    }
    let program = mutant.programs.get_mut(function)?;
    match *fault {
        Fault::SwappedResults(at) => swap_results(program, at)?,
        Fault::LostFactor(at) => {
            let id = program.results[at];
            program.results[at] = program.push(Node::Add(id, id), 0);
        }
        Fault::TransposedRotation(slot) => {
            let axes = 7 * slot + 4..7 * slot + 7;
            *program = rewritten(program, |p, k| axes.contains(&k).then(|| negated_read(p, k)))?;
        }
        Fault::ForgottenVelocities(slot) => {
            let velocities = 7 * n + 6 * slot..7 * n + 6 * slot + 6;
            *program = rewritten(program, |p, k| velocities.contains(&k).then(|| no_read(p, k)))?;
        }
        Fault::ForgottenTerm => forget_term(program, &module.programs["phi_q"], &module.phi_q_pattern, n),
        Fault::Store(at) => {
            program.places[at] += 1;
            if program.places.get(at + 1) == Some(&program.places[at]) {
                return None;
            }
        }
        _ => change_node(program, fault)?,
    }
    Some(mutant)
}

fn change_node(program: &mut Program, fault: &Fault) -> Option<()> {
    let (Fault::Sign(id)
    | Fault::SwappedOperands(id)
    | Fault::DroppedOperand(id)
    | Fault::Operation(id)
    | Fault::Index(id)
    | Fault::Neighbour(id)
    | Fault::Function(id)) = *fault
    else {
        return None;
    };
    let node = program.nodes[id];
    program.nodes[id] = match (fault, node) {
        (Fault::Sign(_), Node::Add(a, b)) => Node::Sub(a, b),
        (Fault::Sign(_), Node::Sub(a, b)) => Node::Add(a, b),
        (Fault::SwappedOperands(_), Node::Sub(a, b)) => Node::Sub(b, a),
        (Fault::SwappedOperands(_), Node::Div(a, b)) => Node::Div(b, a),
        (Fault::SwappedOperands(_), Node::Call(function, [a, b])) => Node::Call(function, [b, a]),
        (Fault::Operation(_), Node::Mul(a, b)) => Node::Add(a, b),
        (Fault::Index(_), Node::Read(source)) => Node::Read(other(source)?),
        (Fault::Index(_), Node::Curve { table, order, time }) => {
            Node::Curve { table, order: (order + 1) % 3, time }
        }
        (Fault::Neighbour(_), node) => neighbour(node)?,
        (Fault::Function(_), Node::Call(Function::Sin, a)) => Node::Call(Function::Cos, a),
        (Fault::Function(_), Node::Call(_, a)) => Node::Call(Function::Sin, a),
        (Fault::Sign(_), Node::Neg(a))
        | (Fault::DroppedOperand(_), Node::Add(a, _) | Node::Sub(a, _) | Node::Mul(a, _) | Node::Div(a, _)) =>
        {
            // A copy of the operand.
            program.nodes[a]
        }
        _ => return None,
    };
    Some(())
}

fn other(source: Source) -> Option<Source> {
    Some(match source {
        Source::State(k) => Source::State(if k == 0 { 1 } else { k - 1 }),
        Source::Acceleration(0) => return None,
        Source::Acceleration(k) => Source::Acceleration(k - 1),
        Source::Change(0) | Source::Joint(0) => return None,
        Source::Change(row) => Source::Change(row - 1),
        Source::Joint(k) => Source::Joint(k - 1),
        Source::Chart(chart, k) => Source::Chart(chart, (k + 1) % 4),
        Source::Parameter(k) if k > 0 => Source::Parameter(k - 1),
        _ => return None,
    })
}

fn neighbour(node: Node) -> Option<Node> {
    let before = |id: Id| id.checked_sub(1);
    Some(match node {
        Node::Add(a, b) => Node::Add(a, before(b)?),
        Node::Sub(a, b) => Node::Sub(a, before(b)?),
        Node::Mul(a, b) => Node::Mul(a, before(b)?),
        _ => return None,
    })
}

fn swap_results(program: &mut Program, at: usize) -> Option<()> {
    let same = program.nodes[program.results[at]] == program.nodes[program.results[at - 1]];
    program.results.swap(at, at - 1);
    (!same).then_some(())
}

/// Another constant in one function: other functions may share it.
fn with_constant(mut module: Module, function: &str, place: usize) -> Option<Module> {
    let constant = module.constants.values[place].clone();
    let part = gyro_model::parse_decimal("1.000000000000001")?;
    let factor = if constant.literal == 0.0 { part } else { &constant.factor * part };
    module.constants.values.push(Constant { factor, ..constant });
    let changed = Node::Constant(module.constants.values.len() - 1);
    let program = module.programs.get_mut(function)?;
    program.nodes.iter_mut().filter(|node| **node == Node::Constant(place)).for_each(|node| *node = changed);
    Some(module)
}

/// The program with reads of the state replaced; `None` if there is nothing to replace.
fn rewritten(program: &Program, replace: impl Fn(&mut Program, usize) -> Option<Id>) -> Option<Program> {
    let (mut new, mut places, mut changed) =
        (Program { unused: program.unused.clone(), ..Program::default() }, Vec::new(), false);
    for (node, &line) in program.nodes.iter().zip(&program.lines) {
        let replaced = match node {
            Node::Read(Source::State(k)) => replace(&mut new, *k),
            _ => None,
        };
        changed |= replaced.is_some();
        let id = replaced.unwrap_or_else(|| new.push(node.with_operands(|id| places[id]), line));
        places.push(id);
    }
    new.results = program.results.iter().map(|&id| places[id]).collect();
    new.places = program.places.clone();
    changed.then_some(new)
}

fn negated_read(program: &mut Program, k: usize) -> Id {
    let read = program.push(Node::Read(Source::State(k)), 0);
    program.push(Node::Neg(read), 0)
}

fn no_read(program: &mut Program, k: usize) -> Id {
    let read = program.push(Node::Read(Source::State(k)), 0);
    program.push(Node::Sub(read, read), 0)
}

/// `γ = γ_q − ½ Φ_p Ġᵀ w'` and `Ġᵀ w' = −½ (w'·w') p`: subtracts `Σ ¼ (w'·w') Φ_p p`.
fn forget_term(gamma: &mut Program, phi_q: &Program, pattern: &[(usize, usize)], n: usize) {
    let offset = gamma.nodes.len();
    for (node, &line) in phi_q.nodes.iter().zip(&phi_q.lines) {
        gamma.push(node.with_operands(|id| id + offset), line);
    }
    for (&value, &(row, column)) in phi_q.results.iter().zip(pattern) {
        if column % 7 < 3 || row >= gamma.results.len() {
            continue;
        }
        let read = |program: &mut Program, k| program.push(Node::Read(Source::State(k)), 0);
        let e = read(gamma, column);
        let mut term = gamma.push(Node::Mul(value + offset, e), 0);
        let w = [3, 4, 5].map(|k| read(gamma, 7 * n + 6 * (column / 7) + k));
        let squares = w.map(|w| gamma.push(Node::Mul(w, w), 0));
        let square =
            squares.into_iter().reduce(|a, b| gamma.push(Node::Add(a, b), 0)).expect("three squares");
        term = gamma.push(Node::Mul(term, square), 0);
        // A quarter of it: 1 / 4 has no constant of its own, but x / (y / y + y / y)² needs none.
        let one = gamma.push(Node::Div(e, e), 0);
        let two = gamma.push(Node::Add(one, one), 0);
        let four = gamma.push(Node::Mul(two, two), 0);
        term = gamma.push(Node::Div(term, four), 0);
        gamma.results[row] = gamma.push(Node::Sub(gamma.results[row], term), 0);
    }
}
