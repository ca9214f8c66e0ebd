//! How long a loop waits from part to part: sums of a body are added in the order in which their terms arrive.
//!
//! A processor works at several parts at once, up to what hands numbers from one part to the next: the longest circle
//! of operations through carried numbers is the least time that a part takes. Of a sum of several terms the one that
//! arrives last is added last, so that only one addition comes after it. Terms, and how many operations there are, stay
//! as they are; roundings are those of another order.

use super::kernel::{At, Local, Repeat, Rolled};
use crate::expr::by_expr::ByExpr;
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::schedule::Uses;
use crate::expr::symbol::Symbol;
use rustc_hash::{FxHashMap as HashMap, FxHashSet as HashSet};

/// Cycles from operands to result, as most processors take them.
const SUM: u64 = 4;
const PRODUCT: u64 = 4;
const QUOTIENT: u64 = 14;
const FUNCTION: u64 = 60;

/// Parts after which the longest circle has shown itself, and as many over which its length is measured.
const PARTS: u64 = 8;

/// How often sums are put in order, each time by what the last order has led to.
const ROUNDS: usize = 4;

/// A loop's body as a recurrence.
struct Recurrence {
    graph: Graph,
    /// All that is stored, and which of these numbers each carried symbol stands for in the next part.
    values: Vec<ExprId>,
    carried: Vec<(Symbol, usize)>,
}

impl Rolled {
    /// The same with the sums of all loops in the order in which the next part has its numbers soonest.
    pub(super) fn hastened(mut self) -> Self {
        let hastened = |(before, repeat): (_, Repeat)| (before, repeat.hastened());
        self.loops = self.loops.into_iter().map(hastened).collect();
        self
    }
}

impl Repeat {
    /// The same with sums in the order in which the next part has its numbers soonest.
    pub(super) fn hastened(mut self) -> Self {
        let mut best = Recurrence::of(&mut self);
        let mut length = best.length();
        let mut next = best.reordered();
        for _ in 0..ROUNDS {
            let found = next.length();
            let after = next.reordered();
            if found < length {
                (best, length) = (next, found);
            }
            next = after;
        }
        let mut values = best.values.into_iter();
        for row in &mut self.rows {
            row.values.iter_mut().zip(values.by_ref()).for_each(|(value, new)| *value = new);
        }
        self.graph = best.graph;
        self
    }
}

impl Recurrence {
    fn of(repeat: &mut Repeat) -> Self {
        let values = repeat.values();
        let mut place = 0;
        let mut at: HashMap<(usize, usize), usize> = HashMap::default();
        for row in &repeat.rows {
            if row.at == At::Only {
                at.extend((0..row.values.len()).map(|column| ((row.array, column), place + column)));
            }
            place += row.values.len();
        }
        let carried = repeat.locals.iter().enumerate().filter_map(|(number, local)| match local {
            Local::Carried { array, column } => Some((Symbol::Local(number), at[&(*array, *column)])),
            _ => None,
        });
        let carried = carried.collect();
        Self { graph: std::mem::replace(&mut repeat.graph, Graph::new()), values, carried }
    }

    /// When each carried symbol arrives after so many parts.
    fn after(&self, uses: &Uses, n_parts: u64) -> HashMap<Symbol, u64> {
        let mut arrivals = HashMap::default();
        for _ in 0..n_parts {
            let all = self.arrivals(uses, &arrivals);
            arrivals = self.carried.iter().map(|&(symbol, at)| (symbol, all[self.values[at]])).collect();
        }
        arrivals
    }

    /// When everything arrives if carried symbols arrive so, and all else was there long ago.
    fn arrivals(&self, uses: &Uses, carried: &HashMap<Symbol, u64>) -> ByExpr<u64> {
        let mut arrivals = ByExpr::default();
        for &id in &uses.order {
            let at = arrival(&self.graph, id, carried, |operand| arrivals[operand]);
            arrivals.insert(id, at);
        }
        arrivals
    }

    /// Cycles from part to part, for as many parts as it is measured over.
    fn length(&self) -> u64 {
        let uses = Uses::count(&self.graph, &self.values);
        let latest = |n| self.after(&uses, n).into_values().max().unwrap_or(0);
        latest(2 * PARTS) - latest(PARTS)
    }

    fn reordered(&self) -> Self {
        let uses = Uses::count(&self.graph, &self.values);
        let carried = self.after(&uses, PARTS);
        let within = within_sums(&self.graph, &uses);
        let mut to = Reordering { graph: Graph::new(), arrivals: ByExpr::default(), carried: &carried };
        let mut new: ByExpr<ExprId> = ByExpr::default();
        for &id in uses.order.iter().filter(|id| !within.contains(id)) {
            let node = self.graph.node(id);
            let made = if let Node::Add(..) = node {
                let mut terms = Vec::new();
                self.terms(id, false, &within, &new, &mut terms);
                to.sum(terms)
            } else {
                to.put(node.with_operands(|operand| new[operand]))
            };
            new.insert(id, made);
        }
        let values = self.values.iter().map(|value| new[*value]).collect();
        Self { graph: to.graph, values, carried: self.carried.clone() }
    }

    /// The terms of a sum and of the sums in it.
    fn terms(
        &self,
        id: ExprId,
        is_negative: bool,
        within: &HashSet<ExprId>,
        new: &ByExpr<ExprId>,
        terms: &mut Vec<(bool, ExprId)>,
    ) {
        for operand in self.graph.node(id).operands() {
            let (inner, flips) = positive(&self.graph, operand);
            let is_negative = is_negative ^ flips;
            if within.contains(&inner) {
                self.terms(inner, is_negative, within, new, terms);
            } else {
                terms.push((is_negative, new[inner]));
            }
        }
    }
}

/// What a negation negates, and whether there was one.
fn positive(graph: &Graph, id: ExprId) -> (ExprId, bool) {
    if let Node::Neg(x) = *graph.node(id) { (x, true) } else { (id, false) }
}

/// Sums that are terms of another sum and of nothing else, and their negations.
fn within_sums(graph: &Graph, uses: &Uses) -> HashSet<ExprId> {
    let mut within = HashSet::default();
    for &id in &uses.order {
        let Node::Add(a, b) = *graph.node(id) else { continue };
        for operand in [a, b] {
            let (inner, _) = positive(graph, operand);
            if matches!(graph.node(inner), Node::Add(..)) && uses.of(inner) == 1 {
                within.extend([inner, operand]);
            }
        }
    }
    within
}

fn arrival(graph: &Graph, id: ExprId, carried: &HashMap<Symbol, u64>, of: impl Fn(ExprId) -> u64) -> u64 {
    let node = graph.node(id);
    let operands = node.operands().map(of).max().unwrap_or(0);
    operands
        + match node {
            Node::Constant(_) | Node::Neg(_) => 0,
            Node::Symbol(symbol) => carried.get(symbol).copied().unwrap_or(0),
            Node::Add(..) => SUM,
            Node::Mul(..) => PRODUCT,
            Node::Recip(_) => QUOTIENT,
            Node::Call(..) => FUNCTION,
        }
}

struct Reordering<'c> {
    graph: Graph,
    arrivals: ByExpr<u64>,
    carried: &'c HashMap<Symbol, u64>,
}

impl Reordering<'_> {
    fn put(&mut self, node: Node) -> ExprId {
        let id = self.graph.intern(node);
        let at = arrival(&self.graph, id, self.carried, |operand| self.arrivals[operand]);
        self.arrivals.insert(id, at);
        id
    }

    /// Terms that arrive first are added first. Of those that arrive together the order stays.
    fn sum(&mut self, mut terms: Vec<(bool, ExprId)>) -> ExprId {
        terms.sort_by_key(|(_, term)| self.arrivals[*term]);
        let mut terms = terms.into_iter();
        let first = terms.next().expect("a sum has two terms");
        let (is_negative, sum) = terms.fold(first, |sum, term| self.pair(sum, term));
        if is_negative { self.put(Node::Neg(sum)) } else { sum }
    }

    fn pair(&mut self, (minus_a, a): (bool, ExprId), (minus_b, b): (bool, ExprId)) -> (bool, ExprId) {
        let (first, second) = if minus_a && !minus_b { (b, a) } else { (a, b) };
        let second = if minus_a == minus_b { second } else { self.put(Node::Neg(second)) };
        (minus_a && minus_b, self.put(Node::Add(first, second)))
    }
}

#[cfg(test)]
mod tests;
