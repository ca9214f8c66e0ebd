//! The faults still apply to the generator as it is. This is quick to check, so plain test runs include it.

use gyro_mutants::STALE;

#[test]
fn every_fault_has_its_place_in_the_generator_s_text() {
    assert!(STALE.is_empty(), "the generator's text has changed, `faults.rs` must follow: {STALE:#?}");
}
