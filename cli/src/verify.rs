//! `cargo xtask verify`: proves generated modules against the textbook.

use crate::args::VerifyArgs;
use crate::failure::Failure;
use crate::invocation::program;
use crate::places::{Place, all_model_files, module_path};
use crate::progress::Spinner;
use crate::remarks::say;
use crate::side_by_side::side_by_side;
use crate::words::count;
use crate::{files, remarks, rounding, scene, stability};
use gyro_codegen::Module;
use gyro_model::Model;
use gyro_verifier::{Depth, Report, Seed, verify, verify_at, with_proof};
use std::fs;
use std::path::Path;

/// Verifies the modules of the models, prints what was proved, and fails unless all was.
pub(crate) fn verify_models(args: &VerifyArgs) -> Result<(), Failure> {
    let places = Place::all();
    let pages = if args.models.is_empty() { all_model_files(&places)? } else { args.models.clone() };
    if args.rounding {
        let tables: Result<Vec<rounding::Table>, Failure> =
            side_by_side(pages.len(), |k| rounding_of(&places, &pages[k])).into_iter().collect();
        return say(&rounding::report(&tables?));
    }
    if let Some(configurations) = args.stability {
        return say(&stability::report(&args.models, configurations.get())?);
    }
    let seed = args.seed.unwrap_or_else(Seed::fresh);
    let depth = if args.quick { Depth::Quick } else { Depth::Full };
    let reports: Result<Vec<Report>, Failure> =
        side_by_side(pages.len(), |k| verify_model(&places, &pages[k], depth, seed)).into_iter().collect();
    let reports = reports?;
    let text = if args.json {
        format!("{}\n", serde_json::Value::Array(reports.iter().map(Report::to_json).collect()))
    } else {
        in_words(&reports, seed)
    };
    say(&text)?;
    let n_unproved = reports.iter().filter(|report| !report.is_proved()).count();
    if n_unproved == 0 {
        return Ok(());
    }
    Err(Failure::Run(format!("{} not proved", count(n_unproved as u64, "module"))))
}

fn verify_model(places: &[Place], page: &Path, depth: Depth, seed: Seed) -> Result<Report, Failure> {
    let (model, [code, constants]) = read_module(places, page)?;
    Ok(verify_at(&model, &code, &constants, depth, seed))
}

fn rounding_of(places: &[Place], page: &Path) -> Result<rounding::Table, Failure> {
    let (model, [code, constants]) = read_module(places, page)?;
    rounding::table(&model, &code, &constants)
}

/// A model with its module and exact constants: as they are on disk, or as they are generated where they are not kept.
fn read_module(places: &[Place], page: &Path) -> Result<(Model, [String; 2]), Failure> {
    let mut model = scene::read(page)?;
    let Some(path) = module_path(places, page, &model.name) else {
        model.functions.get_or_insert_with(|| vec!["all".to_owned()]);
        let module = gyro_codegen::generate_model(&files::shown(page), &model)
            .map_err(|e| Failure::Usage(format!("{}: {e}", page.display())))?;
        return Ok((model, [module.code, module.constants]));
    };
    let read = |path: &Path| {
        fs::read_to_string(path).map_err(|e| {
            let (path, page) = (path.display(), page.display());
            Failure::Usage(format!("{path} cannot be read: {e}\nto write it: {} generate {page}", program()))
        })
    };
    let texts = [read(&path)?, read(&path.with_extension("exact"))?];
    // As the module was asked for: `generate --count-work`.
    model.counts_work = texts[0].contains("has_work: true");
    Ok((model, texts))
}

/// Proves a module that was just made, for the commands that make one. What is refuted is refused; what is undecided is
/// not known to be wrong, and reported.
pub(crate) fn verify_quickly(model: &Model, module: &Module) -> Result<(), Failure> {
    let spinner = Spinner::new(format!("proving {}", module.name));
    let report = verify(model, &module.code, &module.constants, Depth::Quick);
    drop(spinner);
    judge(&report)
}

/// The same; gives the module with what was proved on its data sheet, which is the text that was proved.
pub(crate) fn proved(model: &Model, module: Module) -> Result<Module, Failure> {
    let spinner = Spinner::new(format!("proving {}", module.name));
    let (code, report) = with_proof(model, &module.code, &module.constants, Depth::Quick);
    drop(spinner);
    judge(&report)?;
    Ok(Module { code, ..module })
}

/// Refuses what is refuted, and warns of what is undecided.
///
/// # Errors
/// The module is refuted.
pub(crate) fn judge(report: &Report) -> Result<(), Failure> {
    if report.is_refuted() {
        let cure = "this is a mistake of the generator: please report it with the model file";
        return Err(Failure::Run(format!(
            "the generated module is not what the textbook says\n{report}{cure}"
        )));
    }
    if !report.is_proved() {
        remarks::warn(&format!(
            "nothing wrong was found in {}, but not all is as it should be\n{report}",
            report.mechanism
        ));
    }
    Ok(())
}

fn in_words(reports: &[Report], seed: Seed) -> String {
    let mut text: String = reports.iter().map(|report| format!("{report}\n")).collect();
    let proved: Vec<&Report> = reports.iter().filter(|report| report.is_proved()).collect();
    text += &format!("{} of {} proved", proved.len(), count(reports.len() as u64, "module"));
    if let Some(worst) = proved.iter().map(|report| report.error_log10()).reduce(f64::max) {
        text += &format!("; each is false with a probability below 1e{:.0}", worst.ceil());
    }
    text + &format!("\nto repeat this: --seed {seed}\n")
}
