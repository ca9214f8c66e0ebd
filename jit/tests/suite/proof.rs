//! What Cranelift is given is read back by the verifier: as it is, it is what the module says; any change is found.

use gyro_codegen::{Effort, Functions, Kernel, Scheduled};
use gyro_jit::{Input, compile_scheduled};
use gyro_model::Model;
use gyro_verifier::{Clif, Depth, Written, same_in_clif, verify};

/// Cranelift's input for a model, and the module of the same kernels.
pub struct Given {
    model: Model,
    module: gyro_codegen::Module,
    functions: Vec<(Kernel, String)>,
    tables: Vec<f64>,
}

impl Given {
    fn new(model: Model, functions: &Functions, effort: Effort) -> Self {
        let module = gyro_codegen::generate_by_effort("page.toml", &model, functions, effort).unwrap();
        let scheduled = gyro_codegen::schedule(&model, functions, effort).unwrap();
        Self::of_scheduled(model, module, scheduled)
    }

    pub fn of_scheduled(model: Model, module: gyro_codegen::Module, scheduled: Scheduled) -> Self {
        let (mut functions, mut tables) = (Vec::new(), Vec::new());
        let mut told = |input: Input<'_>| {
            functions.push((input.kernel, input.clif));
            tables = input.tables.to_vec();
        };
        compile_scheduled::<f64>(&model, scheduled, Some(&mut told)).unwrap();
        Self { model, module, functions, tables }
    }

    fn of(name: &str) -> Self {
        let file = format!("{}/../models/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        let model = gyro_model::read(name, &std::fs::read_to_string(file).unwrap());
        Self::new(model.unwrap_or_else(|error| panic!("{error}")), &Functions::usual(), Effort::Quick)
    }

    pub fn n_functions(&self) -> usize {
        self.functions.len()
    }

    /// Whether the verifier accepts all functions.
    pub fn is_accepted(&self) -> Result<usize, String> {
        let function = |(kernel, text)| Clif { name: Kernel::name(kernel), text, tables: &self.tables };
        let functions: Vec<Clif<'_>> =
            self.functions.iter().map(|(kernel, text)| function((*kernel, &text[..]))).collect();
        let module = (&self.module.code[..], &self.module.constants[..]);
        same_in_clif(&self.model, module, &functions).map_err(|refusal| refusal.to_string())
    }
}

/// A chain whose kernels have loops over tables of constants.
fn chain() -> Given {
    let model =
        gyro_model::read("chain", &super::kernels::chain(24)).unwrap_or_else(|error| panic!("{error}"));
    Given::new(model, &Functions::named(["joint"]).unwrap(), Effort::Full)
}

#[test]
fn what_cranelift_is_given_is_what_was_proved() {
    for name in ["gyroscope-parameters", "four-bar", "driven-gyroscope"] {
        let given = Given::of(name);
        let report = verify(&given.model, &given.module.code, &given.module.constants, Depth::Quick);
        assert!(report.is_proved(), "{report}");
        assert_eq!(given.is_accepted(), Ok(given.functions.len()), "{name}");
    }
    let chain = chain();
    assert!(chain.functions.iter().any(|(_, text)| text.contains("brif")));
    assert_eq!(chain.is_accepted(), Ok(chain.functions.len()));
}

/// The line with one thing changed, for each thing that can be.
fn mutants(line: &str) -> Vec<String> {
    let mut mutants = Vec::new();
    let mut replaced = |from: &str, to: &str| {
        if line.contains(from) {
            mutants.push(line.replacen(from, to, 1));
        }
    };
    for (from, to) in [
        (" fadd ", " fsub "),
        (" fsub ", " fadd "),
        (" fmul ", " fdiv "),
        (" fdiv ", " fmul "),
        (" fneg ", " sqrt "),
        ("icmp eq", "icmp ne"),
        ("call fn1(", "call fn2("),
        ("call fn2(", "call fn1("),
        (&format!("{}(", both())[3..], "call fn1("),
    ] {
        replaced(from, to);
    }
    let code = line.split(';').next().unwrap_or_default().trim_end();
    // The last digit of a constant; an offset or a bound of a loop.
    if let Some((head, tail)) = code.split_once("f64const 0x1.") {
        let (digits, exponent) = tail.split_once('p').unwrap();
        let last = if digits.ends_with('0') { "1" } else { "0" };
        mutants.push(format!("{head}f64const 0x1.{}{last}p{exponent}", &digits[..digits.len() - 1]));
    }
    if let Some((head, number)) = code.split_once("iconst.i64 ") {
        mutants.push(format!("{head}iconst.i64 {}", number.parse::<i64>().unwrap() + 1));
    }
    if code.contains(" notrap aligned ") {
        let (head, offset) = code.rsplit_once('+').unwrap_or((code, "0"));
        mutants.push(format!("{head}+{}", offset.parse::<i64>().unwrap() + 8));
    }
    // Sine and cosine.
    if let Some((names, call)) = code.split_once(&both()) {
        let (sine, cosine) = names.trim().split_once(", ").unwrap();
        mutants.push(format!("    {cosine}, {sine}{}{call}", both()));
    }
    // Operands.
    if ["fsub", "fdiv"].iter().any(|name| code.contains(name)) {
        let (head, second) = code.rsplit_once(", ").unwrap();
        let (head, first) = head.rsplit_once(' ').unwrap();
        mutants.push(format!("{head} {second}, {first}"));
    }
    if code.trim_start().starts_with("store") {
        mutants.push(String::new());
    }
    mutants
}

/// A call of what computes sine and cosine together, which comes after all functions.
fn both() -> String {
    format!(" = call fn{}", gyro_program::elementary::Function::ALL.len())
}

/// Whether a line loads a number that nothing reads: the angle of a sine whose cosine was computed before, with it.
/// Cranelift leaves such a load out.
fn is_in_vain(line: &str, text: &str) -> bool {
    let is_word = |c: char| c.is_ascii_alphanumeric();
    line.split_once(" = load.").is_some_and(|(value, _)| {
        text.split(|c| !is_word(c)).filter(|word| *word == value.trim()).count() == 1
    })
}

/// Tries mutants of so many lines of each function.
fn check(given: &Given, n_lines: usize) -> usize {
    let mut n_found = 0;
    let written = Written::read(&given.model, &given.module.code, &given.module.constants).unwrap();
    for (kernel, text) in &given.functions {
        let as_given = written.same_function(&Clif { name: kernel.name(), text, tables: &given.tables });
        assert_eq!(as_given, Ok(()), "{}", kernel.name());
        let lines: Vec<&str> = text.lines().collect();
        let step = lines.len().div_ceil(n_lines);
        for at in (0..lines.len()).step_by(step).filter(|&at| !is_in_vain(lines[at], text)) {
            for mutant in mutants(lines[at]) {
                let mut changed = lines.clone();
                changed[at] = &mutant;
                let text = &changed.join("\n");
                let outcome =
                    written.same_function(&Clif { name: kernel.name(), text, tables: &given.tables });
                assert!(outcome.is_err(), "{}: `{}` became `{mutant}`", kernel.name(), lines[at]);
                n_found += 1;
            }
        }
    }
    n_found
}

#[test]
fn every_change_of_what_cranelift_is_given_is_found() {
    let n = check(&Given::of("gyroscope-parameters"), 12) + check(&chain(), 40);
    assert!(n > 300, "{n}");
}

#[test]
fn a_sine_that_became_a_cosine_is_found() {
    let both = both();
    let mut given = Given::of("gyroscope");
    let n_functions = given.functions.len();
    let (kernel, text) = given.functions.iter().find(|(_, text)| text.contains(&both)).unwrap().clone();
    let calls: Vec<String> = text.lines().filter(|line| line.contains(&both)).map(String::from).collect();
    assert_eq!(given.is_accepted(), Ok(n_functions));
    for mutant in calls.iter().flat_map(|line| mutants(line).into_iter().map(move |mutant| (line, mutant))) {
        let changed = text.replacen(&mutant.0[..], &mutant.1, 1);
        let function = given.functions.iter_mut().find(|(other, _)| *other == kernel).unwrap();
        function.1 = changed;
        assert!(given.is_accepted().is_err(), "`{}` became `{}`", mutant.0, mutant.1);
    }
}
