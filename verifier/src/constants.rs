//! The exact constants behind a module's literals: a text that the generator writes and the verifier does not trust.
//!
//! One line a literal: `0.1 = 1/10`, `-0.7071067811865475 = -1/2*sqrt(2)`. Where several numbers round to one literal,
//! the line says which of its occurrences in the module's text stand for which: by `0.1 = 1/10,
//! 100000000000000001/1000000000000000000 as 1*3 2` the first three stand for the first number, the fourth for the
//! second. Each must round to its literal; whether it is the right number is seen when the identities hold.

use crate::field::Constant;
use crate::refusal::Refusal;
use gyro_model::Rational;
use num_bigint::BigInt;
use num_traits::{One, Signed, Zero};
use proc_macro2::LineColumn;
use std::cmp::Ordering;
use std::collections::HashMap;

/// The exact constants of a module.
#[derive(Clone, Debug, Default)]
pub struct Constants {
    /// In the order of the text.
    pub values: Vec<Constant>,
    lines: Vec<Line>,
    by_literal: HashMap<String, usize>,
}

/// What stands for one literal.
#[derive(Clone, Debug)]
struct Line {
    number: usize,
    literal: String,
    /// Place of the first number in [`Constants::values`].
    first: usize,
    /// Nothing if all occurrences stand for one number.
    runs: Vec<Run>,
}

/// Which of a line's numbers, and how many occurrences in a row stand for it.
type Run = (usize, usize);

/// A literal in the module's text.
#[derive(Clone, Debug)]
pub struct Occurrence {
    /// As it is written.
    pub literal: String,
    /// Where it is written.
    pub at: LineColumn,
}

impl Constants {
    /// Reads the text and checks that every number rounds to its literal.
    ///
    /// # Errors
    /// The first line that is malformed, repeats a literal or a number, or does not round to its literal.
    pub fn read(text: &str) -> Result<Self, Refusal> {
        let mut constants = Self::default();
        for (index, line) in text.lines().enumerate() {
            constants.line(index + 1, line).map_err(|message| Refusal::new(index + 1, message))?;
        }
        Ok(constants)
    }

    fn line(&mut self, number: usize, line: &str) -> Result<(), String> {
        let Some((literal, values, runs)) = read(line) else {
            return Err(format!(
                "`{line}` is not `LITERAL = RATIONAL` or `LITERAL = RATIONAL*sqrt(RATIONAL)`, nor several such numbers and \
                 ` as 1*3 2`, say, which is for occurrences in the order of the text"
            ));
        };
        if !values.iter().all(rounds) {
            return Err(format!("`{line}`: the number does not round to its literal"));
        }
        if !are_told_apart(&values, &runs) {
            return Err(format!(
                "`{line}`: numbers must differ, each must be used, and each run be another's"
            ));
        }
        if self.by_literal.insert(literal.to_owned(), self.lines.len()).is_some() {
            return Err(format!("a second line for the literal {literal}"));
        }
        self.lines.push(Line { number, literal: literal.to_owned(), first: self.values.len(), runs });
        self.values.extend(values);
        Ok(())
    }

    /// The place in [`Constants::values`] of what each occurrence stands for, all occurrences of a module being given.
    ///
    /// # Errors
    /// A literal without a line, a line without a literal, or one that is for more or fewer occurrences than there are.
    pub fn places(&self, occurrences: &[Occurrence]) -> Result<Vec<usize>, Refusal> {
        let mut of_lines: Vec<Vec<usize>> = vec![Vec::new(); self.lines.len()];
        for (index, Occurrence { literal, at }) in occurrences.iter().enumerate() {
            let missing = || Refusal::new(at.line, format!("no exact constant is given for `{literal}`"));
            of_lines[*self.by_literal.get(literal).ok_or_else(missing)?].push(index);
        }
        let mut places = vec![0; occurrences.len()];
        for (line, mut own) in self.lines.iter().zip(of_lines) {
            own.sort_by_key(|&index| occurrences[index].at);
            let values = line.values(own.len()).map_err(|message| {
                Refusal::new(line.number, format!("of the constants: the literal {} {message}", line.literal))
            })?;
            own.into_iter().zip(values).for_each(|(index, value)| places[index] = line.first + value);
        }
        Ok(places)
    }

    /// What the constant of a place is rounded to, as its literal says.
    pub(crate) fn rounded(&self, place: usize) -> f64 {
        let after = self.lines.partition_point(|line| line.first <= place);
        let line = after.checked_sub(1).and_then(|line| self.lines.get(line));
        line.and_then(|line| line.literal.parse().ok()).unwrap_or(f64::NAN)
    }
}

impl Line {
    /// Which of the line's numbers each occurrence stands for.
    fn values(&self, n_occurrences: usize) -> Result<Vec<usize>, String> {
        if n_occurrences == 0 {
            return Err("does not occur".to_owned());
        }
        if self.runs.is_empty() {
            return Ok(vec![0; n_occurrences]);
        }
        // Runs may claim any length: they are compared before anything of that length is made.
        let claimed = self.runs.iter().fold(0_usize, |sum, &(_, length)| sum.saturating_add(length));
        if claimed != n_occurrences {
            return Err(format!("occurs {n_occurrences} times, and {claimed} occurrences are listed"));
        }
        Ok(self.runs.iter().flat_map(|&(value, length)| std::iter::repeat_n(value, length)).collect())
    }
}

/// The literal, its numbers, and the runs of occurrences that stand for them.
fn read(line: &str) -> Option<(&str, Vec<Constant>, Vec<Run>)> {
    let (literal, rest) = line.split_once(" = ")?;
    let (numbers, runs) = match rest.split_once(" as ") {
        Some((numbers, runs)) => (numbers, runs.split(' ').map(run).collect::<Option<Vec<_>>>()?),
        None => (rest, Vec::new()),
    };
    let values = numbers.split(", ").map(|exact| constant(literal, exact)).collect::<Option<Vec<_>>>()?;
    let is_whole = runs.is_empty() == (values.len() == 1);
    is_whole.then_some((literal, values, runs))
}

/// `2*5`, or `2` for `2*1`: the second number, counted here from zero.
fn run(text: &str) -> Option<Run> {
    let (value, length) = text.split_once('*').unwrap_or((text, "1"));
    let count = |text: &str| text.parse::<usize>().ok().filter(|&n| n > 0 && n.to_string() == text);
    Some((count(value)? - 1, count(length)?))
}

/// Whether a line's numbers are different and all stand for something, and runs are as long as they can be.
fn are_told_apart(values: &[Constant], runs: &[Run]) -> bool {
    let differ = (1..values.len()).all(|k| !values[..k].contains(&values[k]));
    let are_used = runs.is_empty() || (0..values.len()).all(|k| runs.iter().any(|&(value, _)| value == k));
    let exist = runs.iter().all(|&(value, _)| value < values.len());
    differ && are_used && exist && runs.windows(2).all(|pair| pair[0].0 != pair[1].0)
}

fn constant(literal: &str, exact: &str) -> Option<Constant> {
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

/// Rounding twice, as the run time does, differs from rounding once where the literal lies between two `f32` exactly;
/// the literal then decides. Numbers beyond the range of `f32` are of no use there and not checked.
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
mod tests;
