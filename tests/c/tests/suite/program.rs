//! Exported mechanisms as programs.

use gyro_export::Precision;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// Of gcc and clang alike.
const FLAGS: [&str; 8] =
    ["-std=c99", "-O1", "-ffp-contract=off", "-Wall", "-Wextra", "-pedantic", "-Wshadow", "-Werror"];

/// A mechanism as a program in C; none without a C compiler.
pub(crate) fn program(
    page: &str,
    precision: Precision,
    (main, text_of_main): (&str, &str),
    more: &[&str],
) -> Option<PathBuf> {
    let path = Path::new("../..").join(page);
    let text = fs::read_to_string(&path).expect("a model file");
    let mut load = |table: &str| fs::read_to_string(path.with_file_name(table)).map_err(|e| e.to_string());
    let model = gyro_model::read_with(page, &text, &mut load).expect("no mistakes");
    let functions = match &model.functions {
        Some(names) => gyro_codegen::Functions::named(names.iter().map(String::as_str)).expect("known"),
        None => gyro_codegen::Functions::of_solvers(),
    };
    let module = gyro_codegen::generate_functions(page, &model, &functions).expect("a module");
    let exported = gyro_export::c(&model, &module.code, precision).expect("C");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("{}_{main}_{precision:?}", model.name));
    fs::create_dir_all(&folder).expect("a folder");
    let own = |text: &str| {
        let text = text.replace("const gyro *", "const \u{1} *").replace("gyro m;", "\u{1} m;");
        let upper = format!("{}_", model.name.to_uppercase());
        let text = text.replace("gyro.h", "\u{1}.h").replace("GYRO_", &upper);
        text.replace("gyro_", &format!("{}_", model.name)).replace('\u{1}', &model.name)
    };
    let files = [
        (format!("{}.h", model.name), exported.header),
        (format!("{}.c", model.name), exported.source),
        (format!("{main}.c"), own(text_of_main)),
    ];
    for (file, text) in &files {
        fs::write(folder.join(file), text).expect("a file");
    }
    let compiler = env::var_os("CC").unwrap_or_else(|| "cc".into());
    let mut command = Command::new(compiler);
    command.current_dir(&folder).args(FLAGS).args(more).args([&files[1].0, &files[2].0, "-o", main, "-lm"]);
    match command.output() {
        Ok(output) => {
            let words = String::from_utf8_lossy(&output.stderr);
            assert!(output.status.success(), "{page}: the C compiler says\n{words}");
            Some(folder.join(main))
        }
        Err(error) => {
            eprintln!("skipped: there is no C compiler: {error}");
            None
        }
    }
}
