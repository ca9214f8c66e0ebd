//! `cargo xtask simulate` from the outside: what it prints, writes and returns.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// An empty folder of its own, removed at the end.
struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("xtask-simulate-{}-{name}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

fn model(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../models").join(name).display().to_string()
}

fn simulate(folder: &Folder, args: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_xtask"));
    command.arg("simulate").args(args).current_dir(&folder.0).output().unwrap()
}

fn json(folder: &Folder, args: &[&str]) -> Value {
    let output = simulate(folder, &[args, &["--json"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// Integration to 1e-11, and rounding of two orders of evaluation.
const ENGINES_AGREE: f64 = 1e-10;

#[test]
fn json_is_one_object_and_both_engines_give_the_same() {
    let folder = Folder::new("json");
    let page = model("gyroscope-parameters.toml");
    let run = |engine| {
        json(&folder, &[&page, "--engine", engine, "--t-end", "0.05", "--set", "rotor_offset=0.0002"])
    };
    let (generated, assembled) = (run("generated"), run("assembled"));
    let mut keys: Vec<&String> = assembled.as_object().unwrap().keys().collect();
    keys.sort();
    assert_eq!(
        keys,
        [
            "chart_switches",
            "constraint_violation",
            "energy",
            "energy_drift",
            "engine",
            "joints",
            "method",
            "model",
            "run_time_s",
            "step",
            "steps",
            "t",
            "velocity_violation"
        ]
    );
    assert_eq!((assembled["steps"].as_u64(), assembled["t"].as_f64()), (Some(500), Some(0.05)));
    for joint in ["alpha", "beta", "phi"] {
        for key in ["position", "rate"] {
            let value = |run: &Value| run["joints"][joint][key].as_f64().unwrap();
            let difference = (value(&generated) - value(&assembled)).abs();
            assert!(difference < ENGINES_AGREE, "{joint} {key}: {difference:e}");
        }
    }
    assert!(folder.files().is_empty(), "--json without --out writes nothing");
}

#[test]
fn spherical_joints_give_euler_parameters_and_body_rates() {
    let folder = Folder::new("spherical");
    let run = json(&folder, &[&model("heavy-top.toml"), "--engine", "assembled", "--t-end", "0.01"]);
    assert_eq!(run["joints"]["tip"]["position"].as_array().unwrap().len(), 4);
    assert_eq!(run["joints"]["tip"]["rate"].as_array().unwrap().len(), 3);
}

#[test]
fn the_summary_stands_beside_linear_theory_and_files_are_written() {
    let folder = Folder::new("summary");
    let output = simulate(&folder, &[&model("gyroscope.toml"), "--engine", "assembled", "--out", "."]);
    let text = String::from_utf8(output.stdout).unwrap();
    for words in ["alpha slope b [rad/s]", "linear theory", "144.311261", "wrote ./gyroscope.csv"] {
        assert!(text.contains(words), "{words} is missing in\n{text}");
    }
    let names = ["gyroscope-energy.svg", "gyroscope-motion.svg", "gyroscope-residuals.svg", "gyroscope.csv"];
    assert_eq!(folder.files(), names);
    let table = fs::read_to_string(folder.0.join("gyroscope.csv")).unwrap();
    assert!(table.starts_with("t [s],alpha [rad],alpha rate [rad/s],"), "{}", table.lines().next().unwrap());
    assert_eq!(table.lines().count(), 1 + 1001);
}

#[test]
fn a_run_that_fails_says_where_and_keeps_whole_rows() {
    let folder = Folder::new("fails");
    let page = model("gyroscope.toml");
    let rough = [&page, "--engine", "assembled", "--method", "direct", "--step", "0.05", "--every", "0.05"];
    let output = simulate(&folder, &[&rough[..], &["--t-end", "20", "--out", "."]].concat());
    let words = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(words.contains("no longer finite") && words.contains("The run is incomplete"), "{words}");
    assert_eq!(folder.files(), ["gyroscope.csv"]);
    let output = simulate(&folder, &[&rough[..], &["--t-end", "20", "--json"]].concat());
    assert!(output.stdout.is_empty() && output.status.code() == Some(1));
}

#[test]
fn bad_requests_leave_nothing_behind() {
    let folder = Folder::new("bad");
    fs::write(folder.0.join("bad.toml"), "format = 1\nnam = \"x\"\n").unwrap();
    let (page, tunable) = (model("gyroscope.toml"), model("gyroscope-parameters.toml"));
    for (args, message) in [
        (&["none.toml"][..], "none.toml cannot be read"),
        (&["bad.toml"], "bad.toml:2:1"),
        (&[&page, "--step", "-1e-4"], "a positive number of seconds was expected"),
        (&[&page, "--every", "1e-12"], "at most 1e7 are accepted"),
        (&[&page, "--set", "mass=1"], "has no parameters"),
        (&[&tunable, "--set", "rotor_mas=1"], "write `rotor_mass`"),
        (&[&tunable, "--set", "rotor_mass=-1"], "the mass of body `rotor` is not positive"),
        (&[&tunable, "--set", "gravity=1", "--set", "gravity=2"], "gives `gravity` twice"),
    ] {
        let output = simulate(&folder, args);
        let words = String::from_utf8(output.stderr).unwrap();
        assert!(words.contains(message), "{args:?}: {words}");
        assert!(output.status.code() == Some(2) && output.stdout.is_empty(), "{args:?}");
    }
    assert_eq!(folder.files(), ["bad.toml"]);
}
