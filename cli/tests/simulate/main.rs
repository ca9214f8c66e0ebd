//! `gyro simulate` from the outside: what it prints, writes and returns.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

mod bearings;
mod bushings;
mod cells;
mod closed_loops;
mod contacts;
mod controllers;
mod curves;
mod defaults;
mod edges;
mod elements;
mod events;
mod excavator;
mod followed;
mod gravity;
mod inputs;
mod interrupted;
mod kinks;
mod laws;
mod lengths;
mod loads;
mod orientation;
mod plants;
mod rates;
mod refusals;
mod rigid;
mod rolling;
mod rolling_bodies;
mod states;
mod stops;
mod support;
mod tops;
mod touching;
mod verdicts;

use crate::inputs::MOTOR;
use crate::support::{Folder, json, model, simulate, xtask};
use serde_json::Value;
use std::fs;

/// Integration to 1e-11, and rounding of two orders of evaluation.
const ENGINES_AGREE: f64 = 1e-10;

#[test]
fn json_is_one_object_and_both_engines_give_the_same() {
    let folder = Folder::new("json");
    let page = model("gyroscope-parameters.toml");
    let run = |engine| {
        // Between corrections generated code takes a shorter way, with roundings and truncations of its own.
        let scene = [&page, "--engine", engine, "--t-end", "0.05", "--set", "rotor_offset=0.0002"];
        json(&folder, &[&scene[..], &["--method", "direct", "--step", "1e-4"]].concat())
    };
    let (generated, assembled) = (run("generated"), run("assembled"));
    let mut keys: Vec<&String> = assembled.as_object().unwrap().keys().collect();
    keys.sort();
    assert_eq!(
        keys,
        [
            "chart_switches",
            "chosen",
            "components",
            "constraint_violation",
            "coordinates",
            "correction",
            "corrections",
            "degrees_of_freedom",
            "energy",
            "energy_drift",
            "engine",
            "evaluations",
            "events",
            "files",
            "inputs",
            "integrator",
            "jacobians",
            "joints",
            "kinks_crossed",
            "method",
            "model",
            "norm_violation",
            "outputs",
            "poses_passed",
            "poses_stepped_over",
            "proof",
            "redundant",
            "rejected_steps",
            "run_time_s",
            "step",
            "steps",
            "steps_limited_by_stability",
            "t",
            "tolerance",
            "velocity_violation",
            "warnings"
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
fn a_run_is_judged_and_linearised() {
    let folder = Folder::new("judged");
    let page = model("gyroscope-parameters.toml");
    let judged = json(&folder, &[&page, "--t-end", "0.05", "--verify"]);
    let verdict = &judged["verdict"];
    for joint in ["alpha", "beta", "phi"] {
        let error = verdict["estimated_errors"][joint].as_f64().unwrap();
        assert!(error > 0.0 && error < 1e-9, "{joint}: {verdict}");
    }
    assert_eq!(verdict["grade"], "good", "{verdict}");
    let joint = ["--coordinates", "joint", "--integrator", "dop853", "--tolerance", "1e-9"];
    let linear = json(&folder, &[&[&page, "--linearize", "0.05"][..], &joint].concat());
    // The rotor has turned by five radians, more than half a turn.
    let phi = |run: &Value| run["joints"]["phi"]["position"].as_f64().unwrap();
    let difference = linear["linearization"]["state"][2].as_f64().unwrap() - phi(&linear);
    assert!(difference.abs() < 1e-9 && phi(&linear) > 4.0, "{linear}");
    let linear = &linear["linearization"];
    assert_eq!(linear["A"].as_array().unwrap().len(), 6);
    // The nutation of the paper's scene.
    let fastest = linear["eigenvalues"][0][1].as_f64().unwrap();
    assert!((fastest - 144.31).abs() < 0.1, "{linear}");
    // At the start, where nothing has moved yet.
    let start = json(&folder, &[&[&page, "--linearize", "0", "--out", "."][..], &joint].concat());
    assert_eq!((start["t"].as_f64(), start["steps"].as_u64()), (Some(0.0), Some(0)));
    let fastest = start["linearization"]["eigenvalues"][0][1].as_f64().unwrap();
    assert!((fastest - 144.31).abs() < 0.1, "{start}");
    assert_eq!(folder.files(), ["gyroscope_parameters-linearized.csv"], "one sample has no plots");
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
fn redundant_rows_are_warned_of_listed_and_refused_if_strict() {
    let folder = Folder::new("redundant");
    let page = model("four-bar-revolute.toml");
    let args = [&page[..], "--engine", "assembled", "--t-end", "0.05"];
    let output = simulate(&folder, &args);
    let (warnings, text) =
        (String::from_utf8(output.stderr).unwrap(), String::from_utf8(output.stdout).unwrap());
    assert_eq!(warnings.lines().filter(|line| line.starts_with("warning: ")).count(), 1, "{warnings}");
    // In a planar linkage the loads in its plane are unique.
    let words = "not unique: force_h, torque_f, torque_g of `crank_pivot`, `rocker_pivot`, `elbow`, `knee`";
    assert!(warnings.contains("row 3 (d z) of joint `knee`") && warnings.contains(words), "{warnings}");
    let marked: Vec<_> = text.lines().filter(|line| line.contains("not unique")).collect();
    assert!(
        marked.iter().all(|line| ["force_h", "torque_f", "torque_g"].iter().any(|n| line.contains(n))),
        "{text}"
    );
    for words in ["1 degree of freedom, 3 redundant rows dropped", "moved to close", "elbow.angle"] {
        assert!(text.contains(words), "{words} is missing in\n{text}");
    }
    let run = json(&folder, &args);
    let rows: Vec<u64> =
        run["redundant"].as_array().unwrap().iter().map(|r| r["row"].as_u64().unwrap()).collect();
    assert_eq!((rows, &run["redundant"][0]["name"]), (vec![3, 4, 5], &Value::from("knee")));
    let strict = simulate(&folder, &[&args[..], &["--strict"]].concat());
    let words = String::from_utf8(strict.stderr).unwrap();
    assert!(words.contains("has 3 redundant constraint rows, refused by --strict"), "{words}");
    assert_eq!(strict.status.code(), Some(2));
    let module = ["generate", &page[..], "--out", "x.rs"];
    assert!(xtask(&folder, &module).status.success());
    fs::remove_file(folder.0.join("x.rs")).unwrap();
    let strict = xtask(&folder, &[&module[..], &["--strict"]].concat());
    assert!(strict.status.code() == Some(2) && !folder.0.join("x.rs").exists());
}

/// A block that is welded to the wall, with gravity and a lever.
const WELD: &str = r#"format = 1
name = "weld"
gravity = [0, 0, -9.81]
[simulation]
t_end = 1
step = 1e-3
[[body]]
name = "wall"
fixed = true
[[body]]
name = "block"
mass = 1
inertia = [0.3, 0.3, 0.5]
[[joint]]
name = "glue"
kind = "fixed"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "wall", point = [0.3, 0.2, 0.1] }
second = { body = "block", point = [0.1, -0.2, 0.33] }
"#;

#[test]
fn a_body_that_cannot_move_has_no_energy_drift() {
    let folder = Folder::new("weld");
    fs::write(folder.0.join("weld.toml"), WELD).unwrap();
    for args in [&["--method", "direct"][..], &["--precision", "f32"], &[]] {
        let run = json(&folder, &[&["weld.toml", "--engine", "assembled"][..], args].concat());
        assert!(run["energy_drift"].as_f64().unwrap() < 1e-3, "{args:?}: {}", run["energy_drift"]);
        assert_eq!(run["warnings"], Value::Array(vec![]), "{args:?}");
    }
}

#[test]
fn a_budget_ends_fixed_steps() {
    let folder = Folder::new("budget");
    fs::write(folder.0.join("motor.toml"), MOTOR).unwrap();
    let run = ["motor.toml", "--engine", "assembled", "--step", "1e-3", "--json"];
    let output = simulate(&folder, &[&run[..], &["--budget", "700"]].concat());
    let words = String::from_utf8(output.stderr).unwrap();
    assert!(words.contains("the budget of 700 steps is used up; try --budget 2000"), "{words}");
    assert_eq!(output.status.code(), Some(1));
    assert!(simulate(&folder, &[&run[..], &["--budget", "2000"]].concat()).status.success());
}

#[test]
fn what_drivers_determine_is_judged_and_linearised() {
    let folder = Folder::new("driven");
    let cam = model("../tests/models/cam.toml");
    let judged = json(&folder, &[&cam, "--engine", "jit", "--t-end", "0.1", "--verify"]);
    assert_eq!(judged["verdict"]["grade"], "good", "{}", judged["verdict"]);
    let linear = json(&folder, &[&cam, "--engine", "jit", "--linearize", "0"]);
    assert_eq!(linear["linearization"]["eigenvalues"], Value::Array(Vec::new()), "{linear}");
}
