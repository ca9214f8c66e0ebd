//! What exported mechanisms run on: this machine, a Cortex-M7 under QEMU, WebAssembly under Node.

use crate::program::{self, FLAGS, folder, model_and_module, written};
use gyro_export::Precision;
use gyro_export::wasm::{OPTIONS, wasm};
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Where a mechanism runs.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Target {
    Here,
    CortexM7,
    WebAssembly,
}

/// A program that reads numbers and writes numbers, by what runs it.
pub(crate) struct Program {
    runner: Vec<OsString>,
    /// What goes before an argument of the program.
    before_argument: &'static str,
}

impl Program {
    /// A run with an argument.
    pub(crate) fn command(&self, argument: &str) -> Command {
        let mut command = Command::new(&self.runner[0]);
        command.args(&self.runner[1..]).arg(format!("{}{argument}", self.before_argument));
        command
    }
}

/// The driver; `driver.mjs` is the same in JavaScript.
const IN_C: (&str, &str) = ("driver", include_str!("driver.c"));

impl Target {
    /// The program of a mechanism; none on this machine if it has no C compiler.
    pub(crate) fn program(self, page: &str, precision: Precision) -> Option<Program> {
        match self {
            Self::Here => {
                let program = program::program(page, precision, IN_C, &[])?;
                Some(Program { runner: vec![program.into()], before_argument: "" })
            }
            Self::CortexM7 => Some(on_a_cortex_m7(page, precision)),
            Self::WebAssembly => Some(in_webassembly(page, precision)),
        }
    }
}

/// A program, of those that `embedded/setup.sh` fetches, or the machine's.
pub(crate) fn tool(name: &str) -> PathBuf {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).parent().expect("the target folder");
    let fetched = target.join("embedded/tools/bin").join(name);
    if fetched.is_file() { fetched } else { name.into() }
}

fn made(what: &str, command: &mut Command) {
    let name = command.get_program().to_string_lossy().into_owned();
    let output = command
        .output()
        .unwrap_or_else(|e| panic!("{name} cannot be started: {e}: embedded/setup.sh fetches it"));
    assert!(output.status.success(), "{what}: {}", String::from_utf8_lossy(&output.stderr));
}

/// As firmware is compiled; only from -O2 on would products and sums be fused if they were allowed to be.
const CORTEX_M7: [&str; 5] = ["-O2", "-mcpu=cortex-m7", "-mthumb", "-mfloat-abi=hard", "-mfpu=fpv5-d16"];
/// Printing and reading are the debugger's.
const BARE: [&str; 4] = ["--specs=rdimon.specs", "-nostartfiles", "-Tboard.ld", "board.c"];

fn on_a_cortex_m7(page: &str, precision: Precision) -> Program {
    let (folder, sources) = written(page, precision, IN_C, "cortex-m7");
    fs::write(folder.join("board.c"), include_str!("board.c")).expect("a file");
    fs::write(folder.join("board.ld"), include_str!("board.ld")).expect("a file");
    let mut compiler = Command::new(tool("arm-none-eabi-gcc"));
    compiler.current_dir(&folder).args(FLAGS).args(CORTEX_M7).args(BARE).args(&sources);
    made(page, compiler.args(["-lm", "-o", "driver"]));
    let mut runner: Vec<OsString> = vec![tool("qemu-system-arm").into()];
    let board = ["-machine", "mps2-an500", "-cpu", "cortex-m7", "-display", "none", "-monitor", "none"];
    runner.extend(board.map(Into::into));
    runner.extend(["-serial", "none", "-kernel"].map(Into::into));
    runner.push(folder.join("driver").into());
    runner.push("-semihosting-config".into());
    Program { runner, before_argument: "enable=on,target=native,arg=driver,arg=" }
}

fn in_webassembly(page: &str, precision: Precision) -> Program {
    let script = es_module(page, precision, IN_C.0);
    let driver = script.with_file_name("driver.mjs");
    fs::write(&driver, include_str!("driver.mjs")).expect("a file");
    Program { runner: vec![tool("node").into(), driver.into(), script.into()], before_argument: "" }
}

/// The ES module of a mechanism, beside its module, in a folder for a program.
pub(crate) fn es_module(page: &str, precision: Precision, program: &str) -> PathBuf {
    let (model, module) = model_and_module(page, None);
    let exported = wasm(page, &model, &module.scheduled, precision);
    let folder = folder(&model.name, program, precision, "wasm");
    let script = (format!("{}.mjs", model.name), exported.script);
    for (file, text) in exported.files.iter().chain([&script]) {
        fs::write(folder.join(file), text).expect("a file");
    }
    let mut compiler = Command::new(tool("clang"));
    compiler.current_dir(&folder).args(OPTIONS).args(&FLAGS[3..]).arg("-isystem.").args(&exported.sources);
    compiler.args(exported.exports.iter().map(|function| format!("-Wl,--export={function}")));
    made(page, compiler.args(["-o", &format!("{}.wasm", model.name)]));
    folder.join(script.0)
}
