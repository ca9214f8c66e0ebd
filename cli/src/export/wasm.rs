//! A module of WebAssembly, with an ES module around it and its declarations.

use super::{Scratch, asked, made, numbers, prove, say};
use crate::args::WasmArgs;
use crate::failure::Failure;
use crate::files;
use crate::left_out;
use crate::paths;
use crate::progress::Spinner;
use crate::write::{self, Known};
use gyro_export::wasm::{MARK, MODULE_MARK, OPTIONS, Wasm, wasm as written};
use gyro_model::Model;
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

/// Writes all three.
pub(super) fn wasm(args: &WasmArgs) -> Result<(), Failure> {
    let asked = |model: &mut Model| asked(model, args.functions.as_ref(), args.count_work);
    let (model, module) = made(&args.model, &asked, args.strict)?;
    left_out::tell(&model, "the exported code");
    paths::refuse(&model, "exported code")?;
    let page = files::shown(&args.model);
    let exported = written(&page, &model, &module.scheduled, numbers(args.precision));
    prove(&args.model, (&model, &module), &exported.c)?;
    let place = |ending: &str| args.out.join(format!("{}.{ending}", module.name));
    let texts = [(place("mjs"), &exported.script), (place("d.mts"), &exported.declarations)];
    let binary = place("wasm");
    write::check(&binary, Known::Mark(MODULE_MARK))?;
    for (path, _) in &texts {
        write::check(path, Known::Mark(MARK))?;
    }
    let bytes = compiled(&module.name, &exported)?;
    tell(&binary, write::write(&binary, bytes, Known::Mark(MODULE_MARK))?);
    for (path, text) in &texts {
        tell(path, write::write(path, text, Known::Mark(MARK))?);
    }
    Ok(())
}

fn tell(path: &Path, is_new: bool) {
    say(&format!("{} {}", if is_new { "wrote" } else { "fresh already:" }, path.display()));
}

/// The bytes of the module.
pub(crate) fn compiled(name: &str, exported: &Wasm) -> Result<Vec<u8>, Failure> {
    let _spinner = Spinner::new(format!("compiling {name}"));
    let folder = Scratch::new()?;
    let failed = |path: &Path, e: &io::Error| Failure::Run(format!("{}: {e}", path.display()));
    for (file, text) in &exported.files {
        let path = folder.0.join(file);
        fs::write(&path, text).map_err(|e| failed(&path, &e))?;
    }
    let made = folder.0.join("module.wasm");
    let clang = clang();
    let output = Command::new(&clang)
        .current_dir(&folder.0)
        .args(OPTIONS)
        .arg("-isystem.")
        .args(exported.exports.iter().map(|function| format!("-Wl,--export={function}")))
        .args(&exported.sources)
        .arg("-o")
        .arg(&made)
        .output()
        .map_err(|e| missing(&clang, &format!("cannot be started: {e}")))?;
    if output.status.success() {
        return fs::read(&made).map_err(|e| failed(&made, &e));
    }
    let words = String::from_utf8_lossy(&output.stderr);
    // Apple's clang, gcc under that name, or a linker that is a package of its own.
    let lacks = ["wasm-ld", "wasm32", "No available targets", "unrecognized command"];
    if lacks.iter().any(|word| words.contains(word)) && !words.contains("error: undefined symbol") {
        return Err(missing(&clang, &format!("does not make WebAssembly:\n{}", words.trim_end())));
    }
    Err(Failure::Run(format!("`{}` has failed: nothing was written\n{words}", clang.display())))
}

/// What the variable names; or what the machine has; or what was unpacked into the clone.
fn clang() -> OsString {
    if let Some(named) = env::var_os("CLANG") {
        return named;
    }
    let name = format!("clang{}", env::consts::EXE_SUFFIX);
    let folders: Vec<PathBuf> = env::var_os("PATH").iter().flat_map(env::split_paths).collect();
    let is_on_path = folders.iter().any(|folder| folder.join(&name).is_file());
    let unpacked = files::workspace().map(|root| root.join("target/embedded/tools/bin").join(&name));
    match unpacked.filter(|unpacked| !is_on_path && unpacked.is_file()) {
        Some(unpacked) => unpacked.into(),
        None => name.into(),
    }
}

fn missing(clang: &OsString, what: &str) -> Failure {
    let script = files::workspace().map_or(String::new(), |root| {
        let script = root.join("embedded").join("setup.sh");
        format!("; or, without root on Debian, run\n    {}", script.display())
    });
    Failure::Usage(format!(
        "WebAssembly is compiled by clang and linked by its wasm-ld, and `{}` {what}\n\
         Install both (Debian and Ubuntu: apt install clang lld; macOS: brew install llvm lld){script}\n\
         The variable CLANG names another clang.",
        clang.display()
    ))
}
