//! Numbers, vectors and tensors of a page.

use num_bigint::BigInt;
use toml::Spanned;
use toml::de::DeValue;

use super::names;
use super::reader::Reader;
use super::section::{Item, Section, found};
use crate::number::{SIZE_EXPONENT, in_range};
use crate::validate::Owner;
use crate::{Number, Rational, parse_decimal};

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

/// A number: a decimal, or a text that names a parameter.
pub(super) fn number(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Number> {
    match item.value.get_ref() {
        DeValue::String(text) => reference(reader, item, text),
        _ => plain_number(reader, item).map(Number::Exact),
    }
}

/// A number that cannot be a parameter.
pub(super) fn plain_number(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Rational> {
    let value = match item.value.get_ref() {
        DeValue::Float(float) => decimal(float.as_str()),
        DeValue::Integer(integer) => whole(integer.as_str(), integer.radix()),
        DeValue::String(text)
            if reader.parameters.iter().any(|name| *name == text.trim_start_matches('-')) =>
        {
            let help = format!("write the number itself in place of {text:?}");
            item.wrong(
                reader,
                [format!("`{}` cannot be a parameter", item.key()), "a parameter".to_owned(), help],
            );
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

/// An array of `N` numbers.
pub(super) fn vector<const N: usize>(reader: &mut Reader<'_>, item: Item<'_>) -> Option<[Number; N]> {
    let what = format!("an array of {N} numbers");
    let example = format!("{} = [{}]", item.key(), example(item.key(), N).join(", "));
    let Some(elements) = item.value.get_ref().as_array() else {
        item.wrong_type(reader, &what, &example);
        return None;
    };
    if elements.len() != N {
        item.wrong_type(reader, &what, &example);
    }
    let numbers: Vec<Option<Number>> =
        elements.iter().map(|value| number(reader, Item { place: item.place, value })).collect();
    let numbers: Option<Vec<Number>> = numbers.into_iter().collect();
    numbers.and_then(|numbers| numbers.try_into().ok())
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

/// An inertia tensor: `[xx, yy, zz]`, a table of its elements or a symmetric matrix.
pub(super) fn tensor(reader: &mut Reader<'_>, item: Item<'_>) -> Option<[Number; 6]> {
    match item.value.get_ref() {
        DeValue::Table(_) => tensor_of_elements(reader, item),
        DeValue::Array(rows) if !rows.is_empty() && rows.iter().all(|row| row.get_ref().is_array()) => {
            tensor_of_rows(reader, item, rows)
        }
        DeValue::Array(elements) if elements.len() == 3 => {
            let [xx, yy, zz] = vector(reader, item)?;
            Some([xx, yy, zz, Number::integer(0), Number::integer(0), Number::integer(0)])
        }
        _ => {
            item.wrong_type(
                reader,
                "three moments of inertia, a table of elements or a symmetric matrix",
                "inertia = [xx, yy, zz], { xx = .., yy = .., zz = .., xy = .., xz = .., yz = .. } or three rows of three",
            );
            None
        }
    }
}

const ELEMENTS: [&str; 6] = ["xx", "yy", "zz", "xy", "xz", "yz"];

fn tensor_of_elements(reader: &mut Reader<'_>, item: Item<'_>) -> Option<[Number; 6]> {
    let table = item.value.get_ref().as_table()?;
    // The elements are marked under the body's own place: they are judged together, as its inertia.
    let section = Section::open(reader, item.place.owner, "an inertia", table, &ELEMENTS);
    let mut whole = true;
    let elements = ELEMENTS.map(|key| match section.get(key) {
        Some(element) => {
            let number = number(reader, Item { place: element.place, value: element.value });
            whole &= number.is_some();
            number.unwrap_or_else(|| Number::integer(0))
        }
        None => {
            if key.as_bytes()[0] == key.as_bytes()[1] {
                whole = false;
                let words = [
                    format!("the inertia has no `{key}`"),
                    format!("needs `{key}`"),
                    format!("write {key} = ..."),
                ];
                reader.missing(item.place, words);
            }
            Number::integer(0)
        }
    });
    if !whole {
        reader.doubt(item.place);
    }
    whole.then_some(elements)
}

fn tensor_of_rows(
    reader: &mut Reader<'_>,
    item: Item<'_>,
    rows: &[Spanned<DeValue<'_>>],
) -> Option<[Number; 6]> {
    if rows.len() != 3 {
        item.wrong_type(
            reader,
            "a matrix of three rows of three numbers",
            "[[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]",
        );
        return None;
    }
    let rows: Vec<Option<[Number; 3]>> =
        rows.iter().map(|value| vector(reader, Item { place: item.place, value })).collect();
    let rows: Vec<[Number; 3]> = rows.into_iter().collect::<Option<_>>()?;
    for (i, j) in [(0, 1), (0, 2), (1, 2)] {
        if rows[i][j] != rows[j][i] {
            let axes = ["x", "y", "z"];
            let words = [
                "an inertia tensor is symmetric".to_owned(),
                format!("{0}{1} differs from {1}{0}", axes[i], axes[j]),
                format!(
                    "write the same number in row {}, column {} and in row {1}, column {0}",
                    i + 1,
                    j + 1
                ),
            ];
            item.wrong(reader, words);
            return None;
        }
    }
    let [[xx, xy, xz], [_, yy, yz], [_, _, zz]] = <[[Number; 3]; 3]>::try_from(rows).ok()?;
    Some([xx, yy, zz, xy, xz, yz])
}

/// A reference to a parameter, `"name"` or `"-name"`.
fn reference(reader: &mut Reader<'_>, item: Item<'_>, text: &str) -> Option<Number> {
    let (name, negated) = text.strip_prefix('-').map_or((text, false), |name| (name, true));
    if let Some(index) = reader.parameters.iter().position(|p| p == name) {
        return Some(Number::Parameter { index, negated });
    }
    let help = if parse_decimal(text).is_some() {
        format!("write {text} without quotes")
    } else if reader.parameters.is_empty() {
        format!("write a number, or declare {name} under [parameters]")
    } else {
        let known: Vec<&str> = reader.parameters.iter().map(String::as_str).collect();
        format!("{}, or declare `{name}` under [parameters]", names::instead(name, &known))
    };
    let words = [
        format!("unknown parameter `{name}`"),
        format!("text in place of the number `{}`", item.key()),
        help,
    ];
    item.wrong(reader, words);
    None
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
            "cannot be computed with".to_owned(),
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
