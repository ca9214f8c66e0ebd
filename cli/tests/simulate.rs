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

fn model(name: &str) -> String {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../models").join(name).display().to_string()
}

fn xtask(folder: &Folder, args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gyro")).args(args).current_dir(&folder.0).output().unwrap()
}

fn simulate(folder: &Folder, args: &[&str]) -> Output {
    xtask(folder, &[&["simulate"], args].concat())
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
        // Between corrections generated code takes a shorter way, with roundings and truncations of its own.
        let scene = [&page, "--engine", engine, "--t-end", "0.05", "--set", "rotor_offset=0.0002"];
        json(&folder, &[&scene[..], &["--method", "direct"]].concat())
    };
    let (generated, assembled) = (run("generated"), run("assembled"));
    let mut keys: Vec<&String> = assembled.as_object().unwrap().keys().collect();
    keys.sort();
    assert_eq!(
        keys,
        [
            "chart_switches",
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
            "files",
            "inputs",
            "integrator",
            "jacobians",
            "joints",
            "method",
            "model",
            "outputs",
            "poses_passed",
            "poses_stepped_over",
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
    assert_eq!(folder.files(), ["gyroscope_parameters.csv"], "one sample has no plots");
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

/// The name is that of something which programs around a mechanism use. A disc on a shaft that a motor turns, J = 0.5 kg·m², with a sledge that slides on a table beside it.
const MOTOR: &str = r#"format = 1
name = "tree_with_jacobian"
[simulation]
t_end = 2
step = 1e-3
[inputs]
torque = 3
push = 0
[[body]]
name = "frame"
fixed = true
[[body]]
name = "disc"
mass = 1
inertia = [0.3, 0.3, 0.5]
[[body]]
name = "sledge"
mass = 2
inertia = [0.1, 0.1, 0.1]
[[joint]]
name = "shaft"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "frame" }
second = { body = "disc" }
[[joint]]
name = "table"
kind = "planar"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "frame" }
second = { body = "sledge" }
rate = [0.5, 0, 7]
[[force]]
name = "motor"
kind = "motor"
joint = "shaft"
value = "torque"
[[force]]
name = "pusher"
kind = "motor"
joint = "table"
coordinate = "y"
value = "push"
[[output]]
name = "spin"
kind = "velocity"
body = "disc"
[[output]]
name = "energies"
kind = "energy"
"#;

fn close(found: &Value, expected: f64) {
    let found = found.as_f64().unwrap();
    assert!((found - expected).abs() < 1e-9 * expected.abs().max(1.0), "{found} for {expected}");
}

#[test]
fn inputs_come_from_the_page_from_numbers_and_from_tables() {
    let folder = Folder::new("inputs");
    fs::write(folder.0.join("motor.toml"), MOTOR).unwrap();
    fs::write(folder.0.join("ramp.csv"), "t,torque\n0,0\n1,2\n").unwrap();
    let run = |args: &[&str]| {
        json(&folder, &[&["motor.toml", "--engine", "assembled", "--every", "0.5"], args].concat())
    };
    let constant = run(&["--input", "push=0.5"]);
    close(&constant["joints"]["shaft"]["rate"], 3.0 / 0.5 * 2.0);
    close(&constant["joints"]["shaft"]["position"], 3.0 / 0.5 * 2.0);
    // Coordinates x, y, angle, of which the last has turned more than twice.
    for (k, (position, rate)) in [(1.0, 0.5), (0.5, 0.5), (14.0, 7.0)].into_iter().enumerate() {
        close(&constant["joints"]["table"]["position"][k], position);
        close(&constant["joints"]["table"]["rate"][k], rate);
    }
    close(&constant["outputs"]["spin"][5], 12.0);
    close(&constant["outputs"]["energies"][0], 0.25 * 144.0 + 0.25 + 0.25 + 0.05 * 49.0);
    assert_eq!(constant["degrees_of_freedom"], 4);
    let generated = json(&folder, &["motor.toml", "--input", "torque=ramp.csv", "--every", "0.5"]);
    // The ramp is held over each of its thousand steps, then stays: Σ 2 k/1000 · 1e-3 = 0.999, and 2 N·m for a second.
    let ramp = run(&["--input", "torque=ramp.csv"]);
    for run in [&ramp, &generated] {
        close(&run["joints"]["shaft"]["rate"], (0.999 + 2.0) / 0.5);
    }
    assert_eq!(generated["engine"], "generated");
}

#[test]
fn columns_have_the_names_of_coordinates_and_outputs() {
    let folder = Folder::new("columns");
    fs::write(folder.0.join("motor.toml"), MOTOR).unwrap();
    let output =
        simulate(&folder, &["motor.toml", "--engine", "assembled", "--out", ".", "--input", "push=0.5"]);
    let text = String::from_utf8(output.stdout).unwrap();
    for words in [
        "dense form",
        "4 degrees of freedom",
        "input torque = 3.0",
        "input push = 0.5",
        "table.angle",
        "spin.wz",
    ] {
        assert!(text.contains(words), "{words} is missing in\n{text}");
    }
    assert!(!text.contains("linear theory"), "{text}");
    let table = fs::read_to_string(folder.0.join("tree_with_jacobian.csv")).unwrap();
    let header = table.lines().next().unwrap();
    let expected = "t [s],torque [N*m],push [N],shaft [rad],shaft rate [rad/s],table.x [m],table.x rate [m/s],table.y [m],table.y rate [m/s],\
                    table.angle [rad],table.angle rate [rad/s],spin.vx [m/s],spin.vy [m/s],spin.vz [m/s],spin.wx [rad/s],\
                    spin.wy [rad/s],spin.wz [rad/s],energies.kinetic [J],energies.potential [J],kinetic energy [J],";
    assert!(header.starts_with(expected), "{header}");
    let motion = fs::read_to_string(folder.0.join("tree_with_jacobian-motion.svg")).unwrap();
    assert!(motion.contains("table.x [m]") && motion.contains("table.angle [rad]"));
    assert!(folder.files().contains(&"tree_with_jacobian-outputs.svg".to_owned()));
}

#[test]
fn bad_inputs_are_told_with_their_line() {
    let folder = Folder::new("bad-inputs");
    fs::write(folder.0.join("motor.toml"), MOTOR).unwrap();
    fs::write(folder.0.join("back.csv"), "t,torque\n0,0\n1,2\n1,3\n").unwrap();
    fs::write(folder.0.join("word.csv"), "t,torque\n0,zero\n").unwrap();
    let gyroscope = model("gyroscope.toml");
    for (page, inputs, message) in [
        ("motor.toml", &["torqe=1"][..], "unknown input `torqe`: write `torque`; there are `torque`, `push`"),
        ("motor.toml", &["torque=none.csv"], "--input torque=none.csv: the file cannot be read"),
        ("motor.toml", &["torque=back.csv"], "torque=back.csv: line 4: the time 1.0 does not follow 1.0"),
        ("motor.toml", &["torque=word.csv"], "torque=word.csv: line 2: found `zero`"),
        ("motor.toml", &["torque=1", "torque=2"], "--input gives `torque` twice"),
        (&gyroscope, &["torque=1"], "has no inputs"),
    ] {
        let given: Vec<&str> = inputs.iter().flat_map(|input| ["--input", *input]).collect();
        let output = simulate(&folder, &[&[page, "--json"], &given[..]].concat());
        let words = String::from_utf8(output.stderr).unwrap();
        assert!(words.contains(message), "{inputs:?}: {words}");
        assert!(output.status.code() == Some(2) && output.stdout.is_empty(), "{inputs:?}");
    }
}

#[test]
fn redundant_rows_are_warned_of_listed_and_refused_if_strict() {
    let folder = Folder::new("redundant");
    let page = model("four-bar-revolute.toml");
    let args = [&page[..], "--engine", "assembled", "--t-end", "0.05"];
    let output = simulate(&folder, &args);
    let (warnings, text) =
        (String::from_utf8(output.stderr).unwrap(), String::from_utf8(output.stdout).unwrap());
    assert_eq!(warnings.lines().filter(|line| line.starts_with("warning: ")).count(), 3, "{warnings}");
    assert!(warnings.contains("row 3 (d z) of joint `knee` depends on joint `crank_pivot`"), "{warnings}");
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

/// A pendulum whose pivot is moved along x as a table beside the page says.
const SHAKEN: &str = r#"format = 1
name = "shaken"
[simulation]
t_end = 1
[[body]]
name = "cart"
driven = { translation = [{ table = "motions/shake.csv" }, 0, 0] }
[[body]]
name = "plate"
mass = 0.1
inertia = [1e-4, 1e-4, 2e-4]
[[joint]]
name = "slide"
kind = "prismatic"
axis = [0, 1, 0]
zero = [1, 0, 0]
first = { body = "cart" }
second = { body = "plate" }
rate = 0.25
[[output]]
name = "pose"
kind = "pose"
body = "plate"
"#;

#[test]
fn tables_of_motions_lie_beside_the_page() {
    let folder = Folder::new("tables");
    let pages = folder.0.join("pages");
    fs::create_dir_all(pages.join("motions")).unwrap();
    fs::write(pages.join("shaken.toml"), SHAKEN).unwrap();
    let missing = simulate(&folder, &["pages/shaken.toml"]);
    let words = String::from_utf8(missing.stderr).unwrap();
    assert!(words.contains("motions/shake.csv") && words.contains("cannot be read"), "{words}");
    fs::write(pages.join("motions/shake.csv"), "t,x\n0,0\n1,0.02\n2,0.04").unwrap();
    let run = json(&folder, &["pages/shaken.toml", "--engine", "assembled"]);
    close(&run["outputs"]["pose"][0], 0.02);
    close(&run["outputs"]["pose"][1], 0.25);
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
t_end = 2
step = 0.25
correct_every = 0.25
sample_every = 0.25
"#;

#[test]
fn a_link_whose_ends_come_together_during_a_run_is_named_in_every_engine() {
    let folder = Folder::new("meeting");
    fs::write(folder.0.join("meeting.toml"), MEETING).unwrap();
    for engine in ["generated", "assembled", "dense"] {
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

/// A body on a table that follows `shaken.csv`, which is also the name of what a run writes.
const TABLED: &str = "format = 1
name = \"shaken\"
[simulation]
t_end = 0.01
[[body]]
name = \"table\"
driven = { translation = [{ table = \"shaken.csv\" }, 0, 0] }
[[body]]
name = \"plate\"
mass = 0.1
inertia = [1e-4, 1e-4, 2e-4]
[[joint]]
name = \"slide\"
kind = \"prismatic\"
axis = [1, 0, 0]
zero = [0, 1, 0]
first = { body = \"table\" }
second = { body = \"plate\" }
";

const TABLE: &str = "t,x\n0,0\n1,0.01\n2,0\n";

fn refused(output: &Output, words: &str) {
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.code() == Some(2) && said.contains(words), "{said}");
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

#[test]
#[cfg(unix)]
fn tables_and_inputs_are_files() {
    let folder = Folder::new("pipes");
    fs::write(folder.0.join("shaken.toml"), TABLED).unwrap();
    assert!(Command::new("mkfifo").arg(folder.0.join("shaken.csv")).status().unwrap().success());
    refused(&simulate(&folder, &["shaken.toml", "--engine", "assembled"]), "a pipe or a device");
    refused(&simulate(&folder, &["shaken.csv"]), "a pipe or a device");
    let page = model("../tests/models/motor.toml");
    let input = ["--input", "torque=/dev/zero", "--engine", "assembled"];
    refused(&simulate(&folder, &[&[page.as_str()], &input[..]].concat()), "a pipe or a device");
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
    fs::write(folder.0.join("tiny.toml"), dragged().replace("step = 1e-3", "step = 1e-12")).unwrap();
    fs::write(folder.0.join("ramp.csv"), "t,torque\n0,0\n1,2\n").unwrap();
    let assembled = ["motor.toml", "--engine", "assembled"];
    let controlled = ["--integrator", "dop853", "--tolerance"];
    let negative = "the damping of force `bearing` is negative";
    for (args, message) in [
        (&["--input", "drag=-1"][..], negative),
        (&["--input", "drag=drag.csv"], "with -0.5 at t = 1 s the damping"),
        (&["--input", "torque=1e300"], "input `torque` is too large or too small to compute with"),
        (&["--coordinates", "joint"], "the twins run in maximal coordinates"),
        (&["--correction", "closed-form"], "the closed form is for generated code of trees"),
        (&["--linearize", "0.5"], "--linearize is about joint coordinates"),
        (&["--integrator", "rodas4"], "rodas4 needs derivatives"),
        (&["--tolerance", "1e-9"], "rk4 has no error estimate"),
        (&[&controlled[..], &["nan"]].concat(), "a number above 0 and at most 1 was expected"),
        (&[&controlled[..], &["1e-16"]].concat(), "a tolerance of 1e-16 cannot be met"),
        (&[&controlled[..], &["1e-9", "--precision", "f32"]].concat(), "a tolerance of 1e-9 cannot be met"),
        (&[&controlled[..], &["1e-9", "--input", "torque=ramp.csv"]].concat(), "inputs that vary are held"),
        (&["--step", "1e-12"], "steps of 1e-12 s, about"),
        (&["--step", "1e-15"], "at most 1e13 are accepted"),
    ] {
        let output = simulate(&folder, &[&assembled[..], args, &["--out", "new/folder"]].concat());
        let words = String::from_utf8(output.stderr).unwrap();
        assert!(words.contains(message), "{args:?}: {words}");
        assert!(output.status.code() == Some(2) && output.stdout.is_empty(), "{args:?}");
    }
    // The same in the page, and said by the program that was compiled.
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
    let run = ["motor.toml", "--engine", "assembled", "--json"];
    let output = simulate(&folder, &[&run[..], &["--budget", "700"]].concat());
    let words = String::from_utf8(output.stderr).unwrap();
    assert!(words.contains("the budget of 700 steps is used up; try --budget 2000"), "{words}");
    assert_eq!(output.status.code(), Some(1));
    assert!(simulate(&folder, &[&run[..], &["--budget", "2000"]].concat()).status.success());
}

#[test]
fn what_has_no_joint_coordinates_is_said_and_a_tree_is_called_a_tree() {
    let folder = Folder::new("joint");
    let check = |page: &str, engine: &str, words: &str| {
        let output = simulate(&folder, &[&model(page), "--engine", engine, "--coordinates", "joint"]);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && said.contains(words), "{page} {engine}: {said}");
    };
    check("compound-pendulum.toml", "recursive", "leave out --engine recursive");
    check("compound-pendulum.toml", "assembled", "leave out --engine");
    check("four-bar.toml", "generated", "has a loop, which is closed by joint `knee`");
    check("four-bar.toml", "recursive", "has a loop");
}

/// What was fed in is in the table beside what came of it, and the object says what its numbers are and where the table is.
#[test]
fn the_table_has_the_inputs_and_the_object_names_components_and_files() {
    let folder = Folder::new("inputs");
    let page = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/models/motor.toml");
    let text = fs::read_to_string(page).unwrap();
    let more = "\n[[output]]\nname = \"felt\"\nkind = \"acceleration\"\nbody = \"disc\"\n\
                [[output]]\nname = \"torque\"\nkind = \"power\"\n";
    let page = folder.0.join("motor.toml");
    fs::write(&page, text.replacen("torque = 0\n", "torque = 0\nspare = 2\n", 1) + more).unwrap();
    fs::write(folder.0.join("ramp.csv"), "t,torque\n0,0\n1,0.5\n").unwrap();
    let page = page.to_str().unwrap();
    let run =
        [page, "--engine", "assembled", "--t-end", "0.1", "--every", "0.05", "--input", "torque=ramp.csv"];
    let run = json(&folder, &[&run[..], &["--out", "here"]].concat());
    assert_eq!(run["inputs"]["spare"], 2.0);
    assert!((run["inputs"]["torque"].as_f64().unwrap() - 0.05).abs() < 1e-12, "{run}");
    assert_eq!(run["components"]["inputs"]["torque"], "N*m");
    assert_eq!(run["components"]["outputs"]["felt"][3]["name"], "dwx");
    assert_eq!(run["components"]["outputs"]["felt"][3]["unit"], "rad/s2");
    assert_eq!(run["components"]["outputs"]["felt"].as_array().unwrap().len(), 6);
    assert_eq!(run["components"]["joints"]["bearing"][0]["unit"], "rad");
    let table = fs::read_to_string(folder.0.join(run["files"]["time_series"].as_str().unwrap())).unwrap();
    let mut lines = table.lines();
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    // An output has the input's name.
    let column =
        |name: &str| head.iter().position(|other| *other == name).unwrap_or_else(|| panic!("{head:?}"));
    let (t, torque, spare) = (column("t [s]"), column("input torque [N*m]"), column("spare [1]"));
    for line in lines {
        let row: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        assert!((row[torque] - 0.5 * row[t]).abs() < 1e-12 && row[spare] == 2.0, "{line}");
    }
    let nowhere = json(&folder, &[page, "--engine", "assembled", "--t-end", "0.01"]);
    assert!(nowhere["files"]["time_series"].is_null(), "{nowhere}");
    assert!(nowhere["files"]["note"].as_str().unwrap().contains("--out"), "{nowhere}");
}
