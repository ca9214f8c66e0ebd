//! For build scripts: from the model file and its module to yes or no.

use crate::report::Report;
use crate::seed::Seed;
use crate::verify::{Depth, verify_at};
use gyro_model::Diagnostics;
use std::fmt;

/// Why a module is not proved.
#[derive(Clone)]
pub enum NotProved {
    /// Mistakes in the model file.
    ModelFile(Diagnostics),
    /// Something in the module is refuted, refused or undecided.
    Module(Box<Report>),
}

/// Proves that a module computes what its model file asks for, at one point that is drawn anew each time.
///
/// ```
/// # let page = r#"
/// # format = 1
/// # name = "pendulum"
/// # gravity = [0, -9.81, 0]
/// # [[body]]
/// # name = "wall"
/// # fixed = true
/// # [[body]]
/// # name = "rod"
/// # mass = 1
/// # inertia = [1e-4, 0.08, 0.08]
/// # [[joint]]
/// # name = "hinge"
/// # kind = "revolute"
/// # axis = [0, 0, 1]
/// # zero = [1, 0, 0]
/// # first = { body = "wall" }
/// # second = { body = "rod", point = [-0.5, 0, 0] }
/// # "#;
/// let module = gyro_codegen::generate("pendulum.toml", page)?;
/// let report = gyro_verifier::prove("pendulum.toml", page, &module.code, &module.constants)?;
/// assert!(report.error_log10() < -30.0);
///
/// let wrong = module.code.replacen(" - ", " + ", 1);
/// assert!(gyro_verifier::prove("pendulum.toml", page, &wrong, &module.constants).is_err());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// What is right but flawed (a zero that is stored, say) is proved; [`Report::flaws`] tells.
///
/// # Errors
/// Mistakes in the model file, or the report of a module that is not proved.
pub fn prove(file_name: &str, page: &str, code: &str, constants: &str) -> Result<Report, NotProved> {
    let model = gyro_model::read(file_name, page).map_err(NotProved::ModelFile)?;
    prove_model(&model, code, constants)
}

/// The same for a model file whose motions name tables: `load` gives the text of the file that the model file calls by
/// this name.
///
/// # Errors
/// Mistakes in the model file, or the report of a module that is not proved.
pub fn prove_with(
    file_name: &str,
    page: &str,
    load: &mut dyn FnMut(&str) -> Result<String, String>,
    code: &str,
    constants: &str,
) -> Result<Report, NotProved> {
    let model = gyro_model::read_with(file_name, page, load).map_err(NotProved::ModelFile)?;
    prove_model(&model, code, constants)
}

fn prove_model(model: &gyro_model::Model, code: &str, constants: &str) -> Result<Report, NotProved> {
    let report = verify_at(model, code, constants, Depth::Quick, Seed::fresh());
    if report.is_right() { Ok(report) } else { Err(NotProved::Module(Box::new(report))) }
}

impl fmt::Display for NotProved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ModelFile(diagnostics) => diagnostics.fmt(f),
            Self::Module(report) => report.fmt(f),
        }
    }
}

/// The same words as [`fmt::Display`]: a `main` or `build.rs` that returns the error shows it in this form.
impl fmt::Debug for NotProved {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "\n{self}")
    }
}

impl std::error::Error for NotProved {}
