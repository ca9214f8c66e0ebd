//! From a set of expressions to a straight-line program: what gets a name, in which order, and what it costs.

use crate::expr::by_expr::ByExpr;
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::symbol::Symbol;
use gyro_program::elementary::Function;
use rustc_hash::FxHashSet as HashSet;
use std::fmt;

/// Arithmetic operations of a program. A negation is free; a product with a reciprocal that nobody else uses is one
/// division.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Operations {
    /// Sums and differences.
    pub additions: usize,
    /// Products.
    pub multiplications: usize,
    /// Quotients.
    pub divisions: usize,
    /// Square roots, sines and the like.
    pub functions: usize,
}

impl Operations {
    /// Counts each shared expression once.
    pub(crate) fn count(graph: &Graph, roots: &[ExprId]) -> Self {
        Self::of(graph, &Uses::count(graph, roots))
    }

    /// The same but for what depends on parameters alone, which is computed once, before all steps.
    pub(crate) fn recurring(graph: &Graph, roots: &[ExprId]) -> Self {
        Self::of(graph, &Uses::beyond(graph, roots, |id| graph.is_settled(id)))
    }

    fn of(graph: &Graph, uses: &Uses) -> Self {
        let mut operations = Self::default();
        for &id in &uses.order {
            match graph.node(id) {
                Node::Constant(_) | Node::Symbol(_) | Node::Neg(_) => {}
                Node::Add(..) => operations.additions += 1,
                Node::Mul(a, b) if uses.quotient(graph, *a, *b).is_some() => {}
                Node::Mul(..) => operations.multiplications += 1,
                Node::Recip(_) => operations.divisions += 1,
                // Tables at the time count as variables, as those of motions do.
                Node::Call(Function::Curve { .. }, [at, _]) if is_time(graph, *at) => {}
                Node::Call(..) => operations.functions += 1,
            }
        }
        operations
    }

    /// + − × ÷, one each; functions apart.
    pub fn total(&self) -> usize {
        self.additions + self.multiplications + self.divisions
    }
}

fn is_time(graph: &Graph, id: ExprId) -> bool {
    *graph.node(id) == Node::Symbol(Symbol::Time)
}

impl fmt::Display for Operations {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { additions, multiplications, divisions, functions } = self;
        write!(f, "{} operations ({additions} ±, {multiplications} ×, {divisions} ÷)", self.total())?;
        if *functions > 0 {
            write!(f, " and {functions} functions")?;
        }
        Ok(())
    }
}

/// Operations on the way to a program, + − × ÷ together. Constants are folded and zeros and ones vanish as expressions
/// are built: no pass comes before that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Passes {
    /// Every expression written out wherever it is used; the largest number if there are more.
    pub written_out: u64,
    /// Equal expressions computed once.
    pub shared: usize,
    /// Products with reciprocals that nobody else uses written as quotients: what is emitted.
    pub emitted: usize,
}

impl Passes {
    pub(crate) fn count(graph: &Graph, roots: &[ExprId]) -> Self {
        let is_operation =
            |id: ExprId| matches!(graph.node(id), Node::Add(..) | Node::Mul(..) | Node::Recip(_));
        let order = graph.reachable(roots);
        let mut sizes: ByExpr<u64> = ByExpr::default();
        for &id in &order {
            let operands = graph.node(id).operands().map(|operand| sizes[operand]);
            sizes.insert(id, operands.fold(u64::from(is_operation(id)), u64::saturating_add));
        }
        Self {
            written_out: roots.iter().fold(0, |sum, root| sizes[*root].saturating_add(sum)),
            shared: order.iter().filter(|&&id| is_operation(id)).count(),
            emitted: Operations::count(graph, roots).total(),
        }
    }
}

/// How often each reachable expression is used.
#[derive(Debug)]
pub struct Uses {
    /// Operands before their users.
    pub order: Vec<ExprId>,
    counts: ByExpr<u32>,
}

impl Uses {
    /// A negation is written where it is used, so its uses are uses of what it negates.
    pub fn count(graph: &Graph, roots: &[ExprId]) -> Self {
        Self::beyond(graph, roots, |_| false)
    }

    /// The same, but for what is known and what only that depends on.
    fn beyond(graph: &Graph, roots: &[ExprId], is_known: impl Fn(ExprId) -> bool) -> Self {
        let order = graph.reachable_beyond(roots, &is_known);
        let mut counts: ByExpr<u32> = ByExpr::default();
        for &root in roots.iter().filter(|&&root| !is_known(root)) {
            *counts.or_default(root) += 1;
        }
        for &id in order.iter().rev() {
            let weight = if matches!(graph.node(id), Node::Neg(_)) { counts[id] } else { 1 };
            for operand in graph.node(id).operands().filter(|&operand| !is_known(operand)) {
                *counts.or_default(operand) += weight;
            }
        }
        Self { order, counts }
    }

    pub fn of(&self, id: ExprId) -> u32 {
        self.counts.get(id).copied().unwrap_or(0)
    }

    /// Numerator and denominator of a product that is better written as a quotient.
    pub fn quotient(&self, graph: &Graph, a: ExprId, b: ExprId) -> Option<(ExprId, ExprId)> {
        let denominator = |id| match graph.node(id) {
            Node::Recip(x) if self.of(id) == 1 => Some(*x),
            _ => None,
        };
        denominator(b).map(|x| (a, x)).or_else(|| denominator(a).map(|x| (b, x)))
    }
}

/// Expressions with more operations than this get a name even if they are used once: for the reader.
const MAX_INLINE_OPERATIONS: usize = 6;

/// A straight-line program.
#[derive(Debug)]
pub struct Program {
    pub uses: Uses,
    /// Expressions that get a name, in order.
    pub temporaries: Vec<ExprId>,
}

impl Program {
    pub fn new(graph: &Graph, roots: &[ExprId]) -> Self {
        let uses = Uses::count(graph, roots);
        let summed = products_of_sums(graph, &uses.order);
        let mut inline_size: ByExpr<usize> = ByExpr::default();
        let mut temporaries = Vec::new();
        for &id in &uses.order {
            let own = match graph.node(id) {
                Node::Constant(_) | Node::Symbol(_) => 0,
                node => {
                    let free = matches!(node, Node::Neg(_));
                    usize::from(!free) + node.operands().map(|o| inline_size[o]).sum::<usize>()
                }
            };
            let shared = uses.of(id) > 1 && !matches!(graph.node(id), Node::Neg(_));
            // A reciprocal that is used once is written as a quotient.
            // A product that feeds one sum becomes one operation with it.
            let long = own > MAX_INLINE_OPERATIONS
                && !matches!(graph.node(id), Node::Recip(_) | Node::Neg(_))
                && !summed.contains(&id);
            let named = own > 0 && (shared || long);
            if named {
                temporaries.push(id);
            }
            inline_size.insert(id, if named { 0 } else { own });
        }
        Self { uses, temporaries }
    }
}

/// Products that are terms of sums.
fn products_of_sums(graph: &Graph, order: &[ExprId]) -> HashSet<ExprId> {
    let sums = order.iter().filter(|&&id| matches!(graph.node(id), Node::Add(..)));
    let terms = sums.flat_map(|&sum| graph.node(sum).operands());
    let unsigned = terms.map(|term| if let Node::Neg(inner) = graph.node(term) { *inner } else { term });
    unsigned.filter(|&term| matches!(graph.node(term), Node::Mul(..))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::expr::symbol::Symbol;

    /// (x + y)² / z, and once more.
    #[test]
    fn each_pass_saves_what_it_says() {
        let mut graph = Graph::new();
        let [x, y, z] = [0, 1, 2].map(|k| graph.symbol(Symbol::Coordinate(k)));
        let sum = graph.add(x, y);
        let square = graph.mul(sum, sum);
        let inverse = graph.recip(z);
        let quotient = graph.mul(square, inverse);
        let passes = Passes::count(&graph, &[quotient]);
        assert_eq!(passes, Passes { written_out: 5, shared: 4, emitted: 3 });
        assert_eq!(Passes::count(&graph, &[quotient, quotient]), Passes { written_out: 10, ..passes });
    }

    #[test]
    fn what_is_too_large_to_count_is_the_largest_number() {
        let mut graph = Graph::new();
        let mut power = graph.symbol(Symbol::Coordinate(0));
        for _ in 0..100 {
            power = graph.mul(power, power);
        }
        let passes = Passes::count(&graph, &[power]);
        assert_eq!((passes.written_out, passes.shared), (u64::MAX, 100));
    }
}
