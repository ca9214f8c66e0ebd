//! Functions over jets against differences.

use super::support::{assert_close, derivative};
use crate::atoms::Elementary;
use crate::point::Point;
use crate::textbook::jet::Jet;
use crate::textbook::scope::Scope;

/// Step of differences of fourth order: what is left of them is below the rounding, 1e-16 divided by it.
const STEP: f64 = 3e-4;
const DIFFERENCE: f64 = 1e-9;

type Function = fn(&Scope<'_, f64>, &Jet<f64>) -> Option<Jet<f64>>;

/// A condition that is true for a part of the path, with what is no number elsewhere.
fn choice(scope: &Scope<'_, f64>, x: &Jet<f64>) -> Option<Jet<f64>> {
    let root = scope.sqrt(x)?;
    Some(scope.when(x, &root) + scope.unless(x, &(x * x)))
}

#[test]
fn functions_have_the_derivatives_of_their_differences() {
    let point = Point { context: (), t: 0.0, state: Vec::new(), parameters: Vec::new(), inputs: Vec::new() };
    let scope = Scope::new(&point, &Elementary);
    let functions: [(&str, Function); 7] = [
        ("tanh", |scope, x| Some(scope.tanh(x))),
        ("exp", |scope, x| Some(scope.exp(x))),
        ("ln", |scope, x| scope.ln(&(x * x))),
        ("abs", |scope, x| Some(scope.abs(x))),
        ("floor", |scope, x| Some(scope.floor(x))),
        ("when and unless", choice),
        ("neither", |scope, x| Some(scope.when(x, &scope.zero) + scope.unless(&scope.one, x))),
    ];
    // x(τ) = x₀ + 0.8 τ + 0.3 τ².
    for (name, function) in functions {
        for start in [-1.3, -0.4, 0.6, 1.7] {
            let at = |time: f64| {
                let x = Jet {
                    value: start + time * (0.8 + 0.3 * time),
                    rate: Some(0.8 + 0.6 * time),
                    second: Some(0.6),
                };
                function(&scope, &x).expect("no division by zero")
            };
            let (found, value) = (at(0.0), |time| vec![at(time).value]);
            let rate = |time| vec![at(time).rate.unwrap_or(0.0)];
            let what = format!("{name} at {start}");
            assert_close(&what, &[found.rate.unwrap_or(0.0)], &derivative(STEP, value), DIFFERENCE);
            assert_close(&what, &[found.second.unwrap_or(0.0)], &derivative(STEP, rate), DIFFERENCE);
        }
    }
}
