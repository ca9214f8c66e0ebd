//! The reader: from the text of a model file to a checked [`Model`], or to every mistake in it at once.

mod bodies;
mod build;
mod computed;
mod contacts;
mod controllers;
mod couplings;
mod curves;
mod driven;
mod elements;
mod events;
mod expression;
mod forces;
mod formulas;
mod functions;
mod joint_start;
mod joints;
mod kinds;
mod laws;
mod lines;
mod lookup;
mod motion;
mod named_formulas;
mod names;
mod numbers;
mod outputs;
mod page;
mod parameters;
mod point_masses;
mod prelude;
mod reader;
mod references;
mod section;
mod seen;
mod shapes;
mod simulation;
mod start;
mod states;
mod surfaces;
mod synonyms;
mod table;
mod tables;
mod tensor;
mod units;

pub use computed::root;
pub use names::{column, is_keyword, meant};
pub use units::pi;

use toml::de::DeTable;

use crate::diagnostics::{Diagnostic, Diagnostics};
use crate::directions;
use crate::keys::{FILE, Key, Value};
use crate::validate::{coordinate_problems, number_problems, settings_problems, topology_problems};
use crate::{Model, Number};
use reader::Reader;

/// Reads a model file. The file's name is used in messages only.
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
/// let model = gyro_model::read("plate.toml", page).expect("a good model file");
/// assert_eq!(model.bodies[0].name, "plate");
/// assert_eq!(model.assemble().expect("a free body has a start").v[5], 50.0);
///
/// let mistakes = gyro_model::read("plate.toml", &page.replace("mass", "mas")).expect_err("a misspelt key");
/// assert!(mistakes.to_string().contains("write `mass`"));
/// ```
///
/// # Errors
/// Every mistake of the model file: syntax, unknown and missing keys, wrong types, unknown names, unphysical numbers,
/// bodies that are connected wrongly, and a start that the joints do not allow.
pub fn read(file_name: &str, text: &str) -> Result<Model, Diagnostics> {
    read_with(file_name, text, &mut |_| {
        Err("this model file is read without its folder: see `read_with`".to_owned())
    })
}

/// Reads a model file whose motions may be tables in files beside it.
///
/// `load` gets the path of a table as the model file writes it and returns the text of the CSV file, or why it cannot
/// be read.
///
/// ```
/// let page = r#"
/// format = 1
/// name = "shaken_plate"
/// [[body]]
/// name = "table"
/// driven = { translation = [{ table = "shake.csv" }, 0, 0] }
/// [[body]]
/// name = "plate"
/// mass = 0.1
/// inertia = [1e-4, 1e-4, 2e-4]
/// [[joint]]
/// name = "slide"
/// kind = "prismatic"
/// axis = [1, 0, 0]
/// zero = [0, 1, 0]
/// first = { body = "table" }
/// second = { body = "plate" }
/// "#;
/// let mut load = |_: &str| Ok("t,x\n0,0\n1,0.01\n2,0".to_owned());
/// let model = gyro_model::read_with("shaken.toml", page, &mut load).expect("a good model file");
/// assert!(model.bodies[0].motion.is_some());
/// ```
///
/// # Errors
/// As [`read`], and missing or invalid tables.
pub fn read_with(
    file_name: &str,
    text: &str,
    load: &mut dyn FnMut(&str) -> Result<String, String>,
) -> Result<Model, Diagnostics> {
    let (document, syntax) = DeTable::parse_recoverable(text);
    let mut reader = Reader::new(text, load);
    let (document, elements) = prelude::expanded(document.get_ref());
    reader.elements = elements;
    let mut model = page::read(&mut reader, &document);
    directions::settle(&mut model);
    check(&mut reader, &mut model);
    let mistakes = if syntax.is_empty() {
        reader.into_mistakes()
    } else {
        reader.into_certain(syntax_mistakes(text, &syntax))
    };
    if mistakes.is_empty() { Ok(model) } else { Err(Diagnostics::new(file_name, text, mistakes)) }
}

/// The message for a parameter that a model does not have, or computes from others.
pub(crate) fn not_settable(model: &Model, name: &str) -> String {
    if let Some(derived) = model.derived_parameters.iter().find(|p| p.name == name) {
        let (text, numbers) = (&derived.text, derived.number.leaves());
        let from = model.parameters.iter().enumerate().filter(|(k, _)| {
            numbers.iter().any(|number| matches!(number, Number::Parameter { index, .. } if index == k))
        });
        let from: Vec<&str> = from.map(|(_, parameter)| parameter.name.as_str()).collect();
        return format!(
            "the parameter `{name}` is computed as {text:?} and cannot be set: set {}",
            names::list(&from)
        );
    }
    let known: Vec<&str> = model.parameters.iter().map(|p| p.name.as_str()).collect();
    if known.is_empty() {
        return format!("unknown parameter `{name}`: the model `{}` has no parameters", model.name);
    }
    format!("unknown parameter `{name}`: {}", names::instead(name, &known))
}

/// What goes beyond the syntax. Places with a mistake of their own are not judged again. What can only be said of a
/// good model, its start and its redundant rows, comes last.
fn check(reader: &mut Reader<'_>, model: &mut Model) {
    reader.add_problems(number_problems(model));
    if reader.names_are_broken() {
        return;
    }
    reader.add_problems(topology_problems(model));
    reader.add_problems(coordinate_problems(model));
    start::misplaced(reader, model);
    if reader.is_clean() {
        contacts::watch(model);
        start::check(reader, model);
        reader.add_problems(settings_problems(model));
    }
}

fn syntax_mistakes(text: &str, errors: &[toml::de::Error]) -> Vec<Diagnostic> {
    let mistake = |error: &toml::de::Error| {
        let span = error.span().unwrap_or_default();
        let written = text.get(span.start..).unwrap_or_default();
        // As much as a header takes: all that follows, for each of many errors, would be a square of it.
        let written = written.char_indices().nth(20).map_or(written, |(end, _)| &written[..end]);
        let help = syntax_help(error.message(), written);
        let message =
            format!("TOML syntax error: {}", error.message().trim_end_matches(", expected nothing"));
        Diagnostic { span, message, label: "cannot be parsed".to_owned(), help, related: Vec::new() }
    };
    errors.iter().map(mistake).collect()
}

/// What to do about the commonest syntax errors.
fn syntax_help(message: &str, written: &str) -> String {
    if message.contains("duplicate key") {
        let name = written.split_once(']').map_or("", |(name, _)| name);
        let is_list = |key: &&Key| key.name == name && matches!(key.value, Value::Tables(_));
        match FILE.keys.iter().find(is_list) {
            Some(_) => format!("write [[{name}]] above each {name}"),
            None => "a key may appear only once: remove one of the two".to_owned(),
        }
    } else if written.starts_with(',') {
        "write numbers with a decimal point, and lists of numbers in brackets".to_owned()
    } else if message.contains("quoted") {
        "put strings in double quotes".to_owned()
    } else {
        "a line is `key = value`, `[table]` or `[[table]]`; see docs/model-format.md".to_owned()
    }
}
