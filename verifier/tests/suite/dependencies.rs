//! The verifier shares no derivation with the generator: its dependencies are the description, a parser, and numbers.

use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

/// What `cargo metadata` says of the workspace.
fn metadata() -> Value {
    let cargo = std::env::var("CARGO").unwrap_or_else(|_| "cargo".to_owned());
    let output = Command::new(cargo)
        .args(["metadata", "--format-version", "1", "--offline", "--locked"])
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .output()
        .expect("cargo runs");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON")
}

/// The packages that one needs to be built, by normal dependencies.
fn needed(metadata: &Value, package: &str) -> BTreeSet<String> {
    let text = |value: &Value| value.as_str().expect("a text").to_owned();
    let list = |value: &Value| value.as_array().expect("a list").clone();
    let names: BTreeMap<String, String> =
        list(&metadata["packages"]).iter().map(|p| (text(&p["id"]), text(&p["name"]))).collect();
    let is_normal =
        |dependency: &Value| list(&dependency["dep_kinds"]).iter().any(|kind| kind["kind"].is_null());
    let edges: BTreeMap<String, Vec<String>> = list(&metadata["resolve"]["nodes"])
        .iter()
        .map(|node| {
            let dependencies = list(&node["deps"]).into_iter().filter(is_normal);
            (text(&node["id"]), dependencies.map(|dependency| text(&dependency["pkg"])).collect())
        })
        .collect();
    let start = names.iter().find(|(_, name)| *name == package).map(|(id, _)| id.clone());
    let (mut found, mut open) = (BTreeSet::new(), vec![start.expect("the package")]);
    while let Some(id) = open.pop() {
        if found.insert(id.clone()) {
            open.extend(edges[&id].iter().cloned());
        }
    }
    found.iter().map(|id| names[id].clone()).collect()
}

#[test]
fn the_verifier_needs_nothing_of_the_generator() {
    let metadata = metadata();
    let ours = |package: &str| -> Vec<String> {
        needed(&metadata, package).into_iter().filter(|name| name.starts_with("gyro-")).collect()
    };
    assert_eq!(ours("gyro-verifier"), ["gyro-model", "gyro-verifier"]);
    // The description knows neither of them, and the test sees a dependency where there is one.
    assert_eq!(ours("gyro-model"), ["gyro-model"]);
    assert_eq!(ours("gyro-codegen"), ["gyro-codegen", "gyro-model"]);
    assert!(ours("xtask").contains(&"gyro-codegen".to_owned()));
}
