//! The schema is fresh, admits every good model file, and refuses what it can know to be wrong.

mod keys;

use jsonschema::Validator;
use serde_json::Value;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn validator() -> Validator {
    let schema: Value = serde_json::from_str(gyro_schema::SCHEMA).expect("JSON");
    jsonschema::validator_for(&schema).expect("a schema")
}

/// The model file as JSON; `None` if it is not TOML.
fn json(text: &str) -> Option<Value> {
    toml::from_str(text).ok()
}

/// The model files of a folder.
fn pages(folder: &str) -> Vec<(String, String)> {
    let entries = std::fs::read_dir(root().join(folder)).expect("a folder");
    let paths = entries.map(|entry| entry.expect("an entry").path());
    let paths = paths.filter(|path| path.extension().is_some_and(|extension| extension == "toml"));
    let read = |path: PathBuf| {
        let name = path.file_stem().expect("a name").to_string_lossy().into_owned();
        (name, std::fs::read_to_string(path).expect("text"))
    };
    let mut pages: Vec<_> = paths.map(read).collect();
    pages.sort();
    pages
}

/// `UPDATE_EXPECT=1` writes it anew.
#[test]
fn the_schema_is_fresh() {
    let path = root().join("schema/model.schema.json");
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        std::fs::write(&path, keys::schema()).expect("the folder can be written to");
    }
    let committed = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(committed == keys::schema(), "UPDATE_EXPECT=1 cargo test -p gyro-schema writes it anew");
}

#[test]
fn good_model_files_are_admitted() {
    let validator = validator();
    let folders =
        ["models", "tests/models", "embedded/models", "examples", "examples/arm", "examples/cart-pendulum"];
    let files = folders.into_iter().flat_map(pages);
    let templates =
        pages("cli/templates").into_iter().map(|(name, text)| (name, text.replace("\"NAME\"", "\"name\"")));
    let random = (0..200).map(|seed| (format!("random {seed}"), gyro_pages::page(seed)));
    let mut count = 0;
    for (name, text) in files.chain(templates).chain(random) {
        let page = json(&text).expect("TOML");
        let mistakes: Vec<String> = validator.iter_errors(&page).map(|error| error.to_string()).collect();
        assert!(mistakes.is_empty(), "{name}: {}", mistakes.join("\n"));
        count += 1;
    }
    assert!(count > 250, "{count}");
}

/// Mistakes in keys, types and words; the others are the reader's to find.
#[test]
fn mistakes_that_a_schema_can_know_are_refused() {
    let validator = validator();
    let is_refused = |text: &str| json(text).is_some_and(|page| !validator.is_valid(&page));
    let known = [
        "empty-page",
        "joint-kind-keys",
        "unknown-keys",
        "misplaced-keys",
        "wrong-types",
        "names",
        "tables-for-numbers",
        "point-masses",
        "motions",
    ];
    let bad = pages("tests/bad-models");
    let refused: Vec<&str> =
        bad.iter().filter(|(_, text)| is_refused(text)).map(|(name, _)| name.as_str()).collect();
    let missed: Vec<&&str> = known
        .iter()
        .filter(|name| bad.iter().any(|(other, _)| other == *name) && !refused.contains(name))
        .collect();
    assert!(missed.is_empty(), "{missed:?} of {refused:?}");
    assert!(refused.len() >= 25, "{} of {}: {refused:?}", refused.len(), bad.len());
}
