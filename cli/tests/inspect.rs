//! `cargo xtask inspect` from the outside.
#![allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::LazyLock;

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn model(name: &str) -> String {
    root().join("models").join(name).display().to_string()
}

fn inspect(args: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gyro")).arg("inspect").args(args).output().unwrap()
}

fn json(args: &[&str]) -> Value {
    let output = inspect(&[args, &["--json"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).unwrap()
}

/// The paper's scene, inspected once for all tests.
static GYROSCOPE: LazyLock<Value> = LazyLock::new(|| json(&[&model("gyroscope.toml"), "--no-compile"]));

fn functions(inspection: &Value) -> &Vec<Value> {
    inspection["functions"].as_array().unwrap()
}

/// By how many operations a function changes without an element of the model.
fn without(inspection: &Value, what: &str, name: &str) -> i64 {
    let elements = inspection["elements"].as_array().unwrap();
    let element = elements.iter().find(|element| element["what"] == what);
    let element = element.unwrap_or_else(|| panic!("{what} is missing in {elements:?}"));
    let function = &element["functions"][name];
    let functions = functions(inspection);
    let whole = functions.iter().find(|known| known["name"] == name).unwrap();
    let (now, change) = (function["operations"].as_i64().unwrap(), function["change"].as_i64().unwrap());
    assert_eq!(now - change, whole["operations"]["total"].as_i64().unwrap(), "{what}, {name}");
    change
}

#[test]
fn the_paper_s_scene_is_shown_pass_by_pass_and_element_by_element() {
    let found = &*GYROSCOPE;
    let numbers = ["coordinates", "constraints", "degrees_of_freedom", "unknowns"];
    assert_eq!(numbers.map(|key| found[key].as_u64().unwrap()), [21, 18, 3, 33]);
    for function in functions(found) {
        let pass = |name: &str| function["passes"][name].as_u64().unwrap();
        let passes = ["written_out", "shared", "emitted"].map(pass);
        assert!(passes.is_sorted_by(|a, b| a >= b), "{function}");
        assert_eq!(function["operations"]["total"], passes[2]);
        let forms = function["forms"].as_array().unwrap();
        let taken: Vec<&Value> = forms.iter().filter(|form| form["is_taken"] == true).collect();
        assert_eq!(taken.len(), usize::from(!forms.is_empty()), "{function}");
        assert!(taken.iter().all(|form| form["operations"] == function["operations"]), "{function}");
        assert!(function["machine_code_bytes"].is_null());
    }
    let accelerations = |what| without(found, what, "accelerations");
    assert!(accelerations("without the offset of `phi` on `inner_ring`") < 0);
    assert!(accelerations("without gravity") < 0);
    assert!(without(found, "with free masses and inertias", "joint_accelerations") > 0);
    let of_geometry = accelerations("with a free geometry");
    assert!(of_geometry > accelerations("with free joint points"));
    assert!(accelerations("with a free geometry, zeros too") > of_geometry);
    assert_eq!(without(found, "without gravity", "phi"), 0);
    let left_out: Vec<&str> =
        found["left_out"].as_array().unwrap().iter().map(|words| words.as_str().unwrap()).collect();
    assert!(left_out.iter().any(|what| what.contains("`base`")), "{left_out:?}");
    let spared = found["spared"].as_array().unwrap();
    assert!(spared.iter().any(|what| what.as_str().unwrap().contains("`rotor`")), "{spared:?}");
}

#[test]
fn the_head_of_a_generated_file_says_the_same() {
    let found = &*GYROSCOPE;
    let file = root().join("gyro-sim/src/generated/gyroscope.rs");
    let text = fs::read_to_string(file).unwrap();
    let head: Vec<&str> = text.lines().filter_map(|line| line.strip_prefix("//! ")).collect();
    for function in functions(found) {
        let begin = format!("| {} |", function["name"].as_str().unwrap());
        let row = head.iter().find(|line| line.starts_with(&begin)).unwrap();
        let cells: Vec<&str> = row.split(" | ").collect();
        assert_eq!(cells[5], function["operations"]["total"].to_string());
    }
    for what in found["left_out"].as_array().unwrap() {
        let line = format!("* left out: {}", what.as_str().unwrap());
        assert!(head.contains(&line.as_str()), "{line}");
    }
}

#[test]
fn a_page_elsewhere_is_compiled_and_its_machine_code_measured() {
    let folder = std::env::temp_dir().join(format!("xtask-inspect-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    let page = folder.join("my-top.toml");
    let text = fs::read_to_string(root().join("models/spinning-top.toml")).unwrap();
    fs::write(&page, text).unwrap();
    let output = inspect(&[&page.display().to_string()]);
    let (said, text) = (String::from_utf8_lossy(&output.stderr), String::from_utf8_lossy(&output.stdout));
    fs::remove_dir_all(&folder).unwrap();
    assert!(output.status.success(), "{said}");
    let row = text.lines().find(|line| line.trim_start().starts_with("accelerations ")).unwrap();
    // Without `nm` there is a warning instead.
    if !said.contains("`nm`") {
        let bytes: u64 = row.split_whitespace().next_back().unwrap().parse().unwrap();
        let operations: u64 = row.split_whitespace().nth(3).unwrap().parse().unwrap();
        assert!((2 * operations..100 * operations).contains(&bytes), "{row}");
    }
    assert!(text.contains("without gravity"), "{text}");
}

#[test]
#[ignore = "takes long: `.ci/steps` runs it"]
fn a_linkage_says_what_cannot_be_assembled() {
    let found = json(&[&model("four-bar.toml"), "--no-compile"]);
    let elements = found["elements"].as_array().unwrap();
    assert!(elements.iter().any(|element| element["error"].is_string()), "{elements:?}");
    assert!(elements.iter().any(|element| element["functions"].is_object()), "{elements:?}");
    assert!(found["saddle"].is_null());
}

#[test]
fn a_page_that_is_not_there_or_wrong_is_refused() {
    let output = inspect(&["no-such-page.toml"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && output.stdout.is_empty());
    assert!(said.contains("no-such-page.toml cannot be read"), "{said}");
    let page = root().join("tests/bad-models/zero-axis.toml");
    let output = inspect(&[&page.display().to_string(), "--json"]);
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(!output.status.success() && output.stdout.is_empty());
    assert!(said.contains("axis"), "{said}");
}
