//! Strings with arithmetic in them: a model file has numbers and names only.

use std::f64::consts::{PI, TAU};

use super::names::snake_case;
use super::reader::Reader;
use super::units;
use crate::validate::Place;

/// Functions and constants of other languages.
const FUNCTIONS: [&str; 12] =
    ["pi", "tau", "sqrt", "sin", "cos", "tan", "asin", "acos", "atan", "exp", "radians", "abs"];

/// The message for a string with arithmetic in it; `None` for other strings.
pub(super) fn refused(reader: &Reader<'_>, place: Place, text: &str) -> Option<[String; 3]> {
    if !is_arithmetic(reader, text) {
        return None;
    }
    let help = match value(text) {
        Some(value) => format!("write {} in place of {text:?}", units::shown(value)),
        None if names(text).any(|name| is_known(reader, name)) => {
            "write the result as a number, or declare another \
             parameter for it under [parameters]; of a parameter only \"name\" and \"-name\" can be written"
                .to_owned()
        }
        None => "write the result as a number".to_owned(),
    };
    Some([
        format!("`{}` must be a number or a name: arithmetic is not supported", place.key),
        "an expression".to_owned(),
        help,
    ])
}

/// Operators between numbers and names, not those of a unit after a number.
fn is_arithmetic(reader: &Reader<'_>, text: &str) -> bool {
    let text = text.trim();
    let is_operator = |c: char| matches!(c, '+' | '*' | '/' | '^' | '(' | '×' | '·' | '÷');
    let is_function = |name: &str| FUNCTIONS.contains(&name.to_ascii_lowercase().as_str());
    // A name with a hyphen is a name written in another style.
    let hyphen = !text.contains(is_operator) && !text.starts_with(|c: char| c.is_ascii_digit() || c == '.');
    if hyphen && is_known(reader, &snake_case(text)) {
        return false;
    }
    let computes = text.contains(is_operator) || minus(text).is_some();
    let knows = names(text).any(|name| is_known(reader, name) || is_function(name));
    // `3*` and `2(` go on with a factor, `3 N*m` with a unit.
    let rest = units::rest(text).unwrap_or(text);
    let has_unit = rest.len() < text.len() && !rest.starts_with(|c: char| is_operator(c) || c == '-');
    computes && (knows || !has_unit && !hyphen && is_formula(text))
        || names(text).eq([text]) && is_function(text)
}

/// Whether there is nothing but what formulas are made of.
fn is_formula(text: &str) -> bool {
    text.chars().all(|c| c.is_ascii_alphanumeric() || "_.+-*/^()×·÷ ,".contains(c))
}

fn is_known(reader: &Reader<'_>, name: &str) -> bool {
    reader.parameters.iter().chain(&reader.inputs).any(|known| known == name)
}

/// The words in a string.
fn names(text: &str) -> impl Iterator<Item = &str> {
    text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_'))
        .filter(|word| word.starts_with(|c: char| c.is_ascii_alphabetic()))
}

/// Where a minus stands between two operands, not before the first or in an exponent.
fn minus(text: &str) -> Option<usize> {
    let operand = |c: char| c.is_ascii_alphanumeric() || matches!(c, '.' | ')' | '_');
    let exponent = |before: &str| {
        let number = before.strip_suffix(['e', 'E']);
        number.is_some_and(|number| number.ends_with(|c: char| c.is_ascii_digit() || c == '.'))
    };
    text.match_indices('-').map(|(at, _)| at).find(|&at| {
        let before = text[..at].trim_end();
        before.ends_with(operand) && !exponent(before) && text[at + 1..].trim_start().starts_with(operand)
    })
}

/// The value of two numbers with an operator between them, or of π.
fn value(text: &str) -> Option<f64> {
    let text = text.trim();
    let number = |text: &str| match text.trim().trim_start_matches('-') {
        "pi" => Some(if text.trim().starts_with('-') { -PI } else { PI }),
        "tau" => Some(if text.trim().starts_with('-') { -TAU } else { TAU }),
        _ => text.trim().parse::<f64>().ok().filter(|value| value.is_finite()),
    };
    let computed = text.char_indices().filter(|(_, c)| matches!(c, '*' | '/' | '+')).map(|(at, _)| at);
    let mut places: Vec<usize> = computed.chain(minus(text)).collect();
    places.sort_unstable();
    let Some(&at) = places.first() else { return number(text) };
    let (a, b) = (number(&text[..at])?, number(&text[at + 1..])?);
    let value = match &text[at..=at] {
        "*" => a * b,
        "/" => a / b,
        "+" => a + b,
        _ => a - b,
    };
    (value.is_finite() && (value == 0.0 || (1e-100..=1e100).contains(&value.abs()))).then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arithmetic_is_told_from_units_and_names() {
        let mut load = |_: &str| Err(String::new());
        let mut reader = Reader::new("", &mut load);
        reader.parameters = vec!["length".to_owned(), "half_length".to_owned()];
        let check = |text: &str, expected: bool| assert_eq!(is_arithmetic(&reader, text), expected, "{text}");
        for text in [
            "2*length",
            "length/2",
            "-length/2",
            "length - 1",
            "2 * pi",
            "pi",
            "pi/2",
            "1/3",
            "sqrt(2)",
            "0.5+1",
            "2(length)",
            "-(length)",
            "3*width",
            "length-half_length",
            "1 - 2",
            "2^3",
            "2·length",
        ] {
            check(text, true);
        }
        for text in [
            "length",
            "-length",
            "30 deg",
            "3 N*m",
            "1e-3",
            "60 1/min",
            "2 kg*m^2",
            "9.81 m/s^2",
            "lenth",
            "5 m/s",
            "",
            "é",
            "a-b c",
            "half-length",
            "-half-length",
            "1e-3 m",
            "0.1 kg-m2",
        ] {
            check(text, false);
        }
    }

    #[test]
    fn what_two_numbers_make_is_told() {
        let check = |text: &str, expected: Option<f64>| assert_eq!(value(text), expected, "{text}");
        check("1/3", Some(1.0 / 3.0));
        check("-pi/2", Some(-PI / 2.0));
        check("2 * pi", Some(TAU));
        check("3-1e-1", Some(2.9));
        check("1/0", None);
        check("2*length", None);
        check("1+2+3", None);
    }
}
