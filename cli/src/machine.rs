//! The machine that figures are measured on.

use crate::failure::Failure;
use crate::programs::output;
use std::fs;
use std::process::Command;

/// What the figures of programs depend on that are compiled with this profile.
///
/// # Errors
/// A compiler that does not say its version.
pub fn machine_in(profile: &str) -> Result<String, Failure> {
    Ok(format!("{}; profile `{profile}`", hardware()?))
}

/// Processor, system and compiler.
///
/// # Errors
/// A compiler that does not say its version.
pub fn hardware() -> Result<String, Failure> {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model =
        info.lines().find_map(|line| line.strip_prefix("model name")).and_then(|l| l.split_once(": "));
    let cpu = model.map_or("a processor of unknown name", |(_, name)| name);
    let cores = std::thread::available_parallelism().map_or(0, std::num::NonZero::get);
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let version = output(Command::new(rustc).arg("--version"))?;
    Ok(format!(
        "{cpu}, {cores} cores, {} {}; {}",
        std::env::consts::ARCH,
        std::env::consts::OS,
        version.trim()
    ))
}
