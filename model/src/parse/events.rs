//! Events.

use toml::de::DeTable;

use super::formulas::Named;
use super::numbers::{named, wrong_within};
use super::reader::Reader;
use super::section::{Item, Section};
use super::seen::{self, Known};
use super::tables;
use crate::validate::{Owner, Place};
use crate::{Direction, Event, Formula, Number, Output};

const KEYS: [&str; 6] = ["name", "of", "minus", "level", "direction", "stop"];

/// Reads all events.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>, outputs: &[Output]) -> Vec<Event> {
    let tables = tables::tables(reader, page, "event");
    let names = tables::names(reader, &tables, Owner::Event, "event");
    if let Some((span, _)) = tables.get(Event::MOST) {
        let words = [
            format!("a model has at most {} events", Event::MOST),
            format!("there are {}", tables.len()),
            "leave some out, or look for them in the table of the run".to_owned(),
        ];
        reader.wrong(Place { owner: Owner::Event(Event::MOST), key: "" }, span.clone(), words);
    }
    let known = seen::known(&reader.joints, outputs);
    let named = tables.iter().zip(names).enumerate();
    named
        .map(|(index, ((_, table), name))| {
            event(reader, (index, table), &known, name.unwrap_or_else(|| format!("event {}", index + 1)))
        })
        .collect()
}

fn event(
    reader: &mut Reader<'_>,
    (index, table): (usize, &DeTable<'_>),
    known: &Known,
    name: String,
) -> Event {
    let title = format!("event `{name}`");
    let section = Section::open(reader, Owner::Event(index), &title, table, &KEYS);
    let example = "of = \"...\": a joint coordinate, a rate (\"joint rate\"), or a number of an output";
    section.require(reader, "of", &title, example);
    let [of, minus] = ["of", "minus"].map(|key| {
        let item = section.get(key)?;
        let word = item.text(reader, &format!("{key} = \"...\", the name of a column of a run's table"))?;
        formula(reader, item, word, known)
    });
    let of = of.unwrap_or(Formula::Number(Number::integer(0)));
    let of = match minus {
        None => of,
        Some(minus) => Formula::Difference(Box::new([of, minus])),
    };
    let direction = section.get("direction").and_then(|item| {
        let known = Direction::NAMES;
        item.choice(reader, ("direction", &known))
    });
    Event {
        name,
        of,
        level: section.number_or(reader, "level", 0),
        direction: direction.unwrap_or_default(),
        stops: section.get("stop").and_then(|item| item.flag(reader)).unwrap_or(false),
    }
}

/// A column, or a formula of columns and parameters.
fn formula(reader: &mut Reader<'_>, item: Item<'_>, text: &str, known: &Known) -> Option<Formula> {
    let is_name = |c: char| c.is_alphanumeric() || "_.- ".contains(c);
    let is_number = text.starts_with(|c: char| c.is_ascii_digit());
    let found = {
        let names: Vec<String> = reader.parameters.iter().map(|name| name.to_string()).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let parameter = |name: &str| named(reader, name);
        Named { columns: known, parameter: &parameter, parameters: &names }.formula(text)
    };
    match found {
        Ok(formula) => Some(formula),
        // Of a single name it can be said what is meant.
        Err(_) if text.chars().all(is_name) && !is_number && !text.contains(" - ") => {
            seen::named(reader, item, text, known).map(Formula::Seen)
        }
        Err(fault) => {
            wrong_within(reader, item, text, fault);
            None
        }
    }
}
