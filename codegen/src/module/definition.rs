//! The mechanism's type, its default and its parameters.

use super::ModuleWriter;
use crate::emit::{float, ident, index};
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    /// The type, its default and its parameters.
    pub fn definition(&self) -> TokenStream {
        let name = ident(self.type_name);
        let doc = format!(" The mechanism `{}`.", self.equations.model.name);
        let parameters = &self.equations.model.parameters;
        let names: Vec<_> = parameters.iter().map(|p| ident(&p.name)).collect();
        let strings = parameters.iter().map(|p| &p.name);
        let values: Vec<_> = parameters.iter().map(|p| float(gyro_model::to_f64(&p.value))).collect();
        let docs =
            parameters.iter().map(|p| format!(" Parameter; default {:?}.", gyro_model::to_f64(&p.value)));
        let inputs = &self.equations.model.inputs;
        let input_names: Vec<_> = inputs.iter().map(|p| ident(&p.name)).collect();
        let input_values = inputs.iter().map(|p| float(gyro_model::to_f64(&p.value)));
        let input_docs = inputs
            .iter()
            .map(|p| format!(" Input, set at every step; until then {:?}.", gyro_model::to_f64(&p.value)));
        let (count, positions) = (index(parameters.len()), (0..parameters.len()).map(index));
        let (marker, marker_value) = if parameters.is_empty() && inputs.is_empty() {
            let doc = " The model has neither parameters nor inputs.";
            (
                quote! { #[doc = #doc] scalar: ::core::marker::PhantomData<T>, },
                quote! { scalar: ::core::marker::PhantomData, },
            )
        } else {
            (quote! {}, quote! {})
        };
        let set_parameter = if parameters.is_empty() {
            quote! {
                pub fn set_parameter(&mut self, _index: usize, _value: T) -> bool {
                    false
                }
            }
        } else {
            quote! {
                pub fn set_parameter(&mut self, index: usize, value: T) -> bool {
                    match index {
                        #(#positions => self.#names = value,)*
                        _ => return false,
                    }
                    true
                }
            }
        };
        quote! {
            #[doc = #doc]
            #[derive(Clone, Copy, Debug, PartialEq)]
            pub struct #name<T> {
                #(#[doc = #docs] pub #names: T,)*
                #(#[doc = #input_docs] pub #input_names: T,)*
                #marker
            }

            impl<T: gyro_sim::Scalar> ::core::default::Default for #name<T> {
                fn default() -> Self {
                    Self { #(#names: T::constant(#values),)* #(#input_names: T::constant(#input_values),)* #marker_value }
                }
            }

            impl<T> #name<T> {
                /// Names of the parameters.
                pub const PARAMETERS: [&'static str; #count] = [#(#strings),*];

                /// Sets a parameter by its place in [`Self::PARAMETERS`]; returns whether there is one.
                #set_parameter
            }
        }
    }
}
