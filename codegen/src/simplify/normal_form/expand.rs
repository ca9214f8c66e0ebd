//! From expressions to polynomials: the graph is walked once from its leaves, and each node becomes a polynomial over
//! literals, reduced by what is known of their powers.

use super::polynomial::{Literal, Monomial, Polynomial};
use crate::expr::constant::Constant;
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::symbol::Symbol;
use gyro_program::elementary::{Function, Parity, Properties};
use rustc_hash::FxHashMap as HashMap;
use std::rc::Rc;

/// What a literal stands for.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub enum Atom {
    Symbol(Symbol),
    Function(Function, Vec<Polynomial>),
    /// A sum that something is divided by: it occurs with negative exponents only.
    Sum(Polynomial),
}

/// The power of a literal that is replaced, and by what.
#[derive(Debug)]
struct Rule {
    exponent: i32,
    value: Rc<Polynomial>,
    used: bool,
}

/// The polynomials of a graph's nodes.
#[derive(Debug)]
pub struct Expansion<'a> {
    graph: &'a Graph,
    pub atoms: Vec<Atom>,
    index: HashMap<Atom, Literal>,
    rules: HashMap<Literal, Rule>,
    memo: HashMap<ExprId, Rc<Polynomial>>,
    /// How many more terms may be worked out.
    terms: &'a mut usize,
}

impl<'a> Expansion<'a> {
    pub fn new(graph: &'a Graph, terms: &'a mut usize) -> Self {
        Self {
            graph,
            atoms: Vec::new(),
            index: HashMap::default(),
            rules: HashMap::default(),
            memo: HashMap::default(),
            terms,
        }
    }

    /// From now on the square of `reduced` is one minus the squares of `others`. `None` if this is too large.
    pub fn relate(&mut self, reduced: ExprId, others: &[ExprId]) -> Option<()> {
        let mut square = Polynomial::term(Constant::integer(1), Monomial::one());
        for &other in others {
            let value = self.of(other)?;
            let other_square = self.product(&value, &value)?;
            square.add(&other_square.scale(&Constant::integer(-1)));
        }
        // What follows from earlier relations, such as cos² = 1 − sin² where sin² = 1 − cos² is known, replaces
        // nothing.
        let says_more = |literal: Literal| {
            let has_square = |(_, m): (&Constant, &Monomial)| m.powers().any(|(l, e)| l == literal && e >= 2);
            !square.terms().any(has_square)
        };
        if let Some(literal) = self.literal_of(reduced)?.filter(|&literal| says_more(literal)) {
            self.rules.insert(literal, Rule { exponent: 2, value: Rc::new(square), used: false });
        }
        Some(())
    }

    /// Whether anything was replaced by the relation for `reduced`.
    pub fn was_used(&mut self, reduced: ExprId) -> bool {
        let literal = self.literal_of(reduced).flatten();
        literal.and_then(|literal| self.rules.get(&literal)).is_some_and(|rule| rule.used)
    }

    /// How many terms of denominators, and of what else will be divided by, are subtracted from others although they
    /// cannot be negative: where they come close, digits are lost. A parameter (a mass, a moment of inertia) counts as
    /// positive.
    pub fn cancellations<'p>(&self, divisors: impl Iterator<Item = &'p Polynomial>) -> usize {
        let is_parameter =
            |literal: Literal| matches!(self.atoms[literal], Atom::Symbol(Symbol::Parameter(_)));
        let cannot_be_negative =
            |monomial: &Monomial| monomial.powers().all(|(literal, e)| e % 2 == 0 || is_parameter(literal));
        let in_one = |denominator: &Polynomial| {
            let squares = denominator.terms().filter(|(_, monomial)| cannot_be_negative(monomial));
            let (negative, positive): (Vec<_>, Vec<_>) = squares.partition(|(c, _)| c.is_negative());
            negative.len().min(positive.len())
        };
        let denominators = self.atoms.iter().filter_map(|atom| match atom {
            Atom::Sum(denominator) => Some(in_one(denominator)),
            _ => None,
        });
        denominators.sum::<usize>() + divisors.map(in_one).sum::<usize>()
    }

    /// The literal that an expression is, if it is one.
    fn literal_of(&mut self, expression: ExprId) -> Option<Option<Literal>> {
        let value = self.of(expression)?;
        let monomial = value.single_term().map(|(_, monomial)| monomial).filter(|m| m.degree() == 1);
        Some(
            monomial
                .and_then(|monomial| monomial.powers().find(|&(_, e)| e == 1))
                .map(|(literal, _)| literal),
        )
    }

    /// `None` if the polynomial is too large, or divides by zero.
    pub fn of(&mut self, root: ExprId) -> Option<Rc<Polynomial>> {
        for id in self.graph.reachable(&[root]) {
            if !self.memo.contains_key(&id) {
                let polynomial = self.node(id)?;
                self.spend(polynomial.len())?;
                self.memo.insert(id, polynomial);
            }
        }
        Some(self.memo[&root].clone())
    }

    fn node(&mut self, id: ExprId) -> Option<Rc<Polynomial>> {
        let polynomial = match self.graph.node(id).clone() {
            Node::Constant(value) => Polynomial::term(value, Monomial::one()),
            Node::Symbol(symbol) => Polynomial::literal(self.literal(Atom::Symbol(symbol))),
            Node::Add(a, b) => {
                let mut sum = Polynomial::clone(&self.memo[&a]);
                sum.add(&self.memo[&b]);
                sum
            }
            Node::Mul(a, b) => self.product(&self.memo[&a].clone(), &self.memo[&b].clone())?,
            Node::Neg(a) => self.memo[&a].scale(&Constant::integer(-1)),
            Node::Recip(a) => self.reciprocal(&self.memo[&a].clone())?,
            Node::Call(Function::Sqrt, [a, _]) => self.root(&self.memo[&a].clone()),
            Node::Call(function, [a, _]) if function.arity() == 1 => self.function_of_one(function, a),
            Node::Call(function, operands) => {
                let operands = operands.map(|operand| Polynomial::clone(&self.memo[&operand]));
                self.function(function, operands.to_vec())
            }
        };
        Some(Rc::new(polynomial))
    }

    /// `None` if there is nothing left to spend.
    fn spend(&mut self, terms: usize) -> Option<()> {
        *self.terms = self.terms.checked_sub(terms)?;
        Some(())
    }

    fn literal(&mut self, atom: Atom) -> Literal {
        if let Some(&literal) = self.index.get(&atom) {
            return literal;
        }
        self.atoms.push(atom.clone());
        self.index.insert(atom, self.atoms.len() - 1);
        self.atoms.len() - 1
    }

    fn function(&mut self, function: Function, operands: Vec<Polynomial>) -> Polynomial {
        Polynomial::literal(self.literal(Atom::Function(function, operands)))
    }

    /// √x of a number may be exact; the square of any other root is its operand.
    fn root(&mut self, operand: &Rc<Polynomial>) -> Polynomial {
        if operand.len() == 0 {
            return Polynomial::default();
        }
        let constant = operand.single_term().filter(|(_, monomial)| monomial.degree() == 0);
        if let Some(root) = constant.and_then(|(value, _)| value.sqrt()) {
            return Polynomial::term(root, Monomial::one());
        }
        let literal = self.literal(Atom::Function(Function::Sqrt, vec![Polynomial::clone(operand)]));
        self.rules.insert(literal, Rule { exponent: 2, value: operand.clone(), used: false });
        Polynomial::literal(literal)
    }

    /// f(−x) = −f(x) or f(x): the operand's first coefficient is made positive.
    fn function_of_one(&mut self, function: Function, operand: ExprId) -> Polynomial {
        let (operand, minus) = (self.memo[&operand].clone(), Constant::integer(-1));
        let Properties { parity, at_zero, .. } = function.properties();
        match (operand.leading(), at_zero) {
            (None, Some(0)) => Polynomial::default(),
            (None, Some(value)) => Polynomial::term(Constant::integer(value), Monomial::one()),
            (Some(leading), _) if leading.is_negative() && parity != Parity::Neither => {
                let value = self.function(function, vec![operand.scale(&minus)]);
                if parity == Parity::Odd { value.scale(&minus) } else { value }
            }
            _ => self.function(function, vec![Polynomial::clone(&operand)]),
        }
    }

    /// A sum is divided by in the form that has a first coefficient of one and no divisions of its own, so that
    /// reciprocals of sums that agree up to a simple factor are one literal. `None` for zero.
    fn reciprocal(&mut self, operand: &Polynomial) -> Option<Polynomial> {
        if let Some((coefficient, monomial)) = operand.single_term() {
            return self.reduced(coefficient.recip()?, monomial.recip());
        }
        let factor = operand.divisions().recip();
        let denominator = self.product(operand, &Polynomial::term(Constant::integer(1), factor.clone()))?;
        if factor.degree() > 0 {
            // The divisions are gone: what is left may be a single term.
            let inverse = self.reciprocal(&denominator)?;
            return self.product(&inverse, &Polynomial::term(Constant::integer(1), factor));
        }
        let inverse = denominator.leading()?.recip()?;
        let denominator = denominator.scale(&inverse);
        let literal = self.literal(Atom::Sum(denominator.clone()));
        self.rules.insert(literal, Rule { exponent: 1, value: Rc::new(denominator), used: false });
        Some(Polynomial::term(inverse, Monomial::power(literal, -1)))
    }

    fn product(&mut self, a: &Polynomial, b: &Polynomial) -> Option<Polynomial> {
        let mut product = Polynomial::default();
        for (ca, ma) in a.terms() {
            for (cb, mb) in b.terms() {
                self.add_reduced(&mut product, ca.mul(cb), ma.mul(mb))?;
            }
        }
        Some(product)
    }

    fn reduced(&mut self, coefficient: Constant, monomial: Monomial) -> Option<Polynomial> {
        let mut sum = Polynomial::default();
        self.add_reduced(&mut sum, coefficient, monomial)?;
        Some(sum)
    }

    /// Adds a term in which the powers that have a rule are replaced, until none is left.
    fn add_reduced(&mut self, sum: &mut Polynomial, coefficient: Constant, monomial: Monomial) -> Option<()> {
        self.spend(1)?;
        let rule = monomial.powers().find_map(|(literal, exponent)| {
            self.rules.get(&literal).filter(|rule| exponent >= rule.exponent).map(|_| literal)
        });
        let Some((literal, rule)) = rule.and_then(|literal| Some((literal, self.rules.get_mut(&literal)?)))
        else {
            sum.add_term(coefficient, monomial);
            return Some(());
        };
        rule.used = true;
        let rest = monomial.div(&Monomial::power(literal, rule.exponent));
        for (c, m) in rule.value.clone().terms() {
            self.add_reduced(sum, coefficient.mul(c), rest.mul(m))?;
        }
        Some(())
    }
}
