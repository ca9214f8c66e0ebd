//! The command line's arguments.

use clap::{Args, Parser, Subcommand, ValueEnum};
use gyro_model::{Method, Rational, parse_decimal};
use std::path::PathBuf;

/// From a page of bodies and joints to Rust code and to plots.
#[derive(Debug, Parser)]
#[command(name = "cargo xtask", bin_name = "cargo xtask")]
pub(crate) struct Cli {
    #[command(subcommand)]
    pub(crate) command: Command,
}

#[derive(Debug, Subcommand)]
pub(crate) enum Command {
    Generate(GenerateArgs),
    Simulate(SimulateArgs),
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
}

/// Simulate a model
///
/// Prints a summary and writes a CSV file and plots. What no option says, the model page's own table `simulation` says. All
/// times are in seconds.
#[derive(Clone, Debug, Args)]
#[command(after_help = "Examples:
  cargo xtask simulate models/gyroscope.toml
  cargo xtask simulate models/gyroscope.toml --engine assembled --t-end 10
  cargo xtask simulate models/gyroscope.toml --method direct --step 2e-4 --out /tmp/direct
  cargo xtask simulate my-gimbal.toml --set rotor_mass=0.085 --json")]
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
    #[arg(long, value_enum)]
    pub(crate) method: Option<MethodName>,
    /// Number type of the run
    #[arg(long, value_enum, default_value_t = Precision::F64)]
    pub(crate) precision: Precision,
    /// Interval between samples [default: the page's, on the nearest whole number of corrections]
    #[arg(long, value_name = "S", value_parser = seconds, allow_hyphen_values = true)]
    pub(crate) every: Option<f64>,
    /// Value of one of the model's parameters; may be given several times. The start is assembled anew
    #[arg(long, value_name = "PARAMETER=VALUE", value_parser = setting)]
    pub(crate) set: Vec<(String, Rational)>,
    /// Folder for the CSV file and the plots [default: out/NAME; none with --json]
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print one JSON object on standard output and nothing else
    #[arg(long)]
    pub(crate) json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Engine {
    /// Generated code, compiled for the purpose
    Generated,
    /// The runtime-assembled twin, as a careful engineer would make it: starts at once
    Assembled,
    /// The twin in the paper's plain dense form
    Dense,
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
        let all = ["cargo xtask", "simulate", "x.toml"].iter().chain(args);
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
    }

    #[test]
    fn mistakes_say_what_was_expected() {
        for (args, message) in [
            (&["--step", "-1"][..], "a positive number of seconds was expected"),
            (&["--t-end", "NaN"], "a positive number of seconds was expected"),
            (&["--every", "inf"], "a positive number of seconds was expected"),
            (&["--correct-every", "0"], "a positive number of seconds was expected"),
            (&["--step", "fast"], "a positive number of seconds was expected"),
            (&["--set", "mass"], "PARAMETER=VALUE was expected"),
            (&["--set", "mass=heavy"], "`heavy` is not a decimal number"),
            (&["--set", "mass=nan"], "`nan` is not a decimal number"),
            (&["--engine", "steam"], "possible values: generated, assembled, dense"),
            (&["--methd", "direct"], "--method"),
        ] {
            let found = simulate(args).unwrap_err();
            assert!(found.contains(message), "{args:?}: {found}");
        }
    }

    #[test]
    fn the_commands_are_consistent() {
        use clap::CommandFactory;
        Cli::command().debug_assert();
    }
}
