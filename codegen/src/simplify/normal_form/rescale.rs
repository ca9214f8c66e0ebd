//! Where constant factors stand: a sum that has a name can be multiplied by a constant if what uses it is divided by
//! it. Each is given the scale at which the fewest terms have a coefficient.

use super::polynomial::Literal;
use super::sums::{Ratio, Scale, Scales, SumId, Sums, Term, Value};
use std::collections::BTreeMap;

/// A sum whose scale is free: no root, and no operand of a function other than the reciprocal.
struct Free {
    sum: SumId,
    /// The terms that contain it, with its exponent there: −1 for its reciprocal.
    uses: Vec<((SumId, usize), i32)>,
}

/// The constant that a sum is multiplied by: a scale or, with the exponent −1, its reciprocal.
#[derive(Clone, Copy)]
struct Factor {
    scale: Scale,
    exponent: i32,
}

/// Rounds of improvement; it settles in two or three.
const MAX_ROUNDS: usize = 4;

/// Moves constant factors until no move of one saves a multiplication.
pub fn rescale(system: &mut Sums) {
    let free = free(system);
    settle(system, &free);
}

/// The same for moves of two at once: the first saves nothing by itself, but lets a neighbour save.
pub fn rescale_pairs(system: &mut Sums) {
    let free = free(system);
    for one in &free {
        let now = cost(system, one, 1.0);
        let level: Vec<_> = factors(system, one).filter(|(cost, _)| *cost == now).map(|(_, f)| f).collect();
        for factor in level {
            apply(system, one, factor);
            let neighbours = free.iter().filter(|other| one.touches(other));
            let better = neighbours.filter_map(|other| Some((other, best_factor(system, other)?))).next();
            match better {
                Some((other, factor)) => {
                    apply(system, other, factor);
                    settle(system, &free);
                    break;
                }
                None => apply(system, one, Factor { exponent: -factor.exponent, ..factor }),
            }
        }
    }
}

fn settle(system: &mut Sums, free: &[Free]) {
    for _ in 0..MAX_ROUNDS {
        let mut changed = false;
        for one in free {
            if let Some(factor) = best_factor(system, one) {
                apply(system, one, factor);
                changed = true;
            }
        }
        if !changed {
            return;
        }
    }
}

impl Free {
    /// Whether there is a term that both may change.
    fn touches(&self, other: &Self) -> bool {
        let changes = |one: &Self, sum| one.sum == sum || one.uses.iter().any(|&((used, _), _)| used == sum);
        self.sum != other.sum
            && (changes(self, other.sum) || other.uses.iter().any(|&((sum, _), _)| changes(self, sum)))
    }
}

fn free(system: &Sums) -> Vec<Free> {
    let mut literals: BTreeMap<SumId, Vec<(Literal, i32)>> = BTreeMap::new();
    for (literal, value) in system.literals.iter().enumerate() {
        match value {
            Value::Sum(sum) => literals.entry(*sum).or_default().push((literal, 1)),
            Value::Recip(of) => {
                literals.entry(*of).or_default().push((literal, -1));
                // The reciprocal of a multiple of a sum is one of that sum too.
                if let Some(sum) = multiple_of(system, *of) {
                    literals.entry(sum).or_default().push((literal, -1));
                }
            }
            _ => {}
        }
    }
    let uses = uses(system);
    let free = literals.into_iter().map(|(sum, literals)| {
        let mut exponents = BTreeMap::new();
        for (literal, exponent) in literals {
            let own_operand = |place: &(SumId, usize)| exponent > 0 && is_operand(system, place.0, literal);
            for &(place, times) in uses[literal].iter().filter(|(place, _)| !own_operand(place)) {
                *exponents.entry(place).or_default() += exponent * times;
            }
        }
        Free { sum, uses: exponents.into_iter().collect() }
    });
    free.collect()
}

/// The terms that contain each literal, and how often.
fn uses(system: &Sums) -> Vec<Vec<((SumId, usize), i32)>> {
    let mut uses = vec![Vec::new(); system.literals.len()];
    for (sum, terms) in system.sums.iter().enumerate() {
        for (at, term) in terms.iter().enumerate() {
            for (literal, times) in term.monomial.powers() {
                uses[literal].push(((sum, at), times));
            }
        }
    }
    uses
}

/// The sum that another is a mere multiple of.
fn multiple_of(system: &Sums, sum: SumId) -> Option<SumId> {
    let [Term { monomial, .. }] = &system.sums[sum][..] else { return None };
    let (literal, _) = monomial.powers().next().filter(|_| monomial.degree() == 1)?;
    if let Value::Sum(inner) = system.literals[literal] { Some(inner) } else { None }
}

/// Whether a sum is a multiple of a literal and is what something is divided by.
fn is_operand(system: &Sums, sum: SumId, literal: Literal) -> bool {
    let divided = |value: &Value| matches!(value, Value::Recip(of) if *of == sum);
    matches!(&system.sums[sum][..], [term] if term.monomial.degree() == 1 && term.monomial.exponent(literal) == 1)
        && system.literals.iter().any(divided)
}

/// The factor of a sum that saves most multiplications, if any does.
fn best_factor(system: &Sums, free: &Free) -> Option<Factor> {
    let (least, factor) =
        factors(system, free).reduce(|best, other| if other.0 < best.0 { other } else { best })?;
    (least < cost(system, free, 1.0)).then_some(factor)
}

/// The factors that rid some term of its coefficient, and what the terms cost then.
fn factors(system: &Sums, free: &Free) -> impl Iterator<Item = (usize, Factor)> {
    let inside = system.sums[free.sum].iter().map(|term| (term.scale, -1));
    let outside = free.uses.iter().filter(|(_, exponent)| exponent.abs() == 1);
    let outside = outside.map(|&((sum, at), exponent)| (system.sums[sum][at].scale, exponent));
    let factors = inside.chain(outside).filter(|(scale, _)| *scale != Scales::ONE);
    factors.map(|(scale, exponent)| {
        (cost(system, free, system.scales.nearest(scale).powi(exponent)), Factor { scale, exponent })
    })
}

/// Multiplications in the sum and where it is used, were it multiplied by a factor.
fn cost(system: &Sums, free: &Free, factor: f64) -> usize {
    let one = |term: &Term, factor: f64| {
        let scaled = Ratio::new(system.scales.nearest(term.scale) * factor) != Ratio::ONE;
        (term.monomial.degree() + usize::from(scaled)).saturating_sub(1)
    };
    let inside = system.sums[free.sum].iter().map(|term| one(term, factor));
    let outside =
        free.uses.iter().map(|&((sum, at), exponent)| one(&system.sums[sum][at], factor.powi(-exponent)));
    inside.chain(outside).sum()
}

fn apply(system: &mut Sums, free: &Free, Factor { scale, exponent }: Factor) {
    let inverse = system.scales.div(Scales::ONE, scale);
    let (factor, inverse) = if exponent > 0 { (scale, inverse) } else { (inverse, scale) };
    for term in &mut system.sums[free.sum] {
        term.scale = system.scales.mul(term.scale, factor);
    }
    for &((sum, at), exponent) in &free.uses {
        let term = &mut system.sums[sum][at];
        for _ in 0..exponent.abs() {
            term.scale = system.scales.mul(term.scale, if exponent > 0 { inverse } else { factor });
        }
    }
}
