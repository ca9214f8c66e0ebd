//! What is refused, and runs that fail.

use crate::inputs::{MOTOR, TABLE, TABLED};
use crate::support::{Folder, model, refused, simulate, xtask};
use serde_json::Value;
use std::fs;

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

/// A cart that runs into the wall to which a string ties it.
const MEETING: &str = r#"
format = 1
name = "meeting"
[[body]]
name = "wall"
fixed = true
[[body]]
name = "cart"
mass = 1
inertia = [1, 1, 1]
[[joint]]
name = "rail"
kind = "prismatic"
first = { body = "wall" }
second = { body = "cart" }
axis = [1, 0, 0]
zero = [0, 1, 0]
[[driver]]
name = "winch"
joint = "rail"
motion = { polynomial = [1, -1] }
[[force]]
name = "chain"
kind = "link"
first = { body = "wall", point = [0, 0, 3] }
second = { body = "cart", point = [0, 0, 2] }
damping = 1
[[force]]
name = "string"
kind = "link"
first = { body = "wall" }
second = { body = "cart" }
stiffness = 1
free_length = 0.3
[simulation]
coordinates = "maximal"
method = "rk4"
t_end = 2
step = 0.25
correct_every = 0.25
sample_every = 0.25
"#;

#[test]
fn a_link_whose_ends_come_together_during_a_run_is_named_in_every_engine() {
    let folder = Folder::new("meeting");
    fs::write(folder.0.join("meeting.toml"), MEETING).unwrap();
    for engine in ["generated", "assembled"] {
        let output = simulate(&folder, &["meeting.toml", "--engine", engine, "--json"]);
        let words = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{engine}: {words}");
        assert!(words.contains("no longer finite") && words.contains("at t = 0.75 s"), "{engine}: {words}");
        assert!(words.contains("The ends of link `string` come together"), "{engine}: {words}");
    }
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

#[test]
fn inputs_and_the_files_of_others_are_not_overwritten() {
    let folder = Folder::new("spared");
    fs::write(folder.0.join("shaken.toml"), TABLED).unwrap();
    fs::write(folder.0.join("shaken.csv"), TABLE).unwrap();
    let run = |out: &str| simulate(&folder, &["shaken.toml", "--engine", "assembled", "--out", out]);
    refused(&run("."), "shaken.csv is read by this run");
    assert_eq!(fs::read_to_string(folder.0.join("shaken.csv")).unwrap(), TABLE);
    assert_eq!(folder.files(), ["shaken.csv", "shaken.toml"]);
    // What a run has written another may replace, until somebody else has.
    for _ in 0..2 {
        assert!(run("out").status.success());
    }
    let plot = folder.0.join("out").join("shaken-motion.svg");
    fs::write(&plot, "mine").unwrap();
    refused(&run("out"), "shaken-motion.svg exists");
    assert_eq!(fs::read_to_string(&plot).unwrap(), "mine");
}

/// The motor's shaft in a bearing whose drag is an input.
fn dragged() -> String {
    let damper = "[[force]]\nname = \"bearing\"\nkind = \"damper\"\njoint = \"shaft\"\ndamping = \"drag\"\n";
    MOTOR.replace("push = 0\n", "push = 0\ndrag = 0.1\n") + damper
}

#[test]
fn what_cannot_be_done_is_refused_by_one_code_and_leaves_no_folder() {
    let folder = Folder::new("refused");
    fs::write(folder.0.join("motor.toml"), dragged()).unwrap();
    fs::write(folder.0.join("drag.csv"), "t,drag\n0,1\n1,-0.5\n2,1\n").unwrap();
    fs::write(folder.0.join("tiny.toml"), dragged().replace("step = 1e-3", "method = \"rk4\"\nstep = 1e-12"))
        .unwrap();
    fs::write(folder.0.join("ramp.csv"), "t,torque\n0,0\n1,2\n").unwrap();
    let assembled = ["motor.toml", "--engine", "assembled"];
    let controlled = ["--integrator", "dop853", "--tolerance"];
    let negative = "the damping of force `bearing` is negative";
    for (args, message) in [
        (&["--input", "drag=-1"][..], negative),
        (&["--input", "drag=drag.csv"], "with -0.5 at t = 1 s the damping"),
        (&["--input", "torque=1e300"], "input `torque` is too large or too small to compute with"),
        (&["--coordinates", "joint"], "runtime-assembled models run in maximal coordinates"),
        (&["--correction", "closed-form"], "the closed form is for generated code with joint coordinates"),
        (&["--linearize", "0.5"], "--linearize is about joint coordinates"),
        (&["--integrator", "rodas4"], "rodas4 needs derivatives"),
        (&["--integrator", "rk4", "--tolerance", "1e-9"], "rk4 has no error estimate"),
        (&[&controlled[..], &["nan"]].concat(), "a number above 0 and at most 1 was expected"),
        (&[&controlled[..], &["1e-16"]].concat(), "a tolerance of 1e-16 cannot be met"),
        (&[&controlled[..], &["1e-9", "--precision", "f32"]].concat(), "a tolerance of 1e-9 cannot be met"),
        (&["--step", "1e-12"], "steps of 1e-12 s, about"),
        (&["--step", "1e-15"], "at most 1e13 are accepted"),
    ] {
        let output = simulate(&folder, &[&assembled[..], args, &["--out", "new/folder"]].concat());
        let words = String::from_utf8(output.stderr).unwrap();
        assert!(words.contains(message), "{args:?}: {words}");
        assert!(output.status.code() == Some(2) && output.stdout.is_empty(), "{args:?}");
    }
    // The same in the model file, and said by the program that was compiled.
    let output = simulate(&folder, &["tiny.toml", "--out", "new"]);
    let words = String::from_utf8(output.stderr).unwrap();
    assert!(words.contains("will take about") && words.contains("give --budget"), "{words}");
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(folder.files(), ["drag.csv", "motor.toml", "ramp.csv", "tiny.toml"]);
}

#[test]
fn the_same_mistake_has_the_same_code_in_every_command() {
    let folder = Folder::new("codes");
    fs::write(folder.0.join("motor.toml"), MOTOR).unwrap();
    fs::write(folder.0.join("bad.toml"), "format = 1\nnam = \"x\"\n").unwrap();
    fs::write(folder.0.join("bytes.toml"), [0xff, 0xfe]).unwrap();
    let commands: [&[&str]; 7] = [
        &["simulate"],
        &["generate", "--out", "x.rs"],
        &["generate", "--check", "--out", "x.rs"],
        &["inspect", "--no-compile"],
        &["verify"],
        &["verify", "--rounding"],
        &["report"],
    ];
    for command in commands {
        for page in ["none.toml", "bad.toml", "bytes.toml", "."] {
            let output = xtask(&folder, &[command, &[page]].concat());
            assert_eq!(output.status.code(), Some(2), "{command:?} {page}");
        }
        let output = xtask(&folder, &[command, &["motor.toml", "--nonsense"]].concat());
        assert_eq!(output.status.code(), Some(2), "{command:?} --nonsense");
    }
    let out: [&[&str]; 3] = [&["simulate", "--engine", "assembled"], &["generate"], &["report", "--quick"]];
    for command in out {
        let output = xtask(&folder, &[command, &["motor.toml", "--out", "bad.toml/x"]].concat());
        assert_eq!(output.status.code(), Some(2), "{command:?} --out");
    }
    assert_eq!(folder.files(), ["bad.toml", "bytes.toml", "motor.toml"]);
}

#[test]
fn a_worthless_result_has_a_code_of_its_own() {
    let folder = Folder::new("worthless");
    let page = model("compound-pendulum.toml");
    // No verdict is asked for: the energy tells.
    let run = |step: &str, args: &[&str]| {
        let run = [
            &page,
            "--engine",
            "assembled",
            "--method",
            "direct",
            "--t-end",
            "5",
            "--step",
            step,
            "--every",
            step,
        ];
        simulate(&folder, &[&run[..], args].concat())
    };
    let worthless = run("0.3", &["--json", "--out", "."]);
    let words = String::from_utf8(worthless.stderr).unwrap();
    assert!(words.contains("the result is worthless. The energy balance is open by 5.3e-1"), "{words}");
    assert_eq!(worthless.status.code(), Some(3));
    let object: Value = serde_json::from_slice(&worthless.stdout).unwrap();
    assert!(object["warnings"][0].as_str().unwrap().contains("energy balance"), "{object}");
    assert!(folder.files().contains(&"compound_pendulum.csv".to_owned()), "{:?}", folder.files());
    let doubtful = run("0.1", &["--json"]);
    let words = String::from_utf8(doubtful.stderr).unwrap();
    assert!(words.starts_with("warning: ") && words.contains("--verify tells how far"), "{words}");
    assert!(doubtful.status.success());
    let fine = run("0.01", &["--json"]);
    assert!(fine.status.success() && fine.stderr.is_empty());
}

#[test]
fn an_engine_without_joint_coordinates_says_so() {
    let folder = Folder::new("joint");
    let check = |page: &str, engine: &str, words: &str| {
        let output = simulate(&folder, &[&model(page), "--engine", engine, "--coordinates", "joint"]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && said.contains(words), "{page} {engine}: {said}");
    };
    check("compound-pendulum.toml", "assembled", "leave out --engine");
    check("four-bar.toml", "assembled", "leave out --engine");
}
