//! What the generator writes: always the same, and the same as what is checked in.

use gyro_sim_suite::{page, pages};
use std::path::{Path, PathBuf};

fn module(name: &str) -> gyro_codegen::Module {
    // Named as `cargo xtask generate` names the pages of models/ in their modules' first line.
    gyro_codegen::generate(&format!("{name}.toml"), &page(name)).unwrap_or_else(|error| panic!("{error}"))
}

fn checked_in(module: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("gyro-sim/src/generated/{module}.rs"))
}

#[test]
fn checked_in_modules_are_fresh() {
    for module in pages().iter().map(|page| module(page)) {
        let found = std::fs::read_to_string(checked_in(&module.name)).unwrap_or_default();
        assert!(found == module.code, "{}.rs is stale, run: cargo xtask generate", module.name);
    }
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
    assert!(std::fs::read_to_string(checked_in("heavy_top")).unwrap() != module.code);
}

#[test]
fn no_generated_module_is_an_orphan() {
    let mut expected: Vec<String> = pages().iter().map(|page| page.replace('-', "_")).collect();
    expected.push("mod".to_owned());
    expected.sort();
    let folder = std::fs::read_dir(checked_in("mod").parent().unwrap()).unwrap();
    let stem = |path: PathBuf| path.file_stem().unwrap().to_string_lossy().into_owned();
    let mut found: Vec<String> = folder.map(|entry| stem(entry.unwrap().path())).collect();
    found.sort();
    assert_eq!(found, expected);
}
