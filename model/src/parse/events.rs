//! Events.

use super::formulas::{self, Inputs};
use super::laws;
use super::lookup::wrong_within;
use super::reader::Reader;
use super::section::{Item, Section};
use super::seen::{self, Known};
use super::tables;
use crate::validate::Owner;
use crate::{Direction, Event, Formula, Output, Seen};

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
    let of = of.unwrap_or_else(|| Formula::seen("t", Seen::Time));
    let of = match minus {
        None => of,
        Some(minus) => of.minus(&minus),
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
    let found = laws::with_names(reader, known, Inputs::Unknown, &formulas::any, |named| named.varying(text));
    match found {
        Ok(formula) => Some(formula),
        // Of a single name it can be said what is meant.
        Err(_) if laws::is_name(text) => {
            seen::named(reader, item, text, known).map(|seen| Formula::seen(text, seen))
        }
        Err(fault) => {
            wrong_within(reader, item, text, fault);
            None
        }
    }
}
