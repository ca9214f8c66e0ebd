//! Loops of long modules: they are proved as straight-line code is, and faults in them are found.

use gyro_codegen::{Functions, Kernel};
use gyro_verifier::{Depth, verify};
use std::fmt::Write as _;

/// Links of a chain, all alike: enough for loops.
const LINKS: usize = 14;

fn chain() -> String {
    let mut text =
        "format = 1\nname = \"chain\"\ngravity = [0, 0, -9.81]\n[[body]]\nname = \"b0\"\nfixed = true\n"
            .to_owned();
    for link in 1..=LINKS {
        write!(
            text,
            "[[body]]\nname = \"b{link}\"\nmass = 1.{link}\ninertia = [0.02, 0.03, 0.04]\n[[joint]]\nname = \
             \"j{link}\"\nkind = \"revolute\"\nfirst = {{ body = \"b{}\", point = [0.02, -0.01, -0.1], axis = \
             [1, 2, 2], zero = [2, 1, -2] }}\nsecond = {{ body = \"b{link}\", point = [-0.01, 0.02, 0.1], axis = \
             [2, -1, 2], zero = [2, 2, -1] }}\n",
            link - 1
        )
        .expect("a string takes all text");
    }
    text
}

/// The text with something else in the place of the first occurrence after a loop's table.
fn with(code: &str, from: &str, to: &str) -> String {
    let table = code.find("const PARTS_").expect("a loop with a table");
    let at = table + code[table..].find(from).unwrap_or_else(|| panic!("no `{from}` in a loop"));
    format!("{}{to}{}", &code[..at], &code[at + from.len()..])
}

#[test]
fn loops_are_proved_and_their_faults_are_found() {
    let model = gyro_model::read("chain.toml", &chain()).expect("a model file");
    let functions = Functions::named(["maximal"]).expect("there is such a group");
    let module = gyro_codegen::generate_functions("chain.toml", &model, &functions).expect("a module");
    let function = module.data_sheet.function(Kernel::Accelerations).expect("they are asked for");
    let repetition = function.repetition.expect("they are long");
    assert!(repetition.loops > 0 && (4..=LINKS).contains(&repetition.copies), "{repetition:?}");
    assert!(2 * repetition.written <= function.operations.total(), "{repetition:?}");
    let is_proved = |code: &str| verify(&model, code, &module.constants, Depth::Quick).is_proved();
    let report = verify(&model, &module.code, &module.constants, Depth::Quick);
    assert!(report.is_proved(), "{report}");
    // The sheet says what the verifier counts.
    let row = format!("eq. (17), in {} loops |", repetition.loops);
    assert!(module.code.contains(&row), "no row with `{row}`");
    let other = format!("eq. (17), in {} loops |", repetition.loops + 1);
    assert!(!is_proved(&module.code.replace(&row, &other)), "a wrong number of loops is not found");
    for (from, to) in [
        // A loop that ends too early.
        ("for i in (0..", "for i in (1.."),
        (").rev() {", ") {"),
        ("[i + 1]", "[i + 2]"),
        ("[i]", "[i + 1]"),
        ("[i][0]", "[i][1]"),
        ("+ v0", "- v0"),
    ] {
        if module.code.contains(from) {
            assert!(!is_proved(&with(&module.code, from, to)), "`{to}` for `{from}` is not found");
        }
    }
    // Two entries of a table that change places.
    let table = module.code.find("const PARTS_").expect("a loop with a table");
    let row = table + module.code[table..].find("= [").expect("its rows") + 3;
    let end = row + module.code[row..].find(']').expect("the end of a row");
    let entries: Vec<&str> =
        module.code[row..end].trim_start_matches(['[', '\n', ' ']).split(',').map(str::trim).collect();
    let (first, other) =
        (entries[0], entries.iter().find(|entry| **entry != entries[0]).expect("another number"));
    let at = row + module.code[row..end].find(first).expect("the entry");
    let changed = format!("{}{other}{}", &module.code[..at], &module.code[at + first.len()..]);
    assert!(!is_proved(&changed), "a wrong entry of a table is not found");
}
