//! Events in model files and on the command line.

use crate::support::{Folder, json, refused, simulate};
use serde_json::Value;
use std::fs;

/// ẍ = −x in two masses on springs, 90° apart: sines and cosines.
const OSCILLATORS: &str = r#"format = 1
name = "oscillators"
[simulation]
t_end = 7
step = 1e-3
[parameters]
level = 0.5
[[body]]
name = "ground"
fixed = true
[[body]]
name = "first"
mass = 1
inertia = [1, 1, 1]
[[body]]
name = "second"
mass = 1
inertia = [1, 1, 1]
[[joint]]
name = "sine"
kind = "prismatic"
axis = [1, 0, 0]
zero = [0, 1, 0]
first = { body = "ground" }
second = { body = "first" }
rate = 1
[[joint]]
name = "cosine"
kind = "prismatic"
axis = [1, 0, 0]
zero = [0, 1, 0]
first = { body = "ground" }
second = { body = "second" }
displacement = 1
[[force]]
name = "first_spring"
kind = "spring"
joint = "sine"
stiffness = 1
[[force]]
name = "second_spring"
kind = "spring"
joint = "cosine"
stiffness = 1
[[output]]
name = "place"
kind = "pose"
body = "first"
[[event]]
name = "half"
of = "sine"
level = "level"
[[event]]
name = "equal"
of = "sine"
minus = "cosine"
[[event]]
name = "formula"
of = "(sine rate * cosine) - 2*level^2 / 2"
[[event]]
name = "turning"
of = "cosine rate"
direction = "falling"
[[event]]
name = "output"
of = "place.rx"
level = -0.5
direction = "rising"
"#;

const PI: f64 = std::f64::consts::PI;

/// In order of time; sin and cos are equal at π/4 and 5π/4, sin is ½ at π/6 and 5π/6; cos² is
/// ¼ at π/3 and its like.
const EXPECTED: [(f64, &str, &str); 11] = [
    (PI / 6.0, "half", "rises"),
    (PI / 4.0, "equal", "rises"),
    (PI / 3.0, "formula", "falls"),
    (2.0 * PI / 3.0, "formula", "rises"),
    (5.0 * PI / 6.0, "half", "falls"),
    (5.0 * PI / 4.0, "equal", "falls"),
    (4.0 * PI / 3.0, "formula", "falls"),
    (5.0 * PI / 3.0, "formula", "rises"),
    (11.0 * PI / 6.0, "output", "rises"),
    (2.0 * PI, "turning", "falls"),
    (2.0 * PI + PI / 6.0, "half", "rises"),
];

fn compare(run: &Value, close: f64) {
    let found = run["events"].as_array().unwrap();
    assert_eq!(found.len(), EXPECTED.len(), "{found:?}");
    for (found, (t, name, what)) in found.iter().zip(EXPECTED) {
        let error = found["t"].as_f64().unwrap() - t;
        assert!(found["name"] == name && found["what"] == what && error.abs() < close, "{found}: {error:e}");
    }
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn events_are_found_by_all_engines_and_methods() {
    let folder = Folder::new("events");
    fs::write(folder.0.join("oscillators.toml"), OSCILLATORS).unwrap();
    let fine = ["--integrator", "dop853", "--tolerance", "1e-13"];
    let joint = ["--engine", "jit", "--coordinates", "joint"];
    for (args, close) in [
        ([&["--engine", "jit", "--coordinates", "maximal"][..], &fine].concat(), 1e-11),
        ([&joint[..], &fine].concat(), 1e-11),
        ([&joint[..], &["--integrator", "tsit5", "--tolerance", "1e-9"]].concat(), 1e-7),
        ([&joint[..], &["--integrator", "rodas4", "--tolerance", "1e-9"]].concat(), 1e-6),
        ([&["--engine", "assembled"][..], &fine].concat(), 1e-11),
        ([&["--engine", "assembled"][..], &fine, &["--correction", "none"]].concat(), 1e-11),
        ([&["--engine", "assembled", "--step", "1e-3"][..]].concat(), 1e-9),
        ([&joint[..], &["--step", "1e-3"]].concat(), 1e-9),
    ] {
        compare(&json(&folder, &[&["oscillators.toml"], &args[..]].concat()), close);
    }
}

#[test]
fn a_run_ends_at_an_event_and_lists_are_written() {
    let folder = Folder::new("events-stop");
    fs::write(folder.0.join("oscillators.toml"), OSCILLATORS).unwrap();
    let end = PI / 3.0 + PI;
    for method in [&["--integrator", "dop853", "--tolerance", "1e-12"][..], &["--step", "1e-3"]] {
        let stop = ["--event", "cosine>-0.5:stop", "--out", "."];
        let args = [&["oscillators.toml", "--engine", "assembled"], method, &stop].concat();
        let run = json(&folder, &args);
        assert!((run["t"].as_f64().unwrap() - end).abs() < 1e-9, "{}", run["t"]);
        assert!(
            (run["joints"]["cosine"]["position"].as_f64().unwrap() + 0.5).abs() < 1e-12,
            "{}",
            run["joints"]
        );
        assert_eq!(run["events"].as_array().unwrap().last().unwrap()["name"], "cosine>-0.5:stop");
        let list = fs::read_to_string(folder.0.join("oscillators-events.csv")).unwrap();
        assert!(list.starts_with("t [s],event,what,rate before,rate after\n5.235987"), "{list}");
        assert_eq!(list.lines().count(), 1 + run["events"].as_array().unwrap().len());
        let text = simulate(&folder, &args);
        let text = String::from_utf8(text.stdout).unwrap();
        assert!(text.contains("ended by event cosine>-0.5:stop") && text.contains("\nevents\n"), "{text}");
    }
}

#[test]
fn what_cannot_be_seen_is_refused() {
    let folder = Folder::new("events-refused");
    fs::write(folder.0.join("oscillators.toml"), OSCILLATORS).unwrap();
    let run = |event| simulate(&folder, &["oscillators.toml", "--engine", "assembled", "--event", event]);
    refused(&run("sinus=0"), "`sinus` names nothing that moves and no parameter; write `sine`");
    refused(&run("2*sine rate - cosinus>0"), "`cosinus` names nothing that moves");
    refused(&run("(sine=0"), "close the parenthesis");
    refused(&run("2*level=0"), "names nothing that moves");
    refused(&run("cosinus(sine)=0"), "there is no function `cosinus`");
    refused(&run("sine"), "a column or a formula of some, =, > or <, and a level were expected");
    refused(&run("sine-=0"), "write a number, a name or a parenthesis after the last operator");
    let root = run("sqrt(sine - 2)=0");
    let said = String::from_utf8_lossy(&root.stderr);
    assert!(
        root.status.code() == Some(1) && said.contains("the formula of an event is no longer finite"),
        "{said}"
    );
    refused(&run("sine=much"), "`much` is not a decimal number");
}
