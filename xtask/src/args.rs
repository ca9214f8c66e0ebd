//! The command line's arguments.

use clap::{Args, Parser, Subcommand, ValueEnum};
use gyro_model::{Method, Rational, parse_decimal};
use gyro_runner::{Coordinates, Correction, Integrator, When};
use gyro_verifier::Seed;
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// What every command returns.
pub(crate) const EXIT_CODES: &str = "Exit codes:
  0  it is done
  1  it was asked for correctly and did not succeed: a run that ends early, a refuted proof, a stale file under --check
  2  it cannot be done as it was asked for: an option, a page or a file; nothing was begun
  3  the run has come to its end, and its result is worthless; files and figures are written all the same";

/// From a page of bodies and joints to Rust code and to plots.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask", after_help = EXIT_CODES)]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Generate(GenerateArgs),
    Simulate(SimulateArgs),
    Inspect(InspectArgs),
    Import(ImportArgs),
    Verify(VerifyArgs),
    Performance(PerformanceArgs),
    Report(ReportArgs),
    Embedded(EmbeddedArgs),
}

/// Write the Rust modules of models
///
/// Models in models/ go to gyro-sim/src/generated/NAME.rs, others beside their page. Nothing is written unless every
/// model is free of mistakes.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo xtask generate                          every model in models/
  cargo xtask generate --check                  fail if a generated file is not fresh
  cargo xtask generate ~/gimbal.toml --out src/gimbal.rs")]
pub(crate) struct GenerateArgs {
    /// Model pages; all of models/ if none is given
    #[arg(value_name = "MODEL")]
    pub(crate) models: Vec<PathBuf>,
    /// Write nothing: exit with status 1 and show the difference if a file is not what its model says
    #[arg(long)]
    pub(crate) check: bool,
    /// Where to write the module of a single model
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Refuse models with redundant constraint rows instead of dropping the rows with a warning
    #[arg(long)]
    pub(crate) strict: bool,
}

/// Prove generated modules against the textbook
///
/// Parses the module of each model back from its file and decides, by identity testing over a prime field, whether
/// every function computes what the textbook says. See docs/verification.md.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo xtask verify                            every module of the workspace
  cargo xtask verify ~/gimbal.toml              the module that `cargo xtask generate` wrote beside the page
  cargo xtask verify --json models/gyroscope.toml")]
pub(crate) struct VerifyArgs {
    /// Model pages; all of the workspace if none is given
    #[arg(value_name = "MODEL")]
    pub(crate) models: Vec<PathBuf>,
    /// Measure rounding instead: errors of generated code and of both forms of the twin, against 384 bits
    #[arg(long, conflicts_with_all = ["quick", "json"])]
    pub(crate) rounding: bool,
    /// Measure the stability of trees instead: masses, inertias and joint points become parameters, and random
    /// configurations of ten kinds are compared with 384 bits, beside the dense twin
    #[arg(long, value_name = "CONFIGURATIONS", num_args = 0..=1, default_missing_value = "1000", conflicts_with_all = ["rounding", "quick", "json"])]
    pub(crate) stability: Option<NonZeroUsize>,
    /// One point for each claim instead of two
    #[arg(long)]
    pub(crate) quick: bool,
    /// Test at the points of this seed, as another run has printed it; otherwise they are drawn anew
    #[arg(long, value_name = "HEX", conflicts_with_all = ["rounding", "stability"])]
    pub(crate) seed: Option<Seed>,
    /// Print one JSON array and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

/// Show what is generated from a model, what is left out, and what each element of the model costs
///
/// Prints coordinates, equations and degrees of freedom; of each function the operations before and after each pass and
/// the bytes of machine code; and the operations of the same model without one of its elements, or with more
/// parameters. Writes no module.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo xtask inspect models/gyroscope.toml
  cargo xtask inspect ~/gimbal.toml --no-compile     no machine code: at once
  cargo xtask inspect models/four-bar.toml --json")]
pub(crate) struct InspectArgs {
    /// Model page, anywhere on disk
    #[arg(value_name = "MODEL")]
    pub(crate) model: PathBuf,
    /// Leave out the machine code, for which the module has to be compiled
    #[arg(long)]
    pub(crate) no_compile: bool,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

/// Simulate a model
///
/// Prints a summary and writes a CSV file and plots. What no option says, the model page's own table `simulation` says.
/// Of an option that is given twice the last one counts. All times are in seconds.
#[derive(Clone, Debug, Args)]
#[command(
    args_override_self = true,
    after_help = "Examples:
  cargo xtask simulate models/gyroscope.toml
  cargo xtask simulate models/gyroscope.toml --engine assembled --t-end 10
  cargo xtask simulate models/gyroscope.toml --method direct --step 2e-4 --out /tmp/direct
  cargo xtask simulate models/gyroscope.toml --integrator dop853 --tolerance 1e-9 --coordinates joint --verify
  cargo xtask simulate models/gyroscope.toml --linearize 0.5 --json
  cargo xtask simulate my-gimbal.toml --set rotor_mass=0.085 --json
  cargo xtask simulate my-gimbal.toml --input motor=torque.csv --input brake=0.01

Exit codes: 0 done; 1 the run has failed; 2 it cannot be made as it was asked for; 3 it has come to its end, and the result is
worthless"
)]
pub(crate) struct SimulateArgs {
    /// Model page, anywhere on disk
    #[arg(value_name = "MODEL")]
    pub(crate) model: PathBuf,
    /// What computes the motion
    #[arg(long, value_enum, default_value_t = Engine::Generated)]
    pub(crate) engine: Engine,
    /// Length of the run
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true)]
    pub(crate) t_end: Option<f64>,
    /// Largest step of the integrator; intervals are divided into equal steps
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true)]
    pub(crate) step: Option<f64>,
    /// Interval between corrections of the dependent coordinates
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true)]
    pub(crate) correct_every: Option<f64>,
    /// Integration alone, or with coordinate partitioning
    #[arg(long, value_enum, overrides_with = "correction")]
    pub(crate) method: Option<MethodName>,
    /// The integrator: rk4 (fixed steps), tsit5, dop853, or rodas4 for stiff scenes
    #[arg(long, value_name = "NAME", value_parser = integrator, default_value = "rk4")]
    pub(crate) integrator: Integrator,
    /// Error tolerated in each step, relative and absolute: steps are then as long as it allows
    #[arg(long, value_name = "TOL", value_parser = tolerance, allow_hyphen_values = true, conflicts_with = "step")]
    pub(crate) tolerance: Option<f64>,
    /// What is integrated: positions and Euler parameters of all bodies, or a tree's joint coordinates (generated code
    /// only)
    #[arg(long, value_name = "maximal|joint", value_parser = coordinates, default_value = "maximal")]
    pub(crate) coordinates: Coordinates,
    /// How constraints are kept: partition, closed-form (trees), mass-weighted, baumgarte=RATE, none [default: the
    /// page's]
    #[arg(long, value_name = "NAME", value_parser = correction)]
    pub(crate) correction: Option<Correction>,
    /// When they are corrected: steps=K or violation=SIZE [default: --correct-every; every step with --tolerance]
    #[arg(long, value_name = "WHEN", value_parser = when, overrides_with = "correct_every")]
    pub(crate) correct_when: Option<When>,
    /// Steps after which the run is given up [default: 10 million with --tolerance]. Fixed steps that would take more
    /// than an hour are made only with a budget
    #[arg(long, value_name = "STEPS", value_parser = clap::value_parser!(u64).range(1..), allow_hyphen_values = true)]
    pub(crate) budget: Option<u64>,
    /// Run a second time with a finer step or tolerance, and say in words how far the result can be trusted
    #[arg(long)]
    pub(crate) verify: bool,
    /// End the run at this time, 0 for the start, and print the linearisation of the joint coordinates there: A, B and
    /// eigenvalues. Trees only
    #[arg(long, value_name = "S", value_parser = seconds_or_none, allow_hyphen_values = true, conflicts_with = "t_end")]
    pub(crate) linearize: Option<f64>,
    /// Number type of the run
    #[arg(long, value_enum, default_value_t = Precision::F64)]
    pub(crate) precision: Precision,
    /// Interval between samples [default: the page's, on the nearest whole number of corrections]
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true)]
    pub(crate) every: Option<f64>,
    /// Value of one of the model's parameters; may be given several times. The start is assembled anew
    #[arg(long, value_name = "PARAMETER=VALUE", value_parser = setting)]
    pub(crate) set: Vec<(String, Rational)>,
    /// What one of the model's inputs is, once for each input: a number, or a CSV file with two columns, time and
    /// value. Between rows the value is linear, beyond them it is held; each step has the value at its start. Other
    /// inputs keep the page's value
    #[arg(long, value_name = "NAME=FILE.csv|NUMBER", value_parser = feed)]
    pub(crate) input: Vec<(String, Feed)>,
    /// Refuse a model with redundant constraint rows instead of dropping the rows with a warning
    #[arg(long)]
    pub(crate) strict: bool,
    /// Folder for the CSV file and the plots [default: out/NAME; none with --json]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print one JSON object on standard output and nothing else: the last sample, what its numbers are, and the files
    /// with all samples
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Engine {
    /// Generated code, compiled for the purpose
    Generated,
    /// The runtime-assembled twin, as a careful engineer would make it where the model allows (trees of revolute,
    /// spherical and fixed joints): starts at once
    Assembled,
    /// The twin in the paper's plain dense form
    Dense,
    /// The twin as a recursion in joint coordinates: for trees of any joints, and the quickest without compiling
    Recursive,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MethodName {
    Direct,
    Partitioned,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Precision {
    F32,
    F64,
}

impl Engine {
    /// Its name on the command line.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::Generated => "generated",
            Self::Assembled => "assembled",
            Self::Dense => "dense",
            Self::Recursive => "recursive",
        }
    }
}

impl Precision {
    /// The Rust type.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::F32 => "f32",
            Self::F64 => "f64",
        }
    }
}

impl From<MethodName> for Method {
    fn from(name: MethodName) -> Self {
        match name {
            MethodName::Direct => Self::Direct,
            MethodName::Partitioned => Self::Partitioned,
        }
    }
}

/// Write the model page of a URDF robot
///
/// Says what of the robot has no counterpart on the page. Link frames become body frames at the mass centres; links
/// without mass are merged with what they are fixed to.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo xtask import arm.urdf                    writes arm.toml beside it
  cargo xtask import arm.urdf --out models/arm.toml
  cargo xtask import quadruped.urdf --floating   its trunk floats")]
pub(crate) struct ImportArgs {
    /// Robot in the Unified Robot Description Format
    #[arg(value_name = "FILE.urdf")]
    pub(crate) file: PathBuf,
    /// Where to write the page [default: beside the robot, with the extension toml]
    #[arg(long, value_name = "MODEL.toml")]
    pub(crate) out: Option<PathBuf>,
    /// Let the root link float in place of fixing it to the ground
    #[arg(long)]
    pub(crate) floating: bool,
    /// Replace a page that an import has written
    #[arg(long)]
    pub(crate) force: bool,
}

/// Measure generated code and write the tables of docs/performance.md
///
/// Times every kernel of the paper's scene beside a floor derived by hand and the forms of the twin, in turns in one
/// process; counts instructions where valgrind is installed; generates, compiles and runs chains of more and more
/// bodies. All of it optimised. Takes several minutes; leave the machine alone meanwhile.
#[derive(Debug, Args)]
pub(crate) struct PerformanceArgs {
    /// The page whose tables are to be replaced [default: docs/performance.md]
    #[arg(long, value_name = "FILE.md")]
    pub(crate) out: Option<PathBuf>,
    /// Bodies of the longest chain; 0 leaves the chains and their table alone
    #[arg(long, value_name = "N", default_value_t = 64)]
    pub(crate) bodies: usize,
    /// Measure packs of lanes alone and leave the other tables alone
    #[arg(long, conflicts_with = "bodies")]
    pub(crate) only_lanes: bool,
}

/// Report error against run time, drift and stability of scenes
///
/// Runs each scene by every integrator, correction, coordinates and precision and by the twins, counts errors from a
/// reference solution of its own, and writes a page for each scene as Markdown and as one HTML file, figures, raw data
/// as CSV and an index. All of it takes about twenty minutes; leave the machine alone meanwhile.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo xtask report                             every model in models/, to docs/report
  cargo xtask report models/gyroscope.toml
  cargo xtask report --quick                     a minute, to target/report
  cargo xtask report ~/gimbal.toml --out ~/gimbal-report")]
pub(crate) struct ReportArgs {
    /// Model pages; all of models/ if none is given
    #[arg(value_name = "MODEL")]
    pub(crate) models: Vec<PathBuf>,
    /// Few points and short runs, and the paper's scene alone if none is given
    #[arg(long)]
    pub(crate) quick: bool,
    /// Folder of the report [default: docs/report; target/report with --quick]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

/// Run the firmware and write docs/embedded.md
///
/// Builds the firmware in embedded/ for a Cortex-M7 and a Cortex-M4F, runs it under QEMU, compares every bit with the
/// same runs on this machine, proves by the linker that nothing panics or allocates, and writes the tables of
/// docs/embedded.md anew. The tools come from embedded/setup.sh; nothing is fetched here.
#[derive(Debug, Args)]
pub(crate) struct EmbeddedArgs {
    /// The page whose tables are to be replaced [default: docs/embedded.md]
    #[arg(long, value_name = "FILE.md")]
    pub(crate) out: Option<PathBuf>,
    /// Print the tables instead, and write nothing
    #[arg(long, conflicts_with = "out")]
    pub(crate) print: bool,
}

/// What is fed into an input.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Feed {
    /// A constant.
    Number(f64),
    /// A table.
    File(PathBuf),
}

fn feed(text: &str) -> Result<(String, Feed), String> {
    let (name, value) = text
        .split_once('=')
        .ok_or("NAME=FILE.csv or NAME=NUMBER was expected, such as motor=torque.csv or motor=0.02")?;
    let (name, value) = (name.trim().to_owned(), value.trim());
    match value.parse::<f64>() {
        Ok(number) if number.is_finite() => Ok((name, Feed::Number(number))),
        Ok(_) => Err(format!("`{value}` is not a finite number")),
        Err(_) if value.is_empty() => Err(format!("nothing stands after `{name}=`")),
        Err(_) => Ok((name, Feed::File(PathBuf::from(value)))),
    }
}

fn integrator(text: &str) -> Result<Integrator, String> {
    text.parse().map_err(|()| "rk4, tsit5, dop853 or rodas4 was expected".to_owned())
}

fn coordinates(text: &str) -> Result<Coordinates, String> {
    text.parse().map_err(|()| "maximal or joint was expected".to_owned())
}

fn correction(text: &str) -> Result<Correction, String> {
    let expected =
        "partition, closed-form, mass-weighted, baumgarte=RATE or none was expected, such as baumgarte=100";
    text.parse().map_err(|()| expected.to_owned())
}

fn when(text: &str) -> Result<When, String> {
    text.parse()
        .map_err(|()| "steps=K or violation=SIZE was expected, such as steps=5 or violation=1e-10".to_owned())
}

fn tolerance(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value <= 1.0 => Ok(value),
        _ => Err("a number above 0 and at most 1 was expected, such as 1e-9".to_owned()),
    }
}

fn seconds_or_none(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value >= 0.0 && value.is_finite() => Ok(value),
        _ => Err("0 or a positive number of seconds was expected, such as 0.5".to_owned()),
    }
}

fn seconds(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("a positive number of seconds was expected, such as 1e-4".to_owned()),
    }
}

fn setting(text: &str) -> Result<(String, Rational), String> {
    let (name, value) =
        text.split_once('=').ok_or("PARAMETER=VALUE was expected, such as rotor_mass=0.08")?;
    let exact = parse_decimal(value)
        .ok_or_else(|| format!("`{}` is not a decimal number, such as -0.08 or 8e-2", value.trim()))?;
    Ok((name.trim().to_owned(), exact))
}

#[cfg(test)]
mod tests;
