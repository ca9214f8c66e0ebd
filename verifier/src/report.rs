//! What was proved of a module, for people and for programs.

use crate::data_sheet::PROOF;
use crate::divisors::Divisor;
use crate::proof::{Claim, Verdict};
use crate::refusal::Refusal;
use crate::seed::Seed;
use serde_json::{Value, json};
use std::fmt;

/// The largest probability of a false proof that is accepted, as a logarithm to base ten.
pub const ACCEPTED_LOG10: f64 = -30.0;

/// There are no more claims than this, so that the sum of their errors is less than so many times the largest.
const MOST_CLAIMS: f64 = 32.0;

/// All that was found out about a module.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// Name of the mechanism.
    pub mechanism: String,
    /// Bits of the prime.
    pub prime_bits: u64,
    /// Whether the prime is the Mersenne prime of these bits; otherwise it was drawn so that the constants have their
    /// roots.
    pub is_mersenne: bool,
    /// Points at which each claim was tested.
    pub points: u32,
    /// What the points, and a prime that was drawn, come from.
    pub seed: Seed,
    /// The claims.
    pub findings: Vec<Finding>,
    /// What is wrong with the text or its exact constants so that nothing could be proved.
    pub refusals: Vec<Refusal>,
    /// What is wrong with the start or the signs of readings.
    pub problems: Vec<String>,
    /// What is not wrong but could be better: zeros that are stored, numbers that are computed twice or not used, or
    /// counted wrongly.
    pub flaws: Vec<String>,
    /// All divisions, with whether what they divide by is never zero.
    pub divisors: Vec<Divisor>,
    /// What could not be decided, besides findings.
    pub undecided: Vec<String>,
}

/// A claim with its verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// What is claimed, of which functions.
    pub claim: Claim,
    /// How it was decided.
    pub verdict: Verdict,
}

impl Finding {
    /// Whether the claim is proved well enough.
    pub fn is_proved(&self) -> bool {
        matches!(self.verdict, Verdict::Proved { error_log10, .. } if error_log10 <= ACCEPTED_LOG10)
    }

    /// The bound on the probability that the claim is false, as a logarithm to base ten.
    fn error_log10(&self) -> f64 {
        match self.verdict {
            Verdict::Proved { error_log10, .. } => error_log10,
            _ => 0.0,
        }
    }

    /// Whether the claim was shown to be false.
    pub fn is_refuted(&self) -> bool {
        matches!(self.verdict, Verdict::Refuted { .. } | Verdict::Divides { .. })
    }

    fn functions(&self) -> String {
        self.claim.functions().join(", ")
    }

    fn to_json(&self) -> Value {
        let (verdict, detail) = match self.verdict {
            Verdict::Proved { error_log10, degree_log2 } => {
                ("proved", json!({ "error_log10": error_log10, "degree_log2": degree_log2 }))
            }
            Verdict::Refuted { residual } => ("refuted", json!({ "residual": residual })),
            Verdict::Divides { line } => ("refuted", json!({ "line": line })),
            Verdict::Undecided => ("undecided", json!({})),
        };
        json!({
            "functions": self.claim.functions(),
            "claim": self.claim.words(),
            "verdict": verdict,
            "is_proved": self.is_proved(),
            "detail": detail,
        })
    }
}

impl Report {
    /// Whether all is proved and nothing is wrong.
    pub fn is_proved(&self) -> bool {
        self.is_right() && self.flaws.is_empty()
    }

    /// Whether all is proved, though it may be flawed.
    pub fn is_right(&self) -> bool {
        !self.findings.is_empty()
            && self.findings.iter().all(Finding::is_proved)
            && self.refusals.is_empty()
            && self.problems.is_empty()
            && self.undecided.is_empty()
    }

    /// Whether something was shown to be wrong. What is neither proved nor refuted is undecided, or right but flawed.
    pub fn is_refuted(&self) -> bool {
        !self.refusals.is_empty()
            || !self.problems.is_empty()
            || self.findings.iter().any(Finding::is_refuted)
    }

    /// The bound on the probability that any claim of the report is false, as a logarithm to base ten; zero where
    /// something is not proved.
    pub fn error_log10(&self) -> f64 {
        if !self.is_right() {
            return 0.0;
        }
        let errors = self.findings.iter().map(Finding::error_log10);
        errors.fold(f64::NEG_INFINITY, f64::max) + MOST_CLAIMS.log10()
    }

    /// What the data sheet of the module says of the proof: a section of lines.
    pub fn section(&self) -> Vec<String> {
        let (proved, open): (Vec<&Finding>, Vec<&Finding>) =
            self.findings.iter().partition(|f| f.is_proved());
        let proved: Vec<Claim> = proved.into_iter().map(|finding| finding.claim).collect();
        let open = open.into_iter().map(Finding::functions).chain(self.undecided.iter().cloned());
        section(&proved, &open.collect::<Vec<_>>())
    }

    /// The report as JSON.
    pub fn to_json(&self) -> Value {
        let of_divisor = |divisor: &Divisor| json!({ "function": divisor.function, "line": divisor.line, "is_never_zero": divisor.is_never_zero });
        let refusals = self.refusals.iter().map(|r| json!({ "line": r.line, "message": r.message }));
        json!({
            "mechanism": self.mechanism,
            "is_proved": self.is_proved(),
            "is_refuted": self.is_refuted(),
            "error_log10": self.error_log10(),
            "prime": self.prime(),
            "prime_bits": self.prime_bits,
            "points": self.points,
            "seed": self.seed.to_string(),
            "findings": self.findings.iter().map(Finding::to_json).collect::<Vec<_>>(),
            "refusals": refusals.collect::<Vec<_>>(),
            "problems": self.problems,
            "flaws": self.flaws,
            "undecided": self.undecided,
            "divisors": self.divisors.iter().map(of_divisor).collect::<Vec<_>>(),
        })
    }

    /// How many divisions there are, and function by function the lines of those by what may be zero.
    fn divisors_in_words(&self) -> Vec<String> {
        let total = self.divisors.len();
        let open: Vec<&Divisor> = self.divisors.iter().filter(|divisor| !divisor.is_never_zero).collect();
        let head = format!("{} of {total} divisors are never zero; the others by line", total - open.len());
        let of_function = |group: &[&Divisor]| {
            let lines: Vec<String> = group.iter().map(|divisor| divisor.line.to_string()).collect();
            format!("  {}: {}", group[0].function, lines.join(", "))
        };
        let groups = open.chunk_by(|a, b| a.function == b.function).map(of_function);
        let head = (total > 0).then_some(if open.is_empty() {
            format!("all {total} divisors are never zero")
        } else {
            head
        });
        head.into_iter().chain(groups).collect()
    }

    /// The prime in words; none where nothing was tested.
    fn prime(&self) -> Option<String> {
        let of_bits = |bits: u64| {
            if self.is_mersenne { format!("2^{bits} - 1") } else { format!("random, {bits} bits") }
        };
        (self.prime_bits > 0).then(|| of_bits(self.prime_bits))
    }
}

/// The section of a data sheet on claims that are proved, and on what is not.
pub(crate) fn section(proved: &[Claim], open: &[String]) -> Vec<String> {
    let mut lines = vec![
        PROOF.to_owned(),
        String::new(),
        "Equal to the textbook's, by identity testing at a point of a fixed seed (`cargo xtask verify` draws it anew):".to_owned(),
    ];
    for group in proved.chunk_by(|a, b| a.against() == b.against()) {
        let functions: Vec<&str> = group.iter().flat_map(|claim| claim.functions()).collect();
        lines.push(format!("* {}: {}", functions.join(", "), group[0].against()));
    }
    let not_proved: Vec<&str> =
        open.iter().map(String::as_str).chain(["the size of rounding errors"]).collect();
    lines.extend([String::new(), format!("Not proved: {}.", not_proved.join(", "))]);
    lines
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = match (self.is_proved(), self.is_refuted()) {
            (true, _) => "proved",
            (_, true) => "REFUTED",
            _ if self.undecided.is_empty() && self.findings.iter().all(Finding::is_proved) => {
                "PROVED, BUT FLAWED"
            }
            _ => "NOT PROVED",
        };
        write!(f, "{}: {verdict}", self.mechanism)?;
        match self.prime() {
            Some(prime) => writeln!(f, " (prime: {prime}; points: {}; seed: {})", self.points, self.seed)?,
            None => writeln!(f)?,
        }
        for refusal in &self.refusals {
            writeln!(f, "  {refusal}")?;
        }
        for problem in self.problems.iter().chain(&self.flaws).chain(&self.undecided) {
            writeln!(f, "  {problem}")?;
        }
        for finding in &self.findings {
            let verdict = match finding.verdict {
                Verdict::Proved { error_log10, degree_log2 } => {
                    format!("degree < 2^{:.0}, error < 1e{:.0}", degree_log2.ceil(), error_log10.ceil())
                }
                Verdict::Refuted { residual } => format!("REFUTED: number {residual} is not zero"),
                Verdict::Divides { line } => format!("REFUTED: line {line} divides by zero"),
                Verdict::Undecided => "UNDECIDED: no point has all roots and quotients".to_owned(),
            };
            writeln!(f, "  {:26} {:58} {verdict}", finding.functions(), finding.claim.words())?;
        }
        self.divisors_in_words().into_iter().try_for_each(|line| writeln!(f, "  {line}"))
    }
}
