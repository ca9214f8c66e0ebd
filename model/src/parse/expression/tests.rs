use super::*;

/// With all parentheses.
fn shown(term: &Term) -> String {
    let two = |operator: &str, a: &Term, b: &Term| format!("({}{operator}{})", shown(a), shown(b));
    match &term.kind {
        Kind::Number(text) | Kind::Name(text) => text.clone(),
        Kind::Call(name, operands) => {
            let operands: Vec<String> = operands.iter().map(shown).collect();
            format!("{name}({})", operands.join(","))
        }
        Kind::Negative(a) => format!("(-{})", shown(a)),
        Kind::Sum(a, b) => two("+", a, b),
        Kind::Difference(a, b) => two("-", a, b),
        Kind::Product(a, b) => two("*", a, b),
        Kind::Quotient(a, b) => two("/", a, b),
        Kind::Power(a, b) => two("^", a, b),
        Kind::Greater(a, b) => two(">", a, b),
        Kind::AtLeast(a, b) => two(">=", a, b),
        Kind::And(a, b) => two("&", a, b),
        Kind::Or(a, b) => two("|", a, b),
        Kind::In(a, unit) => format!("({} {unit:?})", shown(a)),
    }
}

#[test]
fn operators_bind_as_they_do_on_paper() {
    let check = |text: &str, expected: &str| {
        assert_eq!(parse(text).map(|term| shown(&term)), Ok(expected.to_owned()), "{text}");
    };
    check("m * L^2 / 12", "((m*(L^2))/12)");
    check("a - b - c*d", "((a-b)-(c*d))");
    check("-a^2", "(-(a^2))");
    check(" 2*-x ", "(2*(-x))");
    check("--x", "x");
    check("1/2 deg", "((1/2) Degree)");
    check("90 deg - 5deg", "((90 Degree)-(5 Degree))");
    check("2*pi/3", "((2*pi)/3)");
    check("60 rpm", "(60 RevolutionPerMinute)");
    check("10 deg/s", "(10 DegreePerSecond)");
    check("10 deg/sum", "((10 Degree)/sum)");
    check("sqrt(2)/2", "(sqrt(2)/2)");
    check("(1 + 2)*3", "((1+2)*3)");
    check("x^-2 + y^(-1)", "((x^(-2))+(y^(-1)))");
    check("1_000.5e-3 * .5 * 2.", "((1_000.5e-3*.5)*2.)");
    check("degree * rad", "(degree*rad)");
    check("x^y + x^0.5", "((x^y)+(x^0.5))");
    check("sin(pan rate * t) + table.x", "(sin((pan rate*t))+table.x)");
    check("atan2(y, -x)^2", "(atan2(y,(-x))^2)");
    check("if(a > 0 and b <= 1 or not(c < d), a, -1)", "if((((a>0)&(1>=b))|not((d>c))),a,(-1))");
    check("if((a + b)*2 >= c, (a), b)", "if((((a+b)*2)>=c),a,b)");
}

#[test]
fn what_is_no_expression_is_refused_where_it_breaks() {
    for (text, at) in [
        ("", 0),
        ("2 *", 3),
        ("2 * * 3", 4),
        ("(1 + 2", 6),
        ("1 + 2)", 5),
        ("2 length", 2),
        ("2(length)", 1),
        ("x^2^3", 3),
        ("sin (x)", 4),
        ("atan2(x,)", 8),
        ("a == b", 2),
        ("a > b > c", 6),
        ("2 ** 3", 3),
        ("3 kg", 2),
        ("_1", 0),
        ("1,5", 1),
    ] {
        assert_eq!(parse(text).map(|term| shown(&term)), Err(at), "{text}");
    }
    let deep = format!("{}1{}", "(".repeat(41), ")".repeat(41));
    assert_eq!(parse(&deep), Err(40));
    assert!(parse(&deep[1..]).is_err() && parse(&deep[1..82]).is_ok());
    assert!(parse(&format!("1{}", "+1".repeat(300))).is_err());
}
