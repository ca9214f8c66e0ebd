//! Units, and functions of constants.

use gyro_model::Rational;
use num_traits::Signed;

/// Units of angle and of its rate, in rad and rad/s: so many half turns, or radians.
pub(super) const UNITS: [(&str, (i64, i64), bool); 7] = [
    ("rad/s", (1, 1), false),
    ("deg/s", (1, 180), true),
    ("rev/s", (2, 1), true),
    ("rpm", (1, 30), true),
    ("rad", (1, 1), false),
    ("deg", (1, 180), true),
    ("rev", (2, 1), true),
];

/// What is rational of functions of constants: where these lie decides it, which the numbers of a proof do not tell.
pub(super) fn of_constants(name: &str, operands: &[Rational]) -> Option<Rational> {
    let [zero, one] = [0, 1].map(|n: i64| Rational::from_integer(n.into()));
    Some(match (name, operands) {
        ("min", [a, b]) => a.min(b).clone(),
        ("max", [a, b]) => a.max(b).clone(),
        ("abs", [x]) => x.abs(),
        ("sign", [x]) => x.signum(),
        ("floor", [x]) => x.floor(),
        ("mod", [a, b]) if *b != zero => a - b * (a / b).floor(),
        ("step", [x, x0, y0, x1, y1]) if x0 != x1 => {
            let part = ((x - x0) / (x1 - x0)).max(zero).min(one.clone());
            let rest = &one + &one + &one - &part - &part;
            y0 + (y1 - y0) * &part * &part * rest
        }
        _ => return None,
    })
}
