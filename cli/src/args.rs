//! The command line's arguments.

use clap::{Args, Parser, Subcommand, ValueEnum};
use gyro_model::{Method, Rational, parse_decimal};
use gyro_runner::{Coordinates, Correction, Integrator, When};
use gyro_verifier::Seed;
use std::num::NonZeroUsize;
use std::path::PathBuf;

/// What every command returns.
pub const EXIT_CODES: &str = "Exit codes:
  0  it is done
  1  it was asked for correctly and did not succeed: a run that ends early, a refuted proof, a stale file under --check
  2  it cannot be done as it was asked for: an option, a model or another file; nothing was begun
  3  the run has come to its end, and its result is worthless; files and figures are written all the same";

/// From a model file of bodies and joints to Rust code and to plots.
#[derive(Debug, Parser)]
#[command(name = "gyro", after_help = EXIT_CODES)]
pub struct Cli {
    /// What is to be done.
    #[command(subcommand)]
    pub command: Command,
}

/// What there is to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    Generate(GenerateArgs),
    Simulate(SimulateArgs),
    Inspect(InspectArgs),
    Import(ImportArgs),
    Verify(VerifyArgs),
    Report(ReportArgs),
}

/// Write the Rust modules of models and their data sheets
///
/// The module of a model goes beside its model file, or where --out says. Of the models of this project the data sheets
/// are kept (mechanisms/sheets, tests/sheets, embedded/sheets) and a few modules to be read (mechanisms/src/golden, and
/// the paper's scene in gyro-sim/src/generated); all others are generated when they are compiled. Nothing is written
/// unless every model is free of mistakes.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo xtask generate                          what is kept of every model of this project
  cargo xtask generate models/torsion.toml --out out/torsion.rs
  cargo xtask generate --check                  fail if a generated file is not fresh
  cargo xtask generate ~/gimbal.toml --out src/gimbal.rs")]
pub struct GenerateArgs {
    /// Model files; all of this project if none is given
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
  cargo xtask verify ~/gimbal.toml              the module that `cargo xtask generate` wrote beside the model
  cargo xtask verify --json models/gyroscope.toml")]
pub struct VerifyArgs {
    /// Model files; all of the workspace if none is given
    #[arg(value_name = "MODEL")]
    pub(crate) models: Vec<PathBuf>,
    /// Measure rounding instead: errors of generated code and of two runtime-assembled forms, against 384 bits
    #[arg(long, conflicts_with_all = ["quick", "json"])]
    pub(crate) rounding: bool,
    /// Measure the stability of trees instead: masses, inertias and joint points become parameters, and random
    /// configurations of ten kinds are compared with 384 bits, beside the dense assembled form
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
pub struct InspectArgs {
    /// Model file, anywhere on disk
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
/// Prints a summary and writes a CSV file and plots. What no option says, the model file's own table `simulation` says.
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
pub struct SimulateArgs {
    /// Model file, anywhere on disk
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
    /// What is integrated: positions and Euler parameters of all bodies, or joint coordinates (generated code of
    /// mechanisms that have them)
    #[arg(long, value_name = "maximal|joint", value_parser = coordinates, default_value = "maximal")]
    pub(crate) coordinates: Coordinates,
    /// How constraints are kept: partition, closed-form (generated code with joint coordinates), mass-weighted,
    /// baumgarte=RATE, none [default: the model file's]
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
    /// End the run at this time, 0 for the start, and print the linearisation of the joint coordinates there (with
    /// loops, of independent ones): A, B, eigenvalues, frequencies and damping ratios
    #[arg(long, value_name = "S", value_parser = seconds_or_none, allow_hyphen_values = true, conflicts_with = "t_end")]
    pub(crate) linearize: Option<f64>,
    /// Number type of the run
    #[arg(long, value_enum, default_value_t = Precision::F64)]
    pub(crate) precision: Precision,
    /// Interval between samples [default: the model file's, on the nearest whole number of corrections]
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true)]
    pub(crate) every: Option<f64>,
    /// Value of one of the model's parameters; may be given several times. The start is assembled anew
    #[arg(long, value_name = "PARAMETER=VALUE", value_parser = setting)]
    pub(crate) set: Vec<(String, Rational)>,
    /// What one of the model's inputs is, once for each input: a number, or a CSV file with two columns, time and
    /// value. Between rows the value is linear, beyond them it is held; each step has the value at its start. Other
    /// inputs keep the model file's value
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
    /// The runtime-assembled model, as a careful engineer would make it where the mechanism allows (trees of revolute,
    /// spherical and fixed joints): starts at once
    Assembled,
    /// The runtime-assembled model in the paper's plain dense form
    Dense,
    /// The same as a recursion in joint coordinates: for trees of any joints, and the quickest without compiling
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

/// Write the model file of a URDF robot
///
/// Says what of the robot has no counterpart in the model file. Link frames become body frames at the mass centres;
/// links without mass are merged with what they are fixed to.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo xtask import arm.urdf                    writes arm.toml beside it
  cargo xtask import arm.urdf --out models/arm.toml
  cargo xtask import quadruped.urdf --floating   its trunk floats")]
pub struct ImportArgs {
    /// Robot in the Unified Robot Description Format
    #[arg(value_name = "FILE.urdf")]
    pub(crate) file: PathBuf,
    /// Where to write the model file [default: beside the robot, with the extension toml]
    #[arg(long, value_name = "MODEL.toml")]
    pub(crate) out: Option<PathBuf>,
    /// Let the root link float in place of fixing it to the ground
    #[arg(long)]
    pub(crate) floating: bool,
    /// Replace a model file that an import has written
    #[arg(long)]
    pub(crate) force: bool,
}

/// Report error against run time, drift and stability of scenes
///
/// Runs each scene by every integrator, correction, coordinates and precision and by runtime-assembled models, counts
/// errors from a reference solution of its own, and writes a page for each scene as Markdown and as one HTML file,
/// figures, raw data as CSV and an index. All of it takes about twenty minutes; leave the machine alone meanwhile.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  cargo xtask report                             every model in models/, to out/report; what is kept, to docs/report
  cargo xtask report models/gyroscope.toml
  cargo xtask report --quick                     a minute, to target/report
  cargo xtask report ~/gimbal.toml --out ~/gimbal-report")]
pub struct ReportArgs {
    /// Model files; all of models/ if none is given
    #[arg(value_name = "MODEL")]
    pub(crate) models: Vec<PathBuf>,
    /// Few points and short runs, and the paper's scene alone if none is given
    #[arg(long)]
    pub(crate) quick: bool,
    /// Folder of the report [default: out/report; target/report with --quick]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
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
mod tests {
    use super::*;

    fn simulate(args: &[&str]) -> Result<SimulateArgs, String> {
        let all = ["gyro", "simulate", "x.toml"].iter().chain(args);
        match Cli::try_parse_from(all) {
            Ok(Cli { command: Command::Simulate(args) }) => Ok(args),
            Ok(other) => Err(format!("{other:?}")),
            Err(error) => Err(error.to_string()),
        }
    }

    #[test]
    fn every_option_is_read() {
        let args = simulate(&[
            "--engine=dense",
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
        assert_eq!((args.engine, args.precision, args.json), (Engine::Dense, Precision::F32, true));
        assert_eq!((args.t_end, args.step), (Some(2.0), Some(1e-3)));
        assert_eq!((args.correct_every, args.every), (Some(5e-3), Some(0.5)));
        assert_eq!(args.method, Some(MethodName::Direct));
        assert_eq!(args.set[0], ("m".to_owned(), parse_decimal("-0.1").unwrap()));
        assert_eq!(args.set[1], ("g".to_owned(), parse_decimal("10").unwrap()));
        assert_eq!(args.input[0], ("motor".to_owned(), Feed::File(PathBuf::from("a=b.csv"))));
        assert_eq!(args.input[1], ("brake".to_owned(), Feed::Number(-1e-3)));
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
            (&["--input", "motor="], "nothing stands after `motor=`"),
            (&["--input", "motor=nan"], "`nan` is not a finite number"),
            (&["--integrator", "euler"], "rk4, tsit5, dop853 or rodas4 was expected"),
            (&["--coordinates", "polar"], "maximal or joint was expected"),
            (&["--correction", "baumgarte"], "such as baumgarte=100"),
            (&["--correct-when", "steps=0"], "such as steps=5"),
            (&["--step", "1e-3", "--tolerance", "1e-6"], "cannot be used with"),
            (&["--engine", "steam"], "possible values: generated, assembled, dense, recursive"),
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
        assert_eq!((args.method, args.correction), (None, Some(Correction::Partition)));
        assert_eq!(args.input.len(), 2);
    }

    #[test]
    fn the_commands_are_consistent() {
        use clap::CommandFactory;
        Cli::command().debug_assert();
    }
}
