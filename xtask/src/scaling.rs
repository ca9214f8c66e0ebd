//! Chains of more and more bodies: what they cost to generate, to compile and to run.

use gyro_cli::chain;
use gyro_cli::failure::Failure;
use gyro_cli::files;
use gyro_cli::machine_code::{self, SYMBOLS};
use gyro_cli::programs::{cargo, executable, folder, io_failure, output, three};
use gyro_cli::progress::Spinner;
use gyro_codegen::Kernel;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Numbers of bodies.
const SIZES: [usize; 9] = [1, 2, 4, 8, 16, 32, 64, 128, 256];

/// What one chain takes.
struct Chain {
    bodies: usize,
    /// Operations of the accelerations in joint coordinates, and of all bodies.
    flops: [String; 2],
    generation_s: f64,
    /// None where rustc fails, or is ended.
    release_s: Option<f64>,
    debug_s: Option<f64>,
    /// Of the accelerations in joint coordinates, and of all bodies.
    bytes: Option<[u64; 2]>,
    /// Not of what rustc has not compiled.
    times: Option<Times>,
}

/// What accelerations take, ns, and medians of ratios.
#[derive(Clone, Copy)]
struct Times {
    joint: f64,
    recursive: f64,
    joint_to_recursive: f64,
    maximal: f64,
    careful: f64,
    maximal_to_careful: f64,
}

/// Measures chains of up to so many bodies; two tables in Markdown: what accelerations take, and what it takes to have
/// them.
pub(crate) fn tables(most: usize) -> Result<[String; 2], Failure> {
    let generator = generator()?;
    let sizes: Vec<usize> = SIZES.into_iter().filter(|&bodies| bodies <= most).collect();
    let place = Place { folder: folder().join("scaling") };
    let mut chains = place.generate(&generator, &sizes)?;
    place.compile(&mut chains)?;
    place.run(&mut chains)?;
    let mut times = "| bodies | joint accelerations, ns | recursive, ns | ÷ recursive | accelerations of all bodies, ns | careful, ns | ÷ careful |\n\
                     |---|---|---|---|---|---|---|\n"
        .to_owned();
    let mut costs = "| bodies | flops, joint accelerations | of all bodies | generation, s | rustc release, s | rustc debug, s | machine code, \
                     joint accelerations, bytes | of all bodies |\n|---|---|---|---|---|---|---|---|\n"
        .to_owned();
    for chain in &chains {
        times += &chain.row_of_times();
        costs += &chain.row_of_costs();
    }
    Ok([times, costs])
}

impl Chain {
    fn row_of_times(&self) -> String {
        let cells = self.times.map_or([(); 6].map(|()| String::new()), |times| {
            let Times { joint, recursive, joint_to_recursive, maximal, careful, maximal_to_careful } = times;
            let [joint, recursive, maximal, careful] = [joint, recursive, maximal, careful].map(three);
            let [one, other] = [joint_to_recursive, maximal_to_careful].map(|ratio| format!("{ratio:.2}"));
            [joint, recursive, one, maximal, careful, other]
        });
        format!("| {} | {} |\n", self.bodies, cells.join(" | "))
    }

    fn row_of_costs(&self) -> String {
        let Self { bodies, flops: [of_joints, of_bodies], generation_s, release_s, debug_s, bytes, .. } =
            self;
        let [joint, maximal] = bytes.map_or([(); 2].map(|()| String::new()), |b| b.map(|b| b.to_string()));
        let seconds =
            |taken: &Option<f64>| taken.map_or("not compiled".to_owned(), |taken| format!("{taken:.1}"));
        let (release_s, debug_s) = (seconds(release_s), seconds(debug_s));
        format!(
            "| {bodies} | {of_joints} | {of_bodies} | {generation_s:.2} | {release_s} | {debug_s} | {joint} | {maximal} |\n"
        )
    }
}

/// The generator, optimised, as a program that prints the module of a model file.
fn generator() -> Result<PathBuf, Failure> {
    let _spinner = Spinner::new("building the generator".to_owned());
    let name = "print_module";
    let mut command = Command::new(cargo());
    command.args(["build", "--release", "--package", "gyro-codegen", "--example", name]);
    executable(command.current_dir(files::root()), name)
}

/// A workspace of its own for the chains' crates and the program that runs them.
struct Place {
    folder: PathBuf,
}

impl Place {
    fn write(&self, path: &str, text: &str) -> Result<(), Failure> {
        let path = self.folder.join(path);
        let parent = path.parent().unwrap_or(&self.folder);
        fs::create_dir_all(parent).map_err(|e| io_failure(parent, &e))?;
        files::write(&path, text).map(|_| ())
    }

    /// Writes model files, modules and crates.
    fn generate(&self, generator: &Path, sizes: &[usize]) -> Result<Vec<Chain>, Failure> {
        let mut chains = Vec::new();
        for &bodies in sizes {
            let _spinner = Spinner::new(format!("generating a chain of {bodies}"));
            let name = format!("chain_{bodies}");
            self.write(&format!("{name}/model.toml"), &chain::model_file(bodies))?;
            let page = self.folder.join(&name).join("model.toml");
            let before = children_cpu_s();
            let module = Command::new(generator)
                .arg(&page)
                .stderr(Stdio::inherit())
                .output()
                .map_err(|e| io_failure(generator, &e))?;
            let generation_s = children_cpu_s() - before;
            if !module.status.success() {
                return Err(Failure::Run(format!("a chain of {bodies} cannot be generated")));
            }
            let module = String::from_utf8_lossy(&module.stdout).into_owned();
            self.write(&format!("{name}/src/mechanism.rs"), &module)?;
            self.write(&format!("{name}/src/lib.rs"), &library(bodies))?;
            self.write(&format!("{name}/Cargo.toml"), &manifest(&name, &[("gyro-sim", "gyro-sim")], &[]))?;
            let flops =
                [Kernel::JointAccelerations, Kernel::Accelerations].map(|kernel| flops(&module, kernel));
            chains.push(Chain {
                bodies,
                flops,
                generation_s,
                release_s: None,
                debug_s: None,
                bytes: None,
                times: None,
            });
        }
        self.write_program(sizes)?;
        Ok(chains)
    }

    fn write_program(&self, sizes: &[usize]) -> Result<(), Failure> {
        let names: Vec<String> = sizes.iter().map(|bodies| format!("chain_{bodies}")).collect();
        let ours = [("gyro-sim", "gyro-sim"), ("gyro-model", "model"), ("gyro-assembled", "assembled")];
        self.write("run/Cargo.toml", &manifest("run", &ours, &names))?;
        self.write("run/src/main.rs", &program(sizes))?;
        let members: Vec<&str> = names.iter().map(String::as_str).chain(["run"]).collect();
        let workspace = format!(
            "[workspace]\nresolver = \"3\"\nmembers = {members:?}\n\n[profile.release]\ndebug = false\n"
        );
        self.write("Cargo.toml", &workspace)?;
        let lock = files::root().join("Cargo.lock");
        let text = fs::read_to_string(&lock).map_err(|e| io_failure(&lock, &e))?;
        self.write("Cargo.lock", &text)
    }

    /// Compiles every chain by itself, after what it depends on.
    fn compile(&self, chains: &mut [Chain]) -> Result<(), Failure> {
        // What an earlier run has compiled would take no time.
        let built = self.folder.join("target");
        if built.exists() {
            fs::remove_dir_all(&built).map_err(|e| io_failure(&built, &e))?;
        }
        for profile in ["release", "dev"] {
            self.cargo(&["build", "--profile", profile, "--package", "gyro-sim"])?;
            for chain in &mut *chains {
                let name = format!("chain_{}", chain.bodies);
                let _spinner = Spinner::new(format!("compiling {name}, profile {profile}"));
                let before = children_cpu_s();
                let outcome = self.cargo(&["build", "--profile", profile, "--package", &name]);
                let taken = outcome.is_ok().then(|| children_cpu_s() - before);
                if let Err(failure) = outcome {
                    failure.report();
                }
                if profile == "release" {
                    chain.release_s = taken;
                } else {
                    chain.debug_s = taken;
                }
            }
        }
        for chain in chains {
            let library = built.join("release").join(format!("libchain_{}.rlib", chain.bodies));
            let of = |bytes: &BTreeMap<_, u64>, kernel| bytes.get(&kernel).copied().unwrap_or(0);
            chain.bytes = machine_code::bytes(&library).map(|all| {
                [Kernel::JointAccelerations, Kernel::Accelerations].map(|kernel| of(&all, kernel))
            });
        }
        Ok(())
    }

    /// Times the accelerations of each chain in turns.
    fn run(&self, chains: &mut [Chain]) -> Result<(), Failure> {
        let _spinner = Spinner::new("running chains".to_owned());
        let compiled = || chains.iter().filter(|chain| chain.release_s.is_some());
        self.write_program(&compiled().map(|chain| chain.bodies).collect::<Vec<_>>())?;
        let said = self.cargo(&["run", "--release", "--package", "run"])?;
        let numbers: Vec<f64> = said.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let figures = numbers.as_chunks::<6>().0;
        if figures.len() != compiled().count() {
            return Err(Failure::Run(format!("the chains printed an unexpected result: {said}")));
        }
        let compiled = chains.iter_mut().filter(|chain| chain.release_s.is_some());
        for (chain, &figures) in compiled.zip(figures) {
            let [recursive, joint, joint_to_recursive, careful, maximal, maximal_to_careful] = figures;
            let times = Times { joint, recursive, joint_to_recursive, maximal, careful, maximal_to_careful };
            chain.times = Some(times);
        }
        Ok(())
    }

    fn cargo(&self, options: &[&str]) -> Result<String, Failure> {
        match self.cargo_with(options, &["--offline"]) {
            // Cargo says so if something has to be downloaded first.
            Err(Failure::Run(words)) if words.contains("offline") => self.cargo_with(options, &[]),
            outcome => outcome,
        }
    }

    fn cargo_with(&self, options: &[&str], network: &[&str]) -> Result<String, Failure> {
        let mut command = Command::new(cargo());
        command.args(options).args(network).arg("--quiet").current_dir(&self.folder);
        let flags = std::env::var("RUSTFLAGS").unwrap_or_default();
        command.env("RUSTFLAGS", format!("{flags} {SYMBOLS}"));
        command.env("CARGO_TARGET_DIR", self.folder.join("target")).env_remove("CARGO_BUILD_TARGET");
        output(&mut command)
    }
}

fn manifest(name: &str, ours: &[(&str, &str)], beside: &[String]) -> String {
    let mut text = format!(
        "[package]\nname = \"{name}\"\nversion = \"0.0.0\"\nedition = \"2024\"\npublish = false\n\n[dependencies]\n"
    );
    for (package, folder) in ours {
        let path = files::root().join(folder);
        let _ = writeln!(text, "{package} = {{ path = {:?} }}", path.to_string_lossy());
    }
    for package in beside {
        let _ = writeln!(text, "{package} = {{ path = \"../{package}\" }}");
    }
    text
}

/// What is compiled of a chain: all functions that a module has unless something else is asked for.
const COMPILED: [Kernel; 19] = [
    Kernel::Accelerations,
    Kernel::Multipliers,
    Kernel::Derivative,
    Kernel::Phi,
    Kernel::PhiQ,
    Kernel::PhiPi,
    Kernel::Gamma,
    Kernel::VelocityResidual,
    Kernel::AppliedForce,
    Kernel::Energy,
    Kernel::ReadJoints,
    Kernel::ChartVectors,
    Kernel::NewtonStep,
    Kernel::SolveVelocities,
    Kernel::JointAccelerations,
    Kernel::ToMaximal,
    Kernel::ToJoints,
    Kernel::CorrectedAccelerations,
    Kernel::CorrectedDerivative,
];

fn library(bodies: usize) -> String {
    let functions = machine_code::library(&format!("Chain{bodies}"), &COMPILED);
    format!(
        "{functions}
pub fn start() -> State {{ Module::default().start() }}
pub fn buffer() -> Accelerations {{ Module::default().acceleration_buffer() }}
pub fn joint_start() -> Joints {{ Module::default().joint_start() }}
pub fn rates() -> Rates {{ Module::default().joint_buffers().rates }}
"
    )
}

/// Prints six numbers a chain: recursive and joint accelerations, ns, and the median of their ratios; the same of
/// careful ones and those of all bodies. All agree, or it panics.
fn program(sizes: &[usize]) -> String {
    let [kernel, round] =
        ["kernel", "round"].map(|name| files::root().join("benches").join("src").join(format!("{name}.rs")));
    let mut text = format!(
        "#![allow(dead_code)]
#[path = {kernel:?}]
mod kernel;
#[path = {round:?}]
mod round;

"
    );
    text += "use gyro_assembled::{Careful, Recursive};
use kernel::Kernel;
use round::{Clock, interleaved};
use gyro_sim::{Dynamics, JointSpace, Mechanism};
use std::hint::black_box;
use std::time::Duration;

fn main() {
";
    for bodies in sizes {
        let _ = write!(
            text,
            "    {{
        let model = gyro_model::read(\"model.toml\", include_str!(\"../../chain_{bodies}/model.toml\")).expect(\"a model file\");
        let chain = chain_{bodies}::Module::default();
        let (y, mut out) = (chain_{bodies}::start(), chain_{bodies}::buffer());
        let (x, mut rates) = (chain_{bodies}::joint_start(), chain_{bodies}::rates());
        chain_{bodies}::accelerations(&chain, 0.0, &y, &mut out);
        let expected = out.as_ref()[..{n_v}].to_vec();
        chain_{bodies}::joint_accelerations(&chain, 0.0, &x, &mut rates);
        let mut moved = [x, x];
        let (plus, minus) = (1e-6, -1e-6);
        for (x, h) in moved.iter_mut().zip([plus, minus]) {{
            for k in 0..{bodies} {{
                x[k] += h * x[{bodies} + k];
                x[{bodies} + k] += h * rates[k];
            }}
        }}
        agree(&chain, &moved, plus - minus, &expected);
        let joint = Kernel::new(\"\", \"\", None, move || chain_{bodies}::joint_accelerations(&chain, 0.0, black_box(&x), black_box(&mut rates)));
        measure(assembled(Recursive::<f64>::new(&model).expect(\"a tree\"), &expected), joint);
        let maximal = Kernel::new(\"\", \"\", None, move || chain_{bodies}::accelerations(&chain, 0.0, black_box(&y), black_box(&mut out)));
        measure(assembled(Careful::<f64>::new(&model).expect(\"a tree\"), &expected), maximal);
    }}
",
            n_v = 6 * bodies
        );
    }
    text += "}

/// Along the motion velocities of bodies change as their accelerations say.
fn agree<M: JointSpace<Scalar = f64>>(chain: &M, moved: &[M::Joints; 2], time: f64, expected: &[f64]) {
    let mut states = [chain.start(), chain.start()];
    for (y, x) in states.iter_mut().zip(moved) {
        chain.to_maximal(0.0, x, y);
    }
    let n_positions = 7 * expected.len() / 6;
    let largest = expected.iter().fold(0.0_f64, |largest, a| largest.max(a.abs()));
    for (k, a) in expected.iter().enumerate() {
        let [plus, minus] = [0, 1].map(|n| states[n].as_ref()[n_positions + k]);
        let rate = (plus - minus) / time;
        assert!((rate - a).abs() < 1e-4 * largest, \"{rate} {a} {largest}\");
    }
}

fn measure(first: Kernel<'_>, second: Kernel<'_>) {
    let figures = interleaved(&mut [first, second], 101, (Duration::from_millis(1), Clock::Wall), |_| ());
    println!(\"{} {} {}\", figures[0].ns, figures[1].ns, figures[1].ratio);
}

fn assembled<M: Dynamics<Scalar = f64, State = Vec<f64>> + 'static>(assembled: M, expected: &[f64]) -> Kernel<'static> {
    let (y, mut out) = (assembled.start(), assembled.acceleration_buffer());
    assembled.accelerations(0.0, &y, &mut out);
    let largest = expected.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    for (a, b) in out.as_ref().iter().zip(expected) {
        assert!((a - b).abs() < 1e-8 * largest, \"{a} {b} {largest}\");
    }
    Kernel::new(\"\", \"\", None, move || assembled.accelerations(0.0, black_box(&y), black_box(&mut out)))
}
";
    text
}

/// The total of a function in a module's data sheet.
fn flops(module: &str, kernel: Kernel) -> String {
    let begins = format!("//! | {} |", kernel.name());
    let row = module.lines().find(|line| line.starts_with(&begins)).unwrap_or_default();
    row.split('|').nth(6).unwrap_or_default().trim().to_owned()
}

/// CPU time of all children that have ended, s: on a shared machine the time of day says little. Zero where the system
/// does not tell.
fn children_cpu_s() -> f64 {
    /// Of the kernel's clock in user space, whatever its own is.
    const TICKS_A_SECOND: f64 = 100.0;
    let text = fs::read_to_string("/proc/self/stat").unwrap_or_default();
    // The name in brackets may contain spaces; user and system time of children are the 14th and 15th after it.
    let after = text.rsplit(')').next().unwrap_or_default();
    let ticks = after.split_whitespace().skip(13).take(2).filter_map(|word| word.parse::<f64>().ok());
    ticks.sum::<f64>() / TICKS_A_SECOND
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_pages_are_chains() {
        for bodies in [1, 2, 8] {
            let model = gyro_model::read("chain.toml", &chain::model_file(bodies)).unwrap();
            assert_eq!((model.degrees_of_freedom(), model.joints.len()), (bodies, bodies));
        }
    }

    #[test]
    fn the_total_is_the_sixth_column() {
        let sheet = "//! | function | computes | + − | × | ÷ | total | zeros |\n//! | accelerations | (s̈, ẇ'), eq. (17) | 216 | 339 | 5 | 560 | 7 of 18 |\n";
        assert_eq!(flops(sheet, Kernel::Accelerations), "560");
    }
}
