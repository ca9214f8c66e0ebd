//! Polynomials with exact coefficients, in canonical form: equal polynomials are equal data.

use crate::expr::constant::Constant;
use crate::expr::domains::mix;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// Place of a factor in a table of what factors stand for.
pub type Literal = usize;

/// A product of powers of literals, in their order. A negative exponent is a division.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Monomial(Vec<(Literal, i32)>);

impl Monomial {
    pub fn one() -> Self {
        Self::default()
    }

    pub fn power(literal: Literal, exponent: i32) -> Self {
        Self(vec![(literal, exponent)])
    }

    pub fn powers(&self) -> impl Iterator<Item = (Literal, i32)> {
        self.0.iter().copied()
    }

    pub fn exponent(&self, literal: Literal) -> i32 {
        self.0.binary_search_by_key(&literal, |&(l, _)| l).map_or(0, |at| self.0[at].1)
    }

    /// Number of factors, powers written out.
    pub fn degree(&self) -> usize {
        self.0.iter().map(|&(_, exponent)| exponent.unsigned_abs() as usize).sum()
    }

    pub fn mul(&self, other: &Self) -> Self {
        self.merge(other, |a, b| a + b)
    }

    pub fn div(&self, other: &Self) -> Self {
        self.merge(other, |a, b| a - b)
    }

    pub fn recip(&self) -> Self {
        Self::one().div(self)
    }

    /// The smaller exponent of each literal, zero where there is none.
    pub fn lower(&self, other: &Self) -> Self {
        self.merge(other, i32::min)
    }

    /// Whether there is a literal in both.
    pub fn shares(&self, other: &Self) -> bool {
        self.0.iter().any(|&(literal, _)| other.exponent(literal) != 0)
    }

    /// A number for the product without its common factor with another: equal for equal products.
    pub fn hash_without(&self, other: &Self) -> u64 {
        let rests = self.0.iter().map(|&(literal, e)| (literal, e - e.min(other.exponent(literal))));
        let hashes = rests.filter(|&(_, e)| e != 0).map(|(literal, e)| mix(mix(literal as u64) ^ e as u64));
        hashes.fold(0, u64::wrapping_add)
    }

    /// Both sorted lists in one pass; exponents that become zero vanish.
    fn merge(&self, other: &Self, exponent: impl Fn(i32, i32) -> i32) -> Self {
        let (mut a, mut b) = (self.0.as_slice(), other.0.as_slice());
        let mut merged = Vec::with_capacity(a.len() + b.len());
        loop {
            let literal = match (a.first(), b.first()) {
                (Some(x), Some(y)) => x.0.min(y.0),
                (Some(x), None) => x.0,
                (None, Some(y)) => y.0,
                (None, None) => return Self(merged),
            };
            let (ea, eb) = (take(&mut a, literal), take(&mut b, literal));
            let power = exponent(ea, eb);
            if power != 0 {
                merged.push((literal, power));
            }
        }
    }
}

/// The exponent of a literal at the head of a list, taken off it.
fn take(list: &mut &[(Literal, i32)], literal: Literal) -> i32 {
    match list.split_first() {
        Some((&(head, exponent), rest)) if head == literal => {
            *list = rest;
            exponent
        }
        _ => 0,
    }
}

/// A sum of monomials. Constants with unlike roots do not add up, so a monomial may have several.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Polynomial(BTreeMap<Monomial, Vec<Constant>>);

impl Polynomial {
    pub fn term(coefficient: Constant, monomial: Monomial) -> Self {
        let mut polynomial = Self::default();
        polynomial.add_term(coefficient, monomial);
        polynomial
    }

    pub fn literal(literal: Literal) -> Self {
        Self::term(Constant::integer(1), Monomial::power(literal, 1))
    }

    pub fn terms(&self) -> impl Iterator<Item = (&Constant, &Monomial)> {
        self.0.iter().flat_map(|(monomial, coefficients)| coefficients.iter().map(move |c| (c, monomial)))
    }

    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// The term of a polynomial that has no other.
    pub fn single_term(&self) -> Option<(&Constant, &Monomial)> {
        let mut terms = self.terms();
        terms.next().filter(|_| terms.next().is_none())
    }

    pub fn add_term(&mut self, coefficient: Constant, monomial: Monomial) {
        if coefficient.is_zero() {
            return;
        }
        match self.0.entry(monomial) {
            Entry::Vacant(entry) => {
                entry.insert(vec![coefficient]);
            }
            Entry::Occupied(mut entry) => {
                add_constant(entry.get_mut(), coefficient);
                if entry.get().is_empty() {
                    entry.remove();
                }
            }
        }
    }

    pub fn add(&mut self, other: &Self) {
        for (coefficient, monomial) in other.terms() {
            self.add_term(coefficient.clone(), monomial.clone());
        }
    }

    pub fn scale(&self, factor: &Constant) -> Self {
        let mut scaled = Self::default();
        for (coefficient, monomial) in self.terms() {
            scaled.add_term(coefficient.mul(factor), monomial.clone());
        }
        scaled
    }

    /// The product of the divisions in all terms: what makes the polynomial free of divisions when it is divided by it.
    pub fn divisions(&self) -> Monomial {
        self.0.keys().fold(Monomial::one(), |divisions, monomial| divisions.lower(monomial))
    }

    /// Coefficient of the first term, the measure of polynomials that agree up to a constant factor.
    pub fn leading(&self) -> Option<&Constant> {
        self.terms().next().map(|(coefficient, _)| coefficient)
    }
}

/// Adds to a sum of constants with unlike roots, which stays sorted so that equal sums are equal data.
fn add_constant(sum: &mut Vec<Constant>, constant: Constant) {
    match sum.iter().enumerate().find_map(|(at, summand)| Some((at, summand.add(&constant)?))) {
        Some((at, total)) if total.is_zero() => {
            sum.remove(at);
        }
        Some((at, total)) => sum[at] = total,
        None => sum.push(constant),
    }
    sum.sort_by(|a, b| a.to_f64().total_cmp(&b.to_f64()));
}
