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
pub(crate) use simulate::{Effort, Engine, EventSetting, InputSetting, Precision, SimulateArgs, table};
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
mod tests {
    use super::simulate::MethodName;
    use super::*;
    use gyro_model::parse_decimal;
    use gyro_runner::{Correction, When};

    fn simulate(args: &[&str]) -> Result<SimulateArgs, String> {
        let all = ["gyro", "simulate", "x.toml"].iter().chain(args);
        match Cli::try_parse_from(all) {
            Ok(Cli { command: Command::Simulate(args), .. }) => Ok(args),
            Ok(other) => Err(format!("{other:?}")),
            Err(error) => Err(error.to_string()),
        }
    }

    #[test]
    fn every_option_is_read() {
        let args = simulate(&[
            "--engine=assembled",
            "--t-end",
            "2",
            "--step=1e-3",
            "--correct-every",
            "5e-3",
            "--method",
            "direct",
            "--precision",
            "f32",
            "--every",
            ".5",
            "--set",
            "m=-0.1",
            "--set",
            "g=1e1",
            "--input",
            "motor=a=b.csv",
            "--input",
            "brake=-1e-3",
            "--strict",
            "--out",
            "d",
            "--json",
        ])
        .unwrap();
        assert_eq!((args.engine(), args.precision, args.json), (Engine::Assembled, Precision::F32, true));
        assert_eq!((args.t_end, args.step), (Some(2.0), Some(1e-3)));
        assert_eq!((args.correct_every, args.every), (Some(5e-3), Some(0.5)));
        assert_eq!(args.method, Some(MethodName::Kept(Correction::None)));
        assert_eq!(args.set[0], ("m".to_owned(), parse_decimal("-0.1").unwrap()));
        assert_eq!(args.set[1], ("g".to_owned(), parse_decimal("10").unwrap()));
        assert_eq!(args.input[0], ("motor".to_owned(), InputSetting::File(PathBuf::from("a=b.csv"), None)));
        assert_eq!(args.input[1], ("brake".to_owned(), InputSetting::Number(-1e-3)));
        assert!(args.strict);
    }

    #[test]
    fn mistakes_say_what_was_expected() {
        for (args, message) in [
            (&["--step", "-1"][..], "a positive number of seconds was expected"),
            (&["--t-end", "NaN"], "a positive number of seconds was expected"),
            (&["--every", "inf"], "a positive number of seconds was expected"),
            (&["--correct-every", "0"], "a positive number of seconds was expected"),
            (&["--step", "fast"], "a positive number of seconds was expected"),
            (&["--tolerance", "nan"], "a number above 0 and at most 1 was expected"),
            (&["--tolerance", "inf"], "a number above 0 and at most 1 was expected"),
            (&["--tolerance", "-1e-9"], "a number above 0 and at most 1 was expected"),
            (&["--tolerance", "0"], "a number above 0 and at most 1 was expected"),
            (&["--tolerance", ""], "a number above 0 and at most 1 was expected"),
            (&["--tolerance", "1e400"], "a number above 0 and at most 1 was expected"),
            (&["--tolerance", "2"], "a number above 0 and at most 1 was expected"),
            (&["--budget", "0"], "0 is not in 1.."),
            (&["--budget", "-1"], "invalid value"),
            (&["--budget", "nan"], "invalid"),
            (&["--budget", "1e3"], "invalid"),
            (&["--step", "1e400"], "a positive number of seconds was expected"),
            (&["--step", ""], "a positive number of seconds was expected"),
            (&["--linearize", "nan"], "0 or a positive number of seconds was expected"),
            (&["--linearize", "-1"], "0 or a positive number of seconds was expected"),
            (&["--correction", "baumgarte=nan"], "such as baumgarte=100"),
            (&["--correct-when", "violation=1e400"], "such as steps=5"),
            (&["--correct-when", "steps=1e12"], "such as steps=5"),
            (&["--input", "motor=1e400"], "`1e400` is not a finite number"),
            (&["--set", "mass"], "PARAMETER=VALUE was expected"),
            (&["--set", "mass=heavy"], "`heavy` is not a decimal number"),
            (&["--set", "mass=nan"], "`nan` is not a decimal number"),
            (&["--input", "motor"], "NAME=FILE.csv or NAME=NUMBER was expected"),
            (&["--input", "motor="], "a value is missing after `motor=`"),
            (&["--input", "motor=nan"], "`nan` is not a finite number"),
            (&["--integrator", "euler"], "rk4, tsit5, dop853 or rodas4 was expected"),
            (&["--coordinates", "polar"], "maximal or joint was expected"),
            (&["--correction", "baumgarte"], "such as baumgarte=100"),
            (&["--correct-when", "steps=0"], "such as steps=5"),
            (&["--step", "1e-3", "--tolerance", "1e-6"], "cannot be used with"),
            (&["--engine", "steam"], "in-process, generated, assembled"),
            (&["--methd", "direct"], "--method"),
        ] {
            let found = simulate(args).unwrap_err();
            assert!(found.contains(message), "{args:?}: {found}");
        }
    }

    #[test]
    fn advice_can_be_appended_to_any_command() {
        let given =
            ["--step=1e-3", "--correct-every=5e-3", "--method=direct", "--input", "a=1", "--input", "b=2"];
        let advice = ["--step", "1e-4", "--correct-when", "steps=1", "--correction", "partition"];
        let args = simulate(&[&given[..], &advice].concat()).unwrap();
        assert_eq!(
            (args.step, args.correct_every, args.correct_when),
            (Some(1e-4), None, Some(When::Steps(1)))
        );
        assert_eq!(args.correction(), Some(Correction::Partition));
        assert_eq!(args.input.len(), 2);
    }

    #[test]
    fn the_commands_are_consistent() {
        use clap::CommandFactory;
        Cli::command().debug_assert();
    }
}
