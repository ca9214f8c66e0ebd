//! What a module divides by: what cannot be zero, and the list of all else.

use crate::atoms::range_of_call;
use crate::joints::JointLayout;
use crate::module::{Module, PARAMETER_SETUP};
use crate::program::{Node, Program, Source};
use crate::range::Range;
use gyro_model::{Model, Number};

/// A division.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Divisor {
    /// Function that divides.
    pub function: String,
    /// Its line.
    pub line: usize,
    /// Whether the divisor is zero nowhere, at |p| = 1 and with masses and moments that are positive.
    pub is_never_zero: bool,
}

/// All divisions of a module, function by function.
pub fn divisors(model: &Model, module: &Module) -> Vec<Divisor> {
    let parameter_setup: Vec<Range> = module.written.get(PARAMETER_SETUP).map_or_else(Vec::new, |program| {
        let all = ranges(module, program, &|source| given(model, module, source));
        program.results.iter().map(|&id| all[id]).collect()
    });
    let given = |source| match source {
        Source::ParameterSetup(place) => parameter_setup[place],
        source => given(model, module, source),
    };
    let of_function = |(function, program): (&String, &Program)| {
        let ranges = ranges(module, program, &given);
        let nodes = program.nodes.iter().zip(&program.lines);
        let divisor = |(node, &line): (&Node, &usize)| match *node {
            Node::Div(_, by) => {
                Some(Divisor { function: function.clone(), line, is_never_zero: ranges[by].is_nonzero })
            }
            _ => None,
        };
        nodes.filter_map(divisor).collect::<Vec<_>>()
    };
    module.written.iter().flat_map(of_function).collect()
}

/// The range of each node.
fn ranges(module: &Module, program: &Program, given: &dyn Fn(Source) -> Range) -> Vec<Range> {
    let mut ranges: Vec<Range> = Vec::with_capacity(program.nodes.len());
    for node in &program.nodes {
        let at = |id: usize| ranges[id];
        let is_minus = |a: usize, b: usize| program.nodes[a] == Node::Neg(b);
        let range = match *node {
            Node::Constant(place) => {
                let literal = module.constants.values[place].literal;
                Range { low: literal, high: literal, is_nonzero: literal != 0.0 }
            }
            Node::Read(source) => given(source),
            Node::Add(a, b) => at(a).add(at(b)),
            Node::Sub(a, b) => at(a).add(at(b).neg()),
            Node::Mul(a, b) if a == b || program.nodes[a] == program.nodes[b] => at(a).square(),
            Node::Mul(a, b) if is_minus(a, b) || is_minus(b, a) => at(a).square().neg(),
            Node::Mul(a, b) => at(a).mul(at(b)),
            Node::Div(a, b) => at(a).mul(at(b).recip()),
            Node::Neg(a) => at(a).neg(),
            Node::Call(function, operands) => range_of_call(function, operands.map(at)),
            Node::Curve { .. } => Range::ANY,
        };
        ranges.push(range);
    }
    ranges
}

/// What something that is read may be.
fn given(model: &Model, module: &Module, source: Source) -> Range {
    let n = model.coordinate_bodies().len();
    let is_euler = |k: usize| {
        module.joints.iter().flat_map(JointLayout::euler).any(|start| (start..start + 4).contains(&k))
    };
    match source {
        Source::State(k) if k < 7 * n && k % 7 >= 3 => Range::UNIT,
        Source::Joint(k) if is_euler(k) => Range::UNIT,
        Source::Parameter(k) if is_positive(model, k) => Range::POSITIVE,
        _ => Range::ANY,
    }
}

/// Whether a parameter is a mass or a principal moment, which are positive.
fn is_positive(model: &Model, parameter: usize) -> bool {
    let is_it = |number: &Number| matches!(number, Number::Parameter { index, negated: false } if *index == parameter);
    let moving = model.coordinate_bodies();
    moving.iter().any(|&body| {
        let body = &model.bodies[body];
        is_it(&body.mass) || body.inertia[..3].iter().any(is_it)
    })
}
