//! The command line's arguments.

mod begin;
mod export;
mod show;
mod simulate;
mod sweep;

use clap::{Args, Parser, Subcommand};
use gyro_verifier::Seed;
use std::num::NonZeroUsize;
use std::path::PathBuf;

pub(crate) use begin::{CheckArgs, NewArgs, SchemaArgs, Template};
pub(crate) use export::{CArgs, ExportArgs, FmuArgs, Target, WasmArgs};
pub(crate) use show::{Change, ShowArgs};
pub(crate) use simulate::{Engine, EventSetting, InputSetting, Precision, SimulateArgs, table};
pub(crate) use sweep::{MergeArgs, Shard, SweepArgs, SweepCommand, SweepEngine};

/// The exit codes of every command.
pub const EXIT_CODES: &str = "Exit codes:
  0  success
  1  the request was valid but failed: a run that ends early, a refuted proof, a stale file under --check
  2  the request was invalid: an option, a model file or another file; nothing was started
  3  the run completed, but its result is worthless; files and figures are written nevertheless
  130  interrupted by Ctrl-C; a run has kept what it had computed";

/// The version, and the commit that this program was built from.
pub const VERSION: &str = match env!("GYRO_COMMIT").is_empty() {
    true => env!("CARGO_PKG_VERSION"),
    false => concat!(env!("CARGO_PKG_VERSION"), " (", env!("GYRO_COMMIT"), ")"),
};

/// From a model file of bodies and joints to Rust code and to plots.
#[derive(Debug, Parser)]
#[command(name = "gyro", version = VERSION, after_help = EXIT_CODES)]
pub struct Cli {
    /// What goes for all commands.
    #[command(flatten)]
    pub common: Common,
    /// The command to run.
    #[command(subcommand)]
    pub command: Command,
}

/// Options of all commands.
#[derive(Debug, Args)]
pub struct Common {
    /// Print no notes and no progress on standard error; warnings and errors are printed
    #[arg(long, short, global = true)]
    quiet: bool,
}

impl Common {
    /// Does what they ask for.
    pub fn apply(&self) {
        if self.quiet {
            crate::remarks::be_quiet();
        }
    }
}

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    New(NewArgs),
    Check(CheckArgs),
    Schema(SchemaArgs),
    Generate(GenerateArgs),
    Simulate(SimulateArgs),
    Sweep(SweepArgs),
    Show(ShowArgs),
    Export(ExportArgs),
    Inspect(InspectArgs),
    Import(ImportArgs),
    Verify(VerifyArgs),
    Report(ReportArgs),
    Cache(CacheArgs),
    Completions(CompletionsArgs),
    #[command(hide = true)]
    #[cfg(feature = "reports")]
    Answer(AnswerArgs),
}

/// Show where generated programs are built, or remove what was built
///
/// Runs of generated code are compiled in a folder of the user's cache, or in the one that the environment variable
/// GYRO_CACHE names. What other versions of this program have built there is removed when they have not been used for
/// a month.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  {program} cache
  {program} cache --clear")]
pub struct CacheArgs {
    /// Remove all of it
    #[arg(long)]
    pub(crate) clear: bool,
}

/// Print completions of commands and options for a shell
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  {program} completions bash > ~/.local/share/bash-completion/completions/gyro
  {program} completions zsh > ~/.zfunc/_gyro
  {program} completions fish > ~/.config/fish/completions/gyro.fish")]
pub struct CompletionsArgs {
    /// The shell
    #[arg(value_enum)]
    pub(crate) shell: clap_complete::Shell,
}

/// Answer requests on standard input with the runtime-assembled model: what `report` asks
#[cfg(feature = "reports")]
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  {program} answer models/gyroscope.toml careful f64")]
pub struct AnswerArgs {
    /// Model file
    pub(crate) model: PathBuf,
    /// recursive, careful or dense
    pub(crate) form: String,
    /// f32 or f64
    pub(crate) precision: String,
}

/// Write the Rust modules of models and their data sheets
///
/// The module of a model is written beside its model file, or to the path given by --out. Of the models of this
/// project, the data sheets are committed (mechanisms/sheets, tests/sheets, embedded/sheets), and a few modules to be
/// read (mechanisms/src/golden, and the paper's scene in gyro-sim/src/generated); all other modules are generated at
/// build time. Nothing is written unless all models are valid.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  {program} generate                          the committed files of all models of this project
  {program} generate models/torsion.toml --out out/torsion.rs
  {program} generate --check                  fail if a generated file is out of date
  {program} generate ~/gimbal.toml --out src/gimbal.rs
  {program} generate ~/gimbal.toml --functions joint    without its Jacobian")]
pub struct GenerateArgs {
    /// Model files [default: all of this project]
    #[arg(value_name = "MODEL")]
    pub(crate) models: Vec<PathBuf>,
    /// Write nothing; exit with status 1 and show the difference if a file is out of date
    #[arg(long)]
    pub(crate) check: bool,
    /// Where to write the module of a single model
    #[arg(long, value_name = "FILE")]
    pub(crate) out: Option<PathBuf>,
    /// Functions of the module, by their names or by groups, separated by commas; a function comes with its group, and
    /// a group with what it needs [default: the model file's, or the usual ones]
    #[arg(long, value_name = "NAMES", value_delimiter = ',', requires = "models", long_help = functions_help())]
    pub(crate) functions: Option<Vec<String>>,
    /// Carry the work of friction, motors and the like as one more state, for the balance of energy, unless the model
    /// file says `count_work = false`
    #[arg(long)]
    pub(crate) count_work: bool,
    /// Refuse models with redundant constraint rows instead of dropping the rows with a warning
    #[arg(long)]
    pub(crate) strict: bool,
}

/// What `--functions` is, with the groups and their functions.
fn functions_help() -> String {
    format!(
        "Functions of the module, by their names or by groups, separated by commas; a function comes with its group, and a \
         group with what it needs [default: the model file's, or the usual ones]\n\n{}",
        gyro_codegen::Functions::help()
    )
}

/// Prove generated modules against the textbook
///
/// Parses the module of each model back from its file and decides, by identity testing over a prime field, whether
/// every function computes what the textbook says. See docs/verification.md.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  {program} verify                            every module of the workspace
  {program} verify ~/gimbal.toml              the module that `{program} generate` wrote beside the model
  {program} verify --json models/gyroscope.toml")]
pub struct VerifyArgs {
    /// Model files [default: all of the workspace]
    #[arg(value_name = "MODEL")]
    pub(crate) models: Vec<PathBuf>,
    /// Measure rounding instead: errors of generated code and of two runtime-assembled forms, against 384 bits
    #[arg(long, conflicts_with_all = ["quick", "json"])]
    pub(crate) rounding: bool,
    /// Measure the stability of trees instead: masses, inertias and joint points become parameters, and random
    /// configurations of ten kinds are compared with 384 bits, beside the dense runtime-assembled form
    #[arg(long, value_name = "CONFIGURATIONS", num_args = 0..=1, default_missing_value = "1000", conflicts_with_all = ["rounding", "quick", "json"])]
    pub(crate) stability: Option<NonZeroUsize>,
    /// Test each claim at one point instead of two
    #[arg(long)]
    pub(crate) quick: bool,
    /// Seed of the test points, as printed by an earlier run [default: a new random seed]
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
  {program} inspect models/gyroscope.toml
  {program} inspect ~/gimbal.toml --no-compile     without machine code: immediate
  {program} inspect models/four-bar.toml --json")]
pub struct InspectArgs {
    /// Model file, anywhere on disk
    #[arg(value_name = "MODEL")]
    pub(crate) model: PathBuf,
    /// Skip the machine code, which needs the module to be compiled
    #[arg(long)]
    pub(crate) no_compile: bool,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

/// Write the model file of a URDF robot
///
/// Reports what in the robot has no counterpart in a model file. Links that are fixed to one another become one body,
/// whose frame is at the mass centre with the axes of the link on the body's joint.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  {program} import arm.urdf                    writes arm.toml beside it
  {program} import arm.urdf --out models/arm.toml
  {program} import quadruped.urdf --floating   its trunk floats
  {program} import arm.urdf --motors --limits  with a motor for each joint, and its stops
  {program} import arm.urdf --wrenches hand    with a force and a torque on the link `hand`")]
pub struct ImportArgs {
    /// Robot in the Unified Robot Description Format
    #[arg(value_name = "FILE.urdf")]
    pub(crate) file: PathBuf,
    /// Where to write the model file [default: beside the robot, with the extension toml]
    #[arg(long, value_name = "MODEL.toml")]
    pub(crate) out: Option<PathBuf>,
    /// Let the root link float instead of fixing it to the ground
    #[arg(long)]
    pub(crate) floating: bool,
    /// Give each joint a motor whose torque or force is an input, JOINT_motor
    #[arg(long)]
    pub(crate) motors: bool,
    /// Give each joint that follows no other this armature: the inertia of its drive's rotor, behind the gear, in kg m2
    /// or kg (that of the rotor times the square of the gear's ratio)
    #[arg(long, value_name = "INERTIA", value_parser = not_negative)]
    pub(crate) armature: Option<f64>,
    /// Make stops of the joints' limits
    #[arg(long)]
    pub(crate) limits: bool,
    /// Let a force and a torque act on these links: at the origin of the link's frame, global components, each an
    /// input, LINK_force_x to LINK_torque_z
    #[arg(long, value_name = "LINK", value_delimiter = ',')]
    pub(crate) wrenches: Vec<String>,
    /// Give these links, or `all` that move, outputs of their frames: LINK_pose and LINK_velocity
    #[arg(long, value_name = "LINK", value_delimiter = ',')]
    pub(crate) frames: Vec<String>,
    /// Keep all numbers of the robot: inertias that no body has (of positive moments), angles close to right ones and
    /// directions close to axes, which are otherwise taken for these
    #[arg(long)]
    pub(crate) as_written: bool,
    /// Weigh the shapes of links whose mass or inertia is missing, or whose inertia no body has, at this density, kg/m3
    #[arg(long, value_name = "DENSITY", value_parser = density)]
    pub(crate) density: Option<f64>,
    /// Leave these elements out, though the robot may be another mechanism without them
    #[arg(long, value_name = "ELEMENT", value_delimiter = ',')]
    pub(crate) ignore: Vec<String>,
    /// Overwrite a model file that an earlier import has written
    #[arg(long)]
    pub(crate) force: bool,
}

/// A density that something has.
fn density(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| *number > 0.0 && *number < 1e6);
    number.ok_or_else(|| "write a density in kg/m3, such as 1000".to_owned())
}

/// A number of 0 or more.
fn not_negative(text: &str) -> Result<f64, String> {
    let number = text.parse::<f64>().ok().filter(|number| number.is_finite() && *number >= 0.0);
    number.ok_or_else(|| "write an inertia of 0 or more, such as 0.01".to_owned())
}

/// Report error against run time, drift and stability of scenes
///
/// Runs each scene with every integrator, correction, choice of coordinates and precision, and with runtime-assembled
/// models; measures errors against the scene's reference solution; and writes a page for each scene as Markdown and as
/// one HTML file, figures, raw data as CSV and an index. A full report takes about twenty minutes; keep the machine
/// otherwise idle.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  {program} report                             every model in models/, to out/report; its index, to docs/report
  {program} report models/gyroscope.toml
  {program} report --quick                     a minute, to target/report
  {program} report ~/gimbal.toml --out ~/gimbal-report")]
pub struct ReportArgs {
    /// Model files [default: all of models/]
    #[arg(value_name = "MODEL")]
    pub(crate) models: Vec<PathBuf>,
    /// Few points and short runs; only the paper's scene if no model is given
    #[arg(long)]
    pub(crate) quick: bool,
    /// Folder of the report [default: out/report; target/report with --quick]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
}

#[cfg(test)]
mod tests;
