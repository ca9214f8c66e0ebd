//! What all arrays of tables share: the tables of a kind, and their names.

use std::ops::Range;

use toml::Spanned;
use toml::de::DeTable;

use super::reader::Reader;
use super::section::{Item, Section};
use crate::diagnostics::Related;
use crate::keys::{Key, Table, Value};
use crate::validate::{Owner, Place};
use crate::{Contact, Event};

/// What there may not be any number of, with what to do instead.
const MOST: [(&str, usize, &str); 2] = [
    ("event", Event::MOST, "leave some out, or look for them in the table of the run"),
    (
        "contact",
        Contact::MOST,
        "leave some out, or write them as [[force]] of kind \"stop\" and \"coulomb\", which are smooth",
    ),
];

/// Opens all tables of `[[body]]`, `[[joint]]` and the like, each with the name of what it describes. Their names are
/// with the reader before anything refers to them.
pub(super) fn each<'t>(
    reader: &mut Reader<'_>,
    page: &Section<'t>,
    what: &'static str,
    owner: impl Fn(usize) -> Owner + Copy,
) -> Vec<(Section<'t>, String)> {
    let item = page.find(reader, what);
    let Some(Item { key: &Key { value: Value::Tables(keys), .. }, .. }) = item else { return Vec::new() };
    let tables: Vec<_> = item.map(|item| item.tables(reader)).unwrap_or_default();
    // Of contacts those on joints count.
    let mut counted = tables.iter().filter(|(_, table)| !table.contains_key("between"));
    let most = MOST.iter().find(|(of, ..)| *of == what);
    if let Some((&(_, most, help), (item, _))) = most.and_then(|most| Some((most, counted.nth(most.1)?))) {
        let words = [
            format!("a model has at most {most} {what}s"),
            format!("there are {}", tables.len()),
            help.to_owned(),
        ];
        reader.wrong(Place { owner: owner(most), key: "" }, item.span(), words);
    }
    if let (Some((first, _)), "body") = (tables.first(), what) {
        reader.mark(page.place("body"), first.span());
    }
    let names = names(reader, &tables, owner, keys);
    let named = tables.iter().zip(&names).enumerate().map(|(index, ((_, table), name))| {
        let name = name.clone().unwrap_or_else(|| format!("{what} {}", index + 1));
        (Section::open(reader, owner(index), format!("{what} `{name}`"), table, keys), name)
    });
    let sections = named.collect();
    reader.names.insert(what, names);
    sections
}

/// Reads the names of all things of a kind and reports those that are missing, repeated or not valid.
fn names(
    reader: &mut Reader<'_>,
    tables: &[(Item<'_>, &DeTable<'_>)],
    owner: impl Fn(usize) -> Owner,
    keys: &'static Table,
) -> Vec<Option<String>> {
    let what = keys.name;
    let mut seen: Vec<(Option<String>, Range<usize>)> = Vec::new();
    for (index, (item, table)) in tables.iter().enumerate() {
        let place = Place { owner: owner(index), key: "name" };
        let value = table.get("name");
        let span = value.map_or(item.span(), Spanned::span);
        reader.mark(Place { key: "", ..place }, span.clone());
        let name = match value {
            Some(value) => Item { place, key: &keys.keys[0], value }.name(reader),
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
