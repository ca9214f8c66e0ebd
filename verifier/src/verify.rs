//! Verifies one module from its text.

use crate::divisors::divisors;
use crate::module::Module;
use crate::proof::{Claim, Decider, Statements, Verdict};
use crate::report::{self, ACCEPTED_LOG10, Finding, Report};
use crate::seed::Seed;
use crate::{data_sheet, finite, numeric, structure};
use gyro_model::Model;
use gyro_program::Kernel;
use num_bigint::BigUint;
use std::f64::consts::LOG10_2;

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

/// Verifies a module's text, and the text of its exact constants, against the model that it claims to be of.
///
/// Nothing of the module is believed: its text must be of the subset that the generator writes, everything in it but
/// the formulas as the model determines it, and the formulas equal to the textbook's. The same module is tested in the
/// same way each time: whoever knows that can write a wrong one that passes, by chance or otherwise, so that nobody's
/// word need be taken use [`verify_at`].
pub fn verify(model: &Model, module: &str, constants: &str, depth: Depth) -> Report {
    verify_at(model, module, constants, depth, Seed::FIXED)
}

/// The same with the prime and the points of a seed, such as [`Seed::fresh`].
pub fn verify_at(model: &Model, module: &str, constants: &str, depth: Depth, seed: Seed) -> Report {
    let empty = Report { mechanism: model.name.clone(), points: depth.points(), seed, ..Report::default() };
    match Module::read(model, module, constants) {
        Ok(module) => prove(model, &module, empty),
        Err(refusal) => Report { refusals: vec![refusal], ..empty },
    }
}

/// A module's text with the section on its proof on the data sheet, and the report on this very text, byte for byte.
pub fn with_proof(model: &Model, module: &str, constants: &str, depth: Depth) -> (String, Report) {
    // What will be proved is nearly always all.
    let Ok(read) = Module::read(model, module, constants) else {
        return (module.to_owned(), verify(model, module, constants, depth));
    };
    let text = with_section(module, &report::section(&claims(model, &read), &[]));
    let report = verify(model, &text, constants, depth);
    let section = report.section();
    if report.findings.is_empty() || report::section(&claims(model, &read), &[]) == section {
        return (text, report);
    }
    let text = with_section(module, &section);
    let report = verify(model, &text, constants, depth);
    (text, report)
}

/// A module with more lines at the end of its data sheet.
fn with_section(module: &str, lines: &[String]) -> String {
    let is_sheet = |line: &&str| {
        line.starts_with("//!") || !(line.starts_with("///") || line.starts_with(char::is_alphabetic))
    };
    let lines_before = module.split_inclusive('\n').take_while(is_sheet);
    let (head, rest) = module.split_at(lines_before.map(str::len).sum());
    let lines: String = lines.iter().map(|line| format!("//! {line}").trim_end().to_owned() + "\n").collect();
    format!("{}\n//!\n{lines}\n{rest}", head.trim_end())
}

/// What is claimed of a module.
fn claims(model: &Model, module: &Module) -> Vec<Claim> {
    let mut claims = Claim::all(module);
    claims.retain(|claim| claim.0 != Kernel::Outputs || !model.outputs.is_empty());
    // Where rows depend on each other, the forces that they share and the motion off the trees' joints are left open.
    let is_open = |claim: &Claim| {
        use Kernel::{Accelerations, CorrectedMultipliers, CorrectedSolution, Project};
        matches!(claim.0, CorrectedMultipliers | CorrectedSolution | Accelerations | Project)
    };
    claims.retain(|claim| model.dependent_rows().is_empty() || !is_open(claim));
    claims
}

/// Proves a module that was read.
fn prove(model: &Model, module: &Module, report: Report) -> Report {
    let mut report = Report {
        flaws: structure::problems(model, module).iter().map(ToString::to_string).collect(),
        problems: [
            numeric::problems(model, module, report.seed),
            finite::problems(model, module, report.seed),
        ]
        .concat(),
        divisors: divisors(model, module),
        ..report
    };
    let claims = claims(model, module);
    let statements = Statements::new(model, module, &claims);
    let degree_log2 = statements.degrees_log2().into_iter().flatten().fold(0.0, f64::max);
    let points = f64::from(report.points);
    let bounds_error = |bits: u64| points * (degree_log2 - bits as f64) * LOG10_2 <= ACCEPTED_LOG10;
    let always = |_: u64| true;
    // Where no prime is long enough to bound the error, the shortest may still show a mistake.
    let tested = by_shortest(model, module, &statements, &report, &bounds_error)
        .or_else(|| by_shortest(model, module, &statements, &report, &always));
    let Some(tested) = tested else {
        report.undecided.push("the square roots of the constants need too long a prime".to_owned());
        return report;
    };
    let findings = claims.into_iter().zip(tested.verdicts);
    report.findings = findings.map(|(claim, verdict)| Finding { claim, verdict }).collect();
    match tested.sparsity {
        Ok(flaws) => report.flaws.extend(flaws),
        Err(_) => report.undecided.push("the patterns could be tested at no point".to_owned()),
    }
    report.prime_bits = tested.prime.bits();
    report.is_mersenne = tested.prime.count_ones() == report.prime_bits;
    if data_sheet::proof(module).is_some_and(|section| section != report.section()) {
        report
            .flaws
            .push("the data sheet's section on the proof says something else than was proved".to_owned());
    }
    report
}

/// What came of tests modulo a prime.
struct Tested {
    prime: BigUint,
    verdicts: Vec<Verdict>,
    sparsity: Result<Vec<String>, Verdict>,
}

/// Tests modulo the shortest of three primes that has the roots of the constants and is long enough.
fn by_shortest(
    model: &Model,
    module: &Module,
    statements: &Statements<'_>,
    report: &Report,
    is_long_enough: &dyn Fn(u64) -> bool,
) -> Option<Tested> {
    modulo::<9>(model, module, statements, report, is_long_enough)
        .or_else(|| modulo::<36>(model, module, statements, report, is_long_enough))
        .or_else(|| modulo::<70>(model, module, statements, report, is_long_enough))
}

/// Tests modulo a prime of this many limbs; `None` if it is too short.
fn modulo<const L: usize>(
    model: &Model,
    module: &Module,
    statements: &Statements<'_>,
    report: &Report,
    is_long_enough: &dyn Fn(u64) -> bool,
) -> Option<Tested> {
    if !is_long_enough(64 * L as u64) {
        return None;
    }
    let decider = |open: &[usize]| {
        let prime = statements.prime::<L>(report.seed, open).ok()?;
        is_long_enough(prime.value().bits() - 1).then(|| Decider::<L>::new(model, prime))
    };
    let tests = |decider: Decider<L>| Tested {
        verdicts: decider.decide_all(statements, report.points, report.seed),
        sparsity: decider.sparsity(module, report.seed),
        prime: decider.prime().value().clone(),
    };
    let tested = tests(decider(&[])?);
    let open: Vec<usize> =
        (0..tested.verdicts.len()).filter(|&k| tested.verdicts[k] == Verdict::Undecided).collect();
    if open.is_empty() {
        return Some(tested);
    }
    // Modulo another prime roots may exist together that modulo this one never do.
    let again = decider(&open).map(tests).filter(|again| !again.verdicts.contains(&Verdict::Undecided));
    again.or(Some(tested))
}
