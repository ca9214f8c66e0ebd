//! From an expression to the number that it denotes: exact where it is rational, with parameters as they are named, and
//! else what is wrong with it and where.

use std::ops::Range;

use num_bigint::{BigInt, BigUint, Sign};
use num_traits::{Signed, Zero};

use super::expression::{Kind, Term, Unit};
use super::units::pi;
use super::{expression, names};
use crate::number::{SIZE_EXPONENT, in_range};
use crate::{Number, Rational, parse_decimal};

/// What is wrong with a part of an expression: where, in bytes of its string, and the words.
#[derive(Debug)]
pub(super) struct Fault {
    pub(super) span: Range<usize>,
    pub(super) words: [String; 3],
}

/// What names in an expression mean.
pub(super) struct Meaning<'m> {
    /// The number that a name stands for.
    pub(super) named: &'m dyn Fn(&str) -> Option<Number>,
    /// The message for a name that stands for none.
    pub(super) unknown: &'m dyn Fn(&str) -> [String; 3],
    /// Values of the parameters, in their order.
    pub(super) values: &'m [Rational],
}

/// Largest exponent of a power.
pub(super) const MOST_EXPONENT: i32 = 100;

/// Numbers and names that an expression may have with those of derived parameters in it, powers counted as products.
pub(super) const MOST_WEIGHT: u64 = 256;

/// Bits of an exact number.
const MOST_BITS: u64 = 20_000;

/// Digits of a root that is not rational, and of π: more than any `f64` distinguishes.
const ROOT_DIGITS: u32 = 42;

impl Meaning<'_> {
    /// The number that an expression denotes.
    pub(super) fn number(&self, term: &Term) -> Result<Number, Fault> {
        let number = self.of(term)?;
        let is_fit = self.value(&number).is_some_and(|value| in_range(&value));
        if is_fit { Ok(number) } else { Err(out_of_range(term)) }
    }

    fn of(&self, term: &Term) -> Result<Number, Fault> {
        let number = match &term.kind {
            Kind::Number(text) => {
                Number::Exact(parse_decimal(text).filter(in_range).ok_or_else(|| out_of_range(term))?)
            }
            Kind::Name(name) => self.name(term, name)?,
            Kind::Negative(a) => -self.of(a)?,
            Kind::Sum(a, b) => self.of(a)? + self.of(b)?,
            Kind::Difference(a, b) => self.of(a)? - self.of(b)?,
            Kind::Product(a, b) => self.of(a)? * self.of(b)?,
            Kind::Quotient(a, b) => {
                let (a, divisor) = (self.of(a)?, self.of(b)?);
                self.not_zero(&divisor, b)?;
                a.over(divisor).ok_or_else(|| division_by_zero(b, false))?
            }
            Kind::Power(a, exponent) => self.power(a, exponent)?,
            Kind::Call(name, operands) => match (name.as_str(), operands.as_slice()) {
                ("sqrt", [a]) => self.root(a)?,
                _ => return Err(not_of_numbers(term, name)),
            },
            Kind::Greater(..) | Kind::AtLeast(..) | Kind::And(..) | Kind::Or(..) => {
                return Err(not_of_numbers(term, "if"));
            }
            Kind::In(a, unit) => self.of(a)? * Number::Exact(size(*unit)),
        };
        let is_fit = |value: &Rational| value.numer().bits().max(value.denom().bits()) <= MOST_BITS;
        match &number {
            Number::Exact(value) if !is_fit(value) => Err(out_of_range(term)),
            number if number.weight() > MOST_WEIGHT => Err(too_long(term, number.weight())),
            _ => Ok(number),
        }
    }

    fn name(&self, term: &Term, name: &str) -> Result<Number, Fault> {
        match (self.named)(name) {
            Some(number) => Ok(number),
            None if name == "pi" => Ok(Number::Exact(pi())),
            None => Err(Fault { span: term.span.clone(), words: (self.unknown)(name) }),
        }
    }

    fn power(&self, base: &Term, exponent: &Term) -> Result<Number, Fault> {
        let number = self.of(base)?;
        let exponent = whole_exponent(exponent)?;
        if exponent < 0 {
            self.not_zero(&number, base)?;
        }
        number.power(exponent).ok_or_else(|| division_by_zero(base, false))
    }

    /// The square root of a number, exact of a square.
    fn root(&self, radicand: &Term) -> Result<Number, Fault> {
        let Number::Exact(value) = self.of(radicand)? else {
            let message = "the square root of a parameter is not supported".to_owned();
            let help = "declare the root itself under [parameters]: its square is \"root^2\"".to_owned();
            return Err(fault(radicand, message, "depends on a parameter", help));
        };
        if value.is_negative() {
            let message = "a negative number has no square root".to_owned();
            let help = "write the root of a number of 0 or more".to_owned();
            return Err(fault(radicand, message, &format!("{} here", shown(&value)), help));
        }
        if !in_range(&value) {
            return Err(out_of_range(radicand));
        }
        Ok(Number::Exact(root(&value)))
    }

    /// Nothing is divided by what is zero with the parameters as they are.
    fn not_zero(&self, divisor: &Number, term: &Term) -> Result<(), Fault> {
        match self.value(divisor) {
            Some(value) if value.is_zero() => Err(division_by_zero(term, divisor.has_parameters())),
            _ => Ok(()),
        }
    }

    fn value(&self, number: &Number) -> Option<Rational> {
        let value = |index: usize| self.values.get(index).cloned().unwrap_or_default();
        number.evaluate(&value, &|_| Rational::zero())
    }
}

/// The exponent of a power of numbers.
fn whole_exponent(exponent: &Term) -> Result<i32, Fault> {
    let wrong = |message: &str, help: String| fault(exponent, message.to_owned(), "this exponent", help);
    let Some(whole) = exponent.whole() else {
        let help =
            "write a whole number as the exponent; sqrt(...) is the square root of a number".to_owned();
        return Err(wrong("the exponent of a power must be a whole number", help));
    };
    if whole.abs() > MOST_EXPONENT {
        let help = format!("write a whole number from -{MOST_EXPONENT} to {MOST_EXPONENT}");
        return Err(wrong("the exponent of a power is too large", help));
    }
    Ok(whole)
}

/// The fault of a function, or a comparison, where a number must stand.
fn not_of_numbers(term: &Term, name: &str) -> Fault {
    let help = "write the value: sqrt is the only function of a number. Strengths of forces may be formulas"
        .to_owned();
    fault(term, format!("`{name}` may stand in formulas of what moves only"), "in place of a number", help)
}

/// A fault of a term, with no more to say of the place.
pub(super) fn here(term: &Term, message: &str, help: &str) -> Fault {
    let words = [message, "here", help].map(str::to_owned);
    Fault { span: term.span.clone(), words }
}

fn fault(term: &Term, message: String, label: &str, help: String) -> Fault {
    Fault { span: term.span.clone(), words: [message, label.to_owned(), help] }
}

fn division_by_zero(divisor: &Term, has_parameters: bool) -> Fault {
    let label = if has_parameters { "0 with the parameters as they are" } else { "this is 0" };
    let help = "divide by something that is not 0".to_owned();
    fault(divisor, "an expression divides by zero".to_owned(), label, help)
}

fn too_long(term: &Term, weight: u64) -> Fault {
    let message = format!("an expression of {weight} numbers and names is too long");
    let label = "powers and parameters that are computed from others count as what they stand for";
    fault(term, message, label, format!("write one of at most {MOST_WEIGHT} numbers and names"))
}

fn out_of_range(term: &Term) -> Fault {
    let help = format!("a number is 0, or its size is between 1e-{SIZE_EXPONENT} and 1e{SIZE_EXPONENT}");
    fault(
        term,
        "an expression is too large, too small or too long".to_owned(),
        "outside the supported range",
        help,
    )
}

fn shown(value: &Rational) -> String {
    format!("{:?}", crate::to_f64(value))
}

/// A unit in rad or rad/s.
pub(super) fn size(unit: Unit) -> Rational {
    let turn = || pi() * Rational::from_integer(2.into());
    let per = |n: i64| Rational::new(1.into(), n.into());
    match unit {
        Unit::Radian | Unit::RadianPerSecond => per(1),
        Unit::Degree | Unit::DegreePerSecond => pi() * per(180),
        Unit::Revolution | Unit::RevolutionPerSecond => turn(),
        Unit::RevolutionPerMinute => turn() * per(60),
    }
}

/// The square root of a rational that is not negative: exact where it is rational, else to 42 digits. Roots of numbers
/// in model files are this.
pub fn root(value: &Rational) -> Rational {
    let of = |n: &BigInt| n.magnitude().sqrt();
    let positive = |n: BigUint| BigInt::from_biguint(Sign::Plus, n);
    let (numerator, denominator) = (of(value.numer()), of(value.denom()));
    let exact = Rational::new(positive(numerator), positive(denominator));
    if &exact * &exact == *value {
        return exact;
    }
    // So many digits after the first that is not zero.
    let scale = BigInt::from(10).pow(ROOT_DIGITS + SIZE_EXPONENT / 2);
    let scaled = value * Rational::from_integer(&scale * &scale);
    Rational::new(positive(scaled.to_integer().magnitude().sqrt()), scale)
}

/// The words for a place where an expression cannot go on.
pub(super) fn syntax(text: &str, at: usize, is_known: &dyn Fn(&str) -> bool) -> Fault {
    let rest = text.get(at..).unwrap_or_default();
    let before = text.get(..at).unwrap_or_default().trim_end();
    let word = rest.split(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or_default();
    let caller = before.rsplit(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or_default();
    let is_name = caller.starts_with(char::is_alphabetic);
    let help = match rest.chars().next() {
        _ if text.len() > expression::MOST_CHARACTERS => {
            "declare parameters for parts of it under [parameters]".to_owned()
        }
        None if text.matches('(').count() > text.matches(')').count() => "close the parenthesis".to_owned(),
        None => "write a number, a name or a parenthesis after the last operator".to_owned(),
        Some('(') if is_name && !is_known(caller) => format!("write {caller}(...) without a blank"),
        Some('(') => "write * before the parenthesis".to_owned(),
        Some(')') => "remove the parenthesis, or open it".to_owned(),
        Some('*') if before.ends_with('*') => "write ^ for a power".to_owned(),
        Some('×' | '·') => "write *".to_owned(),
        Some('÷') => "write /".to_owned(),
        Some(',') => "write a decimal point".to_owned(),
        Some('^') => "write parentheses: of two powers it is not clear which is meant".to_owned(),
        Some('=') => "write if(a > b, ...): what moves is equal to something at instants only".to_owned(),
        Some(_) if !word.is_empty() && !before.is_empty() => {
            format!(
                "write * before `{word}`; the units are {}",
                names::list(&expression::UNITS.map(|(name, _)| name))
            )
        }
        Some(_) => {
            "write numbers, names, pi, functions such as sqrt(...), + - * / ^ and parentheses".to_owned()
        }
    };
    let label = if rest.is_empty() { "breaks off" } else { "cannot go on here" };
    let length = if word.is_empty() { rest.chars().next().map_or(0, char::len_utf8) } else { word.len() };
    let words = [format!("{text:?} is not an expression"), label.to_owned(), help];
    Fault { span: at..at + length, words }
}

#[cfg(test)]
mod tests;
