//! Compiles a generated mechanism into a small program and runs it, or into a library to look at.
//!
//! Each module gets a package of its own, named by a hash of its text, under `target/simulate/programs` of the
//! workspace; all of them share one build folder, so that only the first has to wait for `gyro-sim`. Whether anything
//! has to be compiled is Cargo's to decide.

use crate::args::Precision;
use crate::failure::Failure;
use crate::progress::Spinner;
use crate::scene::Scene;
use crate::verify::verify_quickly;
use crate::{files, machine_code};
use gyro_codegen::Module;
use gyro_runner::protocol::{Reply, Request};
use gyro_runner::{Event, Summary};
use std::collections::hash_map::DefaultHasher;
use std::fs::{self, File};
use std::hash::{Hash, Hasher};
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Generates, compiles and runs; `tell` hears of samples and progress.
pub(crate) fn simulate(scene: &Scene, tell: impl FnMut(Event<'_>)) -> Result<Summary, Failure> {
    let module = gyro_codegen::generate_model(&scene.page_name, &scene.page)
        .map_err(|e| Failure::Usage(e.to_string()))?;
    let package = Package::program(&module, scene.precision);
    if !package.is_there() {
        verify_quickly(&scene.page, &module)?;
    }
    build(&package)?;
    let program = package.built(&format!("{}{}", package.name, std::env::consts::EXE_SUFFIX));
    let request = Request {
        settings: scene.settings,
        approach: scene.approach,
        parameters: scene.parameters(),
        start: scene.start.clone(),
    };
    converse(&program, &request, tell)
}

/// Compiles the functions of these names for `f64`, optimised; the library, in which each has its symbol.
pub(crate) fn library(module: &Module, names: &[&str]) -> Result<PathBuf, Failure> {
    let root = machine_code::library(&module.type_name, names);
    let package = Package::new(module, ("lib.rs", root), &["--", machine_code::SYMBOLS]);
    build(&package)?;
    Ok(package.built(&format!("lib{}.rlib", package.name.replace('-', "_"))))
}

/// The files of a package.
struct Package {
    name: String,
    manifest: String,
    /// Name and text of the file at its root.
    root: (&'static str, String),
    mechanism: String,
    /// What rustc is told besides.
    options: &'static [&'static str],
}

impl Package {
    fn program(module: &Module, precision: Precision) -> Self {
        Self::new(module, ("main.rs", main(module, precision)), &[])
    }

    fn new(module: &Module, root: (&'static str, String), options: &'static [&'static str]) -> Self {
        let mut hasher = DefaultHasher::new();
        (&root.1, &module.code).hash(&mut hasher);
        let name = format!("{}-{:016x}", module.name, hasher.finish());
        Self { manifest: manifest(&name), name, root, mechanism: module.code.clone(), options }
    }

    /// Where Cargo puts what it builds.
    fn built(&self, file: &str) -> PathBuf {
        target().join("release").join(file)
    }

    fn folder(&self) -> PathBuf {
        cache().join("programs").join(&self.name)
    }

    /// Whether this very module was written, and so verified, before.
    fn is_there(&self) -> bool {
        files::holds(&self.folder().join("src").join("mechanism.rs"), &self.mechanism)
    }
}

/// The program's own lines. What the module implements decides with what motions can be begun.
fn main(module: &Module, precision: Precision) -> String {
    let (type_name, precision) = (&module.type_name, precision.name());
    let has = |name: &str| module.code.contains(&format!("gyro_sim::{name} for {type_name}"));
    let kit = match (has("JointSpace"), has("JointJacobian")) {
        (true, true) => "TreeWithJacobian",
        (true, false) => "Tree",
        (false, _) => "WithDuals",
    };
    format!(
        "#[allow(warnings, clippy::all)]
mod mechanism;

use gyro_runner::motion::{{COLUMNS, {kit}}};
use gyro_sim::{{Dual, Scalar}};
use mechanism::{type_name};

fn build<T: Scalar>(parameters: &[f64]) -> {type_name}<T> {{
    let mut mechanism = {type_name}::<T>::default();
    for (index, value) in parameters.iter().enumerate() {{
        mechanism.set_parameter(index, Scalar::constant(*value));
    }}
    mechanism
}}

fn main() -> std::process::ExitCode {{
    gyro_runner::child::main(|parameters| {{
        (build::<{precision}>(parameters), {kit}(build::<Dual<{precision}, COLUMNS>>(parameters)))
    }})
}}
"
    )
}

fn manifest(name: &str) -> String {
    let path = |folder: &str| files::root().join(folder).to_string_lossy().into_owned();
    let (gyro_sim, gyro_runner) = (path("gyro-sim"), path("runner"));
    format!(
        "[package]
name = \"{name}\"
version = \"0.0.0\"
edition = \"2024\"
publish = false

[workspace]

[dependencies]
gyro-sim = {{ path = {gyro_sim:?}, default-features = false }}
gyro-runner = {{ path = {gyro_runner:?} }}

[profile.release]
debug = false
"
    )
}

fn cache() -> PathBuf {
    files::root().join("target").join("simulate")
}

fn target() -> PathBuf {
    cache().join("build")
}

/// Brings a package up to date.
fn build(package: &Package) -> Result<(), Failure> {
    let (cache, folder) = (cache(), package.folder());
    let said = |e: std::io::Error| Failure::Run(format!("{} cannot be used: {e}", cache.display()));
    fs::create_dir_all(folder.join("src")).map_err(said)?;
    let lock = File::create(cache.join("lock")).map_err(said)?;
    // Released when the file is closed at the end of this function. Two runs at once take turns at building.
    lock.lock().map_err(said)?;
    files::write(&folder.join("Cargo.toml"), &package.manifest)?;
    let (file, root) = &package.root;
    files::write(&folder.join("src").join(file), root)?;
    files::write(&folder.join("src").join("mechanism.rs"), &package.mechanism)?;
    copy_lock_file(&folder).map_err(said)?;
    let _spinner = Spinner::new(format!("compiling {}", package.name));
    compile(package, &target())
}

/// The workspace's versions hold here too. Cargo drops from its copy what the package does not need.
fn copy_lock_file(folder: &Path) -> std::io::Result<()> {
    let copy = folder.join("Cargo.lock");
    if copy.is_file() {
        return Ok(());
    }
    match fs::read_to_string(files::root().join("Cargo.lock")) {
        Ok(text) => files::write_if_changed(&copy, &text).map(|_| ()),
        Err(_) => Ok(()),
    }
}

fn compile(package: &Package, target: &Path) -> Result<(), Failure> {
    let folder = package.folder();
    let mut output = cargo(package, target, &["--offline"])?;
    // Cargo says so if something has to be downloaded first.
    if output.as_ref().is_some_and(|words| words.contains("offline")) {
        output = cargo(package, target, &[])?;
    }
    match output {
        None => Ok(()),
        Some(words) => Err(Failure::Run(format!(
            "the generated program does not compile; it is in {}\n{words}",
            folder.display()
        ))),
    }
}

/// What Cargo said if it failed.
fn cargo(package: &Package, target: &Path, options: &[&str]) -> Result<Option<String>, Failure> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .args(["rustc", "--quiet", "--release", "--target-dir"])
        .arg(target)
        .args(options)
        .args(package.options)
        .current_dir(package.folder())
        .env_remove("CARGO_BUILD_TARGET")
        .stdin(Stdio::null())
        .output()
        .map_err(|e| Failure::Run(format!("cargo cannot be started: {e}")))?;
    let words = || String::from_utf8_lossy(&output.stderr).into_owned();
    Ok((!output.status.success()).then(words))
}

/// Hands the request to the program and listens to its replies.
fn converse(program: &Path, request: &Request, mut tell: impl FnMut(Event<'_>)) -> Result<Summary, Failure> {
    let said = |e: std::io::Error| Failure::Run(format!("{}: {e}", program.display()));
    let mut child =
        Command::new(program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().map_err(said)?;
    let mut input = child.stdin.take().expect("standard input is piped");
    input.write_all(request.to_text().as_bytes()).map_err(said)?;
    drop(input);
    let output = BufReader::new(child.stdout.take().expect("standard output is piped"));
    let answer = listen(output, &mut tell);
    if answer.is_err() {
        // It may have ended by itself.
        let _ = child.kill();
    }
    let status = child.wait().map_err(said)?;
    match answer? {
        Some(summary) => Ok(summary),
        None => Err(Failure::Run(format!("{} ended without an answer: {status}", program.display()))),
    }
}

/// The summary, if the replies come to one.
fn listen(output: impl BufRead, tell: &mut impl FnMut(Event<'_>)) -> Result<Option<Summary>, Failure> {
    for line in output.lines() {
        let line = line.map_err(|e| Failure::Run(e.to_string()))?;
        match Reply::parse(&line).map_err(|e| Failure::Run(format!("the generated program: {e}")))? {
            Reply::Sample(sample) => tell(Event::Sample(&sample)),
            Reply::Linear(linear) => tell(Event::Linear(&linear)),
            Reply::Progress(t) => tell(Event::Progress(t)),
            Reply::Done(summary) => return Ok(Some(summary)),
            Reply::Failed(words) => return Err(Failure::Run(words)),
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests {
    use super::*;
    use gyro_codegen::Sheet;

    fn heard(text: &str) -> (Result<Option<Summary>, Failure>, usize) {
        let mut n_samples = 0;
        let outcome = listen(text.as_bytes(), &mut |event: Event<'_>| {
            n_samples += usize::from(matches!(event, Event::Sample(_)));
        });
        (outcome, n_samples)
    }

    #[test]
    fn replies_are_heard_to_their_end() {
        let sample = "sample 0.0 1.0 0.0 0.0 0.0 0.0 0.0 0 angle 0.0 1.0\n";
        let done = Summary { steps: 10, ..Summary::default() };
        let (outcome, n_samples) =
            heard(&format!("{sample}progress 0.5\n{sample}{}\n", Reply::Done(done).to_line()));
        assert_eq!((outcome.unwrap().unwrap().steps, n_samples), (10, 2));
        let (outcome, n_samples) = heard(&format!("{sample}failed at t = 0.5 s\n"));
        assert!(matches!(outcome, Err(Failure::Run(words)) if words == "at t = 0.5 s"));
        assert_eq!(n_samples, 1);
        assert!(heard(sample).0.unwrap().is_none(), "a program that was killed says nothing");
        assert!(matches!(heard("nonsense\n").0, Err(Failure::Run(_))));
    }

    #[test]
    fn a_package_is_named_by_its_contents() {
        let module = |code: &str| Module {
            name: "top".to_owned(),
            type_name: "Top".to_owned(),
            code: code.to_owned(),
            constants: String::new(),
            sheet: Sheet::default(),
        };
        let name = |code, precision| Package::program(&module(code), precision).name;
        assert_eq!(name("a", Precision::F64), name("a", Precision::F64));
        assert_ne!(name("a", Precision::F64), name("b", Precision::F64));
        assert_ne!(name("a", Precision::F64), name("a", Precision::F32));
        assert!(name("a", Precision::F64).starts_with("top-"));
    }
}
