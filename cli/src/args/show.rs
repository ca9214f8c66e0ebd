//! The arguments of `show`.

use super::{Cli, Command, Engine, SimulateArgs};
use crate::failure::Failure;
use clap::{Args, Parser, ValueEnum};
use gyro_model::{Rational, parse_decimal};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// Show a model moving, in a browser
///
/// Simulates the model and writes one HTML page in which it moves: a picture that can be turned, plots, numbers. The
/// page needs no network. Options of the run are those of `simulate`; unless one of them asks for generated code, the
/// run is made by the runtime-assembled model, which starts at once.
#[derive(Clone, Debug, Args)]
#[command(
    args_override_self = true,
    mut_arg("out", |arg| arg.value_name("FILE.html").help("Where to write the page [default: out/NAME/NAME.html]")),
    mut_arg("engine", |arg| arg.help("Engine that computes the motion [default: the one that answers first]")),
    mut_arg("json", |arg| arg.hide(true)),
    mut_arg("verify", |arg| arg.hide(true)),
    mut_arg("linearize", |arg| arg.hide(true)),
    after_help = "Examples:
  {program} show models/gyroscope.toml
  {program} show models/slider-crank.toml --t-end 3 --out crank.html --open
  {program} show my-gimbal.toml --compare rotor_mass=0.1
  {program} show models/four-bar.toml --compare generated --reactions
  {program} show models/gyroscope.toml --compare models/gyroscope-heavy-rotor.toml
  {program} show examples/pendulum.toml --live --open"
)]
pub struct ShowArgs {
    #[command(flatten)]
    pub(crate) simulate: SimulateArgs,
    /// Show a second run over the first, and what it has otherwise: PARAMETER=VALUE, an engine, or another model file;
    /// several are separated by commas
    #[arg(long, value_name = "CHANGES", value_parser = change, value_delimiter = ',')]
    pub(crate) compare: Vec<Change>,
    /// Compute the reactions of all joints, to be shown as arrows and plots
    #[arg(long)]
    pub(crate) reactions: bool,
    /// Put the mechanism into the page, as WebAssembly, with sliders for parameters and inputs
    ///
    /// The run is computed anew there, from the time that is shown on, when one is moved. It needs a compiler, as
    /// `export wasm` does, and a mechanism that has joint coordinates.
    #[arg(long)]
    pub(crate) live: bool,
    /// Open the page in the browser
    #[arg(long)]
    pub(crate) open: bool,
}

impl ShowArgs {
    /// For the run that the model file describes.
    pub(crate) fn of(model: &Path, page: &Path) -> Result<Self, Failure> {
        let words = [OsStr::new("gyro"), "show".as_ref(), "--out".as_ref(), page.as_ref(), "--".as_ref()];
        match Cli::try_parse_from(words.into_iter().chain([model.as_os_str()])).map(|cli| cli.command) {
            Ok(Command::Show(args)) => Ok(args),
            Ok(_) => unreachable!("`show` was asked for"),
            Err(error) => Err(Failure::Usage(error.to_string())),
        }
    }
}

/// What a second run has otherwise.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Change {
    /// Another engine.
    Engine(Engine),
    /// Another value of a parameter.
    Set(String, Rational),
    /// Another model file, of which parameters and inputs are as it has them.
    Model(PathBuf),
}

fn change(text: &str) -> Result<Change, String> {
    if Path::new(text.trim()).extension().is_some_and(|extension| extension == "toml") {
        return Ok(Change::Model(text.trim().into()));
    }
    let Some((name, value)) = text.split_once('=') else {
        return Engine::from_str(text.trim(), false).map(Change::Engine).map_err(|_| {
            "PARAMETER=VALUE, an engine or a model file was expected, such as rotor_mass=0.08, generated or other.toml".to_owned()
        });
    };
    let exact = parse_decimal(value)
        .ok_or_else(|| format!("`{}` is not a decimal number, such as -0.08 or 8e-2", value.trim()))?;
    Ok(Change::Set(name.trim().to_owned(), exact))
}
