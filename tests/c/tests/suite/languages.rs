//! docs/julia-and-matlab.md: what it calls is what is exported, and its programs print what it shows.

use crate::docs::block;
use crate::program::{compiled, folder, program, written};
use gyro_export::Precision;
use std::fs;
use std::path::Path;
use std::process::Command;

const PAGE: &str = include_str!("../../../../docs/julia-and-matlab.md");
const PENDULUM: &str = "examples/pendulum.toml";

/// The header's text without comments and directives, white space as single blanks.
fn header() -> String {
    let (folder, _) = written(PENDULUM, Precision::F64, ("unused", ""), "header");
    let text = fs::read_to_string(folder.join("pendulum.h")).expect("a header");
    let mut code = String::new();
    for (n, part) in text.split("/*").enumerate() {
        code += if n == 0 { part } else { part.split_once("*/").expect("a comment ends").1 };
    }
    let lines: Vec<&str> = code.lines().filter(|line| !line.starts_with('#')).collect();
    lines.join(" ").split_whitespace().collect::<Vec<_>>().join(" ")
}

/// What Julia calls a type of C.
fn in_julia(c: &str) -> &'static str {
    match c.trim().trim_start_matches("const ") {
        "void" => "Cvoid",
        "size_t" => "Csize_t",
        "int" | "pendulum_method" | "pendulum_status" => "Cint",
        "double" | "pendulum_real" => "Cdouble",
        "uint64_t" => "UInt64",
        "uint32_t" => "UInt32",
        "pendulum *" | "pendulum_solver *" => "Ptr{Cvoid}",
        "pendulum_real *" => "Ptr{Cdouble}",
        "char *" => "Cstring",
        "pendulum_control" => "Control",
        "pendulum_control *" => "Ref{Control}",
        other => panic!("the page calls nothing that has a `{other}`"),
    }
}

/// `const double *x` without its name; `double x[2]` is a `double *`.
fn type_of(declaration: &str) -> String {
    let (declaration, array) = declaration.split_once('[').map_or((declaration, ""), |(of, _)| (of, "*"));
    let name =
        declaration.rfind(|c: char| !c.is_alphanumeric() && c != '_').expect("a type goes before a name");
    format!("{}{array}", &declaration[..=name])
}

/// A function's types in Julia: of its arguments, then of its result.
fn declared(header: &str, name: &str) -> Vec<&'static str> {
    let of_it = |part: &&str| part.split('(').next().is_some_and(|head| type_and_name(head).1 == name);
    let declaration =
        header.split(';').find(of_it).unwrap_or_else(|| panic!("the header declares no `{name}`"));
    let (head, arguments) = declaration.split_once('(').expect("it is a function");
    let arguments = arguments.trim_end().trim_end_matches(')');
    let arguments = arguments.split(',').filter(|argument| argument.trim() != "void");
    arguments.map(|argument| in_julia(&type_of(argument))).chain([in_julia(type_and_name(head).0)]).collect()
}

fn type_and_name(head: &str) -> (&str, &str) {
    let head = head.trim();
    let name = head.rfind([' ', '*']).map_or(0, |at| at + 1);
    (head[..name].trim_start_matches("} "), &head[name..])
}

/// The calls of the page: the function, and the types that it says of its arguments and of its result.
fn calls() -> Vec<(String, Vec<String>)> {
    let calls = PAGE.split("@ccall library.").skip(1).map(|rest| {
        let (name, rest) = rest.split_once('(').expect("arguments");
        let mut depth = 1;
        let is_end = |c: char| {
            depth += i32::from(c == '(') - i32::from(c == ')');
            depth == 0
        };
        let (arguments, result) = rest.split_at(rest.find(is_end).expect("arguments end"));
        let result = result.strip_prefix(")::").expect("the type of the result");
        let end = result.find(|c: char| !c.is_alphanumeric() && !"_{}".contains(c)).unwrap_or(result.len());
        let typed = arguments.split(',').filter_map(|argument| argument.rsplit_once("::"));
        let types = typed.map(|(_, of)| of.trim()).chain([&result[..end]]).map(str::to_owned).collect();
        (name.to_owned(), types)
    });
    calls.collect()
}

#[test]
fn calls_from_julia_have_the_types_of_the_header() {
    let header = header();
    let calls = calls();
    assert!(calls.len() > 10, "{} calls", calls.len());
    for (name, types) in calls {
        assert_eq!(types, declared(&header, &name), "{name}");
    }
}

#[test]
fn the_control_in_julia_has_the_fields_of_the_header() {
    let header = header();
    let (before, _) = header.split_once("} pendulum_control;").expect("the header has it");
    let (_, fields) = before.rsplit_once("typedef struct {").expect("it is a structure");
    let expected = fields.split(';').filter(|field| !field.trim().is_empty()).flat_map(|field| {
        let (of, names) = field.trim().split_once(' ').expect("a type and names");
        names.split(',').map(move |name| format!("{}::{}", name.trim(), in_julia(of)))
    });
    let (_, control) = block(PAGE, "julia").split_once("struct Control\n").expect("the page has it");
    let fields = control.split("end\n").next().expect("it ends").lines().map(str::trim);
    assert_eq!(fields.collect::<Vec<_>>(), expected.collect::<Vec<_>>());
}

#[test]
fn constants_are_those_of_the_header() {
    let of_line = |line: &'static str| {
        let (value, name) = line.strip_prefix("const ")?.split_once(" = ")?.1.split_once('#')?;
        Some((value.trim(), name.trim()))
    };
    let (values, names): (Vec<&str>, Vec<&str>) = block(PAGE, "julia").lines().filter_map(of_line).unzip();
    assert!(names.len() > 4, "{names:?}");
    let lines: String = names.iter().map(|name| format!("    printf(\"%d\\n\", (int){name});\n")).collect();
    let text = format!(
        "#include \"pendulum.h\"\n#include <stdio.h>\nint main(void)\n{{\n{lines}    return 0;\n}}\n"
    );
    let Some(program) = program(PENDULUM, Precision::F64, ("constants", &text), &[]) else { return };
    let output = Command::new(program).output().expect("the program starts");
    assert_eq!(String::from_utf8_lossy(&output.stdout).lines().collect::<Vec<_>>(), values);
}

/// What a language prints that may not be installed; nothing is compared then.
fn run(folder: &Path, command: &mut Command) {
    let name = command.get_program().to_string_lossy().into_owned();
    match command.current_dir(folder).output() {
        Ok(output) => {
            let words = String::from_utf8_lossy(&output.stderr);
            assert_eq!(String::from_utf8_lossy(&output.stdout), block(PAGE, "text"), "{name}: {words}");
        }
        Err(error) => eprintln!("skipped: {name} cannot be started: {error}"),
    }
}

#[test]
fn the_program_in_julia_prints_what_the_page_shows() {
    let (folder, [source, _]) = written(PENDULUM, Precision::F64, ("unused", ""), "julia");
    let library = ["-O2", "-shared", "-fPIC"];
    if compiled(&folder, (PENDULUM, "libpendulum.so"), &[&source], &library).is_some() {
        fs::write(folder.join("page.jl"), block(PAGE, "julia")).expect("a file");
        run(&folder, Command::new("julia").args(["--startup-file=no", "page.jl"]));
    }
}

/// In a stand-in for MATLAB.
#[test]
fn the_mex_file_prints_what_the_page_shows() {
    let stand_in = ("stand_in", include_str!("mex/stand_in.c"));
    let (folder, [source, main]) = written(PENDULUM, Precision::F64, stand_in, "mex");
    fs::write(folder.join("mex.h"), include_str!("mex/mex.h")).expect("a file");
    fs::write(folder.join("pendulum_run.c"), block(PAGE, "c")).expect("a file");
    let sources = [source.as_str(), main.as_str(), "pendulum_run.c"];
    let sanitized = ["-I.", "-fsanitize=address,undefined"];
    let Some(program) = compiled(&folder, (PENDULUM, "mex"), &sources, &sanitized) else { return };
    run(&folder, &mut Command::new(program));
}

#[test]
fn the_mex_file_works_in_octave() {
    let (sources, _) = written(PENDULUM, Precision::F64, ("unused", ""), "octave");
    let folder = folder("pendulum", "page", Precision::F64, "octave");
    let place = folder.join("out/pendulum");
    fs::create_dir_all(&place).expect("a folder");
    for file in ["pendulum.h", "pendulum.c"] {
        fs::copy(sources.join(file), place.join(file)).expect("a copy");
    }
    fs::write(folder.join("pendulum_run.c"), block(PAGE, "c")).expect("a file");
    fs::write(folder.join("page.m"), block(PAGE, "matlab")).expect("a file");
    run(&folder, Command::new("octave").args(["--no-gui", "--quiet", "--norc", "page.m"]));
}
