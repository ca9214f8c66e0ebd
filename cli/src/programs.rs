//! Programs that are built and run to be measured.

use crate::failure::Failure;
use crate::files;
use crate::progress::Spinner;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Scratch: what is built and measured on the way.
pub fn folder() -> PathBuf {
    files::root().join("target").join("performance")
}

pub fn io_failure(path: &Path, error: &std::io::Error) -> Failure {
    Failure::Run(format!("{} cannot be used: {error}", path.display()))
}

/// Builds a program that measures, as `set` has Cargo do it; returns where it is.
pub fn built(bench: &str, set: impl FnOnce(&mut Command)) -> Result<PathBuf, Failure> {
    let _spinner = Spinner::new("building the benches".to_owned());
    let mut command = Command::new(cargo());
    command
        .args(["bench", "--no-run", "--package", "gyro-benches", "--bench", bench])
        .current_dir(files::root());
    set(&mut command);
    executable(&mut command, bench)
}

/// Has Cargo build what it is told to; returns where the program of this name is.
///
/// # Errors
/// That of the build.
pub fn executable(command: &mut Command, name: &str) -> Result<PathBuf, Failure> {
    let messages = output(command.arg("--message-format=json"))?;
    let executable = |line: &str| {
        let message: serde_json::Value = serde_json::from_str(line).ok()?;
        let is_ours = message["target"]["name"] == name;
        is_ours.then(|| message["executable"].as_str().map(PathBuf::from)).flatten()
    };
    messages
        .lines()
        .find_map(executable)
        .ok_or_else(|| Failure::Run(format!("cargo does not say where `{name}` is")))
}

pub fn cargo() -> std::ffi::OsString {
    std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into())
}

/// What a command prints; its failure is this command's.
pub fn output(command: &mut Command) -> Result<String, Failure> {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command
        .stdin(Stdio::null())
        .output()
        .map_err(|e| Failure::Run(format!("{name} cannot be started: {e}")))?;
    if output.status.success() {
        return Ok(String::from_utf8_lossy(&output.stdout).into_owned());
    }
    Err(Failure::Run(format!("{name}: {}\n{}", output.status, String::from_utf8_lossy(&output.stderr))))
}

/// Three digits, whole where there are more.
pub fn three(value: f64) -> String {
    let decimals = match value {
        v if v >= 100.0 => 0,
        v if v >= 10.0 => 1,
        _ => 2,
    };
    format!("{value:.decimals$}")
}
