//! Events.

use toml::de::DeTable;

use super::reader::Reader;
use super::section::Section;
use super::seen::{self, Known};
use super::tables;
use crate::validate::{Owner, Place};
use crate::{Direction, Event, JointCoordinate, Output, Seen};

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
        seen::named(reader, item, word, known)
    });
    let direction = section.get("direction").and_then(|item| {
        let known = Direction::NAMES;
        item.choice(reader, ("direction", &known))
    });
    Event {
        name,
        of: of.unwrap_or(Seen::Coordinate(JointCoordinate { joint: 0, coordinate: 0 })),
        minus,
        level: section.number_or(reader, "level", 0),
        direction: direction.unwrap_or_default(),
        stops: section.get("stop").and_then(|item| item.flag(reader)).unwrap_or(false),
    }
}
