//! `cargo xtask export`: a mechanism with its solver for other languages.
//!
//! Everything is made in memory, and a library in a folder of its own, before anything is written.

mod fmu;
pub(crate) mod wasm;

use crate::args::{CArgs, ExportArgs, Precision, Target};
use crate::failure::Failure;
use crate::files;
use crate::generate::{modules, of_solvers};
use crate::left_out;
use crate::paths;
use crate::progress::Spinner;
use crate::scene;
use crate::write::{self, Known};
use gyro_codegen::Module;
use gyro_export::Exported;
use gyro_model::Model;
use std::ffi::{OsStr, OsString};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, process};

/// Writes what is asked for.
pub(crate) fn export(args: &ExportArgs) -> Result<(), Failure> {
    match &args.target {
        Target::C(args) => c(args),
        Target::Wasm(args) => wasm::wasm(args),
        Target::Fmu(args) => fmu::fmu(args),
    }
}

/// How a library begins.
const LIBRARY_MARK: &str = "!<arch>\n";

/// Header, source and, if it is asked for, the library.
fn c(args: &CArgs) -> Result<(), Failure> {
    let asked = |model: &mut Model| asked(model, args.functions.as_ref(), args.count_work);
    let (model, module) = made(&args.model, &asked, args.strict)?;
    left_out::tell(&model, "the exported code");
    paths::refuse(&model, "exported code")?;
    let (page, precision) = (files::shown(&args.model), numbers(args.precision));
    let exported = gyro_export::c(&page, &model, &module.scheduled, precision);
    prove(&args.model, (&model, &module), &exported)?;
    let (place, name) = (|name: String| args.out.join(name), gyro_export::c_name(&module.name));
    let header = place(format!("{name}.h"));
    let source = place(format!("{name}.c"));
    let library = place(format!("lib{name}.a"));
    for path in [&header, &source] {
        write::check(path, Known::Mark(gyro_export::MARK))?;
    }
    let compiled = if args.library {
        write::check(&library, Known::Mark(LIBRARY_MARK))?;
        Some(compiled(&name, &exported)?)
    } else {
        None
    };
    for (path, text) in [(&header, &exported.header), (&source, &exported.source)] {
        let is_new = write::write(path, text, Known::Mark(gyro_export::MARK))?;
        say(&format!("{} {}", if is_new { "wrote" } else { "fresh already:" }, path.display()));
    }
    if let Some(bytes) = compiled {
        let beside = args.out.join(format!(".lib{name}.a.{}", process::id()));
        fs::write(&beside, bytes)
            .and_then(|()| fs::rename(&beside, &library))
            .map_err(|e| Failure::Run(format!("{}: {e}", library.display())))?;
        say(&format!("wrote {}", library.display()));
    }
    Ok(())
}

/// A model with what is asked for of its module, and the module, proved.
fn made(path: &Path, asked: &(dyn Fn(&mut Model) + Sync), strict: bool) -> Result<(Model, Module), Failure> {
    let mut model = scene::read(path)?;
    asked(&mut model);
    let made = modules(&[path.to_path_buf()], &|_, model| asked(model), strict).pop();
    Ok((model, made.expect("one model file gives one module")?))
}

/// What is asked for of a module by options of C and WebAssembly.
fn asked(model: &mut Model, functions: Option<&Vec<String>>, count_work: bool) {
    model.functions = functions.cloned().or(model.functions.take());
    of_solvers(model);
    model.counts_work &= count_work;
}

fn numbers(precision: Precision) -> gyro_export::Precision {
    match precision {
        Precision::F32 => gyro_export::Precision::F32,
        Precision::F64 => gyro_export::Precision::F64,
    }
}

/// Whether the C text is what was proved of the module.
fn prove(path: &Path, (model, module): (&Model, &Module), exported: &Exported) -> Result<(), Failure> {
    let texts = (module.code.as_str(), module.constants.as_str());
    match gyro_verifier::same_in_c(model, texts, (&exported.header, &exported.source)) {
        Ok(_) => Ok(()),
        Err(e) => Err(Failure::Run(format!(
            "{}: the C text is not what was proved: {e}: please report it with the model file",
            path.display()
        ))),
    }
}

/// The bytes of the library.
fn compiled(name: &str, exported: &Exported) -> Result<Vec<u8>, Failure> {
    let spinner = Spinner::new(format!("compiling {name}"));
    let folder = Scratch::new()?;
    let [header, source] = [".h", ".c"].map(|end| folder.0.join(format!("{name}{end}")));
    let [object, library] = ["object.o", "library.a"].map(|file| folder.0.join(file));
    let failed = |path: &Path| {
        let path = path.to_path_buf();
        move |e: io::Error| Failure::Run(format!("{}: {e}", path.display()))
    };
    fs::write(&header, &exported.header).map_err(failed(&header))?;
    fs::write(&source, &exported.source).map_err(failed(&source))?;
    let cc = env::var_os("CC").unwrap_or_else(|| "cc".into());
    let flags = ["-std=c99", "-O2", "-ffp-contract=off", "-c", "-o"].map(OsStr::new);
    let instead = "leave --library away";
    run(&cc, &[&flags[..], &[object.as_os_str(), source.as_os_str()]].concat(), "CC", instead)?;
    let ar = env::var_os("AR").unwrap_or_else(|| "ar".into());
    run(&ar, &[OsStr::new("rcs"), library.as_os_str(), object.as_os_str()], "AR", instead)?;
    drop(spinner);
    fs::read(&library).map_err(failed(&library))
}

/// Runs a compiler. A variable names another one; `instead` is what else to do.
fn run(program: &OsString, arguments: &[&OsStr], variable: &str, instead: &str) -> Result<(), Failure> {
    let shown = program.to_string_lossy();
    let output = Command::new(program).args(arguments).output().map_err(|e| {
        Failure::Usage(format!(
            "a library needs `{shown}`, which cannot be started: {e}: install gcc or clang, set {variable}, or {instead}"
        ))
    })?;
    if output.status.success() {
        return Ok(());
    }
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    Err(Failure::Run(format!("`{shown}` has failed: nothing was written\n{words}")))
}

/// A folder that is removed in the end.
struct Scratch(PathBuf);

impl Scratch {
    fn new() -> Result<Self, Failure> {
        let path = env::temp_dir().join(format!("gyro-export-{}", process::id()));
        fs::create_dir_all(&path).map_err(|e| Failure::Run(format!("{}: {e}", path.display())))?;
        Ok(Self(path))
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn say(words: &str) {
    // What was said is only about files that are there already.
    let _ = writeln!(io::stdout(), "{words}");
}
