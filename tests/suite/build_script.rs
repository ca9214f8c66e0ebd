//! A package outside the workspace, in an empty folder, generates its own mechanisms in `build.rs` and runs them.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use gyro_assembled::Careful;
use gyro_model::{Model, parse_decimal};
use gyro_sim::{Mechanism, Partitioned};
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

/// The state that the runtime-assembled model reaches in this process.
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
#[ignore = "takes long: `.ci/steps` runs it"]
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
    // The check must be able to fail: with the model file's own bob the motion is another.
    assert!(difference(&found[0], &twin(&read(&page), 100), 0.0) > 1e-3);
    // And a model file with a mistake does not build, but says where it is wrong.
    let refused = cargo(&package(&page.replace("mass = 0.5", "mass = -0.5")), &target, "run", &[]);
    assert!(!refused.is_success);
    assert!(refused.stderr.contains("mass"), "{}", refused.stderr);
    // Nor does one whose module is not what the model file says.
    let wrong = package(&page);
    let built = fs::read_to_string(wrong.join("build.rs"))
        .unwrap()
        .replace("WRONG: bool = false", "WRONG: bool = true");
    fs::write(wrong.join("build.rs"), built).unwrap();
    let refused = cargo(&wrong, &target, "run", &[]);
    assert!(!refused.is_success && refused.stderr.contains("REFUTED"), "{}", refused.stderr);
}

/// The blocks of the tutorial in this language.
fn of_the_tutorial(language: &str) -> Vec<String> {
    let page = fs::read_to_string(root().join("docs/tutorial.md")).unwrap();
    let fence = format!("```{language}\n");
    page.split(&fence).skip(1).map(|rest| rest.split("```").next().unwrap().to_owned()).collect()
}

/// The model file, the manifest, the build script and the program of docs/tutorial.md make a package that builds and
/// runs, and prints what the tutorial says.
#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn the_tutorial_s_package_builds_and_runs() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("tutorial");
    let _ = fs::remove_dir_all(&folder);
    fs::create_dir_all(folder.join("src")).unwrap();
    let [model, manifest, ..] = &of_the_tutorial("toml")[..] else { panic!("a model file and a manifest") };
    let [script, program] = &of_the_tutorial("rust,ignore")[..] else { panic!("a script and a program") };
    let clone = root().display().to_string();
    let manifest =
        manifest.replace("path/to/the/clone", &clone) + "\n[workspace]\n\n[profile.dev]\ndebug = false\n";
    let files = [
        ("Cargo.toml", &manifest),
        ("build.rs", script),
        ("src/main.rs", program),
        ("cart-pendulum.toml", model),
    ];
    files.iter().for_each(|(name, text)| fs::write(folder.join(name), text).unwrap());
    let target = Path::new(env!("CARGO_TARGET_TMPDIR")).join("nested");
    let said = cargo(&folder, &target, "run", &[]);
    assert!(said.is_success, "{}", said.stderr);
    let printed = of_the_tutorial("text").into_iter().find(|block| block.starts_with("joint coordinates:"));
    let [found, expected] = [said.stdout, printed.unwrap()].map(|text| numbers(&text));
    assert_eq!([found.len(), expected.len()], [8, 8]);
    let error = difference(&found, &expected, 0.0);
    assert!(error <= AGREEMENT, "off by {error:e}:\n{found:?}\n{expected:?}");
}

/// The numbers between the brackets of each line.
fn numbers(printed: &str) -> Vec<f64> {
    let inside = |line: &str| Some(line.split_once('[')?.1.trim_end().trim_end_matches(']').to_owned());
    let lines: Vec<String> = printed.lines().filter_map(inside).collect();
    lines.iter().flat_map(|line| line.split(", ").map(|x| x.parse::<f64>().unwrap())).collect()
}
