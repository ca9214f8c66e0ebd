//! Model files and their modules.
#![allow(dead_code, reason = "each test program uses a part of it")]

use gyro_model::Model;
use std::path::{Path, PathBuf};

/// A model file with the module that the generator writes for it.
pub struct Page {
    pub name: String,
    pub model: Model,
    pub code: String,
    pub constants: String,
}

/// All model files of the shipped models, and those that the tests of the workspace bring along.
pub fn pages() -> Vec<PathBuf> {
    let folders = ["../models", "../tests/models"];
    let folders = folders.map(|folder| Path::new(env!("CARGO_MANIFEST_DIR")).join(folder));
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(folder).expect("a folder of models"));
    let paths = files.map(|entry| entry.expect("a file").path());
    let mut pages: Vec<_> = paths.filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    pages.sort();
    pages
}

/// The model file of a model by its file's name without extension.
pub fn page(name: &str) -> Page {
    let path = pages().into_iter().find(|path| path.file_stem().is_some_and(|stem| stem == name));
    generate(&path.unwrap_or_else(|| panic!("no model file {name}")))
}

/// Reads a model file and generates its module.
pub fn generate(path: &Path) -> Page {
    let text = std::fs::read_to_string(path).expect("a model file");
    let name = path.file_name().and_then(|name| name.to_str()).expect("a name").to_owned();
    let folder = path.parent().expect("a folder").to_owned();
    let mut load = |file: &str| std::fs::read_to_string(folder.join(file)).map_err(|error| error.to_string());
    let model = gyro_model::read_with(&name, &text, &mut load).expect("a good model file");
    generate_model(name, model)
}

/// The same for a text that is in no file and reads no tables.
pub fn generate_text(name: &str, text: &str) -> Page {
    let model = gyro_model::read(name, text).unwrap_or_else(|problems| panic!("{text}\n{problems}"));
    generate_model(name.to_owned(), model)
}

fn generate_model(name: String, model: Model) -> Page {
    let module =
        gyro_codegen::generate_functions(&name, &model, &gyro_codegen::Functions::all()).expect("a module");
    Page { name, model, code: module.code, constants: module.constants }
}
