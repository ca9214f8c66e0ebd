//! The arguments of `export`.

use super::Precision;
use clap::{Args, Subcommand};
use gyro_runner::{Integrator, listed};
use std::path::PathBuf;

/// Write a mechanism with its solver for other languages and tools
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  {program} export c models/four-bar.toml --out out/four-bar
  {program} export wasm models/four-bar.toml --out out/four-bar
  {program} export fmu models/four-bar.toml --out out/four-bar.fmu")]
pub struct ExportArgs {
    #[command(subcommand)]
    pub(crate) target: Target,
}

/// What it is written as.
#[derive(Debug, Subcommand)]
pub(crate) enum Target {
    C(CArgs),
    Wasm(WasmArgs),
    Fmu(FmuArgs),
}

/// Write a C99 header and one C source: all functions of the module, and a solver with error control
///
/// The source needs the C library's header <math.h> and nothing else; it allocates nothing and has no global state.
/// Compiled without contraction of products and sums (-std=c99, or -ffp-contract=off), it computes the bits of the
/// generated Rust. The module is proved before it is written. See docs/export.md.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  {program} export c models/four-bar.toml --out out/four-bar
  {program} export c ~/gimbal.toml --out firmware/gimbal --precision f32
  {program} export c ~/arm.toml --out out/arm --functions all --library")]
pub struct CArgs {
    /// Model file, anywhere on disk
    #[arg(value_name = "MODEL")]
    pub(crate) model: PathBuf,
    /// Folder for NAME.h and NAME.c; it is made if need be
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Number type
    #[arg(long, value_enum, default_value = "f64")]
    pub(crate) precision: Precision,
    /// Functions, by their names or by groups, separated by commas [default: the model file's, or what solvers call]
    #[arg(long, value_name = "NAMES", value_delimiter = ',', long_help = super::functions_help())]
    pub(crate) functions: Option<Vec<String>>,
    /// Also compile it, with the C compiler `cc` or that of the variable CC, into a static library libNAME.a
    #[arg(long)]
    pub(crate) library: bool,
    /// Carry the work of friction, motors and the like as one more state, for the balance of energy, unless the model
    /// file says `count_work = false`
    #[arg(long)]
    pub(crate) count_work: bool,
    /// Refuse models with redundant constraint rows instead of dropping the rows with a warning
    #[arg(long)]
    pub(crate) strict: bool,
}

/// Write a WebAssembly module with an ES module around it and its declarations for TypeScript
///
/// All functions of the module, and a solver with error control, for browsers and Node; it imports nothing and computes
/// the bits of the generated Rust. It is the C of `export c`, compiled by clang: by what the variable CLANG names, or
/// `clang`, or that which embedded/setup.sh unpacks into the clone. The module is proved before it is written. See
/// docs/export.md.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  {program} export wasm models/four-bar.toml --out out/four-bar
  {program} export wasm ~/arm.toml --out web/arm --functions all")]
pub struct WasmArgs {
    /// Model file, anywhere on disk
    #[arg(value_name = "MODEL")]
    pub(crate) model: PathBuf,
    /// Folder for NAME.wasm, NAME.mjs and NAME.d.mts; it is made if need be
    #[arg(long, value_name = "DIR")]
    pub(crate) out: PathBuf,
    /// Number type
    #[arg(long, value_enum, default_value = "f64")]
    pub(crate) precision: Precision,
    /// Functions, by their names or by groups, separated by commas [default: the model file's, or what solvers call]
    #[arg(long, value_name = "NAMES", value_delimiter = ',', long_help = super::functions_help())]
    pub(crate) functions: Option<Vec<String>>,
    /// Carry the work of friction, motors and the like as one more state, for the balance of energy, unless the model
    /// file says `count_work = false`
    #[arg(long)]
    pub(crate) count_work: bool,
    /// Refuse models with redundant constraint rows instead of dropping the rows with a warning
    #[arg(long)]
    pub(crate) strict: bool,
}

/// Write a functional mock-up unit (FMI 3.0) for model exchange and co-simulation
///
/// Inputs, outputs, parameters, states and derivatives of the mechanism in joint coordinates, with a solver for
/// co-simulation. The archive holds the C sources and, where a C compiler is at hand, a library for this platform. The
/// module is proved before it is written. See docs/export.md.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  {program} export fmu models/four-bar.toml --out out/four-bar.fmu
  {program} export fmu ~/bearing.toml --out bearing.fmu --integrator rodas4 --tolerance 1e-6")]
pub struct FmuArgs {
    /// Model file, anywhere on disk
    #[arg(value_name = "MODEL")]
    pub(crate) model: PathBuf,
    /// Where to write the archive
    #[arg(long, value_name = "FILE.fmu")]
    pub(crate) out: PathBuf,
    /// What co-simulation integrates by: tsit5, dop853, or rodas4 for stiff mechanisms
    #[arg(long, default_value = "dop853", value_parser = adaptive)]
    pub(crate) integrator: Integrator,
    /// Its tolerance, relative and absolute, where the importing tool gives none
    #[arg(long, default_value = "1e-9", value_parser = super::simulate::tolerance)]
    pub(crate) tolerance: f64,
    /// Sources alone, without a library for this platform
    #[arg(long)]
    pub(crate) sources_only: bool,
    /// Carry the work of friction, motors and the like as one more state, for the balance of energy, unless the model
    /// file says `count_work = false`
    #[arg(long)]
    pub(crate) count_work: bool,
    /// Refuse models with redundant constraint rows instead of dropping the rows with a warning
    #[arg(long)]
    pub(crate) strict: bool,
}

/// What co-simulation integrates by: a method with an error estimate.
fn adaptive(text: &str) -> Result<Integrator, String> {
    let method = text.parse().ok().filter(|method: &Integrator| method.is_adaptive());
    method.ok_or_else(|| format!("{} was expected", listed(Integrator::is_adaptive)))
}
