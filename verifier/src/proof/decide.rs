//! Decides claims at random points and bounds the probability of a wrong yes.
//!
//! A claim's residuals are quotients of polynomials in what is drawn. If one is not zero identically, its numerator, of
//! degree d, vanishes at a random point with probability at most d / p (Schwartz 1980, Zippel 1979).
//!
//! *Roots.* Of a number that varies a root exists modulo p at every other point only. Where it does not, a number drawn
//! at random stands for it: an identity that holds for any number in its place holds for the root. So a residual that
//! is zero decides for the claim. One that is not decides against it only where all roots exist; if there are too many
//! to find such a point, floats of 384 bits decide. Roots of parameters alone are never too many: they are few for each
//! joint, and joints are drawn one by one.

use super::claim::Claim;
use super::point::{self, DRAWS, Draw, FAR_FROM_ZERO};
use super::statements::{Outcome, Statements, missed_roots};
use crate::atoms::{Drawn, Elementary};
use crate::field::{Field, Modular, Precision, Prime, Real};
use crate::interpreter::DivisionByZero;
use crate::module::Module;
use crate::program::{Function, Id, Node};
use crate::seed::Seed;
use chacha20::ChaCha8Rng;
use gyro_model::Model;
use rand::SeedableRng;
use std::collections::HashSet;
use std::f64::consts::LOG10_2;

/// How a claim was decided.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// All residuals were zero at all points.
    Proved {
        /// Logarithm to base ten of a bound on the probability that the claim is false all the same.
        error_log10: f64,
        /// Logarithm to base two of the bound on degrees.
        degree_log2: f64,
    },
    /// A residual is not zero.
    Refuted {
        /// Which of the residuals.
        residual: usize,
    },
    /// The module divides by an expression that is identically zero.
    Divides {
        /// Line of the module.
        line: usize,
    },
    /// No point could be found at which both sides exist and differ, nor one at which they are equal.
    Undecided,
}

/// Decides the claims about modules of one model.
#[derive(Debug)]
pub struct Decider<'a, const L: usize> {
    pub(super) model: &'a Model,
    prime: Prime<L>,
}

/// The parameters as they are drawn, or the negatives of all. As −1 is not a square, the root of a parameter's square
/// is the parameter on one side and its negative on the other, as it is for positive and negative ones: what holds of
/// one alone is refuted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Side {
    Drawn,
    Opposite,
}

/// Draws at most this often where something divides by zero: at a random point only what is zero everywhere is zero,
/// but for the sum of a number and of the root of its square, which is zero at every other point.
const DRAWS_BY_ZERO: usize = 32;

/// Looks at so many points for one at which all roots of a claim exist, which is every 2ⁿ-th of n roots: only the roots
/// are computed there.
const SEARCHED: u64 = 16 * DRAWS;

/// So many for all claims together, but for a few for each.
const SEARCHED_IN_ALL: u64 = 2 * SEARCHED;

/// After so many points parameters of which all roots exist are drawn anew, as others may never exist with them: of x
/// and p x one has no root if p has none.
const RESTART: u64 = 128;

/// The way to a point at which all roots exist. Those of parameters are found one group after the other, as many as
/// there are: parameters whose roots all exist stay as they are.
struct Search<F: Field> {
    last: Draw<F>,
    /// The parameters that are to be drawn anew.
    stale: HashSet<usize>,
    /// Whether all but the parameters is to be drawn anew too.
    rest_is_stale: bool,
}

/// What came of the searches for points.
struct Searches<F: Field> {
    /// How many more points are looked at, but for a few.
    left: u64,
    /// Roots of which all were found at none.
    never: Vec<HashSet<(Id, Id)>>,
    found: Vec<Found<F>>,
}

/// Roots that exist at a point, which has a number.
type Found<F> = (HashSet<(Id, Id)>, Side, Draw<F>, u64);

impl<F: Field> Searches<F> {
    /// A point at which these exist.
    fn point(&self, roots: &HashSet<(Id, Id)>, on: Side) -> Option<(Draw<F>, u64)> {
        let mut found = self.found.iter().filter(|(_, side, ..)| *side == on);
        found.find(|(all, ..)| roots.is_subset(all)).map(|(.., draw, number)| (draw.clone(), *number))
    }
}

impl<F: Field> Search<F> {
    /// What to do about roots that were missed, given the parameters that each is a root of, if of nothing else.
    fn after(draw: Draw<F>, groups: &[Option<Vec<usize>>], missed: &[bool]) -> Self {
        let missed = groups.iter().zip(missed).filter(|(_, missed)| **missed).map(|(group, _)| group);
        let rest_is_stale = missed.clone().any(Option::is_none);
        let mut stale: HashSet<usize> = missed.flatten().flatten().copied().collect();
        // Whatever shares a root with them.
        loop {
            let touched = groups.iter().flatten().filter(|group| group.iter().any(|k| stale.contains(k)));
            let wider: HashSet<usize> = touched.flatten().chain(&stale).copied().collect();
            if wider.len() == stale.len() {
                return Self { last: draw, stale, rest_is_stale };
            }
            stale = wider;
        }
    }

    /// The last point with what is stale taken from a new one.
    fn next(self, new: Draw<F>) -> Draw<F> {
        let both = self.last.point.parameters.iter().zip(&new.point.parameters).enumerate();
        let parameters = both.map(|(k, (last, new))| if self.stale.contains(&k) { new } else { last });
        let parameters = parameters.cloned().collect();
        let mut draw = if self.rest_is_stale { new } else { self.last };
        draw.point.parameters = parameters;
        draw
    }
}

impl<'a, const L: usize> Decider<'a, L> {
    /// For a model and a prime that was made for it.
    pub fn new(model: &'a Model, prime: Prime<L>) -> Self {
        Self { model, prime }
    }

    /// The prime.
    pub fn prime(&self) -> &Prime<L> {
        &self.prime
    }

    /// Tests a claim at some points; `seed` makes them other points.
    pub fn decide(&self, module: &Module, claim: Claim, points: u32, seed: impl Into<Seed>) -> Verdict {
        let statements = Statements::new(self.model, module, &[claim]);
        self.decide_all(&statements, points, seed.into()).pop().expect("a verdict for each claim")
    }

    /// Tests some claims together, which share what they have in common.
    pub fn decide_all(&self, statements: &Statements<'_>, points: u32, seed: Seed) -> Vec<Verdict> {
        let mut refutations: Vec<Option<Verdict>> = vec![None; statements.claims.len()];
        for point in 0..u64::from(points) {
            self.test(statements, seed.of_point(point), &mut refutations);
        }
        if refutations.iter().all(Option::is_some) {
            return refutations.into_iter().flatten().collect();
        }
        let degrees = statements.degrees_log2();
        let bits = self.prime.value().bits() as f64 - 1.0;
        let proved = |degree_log2: f64| Verdict::Proved {
            error_log10: f64::from(points) * (degree_log2 - bits).min(0.0) * LOG10_2,
            degree_log2,
        };
        let verdicts = refutations.into_iter().zip(degrees);
        verdicts
            .map(|(refutation, degree)| refutation.or(degree.map(proved)).unwrap_or(Verdict::Undecided))
            .collect()
    }

    /// Tests the claims that are open at one point.
    fn test(&self, statements: &Statements<'_>, seed: Seed, refutations: &mut [Option<Verdict>]) {
        let is_open = |(residuals, refutation): (_, &Option<Verdict>)| {
            if refutation.is_none() { residuals } else { None }
        };
        let open: Vec<Option<&Vec<Id>>> =
            statements.claims.iter().map(Option::as_ref).zip(refutations.iter()).map(is_open).collect();
        let reach = statements.formulas.reach(open.iter().flatten().copied().flatten().copied());
        let values =
            |side| (0..DRAWS).find_map(|number| self.values(statements, &reach, (seed, side), number));
        let has_sides = statements.has_roots_of_parameters(&reach);
        let sides = [Some(Side::Drawn), has_sides.then_some(Side::Opposite)];
        let sides: Vec<_> = sides.into_iter().flatten().map(|side| (side, values(side))).collect();
        let mut searches = Searches { left: SEARCHED_IN_ALL, never: Vec::new(), found: Vec::new() };
        for (refutation, residuals) in refutations.iter_mut().zip(open) {
            let Some(residuals) = residuals else { continue };
            *refutation = sides.iter().find_map(|(side, values)| {
                let outcome =
                    values.as_ref().map(|values| statements.outcome(residuals, values, Field::is_zero));
                match (outcome, values, side) {
                    (Some(Outcome::Zero), Some(values), Side::Drawn) => {
                        self.look_behind(statements, residuals, values, seed)
                    }
                    (Some(Outcome::Zero), ..) => None,
                    _ => self.look_closer(statements, residuals, (seed, *side), &mut searches),
                }
            });
        }
    }

    /// The values of some nodes at the point of this seed and number; `None` if there is no such point.
    fn values(
        &self,
        statements: &Statements<'_>,
        needed: &[bool],
        point: (Seed, Side),
        number: u64,
    ) -> Option<Vec<Option<Modular<'_, L>>>> {
        let (draw, atoms) = self.draw_on(statements.module, point, number)?;
        Some(statements.formulas.evaluate(needed, &self.prime, &atoms, &|source| draw.read(source)))
    }

    /// A point.
    fn draw(&self, module: &Module, seed: Seed, number: u64) -> Option<(Draw<Modular<'_, L>>, Drawn<'_, L>)> {
        let mut random = seed.numbers(number);
        let atoms = Drawn::new(&self.prime, ChaCha8Rng::from_rng(&mut random));
        Some((point::modular(self.model, module, &self.prime, &mut random)?, atoms))
    }

    /// A point on a side.
    fn draw_on(
        &self,
        module: &Module,
        (seed, side): (Seed, Side),
        number: u64,
    ) -> Option<(Draw<Modular<'_, L>>, Drawn<'_, L>)> {
        let (mut draw, atoms) = self.draw(module, seed, number)?;
        if side == Side::Opposite {
            draw.point.parameters.iter_mut().for_each(|parameter| *parameter = parameter.neg());
        }
        Some((draw, atoms))
    }

    /// Decides a claim whose residuals are not all zero, or do not exist, at a point at which roots may have been
    /// missed. `None` if they are all zero where all roots exist.
    fn look_closer<'p>(
        &'p self,
        statements: &Statements<'_>,
        residuals: &[Id],
        (seed, side): (Seed, Side),
        searches: &mut Searches<Modular<'p, L>>,
    ) -> Option<Verdict> {
        let reach = statements.formulas.reach(residuals.iter().copied());
        let roots = statements.roots(&reach);
        let (part, places) = statements.part_of_roots(&roots);
        let all_of_part = vec![true; part.program.nodes.len()];
        let groups: Vec<_> = roots.iter().map(|&(_, radicand)| statements.parameters_of(radicand)).collect();
        let (mut zeros, mut search) = (Vec::new(), None::<Search<_>>);
        let all: HashSet<(Id, Id)> = roots.iter().copied().collect();
        let mut known = searches.point(&all, side);
        let is_hopeless = searches.never.iter().any(|some| some.is_subset(&all));
        let searched = if is_hopeless { 0 } else { SEARCHED.min(searches.left.max(RESTART)) };
        for number in 0..searched {
            let (draw, atoms) = if let Some((draw, number)) = known.take() {
                (draw, self.draw(statements.module, seed, number)?.1)
            } else {
                searches.left = searches.left.saturating_sub(1);
                let Some((new, atoms)) = self.draw_on(statements.module, (seed, side), number) else {
                    continue;
                };
                match search.take().filter(|_| number % RESTART != 0) {
                    Some(search) => (search.next(new), atoms),
                    None => (new, atoms),
                }
            };
            let read = |source| draw.read(source);
            let missed = missed_roots(&part.evaluate(&all_of_part, &self.prime, &atoms, &read), &places);
            if missed.contains(&true) {
                search = Some(Search::after(draw, &groups, &missed));
                continue;
            }
            let values = statements.formulas.evaluate(&reach, &self.prime, &atoms, &read);
            searches.found.push((all.clone(), side, draw, number));
            match statements.outcome(residuals, &values, Field::is_zero) {
                Outcome::Zero => return None,
                Outcome::NotZero { residual } => return Some(Verdict::Refuted { residual }),
                Outcome::DividesByZero { line } => zeros.push(line),
            }
            if zeros.len() == DRAWS_BY_ZERO {
                let line = zeros.into_iter().min().flatten().filter(|_| side == Side::Drawn);
                return Some(line.map_or(Verdict::Undecided, |line| Verdict::Divides { line }));
            }
        }
        if searched == SEARCHED {
            searches.never.push(all);
        }
        Some(self.refute_in_floats(statements, residuals, &reach, seed))
    }

    /// The angle of a point on the line y = 0 was taken for zero: a claim that needs it is refuted if the point is not
    /// on the right half.
    fn look_behind(
        &self,
        statements: &Statements<'_>,
        residuals: &[Id],
        values: &[Option<Modular<'_, L>>],
        seed: Seed,
    ) -> Option<Verdict> {
        let reach = statements.formulas.reach(residuals.iter().copied());
        let nodes = statements.formulas.program.nodes.iter().zip(&reach);
        let on_line: Vec<Id> = nodes
            .filter_map(|(node, reached)| match *node {
                Node::Call(Function::Atan2, [y, x])
                    if *reached && values[y].as_ref().is_some_and(Field::is_zero) =>
                {
                    Some(x)
                }
                _ => None,
            })
            .collect();
        if on_line.is_empty() {
            return None;
        }
        let precision = Precision::new();
        let mut random = seed.numbers(DRAWS);
        let draw = point::real(self.model, statements.module, &precision, &mut random);
        let Some(draw) = draw else { return Some(Verdict::Undecided) };
        let needed = statements.formulas.reach(on_line.iter().copied());
        let values =
            statements.formulas.evaluate(&needed, &precision, &Elementary, &|source| draw.read(source));
        let is_right = |x: &Id| values[*x].as_ref().is_some_and(|x| x.to_f64() > 0.0);
        (!on_line.iter().all(is_right)).then_some(Verdict::Refuted { residual: 0 })
    }

    /// Looks for a point in floating point at which a residual is far from zero.
    fn refute_in_floats(
        &self,
        statements: &Statements<'_>,
        residuals: &[Id],
        reach: &[bool],
        seed: Seed,
    ) -> Verdict {
        let precision = Precision::new();
        let mut random = seed.numbers(DRAWS);
        let Some(draw) = point::real(self.model, statements.module, &precision, &mut random) else {
            return Verdict::Undecided;
        };
        let read = |source| draw.read(source);
        let values = statements.formulas.evaluate(reach, &precision, &Elementary, &read);
        let size = |x: &Real<'_>| x.to_f64().abs();
        let largest = values.iter().flatten().map(size).filter(|x| x.is_finite()).fold(1.0, f64::max);
        // What is not a number refutes nothing.
        let is_zero = |x: &Real<'_>| size(x).is_nan() || size(x) <= FAR_FROM_ZERO * largest;
        match statements.outcome(residuals, &values, is_zero) {
            Outcome::NotZero { residual } => Verdict::Refuted { residual },
            _ => Verdict::Undecided,
        }
    }

    /// Evaluates something at a random point at which it exists with all its roots; where there are too many to find
    /// such a point, with numbers in the place of some. `None` if something is divided by zero.
    pub(super) fn at_any_point<'p, R>(
        &'p self,
        module: &Module,
        seed: Seed,
        evaluate: impl Fn(&Draw<Modular<'p, L>>, &Drawn<'p, L>) -> Result<R, DivisionByZero>,
    ) -> Option<R> {
        let with_numbers = || {
            let mut points = (0..DRAWS).filter_map(|number| self.draw(module, seed, number));
            points.find_map(|(draw, atoms)| evaluate(&draw, &atoms).ok())
        };
        self.at_point(module, seed, &evaluate).or_else(with_numbers)
    }

    /// Evaluates something at a random point at which it exists with all its roots.
    pub(super) fn at_point<'p, R>(
        &'p self,
        module: &Module,
        seed: Seed,
        evaluate: impl Fn(&Draw<Modular<'p, L>>, &Drawn<'p, L>) -> Result<R, DivisionByZero>,
    ) -> Option<R> {
        let mut zeros = 0;
        for number in 0..DRAWS {
            let Some((draw, atoms)) = self.draw(module, seed, number) else { continue };
            let result = evaluate(&draw, &atoms);
            if atoms.missed_root() {
                continue;
            }
            match result {
                Ok(result) => return Some(result),
                Err(_) => zeros += 1,
            }
            if zeros == DRAWS_BY_ZERO {
                break;
            }
        }
        None
    }
}
