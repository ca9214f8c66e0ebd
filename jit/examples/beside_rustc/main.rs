//! Mechanisms compiled in the process beside the same ones compiled by rustc, many to one program: `beside_rustc
//! [--time] [FILE...] [FIRST_SEED COUNT]`. All functions and short runs must have the same bits, and what Cranelift is
//! given must be what the module says; with `--time` it says what a call takes. The model files of seeds are random.
//! `--on COUNT` goes on where the last such call ended: `target/beside-rustc.next` has the seed.
#![allow(clippy::print_stdout, reason = "it is what it is for")]

use gyro_codegen::{Functions, Module};
use serde_json::Value;
use std::error::Error;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;
use std::thread;
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
    let compiler = Compiler::found(is_timed)?;
    // What is timed is timed alone.
    let n_workers = if is_timed { 1 } else { thread::available_parallelism()?.get() };
    let programs: Mutex<_> = Mutex::new(files.chunks(FILES).enumerate());
    let next = || programs.lock().map_err(|error| error.to_string()).map(|mut programs| programs.next());
    let work = || -> Result<(), String> {
        while let Some((number, files)) = next()? {
            compare(&compiler, number, files).map_err(|error| error.to_string())?;
        }
        Ok(())
    };
    thread::scope(|scope| {
        let workers: Vec<_> = (0..n_workers).map(|_| scope.spawn(work)).collect();
        workers.into_iter().try_for_each(|worker| worker.join().map_err(|_| "a worker panicked")?)
    })?;
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
        compare(&compiler, 0, &seeds.map(random).collect::<Vec<_>>())?;
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
fn compare(compiler: &Compiler, number: usize, pages: &[Page]) -> Result<(), Box<dyn Error>> {
    let root = root()?;
    let folder = root.join(format!("target/beside-rustc-{number}"));
    let began = Instant::now();
    let mut main = format!(
        "#[path = {:?}]\nmod pair;\n#[path = {:?}]\nmod program;\n",
        root.join("jit/tests/suite/pair.rs"),
        root.join("jit/examples/beside_rustc/program.rs")
    );
    let mut calls = String::new();
    fs::create_dir_all(&folder)?;
    for (n, page) in pages.iter().enumerate() {
        let module = generated(page)?;
        let with_joints = if module.implements("JointSpace") { "_with_joints" } else { "" };
        writeln!(main, "#[allow(warnings)]\nmod m{n};")?;
        writeln!(
            calls,
            "    program.check{with_joints}({:?}, {:?}, {:?}, m{n}::{}::<f64>::default());",
            page.name, page.text, page.folder, module.type_name
        )?;
        fs::write(folder.join(format!("m{n}.rs")), &module.code)?;
    }
    let derived = began.elapsed().as_secs_f64();
    write!(
        main,
        "fn main() {{\n    let mut program = program::Program::new({});\n{calls}    program.tell();\n}}\n",
        compiler.is_timed
    )?;
    let (source, program) = (folder.join("main.rs"), folder.join("compared"));
    fs::write(&source, main)?;
    let is_built = compiler.start().arg(source).arg("-o").arg(&program).status()?.success();
    let compiled = began.elapsed().as_secs_f64();
    if !is_built || !Command::new(program).status()?.success() {
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

/// rustc with the libraries of this workspace, as they were built for this program. What is timed is optimised as a
/// user's release build is.
struct Compiler {
    is_timed: bool,
    libraries: Vec<[String; 2]>,
}

impl Compiler {
    fn found(is_timed: bool) -> Result<Self, Box<dyn Error>> {
        const LIBRARIES: [&str; 8] = [
            "gyro_codegen",
            "gyro_jit",
            "gyro_model",
            "gyro_pages",
            "gyro_sim",
            "gyro_verifier",
            "rand",
            "chacha20",
        ];
        let mut cargo = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        cargo.current_dir(root()?).args(["build", "--quiet", "--offline", "--message-format", "json"]);
        // As `.ci/beside-rustc` has built this program: nothing is compiled again.
        cargo.args(["--package", "gyro-cli", "--package", "gyro-jit", "--example", "beside_rustc"]);
        let told = cargo.args(is_timed.then_some("--release")).stderr(Stdio::inherit()).output()?;
        let mut libraries = Vec::new();
        for line in String::from_utf8(told.stdout)?.lines() {
            let artifact: Value = serde_json::from_str(line)?;
            let name = artifact["target"]["name"].as_str().filter(|name| LIBRARIES.contains(name));
            let file = artifact["filenames"][0].as_str().filter(|file| file.ends_with(".rlib"));
            libraries.extend(name.zip(file).map(|(name, file)| [name, file].map(str::to_owned)));
        }
        match libraries.len() == LIBRARIES.len() {
            true => Ok(Self { is_timed, libraries }),
            false => Err("some libraries were not built, or twice".into()),
        }
    }

    fn start(&self) -> Command {
        let mut rustc = Command::new(std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into()));
        rustc.args(["--edition", "2024", "-C", if self.is_timed { "opt-level=3" } else { "opt-level=1" }]);
        for [name, file] in &self.libraries {
            rustc.arg("--extern").arg(format!("{name}={file}"));
            rustc.arg("-L").arg(Path::new(file).parent().unwrap_or(Path::new("")));
        }
        rustc
    }
}
