//! What the generator writes: always the same, and the same as what is checked in.

use gyro_sim_suite::{fixture_folders, module, page};
use std::path::PathBuf;

/// Of all modules `cargo xtask generate --check` says so; here one shows that the tests run what the generator writes.
#[test]
fn a_checked_in_module_is_fresh() {
    let checked_in = fixture_folders()[0].generated.join("heavy_top.rs");
    let found = std::fs::read_to_string(checked_in).unwrap();
    assert!(without_proof(&found) == module("heavy-top").code, "stale, run: cargo xtask generate");
}

/// The module as the generator writes it: `cargo xtask generate` adds to the data sheet what was proved, and checks it.
fn without_proof(text: &str) -> String {
    let Some((before, proof)) = text.split_once("//!\n//! # Proof\n") else { return text.to_owned() };
    let rest: String = proof.split_inclusive('\n').skip_while(|line| line.starts_with("//!")).collect();
    format!("{before}{rest}")
}

#[test]
fn the_same_page_gives_the_same_bytes() {
    for page in ["gyroscope", "gyroscope-maximal", "heavy-top"] {
        // On another thread: hash maps would be seeded anew.
        let other = std::thread::scope(|scope| scope.spawn(|| module(page)).join().unwrap());
        assert!(module(page) == other, "{page}: two generations differ");
    }
}

#[test]
fn another_page_gives_other_bytes() {
    // The freshness test must be able to fail: one digit of a page shows.
    let text = page("heavy-top").replace("-0.04]", "-0.05]");
    let module = gyro_codegen::generate("heavy-top.toml", &text).unwrap();
    let checked_in = fixture_folders()[0].generated.join("heavy_top.rs");
    assert!(without_proof(&std::fs::read_to_string(checked_in).unwrap()) != module.code);
}

#[test]
fn no_generated_module_is_an_orphan() {
    for folder in fixture_folders() {
        let mut expected: Vec<String> = folder.pages().iter().map(|page| page.replace('-', "_")).collect();
        expected.push("mod".to_owned());
        expected.sort();
        let folder = std::fs::read_dir(&folder.generated).unwrap().map(|entry| entry.unwrap().path());
        let modules = folder.filter(|path| path.extension().is_some_and(|extension| extension == "rs"));
        let stem = |path: PathBuf| path.file_stem().unwrap().to_string_lossy().into_owned();
        let mut found: Vec<String> = modules.map(stem).collect();
        found.sort();
        assert_eq!(found, expected);
    }
}
