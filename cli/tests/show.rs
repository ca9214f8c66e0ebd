//! `cargo xtask show`: pages are written whole, from disk alone, and never over what somebody else wrote.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// An empty folder of its own, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("gyro-show-{}-{name}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn show(model: &str, page: &Path, options: &[&str]) -> Output {
    let model = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(model);
    let mut command = Command::new(env!("CARGO_BIN_EXE_gyro"));
    command.arg("show").arg(model).arg("--out").arg(page).args(options).output().unwrap()
}

/// What the page tells its program.
fn head(page: &Path) -> Value {
    let html = fs::read_to_string(page).unwrap();
    assert!(html.starts_with("<!doctype html>"), "{}", &html[..80]);
    let (_, rest) = html.split_once("id=\"head\">").unwrap();
    serde_json::from_str(rest.split_once("</script>").unwrap().0).unwrap()
}

#[test]
fn a_run_of_another_model_file_is_shown_over_the_first() {
    let folder = Folder::new("other");
    let page = folder.0.join("pendulum.html");
    let other = Path::new(env!("CARGO_MANIFEST_DIR")).join("../models/compound-pendulum.toml");
    let other = other.to_str().unwrap();
    let options = ["--t-end", "0.1", "--set", "length=0.3", "--compare", other];
    let output = show("examples/pendulum.toml", &page, &options);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let head = head(&page);
    let scenes = head["scenes"].as_array().unwrap();
    let names: Vec<&str> = scenes.iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["pendulum", "compound-pendulum"]);
    assert_eq!(scenes[0]["mechanism"]["joints"][0]["ends"][1]["point"][1], 0.3);
    assert_eq!(scenes[1]["mechanism"]["name"], "compound_pendulum");
}

#[test]
fn two_runs_are_on_one_page() {
    let folder = Folder::new("two");
    let page = folder.0.join("deep/pendulum.html");
    let options = ["--t-end", "0.1", "--every", "0.01", "--compare", "length=0.4,dense", "--reactions"];
    let output = show("examples/pendulum.toml", &page, &options);
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(String::from_utf8_lossy(&output.stdout).contains("22 samples"), "two runs of eleven");
    let head = head(&page);
    let names: Vec<&str> =
        head["scenes"].as_array().unwrap().iter().map(|s| s["name"].as_str().unwrap()).collect();
    assert_eq!(names, ["length = 0.5, recursive", "length = 0.4, dense"]);
    for (scene, length) in head["scenes"].as_array().unwrap().iter().zip([0.5, 0.4]) {
        assert_eq!(scene["n"], 11);
        assert_eq!(scene["mechanism"]["joints"][0]["kind"], "Revolute");
        assert_eq!(scene["mechanism"]["joints"][0]["ends"][1]["point"][1], length);
        assert_eq!(scene["reactions"][0]["joint"], 0);
        let column = scene["reactions"][0]["column"].as_u64().unwrap() as usize;
        assert_eq!(scene["columns"][column]["title"], "reaction_of_hinge");
        assert_eq!(scene["columns"][column]["name"], "force_f");
    }
}

#[test]
fn a_run_that_fails_is_shown_up_to_there() {
    let folder = Folder::new("fails");
    let page = folder.0.join("x.html");
    let options = ["--integrator", "dop853", "--tolerance", "1e-9", "--budget", "4", "--every", "0.001"];
    let output = show("examples/pendulum.toml", &page, &options);
    let words = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{words}");
    assert!(words.contains("The page shows the run up to there"), "{words}");
    assert!(head(&page)["scenes"][0]["n"].as_u64().unwrap() > 1);
}

#[test]
fn mistakes_are_found_before_the_run() {
    let folder = Folder::new("mistakes");
    let page = folder.0.join("mine.html");
    for (options, words) in [
        (&["--json"][..], "--json is an option of simulate"),
        (&["--linearize", "0"], "--linearize is an option of simulate"),
        (&["--compare", "steam"], "PARAMETER=VALUE, an engine or a model file was expected"),
        (&["--compare", "mass=1"], "mass"),
        (&["--coordinates", "joint", "--engine", "dense"], "--coordinates joint"),
    ] {
        let output = show("examples/pendulum.toml", &page, options);
        let found = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{options:?}: {found}");
        assert!(found.contains(words), "{options:?}: {found}");
        assert!(!page.exists());
    }
    fs::write(&page, "mine").unwrap();
    let output = show("examples/pendulum.toml", &page, &["--t-end", "0.1"]);
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(fs::read_to_string(&page).unwrap(), "mine");
}
