//! Faults in the generator's derivation, one at a time: the modules that it then writes must be refuted.

#![allow(clippy::print_stdout, reason = "the list of survivors is for readers")]

use gyro_model::Model;
use gyro_mutants::{Functions, Kernel, generate_functions, switch_on};
use gyro_verifier::module::Module;
use gyro_verifier::proof::{Claim, Decider, Verdict, prime};
use gyro_verifier::{Depth, verify};
use std::collections::{BTreeSet, HashMap};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

#[allow(dead_code, reason = "the build script reads the rest")]
mod faults {
    include!("../faults.rs");

    /// Where each fault is, the model file that shows it, and why it does no harm if that is so.
    pub fn all() -> impl Iterator<Item = (String, &'static str, Option<&'static str>)> {
        FAULTS.iter().map(|fault| {
            let what = format!("{}: {} -> {}", fault.file, fault.place, fault.wrong);
            let harmless = HARMLESS.iter().find(|(place, _)| fault.place.starts_with(place));
            (what, fault.page, harmless.map(|(_, why)| *why))
        })
    }
}

fn page(name: &str) -> Model {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let folders = ["models", "tests/models", "tests/mutants"].map(|folder| root.join(folder));
    let path = folders.iter().map(|f| f.join(format!("{name}.toml"))).find(|path| path.exists());
    let path = path.unwrap_or_else(|| panic!("no model file {name}"));
    let text = std::fs::read_to_string(&path).expect("a model file");
    let mut load =
        |file: &str| std::fs::read_to_string(path.with_file_name(file)).map_err(|error| error.to_string());
    gyro_model::read_with(name, &text, &mut load).expect("a good model file")
}

/// What the generator writes with a fault; `None` if it writes nothing.
fn written(model: &Model, fault: usize) -> Option<gyro_mutants::Module> {
    switch_on(fault);
    let asked = match &model.functions {
        Some(names) => Functions::named(names.iter().map(String::as_str)).expect("known names"),
        None => Functions::of_solvers(),
    };
    let module = catch_unwind(AssertUnwindSafe(|| generate_functions("mutant", model, &asked).ok()));
    switch_on(0);
    module.ok().flatten()
}

/// Seed of the primes and points.
const SEED: u64 = 13;

/// The claims about a module that are refuted: all of those about functions on request, and the first of the others if
/// there is none of these. `None` if the prime has not enough bits.
fn refuted<const L: usize>(model: &Model, module: &Module) -> Option<Vec<Claim>> {
    let decider = Decider::<L>::new(model, prime(model, module, SEED).ok()?);
    let is_refuted = |claim: &Claim| {
        let verdict = decider.decide(module, *claim, 1, SEED);
        matches!(verdict, Verdict::Refuted { .. } | Verdict::Divides { .. })
    };
    let (on_request, usual): (Vec<_>, Vec<_>) = Claim::all(module).into_iter().partition(is_on_request);
    let found: Vec<_> = on_request.into_iter().filter(is_refuted).collect();
    Some(if found.is_empty() { usual.into_iter().find(is_refuted).into_iter().collect() } else { found })
}

/// Functions that a module has only where they are asked for: those that solvers do not call.
fn on_request() -> impl Iterator<Item = &'static str> {
    let solvers = Functions::of_solvers();
    Kernel::all().filter(move |kernel| !solvers.has(kernel.group())).map(Kernel::name)
}

fn is_on_request(claim: &Claim) -> bool {
    on_request().any(|function| claim.functions().contains(&function))
}

/// What became of a fault.
enum Fate {
    Refuted(Vec<Claim>),
    /// Nothing readable was written.
    Unwritten,
    Harmless(&'static str),
    Survived,
}

fn fate(model: &Model, fault: usize, harmless: Option<&'static str>) -> Fate {
    let Some(text) = written(model, fault) else { return Fate::Unwritten };
    if let Some(why) = harmless {
        let report = verify(model, &text.code, &text.constants, Depth::Quick);
        return if report.is_proved() { Fate::Harmless(why) } else { Fate::Survived };
    }
    // The formulas must be refuted: that a fault shows in the structure of the text does not count.
    let Ok(module) = Module::read(model, &text.code, &text.constants) else { return Fate::Unwritten };
    match refuted::<9>(model, &module).or_else(|| refuted::<36>(model, &module)) {
        Some(claims) if !claims.is_empty() => Fate::Refuted(claims),
        _ => Fate::Survived,
    }
}

/// Every `n`th fault from the `k`th on, with what became of it. A fault is switched on for its thread alone.
fn fates(k: usize, n: usize) -> Vec<(String, Fate)> {
    let mut models = HashMap::new();
    let faults = faults::all().enumerate().skip(k).step_by(n);
    let fates = faults.map(|(index, (what, name, harmless))| {
        let model = models.entry(name).or_insert_with(|| {
            let model = page(name);
            let right = written(&model, 0).expect("a module without faults");
            let report = verify(&model, &right.code, &right.constants, Depth::Quick);
            assert!(report.is_proved(), "{report}");
            model
        });
        (format!("{name}: {what}"), fate(model, index + 1, harmless))
    });
    fates.collect()
}

#[test]
fn no_fault_of_the_derivation_survives() {
    let n = std::thread::available_parallelism().map_or(1, usize::from);
    let fates: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..n).map(|k| scope.spawn(move || fates(k, n))).collect();
        threads.into_iter().flat_map(|thread| thread.join().expect("no panic but of the generator")).collect()
    });
    let (mut refuted, mut unwritten, mut survivors) = (0, 0, Vec::new());
    let mut unharmed: BTreeSet<&str> = on_request().collect();
    for (what, fate) in fates {
        match fate {
            Fate::Refuted(claims) => {
                refuted += 1;
                claims.iter().flat_map(|claim| claim.functions()).for_each(|f| _ = unharmed.remove(f));
            }
            Fate::Unwritten => unwritten += 1,
            Fate::Harmless(why) => println!("{what} is proved: {why}"),
            Fate::Survived => survivors.push(what),
        }
    }
    println!("{refuted} faults refuted, {unwritten} after which nothing readable is written");
    assert!(survivors.is_empty(), "{} survivors:\n{}", survivors.len(), survivors.join("\n"));
    assert!(unharmed.is_empty(), "no fault shows in {unharmed:?}");
}
