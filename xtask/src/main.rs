//! `cargo xtask`: all commands of `gyro`, run from the workspace, and what only those who develop the project need.

mod args;
mod embedded;
mod lanes;
mod performance;
mod release;
mod scaling;

use args::{Cli, Command};
use gyro_cli::parse;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = parse::<Cli>();
    cli.common.apply();
    let outcome = match cli.command {
        Command::Gyro(command) => command.run(),
        Command::Performance(args) => performance::performance(&args),
        Command::Embedded(args) => embedded::embedded(&args),
        Command::Release(args) => release::release(&args),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
