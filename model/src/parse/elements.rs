//! What ready elements and rolling bodies are told. What they stand for is read with the forces, states and rows of
//! the model file.

use super::numbers::{number, vector};
use super::reader::Reader;
use super::section::Section;
use super::{references, tables};
use crate::keys::{COUPLER_END, Value, lacking};
use crate::validate::Owner;
use crate::{Element, Number};

/// Reads all elements, behind those that are known.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>, mut all: Vec<Element>) -> Vec<Element> {
    for what in ["element", "rolling"] {
        let before = all.len();
        let sections = tables::each(reader, page, what, |index| Owner::Element(before + index));
        for (section, name) in sections {
            let index = all.len();
            all.push(element(reader, section, (index, name)));
        }
    }
    all
}

fn element(reader: &mut Reader<'_>, mut section: Section<'_>, (index, name): (usize, String)) -> Element {
    let table = section.keys.name;
    let Some(kind) = section.read_kind(reader, |_, _| None) else {
        return Element { name, kind: "", table, numbers: Vec::new() };
    };
    if kind.key("closed").is_some() {
        let twice = format!("{} is along a joint and between points", section.title);
        section.either(reader, ["joint", "first"], &twice);
    }
    let lacks = lacking(kind, |key| section.has(key));
    if let Some(key) = lacks.filter(|key| kind.key(key).is_some_and(|key| !key.is_required)) {
        section.require(reader, key);
    }
    let mut numbers: Vec<(&'static str, Number)> = Vec::new();
    for key in kind.keys {
        match key.value {
            Value::Reference if !section.has(key.name) => {}
            Value::Reference if key.name == "joint" && kind.key("coordinate").is_some() => {
                references::coordinate(reader, &section);
            }
            Value::Reference => {
                references::index(reader, &section, key.name);
            }
            Value::Word(_) => {
                section.word(reader, key.name);
            }
            Value::Number(_) | Value::Strength(_) => {
                let given = section.find(reader, key.name).and_then(|item| number(reader, item));
                numbers.extend(given.map(|number| (key.name, number)));
            }
            Value::Numbers(3, _) | Value::Strengths(_) => {
                let item = section.find(reader, key.name);
                let given = item.and_then(|item| vector::<3>(reader, item));
                let is_zero = given.as_ref().is_some_and(|given| given.iter().all(Number::is_zero));
                if let Some(item) = item.filter(|_| key.name == "axis" && is_zero) {
                    let message = format!("the axis of {} is zero", section.title);
                    item.wrong(
                        reader,
                        [message, "no direction".to_owned(), "write axis = [0, 0, 1]".to_owned()],
                    );
                }
                numbers.extend(given.into_iter().flatten().map(|number| (key.name, number)));
            }
            Value::Table(ends) if std::ptr::eq(ends, &raw const COUPLER_END) => {
                let title = format!("`{}` of {}", key.name, section.title);
                if let Some(end) = section.inner(reader, key.name, (Owner::Element(index), &title)) {
                    references::coordinate(reader, &end);
                }
            }
            Value::Tables(_) => {
                let Some(item) = section.find(reader, key.name) else { continue };
                if item.tables(reader).len() < 2 {
                    let help = format!("write {} = [{{ body = \"...\" }}, {{ body = \"...\" }}]", key.name);
                    item.wrong_type_with(reader, "an array of at least two tables", help);
                }
            }
            // Read where they stand in what the element stands for.
            _ => _ = section.find(reader, key.name),
        }
    }
    Element { name, kind: kind.word, table, numbers }
}
