//! Evaluates expressions numerically; shares no code with simplification.

use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::symbol::Symbol;
use num_traits::Float;
use rustc_hash::FxHashMap as HashMap;

/// The values of some roots, each symbol having the value that `value` gives it.
pub fn evaluate<F: Float>(graph: &Graph, roots: &[ExprId], value: impl Fn(Symbol) -> F) -> Vec<F> {
    let mut values: HashMap<ExprId, F> = HashMap::default();
    for id in graph.reachable(roots) {
        let result = match graph.node(id) {
            Node::Constant(constant) => F::from(constant.to_f64()).unwrap_or_else(F::nan),
            Node::Symbol(symbol) => value(*symbol),
            Node::Add(a, b) => values[a] + values[b],
            Node::Mul(a, b) => values[a] * values[b],
            Node::Neg(a) => -values[a],
            Node::Recip(a) => values[a].recip(),
            Node::Sqrt(a) => values[a].sqrt(),
            Node::Sin(a) => values[a].sin(),
            Node::Cos(a) => values[a].cos(),
            Node::Tanh(a) => values[a].tanh(),
            Node::Atan2(a, b) => values[a].atan2(values[b]),
        };
        values.insert(id, result);
    }
    roots.iter().map(|root| values[root]).collect()
}

/// A reproducible value between −1 and 1 for each symbol.
#[cfg(test)]
pub fn sample(seed: u64) -> impl Fn(Symbol) -> f64 {
    use std::hash::{DefaultHasher, Hash, Hasher};
    move |symbol| {
        let mut hasher = DefaultHasher::new();
        (seed, symbol).hash(&mut hasher);
        #[expect(clippy::cast_precision_loss, reason = "a random fraction")]
        let fraction = (hasher.finish() >> 11) as f64 / (1u64 << 53) as f64;
        2.0 * fraction - 1.0
    }
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
