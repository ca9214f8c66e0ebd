//! Arguments of the commands with which a mechanism begins: `new`, `check` and `schema`.

use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Write a commented start of a model file
///
/// The file is valid and can be simulated at once. Nothing is ever overwritten.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  {program} new swing                         writes swing.toml: a pendulum
  {program} new linkage --template four-bar
  {program} new gimbal --template gimbal --out models/gimbal.toml")]
pub struct NewArgs {
    /// Name of the mechanism: lowercase letters, digits and underscores
    #[arg(value_name = "NAME")]
    pub(crate) name: String,
    /// What to start from
    #[arg(long, value_enum, default_value = "pendulum")]
    pub(crate) template: Template,
    /// Where to write the model file [default: NAME.toml]
    #[arg(long, value_name = "FILE.toml")]
    pub(crate) out: Option<PathBuf>,
}

/// What a model file may start from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum Template {
    /// A bar that swings from a wall
    Pendulum,
    /// A cart on a rail with a pendulum, a spring and a motor
    Cart,
    /// A linkage with a closed loop
    FourBar,
    /// A gyroscope in two rings
    Gimbal,
    /// An arm of two links with motors and a payload
    Arm,
}

/// Say what is wrong with a model file, or what it is
///
/// Reports all mistakes at once, each with its line and what to write instead. Of a good model file it prints what it
/// describes: bodies and joints as a tree, closed loops, degrees of freedom, redundant rows, the start, parameters and
/// the functions that its module will have. Generates and simulates nothing.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  {program} check models/four-bar.toml
  {program} check ~/gimbal.toml --svg gimbal.svg     with a sketch of the skeleton")]
pub struct CheckArgs {
    /// Model file, anywhere on disk
    #[arg(value_name = "MODEL")]
    pub(crate) model: PathBuf,
    /// Draw the skeleton at the start: joints, and the bodies as lines between them
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) svg: Option<PathBuf>,
}

/// Write the JSON schema of model files, by which editors complete and check them
///
/// An editor's TOML support reads it: put `#:schema ./model.schema.json` in the first line of a model file beside it.
/// See docs/model-format.md.
#[derive(Debug, Args)]
#[command(after_help = "Examples:
  {program} schema                                prints it
  {program} schema --out model.schema.json")]
pub struct SchemaArgs {
    /// Where to write it [default: to the screen]
    #[arg(long, value_name = "FILE.json")]
    pub(crate) out: Option<PathBuf>,
}
