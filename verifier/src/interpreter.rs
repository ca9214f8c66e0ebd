//! Runs a program over any field.

use crate::atoms::Atoms;
use crate::field::Field;
use crate::module::Module;
use crate::point::Point;
use crate::program::{Id, Node, Program, Source};
use gyro_model::Spline;

/// What a program reads, besides a point.
#[derive(Clone, Debug)]
pub struct Given<'a, F: Field> {
    /// Time, state, parameters, inputs.
    pub point: &'a Point<F>,
    /// What [`Source::Acceleration`] is.
    pub accelerations: &'a [F],
    /// For each joint with a chart the vector that stands for it: of a chart that is chosen a unit vector.
    pub charts: &'a [[F; 4]],
    /// By how much the rows are asked to change.
    pub changes: &'a [F],
    /// Joint state.
    pub joints: &'a [F],
}

/// Something divided by zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DivisionByZero {
    /// Line of the module's text.
    pub line: usize,
}

/// The constants of a module as numbers.
pub fn constants<F: Field>(context: F::Context, module: &Module) -> Vec<F> {
    module.constants.values.iter().map(|constant| F::constant(context, constant)).collect()
}

/// The results of a program of a module, whose constants are given as numbers.
///
/// # Errors
/// Where a divisor is zero.
pub fn run<F: Field>(
    module: &Module,
    program: &Program,
    constants: &[F],
    atoms: &dyn Atoms<F>,
    given: &Given<F>,
) -> Result<Vec<F>, DivisionByZero> {
    let values = values(module, program, constants, atoms, given)?;
    Ok(program.results.iter().map(|&id| values[id].clone()).collect())
}

/// The values of all nodes of a program.
///
/// # Errors
/// Where a divisor is zero.
pub fn values<F: Field>(
    module: &Module,
    program: &Program,
    constants: &[F],
    atoms: &dyn Atoms<F>,
    given: &Given<F>,
) -> Result<Vec<F>, DivisionByZero> {
    let read = |source: Source| read(source, given);
    let environment = Environment { constants, tables: &module.tables, atoms, read: &read };
    let mut values: Vec<F> = Vec::with_capacity(program.nodes.len());
    for (node, &line) in program.nodes.iter().zip(&program.lines) {
        let value = value(node, &|id| &values[id], &environment).ok_or(DivisionByZero { line })?;
        values.push(value);
    }
    Ok(values)
}

/// What nodes refer to.
pub(crate) struct Environment<'a, F: Field> {
    /// The constants as numbers.
    pub constants: &'a [F],
    /// The tables of prescribed motions.
    pub tables: &'a [Spline],
    /// The functions that are not rational.
    pub atoms: &'a dyn Atoms<F>,
    /// What is given.
    pub read: &'a dyn Fn(Source) -> F,
}

/// The value of a node from those of its operands; `None` by zero.
pub(crate) fn value<'v, F: Field + 'v>(
    node: &Node,
    operand: &dyn Fn(Id) -> &'v F,
    environment: &Environment<F>,
) -> Option<F> {
    let atoms = environment.atoms;
    Some(match *node {
        Node::Constant(place) => environment.constants[place].clone(),
        Node::Read(source) => (environment.read)(source),
        Node::Add(a, b) => operand(a).add(operand(b)),
        Node::Sub(a, b) => operand(a).sub(operand(b)),
        Node::Mul(a, b) => operand(a).mul(operand(b)),
        Node::Div(a, b) => operand(a).div(operand(b))?,
        Node::Neg(a) => operand(a).neg(),
        Node::Call(function, operands) => atoms.call(function, operands.map(operand)),
        Node::Curve { table, order, time } => {
            atoms.spline(&environment.tables[table], operand(time))[order].clone()
        }
    })
}

fn read<F: Field>(source: Source, given: &Given<F>) -> F {
    let point = given.point;
    match source {
        Source::Time => point.t.clone(),
        Source::State(k) => point.state[k].clone(),
        Source::Parameter(k) => point.parameters[k].clone(),
        Source::Input(k) => point.inputs[k].clone(),
        Source::Acceleration(k) => given.accelerations[k].clone(),
        Source::Chart(chart, k) => given.charts[chart][k].clone(),
        Source::Change(k) => given.changes[k].clone(),
        Source::Joint(k) => given.joints[k].clone(),
        Source::ParameterSetup(_) => unreachable!("`parameter_setup` is part of what reads it"),
        Source::Factor(_) | Source::Motion(_) | Source::Before(_) => {
            unreachable!("no module reads what claims vary")
        }
    }
}
