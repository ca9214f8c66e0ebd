//! Fault injection: emitted modules with one thing wrong must not be proved.
//!
//! Formulas are mutated after they were read, so that a mutant differs in nothing but its formula; the text is mutated
//! as text.

use crate::faults::{Fault, apply, faults};
use crate::support::Page;
use chacha20::ChaCha8Rng;
use gyro_verifier::field::Prime;
use gyro_verifier::module::Module;
use gyro_verifier::proof::{Claim, Decider, Verdict, prime};
use gyro_verifier::{Depth, verify};
use rand::{RngExt, SeedableRng};
use std::collections::BTreeMap;

/// Model files whose modules are mutated, and how many mutants of each are tried.
const MUTATED: [(&str, usize); 12] = [
    ("gyroscope", 100),
    ("gyroscope-maximal", 100),
    ("gyroscope-parameters", 100),
    ("gyroscope-viscous", 80),
    ("pitching-gyroscope", 70),
    ("driven-gyroscope", 100),
    ("torsion", 100),
    ("free-body", 100),
    ("heavy-top", 100),
    ("four-bar", 100),
    ("stops", 100),
    ("cam", 50),
];

/// Seed of the points.
const SEED: u64 = 11;

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn no_inequivalent_mutant_of_a_formula_survives() {
    let (mut count, mut equivalent, mut survivors) = (0, Vec::new(), Vec::new());
    let mut kinds = BTreeMap::<String, usize>::new();
    let fates = std::thread::scope(|scope| {
        let (left, right) = MUTATED.split_at(MUTATED.len() / 2);
        let threads = [left, right].map(|pages| scope.spawn(|| pages.iter().map(fates).collect::<Vec<_>>()));
        threads.map(|thread| thread.join().expect("no panic but of the verifier"))
    });
    for fates in fates.into_iter().flatten() {
        count += fates.count;
        equivalent.extend(fates.equivalent);
        survivors.extend(fates.survivors);
        fates.kinds.into_iter().for_each(|(kind, count)| *kinds.entry(kind).or_default() += count);
    }
    println!("{count} mutants of formulas: {kinds:?}");
    println!("{} compute the same function:\n{}", equivalent.len(), equivalent.join("\n"));
    assert!(survivors.is_empty(), "{} survivors:\n{}", survivors.len(), survivors.join("\n"));
    assert!(count >= 1000, "{count} are too few");
}

/// What became of the mutants of some modules.
#[derive(Default)]
struct Fates {
    count: usize,
    equivalent: Vec<String>,
    survivors: Vec<String>,
    kinds: BTreeMap<String, usize>,
}

fn fates(&(name, mutants): &(&str, usize)) -> Fates {
    let mut fates = Fates::default();
    let page = crate::support::page(name);
    let module = Module::read(&page.model, &page.code, &page.constants).expect("the emitted subset");
    let prime: Prime<9> = prime(&page.model, &module, SEED).expect("room for all roots");
    let decider = Decider::new(&page.model, prime);
    for (function, fault) in sample(&module, mutants) {
        let Some(mutant) = apply(&module, &function, &fault) else { continue };
        fates.count += 1;
        *fates
            .kinds
            .entry(format!("{fault:?}").split('(').next().unwrap_or_default().to_owned())
            .or_default() += 1;
        if is_killed(&decider, &mutant, &function) {
            continue;
        }
        let line = format!("{name}, {function}: {fault:?}");
        // None of a few points may have all roots.
        match (SEED..SEED + 5).find_map(|seed| decider.agree([&module, &mutant], &function, seed)) {
            Some(true) if module.phi_q_pattern == mutant.phi_q_pattern => fates.equivalent.push(line),
            _ => fates.survivors.push(line),
        }
    }
    fates
}

/// Whether a claim about the function is not proved, or a pattern found wrong.
fn is_killed(decider: &Decider<9>, mutant: &Module, function: &str) -> bool {
    let claims = Claim::all(mutant);
    let mut claims = claims.into_iter().filter(|claim| claim.functions().contains(&function));
    claims.any(|claim| !matches!(decider.decide(mutant, claim, 1, SEED), Verdict::Proved { .. }))
        || decider.sparsity(mutant, SEED).is_ok_and(|problems| !problems.is_empty())
}

/// Functions that were there before those of joint coordinates.
fn is_of_maximal(function: &str) -> bool {
    let of_joints = ["corrected", "joint_", "to_"];
    !of_joints.iter().any(|start| function.starts_with(start))
}

/// Faults of the derivation of γ, and others, half of them in functions of joint coordinates if there are any, spread
/// evenly over all possible ones.
fn sample(module: &Module, count: usize) -> Vec<(String, Fault)> {
    let is_derivation = |fault: &Fault| {
        matches!(fault, Fault::ForgottenTerm | Fault::TransposedRotation(_) | Fault::ForgottenVelocities(_))
    };
    let (mut sample, mut all): (Vec<_>, Vec<_>) =
        faults(module).into_iter().partition(|(name, fault)| name == "gamma" && is_derivation(fault));
    let mut random = ChaCha8Rng::seed_from_u64(SEED);
    let (of_maximal, of_joints): (Vec<_>, Vec<_>) =
        std::mem::take(&mut all).into_iter().partition(|(name, _)| is_of_maximal(name));
    let n_joints = (count / 2).min(of_joints.len());
    for (mut all, count) in [(of_maximal, count - n_joints), (of_joints, n_joints)] {
        let count = count.min(all.len());
        sample.extend((0..count).map(|_| all.swap_remove(random.random_range(0..all.len()))));
    }
    sample
}

#[test]
fn no_mutant_of_a_text_survives() {
    let (mut survivors, mut equivalent) = (Vec::new(), Vec::new());
    let mut count = 0;
    for name in ["spinning-top", "pendulum"] {
        let page = crate::support::page(name);
        let mut random = ChaCha8Rng::seed_from_u64(SEED);
        let whole = verify(&page.model, &page.code, &page.constants, Depth::Quick);
        assert!(whole.is_proved(), "{whole}");
        for _ in 0..60 {
            let (code, what) = without_a_character(&page.code, &mut random);
            count += 1;
            if verify(&page.model, &code, &page.constants, Depth::Quick).is_proved() {
                let list = if is_equivalent(&page, [&code, &page.constants]) {
                    &mut equivalent
                } else {
                    &mut survivors
                };
                list.push(format!("{name}: {what}"));
            }
        }
        for (code, what) in edited(&page) {
            count += 1;
            if verify(&page.model, &code, &page.constants, Depth::Quick).is_proved() {
                survivors.push(format!("{name}: {what}"));
            }
        }
    }
    println!("{count} mutants of texts");
    println!("{} compute the same:\n{}", equivalent.len(), equivalent.join("\n"));
    assert!(survivors.is_empty(), "{} survivors:\n{}", survivors.len(), survivors.join("\n"));
}

/// Whether another text, with exact constants of its own, computes the same at the states that its functions are made
/// for.
pub fn is_equivalent(page: &Page, [code, constants]: [&str; 2]) -> bool {
    let read = |code, constants| Module::read(&page.model, code, constants).expect("the emitted subset");
    let modules = [read(&page.code, &page.constants), read(code, constants)];
    let prime: Prime<9> = prime(&page.model, &modules[0], SEED).expect("room for all roots");
    let decider = Decider::new(&page.model, prime);
    let mut functions = modules[0].programs.keys();
    functions.all(|function| decider.agree([&modules[0], &modules[1]], function, SEED) == Some(true))
}

/// The text with one character of its code less: no space, no comma, nothing of a comment.
fn without_a_character(code: &str, random: &mut ChaCha8Rng) -> (String, String) {
    loop {
        let at = random.random_range(0..code.len());
        let Some(found) = code.get(at..=at) else { continue };
        let line = code[..at].rsplit('\n').next().unwrap_or_default();
        if line.trim_start().starts_with("//") || found.trim().is_empty() || "/,".contains(found) {
            continue;
        }
        let what = format!("`{found}` after `{line}`");
        return (format!("{}{}", &code[..at], &code[at + 1..]), what);
    }
}

/// Texts with one piece replaced.
fn edited(page: &Page) -> Vec<(String, String)> {
    let edits = [
        ("kinetic:", "potential:"),
        ("&self, t: T", "&self, _t: T"),
        ("T::constant", "T::from"),
        ("k(0.5)", "k(0.5f64)"),
        ("let k = T::constant;", "let k = T::constant; let unused = k(0.5);"),
        ("Ok(())", "return Ok(());"),
        ("*out = [", "*out = [k(0.0), "),
        ("fn phi(&self", "fn phi_other(&self"),
        ("is_length: true", "is_length: false"),
        ("gyro_sim::charts::best", "gyro_sim::charts::worst"),
        ("PARAMETERS: [", "PARAMETERS: [\"more\", "),
        ("impl<T: gyro_sim::Scalar>", "impl<T: gyro_sim::Real>"),
        ("#[derive(", "#[derive(Eq, "),
        ("let k", "#[allow(unused)] let k"),
        ("e0 * ", "e0 % "),
        ("operations (", "operations (1"),
        ("//! | phi | Φ | ", "//! | phi | Φ | 1"),
        ("gyro_sim::Energy {", "gyro_sim::Energy::<T> {"),
        ("gyro_sim::JointSpace for", "gyro_sim::Partition for"),
        (
            "gyro_sim::JointSpace::joint_accelerations(self",
            "gyro_sim::JointSpace::joint_accelerations_at(self",
        ),
        (
            "gyro_sim::CorrectedDynamics::corrected_accelerations(self",
            "gyro_sim::Dynamics::accelerations(self",
        ),
        ("[T::constant(0.0); 18]", "[T::constant(0.0); 3]"),
        ("rates[0]", "rates[1]"),
        ("*dx = [u0", "*dx = [rates[0]"),
        ("x[0] = ", "x[1] = "),
        ("x[0] = x0", "x[0] = x[0]"),
        ("fn to_joints(", "fn to_joint("),
        ("type Joints = [T; ", "type Joints = [T; 1"),
        ("| to_maximal |", "| to_minimal |"),
    ];
    let edits = edits.into_iter().filter(|(from, _)| page.code.contains(from));
    edits.map(|(from, to)| (page.code.replacen(from, to, 1), format!("`{from}` became `{to}`"))).collect()
}

/// A module of a model file that was changed since, or with other constants.
#[test]
fn stale_files_and_wrong_constants_are_not_proved() {
    let page = crate::support::page("heavy-top");
    let proves =
        |model, code: &str, constants: &str| verify(model, code, constants, Depth::Quick).is_proved();
    assert!(proves(&page.model, &page.code, &page.constants));
    let mut changed = page.model.clone();
    changed.bodies.iter_mut().for_each(|body| body.inertia.swap(0, 1));
    changed.bodies.iter_mut().for_each(|body| body.inertia.swap(1, 2));
    assert!(!proves(&changed, &page.code, &page.constants), "a stale file");
    for (index, line) in page.constants.lines().enumerate() {
        let (literal, exact) = line.split_once(" = ").expect("a line of constants");
        let others: Vec<&str> =
            page.constants.lines().enumerate().filter(|(k, _)| *k != index).map(|(_, line)| line).collect();
        let with = |line: String| [others.join("\n"), line, String::new()].join("\n");
        for wrong in [format!("{literal} = {exact}0"), format!("{literal} = -{exact}"), String::new()] {
            let is_zero = literal == "0.0";
            assert!(
                is_zero || !proves(&page.model, &page.code, &with(wrong.clone())),
                "`{line}` became `{wrong}`"
            );
        }
        // Nearer to the literal than half a unit in its last place, and yet another number.
        let close = format!("{literal} = {}", near(exact));
        assert!(!proves(&page.model, &page.code, &with(close.clone())), "`{line}` became `{close}`");
    }
}

/// A rational greater by one part in 10^30.
fn near(exact: &str) -> String {
    let (numerator, denominator) = exact.split_once('/').unwrap_or((exact, "1"));
    let zeros = "0".repeat(30);
    match numerator {
        "0" => format!("1/1{zeros}{zeros}{}", "0".repeat(300)),
        _ => format!("{numerator}{}1/{denominator}{zeros}", &zeros[1..]),
    }
}
