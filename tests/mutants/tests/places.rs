//! The faults are still faults of the generator as it is: quick to know, so that a plain test run says it.

use gyro_mutants::STALE;

#[test]
fn every_fault_has_its_place_in_the_generator_s_text() {
    assert!(STALE.is_empty(), "the generator's text has changed, `faults.rs` must follow: {STALE:#?}");
}
