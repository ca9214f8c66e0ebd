//! What the generator writes: always the same, and the same as what is checked in.

use gyro_codegen::Functions;
use gyro_sim_suite::{module, page};

/// One of the modules that are kept.
const KEPT: &str = include_str!("../../mechanisms/src/golden/heavy_top.rs");

/// Of all modules that are kept `cargo xtask generate --check` says so.
#[test]
fn a_checked_in_module_is_fresh() {
    assert!(without_proof(KEPT) == module("heavy-top").code, "stale, run: cargo xtask generate");
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
        let own = module(page);
        assert!(own.code == other.code && own.constants == other.constants, "{page}: two generations differ");
        assert!(
            format!("{:?}", own.scheduled) == format!("{:?}", other.scheduled),
            "{page}: two generations differ"
        );
    }
}

#[test]
fn another_page_gives_other_bytes() {
    // The freshness test must be able to fail: one digit of a model file shows.
    let text = page("heavy-top").replace("-0.04]", "-0.05]");
    let model = gyro_model::read("heavy-top.toml", &text).unwrap();
    let module =
        gyro_codegen::generate_functions("heavy-top.toml", &model, &Functions::of_solvers()).unwrap();
    assert!(without_proof(KEPT) != module.code);
}
