//! The program that runs a study's scenarios, and what it is asked for.

use crate::args::Precision;
use crate::failure::Failure;
use crate::runs::{Runs, main_by};
use crate::scene::Scene;
use crate::write::digest;
use crate::{nested, progress};
use gyro_codegen::{Functions, Module};
use gyro_model::Model;
use gyro_sweep::study::Study;
use std::path::PathBuf;

/// How scenarios are run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// In the lanes of packs, in joint coordinates.
    Packs,
    /// Each as a whole run of `simulate`.
    Whole,
}

/// A compiled program.
#[derive(Debug)]
pub(super) struct Program {
    pub(super) path: PathBuf,
    /// Digest of its text: with another program the bits may be others.
    pub(super) digest: String,
}

/// Generates, proves and compiles.
///
/// # Errors
/// A model of which no code can be generated, or code that does not compile.
pub(super) fn program(study: &Study, scene: &Scene, way: Way, is_native: bool) -> Result<Program, Failure> {
    // Motions with contacts are compared among themselves.
    let runs = Runs::of(scene).filter(|_| !study.keep.estimate || scene.offers.touches);
    let functions = match (way, runs) {
        (_, Some(runs)) => runs.functions(),
        (_, None) => Functions::of_solvers(),
    };
    let spinner = progress::deriving(&scene.page);
    let module = gyro_codegen::generate_functions(&scene.page_name, &scene.page, &functions)
        .map_err(|e| Failure::Usage(e.to_string()))?;
    drop(spinner);
    let (beside, more) = match study.keep.by.is_empty() {
        true => (String::new(), ""),
        false => (in_duals(&module), ", in_duals"),
    };
    let main = match (way, more) {
        (Way::Packs, _) => in_packs(&module, &scene.page, more),
        (_, "") => main_by("::gyro_sweep::child::whole", &module, Precision::F64, runs, more),
        _ => main_by("::gyro_sweep::child::whole_sensitive", &module, Precision::F64, runs, more),
    } + &beside;
    let main = if is_native { format!("// With all instructions of this processor.\n{main}") } else { main };
    let digest = digest(format!("{main}{}", module.code).as_bytes());
    let path = nested::sweeping(&scene.page, &module, main, is_native)?;
    Ok(Program { path, digest })
}

/// The mechanism in dual numbers, for sensitivities.
fn in_duals(module: &Module) -> String {
    let type_name = &module.type_name;
    let number = "::gyro_sim::Dual<f64, { ::gyro_runner::motion::COLUMNS }>";
    format!(
        "
fn in_duals(values: &[{number}]) -> mechanism::{type_name}<{number}> {{
    let mut built = mechanism::{type_name}::<{number}>::default();
    for (index, value) in values.iter().enumerate() {{
        built.set_parameter(index, *value);
    }}
    built
}}
"
    )
}

/// The lines of a program that runs packs, with what it is told besides.
fn in_packs(module: &Module, model: &Model, more: &str) -> String {
    let type_name = &module.type_name;
    let fields = model.parameters.iter().enumerate();
    let fields: Vec<String> = fields.map(|(k, one)| format!("{}: values[{k}]", one.name)).collect();
    let fields = fields.join(", ");
    let (built, checked) = match model.parameters.is_empty() {
        true => ("::default()".to_owned(), "|_| Ok(())".to_owned()),
        false => (
            format!("::new(mechanism::Parameters {{ {fields} }})"),
            format!(
                "|values| mechanism::Parameters::<f64> {{ {fields} }}.check().map_err(|refused| {{
        let name = mechanism::{type_name}::<f64>::PARAMETERS[usize::from(refused.parameter)];
        format!(\"the mechanism cannot have this value of `{{name}}`\")
    }})"
            ),
        ),
    };
    let packs = if more.is_empty() { "packs" } else { "packs_sensitive" };
    format!(
        "#[allow(warnings, clippy::all)]
mod mechanism;

fn build<T: ::gyro_sim::Scalar>(values: &[T]) -> mechanism::{type_name}<T> {{
    mechanism::{type_name}{built}
}}

fn main() -> ::std::process::ExitCode {{
    ::gyro_sweep::child::{packs}(build::<f64>, build::<::gyro_sim::lanes::f64x8>, {checked}{more})
}}
"
    )
}
