//! Numbers, vectors and tensors of a model file.

use num_bigint::BigInt;
use toml::de::DeValue;

use super::reader::Reader;
use super::section::{Item, Section, found};
use super::{arithmetic, names, units};
use crate::number::{SIZE_EXPONENT, in_range};
use crate::validate::{Owner, Place};
use crate::{Number, Rational, parse_decimal};

/// Keys of forces that may be inputs.
const STRENGTHS: [&str; 5] = ["value", "force", "torque", "level", "damping"];

/// What the name in place of a number may be.
#[derive(Clone, Copy)]
enum Names {
    Parameters,
    ParametersAndInputs,
}

/// Longest text of a number: longer ones only cost time.
const MAX_DIGITS: usize = 400;

impl Section<'_> {
    /// The number of a key, or a default.
    pub(super) fn number_or(&self, reader: &mut Reader<'_>, key: &'static str, default: i64) -> Number {
        let number = self.get(key).and_then(|item| number(reader, item));
        number.unwrap_or_else(|| Number::integer(default))
    }

    /// The vector of a key, or a default.
    pub(super) fn vector_or<const N: usize>(
        &self,
        reader: &mut Reader<'_>,
        key: &'static str,
        default: [i64; N],
    ) -> [Number; N] {
        let vector = self.get(key).and_then(|item| vector(reader, item));
        vector.unwrap_or_else(|| default.map(Number::integer))
    }
}

/// A number: a decimal, or a string that names a parameter.
pub(super) fn number(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Number> {
    referring(reader, item, Names::Parameters)
}

/// The strength of a force: a number that may be an input, too.
pub(super) fn strength(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Number> {
    referring(reader, item, Names::ParametersAndInputs)
}

fn referring(reader: &mut Reader<'_>, item: Item<'_>, allowed: Names) -> Option<Number> {
    match item.value.get_ref() {
        DeValue::String(text) => reference(reader, item, text, allowed),
        _ => plain_number(reader, item).map(Number::Exact),
    }
}

/// A number that cannot be a parameter.
pub(super) fn plain_number(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Rational> {
    let value = match item.value.get_ref() {
        DeValue::Float(float) => decimal(float.as_str()),
        DeValue::Integer(integer) => whole(integer.as_str(), integer.radix()),
        DeValue::String(text) => {
            let words = not_plain(reader, item.place, text);
            item.wrong(reader, words);
            return None;
        }
        other => {
            let words = [
                format!("expected a number for `{}`", item.key()),
                format!("found {}", found(other)),
                "write a number such as 0.5 or 100e-7".to_owned(),
            ];
            item.wrong(reader, words);
            return None;
        }
    };
    value.map_err(|words| item.wrong(reader, words)).ok()
}

/// The message for a string in place of a number that must be written out.
fn not_plain(reader: &Reader<'_>, place: Place, text: &str) -> [String; 3] {
    let key = place.key;
    let name = text.trim_start_matches('-');
    let is = |names: &[String]| names.iter().any(|known| known == name);
    let what = match (is(&reader.parameters), is(&reader.inputs)) {
        (true, _) => "a parameter",
        (false, true) => "an input",
        _ => {
            return arithmetic::refused(reader, place, text)
                .or_else(|| units::with_unit(place, text))
                .unwrap_or_else(|| {
                    [
                        format!("expected a number for `{key}`"),
                        format!("found the string {text:?}"),
                        "write a number such as 0.5 or 100e-7".to_owned(),
                    ]
                });
        }
    };
    let help = format!("write the number itself in place of {text:?}");
    [format!("`{key}` cannot be {what}"), what.to_owned(), help]
}

/// An array of `N` numbers.
pub(super) fn vector<const N: usize>(reader: &mut Reader<'_>, item: Item<'_>) -> Option<[Number; N]> {
    numbers(reader, item, N).and_then(|numbers| numbers.try_into().ok())
}

/// An array of some numbers.
pub(super) fn numbers(reader: &mut Reader<'_>, item: Item<'_>, length: usize) -> Option<Vec<Number>> {
    elements(reader, item, length, number)
}

/// A vector of a force's strength, whose elements may be inputs.
pub(super) fn strengths(reader: &mut Reader<'_>, item: Item<'_>) -> Option<[Number; 3]> {
    elements(reader, item, 3, strength).and_then(|numbers| numbers.try_into().ok())
}

fn elements(
    reader: &mut Reader<'_>,
    item: Item<'_>,
    length: usize,
    element: fn(&mut Reader<'_>, Item<'_>) -> Option<Number>,
) -> Option<Vec<Number>> {
    let what = format!("an array of {length} numbers");
    let example = format!("{} = [{}]", item.key(), example(item.key(), length).join(", "));
    let Some(elements) = item.value.get_ref().as_array() else {
        match (length, along_one_axis(item)) {
            (3, Some(help)) => item.wrong_type_with(reader, &what, help),
            _ => item.wrong_type(reader, &what, &example),
        }
        return None;
    };
    if elements.len() != length {
        item.wrong_type(reader, &what, &example);
    }
    let numbers: Vec<Option<Number>> =
        elements.iter().map(|value| element(reader, Item { place: item.place, value })).collect();
    let numbers: Option<Vec<Number>> = numbers.into_iter().collect();
    numbers.filter(|numbers| numbers.len() == length)
}

/// What to write instead of a number, or of an axis by its letter, where a vector of three is wanted.
fn along_one_axis(item: Item<'_>) -> Option<String> {
    let key = item.key();
    let along = |k: usize, number: &str| {
        let elements: Vec<&str> = (0..3).map(|l| if k == l { number } else { "0" }).collect();
        format!("{key} = [{}]", elements.join(", "))
    };
    let number = match item.value.get_ref() {
        DeValue::Integer(number) => number.as_str(),
        DeValue::Float(number) => number.as_str(),
        DeValue::String(text) => {
            let (sign, letter) = text.strip_prefix('-').map_or(("1", &**text), |letter| ("-1", letter));
            let k = ["x", "y", "z"].iter().position(|axis| *axis == letter.to_ascii_lowercase())?;
            return Some(format!("write {}", along(k, sign)));
        }
        _ => return None,
    };
    let is_zero = number.parse() == Ok(0.0);
    if key == "gravity" && !is_zero {
        let down = format!("-{}", number.trim_start_matches(['+', '-']));
        let [x, y, z] = [0, 1, 2].map(|k| along(k, &down));
        return Some(format!(
            "write {z} if the z axis points up, {y} if y does, {x} if x does: a single number does not say where down is"
        ));
    }
    let [x, y, z] = [0, 1, 2].map(|k| along(k, number));
    (!is_zero).then(|| format!("write {x}, {y} or {z}: a single number does not say along which axis"))
}

/// Degrees in rad.
pub(super) fn radians(degrees: Rational) -> Number {
    Number::Exact(degrees * units::pi() / Rational::from_integer(180.into()))
}

/// Something a turn as the same a radian.
pub(super) fn per_turn(value: Rational) -> Number {
    Number::Exact(value / (units::pi() * Rational::from_integer(2.into())))
}

/// Turns a second in rad/s.
pub(super) fn turns(value: Rational) -> Number {
    Number::Exact(value * units::pi() * Rational::from_integer(2.into()))
}

/// Elements of a vector that would be right.
fn example(key: &str, length: usize) -> Vec<&'static str> {
    let one = match key {
        "axis" => Some(length - 1),
        "zero" | "orientation" => Some(0),
        _ => None,
    };
    (0..length).map(|k| if Some(k) == one { "1" } else { "0" }).collect()
}

/// A reference to a parameter or an input, `"name"` or `"-name"`.
fn reference(reader: &mut Reader<'_>, item: Item<'_>, text: &str, allowed: Names) -> Option<Number> {
    let (name, negated) = text.strip_prefix('-').map_or((text, false), |name| (name, true));
    if let Some(index) = reader.parameters.iter().position(|p| p == name) {
        return Some(Number::Parameter { index, negated });
    }
    match (reader.inputs.iter().position(|input| input == name), allowed) {
        (Some(index), Names::ParametersAndInputs) => return Some(Number::Input { index, negated }),
        (Some(_), Names::Parameters) => item.wrong(reader, not_an_input(item.key(), name)),
        (None, _) => {
            let words = arithmetic::refused(reader, item.place, text)
                .or_else(|| units::with_unit(item.place, text))
                .unwrap_or_else(|| unknown_name(reader, item.key(), text, allowed));
            item.wrong(reader, words);
        }
    }
    None
}

fn not_an_input(key: &str, name: &str) -> [String; 3] {
    [
        format!("`{key}` cannot be an input"),
        "an input".to_owned(),
        format!(
            "inputs are for forces only, for their strength ({}): write the number, or declare `{name}` under \
             [parameters]",
            names::list(&STRENGTHS)
        ),
    ]
}

/// A string that neither names a number nor is one with a unit.
fn unknown_name(reader: &Reader<'_>, key: &str, text: &str, allowed: Names) -> [String; 3] {
    let name = text.strip_prefix('-').unwrap_or(text);
    let mut known: Vec<&str> = reader.parameters.iter().map(String::as_str).collect();
    let (what, tables) = match allowed {
        Names::Parameters => ("parameter", "[parameters]"),
        Names::ParametersAndInputs => {
            known.extend(reader.inputs.iter().map(String::as_str));
            ("parameter or input", "[parameters] or [inputs]")
        }
    };
    let help = if parse_decimal(text).is_some() {
        format!("write {text} without quotes")
    } else if known.is_empty() {
        format!("write a number, or declare {name} under {tables}")
    } else {
        format!("{}, or declare `{name}` under {tables}", names::instead(name, &known))
    };
    [format!("unknown {what} `{name}`"), format!("a string instead of the number `{key}`"), help]
}

/// A decimal with point or exponent.
fn decimal(text: &str) -> Result<Rational, [String; 3]> {
    let lower = text.to_ascii_lowercase();
    if lower.contains("nan") || lower.contains("inf") {
        let label = if lower.contains("nan") { "not a number" } else { "infinite" };
        return Err([
            "a number must be finite".to_owned(),
            label.to_owned(),
            "write a finite number".to_owned(),
        ]);
    }
    sized(text, (text.len() <= MAX_DIGITS).then(|| parse_decimal(text)).flatten())
}

/// An integer in any of TOML's notations.
fn whole(text: &str, radix: u32) -> Result<Rational, [String; 3]> {
    let digits = text.replace('_', "");
    let value = (text.len() <= MAX_DIGITS).then(|| BigInt::parse_bytes(digits.as_bytes(), radix)).flatten();
    sized(text, value.map(Rational::from_integer))
}

fn sized(text: &str, value: Option<Rational>) -> Result<Rational, [String; 3]> {
    value.filter(in_range).ok_or_else(|| {
        let message = if text.len() <= MAX_DIGITS {
            "a number is too large or too small"
        } else {
            "a number is too long"
        };
        [
            message.to_owned(),
            "outside the supported range".to_owned(),
            format!(
                "a number is 0, or its size is between 1e-{SIZE_EXPONENT} and 1e{SIZE_EXPONENT}, in at most \
                 {MAX_DIGITS} characters"
            ),
        ]
    })
}

/// A place of the simulation settings: a positive time.
pub(super) fn positive(
    reader: &mut Reader<'_>,
    section: &Section<'_>,
    key: &'static str,
) -> Option<Rational> {
    debug_assert_eq!(section.owner, Owner::Simulation);
    let item = section.get(key)?;
    let value = plain_number(reader, item)?;
    if value > Rational::from_integer(0.into()) {
        return Some(value);
    }
    let label = format!("{} s", crate::to_f64(&value));
    item.wrong(
        reader,
        [format!("`{key}` must be positive"), label, "write a time greater than 0, in s".to_owned()],
    );
    None
}
