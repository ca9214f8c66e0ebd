//! A function of a module as a straight-line program.

use std::collections::BTreeSet;

pub use gyro_program::elementary::Function;

/// Place of a value in [`Program::nodes`].
pub type Id = usize;

/// One operation, as often as it is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    /// A literal, by its place among the module's constants.
    Constant(usize),
    /// Something given.
    Read(Source),
    /// Sum.
    Add(Id, Id),
    /// Difference.
    Sub(Id, Id),
    /// Product.
    Mul(Id, Id),
    /// Quotient.
    Div(Id, Id),
    /// Negation.
    Neg(Id),
    /// An elementary function; of one argument both are the same.
    Call(Function, [Id; 2]),
    /// Value (order 0) or a derivative of a table's curve at a time.
    Curve {
        /// Index into the module's tables.
        table: usize,
        /// Which derivative.
        order: usize,
        /// When.
        time: Id,
    },
}

/// What a program reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Source {
    /// t.
    Time,
    /// An element of the state.
    State(usize),
    /// A parameter.
    Parameter(usize),
    /// What `parameter_setup` gives in this place.
    ParameterSetup(usize),
    /// An input.
    Input(usize),
    /// What the function has another one compute first, or is given: an element of `Dynamics::Accelerations`,
    /// `Mechanism::Velocities` or `JointSpace::Rates`.
    Acceleration(usize),
    /// By how much a row is asked to change.
    Change(usize),
    /// An element of the joint state.
    Joint(usize),
    /// Component of a joint's chart.
    Chart(usize, usize),
    /// A number for each body by which a claim makes its Euler parameters longer; no module reads it.
    Factor(usize),
    /// Component of (δr, δπ') of any motion that a claim compares with; no module reads it.
    Motion(usize),
    /// An element of a joint state that is not a state of the mechanism, but what a buffer holds before; no module
    /// reads it.
    Before(usize),
}

/// A straight-line program.
#[derive(Clone, Debug, Default)]
pub struct Program {
    /// Operands come before their users.
    pub nodes: Vec<Node>,
    /// Line of each node in the module's text.
    pub lines: Vec<usize>,
    /// What the function gives, in order.
    pub results: Vec<Id>,
    /// For functions that overwrite part of the state: where each result is stored.
    pub places: Vec<usize>,
    /// Names that nothing refers to, with their lines.
    pub unused: Vec<(String, usize)>,
    /// First and last line of each loop.
    pub loops: Vec<(usize, usize)>,
}

impl Node {
    /// What the node is computed from.
    pub fn operands(&self) -> impl Iterator<Item = Id> {
        let (first, second) = match *self {
            Self::Constant(_) | Self::Read(_) => (None, None),
            Self::Neg(a) | Self::Curve { time: a, .. } => (Some(a), None),
            Self::Call(function, [a, b]) => (Some(a), (function.arity() == 2).then_some(b)),
            Self::Add(a, b) | Self::Sub(a, b) | Self::Mul(a, b) | Self::Div(a, b) => (Some(a), Some(b)),
        };
        first.into_iter().chain(second)
    }

    /// The same operation on other operands.
    #[must_use]
    pub fn with_operands(self, other: impl Fn(Id) -> Id) -> Self {
        match self {
            Self::Constant(_) | Self::Read(_) => self,
            Self::Add(a, b) => Self::Add(other(a), other(b)),
            Self::Sub(a, b) => Self::Sub(other(a), other(b)),
            Self::Mul(a, b) => Self::Mul(other(a), other(b)),
            Self::Div(a, b) => Self::Div(other(a), other(b)),
            Self::Neg(a) => Self::Neg(other(a)),
            Self::Call(function, operands) => Self::Call(function, operands.map(other)),
            Self::Curve { table, order, time } => Self::Curve { table, order, time: other(time) },
        }
    }
}

impl Program {
    /// Loops with operations; others only store results, or their negatives.
    pub fn loops_that_compute(&self) -> usize {
        let is_operation = |node: &Node| !matches!(node, Node::Constant(_) | Node::Read(_) | Node::Neg(_));
        let operations = self.nodes.iter().zip(&self.lines).filter(|(node, _)| is_operation(node));
        let lines: BTreeSet<usize> = operations.map(|(_, &line)| line).collect();
        self.loops.iter().filter(|&&(from, to)| lines.range(from..=to).next().is_some()).count()
    }

    /// Adds a node.
    pub fn push(&mut self, node: Node, line: usize) -> Id {
        self.nodes.push(node);
        self.lines.push(line);
        self.nodes.len() - 1
    }

    /// Gives constants, known by their occurrences in the text until then, the places of what these stand for.
    pub fn name_constants(&mut self, places: &[usize]) {
        for node in &mut self.nodes {
            if let Node::Constant(place) = node {
                *place = places[*place];
            }
        }
    }

    /// The program with another one before it, in place of what it reads of that one's results.
    #[must_use]
    pub fn after(&self, parameter_setup: &Program) -> Self {
        let mut joined = Self { places: self.places.clone(), unused: self.unused.clone(), ..Self::default() };
        let of_parameter_setup = joined.append(parameter_setup, &[]);
        let given: Vec<Id> = parameter_setup.results.iter().map(|&id| of_parameter_setup[id]).collect();
        let own = joined.append(self, &given);
        joined.results = self.results.iter().map(|&id| own[id]).collect();
        joined
    }

    /// Adds the nodes of a program; gives their places here.
    fn append(&mut self, other: &Program, parameter_setup: &[Id]) -> Vec<Id> {
        let mut places: Vec<Id> = Vec::with_capacity(other.nodes.len());
        for (node, &line) in other.nodes.iter().zip(&other.lines) {
            let place = match *node {
                Node::Read(Source::ParameterSetup(k)) => parameter_setup[k],
                node => self.push(node.with_operands(|id| places[id]), line),
            };
            places.push(place);
        }
        places
    }
}

/// Operations of a program: a negation is free.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Sums and differences.
    pub additions: usize,
    /// Products.
    pub multiplications: usize,
    /// Quotients.
    pub divisions: usize,
    /// Calls of elementary functions.
    pub functions: usize,
}

impl Operations {
    /// Counts them as they are written.
    pub fn of(program: &Program) -> Self {
        let mut operations = Self::default();
        for node in &program.nodes {
            match *node {
                Node::Add(..) | Node::Sub(..) => operations.additions += 1,
                Node::Mul(..) => operations.multiplications += 1,
                Node::Div(..) => operations.divisions += 1,
                Node::Call(..) => operations.functions += 1,
                // Those of the time are there before all else.
                Node::Curve { time, .. } if program.nodes[time] != Node::Read(Source::Time) => {
                    operations.functions += 1;
                }
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
