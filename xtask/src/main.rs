//! `cargo xtask`: all commands of `gyro`, run from the workspace, and what only those who develop the project need.

mod args;
#[cfg(feature = "developers")]
mod embedded;
#[cfg(feature = "developers")]
mod lanes;
#[cfg(feature = "developers")]
mod performance;
#[cfg(feature = "developers")]
mod release;
#[cfg(feature = "developers")]
mod scaling;

use args::{Cli, Command};
use gyro_cli::parse;
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = parse::<Cli>();
    cli.common.apply();
    let outcome = match cli.command {
        #[cfg(feature = "developers")]
        Command::Performance(args) => performance::performance(&args),
        #[cfg(feature = "developers")]
        Command::Embedded(args) => embedded::embedded(&args),
        #[cfg(feature = "developers")]
        Command::Release(args) => release::release(&args),
        #[cfg(not(feature = "developers"))]
        Command::Performance(_) | Command::Embedded(_) | Command::Release(_) => return for_developers(),
        #[cfg(not(feature = "developers"))]
        Command::Gyro(command) if matches!(*command, gyro_cli::Command::Report(_)) => {
            return for_developers();
        }
        Command::Gyro(command) => command.run(),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}

/// Does what was asked for by a build that has the commands of developers.
#[cfg(not(feature = "developers"))]
fn for_developers() -> ExitCode {
    let mut cargo = std::process::Command::new(gyro_cli::programs::cargo());
    cargo
        .args(["run", "--package", "xtask", "--features", "developers", "--"])
        .args(std::env::args_os().skip(1));
    match cargo.status() {
        Ok(status) => {
            status.code().and_then(|code| u8::try_from(code).ok()).map_or(ExitCode::FAILURE, ExitCode::from)
        }
        Err(error) => gyro_cli::failure::Failure::Run(format!("cargo does not start: {error}")).report(),
    }
}
