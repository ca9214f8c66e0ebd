//! The mechanism as a first-order system.

use super::ModuleWriter;
use crate::emit::{float, ident, index};
use gyro_model::Start;
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    pub fn ode(&self, start: &Start) -> TokenStream {
        let (name, n_state) = (ident(self.type_name), index(self.equations.n_state()));
        let work = self.equations.model.has_work().then_some(0.0);
        let start = start.q.iter().chain(&start.v).copied().chain(work);
        let start: Vec<_> = start.map(|x| if x == 0.0 { float(0.0) } else { float(x) }).collect();
        let derivative = self.function("Writes ẏ", &self.functions.derivative, |body, t, y| {
            let (statements, values) = (&body.statements, &body.values);
            quote! {
                fn derivative(&self, #t: T, #y: &Self::State, dy: &mut Self::State) {
                    #statements
                    *dy = [#(#values),*];
                }
            }
        });
        quote! {
            impl<T: Scalar> Ode for #name<T> {
                type Scalar = T;
                type State = [T; #n_state];

                /// The assembled start, with all parameters at their defaults.
                fn start(&self) -> Self::State {
                    let k = T::constant;
                    [#(k(#start)),*]
                }

                #derivative
            }
        }
    }
}
