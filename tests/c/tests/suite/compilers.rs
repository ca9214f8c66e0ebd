//! What compilers make of exported C: options that they are given, warnings that users ask for, names that mean
//! something else to them.

use crate::program::{FLAGS, of_text, own};
use gyro_export::{Exported, Precision, c_name};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// A pendulum with everything that becomes a name in C, by names that mean something there.
const PAGE: &str = r#"
format = 1
name = "swing"
gravity = [0, -9.81, 0]
parameters = { nan = 0.5 }
inputs = { int = 0 }
body = [
    { name = "wall", fixed = true },
    { name = "double", mass = 1, inertia = [0.1, 0.1, 0.1] },
]
joint = [
    { name = "main", kind = "revolute", axis = [0, 0, 1], zero = [0, -1, 0], first = { body = "wall" }, second = { body = "double", point = [0, "nan", 0] }, angle = 1 },
]
force = [
    { name = "register", kind = "motor", joint = "main", value = "int" },
    { name = "friction", kind = "coulomb", joint = "main", level = 0.1, rate = 0.1 },
]
state = [{ name = "class", rate = "cos(class)" }]
output = [{ name = "errno", kind = "energy" }]
"#;

fn exported(precision: Precision) -> Exported {
    let (model, module) = of_text(("page.toml", PAGE), None);
    gyro_export::c("page.toml", &model, &module.scheduled, precision)
}

/// Its header and its source in a folder.
fn written(name: &str, exported: &Exported, what: &str) -> PathBuf {
    let folder = PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("{name}_{what}"));
    fs::create_dir_all(&folder).expect("a folder");
    let name = c_name(name);
    for (ending, text) in [("h", &exported.header), ("c", &exported.source)] {
        fs::write(folder.join(format!("{name}.{ending}")), text).expect("a file");
    }
    folder
}

/// What a compiler says first of a source, if it refuses it; nothing without a compiler.
fn refused((variable, otherwise): (&str, &str), folder: &Path, options: &[&str]) -> Option<String> {
    let compiler = env::var_os(variable).unwrap_or_else(|| otherwise.into());
    let output = Command::new(compiler).current_dir(folder).arg("-fsyntax-only").args(options).output();
    let Ok(output) = output else {
        eprintln!("skipped: {otherwise} cannot be started");
        return None;
    };
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    let is_error = |line: &&str| line.contains("error");
    (!output.status.success()).then(|| words.lines().find(is_error).unwrap_or(&words).to_owned())
}

const C: (&str, &str) = ("CC", "cc");

/// How precisely a compiler computes, by `FLT_EVAL_METHOD`: 16 is what gcc says where it has half precision.
#[test]
fn only_excess_precision_of_double_and_float_is_refused() {
    let folder = written("swing", &exported(Precision::F64), "precision");
    for (method, is_exact) in
        [("0", true), ("16", true), ("32", true), ("1", false), ("2", false), ("-1", false)]
    {
        let defined = format!("-D__FLT_EVAL_METHOD__={method}");
        let options = ["-std=gnu99", "-Wno-builtin-macro-redefined", &defined, "swing.c"];
        match refused(C, &folder, &options) {
            Some(words) => assert!(!is_exact && words.contains("excess precision"), "{method}: {words}"),
            // clang does not let itself be told.
            None => assert!(is_exact || env::var_os("CC").is_some(), "{method}"),
        }
    }
}

#[test]
fn floats_become_doubles_nowhere_without_being_told() {
    let warnings = ["-Wconversion", "-Wfloat-conversion", "-Wdouble-promotion"];
    for precision in [Precision::F32, Precision::F64] {
        let folder = written("swing", &exported(precision), &format!("{precision:?}"));
        let words = refused(C, &folder, &[&FLAGS[..], &warnings, &["swing.c"]].concat());
        assert_eq!(words, None, "{precision:?}");
    }
}

/// Words of C, C++ and JavaScript, macros, functions of a C library, and names of the run time.
#[test]
fn every_word_may_be_a_name() {
    let main = "#include <errno.h>\n#include <math.h>\n#include <stdio.h>\n#include <stdlib.h>\n#include <string.h>\n\
        #include <time.h>\n#include \"gyro.h\"\n\nint main(void)\n{\n    gyro m;\n    gyro_init(&m);\n    \
        return errno + GYRO_N_JOINTS;\n}\n";
    let (mut model, module) = of_text(("page.toml", PAGE), None);
    for name in NAMES {
        name.clone_into(&mut model.name);
        let folder =
            written(name, &gyro_export::c("page.toml", &model, &module.scheduled, Precision::F64), "name");
        let name = c_name(name);
        let main = own(&name, main);
        fs::write(folder.join("main.c"), &main).expect("a file");
        fs::write(folder.join("main.cpp"), &main).expect("a file");
        let source = format!("{name}.c");
        for standard in ["-std=c99", "-std=gnu17"] {
            assert_eq!(refused(C, &folder, &[standard, "main.c", &source]), None, "{name}");
        }
        assert_eq!(refused(("CXX", "c++"), &folder, &["-std=c++20", "main.cpp"]), None, "{name}");
    }
}

const NAMES: [&str; 12] =
    ["int", "double", "bool", "class", "new", "function", "nan", "main", "errno", "link", "index", "s"];
