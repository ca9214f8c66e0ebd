//! For build scripts: generates the modules of model files into the folder of the build, and declares them in one file:
//!
//! ```ignore
//! include!(concat!(env!("OUT_DIR"), "/modules.rs"));
//! ```
//!
//! The build script runs again when a model file, or a table that one names, is changed; what comes out as it was is
//! not written again, so that nothing is compiled again for it.
#![deny(missing_docs)]
#![allow(clippy::print_stdout, reason = "it is how a build script tells cargo what it depends on")]

use gyro_codegen::Functions;
use std::error::Error;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::{env, fs, io, thread};

/// The model files of a folder, in the order of their names. The build script runs again when one is added.
///
/// # Errors
/// If the folder cannot be read.
pub fn pages(folder: &Path) -> io::Result<Vec<PathBuf>> {
    println!("cargo::rerun-if-changed={}", folder.display());
    let entries = fs::read_dir(folder)?.map(|entry| Ok(entry?.path()));
    let mut pages = entries.collect::<io::Result<Vec<PathBuf>>>()?;
    pages.retain(|path| path.extension().is_some_and(|extension| extension == "toml"));
    pages.sort();
    Ok(pages)
}

/// Generates the modules of model files with all functions, on all cores, and `modules.rs`, which declares them.
///
/// # Errors
/// What is wrong with a model file or another file, and which one it is.
pub fn generate(pages: &[PathBuf]) -> Result<(), Box<dyn Error>> {
    let out = PathBuf::from(env::var_os("OUT_DIR").ok_or("OUT_DIR is not set: this is for build scripts")?);
    let next = AtomicUsize::new(0);
    let some_of_them = || {
        let pages = std::iter::from_fn(|| pages.get(next.fetch_add(1, Ordering::Relaxed)));
        pages.map(|page| generate_one(page, &out)).collect::<Result<Vec<String>, String>>()
    };
    let made: Result<Vec<Vec<String>>, String> = thread::scope(|scope| {
        let n_threads = thread::available_parallelism().map_or(1, usize::from);
        let threads: Vec<_> = (0..n_threads).map(|_| scope.spawn(some_of_them)).collect();
        threads.into_iter().map(|thread| thread.join().map_err(|_| "a thread panicked".to_owned())?).collect()
    });
    let mut modules = made?.concat();
    modules.sort();
    renew(&out.join("modules.rs"), &modules.concat()).map_err(Into::into)
}

/// Generates the module of a model file; gives its declaration.
fn generate_one(page: &Path, out: &Path) -> Result<String, String> {
    println!("cargo::rerun-if-changed={}", page.display());
    let read = |path: &Path| fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()));
    let mut load = |table: &str| {
        let table = page.with_file_name(table);
        println!("cargo::rerun-if-changed={}", table.display());
        read(&table)
    };
    let name = page.to_string_lossy();
    let model = gyro_model::read_with(&name, &read(page)?, &mut load);
    let model = model.map_err(|e| format!("{}: {e}", page.display()))?;
    let failed = |e: &dyn std::fmt::Display| format!("{}: {e}", page.display());
    let functions = match &model.functions {
        Some(names) => Functions::named(names.iter().map(String::as_str)).map_err(|e| failed(&e))?,
        None => Functions::of_solvers(),
    };
    let module = gyro_codegen::generate_functions(&name, &model, &functions).map_err(|e| failed(&e))?;
    let path = out.join(&module.name).with_extension("rs");
    renew(&path, &module.code)?;
    Ok(format!("#[path = {path:?}]\npub mod {};\n", module.name))
}

/// Writes a file unless it has this text already.
fn renew(path: &Path, text: &str) -> Result<(), String> {
    if fs::read_to_string(path).is_ok_and(|found| found == text) {
        return Ok(());
    }
    fs::write(path, text).map_err(|e| format!("{}: {e}", path.display()))
}
