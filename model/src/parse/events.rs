//! Events.

use super::formulas::Named;
use super::numbers::{named, wrong_within};
use super::reader::Reader;
use super::section::{Item, Section};
use super::seen::{self, Known};
use super::tables;
use crate::validate::Owner;
use crate::{Direction, Event, Formula, Number, Output};

/// Reads all events.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>, outputs: &[Output]) -> Vec<Event> {
    let known = seen::known(reader, outputs);
    let sections = tables::each(reader, page, "event", Owner::Event).into_iter();
    sections.map(|(section, name)| event(reader, &section, &known, name)).collect()
}

fn event(reader: &mut Reader<'_>, section: &Section<'_>, known: &Known, name: String) -> Event {
    let [of, minus] = ["of", "minus"].map(|key| {
        let item = section.find(reader, key)?;
        let word = item.text(reader)?;
        formula(reader, item, word, known)
    });
    let of = of.unwrap_or(Formula::Number(Number::integer(0)));
    let of = match minus {
        None => of,
        Some(minus) => Formula::Difference(Box::new([of, minus])),
    };
    Event {
        name,
        of,
        level: section.number(reader, "level"),
        direction: match section.word(reader, "direction") {
            Some("rising") => Direction::Rising,
            Some("falling") => Direction::Falling,
            _ => Direction::Both,
        },
        stops: section.flag(reader, "stop"),
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
