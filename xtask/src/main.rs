//! The command line of the project. See `cargo xtask --help`.

mod args;
mod compare;
mod csv;
mod failure;
mod files;
mod fit;
mod generate;
mod json;
mod linear;
mod nested;
mod plot;
mod progress;
mod scene;
mod simulate;
mod spectrum;
mod summary;
mod words;

use args::{Cli, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let outcome = match Cli::parse().command {
        Command::Generate(args) => generate::generate(&args),
        Command::Simulate(args) => simulate::simulate(&args),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
