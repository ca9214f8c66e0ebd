//! `gyro`: see `gyro --help`.

use gyro_cli::{Cli, parse};
use std::process::ExitCode;

fn main() -> ExitCode {
    let cli = parse::<Cli>();
    cli.common.apply();
    match cli.command.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.report(),
    }
}
