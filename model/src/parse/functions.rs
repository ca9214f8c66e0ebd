//! The functions that formulas may call.

use super::build::Build;
use super::computed::{Fault, here};
use super::expression::Term;
use super::names;
use crate::{Curve, Number, Rational, parse_decimal};
use gyro_program::elementary::Function;
use num_traits::Zero;

/// Their names, each with what it takes.
const ALL: [(&str, &str); 25] = [
    ("sin", "x"),
    ("cos", "x"),
    ("tan", "x"),
    ("asin", "x"),
    ("acos", "x"),
    ("atan", "x"),
    ("atan2", "y, x"),
    ("sinh", "x"),
    ("cosh", "x"),
    ("tanh", "x"),
    ("exp", "x"),
    ("ln", "x"),
    ("log10", "x"),
    ("sqrt", "x"),
    ("abs", "x"),
    ("sign", "x"),
    ("min", "a, b"),
    ("max", "a, b"),
    ("hypot", "a, b"),
    ("floor", "x"),
    ("mod", "a, b"),
    ("step", "x, x0, y0, x1, y1"),
    ("ramp", "z, width"),
    ("if", "condition, a, b"),
    ("not", "condition"),
];

/// ln 10.
const LN_10: &str = "2.302585092994045684017991454684364207601101488";

/// Whether a name has its meaning in every formula.
pub(super) fn is_function(name: &str) -> bool {
    ALL.iter().any(|(known, _)| *known == name) || ["and", "or"].contains(&name)
}

/// Whether there is such a function, or such a curve, of so many operands.
pub(super) fn check(term: &Term, name: &str, n_operands: usize, curves: &[Curve]) -> Result<(), Fault> {
    let of_curve = curves.iter().find(|curve| curve.name == name).map(|_| "x");
    let of_function = ALL.iter().find(|(known, _)| *known == name).map(|(_, takes)| *takes);
    let Some(takes) = of_curve.or(of_function) else {
        let curves = curves.iter().map(|curve| curve.name.as_str());
        let known: Vec<&str> = ALL.iter().map(|(name, _)| *name).chain(curves).collect();
        let help = if name == "log" {
            "write ln(...) or log10(...)".to_owned()
        } else {
            names::instead(name, &known)
        };
        let Fault { span, words } = here(term, &format!("there is no function `{name}`"), &help);
        return Err(Fault { span: span.start..span.start + name.len(), words });
    };
    let length = takes.split(", ").count();
    if n_operands != length {
        let message = format!("`{name}` takes {length} operands, and there are {n_operands}");
        return Err(here(term, &message, &format!("write {name}({takes})")));
    }
    Ok(())
}

impl Build {
    /// The value of a function at operands of the right number.
    pub(super) fn function(&mut self, name: &str, operands: &[usize]) -> usize {
        match (name, operands) {
            ("tan", &[x]) => {
                let [sin, cos] = [Function::Sin, Function::Cos].map(|function| self.call(function, [x; 2]));
                self.quotient(sin, cos)
            }
            ("asin", &[x]) => {
                let other = self.other_side(x);
                self.call(Function::Atan2, [x, other])
            }
            ("acos", &[x]) => {
                let other = self.other_side(x);
                self.call(Function::Atan2, [other, x])
            }
            ("atan", &[x]) => {
                let one = self.integer(1);
                self.call(Function::Atan2, [x, one])
            }
            ("sqrt", &[x]) => self.root(x),
            // Near zero the difference of two exponentials would lose its digits.
            ("sinh", &[x]) => {
                let (tanh, cosh) = (self.call(Function::Tanh, [x; 2]), self.cosh(x));
                self.product(tanh, cosh)
            }
            ("cosh", &[x]) => self.cosh(x),
            ("log10", &[x]) => {
                let (ln, scale) =
                    (self.call(Function::Ln, [x; 2]), self.exact(parse_decimal(LN_10).expect("a decimal")));
                self.quotient(ln, scale)
            }
            ("sign", &[x]) => {
                let [one, minus, zero] = [1, -1, 0].map(|n| self.integer(n));
                let opposite = self.negative(x);
                let below = self.where_positive(opposite, [minus, zero]);
                self.where_positive(x, [one, below])
            }
            ("min", &[a, b]) => {
                let margin = self.difference(b, a);
                self.where_positive(margin, [a, b])
            }
            ("max", &[a, b]) => {
                let margin = self.difference(b, a);
                self.where_positive(margin, [b, a])
            }
            ("hypot", &[a, b]) => self.hypot([a, b]),
            ("mod", &[a, b]) => {
                let quotient = self.quotient(a, b);
                let whole = self.call(Function::Floor, [quotient; 2]);
                let taken = self.product(b, whole);
                self.difference(a, taken)
            }
            ("step", &[x, x0, y0, x1, y1]) => self.step(x, [x0, y0], [x1, y1]),
            ("ramp", &[z, width]) => {
                let square = self.squares([z, width]);
                let root = self.root(square);
                let (double, half) = (self.sum(z, root), self.exact(Rational::new(1.into(), 2.into())));
                self.product(half, double)
            }
            (name, operands) => {
                let function = Function::named(name).expect("the table has no other functions");
                self.call(function, [operands[0], operands[operands.len() - 1]])
            }
        }
    }

    /// √(1 − x²), the other leg of a triangle over 1.
    fn other_side(&mut self, x: usize) -> usize {
        let one = self.integer(1);
        let (less, more) = (self.difference(one, x), self.sum(one, x));
        let square = self.product(less, more);
        self.root(square)
    }

    fn cosh(&mut self, x: usize) -> usize {
        let opposite = self.negative(x);
        let [rising, falling] = [x, opposite].map(|x| self.call(Function::Exp, [x; 2]));
        let (sum, two) = (self.sum(rising, falling), self.integer(2));
        self.quotient(sum, two)
    }

    /// √(a² + b²), which changes by nothing where both are zero, as the absolute value does: of s = 0 the root is
    /// written √(s + 1) − 1, so that a drag `hypot(vx, vy) * vx` has its derivatives at rest.
    fn hypot(&mut self, [a, b]: [usize; 2]) -> usize {
        let sum = self.squares([a, b]);
        if [a, b].map(|x| self.number(x)).iter().any(|x| matches!(x, Some(Number::Exact(x)) if !x.is_zero()))
        {
            return self.root(sum);
        }
        let [zero, one] = [0, 1].map(|n| self.integer(n));
        let lift = self.where_positive(sum, [zero, one]);
        let lifted = self.sum(sum, lift);
        let root = self.root(lifted);
        self.difference(root, lift)
    }

    /// a² + b².
    fn squares(&mut self, [a, b]: [usize; 2]) -> usize {
        let [a, b] = [a, b].map(|x| self.product(x, x));
        self.sum(a, b)
    }

    /// From y0 to y1 by the cubic `y0 + (y1 − y0) s² (3 − 2 s)` of `s = (x − x0) / (x1 − x0)`, and constant beyond.
    fn step(&mut self, x: usize, [x0, y0]: [usize; 2], [x1, y1]: [usize; 2]) -> usize {
        let (from, width) = (self.difference(x, x0), self.difference(x1, x0));
        let s = self.quotient(from, width);
        let [zero, one, two, three] = [0, 1, 2, 3].map(|n| self.integer(n));
        let rest = self.difference(one, s);
        let upper = self.where_positive(rest, [s, one]);
        let s = self.where_positive(s, [upper, zero]);
        let (square, double) = (self.product(s, s), self.product(two, s));
        let slope = self.difference(three, double);
        let part = self.product(square, slope);
        let rise = self.difference(y1, y0);
        let risen = self.product(rise, part);
        self.sum(y0, risen)
    }
}
