//! Motions prescribed in time: constants, polynomials, sinusoids, their sums and products, tables.

use toml::de::{DeTable, DeValue};

use super::names;
use super::numbers::{number, plain_number, radians, turns};
use super::reader::Reader;
use super::section::{Item, Section, found};
use super::table;
use crate::{Motion, Number};

/// The forms of a motion; each excludes the others.
const FORMS: [&str; 5] = ["polynomial", "sinusoid", "sum", "product", "table"];
const KEYS: [&str; 7] = ["polynomial", "sinusoid", "sum", "product", "table", "columns", "between"];
const SINUSOID_KEYS: [&str; 5] = ["amplitude", "angular_frequency", "frequency_hz", "phase", "phase_deg"];

/// No motion: the constant zero.
pub(super) fn rest() -> Motion {
    Motion::Polynomial(vec![Number::integer(0)])
}

/// Reads a motion: a number, or a table of one of the forms.
pub(super) fn read(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Motion> {
    let motion = match item.value.get_ref() {
        DeValue::Table(table) => form(reader, item, table),
        DeValue::Array(_) => {
            let words = [
                "a motion must be a number or a table".to_owned(),
                format!("found {}", found(item.value.get_ref())),
                "write a constant such as 0.5, or { polynomial = [c0, c1] }".to_owned(),
            ];
            item.wrong(reader, words);
            None
        }
        _ => number(reader, item).map(|constant| Motion::Polynomial(vec![constant])),
    };
    if motion.is_none() {
        reader.doubt(item.place);
    }
    motion
}

fn form(reader: &mut Reader<'_>, item: Item<'_>, table: &DeTable<'_>) -> Option<Motion> {
    let section = Section::open(reader, item.place.owner, "a motion", table, &KEYS);
    let mut given = FORMS.into_iter().filter(|form| section.has(form));
    let (Some(form), None) = (given.next(), given.next()) else {
        if table.keys().all(|key| KEYS.contains(&key.get_ref().as_ref())) {
            item.wrong(reader, not_one_form(&section));
        }
        return None;
    };
    if form != "table" {
        section.refuse(reader, "columns", "only a table has columns", "remove `columns`");
        section.refuse(reader, "between", "only a table has something between its rows", "remove `between`");
    }
    let value = section.get(form)?;
    match form {
        "polynomial" => polynomial(reader, value),
        "sinusoid" => sinusoid(reader, value),
        "sum" => several(reader, value).map(Motion::Sum),
        "product" => several(reader, value).map(Motion::Product),
        _ => table::read(reader, &section, value),
    }
}

fn not_one_form(section: &Section<'_>) -> [String; 3] {
    let given: Vec<&str> = FORMS.into_iter().filter(|form| section.has(form)).collect();
    let label = match given.as_slice() {
        [] => "has none".to_owned(),
        given => format!("has {}", names::list(given)),
    };
    let help = format!("write one of {}; `sum` and `product` combine several motions", names::list(&FORMS));
    ["a motion must have exactly one form".to_owned(), label, help]
}

fn polynomial(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Motion> {
    let elements = item.value.get_ref().as_array().filter(|elements| !elements.is_empty());
    let Some(elements) = elements else {
        let expected = "an array of coefficients: the degree cannot be a parameter";
        item.wrong_type(reader, expected, "polynomial = [c0, c1, c2], for c0 + c1 t + c2 t^2");
        return None;
    };
    let coefficients: Vec<Option<Number>> =
        elements.iter().map(|value| number(reader, Item { value, ..item })).collect();
    coefficients.into_iter().collect::<Option<Vec<Number>>>().map(Motion::Polynomial)
}

fn sinusoid(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Motion> {
    const EXAMPLE: &str = "sinusoid = { amplitude = 0.1, frequency_hz = 2 }";
    let table = item.table(reader, EXAMPLE)?;
    let section = Section::open(reader, item.place.owner, "a sinusoid", table, &SINUSOID_KEYS);
    let example = ("the sinusoid", "amplitude = ..., in rad or m");
    let amplitude = section.require_within(reader, item, "amplitude", example);
    let amplitude = amplitude.and_then(|item| number(reader, item));
    let angular_frequency = angular_frequency(reader, &section, item);
    let phase = phase(reader, &section);
    Some(Motion::Sinusoid { amplitude: amplitude?, angular_frequency: angular_frequency?, phase: phase? })
}

/// `angular_frequency`, rad/s, or `frequency_hz`, which must be written out: 2π times it is rounded once.
fn angular_frequency(reader: &mut Reader<'_>, section: &Section<'_>, whole: Item<'_>) -> Option<Number> {
    if !section.has("frequency_hz") {
        let example = ("the sinusoid", "angular_frequency = ..., in rad/s, or frequency_hz = ...");
        let item = section.require_within(reader, whole, "angular_frequency", example)?;
        return number(reader, item);
    }
    let help = "remove `angular_frequency` or `frequency_hz`";
    section.refuse(reader, "angular_frequency", "the frequency is given twice", help);
    let item = section.get("frequency_hz")?;
    plain_number(reader, item).map(turns).filter(|_| !section.has("angular_frequency"))
}

/// `phase`, rad, or `phase_deg`; none is zero.
fn phase(reader: &mut Reader<'_>, section: &Section<'_>) -> Option<Number> {
    let Some(degrees) = section.get("phase_deg") else {
        return section.get("phase").map_or_else(|| Some(Number::integer(0)), |item| number(reader, item));
    };
    section.refuse(reader, "phase", "the phase is given twice", "remove `phase` or `phase_deg`");
    plain_number(reader, degrees).map(radians).filter(|_| !section.has("phase"))
}

fn several(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Vec<Motion>> {
    let elements = item.value.get_ref().as_array().filter(|elements| !elements.is_empty());
    let Some(elements) = elements else {
        let example = format!("{} = [motion, motion]", item.key());
        item.wrong_type(reader, "an array of motions", &example);
        return None;
    };
    let motions: Vec<Option<Motion>> =
        elements.iter().map(|value| read(reader, Item { value, ..item })).collect();
    motions.into_iter().collect()
}
