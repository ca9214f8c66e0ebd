//! By which program the commands are called: `gyro`, or `cargo xtask` for those who develop the project. Help texts
//! and messages name that one.

use crate::Cli;
use crate::args::CompletionsArgs;
use crate::failure::Failure;
use crate::remarks::say;
use clap::error::{ContextKind, ContextValue};
use clap::{Arg, Command, CommandFactory, Parser};
use std::ffi::{OsStr, OsString};
use std::sync::OnceLock;

/// What help texts write for the program.
const PROGRAM: &str = "{program}";

/// The program of this process, once its arguments have been read.
static NAME: OnceLock<String> = OnceLock::new();

/// Reads the arguments of this process. Help texts and messages name the program as the parser calls it.
#[must_use]
pub fn parse<P: Parser>() -> P {
    let command = named(P::command());
    NAME.get_or_init(|| name_of(&command));
    let words: Vec<OsString> = std::env::args_os().collect();
    let matches = command.clone().try_get_matches_from(&words);
    let matches =
        matches.map_err(|error| with_suggestion(error, command, words.iter().map(OsString::as_os_str)));
    matches.and_then(|matches| P::from_arg_matches(&matches)).unwrap_or_else(|error| error.exit())
}

/// The error with the option that was meant where an unknown one was written, if that is known; the parser itself
/// offers the nearest in letters, however far.
pub(crate) fn with_suggestion<'w>(
    mut error: clap::Error,
    command: Command,
    words: impl Iterator<Item = &'w OsStr>,
) -> clap::Error {
    let Some(ContextValue::String(written)) = error.get(ContextKind::InvalidArg) else { return error };
    let called = words.fold(&command, |command, word| command.find_subcommand(word).unwrap_or(command));
    let known: Vec<String> =
        called.get_arguments().filter_map(Arg::get_long).map(|name| name.replace('-', "_")).collect();
    let known: Vec<&str> = known.iter().map(String::as_str).collect();
    let written = written.trim_start_matches('-').replace('-', "_");
    let meant = gyro_model::meant(&written, &known).map(|name| format!("--{}", name.replace('_', "-")));
    error.remove(ContextKind::SuggestedArg);
    error.remove(ContextKind::Suggested);
    if let Some(meant) = meant {
        error.insert(ContextKind::SuggestedArg, ContextValue::String(meant));
    }
    error
}

/// Prints the completions for a shell, of the program and of `cargo xtask` alike: commands and options are the same.
pub(crate) fn completions(args: &CompletionsArgs) -> Result<(), Failure> {
    let mut text = Vec::new();
    clap_complete::generate(args.shell, &mut named(Cli::command()), "gyro", &mut text);
    say(&String::from_utf8_lossy(&text))
}

/// The name of the program: what a user types before the name of a command.
pub(crate) fn program() -> &'static str {
    NAME.get().map_or("gyro", String::as_str)
}

/// A parser's command with the program's name in the help of each of its subcommands, and of theirs.
#[must_use]
pub fn named(command: Command) -> Command {
    let name = name_of(&command);
    command.mut_subcommands(|subcommand| filled(subcommand, &name))
}

fn filled(command: Command, name: &str) -> Command {
    let help = command.get_after_help().map(|help| help.to_string().replace(PROGRAM, name));
    let command = match help {
        Some(help) => command.after_help(help),
        None => command,
    };
    command.mut_subcommands(|subcommand| filled(subcommand, name))
}

fn name_of(command: &Command) -> String {
    command.get_bin_name().unwrap_or_else(|| command.get_name()).to_owned()
}

#[cfg(test)]
mod tests;
