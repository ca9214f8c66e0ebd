//! The gimbal from C, on this machine and on the Cortex-M7, and from JavaScript: the same bits as from Rust.

use super::firmware::{self, BUILDING, Chip, Program, RUNNING, TRIPLE};
use super::host::{self, Expected};
use super::output::Output;
use super::process::within;
use super::tools::Tools;
use super::{folder, proof, say, target};
use gyro_cli::failure::Failure;
use gyro_cli::programs::{io_failure, output};
use gyro_cli::progress::Spinner;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What is linked takes, bytes.
pub(crate) struct Sizes {
    pub(crate) c: u64,
    pub(crate) wasm: u64,
}

/// Builds and runs all three.
pub(crate) fn check(tools: &Tools, expected: &Expected) -> Result<Sizes, Failure> {
    let spinner = Spinner::new("from C on the host".to_owned());
    same("C on the host", expected, &c_on_host()?)?;
    drop(spinner);
    let spinner = Spinner::new("from C on the target".to_owned());
    let program = c_for_target(tools)?;
    same("C on the Cortex-M7", expected, &firmware::run(tools, Chip::M7, &program)?)?;
    let forbidden = proof::forbidden(&program)?;
    if !forbidden.is_empty() {
        return Err(Failure::Run(format!("the example in C has {}", forbidden.join(", "))));
    }
    drop(spinner);
    let spinner = Spinner::new("from JavaScript".to_owned());
    let module = wasm(tools)?;
    same("WebAssembly without imports", expected, &node(tools, &module)?)?;
    drop(spinner);
    let wasm = fs::metadata(&module).map_err(|e| io_failure(&module, &e))?.len();
    Ok(Sizes { c: super::elf::Elf::read(&program.path)?.size(".text"), wasm })
}

/// Compares what an example printed with the same run in Rust.
fn same(what: &str, expected: &Expected, text: &str) -> Result<(), Failure> {
    let outcome = Output::parse(text).and_then(|output| expected.has(&output.runs));
    outcome.map_err(|words| Failure::Run(format!("{what}: {words}")))?;
    say(&format!("{what}: the bits of Rust, misuse answered with errors"));
    Ok(())
}

fn source() -> PathBuf {
    folder().join("c")
}

/// The text of the header, from its source.
pub(crate) fn header() -> Result<String, Failure> {
    let _spinner = Spinner::new("writing the header".to_owned());
    let mut command = host::cargo("run", "");
    // Only run once: it would take longer to optimise.
    command.args(["--package", "gimbal-header", "--target-dir"]).arg(target().join("host"));
    output(&mut command)
}

pub(crate) fn header_path() -> PathBuf {
    source().join("include").join("gimbal.h")
}

/// Fails if the header is not what its source says.
pub(crate) fn check_header(text: &str) -> Result<(), Failure> {
    let path = header_path();
    if gyro_cli::write::holds(&path, text) {
        return Ok(());
    }
    Err(Failure::Run(format!("{} is stale, run: cargo xtask embedded", path.display())))
}

/// What every C compiler is told.
const C_FLAGS: [&str; 6] = ["-std=c11", "-Wall", "-Wextra", "-Werror", "-O2", "-Wl,--gc-sections"];

fn c_on_host() -> Result<String, Failure> {
    let target = target().join("host");
    let mut command = host::cargo("rustc", "");
    command
        .args(["--release", "--package", "gimbal", "--crate-type", "staticlib", "--target-dir"])
        .arg(&target);
    output(&mut command)?;
    let program = target.join("gimbal-in-c");
    let mut compiler = Command::new(std::env::var_os("CC").unwrap_or_else(|| "cc".into()));
    compiler
        .args(C_FLAGS)
        .args(["-Iinclude", "example.c", "host.c"])
        .arg(target.join("release").join("libgimbal.a"))
        .arg("-o")
        .arg(&program)
        .current_dir(source());
    output(&mut compiler)?;
    said_by("the example in C", &mut Command::new(&program))
}

fn c_for_target(tools: &Tools) -> Result<Program, Failure> {
    let flags = format!("-Ctarget-cpu={} -Clinker-flavor=ld.lld -Zemit-stack-sizes", Chip::M7.cpu());
    let mut command = tools.cargo("rustc", TRIPLE, "ld.lld", &flags);
    build(command.args(["--package", "gimbal", "--crate-type", "staticlib"]))?;
    let path = target().join(Chip::M7.cpu()).join("gimbal-in-c");
    let mut compiler = tools.command("arm-none-eabi-gcc");
    compiler
        .args(C_FLAGS)
        .args(["-mcpu=cortex-m7", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv5-d16", "-ffreestanding"])
        .args([
            "-nostdlib",
            "-Tboard/board.ld",
            "-Wl,-z,noexecstack",
            "-Iinclude",
            "example.c",
            "board/board.c",
        ])
        .arg(target().join("target").join(TRIPLE).join("release").join("libgimbal.a"))
        .arg("-o")
        .arg(&path)
        .current_dir(source());
    output(&mut compiler)?;
    Ok(Program { name: "gimbal-in-c".to_owned(), path })
}

fn wasm(tools: &Tools) -> Result<PathBuf, Failure> {
    const TRIPLE: &str = "wasm32-unknown-unknown";
    let mut command = tools.cargo("rustc", TRIPLE, "wasm-ld", "-Clinker-flavor=wasm-ld");
    build(command.args(["--package", "gimbal", "--crate-type", "cdylib"]))?;
    Ok(target().join("target").join(TRIPLE).join("release").join("gimbal.wasm"))
}

fn node(tools: &Tools, module: &Path) -> Result<String, Failure> {
    said_by("the example in JavaScript", tools.command("node").arg(source().join("example.mjs")).arg(module))
}

/// What an example prints, under a time limit; its failure is this command's.
fn said_by(what: &str, command: &mut Command) -> Result<String, Failure> {
    match within(RUNNING, command)? {
        (true, text) => Ok(text),
        (false, text) => Err(Failure::Run(format!("{what} failed\n{text}"))),
    }
}

fn build(command: &mut Command) -> Result<(), Failure> {
    match within(BUILDING, command)? {
        (true, _) => Ok(()),
        (false, words) => Err(Failure::Run(format!("the gimbal's library cannot be built\n{words}"))),
    }
}
