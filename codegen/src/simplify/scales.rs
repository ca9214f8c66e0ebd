//! Every expression up to a constant factor. A product has the factors of its operands together, a reciprocal the
//! reciprocal factor; a sum takes the factor that most of its terms have, and only the others pay for theirs. The
//! result is what a good choice of units achieves by hand: with the moments of one body as unit of inertia, or an arm
//! as unit of length, most constants become one.

use crate::expr::by_expr::ByExpr;
use crate::expr::constant::Constant;
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::schedule::{Operations, Uses};
use rustc_hash::FxHashMap as HashMap;

/// Longer functions stay as they are.
const MAX_OPERATIONS: usize = 3000;

/// The roots, or what is shorter.
pub fn scaled(graph: &mut Graph, roots: &[ExprId]) -> Vec<ExprId> {
    let mut taken = (Operations::recurring(graph, roots).total(), roots.to_vec());
    if taken.0 <= MAX_OPERATIONS {
        for tie in [Tie::One, Tie::First, Tie::Last] {
            let way = written(graph, roots, tie);
            let cost = Operations::recurring(graph, &way).total();
            if cost < taken.0 {
                taken = (cost, way);
            }
        }
    }
    taken.1
}

/// Which of the factors that equally many terms have.
#[derive(Clone, Copy, Debug)]
enum Tie {
    One,
    First,
    Last,
}

fn written(graph: &mut Graph, roots: &[ExprId], tie: Tie) -> Vec<ExprId> {
    let uses = Uses::count(graph, roots);
    let mut scales = Scales { graph, uses, tie, known: ByExpr::default() };
    for id in scales.uses.order.clone() {
        let value = scales.of(id);
        scales.known.insert(id, value);
    }
    let known = scales.known;
    roots.iter().map(|root| graph.scale(&known[*root].0, known[*root].1)).collect()
}

struct Scales<'g> {
    graph: &'g mut Graph,
    uses: Uses,
    tie: Tie,
    /// Of each expression its factor and the rest.
    known: ByExpr<(Constant, ExprId)>,
}

impl Scales<'_> {
    fn of(&mut self, id: ExprId) -> (Constant, ExprId) {
        let node = self.graph.node(id).clone();
        match node {
            Node::Constant(value) => (value, Graph::ONE),
            Node::Symbol(_) => (Constant::integer(1), id),
            Node::Neg(a) => {
                let (c, x) = self.known[a].clone();
                (c.neg(), x)
            }
            Node::Mul(a, b) => {
                let ((c, x), (d, y)) = (self.known[a].clone(), self.known[b].clone());
                let product = self.graph.mul(x, y);
                self.with_factor(&c.mul(&d), product)
            }
            Node::Recip(a) => {
                let (c, x) = self.known[a].clone();
                let inverse = self.graph.recip(x);
                match c.recip() {
                    Some(c) => self.with_factor(&c, inverse),
                    None => (Constant::integer(1), id),
                }
            }
            Node::Add(..) => self.sum(id),
            _ => {
                let operands: HashMap<_, _> = (node.operands())
                    .map(|operand| (operand, self.graph.scale(&self.known[operand].0, self.known[operand].1)))
                    .collect();
                let node = node.with_operands(|operand| operands[&operand]);
                (Constant::integer(1), self.graph.rebuilt(node))
            }
        }
    }

    fn with_factor(&self, c: &Constant, x: ExprId) -> (Constant, ExprId) {
        let (d, x) = self.graph.split(x);
        (c.mul(&d), x)
    }

    fn sum(&mut self, id: ExprId) -> (Constant, ExprId) {
        let mut terms = Vec::new();
        self.terms(id, true, &mut terms);
        let factor = self.factor(&terms);
        let Some(inverse) = factor.recip() else { return (Constant::integer(1), id) };
        let (mut total, mut constant) = (None, Constant::integer(0));
        for (c, x) in terms {
            let c = c.mul(&inverse);
            if x == Graph::ONE
                && let Some(sum) = constant.add(&c)
            {
                constant = sum;
                continue;
            }
            let term = self.graph.scale(&c, x);
            total = Some(total.map_or(term, |total| self.graph.add(total, term)));
        }
        let constant = self.graph.constant(constant);
        let total = total.map_or(constant, |total| self.graph.add(total, constant));
        self.with_factor(&factor, total)
    }

    /// The terms of a sum of sums that nobody else uses.
    fn terms(&self, id: ExprId, is_whole: bool, terms: &mut Vec<(Constant, ExprId)>) {
        match *self.graph.node(id) {
            Node::Add(a, b) if is_whole || self.uses.of(id) == 1 => {
                self.terms(a, false, terms);
                self.terms(b, false, terms);
            }
            Node::Neg(a) if self.uses.of(a) == 1 && matches!(self.graph.node(a), Node::Add(..)) => {
                let first = terms.len();
                self.terms(a, false, terms);
                terms[first..].iter_mut().for_each(|(c, _)| *c = c.neg());
            }
            _ => terms.push(self.known[id].clone()),
        }
    }

    /// The factor that most terms have.
    fn factor(&self, terms: &[(Constant, ExprId)]) -> Constant {
        let factors: Vec<_> = terms.iter().filter(|(_, x)| *x != Graph::ONE).map(|(c, _)| c.abs()).collect();
        let mut often: HashMap<&Constant, usize> = HashMap::default();
        factors.iter().for_each(|c| *often.entry(c).or_default() += 1);
        let most = often.values().copied().max().unwrap_or(0);
        let mut candidates: Vec<_> = factors.iter().filter(|c| often[c] == most).collect();
        match self.tie {
            Tie::One if candidates.iter().any(|c| c.is_one()) => candidates.retain(|c| c.is_one()),
            Tie::Last => candidates.reverse(),
            _ => {}
        }
        candidates.first().map_or_else(|| Constant::integer(1), |&c| c.clone())
    }
}

#[cfg(test)]
mod tests;
