//! Verifies one module from its text.

use crate::field::Prime;
use crate::module::Module;
use crate::proof::{self, Claim, Decider, Verdict};
use crate::refusal::Refusal;
use crate::report::{ACCEPTED_LOG10, Finding, Report};
use crate::{numeric, structure};
use gyro_model::Model;

/// How thorough to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// Two points for each claim: what is published.
    Full,
    /// One point: what a tool does each time it writes a module.
    Quick,
}

impl Depth {
    fn points(self) -> u32 {
        match self {
            Self::Full => 2,
            Self::Quick => 1,
        }
    }
}

/// Seed of the prime and the points: the same module is tested in the same way each time.
const SEED: u64 = 0x6779_726f;

/// Verifies a module's text, and the text of its exact constants, against the model that it claims to be of.
///
/// Nothing of the module is believed: its text must be of the subset that the generator writes, everything in it but the
/// formulas as the model determines it, and the formulas equal to the textbook's.
pub fn verify(model: &Model, module: &str, constants: &str, depth: Depth) -> Report {
    let empty = Report { mechanism: model.name.clone(), points: depth.points(), ..Report::default() };
    match Module::read(model, module, constants) {
        Ok(module) => prove(model, &module, empty),
        Err(refusal) => Report { refusals: vec![refusal], ..empty },
    }
}

/// Proves a module that was read, modulo the shorter of two primes that has the roots and bounds the error.
fn prove(model: &Model, module: &Module, report: Report) -> Report {
    let report = Report {
        refusals: structure::problems(model, module),
        problems: numeric::problems(model, module),
        ..report
    };
    modulo::<9>(model, module, &report).or_else(|| modulo::<36>(model, module, &report)).unwrap_or_else(
        || {
            let refusal =
                Refusal::new(1, "the square roots of the constants or the degrees need too long a prime");
            Report { refusals: vec![refusal], ..report }
        },
    )
}

/// Proves modulo a prime of this many limbs; `None` if it is too short.
fn modulo<const L: usize>(model: &Model, module: &Module, report: &Report) -> Option<Report> {
    let decider = Decider::<L>::new(model, proof::prime(model, module, SEED).ok()?);
    let is_long_enough = |verdict: &Verdict| match verdict {
        Verdict::Proved { error_log10, .. } => *error_log10 <= ACCEPTED_LOG10,
        _ => true,
    };
    let mut report = report.clone();
    for claim in Claim::all(module.n_charts.is_some()) {
        let verdict = decider.decide(module, claim, report.points, SEED);
        if !is_long_enough(&verdict) {
            return None;
        }
        report.findings.push(Finding { claim, verdict });
    }
    match decider.sparsity(module, SEED) {
        Ok(problems) => report.problems.extend(problems),
        Err(_) => report.problems.push("the patterns could not be tested at any point".to_owned()),
    }
    report.prime_bits = decider.prime().value().bits();
    report.is_mersenne = decider.prime().value() == Prime::<9>::mersenne().value();
    Some(report)
}
