//! What runs a study's scenarios: code in this process, or a program that rustc compiles.

use super::loaded::Loaded;
use super::starts;
use crate::args::Precision;
use crate::failure::Failure;
use crate::proof::Proof;
use crate::runs::{Runs, main_by};
use crate::write::digest;
use crate::{in_process, nested, progress};
use gyro_codegen::{Functions, Module, Scheduled};
use gyro_model::Model;
use gyro_sweep::InProcess;
use std::path::PathBuf;
use std::sync::{Arc, Mutex};

/// How scenarios are run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// In the lanes of packs, in joint coordinates.
    Packs,
    /// Each as a whole run of `simulate`.
    Whole,
}

impl Way {
    pub(super) fn of(loaded: &Loaded) -> Self {
        if starts::are_alike(&loaded.study, &loaded.scene) { Self::Packs } else { Self::Whole }
    }
}

/// What runs scenarios. Both give the same bits.
#[derive(Debug)]
pub(super) enum Program {
    InProcess(Mutex<Box<InProcess>>),
    Compiled(PathBuf),
}

/// What runs are made; nothing where a program for all runs makes them.
fn runs(loaded: &Loaded) -> Option<Runs> {
    // Motions with contacts are compared among themselves.
    Runs::of(&loaded.scene).filter(|_| !loaded.study.keep.estimate || loaded.scene.offers.touches)
}

fn functions(loaded: &Loaded) -> Functions {
    runs(loaded).map_or_else(Functions::of_solvers, Runs::functions)
}

/// Digest of what is computed: of other kernels the bits may be others.
pub(super) fn digest_of(scheduled: &Scheduled, way: Way, is_native: bool) -> String {
    digest(format!("{scheduled:?} {way:?} {is_native}").as_bytes())
}

/// The kernels as data.
///
/// # Errors
/// A model of which no code can be generated.
pub(super) fn scheduled(loaded: &Loaded) -> Result<Scheduled, Failure> {
    let _spinner = progress::deriving(&loaded.scene.page);
    gyro_codegen::schedule(&loaded.scene.page, &functions(loaded), loaded.scene.effort)
        .map_err(|error| Failure::Usage(error.to_string()))
}

/// Compiles in this process, or prepares to interpret; a proof of it is on its way.
///
/// # Errors
/// A model of which no code can be generated.
pub(super) fn in_process(loaded: &Loaded, way: Way) -> Result<(InProcess, Proof), Failure> {
    let Loaded { scene, .. } = loaded;
    let (runs, functions) = (runs(loaded), functions(loaded));
    let proof = Proof::begin(scene, &functions);
    let mechanism = in_process::compiled::<f64>(scene, &functions, Some(&proof))?;
    let of_whole = (way == Way::Whole).then(|| in_process::of_runs(scene, runs));
    Ok((InProcess { model: Arc::new(scene.page.clone()), mechanism, runs: of_whole }, proof))
}

/// Generates, proves and compiles by rustc.
///
/// # Errors
/// A model of which no code can be generated, or code that does not compile.
pub(super) fn compiled(loaded: &Loaded, way: Way, is_native: bool) -> Result<PathBuf, Failure> {
    let Loaded { study, scene, .. } = loaded;
    let runs = runs(loaded);
    let spinner = progress::deriving(&scene.page);
    let module = gyro_codegen::generate_functions(&scene.page_name, &scene.page, &functions(loaded))
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
    nested::sweeping(&scene.page, &module, main, is_native)
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
