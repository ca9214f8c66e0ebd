//! Every model file in `tests/bad-models` is refused with the message beside it. `UPDATE_EXPECT=1` writes the messages
//! anew: read them before they are kept.

use std::path::Path;

use gyro_model::{Diagnostics, Model, read_with};

/// Reads a model file with the tables beside it.
fn read_beside(path: &Path, text: &str) -> Result<Model, Diagnostics> {
    let name = path.file_name().and_then(|name| name.to_str()).expect("a name");
    let folder = path.parent().expect("a folder");
    read_with(name, text, &mut |table| {
        std::fs::read_to_string(folder.join(table)).map_err(|_| "there is no such file".to_owned())
    })
}

/// What is wrong with the message of one model file, if anything.
fn difference(path: &Path, text: &str) -> Option<String> {
    let name = path.file_name().and_then(|name| name.to_str()).expect("a name");
    let Err(mistakes) = read_beside(path, text) else {
        return Some(format!("{name} was read without complaint"));
    };
    let (found, expected) = (mistakes.render(), path.with_extension("stderr"));
    if std::env::var_os("UPDATE_EXPECT").is_some() {
        std::fs::write(&expected, &found).expect("the folder can be written to");
    }
    match std::fs::read_to_string(&expected) {
        Ok(expected) if expected == found => None,
        Ok(expected) => Some(format!("{name}: expected\n{expected}\nbut found\n{found}")),
        Err(_) => Some(format!("{} is missing; UPDATE_EXPECT=1 writes it:\n{found}", expected.display())),
    }
}

#[test]
fn bad_pages_are_refused_with_the_message_beside_them() {
    let pages = crate::support::pages("tests/bad-models");
    assert!(pages.len() >= 75);
    let differences: Vec<String> = pages.iter().filter_map(|(path, text)| difference(path, text)).collect();
    assert!(differences.is_empty(), "{}", differences.join("\n"));
}

#[test]
fn every_message_shows_its_place_and_a_cure() {
    for (path, text) in crate::support::pages("tests/bad-models") {
        let name = path.file_name().and_then(|name| name.to_str()).expect("a name");
        let mistakes = read_beside(&path, &text).expect_err(name);
        for mistake in mistakes.mistakes() {
            assert!(!mistake.message.is_empty() && !mistake.help.is_empty(), "{mistake:?}");
            let line = text[..mistake.span.start].matches('\n').count() + 1;
            assert!(mistakes.render().contains(&format!("--> {name}:{line}:")), "{mistake:?}");
        }
        assert!(mistakes.render_colored().contains("\u{1b}["), "no colours");
    }
}
