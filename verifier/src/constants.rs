//! The exact constants behind a module's literals: a text that the generator writes and nobody trusts.
//!
//! One line a literal: `0.1 = 1/10`, `-0.7071067811865475 = -1/2*sqrt(2)`. Each must round to its literal; whether it is the right
//! number is seen when the identities hold.

use crate::field::Constant;
use crate::refusal::Refusal;
use gyro_model::Rational;
use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};
use std::cmp::Ordering;
use std::collections::HashMap;

/// The exact constants of a module.
#[derive(Clone, Debug, Default)]
pub struct Constants {
    /// In the order of the text.
    pub values: Vec<Constant>,
    /// Line of each.
    pub lines: Vec<usize>,
    places: HashMap<String, usize>,
}

impl Constants {
    /// Reads the text and checks that every number rounds to its literal.
    ///
    /// # Errors
    /// The first line that is malformed, repeats a literal or does not round to it.
    pub fn read(text: &str) -> Result<Self, Refusal> {
        let mut constants = Self::default();
        for (index, line) in text.lines().enumerate() {
            let refuse = |message: String| Err(Refusal::new(index + 1, message));
            let Some((literal, constant)) = line.split_once(" = ").and_then(|(l, c)| Some((l, read(l, c)?)))
            else {
                return refuse(format!(
                    "`{line}` is not `LITERAL = RATIONAL` or `LITERAL = RATIONAL*sqrt(RATIONAL)`"
                ));
            };
            if !rounds(&constant) {
                return refuse(format!("`{line}`: the number does not round to its literal"));
            }
            if constants.places.insert(literal.to_owned(), constants.values.len()).is_some() {
                return refuse(format!("a second line for the literal {literal}"));
            }
            constants.values.push(constant);
            constants.lines.push(index + 1);
        }
        Ok(constants)
    }

    /// The place of a literal's constant in [`Constants::values`].
    pub fn place(&self, literal: &str) -> Option<usize> {
        self.places.get(literal).copied()
    }

    /// The literal at a place.
    pub fn literal(&self, place: usize) -> &str {
        let known = self.places.iter().find(|&(_, &at)| at == place);
        known.map_or("", |(literal, _)| literal)
    }
}

fn read(literal: &str, exact: &str) -> Option<Constant> {
    let value: f64 = literal.parse().ok().filter(|x: &f64| x.is_finite())?;
    let (factor, radicand) = match exact.split_once("*sqrt(") {
        Some((factor, rest)) => (factor, Some(rational(rest.strip_suffix(')')?)?)),
        None => (exact, None),
    };
    let is_positive = radicand.as_ref().is_none_or(Signed::is_positive);
    let constant = Constant { literal: value, factor: rational(factor)?, radicand };
    (is_positive && format!("{value:?}") == literal).then_some(constant)
}

/// `-?\d+(/\d+)?`.
fn rational(text: &str) -> Option<Rational> {
    let (numerator, denominator) = text.split_once('/').unwrap_or((text, "1"));
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    if !digits(numerator.strip_prefix('-').unwrap_or(numerator)) || !digits(denominator) {
        return None;
    }
    let [numerator, denominator]: [BigInt; 2] = [numerator.parse().ok()?, denominator.parse().ok()?];
    (!denominator.is_zero()).then(|| Rational::new(numerator, denominator))
}

/// Whether the nearest `f64` is the literal and the nearest `f32` what the literal rounds to.
fn rounds(constant: &Constant) -> bool {
    let literal = constant.literal;
    let double = Neighbours {
        below: f64::next_down(literal),
        at: literal,
        above: f64::next_up(literal),
        is_even: literal.to_bits().is_multiple_of(2),
    };
    double.are_nearest(constant) && rounds_to_single(constant)
}

/// Rounding twice, as the run time does, differs from rounding once where the literal lies between two `f32` exactly; the
/// literal then decides. Numbers beyond the range of `f32` are of no use there and not checked.
#[expect(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is what is meant")]
fn rounds_to_single(constant: &Constant) -> bool {
    let single = constant.literal as f32;
    let [below, above] = [f32::next_down(single), f32::next_up(single)];
    let middle = |other: f32| f64::midpoint(f64::from(single), f64::from(other));
    if !above.is_finite() || !below.is_finite() || (single != 0.0 && !single.is_normal()) {
        return true;
    }
    let is_tie = [below, above].iter().any(|&other| middle(other) == constant.literal);
    let is_even = single.to_bits().is_multiple_of(2);
    let single =
        Neighbours { below: f64::from(below), at: f64::from(single), above: f64::from(above), is_even };
    is_tie || single.are_nearest(constant)
}

/// A floating-point number and the next ones.
struct Neighbours {
    below: f64,
    at: f64,
    above: f64,
    /// Whether a tie is rounded to it.
    is_even: bool,
}

impl Neighbours {
    fn are_nearest(&self, constant: &Constant) -> bool {
        let middle = |other: f64| {
            let [at, other] = [self.at, other].map(Rational::from_float);
            Some((at? + other?) / Rational::from_integer(2.into()))
        };
        let (Some(low), Some(high)) = (middle(self.below), middle(self.above)) else { return false };
        match (compare(constant, &low), compare(constant, &high)) {
            (Ordering::Greater, Ordering::Less) => true,
            (Ordering::Equal, _) | (_, Ordering::Equal) => self.is_even,
            _ => false,
        }
    }
}

/// Compares `factor √radicand` with a rational: by signs, then by squares.
fn compare(constant: &Constant, other: &Rational) -> Ordering {
    let radicand = constant.radicand.clone().unwrap_or_else(Rational::one);
    let square = &constant.factor * &constant.factor * radicand;
    let signed = |square: Rational, sign: &Rational| if sign.is_negative() { -square } else { square };
    signed(square, &constant.factor).cmp(&signed(other * other, other))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn good_lines_are_read() {
        let text = "0.1 = 1/10\n-0.7071067811865476 = -1/2*sqrt(2)\n0.5 = 1/2\n0.0 = 0\n1.0 = 1\n";
        let constants = Constants::read(text).expect("good lines");
        assert_eq!(constants.place("-0.7071067811865476"), Some(1));
        assert_eq!(constants.values[1].radicand, Some(Rational::from_integer(2.into())));
    }

    #[test]
    fn bad_lines_are_refused() {
        for (text, word) in [
            ("0.1 = 1/10\n0.1 = 1/10\n", "second"),
            ("0.1 = 9999999999999999/100000000000000000\n", "round"),
            ("0.7071067811865475 = 1/2*sqrt(2)\n", "round"),
            ("0.7071067811865476 = -1/2*sqrt(2)\n", "round"),
            ("0.10 = 1/10\n", "not"),
            ("0.1 = 1/0\n", "not"),
            ("0.1 = 0.1\n", "not"),
            ("0.1 = +1/10\n", "not"),
            ("1.0 = 1*sqrt(-1)\n", "not"),
            ("0.1: 1/10\n", "not"),
        ] {
            let refusal = Constants::read(text).expect_err(text);
            assert!(refusal.message.contains(word), "{refusal}");
        }
    }

    /// Half an ulp above one is a tie, which goes to the even one; a hair more does not.
    #[test]
    fn ties_go_to_even() {
        let half_ulp = "9007199254740993/9007199254740992";
        assert!(Constants::read(&format!("1.0 = {half_ulp}\n")).is_ok());
        assert!(Constants::read(&format!("1.0000000000000002 = {half_ulp}\n")).is_err());
        assert!(Constants::read("1.0 = 9007199254740993000001/9007199254740992000000\n").is_err());
    }
}
