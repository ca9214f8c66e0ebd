//! The expression graph: a hash-consed arena. Equal expressions are one node, so sharing is common-subexpression
//! elimination, and one graph serves every function of a module.
//!
//! Constructors simplify: constants fold exactly, zeros and ones vanish, signs and constant factors move outwards, and
//! the operands of commutative operations are ordered. An operand always has a smaller id than its expression.

use crate::expr::constant::Constant;
use crate::expr::domains::Domains;
use crate::expr::symbol::Symbol;
use gyro_model::Rational;
use gyro_program::elementary::{Function, Parity, Properties};
use hashbrown::HashTable;
use hashbrown::hash_table::Entry;
use rustc_hash::FxBuildHasher;
use std::cell::RefCell;
use std::hash::BuildHasher;

/// Handle of an expression in its [`Graph`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ExprId(u32);

impl ExprId {
    /// Its place among all expressions of the graph.
    pub fn place(self) -> usize {
        self.0 as usize
    }
}

/// One expression.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Node {
    Constant(Constant),
    Symbol(Symbol),
    /// A sum; at most the second operand is a [`Node::Neg`], and then it is a difference.
    Add(ExprId, ExprId),
    Mul(ExprId, ExprId),
    Neg(ExprId),
    /// `1 / x`.
    Recip(ExprId),
    /// An elementary function; of one operand both are the same.
    Call(Function, [ExprId; 2]),
}

impl Node {
    /// The operands.
    pub fn operands(&self) -> impl Iterator<Item = ExprId> + use<> {
        let (a, b) = match *self {
            Self::Constant(_) | Self::Symbol(_) => (None, None),
            Self::Add(a, b) | Self::Mul(a, b) => (Some(a), Some(b)),
            Self::Neg(a) | Self::Recip(a) => (Some(a), None),
            Self::Call(function, [a, b]) => (Some(a), (function.arity() == 2).then_some(b)),
        };
        a.into_iter().chain(b)
    }

    /// The same operation on other operands.
    #[must_use]
    pub fn with_operands(&self, other: impl Fn(ExprId) -> ExprId) -> Self {
        match self {
            Self::Constant(_) | Self::Symbol(_) => self.clone(),
            Self::Add(a, b) => Self::Add(other(*a), other(*b)),
            Self::Mul(a, b) => Self::Mul(other(*a), other(*b)),
            Self::Neg(a) => Self::Neg(other(*a)),
            Self::Recip(a) => Self::Recip(other(*a)),
            Self::Call(function, operands) => Self::Call(*function, operands.map(other)),
        }
    }
}

/// The arena.
#[derive(Clone, Debug)]
pub struct Graph {
    nodes: Vec<Node>,
    /// By their hashes, which stand beside them: to move an entry, or to tell most that differ, takes no node.
    index: HashTable<(u32, ExprId)>,
    /// Of each node, what it changes with.
    changes: Vec<Changes>,
    /// A bit for each node, all of them zero but while a walk is under way.
    seen: RefCell<Vec<u64>>,
    /// The values that variables take.
    pub domains: Domains,
}

/// What an expression changes with: the last of what its symbols are.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Changes {
    Never,
    WithParameters,
    WithState,
}

impl Graph {
    pub const ZERO: ExprId = ExprId(0);
    pub const ONE: ExprId = ExprId(1);

    pub fn new() -> Self {
        let (nodes, index, changes) = (Vec::new(), HashTable::new(), Vec::new());
        let (seen, domains) = (RefCell::default(), Domains::default());
        let mut graph = Self { nodes, index, changes, seen, domains };
        graph.integer(0);
        graph.integer(1);
        graph
    }

    pub fn node(&self, id: ExprId) -> &Node {
        &self.nodes[id.place()]
    }

    /// The exact value of a constant expression.
    pub fn as_constant(&self, id: ExprId) -> Option<&Constant> {
        if let Node::Constant(value) = self.node(id) { Some(value) } else { None }
    }

    /// Whether an expression depends on parameters and nothing else: it is computed once, before all steps (see
    /// `parameter_setup`).
    pub fn is_settled(&self, id: ExprId) -> bool {
        self.changes[id.place()] == Changes::WithParameters
    }

    /// Whether it changes from step to step.
    pub fn is_changing(&self, id: ExprId) -> bool {
        self.changes[id.place()] == Changes::WithState
    }

    /// Every node that the roots depend on, operands before their users, in the order in which a depth-first walk from
    /// the roots completes them: what an expression needs comes shortly before it.
    pub fn reachable(&self, roots: &[ExprId]) -> Vec<ExprId> {
        self.reachable_beyond(roots, |_| false)
    }

    /// The same, but for what is known and what only that depends on.
    pub fn reachable_beyond(&self, roots: &[ExprId], is_known: impl Fn(ExprId) -> bool) -> Vec<ExprId> {
        let is_seen = |seen: &[u64], id: ExprId| seen[id.place() / 64] & (1 << (id.place() % 64)) != 0;
        let mut seen = self.seen.take();
        seen.resize(self.nodes.len().div_ceil(64), 0);
        let mut order = Vec::new();
        // A node is pushed a second time, as complete, beneath its operands.
        let mut stack: Vec<_> = roots.iter().rev().map(|&root| (root, false)).collect();
        while let Some((id, complete)) = stack.pop() {
            if complete {
                order.push(id);
            } else if !is_seen(&seen, id) && !is_known(id) {
                seen[id.place() / 64] |= 1 << (id.place() % 64);
                stack.push((id, true));
                let operands = self.node(id).operands().filter(|&operand| !is_seen(&seen, operand));
                stack.extend(operands.map(|operand| (operand, false)));
            }
        }
        order.iter().for_each(|id| seen[id.place() / 64] = 0);
        self.seen.replace(seen);
        order
    }

    pub fn constant(&mut self, value: Constant) -> ExprId {
        self.intern(Node::Constant(value))
    }

    pub fn rational(&mut self, value: Rational) -> ExprId {
        self.constant(Constant::rational(value))
    }

    pub fn integer(&mut self, value: i64) -> ExprId {
        self.constant(Constant::integer(value))
    }

    /// `numerator / denominator`.
    pub fn fraction(&mut self, numerator: i64, denominator: i64) -> ExprId {
        self.rational(Rational::new(numerator.into(), denominator.into()))
    }

    pub fn symbol(&mut self, symbol: Symbol) -> ExprId {
        self.intern(Node::Symbol(symbol))
    }

    pub fn neg(&mut self, a: ExprId) -> ExprId {
        match self.node(a) {
            Node::Neg(inner) => *inner,
            Node::Constant(value) => {
                let value = value.neg();
                self.constant(value)
            }
            _ => self.intern(Node::Neg(a)),
        }
    }

    pub fn add(&mut self, a: ExprId, b: ExprId) -> ExprId {
        match (a, b) {
            (Self::ZERO, x) | (x, Self::ZERO) => return x,
            _ => {}
        }
        let ((has_factor_a, rest_a), (has_factor_b, rest_b)) = (self.rest(a), self.rest(b));
        if rest_a != rest_b && !(has_factor_a && has_factor_b) {
            return self.add_terms(a, b);
        }
        let ((ca, xa), (cb, xb)) = (self.split(a), self.split(b));
        if xa == xb
            && let Some(sum) = ca.add(&cb)
        {
            return self.scale(&sum, xa);
        }
        let same_factor = ca.abs() == cb.abs() && xa != Self::ONE && xb != Self::ONE;
        if same_factor && !ca.abs().is_one() {
            // c x ± c y = c (x ± y)
            let (x, y) = (self.signed(&ca, xa), self.signed(&cb, xb));
            let sum = self.add_terms(x, y);
            return self.scale(&ca.abs(), sum);
        }
        self.add_terms(a, b)
    }

    pub fn sub(&mut self, a: ExprId, b: ExprId) -> ExprId {
        let b = self.neg(b);
        self.add(a, b)
    }

    /// A constant factor of one operand stays with it: it is usually shared, as a column of a factorisation is.
    pub fn mul(&mut self, a: ExprId, b: ExprId) -> ExprId {
        match (a, b) {
            (Self::ZERO, _) | (_, Self::ZERO) => return Self::ZERO,
            (Self::ONE, x) | (x, Self::ONE) => return x,
            _ => {}
        }
        if let Some(product) = self.reduced_product(self.rest(a).1, self.rest(b).1) {
            let (ca, cb) = (self.split(a).0, self.split(b).0);
            return self.scale(&ca.mul(&cb), product);
        }
        let ((negative_a, a), (negative_b, b)) = (self.split_sign(a), self.split_sign(b));
        let product = self.intern(Node::Mul(a.min(b), a.max(b)));
        if negative_a == negative_b { product } else { self.neg(product) }
    }

    pub fn recip(&mut self, a: ExprId) -> ExprId {
        let (c, x) = self.split(a);
        let Some(c) = c.recip() else { return self.intern(Node::Recip(a)) };
        let inverse = match self.node(x) {
            Node::Recip(inner) => *inner,
            _ if x == Self::ONE => Self::ONE,
            _ => self.intern(Node::Recip(x)),
        };
        self.scale(&c, inverse)
    }

    pub fn div(&mut self, a: ExprId, b: ExprId) -> ExprId {
        let inverse = self.recip(b);
        self.mul(a, inverse)
    }

    /// An elementary function of these operands; of one operand both are the same. A sign moves outwards, or vanishes.
    pub fn call(&mut self, function: Function, operands: [ExprId; 2]) -> ExprId {
        let Properties { arity, parity, at_zero, .. } = function.properties();
        match (function, operands, at_zero) {
            (_, [Self::ZERO, _], Some(value)) => return self.integer(value),
            (Function::Curve { order, .. }, ..) if order > Function::LAST_ORDER => return Self::ZERO,
            (Function::Sqrt, [a, _], _) => {
                if let Some(root) = self.as_constant(a).and_then(Constant::sqrt) {
                    return self.constant(root);
                }
            }
            (Function::Abs | Function::Floor | Function::When | Function::Unless, ..) => {
                if let Some(known) = self.known(function, operands) {
                    return known;
                }
            }
            _ => {}
        }
        // The signs of points move outwards when a tape is made.
        if arity == 2 || parity == Parity::Neither {
            return self.intern(Node::Call(function, operands));
        }
        let (is_negative, x) = self.split_sign(operands[0]);
        let value = self.intern(Node::Call(function, [x, x]));
        if is_negative && parity == Parity::Odd { self.neg(value) } else { value }
    }

    /// What is exact of rationals: where they lie, and what such a condition chooses.
    fn known(&mut self, function: Function, [a, b]: [ExprId; 2]) -> Option<ExprId> {
        let constant = self.as_constant(a).filter(|constant| constant.is_rational()).cloned();
        match function {
            Function::Abs => Some(self.constant(constant?.abs())),
            Function::Floor => Some(self.constant(constant?.floor())),
            Function::When | Function::Unless if b == Self::ZERO => Some(Self::ZERO),
            Function::When | Function::Unless => {
                let constant = constant?;
                let is_positive = !constant.is_zero() && !constant.is_negative();
                Some(if is_positive == (function == Function::When) { b } else { Self::ZERO })
            }
            _ => None,
        }
    }

    pub fn sqrt(&mut self, a: ExprId) -> ExprId {
        self.call(Function::Sqrt, [a, a])
    }

    pub fn sin(&mut self, a: ExprId) -> ExprId {
        self.call(Function::Sin, [a, a])
    }

    pub fn cos(&mut self, a: ExprId) -> ExprId {
        self.call(Function::Cos, [a, a])
    }

    pub fn tanh(&mut self, a: ExprId) -> ExprId {
        self.call(Function::Tanh, [a, a])
    }

    /// The angle of the point (x, y), in (−π, π].
    pub fn atan2(&mut self, y: ExprId, x: ExprId) -> ExprId {
        self.call(Function::Atan2, [y, x])
    }

    /// x where the condition is greater than zero, and zero where it is not.
    pub fn when(&mut self, condition: ExprId, x: ExprId) -> ExprId {
        self.call(Function::When, [condition, x])
    }

    /// `c · x`, the sign outermost.
    pub fn scale(&mut self, c: &Constant, x: ExprId) -> ExprId {
        if c.is_zero() || x == Self::ZERO {
            return Self::ZERO;
        }
        if x == Self::ONE {
            return self.constant(c.clone());
        }
        let (opposite, x) = self.split_sign(x);
        let magnitude = c.abs();
        let scaled = if magnitude.is_one() {
            x
        } else {
            let magnitude = self.constant(magnitude);
            self.intern(Node::Mul(magnitude, x))
        };
        if c.is_negative() == opposite { scaled } else { self.neg(scaled) }
    }

    /// An expression as constant times the rest; the rest of a constant is one.
    pub fn split(&self, id: ExprId) -> (Constant, ExprId) {
        match self.node(id) {
            Node::Constant(value) => (value.clone(), Self::ONE),
            Node::Neg(inner) => {
                let (c, x) = self.split(*inner);
                (c.neg(), x)
            }
            Node::Mul(c, x) => match self.node(*c) {
                Node::Constant(value) => (value.clone(), *x),
                _ => (Constant::integer(1), id),
            },
            _ => (Constant::integer(1), id),
        }
    }

    /// What [`Self::split`] leaves beside the constant, and whether that is other than ±1.
    fn rest(&self, id: ExprId) -> (bool, ExprId) {
        match self.node(id) {
            Node::Constant(_) => (true, Self::ONE),
            Node::Neg(inner) => self.rest(*inner),
            Node::Mul(c, x) if matches!(self.node(*c), Node::Constant(_)) => (true, *x),
            _ => (false, id),
        }
    }

    /// Whether an expression is a negation, and what it negates; negative constants count.
    pub fn split_sign(&mut self, id: ExprId) -> (bool, ExprId) {
        match self.node(id) {
            Node::Neg(inner) => (true, *inner),
            Node::Constant(value) if value.is_negative() => (true, self.neg(id)),
            _ => (false, id),
        }
    }

    fn signed(&mut self, c: &Constant, x: ExprId) -> ExprId {
        if c.is_negative() { self.neg(x) } else { x }
    }

    /// A sum of two terms that do not combine. A difference keeps its smaller operand first, its sign outermost.
    fn add_terms(&mut self, a: ExprId, b: ExprId) -> ExprId {
        let ((negative_a, xa), (negative_b, xb)) = (self.split_sign(a), self.split_sign(b));
        let (first, second, differ, negative) = if xa <= xb {
            (xa, xb, negative_a != negative_b, negative_a)
        } else {
            (xb, xa, negative_a != negative_b, negative_b)
        };
        let second = if differ { self.intern(Node::Neg(second)) } else { second };
        let sum = self.intern(Node::Add(first, second));
        if negative { self.neg(sum) } else { sum }
    }

    /// A product that simplifies to something else: 1 · b, x · 1/x, √x · √x.
    fn reduced_product(&self, a: ExprId, b: ExprId) -> Option<ExprId> {
        match (self.node(a), self.node(b)) {
            _ if a == Self::ONE => Some(b),
            _ if b == Self::ONE => Some(a),
            (Node::Recip(x), _) if *x == b => Some(Self::ONE),
            (_, Node::Recip(x)) if *x == a => Some(Self::ONE),
            (Node::Call(Function::Sqrt, [x, _]), Node::Call(Function::Sqrt, [y, _])) if x == y => Some(*x),
            _ => None,
        }
    }

    /// An operation on other operands, simplified.
    pub fn rebuilt(&mut self, node: Node) -> ExprId {
        match node {
            Node::Add(a, b) => self.add(a, b),
            Node::Mul(a, b) => self.mul(a, b),
            Node::Neg(a) => self.neg(a),
            Node::Recip(a) => self.recip(a),
            Node::Call(function, operands) => self.call(function, operands),
            Node::Constant(_) | Node::Symbol(_) => self.intern(node),
        }
    }

    /// An expression as it is, without any simplification.
    pub fn intern(&mut self, node: Node) -> ExprId {
        let Self { nodes, index, changes, .. } = self;
        let hash = hash(&node);
        let same = |&(other, id): &(u32, ExprId)| other == hash && nodes[id.place()] == node;
        let spread = |hash: u32| u64::from(hash) | u64::from(hash) << 32;
        let vacant = match index.entry(spread(hash), same, |&(hash, _)| spread(hash)) {
            Entry::Occupied(known) => return known.get().1,
            Entry::Vacant(vacant) => vacant,
        };
        let id = ExprId(
            u32::try_from(nodes.len()).expect("four thousand million expressions do not fit in memory"),
        );
        vacant.insert((hash, id));
        changes.push(match &node {
            Node::Symbol(Symbol::Parameter(_)) => Changes::WithParameters,
            Node::Symbol(_) => Changes::WithState,
            operation => {
                let operands = operation.operands().map(|operand| changes[operand.place()]);
                operands.max().unwrap_or(Changes::Never)
            }
        });
        nodes.push(node);
        id
    }
}

#[cfg(test)]
impl Graph {
    pub fn exp(&mut self, a: ExprId) -> ExprId {
        self.call(Function::Exp, [a, a])
    }

    /// Natural logarithm.
    pub fn ln(&mut self, a: ExprId) -> ExprId {
        self.call(Function::Ln, [a, a])
    }

    pub fn abs(&mut self, a: ExprId) -> ExprId {
        self.call(Function::Abs, [a, a])
    }

    pub fn floor(&mut self, a: ExprId) -> ExprId {
        self.call(Function::Floor, [a, a])
    }

    /// x where the condition is at most zero, and zero where it is greater.
    pub fn unless(&mut self, condition: ExprId, x: ExprId) -> ExprId {
        self.call(Function::Unless, [condition, x])
    }
}

/// The table of nodes takes the last bits for the place and the first seven to tell entries of one place apart. Places
/// go by the last operand: what is made of neighbours is looked up among neighbours, wherever in memory that is.
fn hash(node: &Node) -> u32 {
    let mixed = FxBuildHasher.hash_one(node) as u32;
    let near = node.operands().max().map_or(mixed >> 11, |last| last.0);
    mixed << 25 | ((near << 4 | (mixed >> 7 & 15)) & ((1 << 25) - 1))
}

#[cfg(test)]
mod tests;
