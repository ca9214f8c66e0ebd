//! Cargo inside cargo: packages outside the workspace that a test builds.

use std::path::Path;
use std::process::{Command, Output};

/// The output of a finished program.
#[derive(Clone, Debug)]
pub struct Said {
    /// Whether it succeeded.
    pub is_success: bool,
    /// Its standard output.
    pub stdout: String,
    /// Its standard error.
    pub stderr: String,
}

/// Runs a program to its end.
///
/// # Panics
/// If it cannot be started.
pub fn say(command: &mut Command) -> Said {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?} does not start: {error}"));
    let Output { status, stdout, stderr } = output;
    let text = |bytes: Vec<u8>| String::from_utf8_lossy(&bytes).into_owned();
    Said { is_success: status.success(), stdout: text(stdout), stderr: text(stderr) }
}

/// Runs `cargo`, offline, on a package outside the workspace, with the workspace's locked versions and a target folder
/// that all nested builds share.
///
/// # Panics
/// If it cannot be started, or the package's folder cannot be written to.
pub fn cargo(package: &Path, target: &Path, command: &str, arguments: &[&str]) -> Said {
    let lock = Path::new(env!("CARGO_MANIFEST_DIR")).join("Cargo.lock");
    // Cargo drops from its copy what the package does not need.
    std::fs::copy(&lock, package.join("Cargo.lock")).expect("the folder of the package can be written to");
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args([command, "--offline", "--quiet", "--manifest-path"]).arg(package.join("Cargo.toml"));
    cargo.arg("--target-dir").arg(target).args(arguments);
    // Set by the outer cargo for this package alone.
    cargo.env_remove("CARGO_TARGET_DIR").env_remove("CARGO_MANIFEST_DIR");
    say(&mut cargo)
}
