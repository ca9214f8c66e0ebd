//! Runs of which nothing is said: shipped model files and examples, by the plain command.

use crate::contacts::chain;
use crate::support::{Folder, json, model, simulate};
use chacha20::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::thread;

/// All model files below a folder.
fn below(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            below(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "toml")
            && fs::read_to_string(&path).unwrap().contains("[[body]]")
        {
            found.push(path);
        }
    }
}

/// The engine that starts soonest of those that have all there is.
const FAST: [&str; 4] = ["--engine", "jit", "--effort", "quick"];

/// Scenes whose dampers, bushings or bristles are hard: the others take explicit methods fewer steps.
const STIFF: [&str; 5] = ["balls", "crates", "four_bar_bushing", "gyroscope_overdamped", "stick_slip"];

fn runs_well(path: &Path) {
    let (folder, page) =
        (Folder::new(&path.file_stem().unwrap().to_string_lossy()), path.display().to_string());
    // A thousand seconds of it are 300 000 steps.
    let shorter: &[&str] = if page.contains("gyroscope-long") { &["--t-end", "5"] } else { &[] };
    let output = simulate(&folder, &[&[page.as_str(), "--json"], &FAST[..], shorter].concat());
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{page}: {said}");
    let run: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(run["warnings"].as_array().unwrap().len(), 0, "{page}: {}", run["warnings"]);
    let drift = run["energy_drift"].as_f64().unwrap();
    // The paper's own step keeps the energy to 1e-12; 1e-9 a step add up.
    assert!(drift < 1e-7, "{page}: {drift:e}");
    let name = run["model"].as_str().unwrap();
    let expected = match name {
        "gyroscope" => "rk4",
        _ if STIFF.contains(&name) => "rodas4",
        _ => "dop853",
    };
    assert_eq!(run["integrator"], expected, "{page}: {}", run["chosen"]);
    assert_eq!(run["chosen"] == "", name == "gyroscope", "{page}: {}", run["chosen"]);
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn every_model_file_and_example_runs_well_by_the_plain_command() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut all = Vec::new();
    ["models", "examples", "studies"].iter().for_each(|name| below(&root.join(name), &mut all));
    all.sort();
    assert!(all.len() > 40, "{all:?}");
    let (one, other): (Vec<_>, Vec<_>) = all.iter().enumerate().partition(|(index, _)| index % 2 == 0);
    thread::scope(|scope| {
        for half in [one, other] {
            scope.spawn(move || half.into_iter().for_each(|(_, path)| runs_well(path)));
        }
    });
}

/// Its tables are compared with published ones: the words in its file are all that makes them.
#[test]
fn the_papers_scene_says_how_it_is_run() {
    let (folder, page) = (Folder::new("paper"), model("gyroscope.toml"));
    let said =
        ["--coordinates", "maximal", "--integrator", "rk4", "--correction", "partition", "--step", "1e-4"];
    let more = ["--correct-every", "5e-4", "--every", "1e-3", "--t-end", "1"];
    for engine in ["assembled", "jit"] {
        let table = |options: &[&str]| {
            let output = simulate(&folder, &[&[&page, "--engine", engine, "--out", "."], options].concat());
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
            fs::read(folder.0.join("gyroscope.csv")).unwrap()
        };
        assert!(table(&[]) == table(&[&said[..], &more].concat()), "{engine}");
        assert!(table(&[]) != table(&["--tolerance", "1e-9"]), "{engine}: an option changes it");
    }
}

/// A shaft with a hard brake: 1e6/s against a second.
const BRAKED: &str = r#"format = 1
name = "braked"
[[body]]
name = "ground"
fixed = true
[[body]]
name = "rotor"
mass = 1
inertia = [1, 1, 1]
[[joint]]
name = "shaft"
kind = "revolute"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = "ground" }
second = { body = "rotor", point = [0, 0.1, 0] }
damping = 1e6
rate = 1
"#;

#[test]
fn a_stiff_scene_is_found_and_the_summary_says_so() {
    let folder = Folder::new("braked");
    fs::write(folder.0.join("braked.toml"), BRAKED).unwrap();
    let run = json(&folder, &[&["braked.toml"], &FAST[..]].concat());
    assert_eq!(run["integrator"], "rodas4", "{run}");
    assert!(run["steps"].as_u64().unwrap() < 1000, "{run}");
    assert!(run["chosen"].as_str().unwrap().contains("the scene is stiff"), "{run}");
    // What is typed is kept, stiff or not.
    let typed =
        json(&folder, &[&["braked.toml", "--integrator", "dop853", "--t-end", "0.01"], &FAST[..]].concat());
    assert_eq!(typed["integrator"], "dop853");
    let output = simulate(&folder, &[&["braked.toml", "--t-end", "0.1"], &FAST[..]].concat());
    let text = String::from_utf8_lossy(&output.stdout);
    let lines: Vec<&str> = text.lines().filter(|line| line.starts_with("chosen: ")).collect();
    assert!(lines.len() == 1 && lines[0].contains("rodas4"), "{text}");
}

/// A chain without its contacts; dampers in its joints are soft to hard.
fn damped(random: &mut ChaCha8Rng) -> String {
    let mut is_kept = true;
    let mut text = String::new();
    for line in chain(random).lines() {
        if line.starts_with("[[") {
            is_kept = line != "[[contact]]";
        }
        if is_kept {
            text += &format!("{line}\n");
        }
        if line.starts_with("name = \"joint_") && random.random_bool(0.5) {
            text += &format!("damping = {:?}\n", 10_f64.powf(random.random_range(-4.0..3.5)));
        }
    }
    text
}

/// By the plain command it is right to what its tolerance promises, soft or hard.
#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn random_chains_run_well_by_the_plain_command() {
    let folder = Folder::new("plain");
    let mut random = ChaCha8Rng::seed_from_u64(4009);
    let mut n_stiff = 0;
    for case in 0..16 {
        let text = damped(&mut random);
        fs::write(folder.0.join("chain.toml"), &text).unwrap();
        let run = |more: &[&str]| json(&folder, &[&["chain.toml"], &FAST[..], more].concat());
        let plain = run(&[]);
        let is_stiff = plain["integrator"] == "rodas4";
        n_stiff += u32::from(is_stiff);
        let finer = run(&["--coordinates", "maximal", "--tolerance", "1e-11", "--integrator", "dop853"]);
        for (name, joint) in plain["joints"].as_object().unwrap() {
            for (key, limit) in [("position", 1e-6), ("rate", 1e-5)] {
                let [found, expected] =
                    [joint, &finer["joints"][name]].map(|joint| joint[key].as_f64().unwrap());
                let told = format!("case {case}, {name} {key}: {found}, should be {expected}");
                assert!((found - expected).abs() < limit * expected.abs().max(1.0), "{told}\n{text}");
            }
        }
    }
    println!("{n_stiff} are stiff");
    assert!(n_stiff > 2, "{n_stiff}");
}
