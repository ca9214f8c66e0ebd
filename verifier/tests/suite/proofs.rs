//! Modules are proved: one of each partition here, all of them by `cargo xtask verify`.

use gyro_verifier::{Depth, verify};

#[test]
fn modules_of_both_partitions_are_proved() {
    for name in ["torsion", "gear"] {
        let page = crate::support::page(name);
        let report = verify(&page.model, &page.code, &page.constants, Depth::Quick);
        println!("{report}");
        assert!(report.is_proved(), "{name}: {report}");
    }
}
