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

/// The half angle between joint frames that are skew to each other is a root of what has roots in it. Modulo some
/// primes it does not exist: these frames are proved modulo others.
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

/// Twenty thousand rows take a second; read in the square of their number they would take half a minute.
#[test]
fn a_long_table_is_proved_number_for_number() {
    let page = r#"
format = 1
name = "shaken"
[[body]]
name = "table"
driven = { translation = [{ table = "long.csv" }, 0, 0] }
[[body]]
name = "plate"
mass = 0.1
inertia = [1e-4, 1e-4, 2e-4]
[[joint]]
name = "slide"
kind = "prismatic"
axis = [1, 0, 0]
zero = [0, 1, 0]
first = { body = "table" }
second = { body = "plate" }
"#;
    let row = |k: u32| format!("{},{}\n", f64::from(k) * 1e-3, (f64::from(k) * 0.01).sin());
    let rows: String = (0..20_000).map(row).collect();
    let mut load = |_: &str| Ok(format!("t,x\n{rows}"));
    let model = gyro_model::read_with("shaken.toml", page, &mut load).expect("a good model file");
    let module = gyro_codegen::generate_functions("shaken.toml", &model, &gyro_codegen::Functions::all())
        .expect("a module");
    let proved = |code: &str| verify(&model, code, &module.constants, Depth::Quick).is_proved();
    assert!(proved(&module.code));
    // The last digit of one number in the middle.
    let number = format!("{:?}", (100.0_f64).sin());
    assert_eq!(module.code.matches(&number).count(), 1, "the value of row 10 000");
    let other = format!("{:?}", f64::from_bits((100.0_f64).sin().to_bits() + 1));
    assert!(!proved(&module.code.replacen(&number, &other, 1)));
}
