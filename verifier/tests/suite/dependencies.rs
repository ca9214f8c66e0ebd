//! The verifier shares no derivation with the generator: its dependencies are the description, the signatures of
//! functions, a parser, and numbers.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;
use std::process::Command;

/// What `cargo metadata` says of the workspace's own manifests. It looks at no other package: what other platforms
/// would need has been fetched by nobody.
fn metadata() -> Value {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let output = Command::new(cargo)
        .args(["metadata", "--format-version", "1", "--no-deps", "--offline", "--locked"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// The packages of the workspace that each of them names as a normal dependency, for any platform and feature. No
/// package from elsewhere can lead back into the workspace, so these are all the ways there are.
fn edges(metadata: &Value) -> BTreeMap<String, Vec<String>> {
    let text = |value: &Value| value.as_str().expect("a text").to_owned();
    let list = |value: &Value| value.as_array().expect("a list").clone();
    let is_ours = |dependency: &Value| dependency["path"].is_string() && dependency["kind"].is_null();
    let ours = |package: &Value| {
        let dependencies = list(&package["dependencies"]).into_iter().filter(is_ours);
        dependencies.map(|dependency| text(&dependency["name"])).collect()
    };
    list(&metadata["packages"]).iter().map(|package| (text(&package["name"]), ours(package))).collect()
}

/// The packages of the workspace that one needs to be built, itself included.
fn needed(edges: &BTreeMap<String, Vec<String>>, package: &str) -> Vec<String> {
    let (mut found, mut open) = (BTreeSet::new(), vec![package.to_owned()]);
    while let Some(name) = open.pop() {
        if found.insert(name.clone()) {
            open.extend(edges[&name].iter().cloned());
        }
    }
    found.into_iter().collect()
}

#[test]
fn the_verifier_needs_nothing_of_the_generator() {
    let edges = edges(&metadata());
    let ours = |package: &str| needed(&edges, package);
    assert_eq!(ours("gyro-verifier"), ["gyro-model", "gyro-program", "gyro-verifier"]);
    // The description and the signatures know neither of them, and the test sees a dependency where there is one.
    assert_eq!(ours("gyro-model"), ["gyro-model", "gyro-program"]);
    assert_eq!(ours("gyro-program"), ["gyro-program"]);
    assert_eq!(ours("gyro-codegen"), ["gyro-codegen", "gyro-model", "gyro-program"]);
    assert!(ours("gyro-cli").contains(&"gyro-codegen".to_owned()));
}

/// The texts of all files in a folder.
fn texts(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder").map(|entry| entry.expect("an entry").path());
    let text = |path: &Path| fs::read_to_string(path).expect("a text");
    entries.flat_map(|path| if path.is_dir() { texts(&path) } else { vec![text(&path)] }).collect()
}

/// The rest of the table is the generator's: what signs and zeros do to a function the verifier knows by itself.
#[test]
fn of_the_table_of_functions_the_verifier_reads_names_and_numbers_of_operands() {
    let own = texts(&Path::new(env!("CARGO_MANIFEST_DIR")).join("src"));
    assert!(own.iter().any(|text| text.contains("gyro_program::elementary::Function;")));
    for others in ["properties()", "Properties", "Parity", "at_zero"] {
        assert!(own.iter().all(|text| !text.contains(others)), "the verifier reads {others}");
    }
}
