//! Builds the firmware for a chip and runs it under QEMU.

use super::process::within;
use super::target;
use super::tools::Tools;
use gyro_cli::failure::Failure;
use gyro_cli::programs::io_failure;
use gyro_cli::progress::Spinner;
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::time::Duration;

/// A processor and the board that QEMU has for it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Chip {
    /// Single precision only.
    M4,
    /// Both.
    M7,
}

impl Chip {
    pub(crate) const ALL: [Self; 2] = [Self::M7, Self::M4];

    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::M4 => "Cortex-M4F",
            Self::M7 => "Cortex-M7",
        }
    }

    /// As compiler and QEMU call it.
    pub(crate) fn cpu(self) -> &'static str {
        match self {
            Self::M4 => "cortex-m4",
            Self::M7 => "cortex-m7",
        }
    }

    fn machine(self) -> &'static str {
        match self {
            Self::M4 => "mps2-an386",
            Self::M7 => "mps2-an500",
        }
    }

    /// The precisions in which its programs run.
    pub(crate) fn precisions(self) -> &'static [&'static str] {
        match self {
            Self::M4 => &["f32"],
            Self::M7 => &["f32", "f64"],
        }
    }
}

/// What the firmware's package has in every precision.
pub(crate) const PROGRAMS: [&str; 6] = ["balancer", "control", "runs", "figures", "stabilised", "quadruped"];

/// A program for a chip.
#[derive(Clone, Debug)]
pub(crate) struct Program {
    pub(crate) name: String,
    pub(crate) path: PathBuf,
}

pub(crate) const TRIPLE: &str = "thumbv7em-none-eabihf";

/// The command that builds the firmware.
pub(crate) fn cargo(tools: &Tools, chip: Chip) -> Command {
    let flags = format!("-Ctarget-cpu={} -Clinker-flavor=ld.lld -Zemit-stack-sizes", chip.cpu());
    let mut command = tools.cargo("build", TRIPLE, "ld.lld", &flags);
    command.args(["--package", "firmware"]);
    command
}

/// Builds all programs that a chip can run.
pub(crate) fn build(tools: &Tools, chip: Chip) -> Result<Vec<Program>, Failure> {
    let spinner = Spinner::new(format!("building the firmware of the {}", chip.name()));
    let names: Vec<String> = PROGRAMS
        .iter()
        .flat_map(|program| chip.precisions().iter().map(move |precision| format!("{program}-{precision}")))
        .collect();
    let mut command = cargo(tools, chip);
    names.iter().for_each(|name| _ = command.args(["--bin", name]));
    let (is_success, words) = within(BUILDING, &mut command)?;
    drop(spinner);
    if !is_success {
        return Err(Failure::Run(format!("the firmware of the {} cannot be built\n{words}", chip.name())));
    }
    names.into_iter().map(|name| kept(chip, name)).collect()
}

/// How long one build may take.
pub(crate) const BUILDING: Duration = Duration::from_secs(600);

/// The next build, for another chip, would replace it.
fn kept(chip: Chip, name: String) -> Result<Program, Failure> {
    let folder = target().join(chip.cpu());
    let path = folder.join(&name);
    let built = target().join("target").join(TRIPLE).join("release").join(&name);
    fs::create_dir_all(&folder).and_then(|()| fs::copy(&built, &path)).map_err(|e| io_failure(&built, &e))?;
    Ok(Program { name, path })
}

/// How long a program may run.
pub(crate) const RUNNING: Duration = Duration::from_secs(120);

/// Virtual time of an instruction, as the power of two of nanoseconds: 4 ns for a program that keeps time, 256 ns for
/// one that counts.
fn shift(name: &str) -> u32 {
    if name.starts_with("control") { 2 } else { 8 }
}

/// Runs a program; what it printed.
pub(crate) fn run(tools: &Tools, chip: Chip, program: &Program) -> Result<String, Failure> {
    match attempt(tools, chip, program)? {
        (true, text) => Ok(text),
        (false, text) => Err(Failure::Run(format!("{} on {} failed\n{text}", program.name, chip.name()))),
    }
}

/// Runs a program; whether it succeeded, and what it printed.
pub(crate) fn attempt(tools: &Tools, chip: Chip, program: &Program) -> Result<(bool, String), Failure> {
    let icount = format!("shift={},align=off,sleep=off", shift(&program.name));
    let mut command = tools.command("qemu-system-arm");
    command
        .args(["-machine", chip.machine(), "-cpu", chip.cpu(), "-nographic", "-monitor", "none"])
        .args(["-serial", "none", "-semihosting-config", "enable=on,target=native", "-icount", &icount])
        .arg("-kernel")
        .arg(&program.path);
    within(RUNNING, &mut command)
}
