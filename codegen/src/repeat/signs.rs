//! Signs: of which terms a loop computes the opposite, so that one formula serves all parts. Rounding is symmetric, so
//! opposites have the same digits.
//!
//! Each unknown is zero or one; a sum asks that two of its terms have the same signs for all parts, and a product has
//! those of its factors. The equations are linear in integers modulo two.

use super::columns::{Columns, Source};
use super::loops::Loops;
use super::orbits::{Orbit, Orbits};
use super::terms::{Kind, Place, Terms};
use gyro_program::elementary::Parity;
use rustc_hash::FxHashMap as HashMap;

/// A sum of unknowns, in ascending order, and one if the second part is true, modulo two.
type Form = (Vec<usize>, bool);

#[derive(Default)]
struct Equations {
    /// What each unknown is in terms of later ones, once that is known.
    solved: Vec<Option<Form>>,
}

/// The signs of a kernel's loops: true for opposites.
#[derive(Debug)]
pub struct Signs {
    /// Of terms that are computed in loops.
    pub of_term: Vec<bool>,
    /// Of rows that are filled outside of loops.
    pub of_row: HashMap<(usize, i64), bool>,
    /// Of the operands of orbits where they are not part of a product.
    pub of_operand: HashMap<(Orbit, usize), bool>,
}

impl Signs {
    /// `None` if no formula serves all parts.
    pub fn solve(terms: &Terms, orbits: &Orbits, loops: &Loops, columns: &Columns) -> Option<Self> {
        let mut equations = Equations::default();
        let mut of_term: Vec<Option<Form>> = vec![None; terms.all.len()];
        let mut of_row: HashMap<(usize, i64), Form> = HashMap::default();
        let mut of_operand: HashMap<(Orbit, usize), Form> = HashMap::default();
        for index in 0..loops.all.len() {
            for (k, part) in loops.parts(index).into_iter().enumerate() {
                let is_first = k == 0;
                let members = loops.all[index].orbits.iter();
                let mut members: Vec<(Place, Orbit)> =
                    members.map(|&orbit| (loops.member(orbits, orbit, part), orbit)).collect();
                members.sort_unstable();
                for (term, orbit) in members {
                    let mut given = Vec::new();
                    for (operand, source) in orbits.operands[term].iter().zip(&columns.sources[&orbit]) {
                        let mut form = match source {
                            Source::Local(_) => of_term[operand.term].clone()?,
                            Source::Row { column, offset } => {
                                let row = part + offset;
                                if columns.is_computed(loops, orbits, *column, row) {
                                    of_term[operand.term].clone()?
                                } else {
                                    let fresh = || equations.unknown();
                                    of_row.entry((*column, row)).or_insert_with(fresh).clone()
                                }
                            }
                            Source::Element { .. } | Source::Same(_) => (Vec::new(), false),
                        };
                        form.1 ^= operand.is_negative;
                        given.push(equations.reduced(form));
                    }
                    // What the first part has, all have: an orbit and its opposite serve equally well.
                    let mut operand = |slot: usize| {
                        let form = of_operand.entry((orbit, slot)).or_insert_with(|| given[slot].clone());
                        *form = equations.reduced(std::mem::take(form));
                        form.clone()
                    };
                    let form = match terms.all[term].kind {
                        Kind::Sum => {
                            let [one, other] = [0, 1].map(|slot| plus(&operand(slot), &given[slot]));
                            equations.equate(&one, &other)?;
                            one
                        }
                        Kind::Shifted => plus(&operand(0), &given[0]),
                        Kind::Product | Kind::Quotient => plus(&given[0], &given[1]),
                        Kind::Scaled if is_first => (Vec::new(), false),
                        Kind::Scaled => equations.unknown(),
                        Kind::Reciprocal => given[0].clone(),
                        Kind::Call(function) => {
                            let parity = function.properties().parity;
                            let same = usize::from(parity != Parity::Neither)..given.len();
                            let firsts: Vec<Form> = same.clone().map(&mut operand).collect();
                            for (slot, first) in same.zip(firsts) {
                                equations.equate(&first, &given[slot])?;
                            }
                            if parity == Parity::Odd { given[0].clone() } else { (Vec::new(), false) }
                        }
                        Kind::Variable { .. } | Kind::Constant => return None,
                    };
                    let form = equations.reduced(form);
                    of_term[term] = Some(form);
                }
            }
        }
        let values = equations.values();
        let value = |form: &Form| sum(&values, form);
        Some(Self {
            of_term: of_term.iter().map(|form| form.as_ref().is_some_and(value)).collect(),
            of_row: of_row.iter().map(|(&key, form)| (key, value(form))).collect(),
            of_operand: of_operand.iter().map(|(&key, form)| (key, value(form))).collect(),
        })
    }
}

fn plus(one: &Form, other: &Form) -> Form {
    let (mut a, mut b) = (one.0.iter().peekable(), other.0.iter().peekable());
    let mut sum = Vec::new();
    loop {
        match (a.peek(), b.peek()) {
            (Some(x), Some(y)) if x == y => {
                a.next();
                b.next();
            }
            (Some(x), Some(y)) if x < y => sum.extend(a.next()),
            (Some(_), None) => sum.extend(a.next()),
            (_, Some(_)) => sum.extend(b.next()),
            (None, None) => return (sum, one.1 ^ other.1),
        }
    }
}

/// A form's value, given those of unknowns.
fn sum(values: &[bool], (unknowns, one): &Form) -> bool {
    unknowns.iter().fold(*one, |sum, &unknown| sum ^ values[unknown])
}

impl Equations {
    fn unknown(&mut self) -> Form {
        self.solved.push(None);
        (vec![self.solved.len() - 1], false)
    }

    /// In terms of what is not solved for.
    fn reduced(&mut self, form: Form) -> Form {
        if !self.knows_some(&form) {
            return form;
        }
        for &unknown in &form.0 {
            self.settle(unknown);
        }
        self.substituted(&form)
    }

    /// Writes an unknown that is solved for, and those on the way, in terms of what is not: none of them is gone
    /// through again.
    fn settle(&mut self, unknown: usize) {
        let mut open = vec![unknown];
        while let Some(&unknown) = open.last() {
            let Some(form) = &self.solved[unknown] else { return };
            let is_open =
                |&&inner: &&usize| self.solved[inner].as_ref().is_some_and(|form| self.knows_some(form));
            if let Some(&inner) = form.0.iter().find(is_open) {
                open.push(inner);
                continue;
            }
            if self.knows_some(form) {
                self.solved[unknown] = Some(self.substituted(form));
            }
            open.pop();
        }
    }

    /// Whether some of a form is solved for.
    fn knows_some(&self, form: &Form) -> bool {
        form.0.iter().any(|&unknown| self.solved[unknown].is_some())
    }

    /// With what is solved for replaced, once.
    fn substituted(&self, form: &Form) -> Form {
        let (mut all, mut one) = (Vec::with_capacity(form.0.len()), form.1);
        for &unknown in &form.0 {
            match &self.solved[unknown] {
                Some(known) => {
                    all.extend(&known.0);
                    one ^= known.1;
                }
                None => all.push(unknown),
            }
        }
        // A few runs that are in order each.
        all.sort();
        let odd = all.chunk_by(|a, b| a == b).filter(|same| same.len() % 2 == 1).map(|same| same[0]);
        (odd.collect(), one)
    }

    /// The values of all unknowns; those that are not solved for are zero.
    fn values(&self) -> Vec<bool> {
        let mut values = vec![false; self.solved.len()];
        for (unknown, form) in self.solved.iter().enumerate().rev() {
            values[unknown] = form.as_ref().is_some_and(|form| sum(&values, form));
        }
        values
    }

    /// The oldest unknown yields: what comes later is then in terms of what is near.
    fn equate(&mut self, one: &Form, other: &Form) -> Option<()> {
        let mut form = self.reduced(plus(one, other));
        if form.0.is_empty() {
            return (!form.1).then_some(());
        }
        let unknown = form.0.remove(0);
        self.solved[unknown] = Some(form);
        Some(())
    }
}
