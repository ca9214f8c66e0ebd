//! What README.md and the documents in docs/ tell the reader to type works as it is typed.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use gyro_model::Model;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The blocks between fences of this language.
fn blocks(page: &str, language: &str) -> Vec<String> {
    let fence = format!("```{language}\n");
    page.split(&fence).skip(1).map(|rest| rest.split("```").next().unwrap().to_owned()).collect()
}

/// README.md, ARCHITECTURE.md and the documents in docs/ and its folders but the report, with their paths in the clone.
fn pages() -> Vec<(PathBuf, String)> {
    let mut pages = vec![PathBuf::from("README.md"), PathBuf::from("ARCHITECTURE.md")];
    for folder in ["docs", "docs/decisions"].map(Path::new) {
        let entries = fs::read_dir(root().join(folder)).unwrap().map(|entry| entry.unwrap().file_name());
        pages.extend(
            entries.map(|name| folder.join(name)).filter(|path| path.extension().is_some_and(|e| e == "md")),
        );
    }
    pages.sort();
    let page = |path: PathBuf| {
        let text = fs::read_to_string(root().join(&path)).unwrap();
        (path, text)
    };
    pages.into_iter().map(page).collect()
}

/// All commands of a page: lines after a dollar, and what begins with `cargo` between backquotes.
fn commands(page: &str) -> Vec<Vec<String>> {
    let blocks = blocks(page, "console").concat().replace("\\\n", "");
    let typed = blocks.lines().filter_map(|line| line.strip_prefix("$ "));
    let without = blocks_removed(page);
    let inline = without.split('`').skip(1).step_by(2).filter(|words| words.starts_with("cargo "));
    let words = |line: &str| {
        let typed = line.split(" # ").next().unwrap();
        shlex::split(typed).unwrap_or_else(|| panic!("`{typed}` has a quote without its other half"))
    };
    typed.chain(inline).map(words).collect()
}

fn blocks_removed(page: &str) -> String {
    page.split("```").step_by(2).collect()
}

/// The manifests of the workspace's packages.
fn manifests() -> Vec<String> {
    let workspace = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let members = workspace.lines().find(|line| line.starts_with("members")).unwrap().to_owned();
    let members = members.split('"').skip(1).step_by(2);
    members.map(|member| fs::read_to_string(root().join(member).join("Cargo.toml")).unwrap()).collect()
}

/// A folder for what commands write, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        let path = std::env::temp_dir().join(format!("xtask-readme-{}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Files that a command reads are there, but those that it makes itself (`gyro new NAME && ...`) or that one before
/// it on the page has made.
fn files_are_there(page: &str, command: &[String], made: &mut Vec<String>) {
    let writes = command.iter().position(|word| word == "--out").map(|at| at + 1);
    made.extend(command.windows(2).filter(|pair| pair[0] == "new").map(|pair| format!("{}.toml", pair[1])));
    for (index, word) in command.iter().enumerate().skip(1) {
        let path = word.rsplit(['=', ':']).next().unwrap();
        let is_file = [".toml", ".csv", ".urdf"].iter().any(|end| path.ends_with(end));
        if is_file && writes != Some(index) && !made.iter().any(|file| file == path) {
            assert!(root().join(path).exists(), "{page}: `{}`: there is no {path}", command.join(" "));
        }
    }
}

fn names_a_file(command: &[String]) -> bool {
    let place = if command[2] == "export" { 4 } else { 3 };
    command.get(place).is_some_and(|word| [".toml", ".urdf"].iter().any(|end| word.ends_with(end)))
}

/// Whether a compiler of WebAssembly is at hand.
fn compiles_to_wasm() -> bool {
    ["clang", "wasm-ld"].iter().all(|tool| Command::new(tool).arg("--version").output().is_ok())
}

/// Runs a command of the tool as it is typed, but that it takes little time and writes elsewhere; of the long ones
/// nothing but that their options are known. What `new` makes is there for the commands after it.
fn run(command: &[String], folder: &Path) -> Output {
    let made = folder.join("made");
    let elsewhere = |path: &str| made.join(Path::new(path).file_name().unwrap()).display().to_string();
    let command: Vec<String> = command.iter().take_while(|word| *word != "&&").cloned().collect();
    let mut args: Vec<String> = command[2..].iter().filter(|word| *word != "--open").cloned().collect();
    for at in 1..args.len() {
        let is_written = ["--out", "--svg"].contains(&args[at - 1].as_str());
        if is_written || args[at].ends_with(".toml") && made.join(&args[at]).exists() {
            args[at] = elsewhere(&args[at]);
        }
    }
    let has = |option: &str| command.iter().any(|word| word == option);
    let mut add = |words: &[&str]| args.extend(words.iter().map(|word| (*word).to_owned()));
    let is_of_wasm = has("--live") || has("wasm");
    match command[2].as_str() {
        "new" => {
            fs::create_dir_all(&made).unwrap();
            let file = format!("{}.toml", command[3]);
            let _ = fs::remove_file(made.join(&file));
            add(&["--out", &elsewhere(&file)]);
        }
        "show" | "export" if is_of_wasm && !compiles_to_wasm() => add(&["--help"]),
        "show" if names_a_file(&command) => {
            if !has("--out") {
                add(&["--out", &elsewhere("page.html")]);
            }
            add(&["--t-end", "0.01"]);
        }
        "simulate" if names_a_file(&command) => {
            if !has("--linearize") {
                add(&["--t-end", "0.01"]);
            }
            add(&["--out", &folder.join("run").display().to_string()]);
        }
        "inspect" if names_a_file(&command) && !has("--no-compile") => add(&["--no-compile"]),
        "import" | "generate" | "inspect" | "check" | "export" if names_a_file(&command) => {}
        _ => add(&["--help"]),
    }
    Command::new(env!("CARGO_BIN_EXE_xtask")).args(args).current_dir(root()).output().unwrap()
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn every_command_works_as_it_is_typed() {
    let folder = Folder::new();
    let mut number = 0;
    for (path, page) in pages() {
        let name = path.display().to_string();
        let mut made = Vec::new();
        for command in commands(&page) {
            let command: Vec<String> = command.into_iter().skip_while(|word| word.contains('=')).collect();
            files_are_there(&name, &command, &mut made);
            if command.len() > 2 && command[..2] == ["cargo", "xtask"] {
                let output = run(&command, &folder.0);
                let said = String::from_utf8_lossy(&output.stderr);
                assert!(output.status.success(), "{name}: `{}`: {said}", command.join(" "));
                number += 1;
            }
            if let Some(at) = command.iter().position(|word| word == "--package") {
                let package = format!("name = \"{}\"", command[at + 1]);
                assert!(
                    manifests().iter().any(|text| text.contains(&package)),
                    "{name}: {}",
                    command.join(" ")
                );
            }
        }
    }
    assert!(number > 10, "{number} commands");
}

/// The model file of the README is the one that is shipped, and its bar lies where its hinge makes it lie.
#[test]
fn the_pendulum_is_the_one_that_is_shipped() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let page = blocks(&readme, "toml").remove(0);
    assert_eq!(page, fs::read_to_string(root().join("examples/pendulum.toml")).unwrap());
    let model = gyro_model::read("pendulum.toml", &page).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    let (along, moments) = (arm(&model), model.values(&model.bodies[1].inertia));
    // A thin bar has no moment to speak of about its own direction.
    for k in 0..3 {
        assert_eq!(along[k] == 0.0, moments[k] > 0.01, "{along:?} {moments:?}");
    }
    // m l^2 / 3 with l half the length.
    let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
    assert!((moments[0] - length * length / 3.0).abs() < 1e-3 * moments[0], "{moments:?}");
}

/// The model file of the tutorial is the one that is shipped.
#[test]
fn the_cart_and_pendulum_are_those_that_are_shipped() {
    let tutorial = fs::read_to_string(root().join("docs/tutorial.md")).unwrap();
    let shipped = fs::read_to_string(root().join("examples/cart-pendulum/cart-pendulum.toml")).unwrap();
    assert_eq!(blocks(&tutorial, "toml")[0], shipped);
}

/// The example of loops in the guide of the library is the one that is compiled.
#[test]
fn the_example_of_loops_is_a_compiled_one() {
    let source = fs::read_to_string(root().join("gyro-sim/src/correct/close_loops.rs")).unwrap();
    let documentation = source.lines().filter_map(|line| line.strip_prefix("///"));
    let shown = documentation
        .map(|line| line.strip_prefix(' ').unwrap_or(line))
        .filter(|line| !line.starts_with("# "));
    let shown: String = shown.map(|line| format!("{line}\n")).collect();
    let guide = fs::read_to_string(root().join("docs/library.md")).unwrap();
    assert!(shown.contains(&blocks(&guide, "rust")[0]), "{shown}");
}

/// From the mass centre to the hinge.
fn arm(model: &Model) -> [f64; 3] {
    model.values(&model.joints[0].second.point)
}

/// No page claims another version of Rust than the manifest, no picture or page that is linked is missing.
#[test]
fn the_version_of_rust_is_the_manifest_s_and_links_lead_somewhere() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    let manifest = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let (_, version) = manifest.split_once("rust-version = \"").unwrap();
    let version = version.split('"').next().unwrap();
    assert!(readme.contains(&format!("Rust {version} or newer")), "{version}");
    for (name, page) in pages() {
        let folder = root().join(name.parent().unwrap());
        for link in blocks_removed(&page).split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let path = link.split('#').next().unwrap();
            if path.is_empty() || path.contains("://") {
                continue;
            }
            assert!(folder.join(path).exists(), "{}: {link}", name.display());
        }
    }
}
