//! `docs/model-format.md` keeps up with the reader: its example is good and its tables know every key.

use std::collections::BTreeSet;

use gyro_model::{JointKind, Support, read};

fn page() -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/model-format.md");
    std::fs::read_to_string(path).expect("the format's page")
}

/// The text between the page's TOML fences.
fn example(page: &str) -> &str {
    let (_, rest) = page.split_once("```toml\n").expect("an example");
    rest.split_once("```").expect("its end").0
}

/// The words that stand between backquotes.
fn quoted(text: &str) -> BTreeSet<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

/// The keys that the reader lists when it meets an unknown one.
fn known_keys(text: &str) -> Vec<String> {
    let mistakes = read("page.toml", text).expect_err("an unknown key");
    let help = mistakes.mistakes().iter().find(|m| m.message.contains("unknown key `qqqqqqqqqqqq`"));
    quoted(&help.expect("a list").help).into_iter().map(str::to_owned).collect()
}

#[test]
fn the_example_is_good_and_shows_everything() {
    let page = page();
    let model = read("model-format.md", example(&page)).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    for kind in [JointKind::Revolute, JointKind::Spherical, JointKind::Fixed] {
        assert!(model.joints.iter().any(|j| j.kind == kind), "{kind:?}");
    }
    for support in [Support::Fixed, Support::Free, Support::Moving] {
        assert!(model.bodies.iter().any(|b| b.support == support), "{support:?}");
    }
}

#[test]
fn the_tables_know_every_key() {
    let page = page();
    let (words, example) =
        (quoted(&page.replace("```", "")).into_iter().map(str::to_owned).collect(), example(&page));
    let words: BTreeSet<String> = words;
    let unknown = "qqqqqqqqqqqq = 1\n";
    let after = |line: &str| example.replacen(line, &format!("{line}{unknown}"), 1);
    let sections = [
        format!("{unknown}{example}"),
        after("t_end = 2.0\n"),
        after("name = \"ground\"\n"),
        after("name = \"shoulder\"\n"),
        example.replacen("{ body = \"arm\" }", "{ body = \"arm\", qqqqqqqqqqqq = 1 }", 1),
        example.replacen("{ xx = 2e-4,", "{ qqqqqqqqqqqq = 1, xx = 2e-4,", 1),
    ];
    for section in sections {
        let keys = known_keys(&section);
        assert!(keys.len() >= 4);
        for key in keys {
            assert!(words.contains(key.as_str()), "`{key}` is not in docs/model-format.md");
        }
    }
}
