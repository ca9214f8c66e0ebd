//! `gyro`: see `gyro --help`.

use gyro_cli::{Cli, parse};
use std::process::ExitCode;

fn main() -> ExitCode {
    match parse::<Cli>().command.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
