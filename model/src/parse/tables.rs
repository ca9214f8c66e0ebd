//! What all arrays of tables share: the tables of a kind, and their names.

use std::ops::Range;

use toml::Spanned;
use toml::de::DeTable;

use super::reader::Reader;
use super::section::{Item, Section};
use crate::diagnostics::Related;
use crate::validate::{Owner, Place};

/// The tables of `[[body]]`, `[[joint]]` and the like, with the span of each.
pub(super) fn tables<'t>(
    reader: &mut Reader<'_>,
    page: &Section<'t>,
    key: &'static str,
) -> Vec<(Range<usize>, &'t DeTable<'t>)> {
    let Some(item) = page.get(key) else { return Vec::new() };
    let within = if let Owner::Body(_) = page.owner { "body." } else { "" };
    let example = format!("[[{within}{key}]] on a line of its own above each {}", key.replace('_', " "));
    let Some(elements) = item.value.get_ref().as_array() else {
        item.wrong_type(reader, "an array of tables", &example);
        return Vec::new();
    };
    let mut tables = Vec::new();
    for value in elements.iter() {
        if let Some(table) = (Item { place: item.place, value }).table(reader, &example) {
            tables.push((value.span(), table));
        }
    }
    tables
}

/// Reads the names of all things of a kind and reports those that are missing, repeated or not valid.
pub(super) fn names(
    reader: &mut Reader<'_>,
    tables: &[(Range<usize>, &DeTable<'_>)],
    owner: fn(usize) -> Owner,
    what: &'static str,
) -> Vec<Option<String>> {
    let mut seen: Vec<(Option<String>, Range<usize>)> = Vec::new();
    for (index, (header, table)) in tables.iter().enumerate() {
        let place = Place { owner: owner(index), key: "name" };
        let value = table.get("name");
        let span = value.map_or(header.clone(), Spanned::span);
        reader.mark(Place { key: "", ..place }, span.clone());
        let name = match value {
            Some(value) => Item { place, value }.name(reader),
            None => no_name(reader, place, what, index),
        };
        let earlier = seen.iter().find(|(other, _)| name.is_some() && name == other.as_deref());
        if let (Some(name), Some((_, first))) = (name, earlier) {
            let related = Related { span: first.clone(), label: "first used here".to_owned() };
            let help = "choose another name".to_owned();
            let words = [format!("{what} `{name}` is defined twice"), "used again".to_owned(), help];
            reader.clash(place, span.clone(), related, words);
        } else if let Some(name) = name {
            reader.take(place, &span, name, what);
        }
        seen.push((name.map(str::to_owned), span));
    }
    seen.into_iter().map(|(name, _)| name).collect()
}

fn no_name(reader: &mut Reader<'_>, place: Place, what: &str, index: usize) -> Option<&'static str> {
    let help = format!("write name = \"{what}_{}\"", index + 1);
    reader.missing(place, [format!("{what} {} has no `name`", index + 1), "needs `name`".to_owned(), help]);
    None
}
