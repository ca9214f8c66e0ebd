//! Runs of the command line in a folder of their own.

use serde_json::Value;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::Mutex;

/// An empty folder of its own, removed at the end.
pub(super) struct Folder(pub(super) PathBuf);

impl Folder {
    pub(super) fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("xtask-simulate-{}-{name}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(super) fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(&self.0).unwrap();
        let mut names: Vec<String> = entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
        // What the tool keeps of what it wrote.
        names.retain(|name| name != ".gyro-sim");
        names.sort();
        names
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

pub(super) fn model(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../models").join(name).display().to_string()
}

pub(super) fn xtask(folder: &Folder, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gyro")).args(args).current_dir(&folder.0).output().unwrap()
}

pub(super) fn simulate(folder: &Folder, args: &[&str]) -> Output {
    xtask(folder, &[&["simulate"], args].concat())
}

pub(super) fn json(folder: &Folder, args: &[&str]) -> Value {
    let is_proved = if is_proved_already(folder, args) { &["--no-prove"][..] } else { &[] };
    let output = simulate(folder, &[args, is_proved, &["--json"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// A mechanism is proved once, not again with every option with which it runs.
fn is_proved_already(folder: &Folder, args: &[&str]) -> bool {
    static PROVED: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    let proves = !args.iter().any(|arg| ["--no-prove", "assembled"].contains(arg));
    let page = args.iter().find(|arg| arg.ends_with(".toml")).filter(|_| proves);
    let text = page.and_then(|page| fs::read_to_string(folder.0.join(page)).ok());
    text.is_some_and(|text| !PROVED.lock().unwrap().insert(text))
}

pub(super) fn close(found: &Value, expected: f64) {
    let found = found.as_f64().unwrap();
    assert!((found - expected).abs() < 1e-9 * expected.abs().max(1.0), "{found} for {expected}");
}

pub(super) fn refused(output: &Output, words: &str) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && said.contains(words), "{said}");
}
