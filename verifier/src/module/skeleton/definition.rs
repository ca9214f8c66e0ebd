//! A module's tables, its type and its parameters.

use super::pieces::{lines, list, names, setter};
use gyro_model::{Computation, Model, Number, Parameter, ParameterRule, Spline, to_f64};

/// The tables, whose numbers are read elsewhere.
pub(super) fn constants(tables: &[Spline]) -> String {
    lines(tables.iter().enumerate().map(|(k, table)| {
        let (knots, pieces) = (table.knots.len(), table.pieces.len());
        format!("const KNOTS_{k}: [f64; {knots}] = []; const PIECES_{k}: [[f64; 4]; {pieces}] = [];")
    }))
}

pub(super) fn definition(model: &Model, name: &str, has_parameter_setup: bool) -> String {
    let (parameters, inputs) = (&model.parameters, &model.inputs);
    let public =
        |fields: &[Parameter]| fields.iter().map(|f| format!("pub {}: T", f.name)).collect::<Vec<_>>();
    let default = |f: &Parameter| format!("{}: T::constant({:?})", f.name, to_f64(&f.value));
    let defaults = |fields: &[Parameter]| fields.iter().map(default).collect::<Vec<_>>();
    let (declared_inputs, default_inputs) = (public(inputs), defaults(inputs));
    let count = parameters.len();
    let names = names(parameters.iter().map(|p| &p.name));
    let set_one = "pub fn set_parameter";
    if parameters.is_empty() {
        let marker = "scalar: ::core::marker::PhantomData";
        let (declared, first) = if inputs.is_empty() {
            (format!("{marker}<T>"), marker.to_owned())
        } else {
            (list(declared_inputs), list(default_inputs))
        };
        let set_one = setter(set_one, parameters, ("", "", ""));
        return format!(
            "#[derive(Clone, Copy, Debug, PartialEq)]
            pub struct {name}<T> {{ {declared} }}
            impl<T: gyro_sim::Scalar> ::core::default::Default for {name}<T> {{
                fn default() -> Self {{ Self {{ {first} }} }}
            }}
            impl<T: gyro_sim::Scalar> {name}<T> {{
                pub const PARAMETERS: [&'static str; {count}] = [{names}];
                {set_one}
            }}",
        );
    }
    let with_values = |own: &str, values: &str, inputs: Vec<String>| {
        list([own, values].map(str::to_owned).into_iter().filter(|field| !field.is_empty()).chain(inputs))
    };
    let [declared_values, first_values, parameter_setup, parameter_setup_values] = if has_parameter_setup {
        [
            "derived: [T; INT_derived]",
            "derived: [T::constant(0.0); INT_derived]",
            "fn parameter_setup(&self, ANY_out: &mut [T; INT_derived]) { HOLE_parameter_setup }",
            "let mut derived = self.derived; self.parameter_setup(&mut derived); self.derived = derived;",
        ]
    } else {
        [""; 4]
    };
    let fields = with_values("parameters: Parameters<T>", declared_values, declared_inputs);
    let first = with_values("parameters", first_values, default_inputs);
    let (declared, values) = (list(public(parameters)), list(defaults(parameters)));
    let around = ("parameters", "let mut parameters = self.parameters;", "self.set_parameters(parameters);");
    let set_one = setter(set_one, parameters, around);
    let own = list(parameters.iter().map(|p| format!("self.{}", p.name)));
    let rules = list(model.parameter_rules().iter().map(|rule| rule_of_parameters(model, rule)));
    let values_of_rules = if rules.is_empty() { "_" } else { "p" };
    format!(
        "#[derive(Clone, Copy, Debug, PartialEq)]
        pub struct Parameters<T> {{ {declared} }}
        impl<T: gyro_sim::Scalar> ::core::default::Default for Parameters<T> {{
            fn default() -> Self {{ Self {{ {values} }} }}
        }}
        impl<T: gyro_sim::Real> Parameters<T> {{
            pub fn check(&self) -> ::core::result::Result<(), gyro_sim::admissible::Inadmissible> {{
                gyro_sim::admissible::check(&[{own}], |{values_of_rules}| [{rules}])
            }}
        }}
        #[derive(Clone, Copy, Debug, PartialEq)]
        pub struct {name}<T> {{ {fields} }}
        impl<T: gyro_sim::Scalar> ::core::default::Default for {name}<T> {{
            fn default() -> Self {{ Self::new(Parameters::default()) }}
        }}
        impl<T: gyro_sim::Scalar> {name}<T> {{
            pub const PARAMETERS: [&'static str; {count}] = [{names}];
            pub fn new(parameters: Parameters<T>) -> Self {{
                let mut mechanism = Self {{ {first} }};
                mechanism.set_parameters(parameters);
                mechanism
            }}
            pub fn parameters(&self) -> &Parameters<T> {{ &self.parameters }}
            pub fn set_parameters(&mut self, parameters: Parameters<T>) {{
                self.parameters = parameters;
                {parameter_setup_values}
            }}
            {set_one}
            {parameter_setup}
        }}",
    )
}

/// A rule that parameters must satisfy, as `gyro_sim::admissible` has it, after the first parameter that it names.
fn rule_of_parameters(model: &Model, rule: &ParameterRule<'_>) -> String {
    let number = |number: &Number| number_of_parameters(model, number);
    let several = |numbers: &[Number]| format!("[{}]", list(numbers.iter().map(number)));
    let inside = match rule {
        ParameterRule::Positive(one) => format!("Positive({})", number(one)),
        ParameterRule::NotNegative(one) => format!("NotNegative({})", number(one)),
        ParameterRule::NotZero(numbers) => {
            let zeros = std::iter::repeat_n("0.0".to_owned(), 4 - numbers.len());
            format!("NotZero([{}])", list(numbers.iter().map(number).chain(zeros)))
        }
        ParameterRule::NotParallel(axis, zero) => {
            format!("NotParallel({}, {})", several(*axis), several(*zero))
        }
        ParameterRule::Inertia(elements) => format!("Inertia({})", several(*elements)),
    };
    let mut places = Vec::new();
    rule.numbers().into_iter().for_each(|number| push_parameters(number, &mut places));
    format!("({}, gyro_sim::admissible::Rule::{inside})", places.first().copied().unwrap_or_default())
}

/// The parameters that a number depends on, from left to right.
fn push_parameters(number: &Number, places: &mut Vec<usize>) {
    match number {
        Number::Parameter { index, .. } => places.push(*index),
        Number::Computed(of) => {
            of.operands().into_iter().for_each(|operand| push_parameters(operand, places))
        }
        Number::Exact(_) | Number::Input { .. } | Number::Formula(_) => {}
    }
}

/// A number of such a rule.
fn number_of_parameters(model: &Model, number: &Number) -> String {
    let binary = |a: &Number, sign: char, b: &Number| {
        let [a, b] = [a, b].map(|operand| {
            let text = number_of_parameters(model, operand);
            let is_power = matches!(operand, Number::Computed(of) if matches!(**of, Computation::Power(..)));
            if matches!(operand, Number::Computed(_)) && !is_power { format!("({text})") } else { text }
        });
        format!("{a} {sign} {b}")
    };
    match number {
        Number::Parameter { index, negated: false } => format!("p[{index}]"),
        Number::Parameter { index, negated: true } => format!("-p[{index}]"),
        Number::Computed(computation) => match &**computation {
            Computation::Sum(a, b) => binary(a, '+', b),
            Computation::Product(a, b) => binary(a, '*', b),
            Computation::Quotient(a, b) => binary(a, '/', b),
            Computation::Power(base, exponent) => {
                let base = number_of_parameters(model, base);
                format!("gyro_sim::admissible::power({base}, {exponent})")
            }
        },
        number => format!("{:?}", model.value(number)),
    }
}
