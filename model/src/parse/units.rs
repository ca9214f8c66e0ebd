//! Numbers written with a unit: which unit is meant by a key, and what the number is in it.

use num_traits::ToPrimitive;

use crate::keys::{JOINT, Key, SINUSOID, Table, Value};
use crate::{Rational, parse_decimal};

/// π to more digits than any `f64` distinguishes, so that what is computed with it is rounded once.
const PI: &str = "3.14159265358979323846264338327950288419717";

/// π, to 42 digits: what formulas and angles in degrees are computed with.
pub fn pi() -> Rational {
    parse_decimal(PI).expect("π is a decimal")
}

/// The message for a number that is written as a string with its unit; `None` for other strings.
pub(super) fn with_unit(key: &Key, text: &str) -> Option<[String; 3]> {
    let name = key.name;
    let (number, unit) = split(text)?;
    let expected = key.unit();
    let message = match expected {
        Some(expected) => format!("`{name}` must be a number in {expected}, without a unit"),
        None => format!("`{name}` must be a number, without a unit"),
    };
    let in_base = known(unit).map(|(base, factor)| (base, &number * factor));
    let label = match &in_base {
        Some(_) => format!("a string with the unit `{unit}`"),
        None => format!("a string with the unknown unit `{unit}`"),
    };
    let help = match (in_base, expected) {
        (Some((base, value)), Some(expected)) if expected.split(" or ").any(|unit| unit == base) => {
            let in_degrees = if is_degrees(unit) && has_degrees(key) {
                format!(", or {name}_deg = {}", plain(&number))
            } else {
                String::new()
            };
            format!("write {} in place of {text:?}{in_degrees}", plain(&value))
        }
        (_, Some(expected)) => format!("write the number alone, in {expected}"),
        (_, None) => "write the number alone; all units are SI".to_owned(),
    };
    Some([message, label, help])
}

/// A number and what follows it.
fn split(text: &str) -> Option<(Rational, &str)> {
    let text = text.trim();
    if parse_decimal(text).is_some() {
        return None;
    }
    let ends = text.char_indices().map(|(at, _)| at).filter(|&at| at > 0 && at <= 40);
    let longest = ends.rev().find_map(|at| Some((parse_decimal(&text[..at])?, text[at..].trim())));
    longest.filter(|(_, unit)| !unit.is_empty())
}

/// What follows a number at the start of a string.
pub(super) fn rest(text: &str) -> Option<&str> {
    split(text).map(|(_, rest)| rest)
}

fn is_degrees(unit: &str) -> bool {
    matches!(unit, "deg" | "°" | "degree" | "degrees")
}

/// Whether the angle has a second key in degrees.
fn has_degrees(key: &Key) -> bool {
    let degrees = |table: &Table| table.all().iter().any(|other| other.name == format!("{}_deg", key.name));
    matches!(key.value, Value::Number("rad")) && [&JOINT, &SINUSOID].into_iter().any(degrees)
}

/// The SI unit of a known unit, and its size in it.
fn known(unit: &str) -> Option<(&'static str, Rational)> {
    let decimal = |text: &str| parse_decimal(text).expect("a decimal");
    let degree = || pi() / decimal("180");
    let (base, size) = match unit {
        "rad" => ("rad", decimal("1")),
        "rad/s" => ("rad/s", decimal("1")),
        unit if is_degrees(unit) => ("rad", degree()),
        "deg/s" | "°/s" => ("rad/s", degree()),
        "rpm" | "1/min" => ("rad/s", pi() / decimal("30")),
        "Hz" => ("Hz", decimal("1")),
        "m" => ("m", decimal("1")),
        "mm" => ("m", decimal("1e-3")),
        "cm" => ("m", decimal("1e-2")),
        "um" | "µm" => ("m", decimal("1e-6")),
        "km" => ("m", decimal("1e3")),
        "in" | "inch" => ("m", decimal("0.0254")),
        "m/s" => ("m/s", decimal("1")),
        "mm/s" => ("m/s", decimal("1e-3")),
        "m/s2" | "m/s^2" | "m/s²" => ("m/s2", decimal("1")),
        "kg" => ("kg", decimal("1")),
        "g" => ("kg", decimal("1e-3")),
        "s" => ("s", decimal("1")),
        "ms" => ("s", decimal("1e-3")),
        "us" | "µs" => ("s", decimal("1e-6")),
        "min" => ("s", decimal("60")),
        "N" => ("N", decimal("1")),
        "kN" => ("N", decimal("1e3")),
        "Nm" | "N.m" | "N*m" => ("N.m", decimal("1")),
        "mNm" => ("N.m", decimal("1e-3")),
        _ => return None,
    };
    Some((base, size))
}

/// A number as one would write it.
fn plain(value: &Rational) -> String {
    value.to_f64().map_or_else(String::new, shown)
}

/// The same of a float.
pub(super) fn shown(value: f64) -> String {
    format!("{value:?}").trim_end_matches(".0").to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::keys::{BODY, FORCE};

    #[test]
    fn units_are_told_and_converted() {
        let keys: Vec<&Key> = [&JOINT, &BODY, &FORCE].iter().flat_map(|table| table.all()).collect();
        let key = |name: &str| *keys.iter().find(|key| key.name == name).expect("a key");
        let check = |name: &str, text: &str, expected: &str| {
            let [_, _, help] = with_unit(key(name), text).unwrap_or_default();
            assert_eq!(help, expected, "{name} = {text:?}");
        };
        check("angle", "30 deg", "write 0.5235987755982989 in place of \"30 deg\", or angle_deg = 30");
        check("rate", "60rpm", "write 6.283185307179586 in place of \"60rpm\"");
        check("mass", "80 g", "write 0.08 in place of \"80 g\"");
        check("mass", "3 lb", "write the number alone, in kg");
        check("length", "2e3 mm", "write 2 in place of \"2e3 mm\"");
        assert_eq!(with_unit(key("mass"), "rod_mass"), None);
        assert_eq!(with_unit(key("mass"), "3"), None);
        assert_eq!(with_unit(key("mass"), "é"), None);
    }
}
