//! The grammar of expressions: arithmetic in a string, such as `"m * L^2 / 12"`, `"30 deg"` or, of what moves,
//! `"if(depth > 0, k * depth^1.5, 0)"`.
//!
//! Powers bind before signs, signs before products, products before sums; a unit multiplies all that stands before it
//! in its product, so that `1/2 deg` is half a degree.

use std::ops::Range;

use winnow::ascii::{digit0, digit1, multispace0};
use winnow::combinator::{alt, cut_err, delimited, eof, fail, not, opt, preceded, repeat, terminated};
use winnow::prelude::*;
use winnow::stream::LocatingSlice;
use winnow::token::{any, one_of, take_while};

/// A part of an expression, and where it stands in the string, in bytes.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Term {
    pub(super) kind: Kind,
    pub(super) span: Range<usize>,
}

#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// A decimal, as it is written.
    Number(String),
    /// A parameter, π, or what moves.
    Name(String),
    /// A function of some operands.
    Call(String, Vec<Term>),
    Negative(Box<Term>),
    Sum(Box<Term>, Box<Term>),
    Difference(Box<Term>, Box<Term>),
    Product(Box<Term>, Box<Term>),
    Quotient(Box<Term>, Box<Term>),
    Power(Box<Term>, Box<Term>),
    /// A condition: the first is greater than the second.
    Greater(Box<Term>, Box<Term>),
    /// A condition: the first is not less than the second.
    AtLeast(Box<Term>, Box<Term>),
    /// Two conditions of which both must hold.
    And(Box<Term>, Box<Term>),
    /// Two conditions of which at least one must hold.
    Or(Box<Term>, Box<Term>),
    In(Box<Term>, Unit),
}

/// Units of angle and of angular rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Unit {
    Radian,
    Degree,
    Revolution,
    RadianPerSecond,
    DegreePerSecond,
    RevolutionPerSecond,
    RevolutionPerMinute,
}

/// The words for units, those first that others begin with.
pub(super) const UNITS: [(&str, Unit); 7] = [
    ("rad/s", Unit::RadianPerSecond),
    ("deg/s", Unit::DegreePerSecond),
    ("rev/s", Unit::RevolutionPerSecond),
    ("rpm", Unit::RevolutionPerMinute),
    ("rad", Unit::Radian),
    ("deg", Unit::Degree),
    ("rev", Unit::Revolution),
];

/// Longest text of an expression: longer ones only cost time.
pub(super) const MOST_CHARACTERS: usize = 400;

/// Parentheses within parentheses.
const DEEPEST: usize = 40;

type Input<'s> = LocatingSlice<&'s str>;

impl Unit {
    pub(super) fn is_rate(self) -> bool {
        !matches!(self, Self::Radian | Self::Degree | Self::Revolution)
    }
}

impl Term {
    /// The units that occur in it.
    pub(super) fn units(&self) -> Vec<Unit> {
        let mut units: Vec<Unit> = self.parts().into_iter().flat_map(Self::units).collect();
        if let Kind::In(_, unit) = self.kind {
            units.push(unit);
        }
        units
    }

    /// The names that occur in it.
    pub(super) fn names(&self) -> Vec<&str> {
        match &self.kind {
            Kind::Name(name) => vec![name],
            _ => self.parts().into_iter().flat_map(Self::names).collect(),
        }
    }

    /// The functions that it calls.
    pub(super) fn calls(&self) -> Vec<&str> {
        let mut calls: Vec<&str> = self.parts().into_iter().flat_map(Self::calls).collect();
        if let Kind::Call(name, _) = &self.kind {
            calls.push(name);
        }
        calls
    }

    fn parts(&self) -> Vec<&Self> {
        match &self.kind {
            Kind::Number(_) | Kind::Name(_) => Vec::new(),
            Kind::Call(_, operands) => operands.iter().collect(),
            Kind::Negative(a) | Kind::In(a, _) => vec![a],
            Kind::Sum(a, b)
            | Kind::Difference(a, b)
            | Kind::Product(a, b)
            | Kind::Quotient(a, b)
            | Kind::Power(a, b)
            | Kind::Greater(a, b)
            | Kind::AtLeast(a, b)
            | Kind::And(a, b)
            | Kind::Or(a, b) => vec![a, b],
        }
    }

    /// The whole number that is written there, with its sign.
    pub(super) fn whole(&self) -> Option<i32> {
        match &self.kind {
            Kind::Number(text) if text.bytes().all(|b| b.is_ascii_digit()) => text.parse().ok(),
            Kind::Negative(a) => a.whole().map(|n| -n),
            _ => None,
        }
    }
}

/// Reads an expression.
///
/// # Errors
/// Where in the text it cannot go on.
pub(super) fn parse(text: &str) -> Result<Term, usize> {
    let mut depth = 0_usize;
    for (at, c) in text.char_indices() {
        depth = if c == '(' {
            depth + 1
        } else if c == ')' {
            depth.saturating_sub(1)
        } else {
            depth
        };
        if depth > DEEPEST || at > MOST_CHARACTERS {
            return Err(at);
        }
    }
    delimited(multispace0, any_term, eof).parse(LocatingSlice::new(text)).map_err(|error| error.offset())
}

/// A number, or conditions joined by `or`.
fn any_term(input: &mut Input<'_>) -> ModalResult<Term> {
    let first = both(input)?;
    let further = (keyword("or").value('|'), cut_err(both));
    further_terms(input, first, further, |_, a, b| Kind::Or(a, b))
}

/// A number, or conditions joined by `and`.
fn both(input: &mut Input<'_>) -> ModalResult<Term> {
    let first = comparison(input)?;
    let further = (keyword("and").value('&'), cut_err(comparison));
    further_terms(input, first, further, |_, a, b| Kind::And(a, b))
}

/// A number, or two that are compared.
fn comparison(input: &mut Input<'_>) -> ModalResult<Term> {
    let a = sum(input)?;
    let Some(operator) = opt(word(alt((">=", "<=", ">", "<")))).parse_next(input)? else { return Ok(a) };
    let b = cut_err(sum).parse_next(input)?;
    let span = a.span.start..b.span.end;
    let (a, b) = (Box::new(a), Box::new(b));
    let kind = match operator {
        ">" => Kind::Greater(a, b),
        "<" => Kind::Greater(b, a),
        ">=" => Kind::AtLeast(a, b),
        _ => Kind::AtLeast(b, a),
    };
    Ok(Term { kind, span })
}

/// A word of the grammar.
fn keyword<'s>(
    text: &'static str,
) -> impl Parser<Input<'s>, &'s str, winnow::error::ErrMode<winnow::error::ContextError>> {
    word(terminated(text, not(letter)))
}

fn sum(input: &mut Input<'_>) -> ModalResult<Term> {
    let first = product.parse_next(input)?;
    let further = (word(one_of(['+', '-'])), cut_err(product));
    further_terms(input, first, further, |sign, a, b| match sign {
        '+' => Kind::Sum(a, b),
        _ => Kind::Difference(a, b),
    })
}

/// Operands that follow a first one, each with its operator, from left to right.
fn further_terms<'s>(
    input: &mut Input<'s>,
    first: Term,
    further: impl Parser<Input<'s>, (char, Term), winnow::error::ErrMode<winnow::error::ContextError>>,
    kind: impl Fn(char, Box<Term>, Box<Term>) -> Kind,
) -> ModalResult<Term> {
    let further: Vec<(char, Term)> = repeat(0.., further).parse_next(input)?;
    Ok(further.into_iter().fold(first, |a, (operator, b)| {
        let span = a.span.start..b.span.end;
        Term { kind: kind(operator, Box::new(a), Box::new(b)), span }
    }))
}

fn product(input: &mut Input<'_>) -> ModalResult<Term> {
    let first = in_unit(signed.parse_next(input)?, input)?;
    let mut whole = first;
    while let Some(operator) = opt(word(one_of(['*', '/']))).parse_next(input)? {
        let factor = cut_err(signed).parse_next(input)?;
        let span = whole.span.start..factor.span.end;
        let (a, b) = (Box::new(whole), Box::new(factor));
        let kind = if operator == '*' { Kind::Product(a, b) } else { Kind::Quotient(a, b) };
        whole = in_unit(Term { kind, span }, input)?;
    }
    Ok(whole)
}

/// A product with the unit that may follow it.
fn in_unit(term: Term, input: &mut Input<'_>) -> ModalResult<Term> {
    let Some((unit, end)) = opt(word(unit.with_span())).parse_next(input)?.map(|(unit, at)| (unit, at.end))
    else {
        return Ok(term);
    };
    let span = term.span.start..end;
    Ok(Term { kind: Kind::In(Box::new(term), unit), span })
}

fn unit(input: &mut Input<'_>) -> ModalResult<Unit> {
    for (name, unit) in UNITS {
        if opt(terminated(name, not(letter))).parse_next(input)?.is_some() {
            return Ok(unit);
        }
    }
    fail.parse_next(input)
}

fn signed(input: &mut Input<'_>) -> ModalResult<Term> {
    let (signs, at): (Vec<char>, _) = repeat(0.., word(one_of(['-', '+']))).with_span().parse_next(input)?;
    let term = if signs.is_empty() { power(input)? } else { cut_err(power).parse_next(input)? };
    if signs.iter().filter(|sign| **sign == '-').count() % 2 == 0 {
        return Ok(term);
    }
    let span = at.start..term.span.end;
    Ok(Term { kind: Kind::Negative(Box::new(term)), span })
}

fn power(input: &mut Input<'_>) -> ModalResult<Term> {
    let base = primary(input)?;
    if opt(word('^')).parse_next(input)?.is_none() {
        return Ok(base);
    }
    let exponent = cut_err(exponent).parse_next(input)?;
    let span = base.span.start..exponent.span.end;
    Ok(Term { kind: Kind::Power(Box::new(base), Box::new(exponent)), span })
}

/// An exponent: with its sign, and no power of its own.
fn exponent(input: &mut Input<'_>) -> ModalResult<Term> {
    let (sign, at) = opt(word('-')).with_span().parse_next(input)?;
    let term = primary(input)?;
    if sign.is_none() {
        return Ok(term);
    }
    let span = at.start..term.span.end;
    Ok(Term { kind: Kind::Negative(Box::new(term)), span })
}

fn primary(input: &mut Input<'_>) -> ModalResult<Term> {
    let of = |kind: fn(String) -> Kind| move |text: &str| kind(text.to_owned());
    let within = delimited(word('('), cut_err(any_term), cut_err(')'));
    let kind =
        alt((number.map(of(Kind::Number)), call, name.map(of(Kind::Name)), within.map(|term| term.kind)));
    word(kind.with_span()).map(|(kind, span)| Term { kind, span }).parse_next(input)
}

/// A function of one operand or more.
fn call(input: &mut Input<'_>) -> ModalResult<Kind> {
    let name = (any.verify(|c: &char| c.is_alphabetic()), take_while(0.., is_letter)).take();
    let name: &str = terminated(name, word('(')).parse_next(input)?;
    let mut operands = vec![cut_err(any_term).parse_next(input)?];
    while opt(word(',')).parse_next(input)?.is_some() {
        operands.push(cut_err(any_term).parse_next(input)?);
    }
    cut_err(')').parse_next(input)?;
    Ok(Kind::Call(name.to_owned(), operands))
}

/// Digits with a point and an exponent, as TOML has them and as other languages do.
fn number<'s>(input: &mut Input<'s>) -> ModalResult<&'s str> {
    let digits = || take_while(1.., |c: char| c.is_ascii_digit() || c == '_');
    let mantissa = alt(((digits(), opt(('.', digit0))).void(), ('.', digit1).void()));
    let exponent = (one_of(['e', 'E']), opt(one_of(['+', '-'])), digit1);
    (preceded(not('_'), mantissa), opt(exponent)).take().parse_next(input)
}

/// Letters, digits and underscores; a part after a dot, and the word `rate` after a blank, as columns of a run's table
/// have them.
fn name<'s>(input: &mut Input<'s>) -> ModalResult<&'s str> {
    let word = (any.verify(|c: &char| c.is_alphabetic()), take_while(0.., is_letter));
    let further = ('.', take_while(1.., is_letter));
    let rate = (' ', "rate", not(letter));
    (word, opt(further), opt(rate)).take().parse_next(input)
}

fn letter(input: &mut Input<'_>) -> ModalResult<char> {
    any.verify(|c: &char| is_letter(*c)).parse_next(input)
}

fn is_letter(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// Something with the spaces after it.
fn word<'s, T>(
    parser: impl Parser<Input<'s>, T, winnow::error::ErrMode<winnow::error::ContextError>>,
) -> impl Parser<Input<'s>, T, winnow::error::ErrMode<winnow::error::ContextError>> {
    terminated(parser, multispace0)
}

#[cfg(test)]
mod tests;
