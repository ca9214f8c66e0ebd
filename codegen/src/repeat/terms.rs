//! The expressions of a kernel as terms: signs belong to the operands of a term, and the constant factor of a product
//! or the constant of a sum is part of the term. Terms that differ in constants, signs and variables alone are then
//! alike.

use crate::expr::by_expr::ByExpr;
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::schedule::Uses;
use crate::expr::symbol::Symbol;
use gyro_program::elementary::Function;
use rustc_hash::FxHashSet as HashSet;
use std::ops::{Deref, DerefMut};

/// Place of a term in [`Terms::all`].
pub type Place = usize;

/// What a term computes from its operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Kind {
    /// A variable, by what it is and which component of it.
    Variable {
        of: u8,
        component: usize,
    },
    Constant,
    Sum,
    Product,
    /// A product with a constant.
    Scaled,
    /// A sum with a constant.
    Shifted,
    /// A product with a reciprocal that nobody else uses: numerator and denominator.
    Quotient,
    Reciprocal,
    Call(Function),
}

impl Kind {
    pub fn is_commutative(self) -> bool {
        matches!(self, Self::Sum | Self::Product)
    }

    pub fn is_operation(self) -> bool {
        !matches!(self, Self::Variable { .. } | Self::Constant)
    }

    /// Whether it is one of + − × ÷.
    pub fn is_counted(self) -> bool {
        self.is_operation() && !matches!(self, Self::Call(_))
    }

    /// Whether it is a call of a function: a root is an instruction.
    pub fn is_function(self) -> bool {
        matches!(self, Self::Call(function) if function != Function::Sqrt)
    }
}

/// A term and whether its opposite is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Operand {
    pub term: Place,
    pub is_negative: bool,
}

/// The operands of a term, in place: no operation has more than two.
#[derive(Clone, Copy, Debug)]
pub struct Operands {
    both: [Operand; 2],
    n: usize,
}

impl Deref for Operands {
    type Target = [Operand];

    fn deref(&self) -> &[Operand] {
        &self.both[..self.n]
    }
}

impl DerefMut for Operands {
    fn deref_mut(&mut self) -> &mut [Operand] {
        &mut self.both[..self.n]
    }
}

impl FromIterator<Operand> for Operands {
    fn from_iter<I: IntoIterator<Item = Operand>>(operands: I) -> Self {
        let mut all = Self { both: [Operand { term: 0, is_negative: false }; 2], n: 0 };
        for operand in operands {
            all.both[all.n] = operand;
            all.n += 1;
        }
        all
    }
}

#[derive(Clone, Debug)]
pub struct Term {
    pub id: ExprId,
    pub kind: Kind,
    pub operands: Operands,
    /// The constant of [`Kind::Scaled`], [`Kind::Shifted`] and [`Kind::Constant`].
    pub constant: Option<ExprId>,
    pub users: Vec<Place>,
    pub is_root: bool,
}

/// All terms that some roots depend on, operands before their users.
#[derive(Clone, Debug)]
pub struct Terms {
    pub all: Vec<Term>,
    pub roots: Vec<Operand>,
}

impl Terms {
    pub fn of(graph: &Graph, roots: &[ExprId]) -> Self {
        let uses = Uses::count(graph, roots);
        let mut places: ByExpr<Operand> = ByExpr::default();
        let mut terms = Self { all: Vec::new(), roots: Vec::new() };
        let quotients = reciprocals_of_quotients(graph, &uses);
        for &id in &uses.order {
            let operand = match graph.node(id) {
                // Part of a quotient.
                Node::Recip(_) if quotients.contains(&id) => continue,
                Node::Neg(a) => Operand { is_negative: !places[*a].is_negative, ..places[*a] },
                node => {
                    let term = terms.term(graph, (id, node), &uses, &places);
                    Operand { term, is_negative: false }
                }
            };
            places.insert(id, operand);
        }
        terms.roots = roots.iter().map(|root| places[*root]).collect();
        for root in terms.roots.clone() {
            terms.all[root.term].is_root = true;
        }
        terms
    }

    fn term(
        &mut self,
        graph: &Graph,
        (id, node): (ExprId, &Node),
        uses: &Uses,
        places: &ByExpr<Operand>,
    ) -> Place {
        let is_constant = |id: &ExprId| graph.as_constant(*id).is_some();
        let (kind, constant) = match node {
            Node::Constant(_) => (Kind::Constant, Some(id)),
            Node::Symbol(symbol) => {
                let (of, component, _) = variable(*symbol);
                (Kind::Variable { of, component }, None)
            }
            Node::Mul(a, b) if uses.quotient(graph, *a, *b).is_some() => (Kind::Quotient, None),
            Node::Add(a, b) | Node::Mul(a, b) => {
                let constant = [*a, *b].into_iter().find(is_constant);
                let kind = match (node, constant) {
                    (Node::Add(..), None) => Kind::Sum,
                    (Node::Add(..), Some(_)) => Kind::Shifted,
                    (_, None) => Kind::Product,
                    (_, Some(_)) => Kind::Scaled,
                };
                (kind, constant)
            }
            Node::Recip(_) => (Kind::Reciprocal, None),
            Node::Call(function, _) => (Kind::Call(*function), None),
            Node::Neg(_) => unreachable!("signs belong to operands"),
        };
        let place = self.all.len();
        let absorbed = |operand: &ExprId| kind.is_operation() && Some(*operand) == constant;
        let operands: Operands = match node {
            Node::Mul(a, b) if kind == Kind::Quotient => {
                let (above, below) = uses.quotient(graph, *a, *b).expect("it is a quotient");
                [above, below].into_iter().map(|id| places[id]).collect()
            }
            _ => node.operands().filter(|o| !absorbed(o)).map(|operand| places[operand]).collect(),
        };
        for (slot, operand) in operands.iter().enumerate() {
            // The factors of a square have one user.
            if !operands[..slot].iter().any(|before| before.term == operand.term) {
                self.all[operand.term].users.push(place);
            }
        }
        self.all.push(Term { id, kind, operands, constant, users: Vec::new(), is_root: false });
        place
    }
}

/// What a variable is, which component, and of which body, joint or the like.
pub fn variable(symbol: Symbol) -> (u8, usize, usize) {
    match symbol {
        Symbol::Time => (0, 0, 0),
        Symbol::Position { moving_body, k } => (1, k, moving_body),
        Symbol::Euler { moving_body, k } => (2, k, moving_body),
        Symbol::Velocity { moving_body, k } => (3, k, moving_body),
        Symbol::Spin { moving_body, k } => (4, k, moving_body),
        Symbol::Chart { chart, k } => (5, k, chart),
        Symbol::Parameter(place) => (6, 0, place),
        Symbol::ParameterSetup(place) => (7, 0, place),
        Symbol::Input(place) => (8, 0, place),
        Symbol::State(place) => (25, 0, place),
        Symbol::Turn(place) => (9, 0, place),
        Symbol::Angle(place) => (10, 0, place),
        Symbol::Table { table, order } => (11, order, table),
        Symbol::Acceleration { moving_body, k } => (12, k, moving_body),
        Symbol::LoopMultiplier(place) => (13, 0, place),
        Symbol::Change(place) => (14, 0, place),
        Symbol::Coordinate(place) => (15, 0, place),
        Symbol::Rate(place) => (16, 0, place),
        Symbol::RateOfRate(place) => (17, 0, place),
        Symbol::Sine(place) => (18, 0, place),
        Symbol::Cosine(place) => (19, 0, place),
        Symbol::Unit(place) => (24, 0, place),
        Symbol::Rotation { moving_body, row, column } => (20, 3 * row + column, moving_body),
        Symbol::Relative { joint, row, column } => (21, 3 * row + column, joint),
        Symbol::RotationRate { moving_body, row, column } => (22, 3 * row + column, moving_body),
        Symbol::RelativeRate { joint, row, column } => (23, 3 * row + column, joint),
        Symbol::Entry { .. } | Symbol::Local(_) => unreachable!("there are no loops yet"),
    }
}

fn reciprocals_of_quotients(graph: &Graph, uses: &Uses) -> HashSet<ExprId> {
    let products = uses.order.iter().filter_map(|&id| match graph.node(id) {
        Node::Mul(a, b) => {
            let (_, below) = uses.quotient(graph, *a, *b)?;
            [*a, *b].into_iter().find(|id| matches!(graph.node(*id), Node::Recip(x) if *x == below))
        }
        _ => None,
    });
    products.collect()
}
