//! Directional derivatives of expressions: every derivative of the project comes from here.

use crate::expr::by_expr::ByExpr;
use crate::expr::definitions::Definitions;
use crate::expr::elementary;
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::symbol::Symbol;
use gyro_program::elementary::Function;
use rustc_hash::FxHashMap as HashMap;
use std::collections::BTreeMap;

/// What each symbol changes by.
pub type Direction = BTreeMap<Symbol, ExprId>;

/// The derivative along one direction, given by what it is of the symbols. A symbol that the direction does not name
/// differentiates as its definition, if it has one, and is constant otherwise.
#[derive(Debug)]
pub struct Derivative<'a> {
    definitions: &'a Definitions,
    direction: Direction,
    memo: ByExpr<ExprId>,
}

impl<'a> Derivative<'a> {
    pub fn new(definitions: &'a Definitions, direction: Direction) -> Self {
        Self { definitions, direction, memo: ByExpr::default() }
    }

    /// The derivative of one expression.
    pub fn of(&mut self, graph: &mut Graph, root: ExprId) -> ExprId {
        for id in graph.reachable_beyond(&[root], |id| self.memo.contains(id)) {
            let derivative = self.node(graph, id);
            self.memo.insert(id, derivative);
        }
        self.memo[root]
    }

    fn node(&mut self, graph: &mut Graph, id: ExprId) -> ExprId {
        match graph.node(id).clone() {
            Node::Constant(_) => Graph::ZERO,
            Node::Symbol(symbol) => self.symbol(graph, symbol),
            // (a + b)' = a' + b'
            Node::Add(a, b) => graph.add(self.memo[a], self.memo[b]),
            // (a b)' = a' b + a b'
            Node::Mul(a, b) => {
                let (left, right) = (graph.mul(self.memo[a], b), graph.mul(a, self.memo[b]));
                graph.add(left, right)
            }
            // (-a)' = -a'
            Node::Neg(a) => graph.neg(self.memo[a]),
            // (1/a)' = -a' (1/a)²
            Node::Recip(a) => {
                let square = graph.mul(id, id);
                let product = graph.mul(self.memo[a], square);
                graph.neg(product)
            }
            // atan2(y, x)' = (x y' − y x') / (x² + y²)
            Node::Call(Function::Atan2, [y, x]) => angle_rate(graph, (y, x), (self.memo[y], self.memo[x])),
            // What is not taken may change infinitely fast: it must not be multiplied by zero.
            Node::Call(function @ (Function::When | Function::Unless), [condition, taken]) => {
                graph.call(function, [condition, self.memo[taken]])
            }
            // f(a, b)' = f_a a' + f_b b'
            Node::Call(function, operands) => {
                let slopes = elementary::slopes(graph, function, operands, id);
                graph.dot(&slopes, &operands.map(|operand| self.memo[operand]))
            }
        }
    }

    fn symbol(&mut self, graph: &mut Graph, symbol: Symbol) -> ExprId {
        if let Some(&derivative) = self.direction.get(&symbol) {
            return derivative;
        }
        match symbol {
            Symbol::Table { table, order } => {
                let rate = self.direction.get(&Symbol::Time).copied().unwrap_or(Graph::ZERO);
                let slope = graph.symbol(Symbol::Table { table, order: order + 1 });
                graph.mul(slope, rate)
            }
            Symbol::Angle(turn) => {
                let (sine, cosine) = self.definitions.angle(turn).expect("every angle is defined");
                let rates = (self.of(graph, sine), self.of(graph, cosine));
                angle_rate(graph, (sine, cosine), rates)
            }
            _ => match self.definitions.get(symbol) {
                Some(definition) => self.of(graph, definition),
                None => Graph::ZERO,
            },
        }
    }
}

/// The derivatives of one expression by some symbols, from the expression inwards: each operation on the way is met
/// once, not once for each symbol. Every symbol is constant but these, and the tables that time moves.
pub fn gradient(graph: &mut Graph, root: ExprId, by: &[Symbol]) -> Vec<ExprId> {
    Gradients { by, taken: HashMap::default() }.of(graph, root)
}

/// Gradients by the same symbols.
struct Gradients<'a> {
    by: &'a [Symbol],
    /// Of each expression that a condition chooses, where it is chosen.
    taken: HashMap<ExprId, Vec<ExprId>>,
}

impl Gradients<'_> {
    fn of(&mut self, graph: &mut Graph, root: ExprId) -> Vec<ExprId> {
        let mut slopes: HashMap<ExprId, ExprId> = HashMap::from_iter([(root, Graph::ONE)]);
        let mut of_symbols: HashMap<Symbol, ExprId> = HashMap::default();
        let mut of_choices = vec![Graph::ZERO; self.by.len()];
        for id in graph.reachable(&[root]).into_iter().rev() {
            // Nothing flows into conditions, and into what they choose not from here.
            let Some(slope) = slopes.remove(&id) else { continue };
            let (symbol, factor) = match *graph.node(id) {
                Node::Symbol(Symbol::Table { table, order }) => {
                    (Symbol::Time, graph.symbol(Symbol::Table { table, order: order + 1 }))
                }
                Node::Symbol(symbol) => (symbol, Graph::ONE),
                Node::Call(function @ (Function::When | Function::Unless), [condition, taken]) => {
                    for (sum, by) in of_choices.iter_mut().zip(self.of_taken(graph, taken)) {
                        let by = graph.call(function, [condition, by]);
                        let product = graph.mul(slope, by);
                        *sum = graph.add(*sum, product);
                    }
                    continue;
                }
                _ => {
                    for (operand, factor) in factors(graph, id) {
                        let product = graph.mul(slope, factor);
                        let sum = slopes.get(&operand).copied().unwrap_or(Graph::ZERO);
                        slopes.insert(operand, graph.add(sum, product));
                    }
                    continue;
                }
            };
            let product = graph.mul(slope, factor);
            let sum = of_symbols.get(&symbol).copied().unwrap_or(Graph::ZERO);
            of_symbols.insert(symbol, graph.add(sum, product));
        }
        let of_symbol = |symbol| of_symbols.get(symbol).copied().unwrap_or(Graph::ZERO);
        self.by.iter().zip(of_choices).map(|(symbol, sum)| graph.add(of_symbol(symbol), sum)).collect()
    }

    /// The gradient of what a condition chooses, by itself: a slope that came from outside would be zero where it is
    /// not chosen, and zero times infinity is no zero.
    fn of_taken(&mut self, graph: &mut Graph, taken: ExprId) -> Vec<ExprId> {
        if let Some(known) = self.taken.get(&taken) {
            return known.clone();
        }
        let gradient = self.of(graph, taken);
        self.taken.insert(taken, gradient.clone());
        gradient
    }
}

/// The operands of an expression, each with the derivative of the expression by it.
fn factors(graph: &mut Graph, id: ExprId) -> Vec<(ExprId, ExprId)> {
    match *graph.node(id) {
        Node::Constant(_) | Node::Symbol(_) => Vec::new(),
        Node::Add(a, b) => vec![(a, Graph::ONE), (b, Graph::ONE)],
        Node::Mul(a, b) => vec![(a, b), (b, a)],
        Node::Neg(a) => vec![(a, graph.integer(-1))],
        Node::Recip(a) => {
            let square = graph.mul(id, id);
            vec![(a, graph.neg(square))]
        }
        Node::Call(function, operands) => {
            let slopes = elementary::slopes(graph, function, operands, id);
            operands.into_iter().zip(slopes).take(function.arity()).collect()
        }
    }
}

/// The rate of the angle of the point (x, y): `(x y' − y x') / (x² + y²)`.
pub fn angle_rate(graph: &mut Graph, (y, x): (ExprId, ExprId), (dy, dx): (ExprId, ExprId)) -> ExprId {
    let (plus, minus) = (graph.mul(x, dy), graph.mul(y, dx));
    let turned = graph.sub(plus, minus);
    let square = graph.dot(&[x, y], &[x, y]);
    graph.div(turned, square)
}

#[cfg(test)]
mod tests;
