//! Decides claims at random points and bounds the probability of a wrong yes.
//!
//! A claim's residuals are quotients of polynomials in what is drawn. If one is not zero identically, its numerator, of degree d,
//! vanishes at a random point with probability at most d / p (Schwartz 1980, Zippel 1979).

use super::case::{Case, Undecided};
use super::claim::Claim;
use super::point;
use crate::atoms::{Drawn, Formal};
use crate::field::{Degree, Field, Modular, Prime};
use crate::interpreter::{self, Given};
use crate::module::Module;
use crate::program::Node;
use crate::textbook::Textbook;
use gyro_model::Model;
use num_bigint::BigUint;
use num_integer::Integer;
use num_traits::ToPrimitive;
use rand::SeedableRng;
use rand_chacha::ChaCha8Rng;
use std::cell::RefCell;
use std::collections::HashMap;

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
    /// No point could be found at which both sides exist.
    Undecided {
        /// Line of the module where it divides by zero; `None` if the textbook does or a root is missing.
        line: Option<usize>,
    },
}

impl From<Undecided> for Verdict {
    fn from(undecided: Undecided) -> Self {
        match undecided {
            Undecided::Module(line) => Self::Undecided { line: Some(line) },
            Undecided::Textbook => Self::Undecided { line: None },
        }
    }
}

/// An operation whose result is known without it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Needless {
    /// Its line.
    pub line: usize,
    /// Line of the value that it has, up to its sign; `None` of zero.
    pub same_as: Option<usize>,
}

/// Decides the claims about one module.
#[derive(Debug)]
pub struct Decider<'a, const L: usize> {
    model: &'a Model,
    textbook: Textbook<'a>,
    prime: Prime<L>,
    /// For each seed the draw at which all roots were found to exist.
    draws: RefCell<HashMap<u64, u64>>,
}

/// Draws at most this often until all roots exist: each root of a number that varies exists at every other point.
const DRAWS: u64 = 4096;

/// Draws at most this often where something divides by zero: at a random point only what is zero everywhere is zero.
const DRAWS_BY_ZERO: usize = 3;

impl<'a, const L: usize> Decider<'a, L> {
    /// For a model and a prime that was made for it.
    pub fn new(model: &'a Model, prime: Prime<L>) -> Self {
        Self { model, textbook: Textbook::new(model), prime, draws: RefCell::default() }
    }

    /// The prime.
    pub fn prime(&self) -> &Prime<L> {
        &self.prime
    }

    /// Tests a claim at some points; `seed` makes them other points.
    pub fn decide(&self, module: &Module, claim: Claim, points: u32, seed: u64) -> Verdict {
        for point in 0..u64::from(points) {
            match self.test(module, claim, seed.wrapping_add(point << 32)) {
                Ok(residuals) => {
                    if let Some(residual) = residuals {
                        return Verdict::Refuted { residual };
                    }
                }
                Err(undecided) => return undecided.into(),
            }
        }
        self.bound(module, claim, points)
    }

    /// Whether a function of one module gives the same numbers as that of another one at a random point; `None` if one of them exists at
    /// no point. Functions that read accelerations are given those of the first module.
    pub fn agree(&self, modules: [&Module; 2], function: &str, seed: u64) -> Option<bool> {
        let agree = |case: &Case<Modular<'_, L>>| {
            let accelerations = case.of(modules[0]).run("accelerations", &case.point)?;
            let run = |module| case.of(module).run_with(function, &case.point, &accelerations);
            Ok(run(modules[0])? == run(modules[1])?)
        };
        let same_places = modules[0].programs[function].places == modules[1].programs[function].places;
        self.at_point(modules[0], seed, agree).ok().map(|agree| agree && same_places)
    }

    /// Operations whose value, up to its sign, is zero or one that is known before, wherever |p| = 1: what a cleverer generator could
    /// leave out. They are no fault. `None` if the function exists at no point.
    pub fn needless(&self, module: &Module, function: &str, seed: u64) -> Option<Vec<Needless>> {
        self.at_point(module, seed, |case| needless(case, function)).ok()
    }

    /// What is wrong with the patterns: zeros that are stored, places out of order. (That no place is missing is part of the claims.)
    ///
    /// A number that is zero at a random point is zero identically, with the probability of its claim.
    pub fn sparsity(&self, module: &Module, seed: u64) -> Result<Vec<String>, Verdict> {
        let patterns = [("phi_q", &module.phi_q_pattern), ("phi_pi", &module.phi_pi_pattern)];
        let mut problems = Vec::new();
        for (matrix, pattern) in patterns {
            let values = |case: &Case<Modular<L>>| {
                Ok(case.run(matrix, &case.point)?.iter().map(Field::is_zero).collect::<Vec<_>>())
            };
            let is_zero = self.at_point(module, seed, values).map_err(Verdict::from)?;
            let zeros = pattern.iter().zip(is_zero).filter(|(_, zero)| *zero);
            problems.extend(zeros.map(|(place, _)| format!("`{matrix}` stores the zero at {place:?}")));
            let unsorted = pattern.windows(2).find(|pair| pair[0] >= pair[1]);
            problems.extend(unsorted.map(|pair| format!("`{matrix}` has {:?} after {:?}", pair[1], pair[0])));
        }
        Ok(problems)
    }

    /// The first residual that is not zero at one point at which all exist.
    fn test(&self, module: &Module, claim: Claim, seed: u64) -> Result<Option<usize>, Undecided> {
        self.at_point(module, seed, |case| {
            Ok(claim.residuals(case)?.iter().position(|residual| !residual.is_zero()))
        })
    }

    /// Evaluates something at a random point at which it exists.
    fn at_point<R>(
        &self,
        module: &Module,
        seed: u64,
        evaluate: impl Fn(&Case<Modular<'_, L>>) -> Result<R, Undecided>,
    ) -> Result<R, Undecided> {
        let mut zeros = Vec::new();
        let first = self.draws.borrow().get(&seed).copied().unwrap_or(0);
        for number in first..first + DRAWS {
            let mut random = ChaCha8Rng::seed_from_u64(seed.wrapping_add(number));
            let atoms = Drawn::new(&self.prime, ChaCha8Rng::from_rng(&mut random));
            let Some(point) = point::drawn(self.model, &self.prime, &mut random) else { continue };
            let mut draw = || self.prime.draw(&mut random);
            let case = Case {
                model: self.model,
                textbook: &self.textbook,
                module,
                constants: interpreter::constants(&self.prime, module),
                atoms: &atoms,
                factors: (0..self.model.coordinate_bodies().len()).map(|_| draw()).collect(),
                charts: (0..module.n_charts.unwrap_or(0)).map(|_| [(); 4].map(|()| draw())).collect(),
                point,
            };
            let result = evaluate(&case);
            if atoms.missed_root() {
                continue;
            }
            self.draws.borrow_mut().insert(seed, number);
            match result {
                Ok(result) => return Ok(result),
                Err(undecided) => zeros.push(undecided),
            }
            if zeros.len() == DRAWS_BY_ZERO {
                break;
            }
        }
        Err(zeros.pop().unwrap_or(Undecided::Textbook))
    }

    /// The bound on the probability of an accident.
    fn bound(&self, module: &Module, claim: Claim, points: u32) -> Verdict {
        let Some(degree) = degree(self.model, &self.textbook, module, claim) else {
            return Verdict::Undecided { line: None };
        };
        let degree_log2 = degree.log2();
        let bits = self.prime.value().bits() as f64 - 1.0;
        let error_log10 = f64::from(points) * (degree_log2 - bits).min(0.0) * std::f64::consts::LOG10_2;
        Verdict::Proved { error_log10, degree_log2 }
    }
}

fn needless<const L: usize>(case: &Case<Modular<'_, L>>, function: &str) -> Result<Vec<Needless>, Undecided> {
    let accelerations = case.run("accelerations", &case.point)?;
    let given = Given { point: &case.point, accelerations: &accelerations, charts: &case.charts };
    let program = &case.module.programs[function];
    let values = interpreter::values(case.module, program, &case.constants, case.atoms, &given)?;
    let (mut known, mut needless) = (HashMap::new(), Vec::new());
    for ((node, value), &line) in program.nodes.iter().zip(&values).zip(&program.lines) {
        let is_operation = matches!(node, Node::Add(..) | Node::Sub(..) | Node::Mul(..) | Node::Div(..));
        let keys = [value.key(), value.neg().key()];
        let same_as = keys.iter().find_map(|key| known.get(key).copied());
        if is_operation && (value.is_zero() || same_as.is_some()) {
            needless.push(Needless { line, same_as: same_as.filter(|_| !value.is_zero()) });
        }
        known.entry(keys[0]).or_insert(line);
    }
    Ok(needless)
}

/// A bound on the degree that decides a claim: of the numerator of any residual, of all denominators on the way, and of
/// whatever makes two atoms one by accident; each root of a number that varies doubles it (the norm of `f + g √x` is `f² − g² x`) and
/// leaves half of the points. `None` if the formulas divide by what is zero identically.
fn degree(model: &Model, textbook: &Textbook, module: &Module, claim: Claim) -> Option<f64> {
    let atoms = Formal::default();
    let case = Case {
        model,
        textbook,
        module,
        constants: interpreter::constants((), module),
        atoms: &atoms,
        point: point::degrees(model),
        factors: vec![Degree::polynomial(1.0); model.coordinate_bodies().len()],
        charts: vec![[Degree::polynomial(1.0); 4]; module.n_charts.unwrap_or(0)],
    };
    let residuals = claim.residuals(&case).ok()?;
    let largest = residuals.iter().map(|x| x.numerator + x.denominator).fold(1.0, f64::max);
    Some((largest + atoms.collisions()) * 4.0_f64.powf(atoms.roots() + 1.0))
}

/// A prime for which all constants of a module and a model have their roots: 2^521 − 1 if it is one and nine limbs are asked
/// for, else a random one of all the bits that there is room for.
///
/// # Errors
/// The number of bits that the roots take, if they are too many.
pub fn prime<const L: usize>(model: &Model, module: &Module, seed: u64) -> Result<Prime<L>, u64> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let textbook = Textbook::new(model);
    let mut squares = BigUint::from(1_u32);
    let longest =
        |squares: &BigUint, random: &mut ChaCha8Rng| Prime::with_roots(squares, random).ok_or(squares.bits());
    let mut prime = if L == 9 { Prime::mersenne() } else { longest(&squares, &mut random)? };
    loop {
        interpreter::constants::<Modular<L>>(&prime, module);
        let atoms = Drawn::new(&prime, random.clone());
        if let Some(point) = point::drawn(model, &prime, &mut random) {
            let evaluation = textbook.at(&point, &atoms);
            evaluation.and_then(|evaluation| evaluation.phi());
        }
        let missed = prime.missed();
        if missed.is_empty() {
            return Ok(prime);
        }
        for radicand in missed {
            let number = radical(radicand.numer().magnitude() * radicand.denom().magnitude());
            squares = squares.lcm(&number);
        }
        prime = longest(&squares, &mut random)?;
    }
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
