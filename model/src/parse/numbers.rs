//! Numbers and vectors of a model file.

use num_bigint::BigInt;
use toml::de::DeValue;

use super::computed::{self, Meaning};
use super::expression::{self, Term};
use super::lookup::{named, wrong_within};
use super::reader::Reader;
use super::section::{Item, Section, all, found};
use super::{laws, names, units};
use crate::keys::{FORCE, Key, Value};
use crate::number::{SIZE_EXPONENT, in_range};
use crate::validate::out_of_range;
use crate::{Number, Rational, parse_decimal};

/// What the name in place of a number may be.
#[derive(Clone, Copy)]
enum Names {
    Parameters,
    ParametersAndInputs,
}

/// Longest text of a number: longer ones only cost time.
const MAX_DIGITS: usize = 400;

impl Section<'_> {
    /// The number of a key; where there is none, or a wrong one, the default, or 1, which is never refused.
    pub(super) fn number(&self, reader: &mut Reader<'_>, name: &'static str) -> Number {
        self.given(reader, name).unwrap_or_else(|| self.default(name, 0))
    }

    /// The number of a key, if there is one.
    pub(super) fn given(&self, reader: &mut Reader<'_>, name: &'static str) -> Option<Number> {
        self.find(reader, name).and_then(|item| number(reader, item))
    }

    /// The vector of a key, or the default.
    pub(super) fn vector<const N: usize>(&self, reader: &mut Reader<'_>, name: &'static str) -> [Number; N] {
        let vector = self.given_vector(reader, name);
        vector.unwrap_or_else(|| std::array::from_fn(|k| self.default(name, k)))
    }

    /// The vector of a key, if there is one.
    pub(super) fn given_vector<const N: usize>(
        &self,
        reader: &mut Reader<'_>,
        name: &'static str,
    ) -> Option<[Number; N]> {
        self.find(reader, name).and_then(|item| vector(reader, item))
    }

    /// So many numbers: one for all, or an array.
    pub(super) fn each(
        &self,
        reader: &mut Reader<'_>,
        name: &'static str,
        length: usize,
    ) -> Option<Vec<Number>> {
        let item = self.find(reader, name)?;
        match item.value.get_ref() {
            DeValue::Array(_) => numbers(reader, item, length),
            _ => number(reader, item).map(|one| vec![one; length]),
        }
    }

    /// A number that is written out, if there is one in its range.
    pub(super) fn plain(&self, reader: &mut Reader<'_>, name: &'static str) -> Option<Rational> {
        let item = self.find(reader, name)?;
        let value = plain_number(reader, item)?;
        match out_of_range(item.key, &self.title, &value) {
            Some(words) => item.wrong(reader, words),
            None => return Some(value),
        }
        None
    }

    /// The number that holds where a key is not there, or one of a vector.
    fn default(&self, name: &str, place: usize) -> Number {
        let Key { default, is_required, .. } = self.key(name);
        let mut numbers = default.trim_matches(['[', ']']).split(", ").map(|text| text.parse().ok());
        let number = numbers.nth(place).flatten().unwrap_or(i64::from(*is_required));
        Number::integer(number)
    }
}

/// A number: a decimal, or a string that names a parameter or, of a strength, an input, or has an expression in it.
pub(super) fn number(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Number> {
    let allowed = match item.key.value {
        Value::Strength(_) | Value::Strengths(_) | Value::Either([Value::Strength(_), ..]) => {
            Names::ParametersAndInputs
        }
        _ => Names::Parameters,
    };
    match (item.value.get_ref(), item.key.value) {
        (_, Value::Plain(_)) => plain_number(reader, item).map(Number::Exact),
        (DeValue::String(text), _) => reference(reader, item, text, allowed),
        _ => plain_number(reader, item).map(Number::Exact),
    }
}

/// A number that cannot be a parameter.
pub(super) fn plain_number(reader: &mut Reader<'_>, item: Item<'_>) -> Option<Rational> {
    let value = match item.value.get_ref() {
        DeValue::Float(float) => decimal(float.as_str()),
        DeValue::Integer(integer) => whole(integer.as_str(), integer.radix()),
        DeValue::String(text) => return plain_expression(reader, item, text),
        other => {
            let words = [
                format!("expected a number for `{}`", item.key.name),
                format!("found {}", found(other)),
                "write a number such as 0.5 or 100e-7".to_owned(),
            ];
            item.wrong(reader, words);
            return None;
        }
    };
    value.map_err(|words| item.wrong(reader, words)).ok()
}

/// An expression in place of a number that must be written out: it may not name parameters.
fn plain_expression(reader: &mut Reader<'_>, item: Item<'_>, text: &str) -> Option<Rational> {
    let key = item.key.name;
    let name = text.trim_start_matches('-');
    let what = match (names_parameter(reader, name), reader.inputs.iter().any(|input| input == name)) {
        (true, _) => "a parameter",
        (false, true) => "an input",
        (false, false) if is_word(text) || parse_decimal(text).is_some() => {
            let words = [
                format!("expected a number for `{key}`"),
                format!("found the string {text:?}"),
                "write a number such as 0.5 or 100e-7".to_owned(),
            ];
            item.wrong(reader, words);
            return None;
        }
        _ => {
            return match computed(reader, item, text)? {
                Number::Exact(value) => Some(value),
                _ => {
                    let words = [
                        format!("`{key}` cannot be computed from parameters"),
                        "names a parameter".to_owned(),
                        format!("write the number itself in place of {text:?}"),
                    ];
                    item.wrong(reader, words);
                    None
                }
            };
        }
    };
    let help = format!("write the number itself in place of {text:?}");
    item.wrong(reader, [format!("`{key}` cannot be {what}"), what.to_owned(), help]);
    None
}

/// An array of `N` numbers.
pub(super) fn vector<const N: usize>(reader: &mut Reader<'_>, item: Item<'_>) -> Option<[Number; N]> {
    numbers(reader, item, N).and_then(|numbers| numbers.try_into().ok())
}

/// An array of some numbers.
pub(super) fn numbers(reader: &mut Reader<'_>, item: Item<'_>, length: usize) -> Option<Vec<Number>> {
    let key = item.key.name;
    let what = format!("an array of {length} numbers");
    let help = format!("write {key} = [{}]", example(key, length).join(", "));
    let Some(elements) = item.value.get_ref().as_array() else {
        let along = along_one_axis(item).filter(|_| length == 3);
        item.wrong_type_with(reader, &what, along.unwrap_or(help));
        return None;
    };
    if elements.len() != length {
        item.wrong_type_with(reader, &what, help);
    }
    let numbers = all(item.elements().map(|item| number(reader, item)));
    numbers.filter(|numbers| numbers.len() == length)
}

/// What to write instead of a number, or of an axis by its letter, where a vector of three is wanted.
fn along_one_axis(item: Item<'_>) -> Option<String> {
    let key = item.key.name;
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

/// A parameter, an input or an expression; of a strength a formula, too.
fn reference(reader: &mut Reader<'_>, item: Item<'_>, text: &str, allowed: Names) -> Option<Number> {
    let (name, negated) = text.strip_prefix('-').map_or((text, false), |name| (name, true));
    if let Some(number) = named(reader, name) {
        return Some(if negated { -number } else { number });
    }
    match (reader.inputs.iter().position(|input| input == name), allowed) {
        (Some(index), Names::ParametersAndInputs) => return Some(Number::Input { index, negated }),
        (Some(_), Names::Parameters) => item.wrong(reader, not_an_input(item.key.name, name)),
        (None, Names::ParametersAndInputs) if laws::is_meant(reader, item, name) => {
            return laws::strength(reader, item, text);
        }
        (None, _) if is_word(text) || parse_decimal(text).is_some() || is_hyphenated(reader, text) => {
            item.wrong(reader, unknown_name(reader, item.key.name, text, allowed));
        }
        (None, Names::ParametersAndInputs) => return laws::strength(reader, item, text),
        (None, Names::Parameters) => return computed(reader, item, text),
    }
    None
}

fn names_parameter(reader: &Reader<'_>, name: &str) -> bool {
    named(reader, name).is_some()
}

/// Whether a string is a single word: a name, but for the one that every expression knows.
fn is_word(text: &str) -> bool {
    let word = text.strip_prefix('-').unwrap_or(text);
    word != "pi"
        && !word.starts_with(|c: char| c.is_ascii_digit())
        && word.chars().all(|c| c.is_alphanumeric() || c == '_')
}

/// Whether a string is a name that is written with hyphens.
fn is_hyphenated(reader: &Reader<'_>, text: &str) -> bool {
    let meant = names::snake_case(text);
    let is_known =
        |name: &str| names_parameter(reader, name) || reader.inputs.iter().any(|input| input == name);
    text.chars().all(|c| c.is_alphanumeric() || c == '_' || c == '-')
        && is_known(&meant)
        && !text.split('-').any(is_known)
}

/// The number that an expression of parameters denotes.
pub(super) fn computed(reader: &mut Reader<'_>, item: Item<'_>, text: &str) -> Option<Number> {
    let term = expression::parse(text).map_err(|at| broken(reader, item, text, at)).ok()?;
    if let Some(words) = misused_unit(item.key, text, &term) {
        item.wrong(reader, words);
        return None;
    }
    let meaning = Meaning {
        named: &|name| named(reader, name),
        unknown: &|name| {
            if reader.inputs.iter().any(|input| input == name) {
                input_within(name)
            } else {
                unknown_in_expression(reader, name)
            }
        },
        values: &reader.values,
    };
    let number = meaning.number(&term);
    number.map_err(|fault| wrong_within(reader, item, text, fault)).ok()
}

/// Reports a string that is no expression: a number with a unit, or one that breaks off at a place.
pub(super) fn broken(reader: &mut Reader<'_>, item: Item<'_>, text: &str, at: usize) {
    let rest = units::rest(text).unwrap_or_default();
    let is_known = |word: &str| named(reader, word).is_some();
    let word = rest.split(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or_default();
    let is_unit = !is_known(word)
        && (rest.starts_with(|c: char| c.is_alphabetic() || c == '°') || rest.starts_with("1/"));
    match units::with_unit(item.key, text).filter(|_| is_unit) {
        Some(words) => item.wrong(reader, words),
        None => {
            let fault = computed::syntax(text, at, &is_known);
            wrong_within(reader, item, text, fault);
        }
    }
}

/// The message for a unit of angle, or of its rate, where the key has another.
fn misused_unit(key: &Key, text: &str, term: &Term) -> Option<[String; 3]> {
    let units = term.units();
    let expected = key.unit()?;
    let is_angle = expected.contains("rad") && !expected.contains("rad/s");
    // Of a motion, coefficients may be of any derivative.
    let is_motion = matches!(key.value, Value::Motion(_) | Value::Motions(..));
    let is_misused = !units.is_empty() && !expected.contains("rad")
        || is_angle && !is_motion && units.iter().any(|unit| unit.is_rate());
    is_misused.then(|| {
        units::with_unit(key, text).unwrap_or_else(|| {
            [
                format!("`{}` must be a number in {expected}", key.name),
                "an expression with a unit of angle".to_owned(),
                format!("write it without the unit, in {expected}"),
            ]
        })
    })
}

fn input_within(name: &str) -> [String; 3] {
    let help =
        format!("declare `{name}` under [parameters]: only strengths of forces may be computed from inputs");
    [format!("the input `{name}` cannot be part of a number"), "an input".to_owned(), help]
}

/// The message for an unknown name in an expression.
pub(super) fn unknown_in_expression(reader: &Reader<'_>, name: &str) -> [String; 3] {
    let derived = reader.derived.iter().map(|(name, _)| name.as_str());
    let known: Vec<&str> = reader.parameters.iter().map(String::as_str).chain(derived).collect();
    let moves = reader.has_joint(name);
    let help = match name.to_ascii_lowercase().as_str() {
        _ if moves => format!(
            "this number is a constant or computed from parameters, and `{name}` is a joint, which moves: only strengths \
             of forces may be formulas of what moves ({})",
            names::list(&strengths())
        ),
        "tau" => "write 2*pi".to_owned(),
        "pi" => "write pi".to_owned(),
        _ if known.is_empty() => format!("write a number, or declare `{name}` under [parameters]"),
        _ => format!("{}, or declare `{name}` under [parameters]", names::instead(name, &known)),
    };
    [format!("unknown parameter `{name}`"), "in this expression".to_owned(), help]
}

/// Keys of forces that may be inputs.
fn strengths() -> Vec<&'static str> {
    let mut all = FORCE.all();
    all.retain(|key| matches!(key.value, Value::Strength(_) | Value::Strengths(_)));
    all.into_iter().map(|key| key.name).collect()
}

fn not_an_input(key: &str, name: &str) -> [String; 3] {
    [
        format!("`{key}` cannot be an input"),
        "an input".to_owned(),
        format!(
            "inputs are for forces only, for their strength ({}): write the number, or declare `{name}` under \
             [parameters]",
            names::list(&strengths())
        ),
    ]
}

/// A string that neither names a number nor is one with a unit.
fn unknown_name(reader: &Reader<'_>, key: &str, text: &str, allowed: Names) -> [String; 3] {
    let name = text.strip_prefix('-').unwrap_or(text);
    let derived = reader.derived.iter().map(|(name, _)| name.as_str());
    let mut known: Vec<&str> = reader.parameters.iter().map(String::as_str).chain(derived).collect();
    let (what, tables) = match allowed {
        Names::Parameters => ("parameter", "[parameters]"),
        Names::ParametersAndInputs => {
            known.extend(reader.inputs.iter().map(String::as_str));
            ("parameter or input", "[parameters] or [inputs]")
        }
    };
    let moving =
        reader.visible.iter().map(|(name, _)| name).chain(reader.formulas.iter().map(|(name, _)| name));
    let moving: Vec<&str> = moving.map(String::as_str).collect();
    let is_strength = matches!(allowed, Names::ParametersAndInputs);
    let help = if parse_decimal(text).is_some() {
        format!("write {text} without quotes")
    } else if let Some(meant) = names::meant(name, &moving).filter(|_| is_strength) {
        format!("write `{meant}`, or declare `{name}` under {tables}")
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
