//! What goes in and comes out besides the state.

use super::writer::ModuleWriter;
use crate::emit::names::{ident, index};
use crate::emit::results::filled;
use crate::expr::symbol::Symbol;
use crate::kernels::Kernel;
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    /// The setter of inputs by their index.
    pub fn set_input(&self) -> TokenStream {
        let inputs = &self.equations.model.inputs;
        if inputs.is_empty() {
            return quote! {
                fn set_input(&mut self, _index: usize, _value: T) -> bool {
                    false
                }
            };
        }
        let fields = inputs.iter().map(|input| ident(&input.name));
        let places = (0..inputs.len()).map(index);
        quote! {
            fn set_input(&mut self, index: usize, value: T) -> bool {
                match index {
                    #(#places => { self.#fields = value; })*
                    _ => return false,
                }
                true
            }
        }
    }

    /// The outputs.
    pub fn outputs(&self) -> TokenStream {
        let roots = self.kernels.roots(Kernel::Outputs);
        if roots.is_empty() {
            return quote! {
                fn outputs(&self, _t: T, _y: &Self::State, _out: &mut Self::Outputs) {}
            };
        }
        self.function("Writes the outputs", roots, |body, t, y| {
            let (statements, filled) = (&body.statements, filled("out", &body.values));
            let known = |s: &Symbol| matches!(s, Symbol::Acceleration { .. } | Symbol::LoopMultiplier(_));
            let (t, y, solved) = if body.symbols.iter().any(known) {
                let n = index(self.equations.solved.roots.len());
                let solved = quote! {
                    let mut accelerations = [T::constant(0.0); #n];
                    gyro_sim::Dynamics::accelerations(self, t, y, &mut accelerations);
                };
                (&quote! { t }, &ident("y"), solved)
            } else {
                (t, y, quote! {})
            };
            quote! {
                fn outputs(&self, #t: T, #y: &Self::State, out: &mut Self::Outputs) {
                    #solved
                    #statements
                    #filled
                }
            }
        })
    }
}
