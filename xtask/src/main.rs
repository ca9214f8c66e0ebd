//! `cargo xtask`: all commands of `gyro`, run from the workspace, and what only those who develop the project need.

mod args;
mod embedded;
mod lanes;
mod performance;
mod scaling;

use args::{Cli, Command};
use gyro_cli::parse;
use std::process::ExitCode;

fn main() -> ExitCode {
    let outcome = match parse::<Cli>().command {
        Command::Gyro(command) => command.run(),
        Command::Performance(args) => performance::performance(&args),
        Command::Embedded(args) => embedded::embedded(&args),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
