//! A package outside the workspace, in an empty folder, generates its own mechanisms in `build.rs` and runs them.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use gyro_assembled::Careful;
use gyro_model::{Model, parse_decimal};
use gyro_sim::{Ode, Partitioned};
use gyro_sim_suite::{cargo, difference};
use std::fmt::Write;
use std::fs;
use std::path::{Path, PathBuf};

/// Two engines over half a second: their roundings, amplified by a motion that is chaotic in the long run.
const AGREEMENT: f64 = 1e-9;

/// A chain long enough that no function of it could be one block: rustc fails on those.
const LINKS: usize = 6;

fn fixture(name: &str) -> String {
    let path = root().join("tests/probes/outside").join(name);
    fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// A chain of links with full inertia tensors, every axis skew to the one before.
fn chain() -> String {
    let mut page = "format = 1\nname = \"chain\"\ngravity = [0, 0, -9.81]\n".to_owned();
    page += "[[body]]\nname = \"link_0\"\nfixed = true\n";
    for link in 1..=LINKS {
        let (x, y, second, before) = (link % 3 + 1, link % 4, link % 5, link - 1);
        let _ = write!(
            page,
            "
[[body]]
name = \"link_{link}\"
mass = 0.{link}
inertia = {{ xx = 1e-3, yy = 2e-3, zz = 1.5e-3, xy = 1e-4, xz = 2e-4, yz = -1e-4 }}

[[joint]]
name = \"joint_{link}\"
kind = \"revolute\"
angle = 0.{link}
rate = 0.5
first = {{ body = \"link_{before}\", point = [0.1, 0.02, 0], axis = [{x}, {y}, 1], zero = [0, 1, 0.5] }}
second = {{ body = \"link_{link}\", point = [-0.1, 0.01, 0.03], axis = [1, {second}, 2], zero = [0.3, 0, 1] }}
"
        );
    }
    page
}

/// An empty folder, then the package.
fn package(pendulum: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("outside");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(folder.join("src")).unwrap();
    let [gyro_sim, gyro_codegen, gyro_verifier] =
        ["gyro-sim", "codegen", "verifier"].map(|folder| root().join(folder));
    let manifest = format!(
        "[package]
name = \"outside\"
version = \"0.0.0\"
edition = \"2024\"

[workspace]

[dependencies]
gyro-sim = {{ path = {gyro_sim:?}, default-features = false }}

[build-dependencies]
gyro-codegen = {{ path = {gyro_codegen:?} }}
gyro-verifier = {{ path = {gyro_verifier:?} }}

[profile.dev]
debug = false
"
    );
    let files = [
        ("Cargo.toml", manifest),
        ("build.rs", fixture("build.rs")),
        ("src/main.rs", fixture("main.rs")),
        ("double-pendulum.toml", pendulum.to_owned()),
        ("hinge.toml", fixture("hinge.toml")),
        ("chain.toml", chain()),
    ];
    files.iter().for_each(|(name, text)| fs::write(folder.join(name), text).unwrap());
    folder
}

/// The state that the twin reaches in this process.
fn twin(model: &Model, corrections: u32) -> Vec<f64> {
    let mechanism = Careful::<f64>::new(model).unwrap();
    let mut state = mechanism.start();
    let mut solver = Partitioned::new(&mechanism, &state);
    for interval in 0..corrections {
        solver.advance(&mechanism, f64::from(interval) * 5e-3, 1e-3, 5, &mut state).unwrap();
    }
    state
}

fn read(text: &str) -> Model {
    gyro_model::read("page.toml", text).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

fn states(printed: &str) -> Vec<Vec<f64>> {
    let state = |line: &str| line.trim_matches(['[', ']']).split(", ").map(|x| x.parse().unwrap()).collect();
    printed.lines().map(state).collect()
}

#[test]
fn a_package_outside_generates_its_own_mechanisms() {
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("nested");
    let page = fixture("double-pendulum.toml");
    let said = cargo(&package(&page), &target, "run", &[]);
    assert!(said.is_success, "{}", said.stderr);
    let heavier =
        read(&page).with_parameters(&[("bob_mass".to_owned(), parse_decimal("0.35").unwrap())]).unwrap();
    let found = states(&said.stdout);
    let expected = [twin(&heavier, 100), twin(&read(&chain()), 10)];
    for (name, (found, expected)) in ["pendulum", "chain"].iter().zip(found.iter().zip(&expected)) {
        let error = difference(found, expected, 0.0);
        println!("{name}: {error:e}");
        assert!(error <= AGREEMENT && error > 0.0, "{name}: off by {error:e}:\n{found:?}\n{expected:?}");
    }
    assert_eq!(found.len(), expected.len());
    // The check must be able to fail: with the page's own bob the motion is another.
    assert!(difference(&found[0], &twin(&read(&page), 100), 0.0) > 1e-3);
    // And a page with a mistake does not build, but says where it is wrong.
    let refused = cargo(&package(&page.replace("mass = 0.5", "mass = -0.5")), &target, "run", &[]);
    assert!(!refused.is_success);
    assert!(refused.stderr.contains("mass"), "{}", refused.stderr);
    // Nor does one whose module is not what the page says.
    let wrong = package(&page);
    let built = fs::read_to_string(wrong.join("build.rs"))
        .unwrap()
        .replace("WRONG: bool = false", "WRONG: bool = true");
    fs::write(wrong.join("build.rs"), built).unwrap();
    let refused = cargo(&wrong, &target, "run", &[]);
    assert!(!refused.is_success && refused.stderr.contains("REFUTED"), "{}", refused.stderr);
}

/// The blocks of README.md in this language.
fn of_the_readme(language: &str) -> Vec<String> {
    let page = fs::read_to_string(root().join("README.md")).unwrap();
    let fence = format!("```{language}\n");
    page.split(&fence).skip(1).map(|rest| rest.split("```").next().unwrap().to_owned()).collect()
}

/// The page, the manifest, the build script and the lines of Rust that README.md shows make a package that builds and
/// runs.
#[test]
fn the_readme_s_example_builds_and_runs() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("readme");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(folder.join("src")).unwrap();
    let tables = of_the_readme("toml");
    let [page, dependencies, ..] = &tables[..] else { panic!("a page and dependencies") };
    let (script, lines): (Vec<String>, Vec<String>) =
        of_the_readme("rust,ignore").into_iter().partition(|block| block.contains("// build.rs"));
    let clone = root().display().to_string();
    let head = "[package]\nname = \"readme\"\nversion = \"0.0.0\"\nedition = \"2024\"\n\n[workspace]\n\n[profile.dev]\ndebug = false\n\n";
    let manifest = format!("{head}{}", dependencies.replace("path/to/the/clone", &clone));
    // What generates the items stands outside of functions, all else is a program.
    let text = lines.join("\n");
    let (items, body): (Vec<&str>, Vec<&str>) = text.lines().partition(|line| line.starts_with("include!"));
    let body: Vec<String> = body.into_iter().map(once_imported()).collect();
    let main = format!(
        "#![allow(warnings)]\n{}\nfn main() -> Result<(), gyro_sim::Error> {{\n{}\nprintln!(\"{{:?}} {{:?}}\", state, x);\nOk(())\n}}\n",
        items.join("\n"),
        body.join("\n")
    );
    let files = [
        ("Cargo.toml", &manifest),
        ("build.rs", &script[0]),
        ("src/main.rs", &main),
        ("pendulum.toml", page),
    ];
    files.iter().for_each(|(name, text)| fs::write(folder.join(name), text).unwrap());
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("nested");
    let said = cargo(&folder, &target, "run", &[]);
    assert!(said.is_success, "{}\n{main}", said.stderr);
    assert!(said.stdout.contains("[") && !said.stdout.contains("NaN"), "{}", said.stdout);
}

/// Names are imported once: the snippets of a page are not one program.
fn once_imported() -> impl FnMut(&str) -> String {
    let mut known: Vec<String> = Vec::new();
    move |line| {
        let Some(names) = line.strip_prefix("use gyro_sim::{").and_then(|rest| rest.strip_suffix("};"))
        else {
            return line.to_owned();
        };
        let new: Vec<&str> =
            names.split(", ").filter(|name| !known.iter().any(|other| other == name)).collect();
        known.extend(new.iter().map(|name| (*name).to_owned()));
        format!("use gyro_sim::{{{}}};", new.join(", "))
    }
}
