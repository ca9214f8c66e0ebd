//! `gyro new` and `gyro check` from the outside.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn gyro(folder: &Path, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gyro")).current_dir(folder).args(args).output().unwrap()
}

/// An empty folder.
fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn every_template_is_good_and_simulates_at_once() {
    let folder = folder("begin-templates");
    for (template, words) in [
        ("pendulum", "hinge (revolute, 60°) ── bar (2 kg)"),
        ("cart", "2 degrees of freedom"),
        ("four-bar", "1 closed loop, 1 degree of freedom"),
        ("gimbal", "rotor (0.305 kg)"),
        ("arm", "input elbow_torque = 0"),
    ] {
        let (name, file) = (template.replace('-', "_"), format!("{}.toml", template.replace('-', "_")));
        let output = gyro(&folder, &["new", &name, "--template", template]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        for next in ["check", "simulate", "generate"] {
            assert!(text(&output.stdout).contains(&format!("gyro {next} {file}")), "{next}");
        }
        let output = gyro(&folder, &["check", &file, "--svg", "sketch.svg"]);
        assert!(output.status.success(), "{}", text(&output.stderr));
        assert!(text(&output.stdout).contains(words), "{}", text(&output.stdout));
        let output = gyro(&folder, &["simulate", &file, "--engine", "assembled", "--t-end", "0.01"]);
        assert!(output.status.success(), "{}", text(&output.stderr));
    }
    assert!(std::fs::read_to_string(folder.join("sketch.svg")).unwrap().contains("elbow"));
}

#[test]
fn nothing_is_overwritten_and_names_are_names() {
    let folder = folder("begin-refusals");
    std::fs::write(folder.join("mine.toml"), "mine").unwrap();
    for (args, words) in [
        (&["new", "mine"][..], "nothing is overwritten"),
        (&["new", "other", "--out", "mine.toml"], "nothing is overwritten"),
        (&["new", "My Arm"], "write `my_arm`"),
        (&["new", "loop"], "keyword of Rust"),
        (&["new", "arm", "--out", "nowhere/arm.toml"], "cannot be written"),
    ] {
        let output = gyro(&folder, args);
        assert_eq!(output.status.code(), Some(2), "{args:?}");
        assert!(text(&output.stderr).contains(words), "{args:?}: {}", text(&output.stderr));
    }
    assert_eq!(std::fs::read_to_string(folder.join("mine.toml")).unwrap(), "mine");
    assert_eq!(std::fs::read_dir(&folder).unwrap().count(), 1);
}

#[test]
fn mistakes_are_told_all_at_once_and_parameters_that_nothing_uses_too() {
    let folder = folder("begin-mistakes");
    gyro(&folder, &["new", "swing"]);
    let page = std::fs::read_to_string(folder.join("swing.toml")).unwrap();
    let bad = page.replace("mass * length^2 / 12", "mass * lenght^2 / 12").replace("revolute", "revolut");
    std::fs::write(folder.join("bad.toml"), bad).unwrap();
    let output = gyro(&folder, &["check", "bad.toml"]);
    assert_eq!(output.status.code(), Some(2));
    for words in ["unknown parameter `lenght`", "bad.toml:", "write `length`", "revolut"] {
        assert!(text(&output.stderr).contains(words), "{words}: {}", text(&output.stderr));
    }
    std::fs::write(folder.join("idle.toml"), page.replace("mass = 2", "mass = 2\nidle = 1")).unwrap();
    let output = gyro(&folder, &["check", "idle.toml"]);
    assert!(output.status.success() && text(&output.stderr).contains("the parameter `idle` is used nowhere"));
    let set = |setting| gyro(&folder, &["simulate", "swing.toml", "--engine", "assembled", "--set", setting]);
    let output = set("moment=1");
    assert_eq!(output.status.code(), Some(2));
    assert!(text(&output.stderr).contains("set `length`, `mass`"), "{}", text(&output.stderr));
    assert!(set("length=0.5").status.success());
}
