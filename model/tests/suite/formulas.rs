//! Formulas: what they compute, against the same written in Rust.

use gyro_model::{Formula, Model, Number, Operation, Seen, read};
use gyro_program::elementary::Function;
use rand::{RngExt, SeedableRng};
use std::convert::Infallible;

const PAGE: &str = "
format = 1
name = \"arm\"
[parameters]
k = 2
half = \"k / 4\"
[[body]]
name = \"ground\"
fixed = true
[[body]]
name = \"arm\"
mass = 1
inertia = [1, 1, 1]
[[joint]]
name = \"x\"
kind = \"revolute\"
axis = [0, 0, 1]
zero = [1, 0, 0]
first = { body = \"ground\" }
second = { body = \"arm\" }
[[formula]]
name = \"double\"
of = \"2 * shifted\"
[[formula]]
name = \"shifted\"
of = \"x + half\"
";

/// At a coordinate x, its rate y and a time.
fn value(model: &Model, formula: &Formula, [x, y, t]: [f64; 3]) -> f64 {
    let value = formula.value(|operation, values: &[f64]| {
        Ok::<_, Infallible>(match operation {
            Operation::Number(number) => model.value(number),
            Operation::Seen(Seen::Coordinate(_)) => x,
            Operation::Seen(Seen::Rate(_)) => y,
            Operation::Seen(Seen::Time) => t,
            Operation::Seen(other) => panic!("{other:?} is not named here"),
            Operation::Negative(a) => -values[*a],
            Operation::Sum(a, b) => values[*a] + values[*b],
            Operation::Difference(a, b) => values[*a] - values[*b],
            Operation::Product(a, b) => values[*a] * values[*b],
            Operation::Quotient(a, b) => values[*a] / values[*b],
            Operation::Power(a, exponent) => values[*a].powi(*exponent),
            Operation::Call(function, [a, b]) => call(*function, values[*a], values[*b]),
        })
    });
    let Ok(value) = value;
    value
}

fn call(function: Function, x: f64, y: f64) -> f64 {
    match function {
        Function::Sqrt => x.sqrt(),
        Function::Sin => x.sin(),
        Function::Cos => x.cos(),
        Function::Tanh => x.tanh(),
        Function::Atan2 => x.atan2(y),
        Function::Exp => x.exp(),
        Function::Ln => x.ln(),
        Function::Abs => x.abs(),
        Function::Floor => x.floor(),
        Function::When => {
            if x > 0.0 {
                y
            } else {
                0.0
            }
        }
        Function::Curve { .. } => panic!("no curve is named here"),
        Function::Unless => {
            if x > 0.0 {
                0.0
            } else {
                y
            }
        }
    }
}

type Law = fn(f64, f64, f64) -> f64;

const LAWS: [(&str, Law); 38] =
    [
        ("x", |x, _, _| x),
        ("-k*x^3 + half*x rate", |x, y, _| -2.0 * x.powi(3) + 0.5 * y),
        ("double - 1", |x, _, _| 2.0 * (x + 0.5) - 1.0),
        ("x - x rate - t", |x, y, t| x - y - t),
        ("x / (2 + t) / 4 * 3", |x, _, t| x / (2.0 + t) / 4.0 * 3.0),
        ("-x^2", |x, _, _| -x * x),
        ("(x^2 + 1)^-2", |x, _, _| (x * x + 1.0).powi(-2)),
        ("(x^2 + 1)^1.5", |x, _, _| (x * x + 1.0).powf(1.5)),
        ("(x^2 + 1)^(-1/2)", |x, _, _| (x * x + 1.0).powf(-0.5)),
        ("(x^2 + 1)^0.3", |x, _, _| (x * x + 1.0).powf(0.3)),
        ("(x^2 + 1)^t", |x, _, t| (x * x + 1.0).powf(t)),
        ("x*30 deg", |x, _, _| x * 30.0 * std::f64::consts::PI / 180.0),
        ("x + 60 rpm", |x, _, _| x + std::f64::consts::TAU),
        ("pi*x", |x, _, _| std::f64::consts::PI * x),
        ("sin(x) + cos(x rate) + tan(t)", |x, y, t| x.sin() + y.cos() + t.tan()),
        ("asin(0.3*tanh(x))", |x, _, _| (0.3 * x.tanh()).asin()),
        ("acos(0.3*tanh(x))", |x, _, _| (0.3 * x.tanh()).acos()),
        ("atan(x)", |x, _, _| x.atan()),
        ("atan2(x, x rate)", |x, y, _| x.atan2(y)),
        ("sinh(x)", |x, _, _| x.sinh()),
        ("cosh(x)", |x, _, _| x.cosh()),
        ("exp(-x) + ln(1 + x^2) + log10(2 + x^2)", |x, _, _| {
            (-x).exp() + (1.0 + x * x).ln() + (2.0 + x * x).log10()
        }),
        ("sqrt(x^2)", |x, _, _| x.abs()),
        ("abs(x)", |x, _, _| x.abs()),
        ("sign(x)", |x, _, _| x.signum()),
        ("min(x, x rate)", |x, y, _| x.min(y)),
        ("max(x, x rate)", |x, y, _| x.max(y)),
        ("min(min(x, x rate), max(t, 0.3))", |x, y, t| x.min(y).min(t.max(0.3))),
        ("hypot(x, x rate)", |x, y, _| x.hypot(y)),
        ("floor(3*x)", |x, _, _| (3.0 * x).floor()),
        ("mod(x, 0.7)", |x, _, _| x.rem_euclid(0.7)),
        ("step(x, -1, 2, 1.5, 3)", |x, _, _| {
            let s = ((x + 1.0) / 2.5).clamp(0.0, 1.0);
            2.0 + s * s * (3.0 - 2.0 * s)
        }),
        ("ramp(x, 0.1)", |x, _, _| 0.5 * (x + (x * x + 0.01).sqrt())),
        ("if(x > 0, sqrt(x), -1)", |x, _, _| if x > 0.0 { x.sqrt() } else { -1.0 }),
        ("if(x >= x rate, 1, 2) + if(x <= t, 10, 20)", |x, y, t| {
            (if x >= y { 1.0 } else { 2.0 }) + (if x <= t { 10.0 } else { 20.0 })
        }),
        ("if(x > 0 and x rate < 0, x, t)", |x, y, t| if x > 0.0 && y < 0.0 { x } else { t }),
        ("if(x > 0 or not(x rate < 0 and t > 0.5), x, t)", |x, y, t| {
            if x > 0.0 || !(y < 0.0 && t > 0.5) { x } else { t }
        }),
        ("if((x + 1)*2 > 1, 1, if(x < -2, 2, 3))", |x, _, _| {
            if (x + 1.0) * 2.0 > 1.0 {
                1.0
            } else if x < -2.0 {
                2.0
            } else {
                3.0
            }
        }),
    ];

#[test]
fn formulas_compute_what_they_say() {
    let model = read("arm.toml", PAGE).expect("a good model file");
    let mut dice = chacha20::ChaCha8Rng::seed_from_u64(5);
    for (text, law) in LAWS {
        let formula = model.formula(text).unwrap_or_else(|words| panic!("{text}: {words}"));
        for _ in 0..200 {
            let at @ [x, y, t] = [(); 3].map(|()| dice.random_range(-3.0..3.0));
            let (found, expected) = (value(&model, &formula, at), law(x, y, t));
            assert!((found - expected).abs() <= 1e-12 * (1.0 + expected.abs()), "{text} at {at:?}: {found}");
        }
    }
}

/// What occurs twice is computed once, and what parameters decide is a number: nested choices do not grow.
#[test]
fn formulas_are_short() {
    let model = read("arm.toml", PAGE).expect("a good model file");
    let length = |text: &str| model.formula(text).expect("a formula").operations.len();
    assert_eq!(length("x*x + x*x"), 3);
    assert_eq!(length("2*k*half*(x + 0)"), 3);
    let nested = (0..12).fold("x".to_owned(), |inner, _| format!("min({inner}, x rate + t)"));
    assert!(length(&nested) < 80, "{}", length(&nested));
}

/// A strength that needs no formula is a number as before.
#[test]
fn strengths_without_motion_are_numbers() {
    let motor = |value: &str| {
        let force = "[[force]]\nname = \"m\"\nkind = \"motor\"\njoint = \"x\"\n";
        let page = format!("{PAGE}{force}value = {value:?}")
            .replace("[[body]]\nname = \"ground\"", "[inputs]\nu = 1\n[[body]]\nname = \"ground\"");
        let model = read("arm.toml", &page).unwrap_or_else(|problems| panic!("{problems}"));
        let numbers = model.forces[0].kind.parts().numbers;
        numbers[0].1[0].clone()
    };
    assert_eq!(motor("u"), Number::Input { index: 0, negated: false });
    assert_eq!(motor("-k"), Number::Parameter { index: 0, negated: true });
    assert!(matches!(motor("2*k"), Number::Computed(_)));
    assert_eq!(motor("2*3"), Number::integer(6));
    assert!(matches!(motor("-0.01*u"), Number::Formula(_)));
    assert!(matches!(motor("x"), Number::Formula(_)));
}

#[test]
fn kinks_are_told_in_the_words_of_the_text() {
    let page = |law: &str| {
        format!(
            "{PAGE}[[curve]]\nname = \"slip\"\npoints = [[-1, 0], [0, 1], [2, 1]]\nbetween = \"linear\"\n[[curve]]\n\
             name = \"soft\"\npoints = [[-1, 0], [0, 1], [2, 1]]\nbeyond = \"line\"\n[[formula]]\nname = \"size\"\n\
             of = \"abs(x - k)\"\n[[force]]\nname = \"law\"\nkind = \"motor\"\njoint = \"x\"\nvalue = {law:?}\n"
        )
    };
    let cases: [(&str, &[&str]); 10] = [
        ("abs( x  - half )", &["x - half = 0"]),
        ("sign(x rate)*sin(x) + abs(x rate)", &["x rate = 0"]),
        ("min(x, 3) + max(x rate, x)", &["x = 3", "x rate = x"]),
        ("if(x > 1 and 2 <= t or not(x rate < k), x, 0)", &["x = 1", "2 = t", "x rate = k"]),
        ("floor(3*x) + mod(x, 2*pi)", &["3*x is whole", "x is a multiple of 2*pi"]),
        ("slip(x + t) + soft(x)", &["x + t is at a corner of `slip`"]),
        ("size^2 + size", &["x - k = 0 in formula `size`"]),
        // What is smooth, or no kink of what moves.
        ("step(x, 0, 0, 1, 1) + ramp(x, 0.1) + tanh(x)", &[]),
        ("abs(k - 3)*x + floor(2.5) + min(k, half)", &[]),
        ("x*if(k > 1, 2, 3)", &[]),
    ];
    for (law, places) in cases {
        let model = read("page.toml", &page(law)).unwrap();
        let expected: Vec<String> =
            if places.is_empty() { vec![] } else { vec![format!("force `law` where {}", places.join(", "))] };
        assert_eq!(model.kinks_in_words(), expected, "{law}");
    }
}

#[test]
fn the_places_of_names_and_kinks_have_their_values() {
    let model = read("page.toml", PAGE).unwrap();
    let formula = model.formula("min(double, 3*x rate) + k*t + half").unwrap();
    let at = [0.3, -0.7, 1.9];
    let of = |place: usize| value(&model, &Formula::smooth("", formula.operations[..=place].to_vec()), at);
    let named = |name: &str| formula.names.iter().find(|(known, _)| known == name).unwrap().1.map(of);
    assert_eq!(formula.names.len(), 5);
    assert_eq!(named("double"), Some(2.0 * (0.3 + 0.5)));
    assert_eq!(named("x rate"), Some(-0.7));
    assert_eq!(named("t"), Some(1.9));
    assert_eq!(formula.kinks.len(), 1);
    assert_eq!(of(formula.kinks[0].of).abs(), (2.0 * (0.3 + 0.5) + 3.0 * 0.7_f64).abs());
}
