use super::*;
use crate::parse::expression::parse;

fn of(text: &str) -> Result<Number, Fault> {
    let named = |name: &str| {
        let index = ["m", "zero"].iter().position(|known| *known == name)?;
        Some(Number::Parameter { index, negated: false })
    };
    let unknown = |name: &str| [name, "", ""].map(str::to_owned);
    let values = [Rational::from_integer(2.into()), Rational::zero()];
    Meaning { named: &named, unknown: &unknown, values: &values }.number(&parse(text).expect("an expression"))
}

#[test]
fn numbers_are_exact_where_they_are_rational() {
    let check = |text: &str, expected: &str| {
        let value = parse_decimal(expected).expect("a decimal");
        assert_eq!(of(text).ok(), Some(Number::Exact(value)), "{text}");
    };
    check("1/8 + 2^-3", "0.25");
    check("sqrt(2.25) * 1e-3", "1.5e-3");
    check("-(1 - 3) * 0.1", "0.2");
    check("0.5 rad", "0.5");
    let Ok(Number::Exact(root)) = of("sqrt(2e-99)") else { panic!("a number") };
    let off = &root * &root / parse_decimal("2e-99").expect("a decimal") - Rational::from_integer(1.into());
    assert!(crate::to_f64(&off).abs() < 1e-41, "{off}");
    let Ok(Number::Exact(degrees)) = of("30 deg") else { panic!("a number") };
    assert_eq!(degrees, pi() / Rational::from_integer(6.into()));
}

#[test]
fn faults_are_told_where_they_are() {
    for (text, span, word) in [
        ("1/(3 - 3)", 2..9, "divides by zero"),
        ("1/zero", 2..6, "divides by zero"),
        ("1/(m - 2)", 2..9, "divides by zero"),
        ("zero^-1", 0..4, "divides by zero"),
        ("3 + mas*2", 4..7, "mas"),
        ("sqrt(m)", 5..6, "square root of a parameter"),
        ("sqrt(1 - 2)", 5..10, "negative"),
        ("m^101", 2..5, "exponent"),
        ("m^half", 2..6, "whole number"),
        ("m^0.5", 2..5, "whole number"),
        ("sin(m)", 0..6, "formulas"),
        ("m > 1", 0..5, "formulas"),
        ("1e60^2", 0..6, "too large"),
        ("((1.1^100)^100)^100", 0..15, "too large"),
        ("(m^50)^50", 0..9, "too long"),
        ("1e200", 0..5, "too large"),
    ] {
        let fault = of(text).expect_err(text);
        let found = text.get(fault.span.clone()).unwrap_or_default();
        assert!(fault.words[0].contains(word), "{text}: {fault:?}");
        assert!(fault.span == span, "{text}: {found} {fault:?}");
    }
}
