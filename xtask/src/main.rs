//! `cargo xtask`: all commands of `gyro`, run from the workspace, and what only those who develop the project need.

mod args;
mod embedded;
mod lanes;
mod performance;
mod scaling;

use args::{Cli, Command};
use clap::Parser;
use std::process::ExitCode;

fn main() -> ExitCode {
    let outcome = match Cli::parse().command {
        Command::Gyro(command) => command.run(),
        Command::Performance(args) => performance::performance(&args),
        Command::Embedded(args) => embedded::embedded(&args),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
