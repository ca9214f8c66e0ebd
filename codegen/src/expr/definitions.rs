//! Named intermediate quantities, and the pass that replaces them by what they stand for.
//!
//! Rotation matrices stay symbols while Φ is built and differentiated, because their derivatives along a rotation have
//! a rule of their own (`A' = A ẽ`); afterwards [`Definitions::expand`] puts in A(p) — of the state's p, or of a
//! corrected one, so that a Jacobian derived once can be evaluated anywhere.

use crate::expr::by_expr::ByExpr;
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::symbol::Symbol;
use rustc_hash::FxHashMap as HashMap;
use std::borrow::Cow;

/// What symbols stand for.
#[derive(Clone, Debug, Default)]
pub struct Definitions {
    expressions: HashMap<Symbol, ExprId>,
    /// Sine and cosine of each continuous angle, up to a common factor.
    angles: HashMap<usize, (ExprId, ExprId)>,
}

impl Definitions {
    pub fn insert(&mut self, symbol: Symbol, expression: ExprId) {
        self.expressions.insert(symbol, expression);
    }

    /// A continuous angle differentiates by its sine and cosine: its turn reference is constant in all derivatives.
    pub fn insert_angle(&mut self, turn: usize, angle: ExprId, sine_and_cosine: (ExprId, ExprId)) {
        self.insert(Symbol::Angle(turn), angle);
        self.angles.insert(turn, sine_and_cosine);
    }

    /// Sine and cosine of a continuous angle.
    pub fn angle(&self, turn: usize) -> Option<(ExprId, ExprId)> {
        self.angles.get(&turn).copied()
    }

    pub fn get(&self, symbol: Symbol) -> Option<ExprId> {
        self.expressions.get(&symbol).copied()
    }
}

/// What symbols stand for.
pub type Values = HashMap<Symbol, ExprId>;

/// Replaces symbols: first by the values given here, which are final, else by their definitions, which are expanded in
/// turn.
#[derive(Debug)]
pub struct Expansion<'a> {
    definitions: &'a Definitions,
    values: Cow<'a, Values>,
    memo: ByExpr<ExprId>,
}

impl<'a> Expansion<'a> {
    pub fn new(definitions: &'a Definitions) -> Self {
        Self::with_values(definitions, Values::default())
    }

    pub fn with_values(definitions: &'a Definitions, values: Values) -> Self {
        Self { definitions, values: Cow::Owned(values), memo: ByExpr::default() }
    }

    pub fn at(definitions: &'a Definitions, values: &'a Values) -> Self {
        Self { definitions, values: Cow::Borrowed(values), memo: ByExpr::default() }
    }

    pub fn of(&mut self, graph: &mut Graph, root: ExprId) -> ExprId {
        for id in graph.reachable_beyond(&[root], |id| self.memo.contains(id)) {
            let expanded = self.node(graph, id);
            self.memo.insert(id, expanded);
        }
        self.memo[root]
    }

    pub fn all(&mut self, graph: &mut Graph, roots: &[ExprId]) -> Vec<ExprId> {
        roots.iter().map(|&root| self.of(graph, root)).collect()
    }

    fn node(&mut self, graph: &mut Graph, id: ExprId) -> ExprId {
        match graph.node(id).clone() {
            Node::Symbol(symbol) => match (self.values.get(&symbol), self.definitions.get(symbol)) {
                (Some(&value), _) => value,
                (None, Some(definition)) => self.of(graph, definition),
                (None, None) => id,
            },
            node => {
                let expanded = node.with_operands(|operand| self.memo[operand]);
                if expanded == node { id } else { graph.rebuilt(expanded) }
            }
        }
    }
}
