//! Every function of every model is proved.

mod support;

use gyro_verifier::{Depth, verify};

#[test]
fn all_modules_are_proved() {
    let mut failed = Vec::new();
    for path in support::pages() {
        let page = support::generate(&path);
        let report = verify(&page.model, &page.code, &page.constants, Depth::Quick);
        println!("{report}");
        if !report.is_proved() {
            failed.push(page.name);
        }
    }
    assert!(failed.is_empty(), "not proved: {failed:?}");
}
