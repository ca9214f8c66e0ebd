//! `docs/model-format.md` keeps up with the reader: its example is good and its tables know every key.

use std::collections::BTreeSet;

use gyro_model::{Diagnostics, ForceKind, JointKind, Model, OutputKind, Support, read_with};

fn page() -> String {
    let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/model-format.md");
    std::fs::read_to_string(path).expect("docs/model-format.md")
}

/// The text between the document's first fences of a kind.
fn fenced<'p>(page: &'p str, kind: &str) -> &'p str {
    let (_, rest) = page.split_once(&format!("```{kind}\n")).expect("an example");
    rest.split_once("```").expect("its end").0
}

/// Reads a model file with the table that the document of the format shows.
fn read(text: &str) -> Result<Model, Diagnostics> {
    let page = page();
    read_with("page.toml", text, &mut |table| match table {
        "lift.csv" => Ok(fenced(&page, "csv").to_owned()),
        _ => Err("no such table".to_owned()),
    })
}

/// The words that stand between backquotes.
fn quoted(text: &str) -> BTreeSet<&str> {
    text.split('`').skip(1).step_by(2).collect()
}

/// The keys that the reader lists when it meets an unknown one.
fn known_keys(text: &str) -> Vec<String> {
    let mistakes = read(text).expect_err("an unknown key");
    let help = mistakes.mistakes().iter().find(|m| m.message.contains("unknown key `qqqqqqqqqqqq`"));
    quoted(&help.expect("a list").help).into_iter().map(str::to_owned).collect()
}

#[test]
fn the_example_is_good_and_shows_everything() {
    let page = page();
    let model = read(fenced(&page, "toml")).unwrap_or_else(|mistakes| panic!("{mistakes}"));
    for kind in [
        JointKind::Revolute,
        JointKind::Spherical,
        JointKind::Fixed,
        JointKind::Universal,
        JointKind::Cylindrical,
        JointKind::Prismatic,
        JointKind::Planar,
        JointKind::Screw,
        JointKind::PointOnLine,
        JointKind::Rod,
    ] {
        assert!(model.joints.iter().any(|j| j.kind == kind), "{kind:?}");
    }
    for support in [Support::Fixed, Support::Free, Support::Moving, Support::Driven] {
        assert!(model.bodies.iter().any(|b| b.support == support), "{support:?}");
    }
    let is: [fn(&ForceKind) -> bool; 7] = [
        |f| matches!(f, ForceKind::Spring { .. }),
        |f| matches!(f, ForceKind::Damper { .. }),
        |f| matches!(f, ForceKind::Coulomb { .. }),
        |f| matches!(f, ForceKind::Stop { .. }),
        |f| matches!(f, ForceKind::Motor { .. }),
        |f| matches!(f, ForceKind::Link { .. }),
        |f| matches!(f, ForceKind::Load { .. }),
    ];
    assert!(is.iter().all(|is| model.forces.iter().any(|force| is(&force.kind))));
    assert!(model.outputs.iter().any(|output| matches!(output.kind, OutputKind::Reaction { .. })));
    assert!(!model.inputs.is_empty() && !model.couplers.is_empty() && !model.drivers.is_empty());
}

#[test]
fn the_tables_know_every_key() {
    let page = page();
    let (words, example) =
        (quoted(&page.replace("```", "")).into_iter().map(str::to_owned).collect(), fenced(&page, "toml"));
    let words: BTreeSet<String> = words;
    let unknown = "qqqqqqqqqqqq = 1\n";
    let after = |line: &str| example.replacen(line, &format!("{line}{unknown}"), 1);
    let within = |keys: &str| example.replacen(keys, &format!("qqqqqqqqqqqq = 1, {keys}"), 1);
    let sections = [
        format!("{unknown}{example}"),
        after("t_end = 2.0\n"),
        after("name = \"ground\"\n"),
        after("name = \"shoulder\"\n"),
        after("name = \"gear\"\n"),
        after("name = \"lift\"\n"),
        after("name = \"wind\"\n"),
        after("name = \"energies\"\n"),
        within("body = \"arm\" }"),
        within("joint = \"tube\", coordinate"),
        within("body = \"ground\", point = [1, 0, 0]"),
        within("xx = 2e-4,"),
        within("axis = [1, 0, 0], angle"),
        within("amplitude = 0.01"),
        within("polynomial = [0, 0, 0.05]"),
        after("[body.driven]\n"),
        example.replacen("cylinder = [0.1, 0.4]", "qqqqqqqqqqqq = 1\ncylinder = [0.1, 0.4]", 1),
    ];
    for section in sections {
        let keys = known_keys(&section);
        assert!(keys.len() >= 2, "{keys:?}");
        for key in keys {
            assert!(words.contains(key.as_str()), "`{key}` is not in docs/model-format.md");
        }
    }
}

#[test]
fn names_have_at_most_a_hundred_characters() {
    assert!(page().contains("at most 100 characters"));
    let named = |length: usize| {
        let (text, name) = (page(), "n".repeat(length));
        let example = fenced(&text, "toml");
        let line = example.lines().find(|line| line.starts_with("name = ")).expect("the mechanism's name");
        read(&example.replacen(line, &format!("name = \"{name}\""), 1))
    };
    assert!(named(100).is_ok());
    let said = named(101).expect_err("a name that is too long").render();
    assert!(said.contains("at most 100 characters") && said.contains("write `nnn"), "{said}");
}
