//! Evaluates expressions numerically; shares no code with simplification.

use crate::expr::by_expr::ByExpr;
use crate::expr::calls;
use crate::expr::domains::{Domains, between};
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::symbol::Symbol;
use num_traits::Float;

/// What computes the values of some roots, again and again.
#[derive(Debug)]
pub struct Program<'g> {
    /// Operands before their users, with the places of the operands.
    steps: Vec<(&'g Node, [usize; 2])>,
    /// Constants as they are rounded, one for each step.
    constants: Vec<f64>,
    roots: Vec<usize>,
    domains: &'g Domains,
}

impl<'g> Program<'g> {
    pub fn of(graph: &'g Graph, roots: &[ExprId]) -> Self {
        let mut places: ByExpr<usize> = ByExpr::default();
        let (mut steps, mut constants) = (Vec::new(), Vec::new());
        for id in graph.reachable(roots) {
            let node = graph.node(id);
            let mut operands = node.operands().map(|operand| places[operand]);
            let first = operands.next().unwrap_or(0);
            steps.push((node, [first, operands.next().unwrap_or(0)]));
            constants.push(if let Node::Constant(constant) = node { constant.to_f64() } else { 0.0 });
            places.insert(id, steps.len() - 1);
        }
        let roots = roots.iter().map(|root| places[*root]).collect();
        Self { steps, constants, roots, domains: &graph.domains }
    }

    /// The values of the roots, each symbol having the value that `value` gives it.
    pub fn run<F: Float>(&self, value: impl Fn(Symbol) -> F) -> Vec<F> {
        let mut values: Vec<F> = Vec::with_capacity(self.steps.len());
        for ((node, [a, b]), constant) in self.steps.iter().zip(&self.constants) {
            let operand = |place: &usize| values[*place];
            let result = match node {
                Node::Constant(_) => F::from(*constant).unwrap_or_else(F::nan),
                Node::Symbol(symbol) => value(*symbol),
                Node::Add(..) => operand(a) + operand(b),
                Node::Mul(..) => operand(a) * operand(b),
                Node::Neg(_) => -operand(a),
                Node::Recip(_) => operand(a).recip(),
                Node::Call(function, _) => calls::value(self.domains, *function, [operand(a), operand(b)]),
            };
            values.push(result);
        }
        self.roots.iter().map(|&root| values[root]).collect()
    }
}

/// The values of some roots, each symbol having the value that `value` gives it.
pub fn evaluate<F: Float>(graph: &Graph, roots: &[ExprId], value: impl Fn(Symbol) -> F) -> Vec<F> {
    Program::of(graph, roots).run(value)
}

/// A reproducible value between −1 and 1 for each symbol.
pub fn sample(seed: u64) -> impl Fn(Symbol) -> f64 {
    move |symbol| between(seed, symbol)
}

/// A reproducible state with unit Euler parameters and positive parameters.
#[cfg(test)]
pub fn random_state(seed: u64) -> impl Fn(Symbol) -> f64 {
    move |symbol| {
        let value = sample(seed);
        match symbol {
            Symbol::Euler { moving_body, .. } => {
                let p: [f64; 4] = std::array::from_fn(|k| value(Symbol::Euler { moving_body, k }));
                value(symbol) / p.iter().map(|x| x * x).sum::<f64>().sqrt()
            }
            Symbol::Parameter(_) => value(symbol).abs(),
            _ => value(symbol),
        }
    }
}
