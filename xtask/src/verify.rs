//! `cargo xtask verify`: proves generated modules against the textbook.

use crate::args::VerifyArgs;
use crate::failure::Failure;
use crate::generate::{Places, all_pages, module_path};
use crate::progress::Spinner;
use crate::words::count;
use crate::{files, remarks, rounding, scene, stability};
use gyro_codegen::Module;
use gyro_model::Model;
use gyro_verifier::{Depth, Report, verify};
use rayon::prelude::*;
use std::io::Write;
use std::path::Path;
use std::{fs, io};

/// Verifies the modules of the models, prints what was proved, and fails unless all was.
pub(crate) fn verify_models(args: &VerifyArgs) -> Result<(), Failure> {
    let places = Places::of_workspace(&files::root());
    let pages = if args.models.is_empty() { all_pages(&places)? } else { args.models.clone() };
    if args.rounding {
        let tables: Result<Vec<rounding::Table>, Failure> =
            pages.par_iter().map(|page| rounding_of(&places, page)).collect();
        return say(&rounding::report(&tables?));
    }
    if let Some(configurations) = args.stability {
        return say(&stability::report(&args.models, configurations.get())?);
    }
    let depth = if args.quick { Depth::Quick } else { Depth::Full };
    let reports: Result<Vec<Report>, Failure> =
        pages.par_iter().map(|page| verify_page(&places, page, depth)).collect();
    let reports = reports?;
    let text = if args.json {
        format!("{}\n", serde_json::Value::Array(reports.iter().map(Report::to_json).collect()))
    } else {
        in_words(&reports)
    };
    say(&text)?;
    let n_unproved = reports.iter().filter(|report| !report.is_proved()).count();
    if n_unproved == 0 {
        return Ok(());
    }
    Err(Failure::Run(format!("{} not proved", count(n_unproved as u64, "module"))))
}

fn verify_page(places: &[Places], page: &Path, depth: Depth) -> Result<Report, Failure> {
    let (model, [code, constants]) = read_page(places, page)?;
    Ok(verify(&model, &code, &constants, depth))
}

fn rounding_of(places: &[Places], page: &Path) -> Result<rounding::Table, Failure> {
    let (model, [code, constants]) = read_page(places, page)?;
    rounding::table(&model, &code, &constants)
}

/// A model with its module and exact constants as they are on disk.
fn read_page(places: &[Places], page: &Path) -> Result<(Model, [String; 2]), Failure> {
    let model = scene::read(page)?;
    let path = module_path(places, page, &model.name);
    let read = |path: &Path| {
        fs::read_to_string(path).map_err(|e| {
            let (path, page) = (path.display(), page.display());
            Failure::Usage(format!("{path} cannot be read: {e}\nto write it: cargo xtask generate {page}"))
        })
    };
    let texts = [read(&path)?, read(&path.with_extension("exact"))?];
    Ok((model, texts))
}

fn say(text: &str) -> Result<(), Failure> {
    io::stdout().write_all(text.as_bytes()).map_err(|e| Failure::Run(format!("standard output: {e}")))
}

/// Proves a module that was just made, for the commands that make one. What is refuted is refused; what is undecided is right as far as
/// anybody knows, and said.
pub(crate) fn verify_quickly(model: &Model, module: &Module) -> Result<Report, Failure> {
    let spinner = Spinner::new(format!("proving {}", module.name));
    let report = verify(model, &module.code, &module.constants, Depth::Quick);
    drop(spinner);
    if report.is_refuted() {
        let cure = "this is a mistake of the generator: please report it with the page";
        return Err(Failure::Run(format!(
            "the generated module is not what the textbook says\n{report}{cure}"
        )));
    }
    if !report.is_proved() {
        remarks::warn(&format!(
            "nothing wrong was found in {}, but not all is as it should be\n{report}",
            module.name
        ));
    }
    Ok(report)
}

fn in_words(reports: &[Report]) -> String {
    let mut text: String = reports.iter().map(|report| format!("{report}\n")).collect();
    let n_proved = reports.iter().filter(|report| report.is_proved()).count();
    let worst = reports.iter().map(Report::error_log10).fold(f64::NEG_INFINITY, f64::max);
    text += &format!(
        "{n_proved} of {} proved; each is false with a probability below 1e{:.0}\n",
        count(reports.len() as u64, "module"),
        worst.ceil()
    );
    text
}
