//! What a module divides by: what cannot be zero, and the list of all else.

use crate::joints::JointLayout;
use crate::module::{Module, PARAMETER_SETUP};
use crate::program::{Function, Node, Program, Source};
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

/// What a value may be.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Range {
    low: f64,
    high: f64,
    is_nonzero: bool,
}

impl Range {
    const ANY: Self = Self { low: f64::NEG_INFINITY, high: f64::INFINITY, is_nonzero: false };
    const UNIT: Self = Self { low: -1.0, high: 1.0, is_nonzero: false };
    const POSITIVE: Self = Self { low: 0.0, high: f64::INFINITY, is_nonzero: true };

    /// Bounds that arithmetic gave; infinity less infinity may be anything.
    fn new(low: f64, high: f64, is_nonzero: bool) -> Self {
        let low = if low.is_nan() { f64::NEG_INFINITY } else { low };
        let high = if high.is_nan() { f64::INFINITY } else { high };
        // Bounds were rounded: what they keep from zero by less is not kept from it.
        let is_away = |bound: f64| bound > MARGIN;
        Self { low, high, is_nonzero: is_nonzero || is_away(low) || is_away(-high) }
    }

    fn add(self, other: Self) -> Self {
        let one_sided = |a: Self, b: Self| (a.low >= 0.0 && b.low >= 0.0) || (a.high <= 0.0 && b.high <= 0.0);
        let is_nonzero = one_sided(self, other) && (self.is_nonzero || other.is_nonzero);
        Self::new(self.low + other.low, self.high + other.high, is_nonzero)
    }

    fn neg(self) -> Self {
        Self { low: -self.high, high: -self.low, ..self }
    }

    fn mul(self, other: Self) -> Self {
        // Zero times infinity is zero here: bounds are not reached.
        let product = |a: f64, b: f64| if a == 0.0 || b == 0.0 { 0.0 } else { a * b };
        let products = [self.low, self.high].map(|a| [other.low, other.high].map(|b| product(a, b)));
        let all = products.into_iter().flatten();
        let (low, high) = (all.clone().fold(f64::INFINITY, f64::min), all.fold(f64::NEG_INFINITY, f64::max));
        Self { low, high, is_nonzero: self.is_nonzero && other.is_nonzero }
    }

    fn square(self) -> Self {
        let square = self.mul(self);
        let low = if self.low <= 0.0 && self.high >= 0.0 { 0.0 } else { square.low.max(0.0) };
        Self { low, ..square }
    }

    fn recip(self) -> Self {
        match self.is_nonzero {
            true if self.low >= 0.0 => Self { low: 1.0 / self.high, high: 1.0 / self.low, is_nonzero: true },
            true if self.high <= 0.0 => self.neg().recip().neg(),
            is_nonzero => Self { is_nonzero, ..Self::ANY },
        }
    }
}

/// More than the roundings of a bound.
const MARGIN: f64 = 1e-12;

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
            Node::Call(Function::Sin | Function::Cos | Function::Tanh, _) => Range::UNIT,
            Node::Call(Function::Sqrt, a) => Range {
                low: at(a).low.max(0.0).sqrt(),
                high: at(a).high.max(0.0).sqrt(),
                is_nonzero: at(a).is_nonzero,
            },
            Node::Atan2(..) | Node::Curve { .. } => Range::ANY,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_keep_from_zero_what_cannot_be_zero() {
        let two = Range { low: 2.0, high: 2.0, is_nonzero: true };
        assert!(Range::UNIT.square().add(two).is_nonzero);
        assert!(!Range::UNIT.add(two.neg()).add(Range::UNIT).is_nonzero, "from −4 to 0");
        assert!(Range::UNIT.add(two).is_nonzero, "from 1 to 3");
        assert!(!Range::ANY.square().is_nonzero && Range::ANY.square().low == 0.0);
        assert!(Range::POSITIVE.add(Range::ANY.square()).is_nonzero);
        assert!(!Range::POSITIVE.add(Range::ANY.square().neg()).is_nonzero);
        assert!(Range::POSITIVE.mul(two.neg()).is_nonzero && Range::POSITIVE.mul(two.neg()).high <= 0.0);
        assert_eq!(two.recip(), Range { low: 0.5, high: 0.5, is_nonzero: true });
        assert!(Range::POSITIVE.recip().low >= 0.0 && !Range::ANY.recip().is_nonzero);
    }
}
