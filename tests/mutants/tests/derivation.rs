//! Faults in the generator's derivation, one at a time: the modules that it then writes must be refuted.

#![allow(clippy::print_stdout, reason = "the list of survivors is for readers")]

use gyro_model::Model;
use gyro_mutants::{STALE, generate_model, switch_on};
use gyro_verifier::{Depth, Finding, Report, verify};
use std::collections::HashMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

#[allow(dead_code, reason = "the build script reads the rest")]
mod faults {
    include!("../faults.rs");

    /// Where each fault is, the page that shows it, and why it does no harm if that is so.
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
    let path = path.unwrap_or_else(|| panic!("no page {name}"));
    let text = std::fs::read_to_string(&path).expect("a page");
    let mut load =
        |file: &str| std::fs::read_to_string(path.with_file_name(file)).map_err(|error| error.to_string());
    gyro_model::read_with(name, &text, &mut load).expect("a good page")
}

/// What the verifier says of what the generator writes with a fault; `None` if it writes nothing.
fn report(model: &Model, fault: usize) -> Option<Report> {
    switch_on(fault);
    let module = catch_unwind(AssertUnwindSafe(|| generate_model("mutant", model).ok()));
    switch_on(0);
    let module = module.ok().flatten()?;
    Some(verify(model, &module.code, &module.constants, Depth::Quick))
}

#[test]
fn no_fault_of_the_derivation_survives() {
    assert!(STALE.is_empty(), "the generator's text has changed, `faults.rs` must follow: {STALE:#?}");
    let (mut models, mut survivors) = (HashMap::new(), Vec::new());
    let (mut refuted, mut unwritten) = (0, 0);
    for (index, (what, name, harmless)) in faults::all().enumerate() {
        let model = models.entry(name).or_insert_with(|| {
            let model = page(name);
            let report = report(&model, 0).expect("a module without faults");
            assert!(report.is_proved(), "{report}");
            model
        });
        // The formulas must be refuted: that a fault shows in the structure of the text does not count.
        match (report(model, index + 1), harmless) {
            (Some(report), None) if report.findings.iter().any(Finding::is_refuted) => refuted += 1,
            (Some(report), None) if report.findings.is_empty() => unwritten += 1,
            (None, None) => unwritten += 1,
            (Some(report), Some(why)) if report.findings.iter().all(Finding::is_proved) => {
                println!("{what} is proved: {why}")
            }
            _ => survivors.push(format!("{name}: {what}")),
        }
    }
    println!("{refuted} faults refuted, {unwritten} after which nothing readable is written");
    assert!(survivors.is_empty(), "{} survivors:\n{}", survivors.len(), survivors.join("\n"));
}
