//! The reader: from the text of a page to a checked [`Model`], or to every mistake in it at once.

mod bodies;
mod joints;
mod names;
mod numbers;
mod page;
mod reader;
mod section;
mod start;

use toml::de::DeTable;

use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::validate::{number_problems, topology_problems};
use crate::{Model, Tree};
use reader::Reader;

/// Reads a page. The file's name is used in messages only.
///
/// ```
/// let page = r#"
/// format = 1
/// name = "spinning_plate"
/// [[body]]
/// name = "plate"
/// free = true
/// mass = 0.1
/// inertia = [1e-4, 1e-4, 2e-4]
/// angular_velocity = [0, 1, 50]
/// "#;
/// let model = gyro_model::read("plate.toml", page).expect("a good page");
/// assert_eq!(model.bodies[0].name, "plate");
/// assert_eq!(model.assemble().expect("a free body has a start").v[5], 50.0);
///
/// let mistakes = gyro_model::read("plate.toml", &page.replace("mass", "mas")).expect_err("a misspelt key");
/// assert!(mistakes.to_string().contains("write `mass`"));
/// ```
///
/// # Errors
/// Every mistake of the page: syntax, unknown and missing keys, wrong types, unknown names, unphysical numbers, bodies
/// that hang together wrongly, and a start that the joints do not allow.
pub fn read(file_name: &str, text: &str) -> Result<Model, Diagnostics> {
    let (document, syntax) = DeTable::parse_recoverable(text);
    let mut reader = Reader::new(text);
    let model = page::read(&mut reader, document.get_ref());
    check(&mut reader, &model);
    let mistakes = if syntax.is_empty() {
        reader.into_mistakes()
    } else {
        reader.into_certain(syntax_mistakes(text, &syntax))
    };
    if mistakes.is_empty() { Ok(model) } else { Err(Diagnostics::new(file_name, text, mistakes)) }
}

/// The message for a parameter that a model does not have.
pub(crate) fn unknown_parameter(model: &Model, name: &str) -> String {
    let known: Vec<&str> = model.parameters.iter().map(|p| p.name.as_str()).collect();
    if known.is_empty() {
        return format!("unknown parameter `{name}`: the model `{}` has no parameters", model.name);
    }
    format!("unknown parameter `{name}`: {}", names::instead(name, &known))
}

/// What goes beyond the syntax. Places with a mistake of their own are not judged again.
fn check(reader: &mut Reader<'_>, model: &Model) {
    reader.add_problems(number_problems(model));
    if reader.names_are_broken() {
        return;
    }
    reader.add_problems(topology_problems(model));
    let tree = Tree::of(model);
    if tree.loop_joints.is_empty() && tree.unreached.is_empty() && reader.is_clean() {
        start::check(reader, model);
    }
}

fn syntax_mistakes(text: &str, errors: &[toml::de::Error]) -> Vec<Diagnostic> {
    let mistake = |error: &toml::de::Error| {
        let span = error.span().unwrap_or_default();
        let help = syntax_help(error.message(), text.get(span.start..).unwrap_or_default()).to_owned();
        let message = format!("TOML syntax: {}", error.message().trim_end_matches(", expected nothing"));
        Diagnostic { span, message, label: "not understood".to_owned(), help, related: Vec::new() }
    };
    errors.iter().map(mistake).collect()
}

/// What to do about the commonest syntax errors.
fn syntax_help(message: &str, written: &str) -> &'static str {
    if message.contains("duplicate key") {
        match written.split_once(']') {
            Some(("body", _)) => "write [[body]] above each body",
            Some(("joint", _)) => "write [[joint]] above each joint",
            _ => "a key may be written once: remove one of the two",
        }
    } else if written.starts_with(',') {
        "write numbers with a decimal point, and several of them between brackets"
    } else if message.contains("quoted") {
        "put text between double quotes"
    } else {
        "a line is `key = value`, `[table]` or `[[table]]`; see docs/model-format.md"
    }
}
