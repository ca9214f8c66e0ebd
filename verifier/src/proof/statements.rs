//! Claims about a module written down as formulas: primes at which their roots exist, degrees, and whether residuals
//! are zero.

use super::case::Case;
use super::claim::Claim;
use super::point::{self, DRAWS};
use crate::atoms::{Drawn, Elementary, Formal, HALVINGS};
use crate::field::{Degree, Field, Modular, Precision, Prime, Real, sum_log2};
use crate::module::Module;
use crate::program::{Function, Id, Node, Source};
use crate::seed::Seed;
use crate::tape::{Formulas, Tape, Term};
use crate::textbook::Textbook;
use chacha20::ChaCha8Rng;
use gyro_model::{Model, Rational};
use num_bigint::BigUint;
use num_integer::Integer;
use num_traits::{Signed, ToPrimitive};
use rand::{RngExt, SeedableRng};
use std::collections::BTreeSet;
use std::iter;

/// Primes that are tried for roots of constants that have roots in them: enough for four of these, as a rule.
const PRIMES: usize = 64;

/// Points more than there are roots, until roots are thought to exclude each other: one of 2^8 primes is passed over in
/// vain.
const MORE_POINTS: usize = 8;

/// Claims about a module written down, each as its residuals.
#[derive(Debug)]
pub struct Statements<'a> {
    pub(super) model: &'a Model,
    pub(super) module: &'a Module,
    pub(super) formulas: Formulas,
    /// `None` of a claim whose textbook side divides by the number zero.
    pub(super) claims: Vec<Option<Vec<Id>>>,
}

/// Of each root and what it is the root of, whether it does not exist.
pub(super) fn missed_roots<F: Field>(values: &[Option<F>], roots: &[(Id, Id)]) -> Vec<bool> {
    let is_missed = |&(root, radicand): &(Id, Id)| {
        let both = values[root].as_ref().zip(values[radicand].as_ref());
        both.is_none_or(|(root, radicand)| root.mul(root) != *radicand)
    };
    roots.iter().map(is_missed).collect()
}

/// Vectors modulo two that are independent of each other.
#[derive(Default)]
struct Independent {
    /// The place of the first one of each, and the vector.
    vectors: Vec<(usize, Vec<bool>)>,
}

impl Independent {
    /// What is left of a vector, and the place of its first one; `None` if it is a sum of these.
    fn reduced(&self, mut vector: Vec<bool>) -> Option<(usize, Vec<bool>)> {
        for (first, other) in &self.vectors {
            if vector[*first] {
                vector.iter_mut().zip(other).for_each(|(x, y)| *x ^= y);
            }
        }
        Some((vector.iter().position(|&x| x)?, vector))
    }

    fn add(&mut self, vector: Vec<bool>) {
        self.vectors.extend(self.reduced(vector));
    }
}

/// What residuals are at one point.
pub(super) enum Outcome {
    Zero,
    NotZero { residual: usize },
    DividesByZero { line: Option<usize> },
}

impl<'a> Statements<'a> {
    /// Writes both sides of some claims down.
    pub fn new(model: &'a Model, module: &'a Module, claims: &[Claim]) -> Self {
        let (tape, textbook) = (Tape::new(), Textbook::new(model));
        let claims = {
            let case = Case::new(model, &textbook, module, &tape);
            let ids = |terms: Vec<Term<'_>>| terms.into_iter().map(Term::id).collect();
            claims.iter().map(|claim| claim.residuals(&case).map(ids)).collect()
        };
        Self { model, module, formulas: tape.finish(), claims }
    }

    /// A prime for which all constants have their roots: the largest known Mersenne prime that there is room for if it
    /// is one, else a random one of all the bits that there is room for.
    ///
    /// Roots of numbers that vary should be able to exist together too, if they are among those of some `claims`.
    ///
    /// # Errors
    /// The number of bits that the roots take, if they are too many.
    pub fn prime<const L: usize>(&self, seed: Seed, claims: &[usize]) -> Result<Prime<L>, u64> {
        let constants = self.formulas.constants.iter();
        let radicands: Vec<_> = constants.filter_map(|constant| constant.radicand.as_ref()).collect();
        let mersenne = Some(Prime::mersenne());
        let mut mersenne = mersenne.filter(|prime| radicands.iter().all(|radicand| prime.covers(radicand)));
        let product = |r: &Rational| r.numer().magnitude() * r.denom().magnitude();
        let squares =
            radicands.iter().fold(BigUint::from(1_u32), |squares, r| squares.lcm(&radical(product(r))));
        let mut squares = squares;
        let roots = self.settled_roots(claims);
        let (mut random, mut of_test) = (seed.numbers(0), seed.numbers(1));
        loop {
            let draw = || mersenne.take().or_else(|| Prime::with_roots(&squares, &mut random));
            let prime = self.with_nested_roots(seed, draw, &roots).ok_or(squares.bits())?;
            let uncovered = self.uncovered(&prime, &roots);
            if !uncovered.is_empty() {
                squares = uncovered.iter().fold(squares, |squares, r| squares.lcm(&radical(product(r))));
                continue;
            }
            // Most of the test is left to the one that is taken.
            if prime.is_prime(&mut of_test) {
                return Ok(prime);
            }
        }
    }

    /// Roots of constants and parameters, and all roots of some claims.
    fn settled_roots(&self, claims: &[usize]) -> Vec<(Id, Id)> {
        let ids = claims.iter().filter_map(|&claim| self.claims[claim].as_ref()).flatten().copied();
        let (all, wanted) = (vec![true; self.formulas.program.nodes.len()], self.formulas.reach(ids));
        let is_settled =
            |&(root, radicand): &(Id, Id)| wanted[root] || self.parameters_of(radicand).is_some();
        self.roots(&all).into_iter().filter(is_settled).collect()
    }

    /// Rationals of which roots are taken without a constant for it, as of what orientations of bushings make, and for
    /// which the prime was not made: the root that is a square may then be another one than a constant is.
    fn uncovered<const L: usize>(&self, prime: &Prime<L>, roots: &[(Id, Id)]) -> Vec<Rational> {
        let is_constant =
            |(_, radicand): &(Id, Id)| self.parameters_of(*radicand).is_some_and(|of| of.is_empty());
        let constant: Vec<_> = roots.iter().copied().filter(is_constant).collect();
        let (part, places) = self.part_of_roots(&constant);
        let atoms = Drawn::new(prime, ChaCha8Rng::from_rng(&mut Seed::FIXED.numbers(0)));
        let all = vec![true; part.program.nodes.len()];
        let values = part.evaluate(&all, prime, &atoms, &|_| Modular::zero(prime));
        let fraction = |id: Id| values[id].as_ref()?.small_fraction();
        let rational =
            places.into_iter().filter_map(|(root, radicand)| fraction(root).or_else(|| fraction(radicand)));
        rational.map(|r| r.abs()).filter(|r| r.is_positive() && !prime.covers(r)).collect()
    }

    /// The first of some primes modulo which roots of constants that have roots in them exist too, such as the half
    /// angles between joint frames that are skew to each other, and roots of parameters can exist together: nothing is
    /// known of these beforehand. The last prime if none has them.
    fn with_nested_roots<const L: usize>(
        &self,
        seed: Seed,
        mut draw: impl FnMut() -> Option<Prime<L>>,
        roots: &[(Id, Id)],
    ) -> Option<Prime<L>> {
        let mut prime = draw()?;
        for _ in 1..PRIMES {
            if self.can_all_exist(&prime, seed, roots) {
                break;
            }
            prime = draw()?;
        }
        Some(prime)
    }

    /// Whether some roots can exist at one point. Say 26 is not a square: then of x and 26 x one
    /// is not a square either, whatever x is.
    ///
    /// Of a product of numbers it can be told whether it is a square if it can of each: which roots are missed at
    /// points, as vectors modulo two, differ by sums of some vectors. If nothing missed is no such sum away from what
    /// was missed, some roots exclude each other.
    fn can_all_exist<const L: usize>(&self, prime: &Prime<L>, seed: Seed, roots: &[(Id, Id)]) -> bool {
        let (part, places) = self.part_of_roots(roots);
        let (needed, mut random) = (vec![true; part.program.nodes.len()], seed.numbers(0));
        let mut missed = || {
            let draw = iter::repeat_with(|| point::modular(self.model, self.module, prime, &mut random));
            let draw = draw.flatten().next().expect("nearly every number has a reciprocal");
            let atoms = Drawn::new(prime, ChaCha8Rng::from_rng(&mut random));
            missed_roots(&part.evaluate(&needed, prime, &atoms, &|source| draw.read(source)), &places)
        };
        let first = missed();
        let is_constant =
            |&(_, radicand): &(Id, Id)| self.parameters_of(radicand).is_none_or(|of| of.is_empty());
        if roots.iter().zip(&first).any(|(root, missed)| *missed && is_constant(root)) {
            return false;
        }
        let mut differences = Independent::default();
        (0..roots.len() + MORE_POINTS).any(|_| {
            let is_reached = differences.reduced(first.clone()).is_none();
            if !is_reached {
                let difference = missed().iter().zip(&first).map(|(a, b)| a != b).collect();
                differences.add(difference);
            }
            is_reached
        })
    }

    /// For each claim the logarithm to base two of the degree that decides it: of the numerator of any residual, of all
    /// denominators on the way, and of whatever makes two atoms one by accident. Each root doubles it (the norm of `f +
    /// g √x` is `f² − g² x`), and as it exists at half of the points or is drawn, there are twice as many ways for an
    /// accident. `None` if the formulas divide by an expression that is identically zero.
    pub fn degrees_log2(&self) -> Vec<Option<f64>> {
        let Some(doublings) = self.doublings() else { return vec![None; self.claims.len()] };
        let all = vec![true; self.formulas.program.nodes.len()];
        let degrees =
            self.formulas.evaluate(&all, (), &Formal { doublings: HALVINGS + doublings }, &|source| {
                point::degree(self.model, self.module, source)
            });
        let of_claim = |residuals: &Option<Vec<Id>>| self.degree_log2(residuals.as_ref()?, &degrees);
        self.claims.iter().map(of_claim).collect()
    }

    /// How often an angle must be doubled at most to be another one, as 384-bit floats have it at a point: angles of
    /// which that is so only there count too, which makes degrees larger than they are. `None` if an angle exists at no
    /// point.
    fn doublings(&self) -> Option<u32> {
        let angles = self.formulas.program.nodes.iter().filter_map(|node| match *node {
            Node::Call(Function::Sin | Function::Cos, [angle, _]) => Some(angle),
            _ => None,
        });
        let angles: BTreeSet<Id> = angles.collect();
        let needed = self.formulas.reach(angles.iter().copied());
        let precision = Precision::new();
        let sizes = (0..DRAWS).find_map(|number| {
            let mut random = Seed::FIXED.numbers(number);
            let mut draw = point::real(self.model, self.module, &precision, &mut random)?;
            for parameter in draw.point.parameters.iter_mut().filter(|parameter| parameter.is_zero()) {
                *parameter = Real::new(&precision, random.random_range(0.75..1.25));
            }
            let values =
                self.formulas.evaluate(&needed, &precision, &Elementary, &|source| draw.read(source));
            let size = |angle: &Id| Some(values[*angle].as_ref()?.to_f64().abs().log2());
            let sizes: Vec<f64> = angles.iter().map(size).collect::<Option<_>>()?;
            sizes.iter().all(|size| !size.is_nan()).then_some(sizes)
        })?;
        let ratios = sizes.iter().flat_map(|large| sizes.iter().map(move |small| large - small));
        let is_whole = |ratio: &f64| ratio.is_finite() && (ratio - ratio.round()).abs() < NEARLY_WHOLE;
        Some(ratios.filter(is_whole).fold(0.0, f64::max).round() as u32)
    }

    fn degree_log2(&self, residuals: &[Id], degrees: &[Option<Degree>]) -> Option<f64> {
        let reach = self.formulas.reach(residuals.iter().copied());
        let whole = |id: &Id| degrees[*id].as_ref().map(Degree::whole_log2);
        let largest = residuals.iter().map(whole).collect::<Option<Vec<f64>>>()?;
        let largest = largest.into_iter().fold(0.0, f64::max);
        let nodes = self.formulas.program.nodes.iter().zip(&reach);
        let atoms =
            nodes.filter(|(node, reached)| **reached && matches!(node, Node::Call(..) | Node::Curve { .. }));
        let arguments: Vec<Id> = atoms.flat_map(|(node, _)| node.operands()).collect();
        let all = arguments.iter().filter_map(whole).fold(f64::NEG_INFINITY, sum_log2);
        let collisions = all + (arguments.len() as f64).log2() + f64::from(WAYS_TO_MEET).log2();
        let n_roots = self.roots(&reach).len() as f64;
        Some(sum_log2(largest, collisions) + 2.0 * (n_roots + 1.0) + ROUNDING_LOG2)
    }

    /// The square roots among some nodes.
    pub(super) fn roots(&self, reach: &[bool]) -> Vec<(Id, Id)> {
        let nodes = self.formulas.program.nodes.iter().enumerate();
        let roots = nodes.filter(|(id, _)| reach[*id]);
        let root = |(id, node): (Id, &Node)| match *node {
            Node::Call(Function::Sqrt, [radicand, _]) => Some((id, radicand)),
            _ => None,
        };
        roots.filter_map(root).collect()
    }

    /// Only what roots depend on, with the roots in it.
    pub(super) fn part_of_roots(&self, roots: &[(Id, Id)]) -> (Formulas, Vec<(Id, Id)>) {
        let (part, places) = self.formulas.part(roots.iter().flat_map(|&(root, radicand)| [root, radicand]));
        (part, places.chunks_exact(2).map(|pair| (pair[0], pair[1])).collect())
    }

    /// Whether roots of parameters alone are among some nodes.
    pub(super) fn has_roots_of_parameters(&self, reach: &[bool]) -> bool {
        self.roots(reach)
            .iter()
            .any(|&(_, radicand)| self.parameters_of(radicand).is_some_and(|of| !of.is_empty()))
    }

    /// The parameters that a formula depends on if it depends on nothing else.
    pub(super) fn parameters_of(&self, id: Id) -> Option<Vec<usize>> {
        let nodes = self.formulas.program.nodes.iter().zip(self.formulas.reach([id]));
        let reads = nodes.filter(|(_, reached)| *reached).filter_map(|(node, _)| match *node {
            Node::Read(source) => Some(source),
            _ => None,
        });
        let parameter = |source| if let Source::Parameter(k) = source { Some(k) } else { None };
        reads.map(parameter).collect()
    }

    /// Whether all of some residuals are zero.
    pub(super) fn outcome<F: Field>(
        &self,
        residuals: &[Id],
        values: &[Option<F>],
        is_zero: impl Fn(&F) -> bool,
    ) -> Outcome {
        for (residual, &id) in residuals.iter().enumerate() {
            match &values[id] {
                Some(value) if is_zero(value) => {}
                Some(_) => return Outcome::NotZero { residual },
                None => return Outcome::DividesByZero { line: self.formulas.culprit(values, id) },
            }
        }
        Outcome::Zero
    }
}

/// In how many ways two arguments may be one family by accident: by sign, and by any of the halves of either.
const WAYS_TO_MEET: u32 = 2 * (2 * HALVINGS + 1);

/// Angles whose ratio's logarithm to base two is this near to a whole number are doubles of each other: more than `f64`
/// makes of it.
const NEARLY_WHOLE: f64 = 1e-9;

/// More than all roundings of the logarithms of degrees can make.
const ROUNDING_LOG2: f64 = 1e-3;

/// [`Statements::prime`] of all claims about a module.
///
/// # Errors
/// The number of bits that the roots take, if they are too many.
pub fn prime<const L: usize>(model: &Model, module: &Module, seed: impl Into<Seed>) -> Result<Prime<L>, u64> {
    Statements::new(model, module, &Claim::all(module)).prime(seed.into(), &[])
}

/// The number with small primes taken once: it has the same prime factors.
fn radical(mut number: BigUint) -> BigUint {
    for factor in 2..1000_u32 {
        let square = BigUint::from(factor * factor);
        while (&number % &square).to_u32() == Some(0) {
            number /= factor;
        }
    }
    number
}
