//! Motions prescribed in time: constants, polynomials, sinusoids, their sums and products, tables.

use toml::de::DeValue;

use super::formulas::Inputs;
use super::numbers::{number, radians, turns};
use super::reader::Reader;
use super::section::{Item, Section, all, found};
use super::{curves, expression, laws, lookup, names, seen, table};
use crate::keys::{MOTION, SINUSOID};
use crate::{Motion, Number, Operation, Seen};

/// The forms of a motion; each excludes the others.
const FORMS: [&str; 5] = ["polynomial", "sinusoid", "sum", "product", "table"];

/// No motion: the constant zero.
pub(super) fn rest() -> Motion {
    Motion::Polynomial(vec![Number::integer(0)])
}

/// Reads a motion: a number, or a table of one of the forms.
pub(super) fn read(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Motion> {
    let motion = match item.value.get_ref() {
        DeValue::Table(_) => form(reader, item),
        DeValue::Array(_) => {
            let words = [
                "a motion must be a number or a table".to_owned(),
                format!("found {}", found(item.value.get_ref())),
                "write a constant such as 0.5, or { polynomial = [c0, c1] }".to_owned(),
            ];
            item.wrong(reader, words);
            None
        }
        DeValue::String(text) if followed(reader, text).is_some() => followed(reader, text),
        DeValue::String(text) if moves(reader, text) => in_time(reader, item, text),
        _ => number(reader, item).map(|constant| Motion::Polynomial(vec![constant])),
    };
    if motion.is_none() {
        reader.doubt(item.place);
    }
    motion
}

/// An input that is followed, or its opposite; its rate and acceleration are found once all inputs are known.
fn followed(reader: &Reader<'_>, text: &str) -> Option<Motion> {
    let text = text.trim();
    let input = |name: &str| {
        let place = reader.inputs.iter().position(|input| input == name)?;
        Some(Motion::Input([place; 3]))
    };
    match text.strip_prefix('-') {
        None => input(text),
        Some(name) => {
            Some(Motion::Product(vec![Motion::Polynomial(vec![Number::integer(-1)]), input(name.trim())?]))
        }
    }
}

/// Whether a text is a formula rather than a number: it names the time, or calls a function.
fn moves(reader: &Reader<'_>, text: &str) -> bool {
    let Ok(term) = expression::parse(text) else { return false };
    let is_time = |name: &&str| *name == "t" && lookup::named(reader, "t").is_none();
    term.names().iter().any(is_time) || term.calls().iter().any(|name| *name != "sqrt")
}

/// A formula of time.
fn in_time(reader: &mut Reader<'_>, item: Item<'_>, text: &str) -> Option<Motion> {
    let refuse = |name: &str, seen: Seen| {
        (seen != Seen::Time).then(|| {
            let help =
                "write a formula of t and of parameters; a [[coupler]] follows other coordinates".to_owned();
            [format!("a motion cannot depend on `{name}`"), "not the time".to_owned(), help]
        })
    };
    let known = seen::known(reader, &[]);
    let read = laws::with_names(reader, &known, Inputs::Unknown, &refuse, |named| named.formula(text));
    let formula = read.map_err(|fault| lookup::wrong_within(reader, item, text, fault)).ok()?;
    curves::refuse_kinks(reader, item, &formula, "a motion");
    Some(match formula.operations.as_slice() {
        [Operation::Number(number)] => Motion::Polynomial(vec![number.clone()]),
        _ => Motion::Formula(formula),
    })
}

fn form(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Motion> {
    let section = Section::within(reader, item, "a motion", &MOTION)?;
    let mut given = FORMS.into_iter().filter(|form| section.has(form));
    let (Some(form), None) = (given.next(), given.next()) else {
        if section.is_known() {
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
        "sum" => several(reader, value, 0).map(Motion::Sum),
        "product" => several(reader, value, 0).map(Motion::Product),
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
    if item.elements().next().is_none() {
        item.wrong_type(reader, "an array of coefficients: the degree cannot be a parameter");
        return None;
    }
    all(item.elements().map(|item| number(reader, item))).map(Motion::Polynomial)
}

fn sinusoid(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Motion> {
    let section = Section::within(reader, item, "a sinusoid", &SINUSOID)?;
    let amplitude = section.given(reader, "amplitude");
    let angular_frequency = angular_frequency(reader, &section);
    let phase = phase(reader, &section);
    Some(Motion::Sinusoid { amplitude: amplitude?, angular_frequency: angular_frequency?, phase: phase? })
}

/// `angular_frequency`, rad/s, or `frequency_hz`, which must be written out: 2π times it is rounded once.
fn angular_frequency(reader: &mut Reader<'_>, section: &Section<'_>) -> Option<Number> {
    let keys = ["frequency_hz", "angular_frequency"];
    if section.either(reader, keys, "the frequency is given twice").is_none() {
        section.require(reader, "angular_frequency");
    }
    match keys.map(|key| section.has(key)) {
        [true, true] => None,
        [true, false] => section.plain(reader, "frequency_hz").map(turns),
        [false, _] => section.given(reader, "angular_frequency"),
    }
}

/// `phase`, rad, or `phase_deg`; none is zero.
fn phase(reader: &mut Reader<'_>, section: &Section<'_>) -> Option<Number> {
    let keys = ["phase_deg", "phase"];
    let item = section.either(reader, keys, "the phase is given twice");
    match (item, keys.map(|key| section.has(key))) {
        (_, [true, true]) => None,
        (_, [true, false]) => section.plain(reader, "phase_deg").map(radians),
        (Some(item), _) => number(reader, item),
        (None, _) => Some(Number::integer(0)),
    }
}

/// The motions of an array: at least one, or so many.
pub(super) fn several(reader: &mut Reader<'_>, item: Item<'_>, length: usize) -> Option<Vec<Motion>> {
    let found = item.elements().count();
    if found == 0 || length > 0 && found != length {
        let many = if length == 0 { String::new() } else { format!("{length} ") };
        item.wrong_type(reader, &format!("an array of {many}motions"));
        return None;
    }
    all(item.elements().map(|item| read(reader, item)))
}
