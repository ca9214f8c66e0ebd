//! Runs that are interrupted.

use super::support::{Folder, model};
use std::fs;
use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};

#[cfg(unix)]
#[test]
fn what_was_computed_is_kept() {
    is_kept_by("assembled");
}

#[cfg(all(unix, feature = "jit"))]
#[test]
fn what_compiled_functions_have_computed_is_kept() {
    is_kept_by("jit");
}

#[cfg(unix)]
fn is_kept_by(engine: &str) {
    let folder = Folder::new(&format!("interrupted-{engine}"));
    let options = ["--engine", engine, "--t-end", "1e4", "--budget", "1000000000", "--out", "part"];
    let mut run = Command::new(env!("CARGO_BIN_EXE_gyro"))
        .args(["simulate", &model("gyroscope.toml")])
        .args(options)
        .current_dir(&folder.0)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut said = BufReader::new(run.stderr.take().unwrap());
    // The last that is said before the first step.
    let mut line = String::new();
    while !line.contains("steps will take") {
        line.clear();
        assert!(said.read_line(&mut line).unwrap() > 0, "the run is over");
    }
    let killed = Command::new("kill").args(["-INT", &run.id().to_string()]).status().unwrap();
    assert!(killed.success());
    let output = run.wait_with_output().unwrap();
    let mut rest = String::new();
    said.read_to_string(&mut rest).unwrap();
    assert_eq!(output.status.code(), Some(130), "{rest}");
    assert!(rest.contains("interrupted: the run of 10000 s is incomplete"), "{rest}");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.starts_with("gyroscope: interrupted at t = ") && text.contains("wrote part/"), "{text}");
    let table = fs::read_to_string(folder.0.join("part/gyroscope.csv")).unwrap();
    assert!(table.ends_with('\n'), "{table}");
    let columns = |line: &str| line.split(',').count();
    let head = columns(table.lines().next().unwrap());
    assert!(table.lines().all(|line| columns(line) == head), "{table}");
}
