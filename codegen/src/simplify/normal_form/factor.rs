//! Greedy factoring of a system of sums: what saves most is given a name, again and again.
//!
//! A candidate is a sum of two terms up to a common factor, `(a s + 2 b)` in `3 a s x + 6 b x`, or, once no sum is
//! left, a product of two factors. A longer common sum is found two terms at a time. After Rajski and Vasudevamurthy,
//! "The testability-preserving concurrent decomposition and factorization of Boolean expressions", IEEE Trans. CAD
//! 11(6), 1992, whose cubes have no coefficients: here sums match up to a constant factor, and a constant is a factor
//! like any other.

use super::polynomial::{Literal, Monomial};
use super::sums::{Ratio, Scale, Scales, SumId, Sums, Term, Value};
use crate::expr::domains::mix;
use rustc_hash::FxHashMap as HashMap;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// What terms may have in common. Sums are found by a number that equal ones share: most pairs of terms are met once
/// and never again. What is extracted is compared exactly.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
enum Key {
    Sum(u64),
    Product(Factor, Factor),
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
enum Factor {
    Literal(Literal),
    Scale(Scale),
}

type TermId = usize;

/// A term in the place where it stands. The terms of a sum are replaced, never changed.
#[derive(Debug)]
struct Placed {
    term: Term,
    sum: SumId,
    alive: bool,
}

/// Two terms in the order in which their sum is written.
type Pair = (TermId, TermId);

#[derive(Debug)]
struct Candidate {
    key: Key,
    /// The pairs that make it up, or the terms that contain it, twice. Some may be gone.
    occurrences: Vec<Pair>,
    /// How often a product is contained in all terms.
    count: i64,
    /// Once it has been extracted.
    defined: Option<Definition>,
}

/// The literal that stands for a candidate.
#[derive(Clone, Debug)]
struct Definition {
    literal: Literal,
    sum: SumId,
    terms: Vec<Term>,
}

/// A sum of two terms without what they have in common.
#[derive(Debug, PartialEq, Eq)]
struct Remainder {
    first: Monomial,
    second: Monomial,
    ratio: Scale,
    differ: bool,
}

/// The scale at which a sum is given a name.
#[derive(Clone, Copy, Debug)]
enum Choice {
    /// The first term has no coefficient.
    First,
    /// The second term has none.
    Second,
    /// The sum has the coefficients that it has in this place.
    AsIn(TermId),
}

/// Scales that are tried for one sum, beside those without a coefficient.
const MAX_SCALES: usize = 4;

/// Extracts common parts until none saves an operation. A seed shuffles candidates of nearly equal worth; zero takes
/// them in order. `None` if that takes more than `steps`, from which what it took is subtracted.
pub fn factor(mut system: Sums, seed: u64, steps: &mut usize) -> Option<Sums> {
    let pairs: usize = system.sums.iter().map(|terms| terms.len() * terms.len() / 2).sum();
    if pairs > *steps {
        return None;
    }
    let initial: Vec<_> = system.sums.iter_mut().map(std::mem::take).collect();
    let mut factoring = Factoring {
        placed: Vec::new(),
        sums: vec![Vec::new(); initial.len()],
        system,
        seed,
        candidates: Vec::new(),
        index: HashMap::default(),
        queue: BinaryHeap::new(),
        steps,
    };
    for (sum, terms) in initial.into_iter().enumerate() {
        for term in terms {
            factoring.place(sum, term);
        }
    }
    factoring.run()?;
    Some(factoring.finish())
}

struct Factoring<'a> {
    system: Sums,
    seed: u64,
    placed: Vec<Placed>,
    sums: Vec<Vec<TermId>>,
    candidates: Vec<Candidate>,
    index: HashMap<Key, usize>,
    /// By rank, then by age, the older first.
    queue: BinaryHeap<(i64, Reverse<usize>)>,
    /// How many more comparisons of terms are allowed.
    steps: &'a mut usize,
}

impl Factoring<'_> {
    fn run(&mut self) -> Option<()> {
        while let Some((rank, Reverse(at))) = self.queue.pop() {
            match self.rank(at) {
                Some(current) if current == rank => self.extract(at),
                Some(current) if current < rank => self.queue.push((current, Reverse(at))),
                // It has become worth more, and was queued again when it did; or it is worth nothing.
                _ => {}
            }
            if *self.steps == 0 {
                return None;
            }
        }
        (*self.steps > 0).then_some(())
    }

    fn finish(mut self) -> Sums {
        let terms = |ids: &Vec<TermId>| ids.iter().map(|&id| self.placed[id].term.clone()).collect();
        self.system.sums = self.sums.iter().map(terms).collect();
        self.system
    }

    /// Puts a term into a sum and notes what it has in common with others.
    fn place(&mut self, sum: SumId, term: Term) {
        let Some(term) = self.merge(sum, term) else { return };
        let products = products_in(&term);
        *self.steps = self.steps.saturating_sub(self.sums[sum].len() + products.len());
        if *self.steps == 0 {
            return;
        }
        let id = self.placed.len();
        self.placed.push(Placed { term, sum, alive: true });
        for (key, count) in products {
            let at = self.note(key, (id, id));
            self.candidates[at].count += count;
            self.enqueue(at);
        }
        for other in 0..self.sums[sum].len() {
            let (key, pair) = self.pair_up(self.sums[sum][other], id);
            let at = self.note(key, pair);
            self.enqueue(at);
        }
        self.sums[sum].push(id);
    }

    /// A term joins one with the same literals. `None` if the two vanish.
    fn merge(&mut self, sum: SumId, term: Term) -> Option<Term> {
        for at in 0..self.sums[sum].len() {
            let id = self.sums[sum][at];
            let other = &self.placed[id].term;
            if other.monomial != term.monomial {
                continue;
            }
            let (a, b) = ((other.negative, other.scale), (term.negative, term.scale));
            if let Some(total) = self.system.scales.sum(a, b) {
                self.remove(id);
                return total.map(|(negative, scale)| Term { negative, scale, ..term });
            }
        }
        Some(term)
    }

    fn remove(&mut self, id: TermId) {
        self.placed[id].alive = false;
        let sum = self.placed[id].sum;
        self.sums[sum].retain(|&other| other != id);
        for (key, count) in products_in(&self.placed[id].term) {
            let at = self.index[&key];
            self.candidates[at].count -= count;
        }
    }

    fn note(&mut self, key: Key, occurrence: Pair) -> usize {
        let next = self.candidates.len();
        let at = *self.index.entry(key).or_insert(next);
        if at == next {
            self.candidates.push(Candidate { key, occurrences: Vec::new(), count: 0, defined: None });
        }
        self.candidates[at].occurrences.push(occurrence);
        at
    }

    /// The key of the sum of two terms, and the terms in the order in which it is written.
    fn pair_up(&self, a: TermId, b: TermId) -> (Key, Pair) {
        let (ta, tb) = (&self.placed[a].term, &self.placed[b].term);
        let (hash_a, hash_b) =
            (ta.monomial.hash_without(&tb.monomial), tb.monomial.hash_without(&ta.monomial));
        let (first, second, pair) =
            if hash_a <= hash_b { (hash_a, hash_b, (a, b)) } else { (hash_b, hash_a, (b, a)) };
        let ratio = self.system.scales.ratio(self.placed[pair.1].term.scale, self.placed[pair.0].term.scale);
        let signed = ratio.bits() << 1 | u64::from(ta.negative != tb.negative);
        (Key::Sum(mix(mix(mix(first).wrapping_add(second)).wrapping_add(signed))), pair)
    }

    fn remainder(&mut self, (a, b): Pair) -> Remainder {
        let (ta, tb) = (&self.placed[a].term, &self.placed[b].term);
        let common = ta.monomial.lower(&tb.monomial);
        let (first, second) = (ta.monomial.div(&common), tb.monomial.div(&common));
        let differ = ta.negative != tb.negative;
        Remainder { first, second, ratio: self.system.scales.div(tb.scale, ta.scale), differ }
    }

    fn enqueue(&mut self, at: usize) {
        if let Some(rank) = self.rank(at) {
            self.queue.push((rank, Reverse(at)));
        }
    }

    /// How a candidate stands in the queue, if it saves anything.
    fn rank(&mut self, at: usize) -> Option<i64> {
        let (saved, head_start) = match self.candidates[at].key {
            Key::Sum(_) => (self.best_sum(at)?.0, SUMS_FIRST),
            // The product that defines it is counted too.
            Key::Product(..) => (self.candidates[at].count - 1, 0),
        };
        (saved > 0).then(|| saved * NOISE + noise(self.seed, at) + head_start)
    }

    /// Occurrences that are still there and have no term in common.
    fn disjoint(&mut self, at: usize) -> Vec<Pair> {
        let candidate = &mut self.candidates[at];
        let placed = &self.placed;
        candidate.occurrences.retain(|&(a, b)| placed[a].alive && placed[b].alive);
        let own = candidate.defined.as_ref().map(|definition| definition.sum);
        let mut disjoint: Vec<Pair> = Vec::with_capacity(candidate.occurrences.len());
        for &(a, b) in &candidate.occurrences {
            let free = |id| disjoint.iter().all(|&(x, y)| x != id && y != id);
            if own != Some(placed[a].sum) && free(a) && free(b) {
                disjoint.push((a, b));
            }
        }
        disjoint
    }

    /// The most that naming a sum saves, and the scale at which it does.
    fn best_sum(&mut self, at: usize) -> Option<(i64, Choice)> {
        if let [pair] = self.candidates[at].occurrences[..]
            && !self.may_save_alone(at, pair)
        {
            return None;
        }
        let occurrences = self.disjoint(at);
        let &(a, b) = occurrences.first()?;
        let degrees = [a, b].map(|id| self.placed[id].term.monomial.degree());
        let common = self.placed[a].term.monomial.lower(&self.placed[b].term.monomial).degree();
        let sum = Measure {
            degrees: degrees.map(|degree| degree - common),
            ratio: self.nearest(b) / self.nearest(a),
        };
        if let Some(definition) = &self.candidates[at].defined {
            let scale = self.system.scales.nearest(definition.terms[0].scale);
            return Some((self.saved_in(&sum, &occurrences, scale), Choice::First));
        }
        let choices = [Choice::First, Choice::Second].into_iter();
        let choices = choices.chain(occurrences.iter().take(MAX_SCALES).map(|&(a, _)| Choice::AsIn(a)));
        let savings = choices.map(|choice| {
            let scale = match choice {
                Choice::First => 1.0,
                Choice::Second => sum.ratio.recip(),
                Choice::AsIn(id) => self.nearest(id),
            };
            (self.saved_in(&sum, &occurrences, scale) - sum.cost(scale), choice)
        });
        savings.reduce(|best, other| if other.0 > best.0 { other } else { best })
    }

    fn nearest(&self, id: TermId) -> f64 {
        self.system.scales.nearest(self.placed[id].term.scale)
    }

    /// A sum that stands in one place saves nothing by its name unless something is factored out.
    fn may_save_alone(&self, at: usize, (a, b): Pair) -> bool {
        let (ta, tb) = (&self.placed[a].term, &self.placed[b].term);
        self.candidates[at].defined.is_some() || ta.scale == tb.scale || ta.monomial.shares(&tb.monomial)
    }

    /// What is saved where the sum occurs if it has a name at some scale.
    fn saved_in(&self, sum: &Measure, occurrences: &[Pair], scale: f64) -> i64 {
        let saved = |&(a, b): &Pair| {
            let (ta, tb) = (&self.placed[a].term, &self.placed[b].term);
            let outside = Ratio::new(self.nearest(a) / scale) != Ratio::ONE;
            let after = ta.monomial.degree() - sum.degrees[0] + usize::from(outside);
            operations(ta.cost() + tb.cost() + 1) - operations(after)
        };
        occurrences.iter().map(saved).sum()
    }

    fn extract(&mut self, at: usize) {
        match self.candidates[at].key {
            Key::Sum(_) => self.extract_sum(at),
            Key::Product(x, y) => self.extract_product(at, x, y),
        }
    }

    fn extract_product(&mut self, at: usize, x: Factor, y: Factor) {
        let terms = self.disjoint(at);
        let definition = self.define(at, || vec![product(x, y)]);
        for (id, _) in terms {
            self.replace_product(id, x, y, definition.literal);
        }
    }

    fn extract_sum(&mut self, at: usize) {
        let Some((_, choice)) = self.best_sum(at) else { return };
        let occurrences = self.disjoint(at);
        let wanted = match &self.candidates[at].defined {
            Some(definition) => remainder_of(&mut self.system.scales, &definition.terms),
            None => self.remainder(occurrences[0]),
        };
        let scale = match choice {
            Choice::First => Scales::ONE,
            Choice::Second => self.system.scales.div(Scales::ONE, wanted.ratio),
            Choice::AsIn(id) => self.placed[id].term.scale,
        };
        let second_scale = self.system.scales.mul(scale, wanted.ratio);
        let definition = self.define(at, || {
            let first = Term { negative: false, scale, monomial: wanted.first.clone() };
            vec![
                first,
                Term { negative: wanted.differ, scale: second_scale, monomial: wanted.second.clone() },
            ]
        });
        for pair in occurrences {
            if self.remainder(pair) == wanted {
                self.replace_pair(pair, &definition);
            }
        }
    }

    /// Gives a candidate a literal, unless it has one.
    fn define(&mut self, at: usize, terms: impl FnOnce() -> Vec<Term>) -> Definition {
        if let Some(definition) = &self.candidates[at].defined {
            return definition.clone();
        }
        let (sum, terms) = (self.sums.len(), terms());
        let literal = self.system.define(Value::Sum(sum));
        let definition = Definition { literal, sum, terms };
        self.sums.push(Vec::new());
        self.candidates[at].defined = Some(definition.clone());
        for term in &definition.terms {
            self.place(sum, term.clone());
        }
        definition
    }

    fn replace_pair(&mut self, (a, b): Pair, definition: &Definition) {
        let (sum, term) = (self.placed[a].sum, self.placed[a].term.clone());
        self.remove(a);
        self.remove(b);
        let [first, _] = &definition.terms[..] else { return };
        let scale = self.system.scales.div(term.scale, first.scale);
        let monomial = term.monomial.div(&first.monomial).mul(&Monomial::power(definition.literal, 1));
        self.place(sum, Term { scale, monomial, ..term });
    }

    fn replace_product(&mut self, id: TermId, x: Factor, y: Factor, literal: Literal) {
        let (sum, mut term) = (self.placed[id].sum, self.placed[id].term.clone());
        let times = contained(&term, x, y);
        self.remove(id);
        let factors = product(x, y);
        for _ in 0..times {
            term.monomial = term.monomial.div(&factors.monomial).mul(&Monomial::power(literal, 1));
        }
        if factors.scale != Scales::ONE {
            term.scale = Scales::ONE;
        }
        self.place(sum, term);
    }
}

/// What decides about the cost of a sum: how many literals its terms have, and their coefficients up to a common
/// factor.
struct Measure {
    degrees: [usize; 2],
    ratio: f64,
}

impl Measure {
    fn cost(&self, scale: f64) -> i64 {
        let term = |degree: usize, scale: f64| {
            (degree + usize::from(Ratio::new(scale) != Ratio::ONE)).saturating_sub(1)
        };
        operations(term(self.degrees[0], scale) + term(self.degrees[1], scale * self.ratio) + 1)
    }
}

fn operations(count: usize) -> i64 {
    i64::try_from(count).expect("a count of operations is small")
}

fn remainder_of(scales: &mut Scales, terms: &[Term]) -> Remainder {
    let (first, second) = (&terms[0], &terms[1]);
    let ratio = scales.div(second.scale, first.scale);
    Remainder {
        first: first.monomial.clone(),
        second: second.monomial.clone(),
        ratio,
        differ: second.negative,
    }
}

/// The products of two factors in a term, and how often it contains each.
fn products_in(term: &Term) -> Vec<(Key, i64)> {
    let mut factors: Vec<_> =
        term.monomial.powers().map(|(l, e)| (Factor::Literal(l), i64::from(e))).collect();
    if term.scale != Scales::ONE {
        factors.push((Factor::Scale(term.scale), 1));
    }
    let mut products = Vec::with_capacity(factors.len() * factors.len() / 2);
    for (at, &(second, times)) in factors.iter().enumerate() {
        if times > 1 {
            products.push((Key::Product(second, second), times / 2));
        }
        products.extend(factors[..at].iter().map(|&(first, n)| (Key::Product(first, second), n.min(times))));
    }
    products
}

/// How often a term contains a product.
fn contained(term: &Term, x: Factor, y: Factor) -> i32 {
    let has = |factor| match factor {
        Factor::Literal(literal) => term.monomial.exponent(literal),
        Factor::Scale(scale) => i32::from(term.scale == scale),
    };
    if x == y { has(x) / 2 } else { has(x).min(has(y)) }
}

fn product(x: Factor, y: Factor) -> Term {
    let mut term = Term { negative: false, scale: Scales::ONE, monomial: Monomial::one() };
    for factor in [x, y] {
        match factor {
            Factor::Literal(literal) => term.monomial = term.monomial.mul(&Monomial::power(literal, 1)),
            Factor::Scale(scale) => term.scale = scale,
        }
    }
    term
}

/// Sums are extracted before products, which would hide what terms have in common.
const SUMS_FIRST: i64 = 1 << 40;

/// The rank that is worth one operation.
const NOISE: i64 = 16;

/// A little more than the worth of one operation at most.
fn noise(seed: u64, at: usize) -> i64 {
    if seed == 0 {
        return 0;
    }
    (mix(mix(seed).wrapping_add(at as u64)) % 24).cast_signed()
}
