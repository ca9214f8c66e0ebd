//! Parameters and inputs: names with their default numbers. Inputs become fields of the generated mechanism, parameters
//! those of a type of their own, and those that are computed from others stand for what they compute.

mod derived;

use std::ops::Range;

use num_traits::One;
use toml::Spanned;
use toml::de::{DeString, DeTable, DeValue};

use super::expression;
use super::names;
use super::numbers::plain_number;
use super::reader::Reader;
use super::section::{Item, Section, keyword, unfit};
use crate::diagnostics::Related;
use crate::keys::{INPUT, Key};
use crate::validate::{Owner, Place};
use crate::{Between, DerivedParameter, Parameter, Rational};

/// Fields that a generated mechanism has besides its inputs.
pub(super) const OWN_FIELDS: [&str; 2] = ["parameters", "derived"];

/// The key of a number that has no other.
const VALUE: &Key = &INPUT.keys[0];

/// Names that were met, with where they stand and in which table.
type Seen = Vec<(String, Range<usize>, &'static str)>;

/// Both tables.
pub(super) struct Tables {
    pub(super) parameters: Vec<Parameter>,
    pub(super) derived: Vec<DerivedParameter>,
    pub(super) inputs: Vec<Parameter>,
    pub(super) between: Vec<Between>,
}

/// An entry of a table.
type Entry<'t> = (&'t Spanned<DeString<'t>>, &'t Spanned<DeValue<'t>>);

/// Reads both tables, in the order of the model file. All names are known before any number refers to one.
pub(super) fn read(reader: &mut Reader<'_>, page: &Section<'_>) -> Tables {
    let mut seen = Seen::new();
    let entries = entries(reader, page, "parameters");
    let names: Vec<&str> = entries.iter().map(|(key, _)| key.get_ref().as_ref()).collect();
    let (computed, given): (Vec<Entry<'_>>, Vec<Entry<'_>>) =
        entries.iter().copied().partition(|(_, value)| is_computed(value, &names));
    let parameters = table(reader, &given, &mut seen, ("parameters", Owner::Parameter));
    let parameters: Vec<Parameter> = parameters.into_iter().map(|(parameter, _)| parameter).collect();
    reader.parameters = parameters.iter().map(|p| p.name.clone()).collect();
    reader.values = parameters.iter().map(|p| p.value.clone()).collect();
    let derived = derived::read(reader, &computed);
    seen.extend(computed.iter().map(|(key, _)| (key.get_ref().to_string(), key.span(), "parameters")));
    let given = self::entries(reader, page, "inputs");
    let (inputs, between): (Vec<_>, Vec<_>) =
        table(reader, &given, &mut seen, ("inputs", Owner::Input)).into_iter().unzip();
    reader.inputs = inputs.iter().map(|p| p.name.clone()).collect();
    Tables { parameters, derived, inputs, between }
}

/// Whether an entry names others, or something that should be one.
fn is_computed(value: &Spanned<DeValue<'_>>, names: &[&str]) -> bool {
    let term = value.get_ref().as_str().and_then(|text| expression::parse(text).ok());
    term.is_some_and(|term| term.names().iter().any(|name| *name != "pi" || names.contains(name)))
}

/// The entries of a table in the order of the model file.
fn entries<'t>(reader: &mut Reader<'_>, page: &Section<'t>, title: &'static str) -> Vec<Entry<'t>> {
    let Some(item) = page.get(title) else { return Vec::new() };
    let Some(table) = item.table(reader) else { return Vec::new() };
    let mut entries: Vec<Entry<'t>> = table.iter().collect();
    entries.sort_by_key(|(key, _)| key.span().start);
    entries
}

fn table(
    reader: &mut Reader<'_>,
    entries: &[Entry<'_>],
    seen: &mut Seen,
    (title, owner): (&'static str, fn(usize) -> Owner),
) -> Vec<(Parameter, Between)> {
    let mut parameters = Vec::new();
    for (index, (key, value)) in entries.iter().enumerate() {
        let place = Place { owner: owner(index), key: "" };
        clash(reader, place, seen, key);
        if title == "inputs" && OWN_FIELDS.contains(&key.get_ref().as_ref()) {
            reader.wrong(place, key.span(), own_field(key.get_ref()));
        }
        seen.push((key.get_ref().to_string(), key.span(), title));
        let name = name(reader, place, (key, value));
        let (value, between) = match value.get_ref() {
            DeValue::Table(table) if title == "inputs" => input(reader, place.owner, table),
            _ => {
                let place = Place { key: "value", ..place };
                (plain_number(reader, Item { place, key: VALUE, value }), Between::default())
            }
        };
        parameters.push((Parameter { name, value: value.unwrap_or_else(Rational::one) }, between));
    }
    parameters
}

/// A field has one meaning.
fn clash(reader: &mut Reader<'_>, place: Place, seen: &Seen, key: &Spanned<DeString<'_>>) {
    let name = key.get_ref().as_ref();
    let Some((_, first, table)) = seen.iter().find(|(other, ..)| other == name) else { return };
    let related = Related { span: first.clone(), label: format!("under [{table}] here") };
    let words = [
        format!("`{name}` is both a parameter and an input"),
        "used again".to_owned(),
        "rename one of them".to_owned(),
    ];
    reader.clash(place, key.span(), related, words);
}

/// The words for an input that would be such a field.
fn own_field(name: &str) -> [String; 3] {
    [
        format!("the input `{name}` clashes with a field of the generated mechanism"),
        "cannot be the name of an input".to_owned(),
        format!("choose another name, such as `{name}_0`"),
    ]
}

/// Value of an input that has more, and what the input is between the rows of a table.
fn input(reader: &mut Reader<'_>, owner: Owner, table: &DeTable<'_>) -> (Option<Rational>, Between) {
    let section = Section::open(reader, owner, "the input", table, &INPUT);
    if let (Some(item), Owner::Input(index)) = (section.get("between"), owner)
        && item.value.get_ref().as_str() != Some("smooth")
    {
        reader.corners.push((index, item.span()));
    }
    let between = match section.word(reader, "between") {
        Some("held") => Between::Held,
        Some("smooth") => Between::Smooth,
        _ => Between::Linear,
    };
    (section.plain(reader, "value"), between)
}

/// The name of an entry.
fn name(reader: &mut Reader<'_>, place: Place, (key, value): Entry<'_>) -> String {
    let name = key.get_ref().as_ref();
    reader.mark(place, value.span());
    if let Some(words) = unfit(name) {
        reader.wrong(place, key.span(), words);
    } else if names::is_keyword(name) {
        reader.wrong(place, key.span(), keyword(name));
    }
    name.to_owned()
}
