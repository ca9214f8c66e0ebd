//! Many random model files compiled by rustc into one program and run, beside the forms of the
//! runtime-assembled model by the same solvers.

#[path = "runs.rs"]
mod runs;

use gyro_assembled::{Careful, Dense, Recursive};
use gyro_codegen::Module;
use gyro_model::Model;
use gyro_sim::{CorrectedDynamics, Dynamics, Kinematics, Mechanism, Partition, Projection};
use runs::{Ends, STEPS, maximal};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;

/// What the ends of runs may differ by, in terms of what changes of the start by a unit in the last place do, or of
/// roundings of each step.
const ALLOWED: f64 = 16.0;

/// How often the runtime-assembled model is run anew from starts that differ by a rounding.
const DITHERS: u64 = 3;

/// Roundings of the largest number that each of the steps makes.
const ROUNDINGS: f64 = 100.0 * f64::EPSILON;

/// What was compared, and by how much it differs in terms of what is allowed.
pub type Found = Vec<(String, f64)>;

/// Generates, compiles and runs the model files of these seeds.
pub fn compare(seeds: std::ops::Range<u64>) -> Found {
    let pages: Vec<(u64, Model, Module)> = seeds.clone().map(page).collect();
    let folder = std::env::temp_dir().join("gyro-pages");
    let started = std::time::Instant::now();
    write_package(&folder, &pages);
    let output = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .args(["run", "--quiet", "--release", "--offline", "--manifest-path"])
        .arg(folder.join("Cargo.toml"))
        .output()
        .expect("cargo can be started");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    println!("{seeds:?} compiled and run in {:.0} s", started.elapsed().as_secs_f64());
    let text = String::from_utf8(output.stdout).expect("printed text");
    let lines: Vec<Vec<&str>> = text.lines().map(|line| line.split(';').collect()).collect();
    pages.iter().flat_map(|(seed, model, _)| of_page(*seed, model, &lines)).collect()
}

fn page(seed: u64) -> (u64, Model, Module) {
    let read = gyro_model::read_with("page.toml", &gyro_pages::page(seed), &mut gyro_pages::load);
    let model = read.unwrap_or_else(|problems| panic!("{problems}"));
    let module = gyro_codegen::generate_functions("page.toml", &model, &gyro_codegen::Functions::all());
    let module = module.unwrap_or_else(|error| panic!("{seed}: {error}"));
    (seed, model, module)
}

/// A package with a module for each model file.
fn write_package(folder: &Path, pages: &[(u64, Model, Module)]) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut main = include_str!("runs.rs").replace("//!", "//");
    let mut calls = String::new();
    fs::create_dir_all(folder.join("src")).expect("a temporary folder");
    for (seed, _, module) in pages {
        let name = &module.type_name;
        let _ = write!(main, "#[allow(warnings)]\nmod {};\n", module.name);
        let _ = writeln!(
            calls,
            "    let m = {}::{name}::<f64>::default();\n    for steps in STEPS {{",
            module.name
        );
        let _ = writeln!(calls, "        print({seed}, &m, steps, maximal(&m, &m.start(), steps));");
        if module.code.contains(&format!("gyro_sim::JointSpace for {name}")) {
            let _ = writeln!(calls, "        print({seed}, &m, steps, joint(&m, steps));");
        }
        let _ = writeln!(calls, "    }}");
        fs::write(folder.join(format!("src/{}.rs", module.name)), &module.code).expect("a file");
    }
    let _ = write!(main, "fn main() {{\n{calls}}}\n");
    fs::write(folder.join("src/main.rs"), main).expect("a file");
    let manifest = format!(
        "[package]\nname = \"pages\"\nversion = \"0.0.0\"\nedition = \"2024\"\n[workspace]\n[dependencies]\n\
         gyro-sim = {{ path = {:?}, default-features = false }}\n[profile.release]\nopt-level = 1\ncodegen-units = 16\n",
        root.join("gyro-sim")
    );
    fs::write(folder.join("Cargo.toml"), manifest).expect("a file");
    fs::copy(root.join("Cargo.lock"), folder.join("Cargo.lock")).expect("the workspace's versions");
}

/// The forms of the runtime-assembled model beside what the program has printed.
fn of_page(seed: u64, model: &Model, lines: &[Vec<&str>]) -> Found {
    let mut forms = vec![("dense", Twin::of(Dense::<f64>::new(model).expect("it does every model")))];
    if Careful::<f64>::supports(model).is_ok() {
        forms.push(("careful", Twin::of(Careful::<f64>::new(model).expect("it is supported"))));
    }
    if Recursive::<f64>::supports(model).is_ok() {
        forms.push(("recursive", Twin::of(Recursive::<f64>::new(model).expect("it is supported"))));
    }
    let [coarse, fine] = STEPS.map(|steps| {
        let is_this = move |line: &&Vec<&str>| line[0] == seed.to_string() && line[1] == steps.to_string();
        lines.iter().filter(is_this)
    });
    let mut found = Found::new();
    for (line, finer) in coarse.zip(fine) {
        for (form, twin) in &forms {
            found.push((format!("{seed}: {}, generated and {form}", line[2]), twin.beside(line, finer)));
        }
    }
    assert!(!found.is_empty(), "{seed} was not run");
    found
}

/// A form's ends, the same by finer steps, and what moving the start by a rounding does to each.
struct Twin {
    ends: [Ends; 2],
    noise: Vec<f64>,
}

impl Twin {
    fn of<
        M: Partition<Scalar = f64, State = Vec<f64>> + Kinematics + Dynamics + CorrectedDynamics + Projection,
    >(
        form: M,
    ) -> Self {
        let start = Mechanism::start(&form);
        let ends = STEPS.map(|steps| maximal(&form, &start, steps));
        let mut noise = vec![0.0_f64; ends[0].len()];
        for series in 0..DITHERS {
            let moved = maximal(&form, &super::support::dithered(&start, series), STEPS[0]);
            for ((noise, (_, moved)), (_, end)) in noise.iter_mut().zip(&moved).zip(&ends[0]) {
                if let (Ok(moved), Ok(end)) = (moved, end) {
                    *noise = noise.max(apart(moved, end));
                }
            }
        }
        Self { ends, noise }
    }

    /// How far what was printed is from this form's end in terms of what is allowed: roundings, and what both are off
    /// by as finer steps tell.
    fn beside(&self, line: &[&str], finer: &[&str]) -> f64 {
        // Trees in joint coordinates and by the closed form come to where the partition comes.
        let name = if ["joint", "closed form"].contains(&line[2]) { "partition" } else { line[2] };
        let index = self.ends[0].iter().position(|(known, _)| *known == name).expect("it is run");
        let [end, finer_end] = [0, 1].map(|steps| &self.ends[steps][index].1);
        match (end, numbers(line[3])) {
            (Ok(y), Some(generated)) => {
                let scale = y.iter().fold(1.0, |m: f64, x| m.max(x.abs()));
                let own = finer_end.as_ref().map_or(0.0, |finer| apart(y, finer));
                let method = own + numbers(finer[3]).map_or(0.0, |finer| apart(&generated, &finer));
                apart(y, &generated) / (ALLOWED * (self.noise[index] + ROUNDINGS * scale) + 3.0 * method)
            }
            (Err(error), None) if error.to_string() == line[3] => 0.0,
            (end, _) => {
                let end = end.as_ref().map_or_else(ToString::to_string, |_| "runs".to_owned());
                println!(
                    "{}, {name}: the runtime-assembled model: {end}; generated: {}",
                    line[0],
                    &line[3][..60.min(line[3].len())]
                );
                f64::NAN
            }
        }
    }
}

fn numbers(text: &str) -> Option<Vec<f64>> {
    let inner = text.strip_prefix('[')?.strip_suffix(']')?;
    inner.split(", ").map(|number| number.parse().ok()).collect()
}

/// The largest difference; both signs of Euler parameters are one orientation.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    let mut b = b.to_vec();
    super::support::alike(&mut b, a);
    super::support::difference(a, &b)
}
