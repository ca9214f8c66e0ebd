//! Moves what depends on parameters alone into a function of its own, which runs once when parameters are set.
//!
//! First each function is rewritten so that more does: factors that depend on parameters alone move together through
//! products and sums, `p (q x + y r)` to `(p q) x + (p r) y`, wherever that saves an operation. Then the largest such
//! expressions become numbers that the mechanism carries, [`Symbol::ParameterSetup`].

use crate::expr::by_expr::ByExpr;
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::rounding::rounds_well;
use crate::expr::schedule::Uses;
use crate::expr::symbol::Symbol;
use rustc_hash::FxHashMap as HashMap;

/// Takes out of functions that are called in every step what depends on parameters alone: the values of
/// [`Symbol::ParameterSetup`].
pub fn separate<'r>(
    graph: &mut Graph,
    functions: impl IntoIterator<Item = &'r mut Vec<ExprId>>,
) -> Vec<ExprId> {
    let mut setup = Setup { graph, places: HashMap::default(), values: Vec::new(), memo: ByExpr::default() };
    for roots in functions {
        if setup.graph.reachable(roots).iter().any(|&id| setup.graph.is_settled(id)) {
            // What has moved may leave a factor where it has no other use any more.
            let gathered = (0..PASSES).fold(roots.clone(), |roots, _| Gathering::of(setup.graph, &roots));
            if rounds_well(setup.graph, &gathered, roots) {
                *roots = gathered;
            }
            *roots = roots.iter().map(|&root| setup.without(root)).collect();
        }
    }
    setup.values
}

/// How often.
const PASSES: usize = 2;

/// Moves what depends on parameters alone together.
struct Gathering<'g> {
    graph: &'g mut Graph,
    uses: Uses,
    memo: ByExpr<ExprId>,
}

impl<'g> Gathering<'g> {
    fn of(graph: &'g mut Graph, roots: &[ExprId]) -> Vec<ExprId> {
        let uses = Uses::count(graph, roots);
        let mut gathering = Self { graph, uses, memo: ByExpr::default() };
        for id in gathering.uses.order.clone() {
            let gathered = gathering.gathered(id);
            gathering.memo.insert(id, gathered);
        }
        roots.iter().map(|root| gathering.memo[*root]).collect()
    }

    /// Whether it costs nothing in a step to multiply by it.
    fn is_factor(&self, id: ExprId) -> bool {
        self.graph.is_settled(id) || self.graph.as_constant(id).is_some()
    }

    /// The factor and the rest of a product with one that costs nothing.
    fn split(&self, id: ExprId) -> Option<(ExprId, ExprId)> {
        match *self.graph.node(id) {
            _ if self.is_factor(id) => None,
            Node::Mul(a, b) if self.is_factor(a) => Some((a, b)),
            Node::Mul(a, b) if self.is_factor(b) => Some((b, a)),
            _ => None,
        }
    }

    /// The expression, its operands being gathered.
    fn gathered(&mut self, id: ExprId) -> ExprId {
        match self.split(id) {
            Some((factor, rest)) if self.absorbs(rest) => self.scaled(factor, rest),
            _ if let Some((factor, rest, other)) = self.two_factors(id) => {
                let (rest, scaled) = (self.memo[rest], self.scaled(factor, other));
                self.graph.mul(rest, scaled)
            }
            _ => {
                let node = self.graph.node(id).with_operands(|operand| self.memo[operand]);
                self.graph.rebuilt(node)
            }
        }
    }

    /// Of a product of `factor rest` and of another that absorbs a factor.
    fn two_factors(&self, id: ExprId) -> Option<(ExprId, ExprId, ExprId)> {
        let Node::Mul(a, b) = *self.graph.node(id) else { return None };
        let parted = |id: ExprId, other: ExprId| {
            let (factor, rest) = self.split(id).filter(|_| self.uses.of(id) == 1)?;
            self.absorbs(other).then_some((factor, rest, other))
        };
        parted(a, b).or_else(|| parted(b, a))
    }

    /// Whether a factor vanishes in an expression that nobody else uses.
    fn absorbs(&self, id: ExprId) -> bool {
        if self.is_factor(id) {
            return true;
        }
        if self.uses.of(id) > 1 {
            return false;
        }
        match *self.graph.node(id) {
            Node::Neg(a) => self.absorbs(a),
            Node::Mul(a, b) => self.split(id).is_some() || self.absorbs(a) || self.absorbs(b),
            Node::Add(a, b) => self.absorbs(a) && self.absorbs(b),
            _ => false,
        }
    }

    /// The product with a factor that costs nothing.
    fn scaled(&mut self, factor: ExprId, id: ExprId) -> ExprId {
        let absorbs = self.absorbs(id);
        match *self.graph.node(id) {
            _ if !absorbs || self.is_factor(id) => {
                let rest = self.memo[id];
                self.product(factor, rest)
            }
            Node::Neg(a) => {
                let scaled = self.scaled(factor, a);
                self.graph.neg(scaled)
            }
            Node::Add(a, b) => {
                let (a, b) = (self.scaled(factor, a), self.scaled(factor, b));
                self.graph.add(a, b)
            }
            Node::Mul(a, b) => match self.split(id) {
                Some((inner, rest)) => {
                    let factor = self.graph.mul(factor, inner);
                    self.scaled(factor, rest)
                }
                None => {
                    let (taking, other) = if self.absorbs(a) { (a, b) } else { (b, a) };
                    let (scaled, other) = (self.scaled(factor, taking), self.memo[other]);
                    self.graph.mul(scaled, other)
                }
            },
            _ => unreachable!("nothing else absorbs a factor"),
        }
    }

    /// A product in which a constant does not leave what depends on parameters alone.
    fn product(&mut self, factor: ExprId, rest: ExprId) -> ExprId {
        if !self.graph.is_settled(factor) || self.is_factor(rest) {
            return self.graph.mul(factor, rest);
        }
        let ((negative_factor, factor), (negative_rest, rest)) =
            (self.graph.split_sign(factor), self.graph.split_sign(rest));
        let product = self.graph.intern(Node::Mul(factor.min(rest), factor.max(rest)));
        if negative_factor == negative_rest { product } else { self.graph.neg(product) }
    }
}

/// What was taken out so far.
struct Setup<'g> {
    graph: &'g mut Graph,
    places: HashMap<ExprId, usize>,
    values: Vec<ExprId>,
    memo: ByExpr<ExprId>,
}

impl Setup<'_> {
    /// The expression with numbers in place of what depends on parameters alone.
    fn without(&mut self, root: ExprId) -> ExprId {
        for id in
            self.graph.reachable_beyond(&[root], |id| self.graph.is_settled(id) || self.memo.contains(id))
        {
            let operands: Vec<_> = self.graph.node(id).operands().collect();
            let operands = operands.into_iter().map(|operand| (operand, self.value(operand)));
            let operands: HashMap<_, _> = operands.collect();
            let node = self.graph.node(id).with_operands(|operand| operands[&operand]);
            let value = self.graph.intern(node);
            self.memo.insert(id, value);
        }
        self.value(root)
    }

    fn value(&mut self, id: ExprId) -> ExprId {
        if !self.graph.is_settled(id) {
            return self.memo[id];
        }
        match *self.graph.node(id) {
            Node::Symbol(_) => id,
            Node::Neg(a) => {
                let value = self.value(a);
                self.graph.neg(value)
            }
            _ => {
                let next = self.values.len();
                let place = *self.places.entry(id).or_insert(next);
                if place == next {
                    self.values.push(id);
                }
                self.graph.symbol(Symbol::ParameterSetup(place))
            }
        }
    }
}
