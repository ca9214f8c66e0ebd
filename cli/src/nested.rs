//! Compiles a generated mechanism into a small program and runs it, or into a library to look at.
//!
//! Each module gets a package of its own, named by a hash of its text, in the folder of the runtime that this program
//! carries; all of them share one build folder, so that only the first has to wait for `gyro-sim`. Whether anything has
//! to be compiled is Cargo's to decide.

use crate::args::Precision;
use crate::failure::Failure;
use crate::progress::{self, Spinner};
use crate::runs::{Runs, main};
use crate::scene::Scene;
use crate::verify::verify_quickly;
use crate::{files, interrupt, machine_code, programs, remarks, runtime};
use gyro_codegen::{Functions, Kernel, Module};
use gyro_model::Model;
use gyro_runner::protocol::{self, Reply, Request};
use gyro_runner::{Event, Summary, Timing};
use std::collections::hash_map::DefaultHasher;
use std::fs::{self, File, TryLockError};
use std::hash::{Hash, Hasher};
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// Generates, compiles and runs; `tell` hears of samples and progress.
///
/// A run that fails for a reason which a linearisation explains is made again by a program that has one, of which the
/// reason is all that is heard: to most runs that program would be of no use.
pub(crate) fn simulate(scene: &Scene, tell: impl FnMut(Event<'_>)) -> Result<Summary, Failure> {
    let runs = Runs::of(scene);
    let is_companion = scene.has_companions && !scene.approach.examine;
    let words = match run(scene, runs, tell)? {
        Answer::Done(summary, _) => return Ok(*summary),
        Answer::Unexplained(words) => words,
    };
    if !is_companion {
        run(scene, runs.map(Runs::examined), |_| ())?;
    }
    Err(Failure::Run(words))
}

/// Generates, compiles and runs with a program for these runs.
fn run(scene: &Scene, runs: Option<Runs>, tell: impl FnMut(Event<'_>)) -> Result<Answer, Failure> {
    let spinner = progress::deriving(&scene.page);
    let functions = runs.map_or_else(Functions::of_solvers, Runs::functions);
    let module = gyro_codegen::generate_by_effort(&scene.page_name, &scene.page, &functions, scene.effort)
        .map_err(|e| Failure::Usage(e.to_string()))?;
    drop(spinner);
    let program = program(&scene.page, &module, scene.precision, runs)?;
    let request = Request {
        settings: scene.settings,
        approach: scene.approach,
        parameters: scene.parameters(),
        start: scene.start.clone(),
        measure_for: None,
    };
    let _interruptible = interrupt::Run::begin();
    Session::open(&program, &[])?.hear(&request, tell)
}

/// Compiles a module into a program that answers requests of these runs, or of all; returns where it is.
pub(crate) fn program(
    page: &Model,
    module: &Module,
    precision: Precision,
    runs: Option<Runs>,
) -> Result<PathBuf, Failure> {
    let package = Package::program(module, precision, runs);
    package.build_proved(page, module)?;
    package.program_file()
}

/// The same without a proof, for one that is only timed.
#[cfg(feature = "jit")]
pub(crate) fn unproved(module: &Module, precision: Precision) -> Result<PathBuf, Failure> {
    let package = Package::program(module, precision, None);
    build(&package)?;
    package.program_file()
}

/// Compiles a module into a program with these lines that runs the scenarios of studies, for this very processor if
/// that is asked for; returns where it is.
pub(crate) fn sweeping(
    page: &Model,
    module: &Module,
    main: String,
    is_native: bool,
) -> Result<PathBuf, Failure> {
    let mut package = Package::new(module, ("main.rs", main), processor(is_native));
    package.without_cargo = SINGLE_SCENARIOS;
    package.manifest += "\n[dependencies.gyro-sweep]\npath = \"../../sweep\"\n";
    package.build_proved(page, module)?;
    package.program_file()
}

/// What rustc is told of the processor.
fn processor(is_native: bool) -> &'static [&'static str] {
    if is_native { &["--config", "build.rustflags=['-Ctarget-cpu=native']"] } else { &[] }
}

/// Compiles a module into a library that a program loads, with this text at its root; returns where it is.
#[cfg(feature = "jit")]
pub(crate) fn loadable(
    page: &Model,
    module: &Module,
    root: String,
    is_native: bool,
) -> Result<PathBuf, Failure> {
    use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
    let mut package = Package::new(module, ("lib.rs", root), processor(is_native));
    package.without_cargo = "; all else works without it";
    package.manifest =
        manifest(&package.name, ", features = [\"lanes\"]") + "\n[lib]\ncrate-type = [\"cdylib\"]\n";
    package.build_proved(page, module)?;
    package.built(&format!("{DLL_PREFIX}{}{DLL_SUFFIX}", package.name.replace('-', "_")))
}

/// A program that takes the word `answer`, the path of a model file and the names of a form and of a precision, and
/// answers requests with the runtime-assembled model, optimised: this very program where it was compiled so, else the
/// one that the workspace makes of it.
pub(crate) fn assembled() -> Result<PathBuf, Failure> {
    match files::workspace().filter(|_| cfg!(debug_assertions)) {
        Some(root) => {
            let _spinner = Spinner::new("compiling the runtime-assembled model".to_owned());
            let mut command = Command::new(programs::cargo());
            command.args(["build", "--release", "--package", "gyro-assembled", "--example", ANSWERING]);
            command.args(["--features", "child"]);
            programs::executable(command.current_dir(root), ANSWERING)
        }
        None => std::env::current_exe().map_err(|e| Failure::Run(format!("this program is not found: {e}"))),
    }
}

/// The program of the package `gyro-assembled`, and the word for it here.
const ANSWERING: &str = "answer";

/// Compiles these kernels for `f64`, optimised; the library, in which each has its symbol.
pub(crate) fn library(module: &Module, kernels: &[Kernel]) -> Result<PathBuf, Failure> {
    let root = machine_code::library(&module.type_name, kernels);
    let package = Package::new(module, ("lib.rs", root), &["--", machine_code::SYMBOLS]);
    build(&package)?;
    package.built(&format!("lib{}.rlib", package.name.replace('-', "_")))
}

/// Where cargo builds all packages.
const BUILD: &str = "build";

/// The files of a package.
struct Package {
    name: String,
    manifest: String,
    /// Name and text of the file at its root.
    root: (&'static str, String),
    /// The generated module.
    mechanism: String,
    /// What rustc is told besides.
    options: &'static [&'static str],
    /// What can be had without cargo.
    without_cargo: &'static str,
}

/// What a run can be had by without cargo.
const OTHER_ENGINES: &str =
    ", or leave out --engine: that needs no compiler and has the same results to the last bit";

/// The same of a sweep.
const SINGLE_SCENARIOS: &str =
    ". Without it, single scenarios can be had: `simulate MODEL --set PARAMETER=VALUE`";

impl Package {
    fn program(module: &Module, precision: Precision, runs: Option<Runs>) -> Self {
        let package = Self::new(module, ("main.rs", main(module, precision, runs)), &[]);
        Self { without_cargo: OTHER_ENGINES, ..package }
    }

    fn new(module: &Module, root: (&'static str, String), options: &'static [&'static str]) -> Self {
        let mut hasher = DefaultHasher::new();
        (&root.1, &module.code).hash(&mut hasher);
        let name = format!("{}-{:016x}", module.name, hasher.finish());
        Self {
            manifest: manifest(&name, ""),
            name,
            root,
            mechanism: module.code.clone(),
            options,
            without_cargo: "",
        }
    }

    fn program_file(&self) -> Result<PathBuf, Failure> {
        self.built(&format!("{}{}", self.name, std::env::consts::EXE_SUFFIX))
    }

    /// Where Cargo puts what it builds.
    fn built(&self, file: &str) -> Result<PathBuf, Failure> {
        Ok(runtime::folder()?.join(BUILD).join("release").join(file))
    }

    fn folder(&self) -> Result<PathBuf, Failure> {
        Ok(runtime::folder()?.join("programs").join(&self.name))
    }

    /// Compiles it, the module being verified unless this very one was written before.
    fn build_proved(&self, page: &Model, module: &Module) -> Result<(), Failure> {
        let file = self.folder()?.join("src").join("mechanism.rs");
        if !crate::write::holds(&file, &self.mechanism) {
            verify_quickly(page, module)?;
        }
        build(self)
    }
}

/// A manifest with the carried sources as dependencies, the runtime with these features.
fn manifest(name: &str, features: &str) -> String {
    format!(
        "[package]
name = \"{name}\"
version = \"0.0.0\"
edition = \"2024\"
publish = false

[workspace]

[dependencies]
gyro-sim = {{ path = \"../../gyro-sim\", default-features = false{features} }}
gyro-runner = {{ path = \"../../runner\" }}

[profile.release]
debug = false
"
    )
}

/// Brings a package up to date.
fn build(package: &Package) -> Result<(), Failure> {
    let (runtime, folder) = (runtime::folder()?, package.folder()?);
    let failure = |e: std::io::Error| Failure::Run(format!("{} cannot be used: {e}", runtime.display()));
    fs::create_dir_all(folder.join("src")).map_err(failure)?;
    let lock = File::create(runtime.join("lock")).map_err(failure)?;
    // Released when the file is closed at the end of this function. Two runs at once take turns at building.
    wait_for(&lock, remarks::note).map_err(failure)?;
    files::write(&folder.join("Cargo.toml"), &package.manifest)?;
    let (file, root) = &package.root;
    files::write(&folder.join("src").join(file), root)?;
    files::write(&folder.join("src").join("mechanism.rs"), &package.mechanism)?;
    // The carried versions hold here too. Cargo drops from its copy what the package does not need.
    if !folder.join("Cargo.lock").is_file() {
        fs::copy(runtime.join("Cargo.lock"), folder.join("Cargo.lock")).map_err(failure)?;
    }
    let _spinner = Spinner::new(format!("compiling {}", package.name));
    match cargo(package, &folder, &runtime.join(BUILD))? {
        None => Ok(()),
        Some(words) => Err(Failure::Run(format!(
            "the generated program does not compile; it is in {}\n{words}",
            folder.display()
        ))),
    }
}

/// Waits until a file can be locked, and says so if that is not at once.
fn wait_for(lock: &File, tell: impl Fn(&str)) -> std::io::Result<()> {
    match lock.try_lock() {
        Ok(()) => Ok(()),
        Err(TryLockError::WouldBlock) => {
            tell("another run is compiling; this one waits for it to finish");
            lock.lock()
        }
        Err(TryLockError::Error(error)) => Err(error),
    }
}

/// What Cargo said if it failed.
fn cargo(package: &Package, folder: &Path, target: &Path) -> Result<Option<String>, Failure> {
    let output = Command::new(programs::cargo())
        .args(["rustc", "--quiet", "--release", "--offline", "--target-dir"])
        .arg(target)
        .args(package.options)
        .current_dir(folder)
        .env_remove("CARGO_BUILD_TARGET")
        .stdin(Stdio::null())
        .output()
        .map_err(|e| Failure::Run(without_cargo(&e, package.without_cargo)))?;
    let words = || String::from_utf8_lossy(&output.stderr).into_owned();
    Ok((!output.status.success()).then(words))
}

/// What to do where cargo is missing.
fn without_cargo(error: &std::io::Error, instead: &str) -> String {
    format!(
        "cargo cannot be started ({error}), and generated code must be compiled: install Rust from \
         https://rustup.rs{instead}"
    )
}

/// A program under way that answers requests.
#[derive(Debug)]
pub(crate) struct Session {
    program: PathBuf,
    child: Child,
    input: Option<ChildStdin>,
    replies: BufReader<ChildStdout>,
}

impl Session {
    /// Starts the program.
    pub(crate) fn open(program: &Path, arguments: &[&str]) -> Result<Self, Failure> {
        let mut command = Command::new(program);
        command.args(arguments).stdin(Stdio::piped()).stdout(Stdio::piped());
        let mut child = command.spawn().map_err(|e| Failure::Run(format!("{}: {e}", program.display())))?;
        let input = child.stdin.take();
        let replies = BufReader::new(child.stdout.take().expect("standard output is piped"));
        Ok(Self { program: program.to_path_buf(), child, input, replies })
    }

    /// Hands a request to the program and listens to its replies.
    pub(crate) fn ask(
        &mut self,
        request: &Request,
        tell: impl FnMut(Event<'_>),
    ) -> Result<(Summary, Option<Timing>), Failure> {
        match self.hear(request, tell)? {
            Answer::Done(summary, timing) => Ok((*summary, timing)),
            Answer::Unexplained(words) => Err(Failure::Run(words)),
        }
    }

    /// The same; says whether more can be known of a failure.
    fn hear(&mut self, request: &Request, mut tell: impl FnMut(Event<'_>)) -> Result<Answer, Failure> {
        let input = self.input.as_mut().expect("standard input is piped");
        protocol::write(input, request)
            .map_err(|e| Failure::Run(format!("{}: {e}", self.program.display())))?;
        match listen(&mut self.replies, &mut tell)? {
            Some(answer) => Ok(answer),
            // On a terminal the program hears of it, too.
            None if interrupt::was_interrupted() => Err(interrupt::failure()),
            None => {
                let ended = self.child.wait().map_or_else(|e| e.to_string(), |status| status.to_string());
                Err(Failure::Run(format!("{} ended without an answer: {ended}", self.program.display())))
            }
        }
    }
}

/// How a program's replies end, unless the run fails for a reason that is known.
#[derive(Debug)]
enum Answer {
    /// The figures of the run.
    Done(Box<Summary>, Option<Timing>),
    /// It failed, and a program that linearises can tell more.
    Unexplained(String),
}

impl Drop for Session {
    fn drop(&mut self) {
        // Without input a program ends by itself; one in the middle of a run does not hear of that.
        drop(self.input.take());
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

/// What the replies come to, if they do.
fn listen(output: &mut impl BufRead, tell: &mut impl FnMut(Event<'_>)) -> Result<Option<Answer>, Failure> {
    let mut timing = None;
    let mut told = interrupt::interruptible(tell);
    let mut tell = |event: Event<'_>| told(event).map_err(|_| interrupt::failure());
    while let Some(reply) = protocol::read(output).map_err(|e| Failure::Run(format!("the program: {e}")))? {
        match reply {
            Reply::Sample(sample) => tell(Event::Sample(&sample))?,
            Reply::Occurred(found) => tell(Event::Occurred(&found))?,
            Reply::Linear(linear) => tell(Event::Linear(&linear))?,
            Reply::Stopped(t, state) => tell(Event::Stopped(t, &state))?,
            Reply::Stiff(t) => tell(Event::Stiff(t))?,
            Reply::Progress(t) => tell(Event::Progress(t))?,
            Reply::Forecast(forecast) => tell(Event::Forecast(forecast))?,
            Reply::Timed(timed) => timing = Some(timed),
            Reply::Done(summary) => return Ok(Some(Answer::Done(Box::new(summary), timing))),
            Reply::Unexplained(words) => return Ok(Some(Answer::Unexplained(words))),
            Reply::Failed(words) => return Err(Failure::Run(words)),
            Reply::Refused(words) => return Err(Failure::Usage(words)),
        }
    }
    Ok(None)
}

#[cfg(test)]
mod tests;
