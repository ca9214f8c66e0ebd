//! The mechanism's type, its parameters and what is set up from them.

use super::writer::ModuleWriter;
use crate::emit::literals::float;
use crate::emit::names::{ident, index};
use crate::emit::results::filled;
use gyro_model::{Computation, Model, Number, Parameter, ParameterRule};
use gyro_program::Kernel;
use proc_macro2::{Literal, TokenStream};
use quote::quote;

impl ModuleWriter<'_> {
    /// The type, its default and its parameters.
    pub fn definition(&self) -> TokenStream {
        let name = ident(self.type_name);
        let doc = format!(" The mechanism `{}`.", self.model().name);
        let (parameters, inputs) = (&self.model().parameters, &self.model().inputs);
        let input_names: Vec<_> = inputs.iter().map(|p| ident(&p.name)).collect();
        let input_docs =
            inputs.iter().map(|p| format!(" Input, set at every step; until then {:?}.", default(p)));
        let inputs_at_first: Vec<_> = inputs.iter().map(|p| float(default(p))).collect();
        let n_derived = self.scheduled.n_results(Kernel::ParameterSetup);
        let n_derived = (n_derived > 0).then(|| index(n_derived));
        let (fields, at_first) = if parameters.is_empty() && inputs.is_empty() {
            let doc = " The model has neither parameters nor inputs.";
            (
                quote! { #[doc = #doc] scalar: ::core::marker::PhantomData<T>, },
                quote! { scalar: ::core::marker::PhantomData, },
            )
        } else {
            let (parameters, derived) = ((!parameters.is_empty()).then_some(()), n_derived.iter());
            let (declared, given) = (
                parameters.map(|()| quote! { parameters: Parameters<T>, }),
                parameters.map(|()| quote! { parameters, }),
            );
            let zeros = n_derived.iter().map(|n| quote! { derived: [T::constant(0.0); #n], });
            (
                quote! {
                    #declared
                    #(
                        /// What depends on parameters alone.
                        derived: [T; #derived],
                    )*
                    #(#[doc = #input_docs] pub #input_names: T,)*
                },
                quote! { #given #(#zeros)* #(#input_names: T::constant(#inputs_at_first),)* },
            )
        };
        let (default_value, set_parameters) = if parameters.is_empty() {
            (quote! { Self { #at_first } }, self.without_parameters())
        } else {
            (quote! { Self::new(Parameters::default()) }, self.set_parameters(&at_first))
        };
        let (parameters, parameter_setup) = (self.parameters(), self.parameter_setup());
        quote! {
            #parameters

            #[doc = #doc]
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct #name<T> {
                #fields
            }

            impl<T: gyro_sim::Scalar> ::core::default::Default for #name<T> {
                fn default() -> Self {
                    #default_value
                }
            }

            impl<T: gyro_sim::Scalar> #name<T> {
                #set_parameters
                #parameter_setup
            }
        }
    }

    /// The parameters by name; nothing if there are none.
    fn parameters(&self) -> Option<TokenStream> {
        let parameters = &self.model().parameters;
        if parameters.is_empty() {
            return None;
        }
        let doc = format!(" Parameters of [`{}`].", self.type_name);
        let names: Vec<_> = parameters.iter().map(|p| ident(&p.name)).collect();
        let values: Vec<_> = parameters.iter().map(|p| float(default(p))).collect();
        let docs = parameters.iter().map(|p| format!(" Default {:?}.", default(p)));
        let model = &self.model();
        let rules: Vec<_> = model.parameter_rules().iter().map(|rule| rule_tokens(model, rule)).collect();
        let values_of_rules = if rules.is_empty() {
            quote! { _ }
        } else {
            quote! { p }
        };
        Some(quote! {
            #[doc = #doc]
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct Parameters<T> {
                #(#[doc = #docs] pub #names: T,)*
            }

            impl<T: gyro_sim::Scalar> ::core::default::Default for Parameters<T> {
                fn default() -> Self {
                    Self { #(#names: T::constant(#values),)* }
                }
            }

            impl<T: gyro_sim::Real> Parameters<T> {
                /// Whether the mechanism can have these parameters, as the model file's rules decide.
                pub fn check(&self) -> ::core::result::Result<(), gyro_sim::admissible::Inadmissible> {
                    gyro_sim::admissible::check(&[#(self.#names),*], |#values_of_rules| [#(#rules),*])
                }
            }
        })
    }

    fn without_parameters(&self) -> TokenStream {
        quote! {
            /// Names of the parameters.
            pub const PARAMETERS: [&'static str; 0] = [];

            /// Sets a parameter by its place in [`Self::PARAMETERS`]; returns whether there is one.
            pub fn set_parameter(&mut self, _index: usize, _value: T) -> bool {
                false
            }
        }
    }

    fn set_parameters(&self, at_first: &TokenStream) -> TokenStream {
        let parameters = &self.model().parameters;
        let names: Vec<_> = parameters.iter().map(|p| ident(&p.name)).collect();
        let strings = parameters.iter().map(|p| &p.name);
        let (count, places) = (index(parameters.len()), (0..parameters.len()).map(index));
        let parameter_setup = self.scheduled.kernels.contains_key(&Kernel::ParameterSetup).then(|| {
            quote! {
                let mut derived = self.derived;
                self.parameter_setup(&mut derived);
                self.derived = derived;
            }
        });
        quote! {
            /// Names of the parameters.
            pub const PARAMETERS: [&'static str; #count] = [#(#strings),*];

            /// The mechanism with these parameters.
            pub fn new(parameters: Parameters<T>) -> Self {
                let mut mechanism = Self { #at_first };
                mechanism.set_parameters(parameters);
                mechanism
            }

            /// The parameters.
            pub fn parameters(&self) -> &Parameters<T> {
                &self.parameters
            }

            /// Sets all parameters, and computes what depends on them alone.
            pub fn set_parameters(&mut self, parameters: Parameters<T>) {
                self.parameters = parameters;
                #parameter_setup
            }

            /// Sets a parameter by its place in [`Self::PARAMETERS`]; returns whether there is one.
            pub fn set_parameter(&mut self, index: usize, value: T) -> bool {
                let mut parameters = self.parameters;
                match index {
                    #(#places => { parameters.#names = value; })*
                    _ => return false,
                }
                self.set_parameters(parameters);
                true
            }
        }
    }

    /// Nothing if nothing depends on parameters alone.
    fn parameter_setup(&self) -> Option<TokenStream> {
        let n = index(self.scheduled.n_results(Kernel::ParameterSetup));
        self.scheduled.kernels.contains_key(&Kernel::ParameterSetup).then(|| {
            self.function(Kernel::ParameterSetup, |body, _, _| {
                let (statements, filled) = (&body.statements, filled("out", &body.values));
                quote! {
                    fn parameter_setup(&self, out: &mut [T; #n]) {
                        #statements
                        #filled
                    }
                }
            })
        })
    }
}

/// A rule as `gyro_sim::admissible` has it, with the place of the first parameter in it; `p` are the parameters.
fn rule_tokens(model: &Model, rule: &ParameterRule<'_>) -> TokenStream {
    let list = |numbers: &[Number], count: usize| {
        let numbers = numbers.iter().map(|number| number_tokens(model, number));
        let numbers = numbers.chain(std::iter::repeat(quote! { 0.0 })).take(count);
        quote! { [#(#numbers),*] }
    };
    let (kind, arguments) = match rule {
        ParameterRule::Positive(one) => ("Positive", number_tokens(model, one)),
        ParameterRule::NotNegative(one) => ("NotNegative", number_tokens(model, one)),
        ParameterRule::NotZero(numbers) => ("NotZero", list(numbers, 4)),
        ParameterRule::NotParallel(axis, zero) => {
            let (axis, zero) = (list(*axis, 3), list(*zero, 3));
            ("NotParallel", quote! { #axis, #zero })
        }
        ParameterRule::Inertia(elements) => ("Inertia", list(*elements, 6)),
    };
    let (kind, place) = (ident(kind), index(rule.first_parameter()));
    quote! { (#place, gyro_sim::admissible::Rule::#kind(#arguments)) }
}

/// A number of such a rule. Operands that are sums, products or quotients are in parentheses.
fn number_tokens(model: &Model, number: &Number) -> TokenStream {
    let operand = |number: &Number| {
        let tokens = number_tokens(model, number);
        match number {
            Number::Computed(of) if !matches!(**of, Computation::Power(..)) => quote! { (#tokens) },
            _ => tokens,
        }
    };
    match number {
        Number::Parameter { index: place, negated } => {
            let (sign, place) = (negated.then(|| quote! { - }), index(*place));
            quote! { #sign p[#place] }
        }
        Number::Computed(computation) => match &**computation {
            Computation::Sum(a, b) => {
                let (a, b) = (operand(a), operand(b));
                quote! { #a + #b }
            }
            Computation::Product(a, b) => {
                let (a, b) = (operand(a), operand(b));
                quote! { #a * #b }
            }
            Computation::Quotient(a, b) => {
                let (a, b) = (operand(a), operand(b));
                quote! { #a / #b }
            }
            Computation::Power(base, exponent) => {
                let (base, exponent) = (number_tokens(model, base), Literal::u32_unsuffixed(*exponent));
                quote! { gyro_sim::admissible::power(#base, #exponent) }
            }
        },
        Number::Exact(_) | Number::Input { .. } | Number::Formula(_) => float(model.value(number)),
    }
}

fn default(parameter: &Parameter) -> f64 {
    gyro_model::to_f64(&parameter.value)
}
