//! The rules that parameters can break, decided in floating point as a generated module's `Parameters::check` does.

use crate::description::narrow;
use gyro_model::{Computation, Model, Number, ParameterRule};
use gyro_sim::admissible::{Inadmissible, Rule, check_all, power};

/// Whether a mechanism can have these parameters, as the rules of its model file decide.
///
/// # Errors
/// [`Inadmissible`] names the first parameter that is no number of a model file, or that occurs in a rule which is
/// broken.
pub fn check(model: &Model, parameters: &[f64]) -> Result<(), Inadmissible> {
    let value = |number: &Number| value(model, parameters, number);
    let rules = model.parameter_rules().into_iter().map(|rule| {
        let numbers = match &rule {
            ParameterRule::Positive(one) => Rule::Positive(value(one)),
            ParameterRule::NotNegative(one) => Rule::NotNegative(value(one)),
            ParameterRule::NotZero(numbers) => {
                Rule::NotZero(std::array::from_fn(|k| numbers.get(k).map_or(0.0, value)))
            }
            ParameterRule::NotParallel(axis, zero) => {
                Rule::NotParallel(axis.each_ref().map(value), zero.each_ref().map(value))
            }
            ParameterRule::Inertia(elements) => Rule::Inertia(elements.each_ref().map(value)),
        };
        (narrow(rule.first_parameter()), numbers)
    });
    check_all::<f64>(parameters, rules)
}

/// A number of a rule.
fn value(model: &Model, parameters: &[f64], number: &Number) -> f64 {
    let value = |number: &Number| value(model, parameters, number);
    match number {
        Number::Parameter { index, negated: false } => parameters[*index],
        Number::Parameter { index, negated: true } => -parameters[*index],
        Number::Computed(computation) => match &**computation {
            Computation::Sum(a, b) => value(a) + value(b),
            Computation::Product(a, b) => value(a) * value(b),
            Computation::Quotient(a, b) => value(a) / value(b),
            Computation::Power(base, exponent) => power(value(base), *exponent),
        },
        Number::Exact(_) | Number::Input { .. } | Number::Formula(_) => model.value(number),
    }
}
