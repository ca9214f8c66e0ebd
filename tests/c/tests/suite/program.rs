//! Exported mechanisms as programs.

use gyro_codegen::{Functions, Module};
use gyro_export::Precision;
use gyro_model::Model;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// Of gcc and clang alike.
pub(crate) const FLAGS: [&str; 8] =
    ["-std=c99", "-O1", "-ffp-contract=off", "-Wall", "-Wextra", "-pedantic", "-Wshadow", "-Werror"];

/// A model file and its module, with the functions that are asked for here, or there, or that solvers call.
pub(crate) fn model_and_module(page: &str, functions: Option<&[&str]>) -> (Model, Module) {
    let text = fs::read_to_string(Path::new("../..").join(page)).expect("a model file");
    of_text((page, &text), functions)
}

/// The same of a text that stands where a model file would.
pub(crate) fn of_text((page, text): (&str, &str), functions: Option<&[&str]>) -> (Model, Module) {
    let path = Path::new("../..").join(page);
    let mut load = |table: &str| fs::read_to_string(path.with_file_name(table)).map_err(|e| e.to_string());
    let model = gyro_model::read_with(page, text, &mut load).expect("no mistakes");
    let named = |names: Vec<&str>| Functions::named(names).expect("known");
    let functions = match (functions, &model.functions) {
        (Some(names), _) => named(names.to_vec()),
        (None, Some(names)) => named(names.iter().map(String::as_str).collect()),
        (None, None) => Functions::of_solvers(),
    };
    let module = gyro_codegen::generate_functions(page, &model, &functions).expect("a module");
    (model, module)
}

/// A text that is written for a mechanism called `gyro`, for another.
pub(crate) fn own(name: &str, text: &str) -> String {
    let text = text.replace("const gyro *", "const \u{1} *").replace("gyro m;", "\u{1} m;");
    let text = text.replace("gyro.h", "\u{1}.h").replace("GYRO_", &format!("{}_", name.to_uppercase()));
    text.replace("gyro_", &format!("{name}_")).replace('\u{1}', name)
}

/// A mechanism as a program in C; none without a C compiler.
pub(crate) fn program(
    page: &str,
    precision: Precision,
    main: (&str, &str),
    more: &[&str],
) -> Option<PathBuf> {
    let (folder, sources) = written(page, precision, main, "here");
    compiled(&folder, (page, main.0), &sources.each_ref().map(String::as_str), more)
}

/// A folder for a program, of a mechanism and for a target.
pub(crate) fn folder(name: &str, main: &str, precision: Precision, target: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}_{main}_{precision:?}_{target}"));
    fs::create_dir_all(&folder).expect("a folder");
    folder
}

/// The sources of a program, in a folder.
pub(crate) fn written(
    page: &str,
    precision: Precision,
    (main, text_of_main): (&str, &str),
    target: &str,
) -> (PathBuf, [String; 2]) {
    let (model, module) = model_and_module(page, None);
    let exported = gyro_export::c(page, &model, &module.scheduled, precision);
    let folder = folder(&model.name, main, precision, target);
    let [header, source, around] =
        [format!("{}.h", model.name), format!("{}.c", model.name), format!("{main}.c")];
    let text_of_main = own(&model.name, text_of_main);
    for (file, text) in [(&header, &exported.header), (&source, &exported.source), (&around, &text_of_main)] {
        fs::write(folder.join(file), text).expect("a file");
    }
    (folder, [source, around])
}

/// The program of some sources in a folder; none without a C compiler.
pub(crate) fn compiled(
    folder: &Path,
    (page, program): (&str, &str),
    sources: &[&str],
    more: &[&str],
) -> Option<PathBuf> {
    let compiler = env::var_os("CC").unwrap_or_else(|| "cc".into());
    let mut command = Command::new(compiler);
    command.current_dir(folder).args(FLAGS).args(more).args(sources).args(["-o", program, "-lm"]);
    match command.output() {
        Ok(output) => {
            let words = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{page}: the C compiler says\n{words}");
            Some(folder.join(program))
        }
        Err(error) => {
            eprintln!("skipped: there is no C compiler: {error}");
            None
        }
    }
}
