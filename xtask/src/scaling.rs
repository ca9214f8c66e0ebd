//! Chains of more and more bodies: what they cost to generate, to compile and to run.

use gyro_cli::chain;
use gyro_cli::failure::Failure;
use gyro_cli::files;
use gyro_cli::machine_code::{self, SYMBOLS};
use gyro_cli::programs::{cargo, folder, io_failure, output, three};
use gyro_cli::progress::Spinner;
use gyro_codegen::Kernel;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Numbers of bodies.
const SIZES: [usize; 7] = [1, 2, 4, 8, 16, 32, 64];

/// What one chain takes.
struct Chain {
    bodies: usize,
    flops: String,
    generation_s: f64,
    /// None where rustc fails, or is ended.
    release_s: Option<f64>,
    debug_s: Option<f64>,
    bytes: Option<u64>,
    /// Accelerations: generated, recursive, careful; not of what rustc has not compiled.
    ns: Option<[f64; 3]>,
}

/// Measures chains of up to so many bodies; a table in Markdown.
pub(crate) fn table(generator: &Path, most: usize) -> Result<String, Failure> {
    let sizes: Vec<usize> = SIZES.into_iter().filter(|&bodies| bodies <= most).collect();
    let place = Place { folder: folder().join("scaling") };
    let mut chains = place.generate(generator, &sizes)?;
    place.compile(&mut chains)?;
    place.run(&mut chains)?;
    let mut text = "| bodies | flops | flops a body | generated, ns | assembled, recursive, ns | assembled, careful, ns | generation, s | rustc \
                    release, s | rustc debug, s | machine code, bytes |\n"
        .to_owned();
    text += "|---|---|---|---|---|---|---|---|---|---|\n";
    for chain in &chains {
        text += &chain.row();
    }
    Ok(text)
}

impl Chain {
    fn row(&self) -> String {
        let Self { bodies, flops, generation_s, release_s, debug_s, bytes, ns } = self;
        let a_body = flops.parse::<f64>().map_or(String::new(), |flops| three(flops / *bodies as f64));
        let bytes = bytes.map_or(String::new(), |bytes| bytes.to_string());
        let seconds =
            |taken: &Option<f64>| taken.map_or("not compiled".to_owned(), |taken| format!("{taken:.1}"));
        let (release_s, debug_s) = (seconds(release_s), seconds(debug_s));
        let [generated, recursive, careful] = ns.map_or([(); 3].map(|()| String::new()), |ns| ns.map(three));
        format!(
            "| {bodies} | {flops} | {a_body} | {generated} | {recursive} | {careful} | {generation_s:.2} | {release_s} | \
             {debug_s} | {bytes} |\n"
        )
    }
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
            let file = fs::File::open(&page).map_err(|e| io_failure(&page, &e))?;
            let before = children_cpu_s();
            let module = Command::new(generator)
                .arg("--generate")
                .stdin(file)
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
            let flops = flops(&module);
            chains.push(Chain {
                bodies,
                flops,
                generation_s,
                release_s: None,
                debug_s: None,
                bytes: None,
                ns: None,
            });
        }
        self.write_program(sizes)?;
        Ok(chains)
    }

    fn write_program(&self, sizes: &[usize]) -> Result<(), Failure> {
        let names: Vec<String> = sizes.iter().map(|bodies| format!("chain_{bodies}")).collect();
        let ours = [
            ("gyro-sim", "gyro-sim"),
            ("gyro-model", "model"),
            ("gyro-assembled", "assembled"),
            ("gyro-benches", "benches"),
        ];
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
            chain.bytes = machine_code::bytes(&library)
                .map(|bytes| bytes.get(&Kernel::Accelerations).copied().unwrap_or(0));
        }
        Ok(())
    }

    /// Times the accelerations of all chains in turns.
    fn run(&self, chains: &mut [Chain]) -> Result<(), Failure> {
        let _spinner = Spinner::new("running chains".to_owned());
        let compiled = || chains.iter().filter(|chain| chain.release_s.is_some());
        self.write_program(&compiled().map(|chain| chain.bodies).collect::<Vec<_>>())?;
        let said = self.cargo(&["run", "--release", "--package", "run"])?;
        let numbers: Vec<f64> = said.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let figures = numbers.as_chunks::<3>().0;
        if figures.len() != compiled().count() {
            return Err(Failure::Run(format!("the chains printed an unexpected result: {said}")));
        }
        let compiled = chains.iter_mut().filter(|chain| chain.release_s.is_some());
        compiled.zip(figures).for_each(|(chain, ns)| chain.ns = Some(*ns));
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

/// What is compiled of a chain: all but joint coordinates.
const COMPILED: [Kernel; 12] = [
    Kernel::Accelerations,
    Kernel::Multipliers,
    Kernel::Derivative,
    Kernel::Phi,
    Kernel::PhiQ,
    Kernel::Gamma,
    Kernel::VelocityResidual,
    Kernel::Energy,
    Kernel::ReadJoints,
    Kernel::ChartVectors,
    Kernel::NewtonStep,
    Kernel::SolveVelocities,
];

fn library(bodies: usize) -> String {
    let functions = machine_code::library(&format!("Chain{bodies}"), &COMPILED);
    format!(
        "{functions}
pub fn start() -> State {{ Module::default().start() }}
pub fn buffer() -> Accelerations {{ Module::default().acceleration_buffer() }}
"
    )
}

/// Prints three times a chain, ns: accelerations generated, recursive, careful. All agree, or it panics.
fn program(sizes: &[usize]) -> String {
    let mut text = "use gyro_assembled::{Careful, Recursive};
use gyro_benches::{Clock, Kernel, interleaved};
use gyro_sim::{Dynamics, Mechanism};
use std::hint::black_box;
use std::time::Duration;

fn main() {
    let mut kernels = Vec::new();
"
    .to_owned();
    for bodies in sizes {
        let _ = write!(
            text,
            "    let model = gyro_model::read(\"model.toml\", include_str!(\"../../chain_{bodies}/model.toml\")).expect(\"a model file\");
    let y = chain_{bodies}::start();
    let mut out = chain_{bodies}::buffer();
    let chain = chain_{bodies}::Module::default();
    chain_{bodies}::accelerations(&chain, 0.0, &y, &mut out);
    let expected = out.as_ref()[..{n_v}].to_vec();
    kernels.push(Kernel::new(\"\", \"\", None, move || chain_{bodies}::accelerations(&chain, 0.0, black_box(&y), black_box(&mut out))));
    kernels.push(assembled(Recursive::<f64>::new(&model).expect(\"a tree\"), &expected));
    kernels.push(assembled(Careful::<f64>::new(&model).expect(\"a tree\"), &expected));
",
            n_v = 6 * bodies
        );
    }
    text += "    for figure in interleaved(&mut kernels, 51, (Duration::from_millis(1), Clock::Wall), |_| ()) {
        println!(\"{}\", figure.ns);
    }
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

/// The total of the accelerations in a module's data sheet.
fn flops(module: &str) -> String {
    let begins = format!("//! | {} |", Kernel::Accelerations.name());
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
        assert_eq!(flops(sheet), "560");
    }
}
