//! What once got through: terms that vanish where a claim is tested, and syntax that nobody looked at.

use crate::support::Page;
use gyro_program::Kernel;
use gyro_verifier::field::Prime;
use gyro_verifier::module::{Module, is_on_constraints};
use gyro_verifier::program::{Function, Id, Node, Program, Source};
use gyro_verifier::proof::{Claim, Decider, Verdict, prime};
use gyro_verifier::structure::problems;
use gyro_verifier::{Depth, Report, Seed, verify, verify_at, with_proof};

const SEED: u64 = 17;

/// What vanishes on a set where a mechanism is, or starts.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Vanishing {
    /// t, zero at the start.
    Time,
    /// The place of a coordinate, less where it starts.
    Start(usize),
    /// A velocity, zero at rest.
    Velocity(usize),
    /// A row of Φ, zero on the constraints.
    Row(usize),
    /// A row of eq. (18), zero at velocities that fit.
    VelocityRow(usize),
    /// `pᵀp − 1` of the first body.
    Length,
    /// `pᵀp − 1` of a joint state's Euler parameters.
    JointLength(usize),
    /// A joint coordinate or rate.
    Joint(usize),
}

/// Adds the nodes of another program.
fn append(program: &mut Program, other: &Program) -> Vec<Id> {
    let mut places: Vec<Id> = Vec::new();
    for node in &other.nodes {
        places.push(program.push(node.with_operands(|id| places[id]), 1));
    }
    places
}

/// `e₀² + e₁² + e₂² + e₃² − 1`, where the one is a number of the module divided by itself.
fn length(program: &mut Program, sources: [Source; 4]) -> Id {
    let squares = sources.map(|source| {
        let e = program.push(Node::Read(source), 1);
        program.push(Node::Mul(e, e), 1)
    });
    let sum = squares.into_iter().reduce(|a, b| program.push(Node::Add(a, b), 1)).expect("four");
    let t = program.push(Node::Read(Source::Time), 1);
    let one = program.push(Node::Div(t, t), 1);
    program.push(Node::Sub(sum, one), 1)
}

impl Vanishing {
    fn write(self, program: &mut Program, module: &mut Module) -> Id {
        match self {
            Self::Time => program.push(Node::Read(Source::Time), 1),
            Self::Velocity(k) => program.push(Node::Read(Source::State(k)), 1),
            Self::Joint(k) => program.push(Node::Read(Source::Joint(k)), 1),
            Self::Start(k) => {
                let y = program.push(Node::Read(Source::State(k)), 1);
                let literal = module.start[k];
                let factor = gyro_model::parse_decimal(&format!("{literal:?}")).expect("a decimal");
                module.constants.values.push(gyro_verifier::field::Constant {
                    literal,
                    factor,
                    radicand: None,
                });
                let start = program.push(Node::Constant(module.constants.values.len() - 1), 1);
                program.push(Node::Sub(y, start), 1)
            }
            Self::Row(k) | Self::VelocityRow(k) => {
                let rows = if matches!(self, Self::Row(_)) { "phi" } else { "velocity_residual" };
                let rows = module.programs[rows].clone();
                append(program, &rows)[rows.results[k]]
            }
            Self::Length => length(program, [3, 4, 5, 6].map(Source::State)),
            Self::JointLength(start) => length(program, [0, 1, 2, 3].map(|k| Source::Joint(start + k))),
        }
    }
}

/// The module with a vanishing term added to a result of a function.
fn with_term(module: &Module, function: &str, result: usize, term: Vanishing) -> Module {
    let mut mutant = module.clone();
    let mut program = mutant.programs[function].clone();
    let term = term.write(&mut program, &mut mutant);
    program.results[result] = program.push(Node::Add(program.results[result], term), 1);
    mutant.programs.insert(function.to_owned(), program);
    mutant
}

/// What must not be added to a function unnoticed.
fn terms(module: &Module, n: usize, function: &str, result: usize) -> Vec<Vanishing> {
    let in_joints =
        ["joint_accelerations", "joint_derivative", "to_maximal", "joint_jacobian", "joint_input_jacobian"];
    if in_joints.contains(&function) {
        let layout = module.joints.as_ref().expect("joint coordinates");
        let mut terms = vec![Vanishing::Time, Vanishing::Joint(0), Vanishing::Joint(layout.n_coordinates)];
        let is_rate = function == "joint_derivative" && result < layout.n_coordinates;
        terms.extend(layout.euler().next().filter(|_| is_rate).map(Vanishing::JointLength));
        return terms;
    }
    let mut terms = vec![Vanishing::Time, Vanishing::Velocity(7 * n + 5)];
    // What is made for states on the constraints promises nothing elsewhere.
    if !is_on_constraints(function) {
        terms.push(Vanishing::Start(0));
        let rows = module.programs["velocity_residual"].results.len();
        terms.extend((0..rows.min(1)).flat_map(|row| [Vanishing::Row(row), Vanishing::VelocityRow(row)]));
    }
    let rows = module.programs["velocity_residual"].results.len();
    let is_claimed_off_the_sphere = match function {
        "phi" => result >= rows,
        "phi_q" => module.phi_q_pattern[result].0 >= rows,
        "derivative" | "corrected_derivative" => result < 7 * n,
        _ => false,
    };
    terms.extend(is_claimed_off_the_sphere.then_some(Vanishing::Length));
    terms
}

#[test]
fn no_term_that_vanishes_at_a_special_place_gets_through() {
    let (mut count, mut survivors) = (0, Vec::new());
    for name in ["torsion", "free-body", "spinning-top", "four-bar"] {
        let page = crate::support::page(name);
        let module = Module::read(&page.model, &page.code, &page.constants).expect("the emitted subset");
        let prime: Prime<9> = prime(&page.model, &module, SEED).expect("room for all roots");
        let decider = Decider::new(&page.model, prime);
        let n = page.model.coordinate_bodies().len();
        for (function, program) in &module.programs {
            let results = program.results.len();
            let some = [0, results.saturating_sub(1)];
            for result in some.into_iter().filter(|&k| k < results) {
                for term in terms(&module, n, function, result) {
                    count += 1;
                    let mutant = with_term(&module, function, result, term);
                    let mut claims = Claim::all(&mutant)
                        .into_iter()
                        .filter(|c| c.functions().contains(&function.as_str()));
                    let is_refuted = claims
                        .any(|c| !matches!(decider.decide(&mutant, c, 1, SEED), Verdict::Proved { .. }));
                    if !is_refuted {
                        survivors.push(format!("{name}: {function}[{result}] + {term:?}"));
                    }
                }
            }
        }
    }
    assert!(survivors.is_empty(), "{} of {count}:\n{}", survivors.len(), survivors.join("\n"));
    assert!(count > 400, "{count} are too few");
}

/// Where |p| = 1 a row of normalisation is zero, whatever it is.
#[test]
fn normalisation_rows_are_proved() {
    let page = crate::support::page("spinning-top");
    let module = Module::read(&page.model, &page.code, &page.constants).expect("the emitted subset");
    let prime: Prime<9> = prime(&page.model, &module, SEED).expect("room for all roots");
    let decider = Decider::new(&page.model, prime);
    let verdict = |module: &Module| decider.decide(module, Claim(Kernel::Phi), 1, SEED);
    assert!(matches!(verdict(&module), Verdict::Proved { .. }));
    let row = page.model.rows().len();
    for wrong in ["1 − pᵀp", "0", "(pᵀp)² − pᵀp"] {
        let mut mutant = module.clone();
        let phi = mutant.programs.get_mut("phi").expect("a function");
        let right = phi.results[row];
        phi.results[row] = match wrong {
            "0" => phi.push(Node::Sub(right, right), 1),
            "1 − pᵀp" => phi.push(Node::Neg(right), 1),
            _ => {
                let square = phi.push(Node::Mul(right, right), 1);
                phi.push(Node::Add(square, right), 1)
            }
        };
        assert!(matches!(verdict(&mutant), Verdict::Refuted { .. }), "{wrong}");
    }
}

/// Something that the text of a module could have besides: what it is put before, after or instead of, and what it is.
const FOREIGN: &[(&str, &str)] = &[
    // Attributes: of the file, items, members, arms, statements, patterns, fields, expressions, arguments.
    ("//! The mechanism", "#![no_implicit_prelude]\n//! The mechanism"),
    ("/// The mechanism", "#[cfg(any())]\n/// The mechanism"),
    ("pub struct", "#[repr(C)] pub struct"),
    ("    fn phi(", "    #[cold] fn phi("),
    ("    fn phi(", "    #[inline(never)] fn phi("),
    ("type Rows", "#[cfg(all())] type Rows"),
    ("_ => return false", "#[cfg(any())] _ => return false"),
    ("0 => {", "#[cfg(any())] 0 => {"),
    // Names of places: another place, another name, another joint's.
    ("pub const GRAVITY: usize = 0;", "pub const GRAVITY: usize = 1;"),
    ("pub const CRANK_PIVOT: usize = 0;", "pub const CRANK_PIVOT: usize = 1;"),
    ("pub const ELBOW: usize", "pub const KNEE: usize"),
    ("pub mod joint_rate", "pub mod joint_speed"),
    ("let t0", "#[cfg(any())] let t0"),
    ("*out = [", "#[cfg(any())] *out = ["),
    ("kinetic:", "#[cfg(any())] kinetic:"),
    ("kinetic: ", "kinetic: #[cfg(all())] "),
    ("k(0.5)", "#[cfg(any())] k(0.5)"),
    ("k(0.5)", "k(#[cfg(all())] 0.5)"),
    ("k(0.0),", "#[cfg(any())] k(0.0),"),
    ("t: T, y", "#[cfg(all())] t: T, y"),
    ("(0, 0)", "#[cfg(all())] (0, 0)"),
    ("(0, 0)", "(#[cfg(all())] 0, 0)"),
    ("*out = [", "*out = #[cfg(all())] ["),
    ("*out = [\n", "*out = [#[cfg(any())] k(0.5),\n"),
    ("let k = T::constant;", "#[doc = \"one\"] let k = T::constant;"),
    ("let k = T::constant;", "let #[cfg(all())] k = T::constant;"),
    // Qualifiers.
    ("    fn phi(", "    unsafe fn phi("),
    ("    fn phi(", "    const fn phi("),
    ("    fn phi(", "    async fn phi("),
    ("    fn phi(", "    extern \"C\" fn phi("),
    ("    fn phi(", "    pub fn phi("),
    ("    fn phi(", "    default fn phi("),
    ("fn phi(&self", "fn phi<U>(&self"),
    ("fn phi(&self", "fn phi(&mut self"),
    ("fn phi(&self", "fn phi(self: &Self"),
    ("fn phi(&self", "fn phi(&'static self"),
    ("pub struct", "pub(crate) struct"),
    ("> gyro_sim::Mechanism for", "> !gyro_sim::Mechanism for"),
    ("impl<T: gyro_sim::Scalar> gyro_sim::Mechanism", "unsafe impl<T: gyro_sim::Scalar> gyro_sim::Mechanism"),
    ("impl<T: gyro_sim::Scalar> gyro_sim::Mechanism", "impl<T: gyro_sim::Scalar + Copy> gyro_sim::Mechanism"),
    ("impl<T: gyro_sim::Scalar> gyro_sim::Mechanism", "impl<'a, T: gyro_sim::Scalar> gyro_sim::Mechanism"),
    (
        "impl<T: gyro_sim::Scalar> gyro_sim::Mechanism",
        "impl<T: ?Sized + gyro_sim::Scalar> gyro_sim::Mechanism",
    ),
    // Statements and expressions of other kinds.
    ("let k = T::constant;", "let k: fn(f64) -> T = T::constant;"),
    ("let k = T::constant;", "let mut k = T::constant;"),
    ("let k = T::constant;", "let ref k = T::constant;"),
    ("let k = T::constant;", "let k = T::constant else { return };"),
    ("let k = T::constant;", "let k = T::constant::<>;"),
    ("let k = T::constant;", "let k = <T>::constant;"),
    ("let k = T::constant;", "let k = T::constant; fn k(x: f64) -> f64 { -x }"),
    ("let k = T::constant;", "let k = T::constant; let k = T::constant;"),
    ("let k = T::constant;", "let k = T::constant; macro_rules! k { () => {} }"),
    ("let k = T::constant;", "let k = T::constant; use core::ops::Sub as Add;"),
    ("let k = T::constant;", "let k = T::constant;;"),
    ("let k = T::constant;", "let k = |x| T::constant(-x);"),
    ("k(0.5)", "k(0_.5)"),
    ("k(0.5)", "k(5e-1)"),
    ("k(0.5)", "k::<>(0.5)"),
    ("k(0.5)", "{ k(0.5) }"),
    ("k(0.5)", "(k(0.5) as T)"),
    ("k(0.5)", "k!(0.5)"),
    ("k(0.5)", "r#k(0.5)"),
    ("k(0.5)", "unsafe { k(0.5) }"),
    ("k(0.5)", "k(0.5).sin::<f64>()"),
    ("T::fused(", "T::fused::<>("),
    ("T::fused(", "<T>::fused("),
    ("T::fused(", "Self::fused("),
    ("*out = [", "*out = loop { break "),
    ("*out = [", "return; *out = ["),
    ("*out = [", "**out = ["),
    ("*out = [", "*out += ["),
    ("kinetic:", "r#kinetic:"),
    // Items and comments.
    ("/// The mechanism", "use gyro_sim as core;\n/// The mechanism"),
    ("/// The mechanism", "extern crate gyro_sim as core;\n/// The mechanism"),
    ("/// The mechanism", "mod core {}\n/// The mechanism"),
    ("/// The mechanism", "macro_rules! k { () => {} }\n/// The mechanism"),
    ("/// The mechanism", "trait Other { fn sin(self) -> f64; }\n/// The mechanism"),
    ("/// The mechanism", "impl<T> Drop for Other<T> { fn drop(&mut self) {} }\n/// The mechanism"),
    ("/// The mechanism", "const _: () = ();\n/// The mechanism"),
    ("/// The mechanism", "static X: u8 = 0;\n/// The mechanism"),
    ("/// The mechanism", "include!(\"other.rs\");\n/// The mechanism"),
    ("/// The mechanism", "#[doc = include_str!(\"other.md\")]\n/// The mechanism"),
    ("/// The mechanism", "#[cfg_attr(all(), cfg(any()))]\n/// The mechanism"),
    ("let k", "// proved by hand\nlet k"),
    ("let k", "/* proved by hand */ let k"),
    ("let k = T::constant;", "let k = T::constant; // proved by hand"),
];

#[test]
fn what_no_module_has_is_refused() {
    let pages = ["spinning-top", "gyroscope-parameters", "four-bar"].map(crate::support::page);
    let mut accepted = Vec::new();
    for (place, wrong) in FOREIGN {
        let has_place = |page: &&Page| page.code.contains(place);
        let Some(page) = pages.iter().find(has_place) else {
            accepted.push(format!("no module has `{place}`"));
            continue;
        };
        // At the first place and at the last.
        let at = page.code.rfind(place).expect("it has one");
        let last = format!("{}{wrong}{}", &page.code[..at], &page.code[at + place.len()..]);
        for code in [page.code.replacen(place, wrong, 1), last] {
            let report = verify(&page.model, &code, &page.constants, Depth::Quick);
            if report.refusals.is_empty() {
                accepted.push(format!("`{place}` became `{wrong}`"));
            }
        }
    }
    assert!(accepted.is_empty(), "{} were read:\n{}", accepted.len(), accepted.join("\n"));
}

/// `x w / w` is x but where w is zero: at the start, at rest, where an angle is a half turn.
#[test]
fn removable_singularities_are_found() {
    let page = crate::support::page("gyroscope");
    let spin = 7 * 3 + 4;
    // A function, and what is zero somewhere. (A cosine is nowhere zero in `f64`, and x w / w is x there.)
    let removable = [
        ("applied_force", format!("y[{spin}]")),
        ("accelerations", format!("y[{spin}]")),
        ("project", "y[3]".to_owned()),
        ("joint_accelerations", "x[3]".to_owned()),
        ("joint_accelerations", "x[1].sin()".to_owned()),
        ("to_maximal", "x[4]".to_owned()),
        ("corrected_solution", format!("y[{spin}]")),
        ("newton_step", "y[3]".to_owned()),
        ("solve_velocities", format!("y[{spin}]")),
    ];
    for (function, zero) in removable {
        let module = Module::read(&page.model, &page.code, &page.constants).expect("the emitted subset");
        let source = |text: &str| {
            let (array, rest) = text.split_once('[').expect("an element");
            let place: usize = rest.split(']').next().and_then(|k| k.parse().ok()).expect("an index");
            if array == "x" { Source::Joint(place) } else { Source::State(place) }
        };
        let mut mutant = module.clone();
        let program = mutant.programs.get_mut(function).expect("a function");
        let mut divisor = program.push(Node::Read(source(&zero)), 1);
        for (call, known) in [(".sin()", Function::Sin)] {
            if zero.ends_with(call) {
                divisor = program.push(Node::Call(known, [divisor; 2]), 1);
            }
        }
        let last = program.results.len() - 1;
        let product = program.push(Node::Mul(program.results[last], divisor), 1);
        program.results[last] = program.push(Node::Div(product, divisor), 77);
        let prime: Prime<9> = prime(&page.model, &mutant, SEED).expect("room for all roots");
        let decider = Decider::new(&page.model, prime);
        let claims = Claim::all(&mutant).into_iter().filter(|claim| claim.functions().contains(&function));
        for claim in claims {
            let verdict = decider.decide(&mutant, claim, 1, SEED);
            assert!(matches!(verdict, Verdict::Proved { .. }), "the identity holds: {claim:?}, {verdict:?}");
        }
        let found = gyro_verifier::not_finite(&page.model, &mutant, Seed::FIXED);
        let about =
            |problem: &&String| problem.starts_with(&format!("`{function}`")) && problem.contains("line 77");
        let problem = found.iter().find(about);
        assert!(problem.is_some(), "{function}, {zero}: {found:?}");
    }
}

/// What may be zero is in the list, as the new divisor is.
#[test]
fn divisors_that_may_vanish_are_listed() {
    let page = crate::support::page("gyroscope");
    let report = verify(&page.model, &page.code, &page.constants, Depth::Quick);
    let listed = |report: &Report| {
        report.divisors.iter().filter(|divisor| !divisor.is_never_zero).map(|d| d.line).collect::<Vec<_>>()
    };
    let divisions = page.code.matches(" / ").count() + page.code.matches("\n        / ").count();
    assert!(report.divisors.len() >= 5 && !listed(&report).contains(&1), "{divisions}");
    let place = "let t0 = ";
    let wrong = page.code.replacen(place, "let t0 = outer_ring_e0 / outer_ring_e0 * ", 1);
    assert_ne!(wrong, page.code);
    let line =
        1 + wrong[..wrong.find("outer_ring_e0 / outer_ring_e0").expect("it is there")].matches('\n').count();
    let report = verify(&page.model, &wrong, &page.constants, Depth::Quick);
    assert!(report.divisors.is_empty() || listed(&report).contains(&line), "{report}");
}

/// Each line of words is known to be true or is not proved: that it is not what another mechanism would have, too.
#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn words_are_proved_too() {
    let mut accepted = Vec::new();
    for name in ["spinning-top", "cam"] {
        let page = crate::support::page(name);
        let (text, report) = with_proof(&page.model, &page.code, &page.constants, Depth::Quick);
        assert!(report.is_proved(), "{report}");
        assert!(
            text.contains("//! # Proof")
                && verify_at(&page.model, &text, &page.constants, Depth::Full, Seed::fresh()).is_proved()
        );
        let lines: Vec<&str> = text.lines().collect();
        let proof = lines.iter().position(|line| line.contains("# Proof")).expect("a section");
        for (place, line) in lines.iter().enumerate().skip(1) {
            let is_of_words = line.trim_start().starts_with("//") && line.trim_start().len() > 4;
            if !is_of_words {
                continue;
            }
            // That something was asked for in vain is known to the sheet alone.
            let is_in_vain = line.starts_with("//! * left out: the functions of ");
            for changed in [format!("{line} Not."), with_another_digit(line), String::new()] {
                let is_documented = changed.is_empty()
                    && line.trim_start().starts_with("///")
                    && !line.contains(" operations (");
                if changed == *line || is_documented || changed.is_empty() && is_in_vain {
                    continue;
                }
                let mut lines = lines.clone();
                lines[place] = &changed;
                if is_right(&page, &(lines.join("\n") + "\n"), place > proof) {
                    accepted.push(format!("{name}: `{line}` became `{changed}`"));
                }
            }
        }
    }
    assert!(accepted.is_empty(), "{} were proved:\n{}", accepted.len(), accepted.join("\n"));
}

/// Whether the words of a module are right; what is said of the proof is known when there is one.
fn is_right(page: &Page, code: &str, is_on_proof: bool) -> bool {
    if is_on_proof && page.name.starts_with("spinning") {
        return verify(&page.model, code, &page.constants, Depth::Quick).is_proved();
    }
    let module = Module::read(&page.model, code, &page.constants);
    !is_on_proof && module.is_ok_and(|module| problems(&page.model, &module).is_empty())
}

/// The last digit of a line is another one.
fn with_another_digit(line: &str) -> String {
    match line.rfind(|c: char| c.is_ascii_digit()) {
        Some(place) => {
            let digit = if &line[place..=place] == "7" { "8" } else { "7" };
            format!("{}{digit}{}", &line[..place], &line[place + 1..])
        }
        None => line.to_owned(),
    }
}

/// Nothing was tested of what was not read: no prime, no probability.
#[test]
fn a_refusal_claims_nothing() {
    let page = crate::support::page("spinning-top");
    let report = verify(&page.model, "", &page.constants, Depth::Quick);
    assert!(report.is_refuted() && report.error_log10() == 0.0);
    let words = report.to_string();
    assert!(!words.contains("prime") && !words.contains("inf"), "{words}");
    assert!(report.to_json()["prime"].is_null() && report.to_json()["error_log10"] == 0.0);
}

/// Points of another seed are other points, and the proof holds at all of them.
#[test]
fn seeds_make_other_points() {
    let page = crate::support::page("spinning-top");
    for seed in [Seed::fresh(), Seed::fresh(), Seed::from(1)] {
        let report = verify_at(&page.model, &page.code, &page.constants, Depth::Quick, seed);
        assert!(report.is_proved() && report.to_string().contains(&format!("seed: {seed}")), "{report}");
        let wrong = page.code.replacen(" - ", " + ", 1);
        assert!(!verify_at(&page.model, &wrong, &page.constants, Depth::Quick, seed).is_proved());
    }
}

/// Names of files have any characters; what they are named in is one line of a comment.
#[test]
fn names_of_files_end_no_line() {
    let folder = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/models");
    let read = |file: &str| std::fs::read_to_string(folder.join(file)).map_err(|error| error.to_string());
    let page = read("cam.toml").expect("a model file");
    let odd = page.replace("\"cam.csv\"", "\"c\\nfn\\r\\u2028\\u202eam*/.csv\"");
    assert_ne!(page, odd);
    let model = gyro_model::read_with("cam.toml", &odd, &mut |_| read("cam.csv")).expect("a good model file");
    let module = gyro_codegen::generate_functions(
        "ca\nm\u{2028}\u{202e}.toml",
        &model,
        &gyro_codegen::Functions::all(),
    )
    .expect("a module");
    let (text, report) = with_proof(&model, &module.code, &module.constants, Depth::Quick);
    assert!(report.is_proved(), "{report}");
    assert!(text.lines().next().is_some_and(|line| line.ends_with("Do not edit.")));
    assert!(!text.contains(['\r', '\u{2028}', '\u{202e}']));
}
