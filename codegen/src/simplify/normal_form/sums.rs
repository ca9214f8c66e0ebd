//! A system of sums of products that use each other: between polynomials and a program.

use super::expand::{Atom, Expansion};
use super::polynomial::{Literal, Monomial, Polynomial};
use crate::expr::constant::Constant;
use crate::expr::graph::{ExprId, Graph};
use crate::expr::symbol::Symbol;
use gyro_program::elementary::Function;
use rustc_hash::FxHashMap as HashMap;
use std::rc::Rc;

/// A positive constant, by its place in [`Scales`]. Equal constants have one place.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Scale(usize);

/// A quotient of scales to twelve digits, all that a search for equal ones needs. What is found is checked exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Ratio(u64);

impl Ratio {
    pub const ONE: Self = Self(Self::bucket(1.0));

    pub fn new(value: f64) -> Self {
        Self(Self::bucket(value))
    }

    pub fn bits(self) -> u64 {
        self.0
    }

    /// Rounds to forty bits; a ratio of small whole numbers is not near a limit between buckets.
    const fn bucket(value: f64) -> u64 {
        (value.to_bits() + (1 << 12)) >> 13
    }
}

/// The positive constants in use.
#[derive(Clone, Debug)]
pub struct Scales {
    values: Vec<(Constant, f64)>,
    index: HashMap<Constant, Scale>,
}

impl Scales {
    pub const ONE: Scale = Scale(0);

    fn new() -> Self {
        let mut scales = Self { values: Vec::new(), index: HashMap::default() };
        scales.intern(Constant::integer(1));
        scales
    }

    pub fn intern(&mut self, value: Constant) -> Scale {
        if let Some(&scale) = self.index.get(&value) {
            return scale;
        }
        let scale = Scale(self.values.len());
        self.index.insert(value.clone(), scale);
        let nearest = value.to_f64();
        self.values.push((value, nearest));
        scale
    }

    pub fn value(&self, scale: Scale) -> &Constant {
        &self.values[scale.0].0
    }

    pub fn nearest(&self, scale: Scale) -> f64 {
        self.values[scale.0].1
    }

    pub fn ratio(&self, a: Scale, b: Scale) -> Ratio {
        if a == b { Ratio::ONE } else { Ratio::new(self.nearest(a) / self.nearest(b)) }
    }

    pub fn div(&mut self, a: Scale, b: Scale) -> Scale {
        if a == b {
            return Self::ONE;
        }
        if b == Self::ONE {
            return a;
        }
        let inverse = self.value(b).recip().expect("a scale is positive");
        let quotient = self.value(a).mul(&inverse);
        self.intern(quotient)
    }

    pub fn mul(&mut self, a: Scale, b: Scale) -> Scale {
        let product = self.value(a).mul(self.value(b));
        self.intern(product)
    }

    /// The sum of two signed constants, if it is a constant of this form: its sign and magnitude, or nothing for zero.
    pub fn sum(&mut self, a: (bool, Scale), b: (bool, Scale)) -> Option<Option<(bool, Scale)>> {
        let signed = |(negative, scale): (bool, Scale)| {
            if negative { self.value(scale).neg() } else { self.value(scale).clone() }
        };
        let sum = signed(a).add(&signed(b))?;
        Some((!sum.is_zero()).then(|| (sum.is_negative(), self.intern(sum.abs()))))
    }
}

/// A signed scale times a product of literals with positive exponents.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Term {
    pub negative: bool,
    pub scale: Scale,
    pub monomial: Monomial,
}

impl Term {
    /// Multiplications, if nothing is shared.
    pub fn cost(&self) -> usize {
        (self.monomial.degree() + usize::from(self.scale != Scales::ONE)).saturating_sub(1)
    }
}

/// Place of a sum in [`Sums`].
pub type SumId = usize;

/// What a literal of a system stands for.
#[derive(Clone, Debug)]
pub enum Value {
    Symbol(Symbol),
    Function(Function, Vec<SumId>),
    Recip(SumId),
    Sum(SumId),
}

#[derive(Clone, Debug)]
pub struct Sums {
    pub scales: Scales,
    pub literals: Vec<Value>,
    pub sums: Vec<Vec<Term>>,
    /// The first sums are the roots.
    pub roots: usize,
}

impl Sums {
    pub fn new(expansion: &Expansion, roots: &[Rc<Polynomial>]) -> Self {
        let system =
            Self { scales: Scales::new(), literals: Vec::new(), sums: Vec::new(), roots: roots.len() };
        let mut lowering = Lowering { atoms: &expansion.atoms, places: HashMap::default(), system };
        lowering.system.sums.resize(roots.len(), Vec::new());
        for (at, root) in roots.iter().enumerate() {
            lowering.system.sums[at] = lowering.terms(root);
        }
        lowering.system
    }

    pub fn define(&mut self, value: Value) -> Literal {
        self.literals.push(value);
        self.literals.len() - 1
    }

    /// The roots as expressions of a graph.
    pub fn build(&self, graph: &mut Graph) -> Vec<ExprId> {
        let mut building = Building { system: self, graph, literals: HashMap::default() };
        (0..self.roots).map(|root| building.sum(root)).collect()
    }
}

/// Gives the literals of an expansion, and their reciprocals, places in a system.
struct Lowering<'a> {
    atoms: &'a [Atom],
    /// By literal and whether it is divided by.
    places: HashMap<(Literal, bool), Literal>,
    system: Sums,
}

impl Lowering<'_> {
    fn terms(&mut self, polynomial: &Polynomial) -> Vec<Term> {
        polynomial.terms().map(|(coefficient, monomial)| self.term(coefficient, monomial)).collect()
    }

    fn term(&mut self, coefficient: &Constant, monomial: &Monomial) -> Term {
        let mut lowered = Monomial::one();
        for (literal, exponent) in monomial.powers() {
            let place = self.literal(literal, exponent < 0);
            lowered = lowered.mul(&Monomial::power(place, exponent.abs()));
        }
        let scale = self.system.scales.intern(coefficient.abs());
        Term { negative: coefficient.is_negative(), scale, monomial: lowered }
    }

    fn literal(&mut self, literal: Literal, divided: bool) -> Literal {
        if let Some(&place) = self.places.get(&(literal, divided)) {
            return place;
        }
        let value = match (&self.atoms[literal], divided) {
            (Atom::Sum(sum), true) => Value::Recip(self.sum(sum)),
            (_, true) => Value::Recip(self.sum(&Polynomial::literal(literal))),
            (Atom::Symbol(symbol), false) => Value::Symbol(*symbol),
            (Atom::Function(function, operands), false) => {
                Value::Function(*function, operands.iter().map(|operand| self.sum(operand)).collect())
            }
            (Atom::Sum(sum), false) => Value::Sum(self.sum(sum)),
        };
        let place = self.system.define(value);
        self.places.insert((literal, divided), place);
        place
    }

    fn sum(&mut self, polynomial: &Polynomial) -> SumId {
        let terms = self.terms(polynomial);
        self.system.sums.push(terms);
        self.system.sums.len() - 1
    }
}

/// Writes a system into a graph, each literal once.
struct Building<'a> {
    system: &'a Sums,
    graph: &'a mut Graph,
    literals: HashMap<Literal, ExprId>,
}

impl Building<'_> {
    fn sum(&mut self, sum: SumId) -> ExprId {
        let terms: Vec<_> = self.system.sums[sum].iter().map(|term| self.term(term)).collect();
        terms.into_iter().fold(Graph::ZERO, |sum, term| self.graph.add(sum, term))
    }

    fn term(&mut self, term: &Term) -> ExprId {
        let mut product = Graph::ONE;
        for (literal, exponent) in term.monomial.powers() {
            let value = self.literal(literal);
            for _ in 0..exponent {
                product = self.graph.mul(product, value);
            }
        }
        let scale = self.system.scales.value(term.scale);
        let scale = if term.negative { scale.neg() } else { scale.clone() };
        let scale = self.graph.constant(scale);
        self.graph.mul(scale, product)
    }

    fn literal(&mut self, literal: Literal) -> ExprId {
        if let Some(&built) = self.literals.get(&literal) {
            return built;
        }
        let built = match &self.system.literals[literal] {
            Value::Symbol(symbol) => self.graph.symbol(*symbol),
            Value::Sum(sum) => self.sum(*sum),
            Value::Recip(sum) => {
                let sum = self.sum(*sum);
                self.graph.recip(sum)
            }
            Value::Function(function, operands) => {
                let operands: Vec<_> = operands.iter().map(|&operand| self.sum(operand)).collect();
                self.graph.call(*function, [operands[0], operands[operands.len() - 1]])
            }
        };
        self.literals.insert(literal, built);
        built
    }
}
