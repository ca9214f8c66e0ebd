//! Formulas written down instead of computed.
//!
//! The textbook runs over [`Term`]s, which only note what is done to them, and the module's programs are copied to the
//! same [`Tape`]. What comes of it is one straight-line program, the same for all points, and is then run over any
//! field. Nothing that a module writes is simplified; of the textbook's own sums and products those with a zero or a
//! one are left out.

use crate::atoms::Atoms;
use crate::field::{Constant, Field};
use crate::interpreter::{Environment, value};
use crate::program::{Function, Id, Node, Program, Source};
use gyro_model::{Rational, Spline, to_f64};
use num_traits::{One, Zero};
use std::cell::RefCell;
use std::collections::HashMap;
use std::fmt;
use std::hash::{BuildHasherDefault, Hasher};

/// What was written down.
#[derive(Debug, Default)]
pub struct Formulas {
    /// Operands come before their users; no operation is there twice. Lines are those of the module, zero of the
    /// textbook.
    pub program: Program,
    /// The numbers that [`Node::Constant`] names.
    pub constants: Vec<Constant>,
    /// The tables that [`Node::Curve`] names.
    pub tables: Vec<Spline>,
}

/// Where formulas are written down.
#[derive(Default)]
pub struct Tape {
    formulas: RefCell<Formulas>,
    known: RefCell<HashMap<Node, Id, BuildHasherDefault<Mixer>>>,
    places: RefCell<HashMap<(Rational, Option<Rational>), usize>>,
}

/// A hash of a few small numbers: millions of nodes are looked up, and nobody chooses them to collide.
#[derive(Default)]
struct Mixer(u64);

impl Hasher for Mixer {
    fn write(&mut self, bytes: &[u8]) {
        bytes.iter().for_each(|&byte| self.write_usize(byte.into()));
    }

    fn write_usize(&mut self, number: usize) {
        // An odd number near 2^64 divided by the golden ratio.
        self.0 = (self.0.rotate_left(5) ^ number as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    }

    fn finish(&self) -> u64 {
        self.0 ^ (self.0 >> 32)
    }
}

/// A place on a tape: a number of which only the formula is known.
#[derive(Clone, Copy)]
pub struct Term<'t> {
    id: Id,
    tape: &'t Tape,
}

/// Zero and one are written down first.
const ZERO: Id = 0;
const ONE: Id = 1;

impl Tape {
    /// Nothing written yet but zero and one.
    pub fn new() -> Self {
        let tape = Self::default();
        for (place, value) in [(ZERO, Rational::zero()), (ONE, Rational::one())] {
            let literal = to_f64(&value);
            let id = tape.constant(&Constant { literal, factor: value, radicand: None }).id;
            assert_eq!(id, place, "zero and one come first");
        }
        tape
    }

    /// What was written.
    pub fn finish(self) -> Formulas {
        self.formulas.into_inner()
    }

    /// What some of it is at a point; `None` of what divides by zero.
    pub fn evaluate<F: Field>(
        &self,
        terms: &[Term<'_>],
        context: F::Context,
        atoms: &dyn Atoms<F>,
        read: &dyn Fn(Source) -> F,
    ) -> Vec<Option<F>> {
        let formulas = self.formulas.borrow();
        let needed = formulas.reach(terms.iter().map(|term| term.id));
        let values = formulas.evaluate(&needed, context, atoms, read);
        terms.iter().map(|term| values[term.id].clone()).collect()
    }

    /// Something given.
    pub fn read(&self, source: Source) -> Term<'_> {
        self.note(Node::Read(source), 0)
    }

    /// The nodes of a program of a module, whose reads are given as terms. Accelerations, charts and states are what
    /// the terms say.
    pub fn copy<'t>(
        &'t self,
        program: &Program,
        constants: &[Constant],
        tables: &[Spline],
        read: &dyn Fn(Source) -> Term<'t>,
    ) -> Vec<Term<'t>> {
        let mut ids: Vec<Id> = Vec::with_capacity(program.nodes.len());
        for (node, &line) in program.nodes.iter().zip(&program.lines) {
            let term = match *node {
                Node::Constant(place) => self.constant(&constants[place]),
                Node::Read(source) => read(source),
                Node::Curve { table, order, time } => {
                    self.note(Node::Curve { table: self.table(&tables[table]), order, time: ids[time] }, line)
                }
                node => self.note(node.with_operands(|id| ids[id]), line),
            };
            ids.push(term.id);
        }
        ids.into_iter().map(|id| Term { id, tape: self }).collect()
    }

    fn note(&self, node: Node, line: usize) -> Term<'_> {
        let push = || self.formulas.borrow_mut().program.push(node, line);
        let id = *self.known.borrow_mut().entry(node).or_insert_with(push);
        Term { id, tape: self }
    }

    fn constant(&self, constant: &Constant) -> Term<'_> {
        let push = || {
            let constants = &mut self.formulas.borrow_mut().constants;
            constants.push(constant.clone());
            constants.len() - 1
        };
        let key = (constant.factor.clone(), constant.radicand.clone());
        let place = *self.places.borrow_mut().entry(key).or_insert_with(push);
        self.note(Node::Constant(place), 0)
    }

    fn table(&self, table: &Spline) -> usize {
        let tables = &mut self.formulas.borrow_mut().tables;
        tables.iter().position(|known| known == table).unwrap_or_else(|| {
            tables.push(table.clone());
            tables.len() - 1
        })
    }
}

impl Formulas {
    /// Of each node whether some results depend on it.
    pub fn reach(&self, results: impl IntoIterator<Item = Id>) -> Vec<bool> {
        let nodes = &self.program.nodes;
        let mut reached = vec![false; nodes.len()];
        results.into_iter().for_each(|id| reached[id] = true);
        for id in (0..nodes.len()).rev() {
            if reached[id] {
                nodes[id].operands().for_each(|operand| reached[operand] = true);
            }
        }
        reached
    }

    /// Only what some results depend on, and where these are in it.
    pub fn part(&self, results: impl Iterator<Item = Id> + Clone) -> (Self, Vec<Id>) {
        let mut places = vec![0; self.program.nodes.len()];
        let mut part = Self { tables: self.tables.clone(), ..Self::default() };
        let reached = self.reach(results.clone());
        for id in (0..places.len()).filter(|&id| reached[id]) {
            let node = match self.program.nodes[id] {
                Node::Constant(place) => {
                    part.constants.push(self.constants[place].clone());
                    Node::Constant(part.constants.len() - 1)
                }
                node => node.with_operands(|operand| places[operand]),
            };
            places[id] = part.program.push(node, self.program.lines[id]);
        }
        (part, results.map(|id| places[id]).collect())
    }

    /// The values of the nodes that are needed; `None` of others, and where something divides by zero.
    pub fn evaluate<F: Field>(
        &self,
        needed: &[bool],
        context: F::Context,
        atoms: &dyn Atoms<F>,
        read: &dyn Fn(Source) -> F,
    ) -> Vec<Option<F>> {
        let constants: Vec<F> = self.constants.iter().map(|c| F::constant(context, c)).collect();
        let environment = Environment { constants: &constants, tables: &self.tables, atoms, read };
        let mut values: Vec<Option<F>> = Vec::with_capacity(needed.len());
        for (node, needed) in self.program.nodes.iter().zip(needed) {
            let exists = *needed && node.operands().all(|operand| values[operand].is_some());
            let operand = |id: Id| values[id].as_ref().expect("all operands exist");
            let value = if exists { value(node, &operand, &environment) } else { None };
            values.push(value);
        }
        values
    }

    /// Line of the module where a value that does not exist is divided by zero; `None` if the textbook does so.
    pub fn culprit<F: Field>(&self, values: &[Option<F>], mut id: Id) -> Option<usize> {
        while let Some(operand) = self.program.nodes[id].operands().find(|&operand| values[operand].is_none())
        {
            id = operand;
        }
        Some(self.program.lines[id]).filter(|line| *line > 0)
    }
}

impl<'t> Term<'t> {
    /// Its place in the program.
    pub fn id(self) -> Id {
        self.id
    }

    fn note(self, node: Node) -> Self {
        self.tape.note(node, 0)
    }

    fn is_one(self) -> bool {
        self.id == ONE
    }
}

impl PartialEq for Term<'_> {
    fn eq(&self, other: &Self) -> bool {
        self.id == other.id
    }
}

impl fmt::Debug for Term<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "node {}", self.id)
    }
}

impl fmt::Debug for Tape {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a tape of {} nodes", self.formulas.borrow().program.nodes.len())
    }
}

impl<'t> Field for Term<'t> {
    type Context = &'t Tape;

    fn from_rational(tape: Self::Context, value: &Rational) -> Self {
        tape.constant(&Constant { literal: to_f64(value), factor: value.clone(), radicand: None })
    }

    fn sqrt_rational(tape: Self::Context, value: &Rational) -> Self {
        let literal = libm::sqrt(to_f64(value));
        tape.constant(&Constant { literal, factor: Rational::one(), radicand: Some(value.clone()) })
    }

    fn constant(tape: Self::Context, constant: &Constant) -> Self {
        tape.constant(constant)
    }

    fn add(&self, other: &Self) -> Self {
        match (self.is_zero(), other.is_zero()) {
            (true, _) => *other,
            (_, true) => *self,
            _ => self.note(Node::Add(self.id, other.id)),
        }
    }

    fn sub(&self, other: &Self) -> Self {
        match (self.is_zero(), other.is_zero()) {
            (_, true) => *self,
            (true, _) => other.neg(),
            _ => self.note(Node::Sub(self.id, other.id)),
        }
    }

    fn mul(&self, other: &Self) -> Self {
        match (self, other) {
            (zero, _) | (_, zero) if zero.is_zero() => *zero,
            (one, x) | (x, one) if one.is_one() => *x,
            _ => self.note(Node::Mul(self.id, other.id)),
        }
    }

    fn neg(&self) -> Self {
        if self.is_zero() { *self } else { self.note(Node::Neg(self.id)) }
    }

    fn inv(&self) -> Option<Self> {
        (!self.is_zero()).then(|| self.note(Node::Div(ONE, self.id)))
    }

    fn div(&self, other: &Self) -> Option<Self> {
        (!other.is_zero()).then(|| self.note(Node::Div(self.id, other.id)))
    }

    /// Whether it is the number zero; whether a formula is zero everywhere is not known here.
    fn is_zero(&self) -> bool {
        self.id == ZERO
    }
}

/// Functions that are written down.
#[derive(Clone, Copy, Debug)]
pub struct Written;

impl<'t> Atoms<Term<'t>> for Written {
    fn call(&self, function: Function, operands: [&Term<'t>; 2]) -> Term<'t> {
        operands[0].note(Node::Call(function, operands.map(|x| x.id)))
    }

    fn spline(&self, table: &Spline, t: &Term<'t>) -> [Term<'t>; 4] {
        let table = t.tape.table(table);
        [0, 1, 2, 3].map(|order| t.note(Node::Curve { table, order, time: t.id }))
    }
}
