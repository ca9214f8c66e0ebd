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

/// The half angle between joint frames that are skew to each other is a root of what has roots in it. Modulo some primes it does not
/// exist: these frames are proved modulo others.
#[test]
fn roots_of_roots_are_found() {
    let axes = ["[1, 1, 0]", "[1, 2, 3]", "[2.34, 2.25, 2.22]", "[1, 1, 1]"];
    for (k, axis) in axes.iter().enumerate() {
        let text = format!(
            "format = 1\nname = \"skew\"\n[[body]]\nname = \"wall\"\nfixed = true\n\
             [[body]]\nname = \"part\"\nmass = 1\ninertia = [1, 1, 1]\n\
             [[joint]]\nname = \"hinge\"\nkind = \"revolute\"\n\
             first = {{ body = \"wall\", axis = {axis}, zero = [0, 0, -1] }}\n\
             second = {{ body = \"part\", axis = [3, 0, 4], zero = [{k}, 1, 0] }}\n"
        );
        let page = crate::support::generate_text("skew.toml", &text);
        let report = verify(&page.model, &page.code, &page.constants, Depth::Quick);
        assert!(report.is_proved(), "{axis}: {report}");
    }
}
