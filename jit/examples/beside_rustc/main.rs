//! Mechanisms compiled in the process beside the same ones compiled by rustc, many to one program: `beside_rustc
//! [--time] [FILE...] [FIRST_SEED COUNT]`. All functions and short runs must have the same bits, and what Cranelift is
//! given must be what the module says; with `--time` it says what a call takes. The model files of seeds are random.
//! `--on COUNT` goes on where the last such call ended: `target/beside-rustc.next` has the seed.
#![allow(clippy::print_stdout, reason = "it is what it is for")]

use gyro_codegen::{Functions, Module};
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::Instant;

/// Random model files to a program.
const BATCH: u64 = 50;

/// Named model files to a program: they are larger.
const FILES: usize = 20;

/// A model file: its name, its text and the folder of its tables.
struct Page {
    name: String,
    text: String,
    folder: Option<PathBuf>,
}

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let is_timed = arguments.iter().any(|argument| argument == "--time");
    let files = arguments.iter().filter(|argument| argument.ends_with(".toml"));
    let files: Vec<Page> = files.map(|file| of_file(Path::new(file))).collect::<Result<_, _>>()?;
    for files in files.chunks(FILES) {
        compare(files, is_timed)?;
    }
    let numbers: Vec<u64> = arguments.iter().filter_map(|argument| argument.parse().ok()).collect();
    let record = root()?.join("target/beside-rustc.next");
    let goes_on = arguments.iter().any(|argument| argument == "--on");
    let (first, count) = match numbers[..] {
        [first, count] => (first, count),
        [count] if goes_on => (fs::read_to_string(&record).map_or(Ok(0), |next| next.trim().parse())?, count),
        _ => return Ok(()),
    };
    let began = Instant::now();
    for from in (first..first + count).step_by(usize::try_from(BATCH)?) {
        let seeds = from..(from + BATCH).min(first + count);
        let random = |seed| Page { name: format!("page {seed}"), text: gyro_pages::page(seed), folder: None };
        let next = seeds.end;
        compare(&seeds.map(random).collect::<Vec<_>>(), is_timed)?;
        println!("seeds {from} to {}", next - 1);
        if goes_on {
            fs::write(&record, next.to_string())?;
        }
    }
    println!("{count} random model files in {:.0} s", began.elapsed().as_secs_f64());
    Ok(())
}

fn root() -> Result<&'static Path, Box<dyn Error>> {
    Ok(Path::new(env!("CARGO_MANIFEST_DIR")).parent().ok_or("no workspace")?)
}

fn of_file(path: &Path) -> Result<Page, Box<dyn Error>> {
    let folder = fs::canonicalize(path)?.parent().map(Path::to_owned);
    Ok(Page { name: path.display().to_string(), text: fs::read_to_string(path)?, folder })
}

/// Writes a program with a module for each model file, compiles it and runs it.
fn compare(pages: &[Page], is_timed: bool) -> Result<(), Box<dyn Error>> {
    let root = root()?;
    let folder = std::env::temp_dir().join("gyro-beside-rustc");
    let began = Instant::now();
    let mut main = format!(
        "#[path = {:?}]\nmod pair;\n#[path = {:?}]\nmod program;\n",
        root.join("jit/tests/suite/pair.rs"),
        root.join("jit/examples/beside_rustc/program.rs")
    );
    let mut calls = String::new();
    fs::create_dir_all(folder.join("src"))?;
    for (n, page) in pages.iter().enumerate() {
        let module = generated(page)?;
        let with_joints = if module.implements("JointSpace") { "_with_joints" } else { "" };
        writeln!(main, "#[allow(warnings)]\nmod m{n};")?;
        writeln!(
            calls,
            "    program.check{with_joints}({:?}, {:?}, {:?}, m{n}::{}::<f64>::default());",
            page.name, page.text, page.folder, module.type_name
        )?;
        fs::write(folder.join(format!("src/m{n}.rs")), &module.code)?;
    }
    let derived = began.elapsed().as_secs_f64();
    write!(
        main,
        "fn main() {{\n    let mut program = program::Program::new({is_timed});\n{calls}    program.tell();\n}}\n"
    )?;
    fs::write(folder.join("src/main.rs"), main)?;
    fs::write(folder.join("Cargo.toml"), manifest(root))?;
    fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock"))?;
    let cargo = |command: &str| {
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.args([command, "--quiet", "--offline"]).args(is_timed.then_some("--release"));
        cargo.arg("--manifest-path");
        cargo.arg(folder.join("Cargo.toml")).env("CARGO_TARGET_DIR", root.join("target"));
        cargo.status()
    };
    let is_built = cargo("build")?.success();
    let compiled = began.elapsed().as_secs_f64();
    if !is_built || !cargo("run")?.success() {
        return Err("they differ, or there is no such program: see above".into());
    }
    let ran = began.elapsed().as_secs_f64();
    println!(
        "generated in {derived:.0} s, compiled by rustc in {:.0} s, compared in {:.0} s",
        compiled - derived,
        ran - compiled
    );
    Ok(())
}

fn generated(page: &Page) -> Result<Module, Box<dyn Error>> {
    let mut load = |table: &str| match &page.folder {
        Some(folder) => fs::read_to_string(folder.join(table)).map_err(|error| error.to_string()),
        None => gyro_pages::load(table),
    };
    let model =
        gyro_model::read_with(&page.name, &page.text, &mut load).map_err(|error| error.to_string())?;
    Ok(gyro_codegen::generate_functions("page.toml", &model, &Functions::of_solvers())?)
}

/// What is timed is optimised as a user's release build is; all else is compiled as in the workspace, with which it
/// shares the crates of others.
fn manifest(root: &Path) -> String {
    let library = |name: &str, folder: &str| format!("{name} = {{ path = {:?} }}\n", root.join(folder));
    let libraries = [
        library("gyro-codegen", "codegen"),
        library("gyro-jit", "jit"),
        library("gyro-model", "model"),
        library("gyro-pages", "tests/pages"),
        library("gyro-verifier", "verifier"),
    ];
    format!(
        "[package]\nname = \"beside-rustc\"\nversion = \"0.0.0\"\nedition = \"2024\"\n[workspace]\n[dependencies]\n{}\
         gyro-sim = {{ path = {:?}, default-features = false }}\nrand = \"0.10\"\n\
         chacha20 = {{ version = \"0.10\", default-features = false, features = [\"rng\"] }}\n\
         [profile.dev]\nopt-level = 1\ndebug = false\nincremental = false\nlto = \"off\"\ncodegen-units = 16\n",
        libraries.concat(),
        root.join("gyro-sim"),
    )
}
