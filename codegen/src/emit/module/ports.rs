//! What goes in and comes out besides the state.

use super::writer::ModuleWriter;
use crate::emit::tokens::{ident, index};
use crate::expr::symbol::Symbol;
use crate::kernels::Kernel;
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    pub fn ports(&self) -> TokenStream {
        let name = ident(self.type_name);
        let model = self.equations.model;
        let outputs = self.outputs();
        let infos = model.outputs.iter().flat_map(|output| {
            output.kind.columns().iter().map(|(suffix, unit)| {
                let name = &output.name;
                quote! { gyro_sim::OutputInfo { name: #name, suffix: #suffix, unit: #unit } }
            })
        });
        let inputs: Vec<_> = model.inputs.iter().map(|input| &input.name).collect();
        let (fields, places) = (inputs.iter().map(|name| ident(name)), (0..inputs.len()).map(index));
        let [n_outputs, n_inputs] = [self.equations.outputs.len(), inputs.len()].map(index);
        let set_input = if inputs.is_empty() {
            quote! {
                fn set_input(&mut self, _index: usize, _value: T) -> bool {
                    false
                }
            }
        } else {
            quote! {
                fn set_input(&mut self, index: usize, value: T) -> bool {
                    match index {
                        #(#places => { self.#fields = value; })*
                        _ => return false,
                    }
                    true
                }
            }
        };
        quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::Ports for #name<T> {
                type Outputs = [T; #n_outputs];

                fn outputs_buffer(&self) -> Self::Outputs {
                    [T::constant(0.0); #n_outputs]
                }
                #outputs
                fn n_outputs(&self) -> usize {
                    #n_outputs
                }
                fn output(&self, index: usize) -> gyro_sim::OutputInfo<'_> {
                    const OUTPUTS: [gyro_sim::OutputInfo<'static>; #n_outputs] = [#(#infos),*];
                    OUTPUTS.get(index).copied().unwrap_or(gyro_sim::OutputInfo { name: "", suffix: "", unit: "" })
                }
                fn n_inputs(&self) -> usize {
                    #n_inputs
                }
                fn input_name(&self, index: usize) -> &str {
                    const INPUTS: [&str; #n_inputs] = [#(#inputs),*];
                    INPUTS.get(index).copied().unwrap_or_default()
                }
                #set_input
            }
        }
    }

    fn outputs(&self) -> TokenStream {
        let roots = self.kernels.roots(Kernel::Outputs);
        if roots.is_empty() {
            return quote! {
                fn outputs(&self, _t: T, _y: &Self::State, _out: &mut Self::Outputs) {}
            };
        }
        self.function("Writes the outputs", roots, |body, t, y| {
            let (statements, values) = (&body.statements, &body.values);
            let known = |s: &Symbol| matches!(s, Symbol::Acceleration { .. } | Symbol::LoopMultiplier(_));
            let (t, y, solved) = if body.symbols.iter().any(known) {
                let solved = quote! {
                    let mut accelerations = gyro_sim::Equations::accelerations_buffer(self);
                    gyro_sim::Equations::accelerations(self, t, y, &mut accelerations);
                };
                (&quote! { t }, &ident("y"), solved)
            } else {
                (t, y, quote! {})
            };
            quote! {
                fn outputs(&self, #t: T, #y: &Self::State, out: &mut Self::Outputs) {
                    #solved
                    #statements
                    *out = [#(#values),*];
                }
            }
        })
    }
}
