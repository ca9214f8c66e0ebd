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
        let derivative = self.derivative();
        quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::Ode for #name<T> {
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

    /// The position rates and the power; the accelerations are those of `Equations`, unrolled there and nowhere else.
    fn derivative(&self) -> TokenStream {
        let n_positions = 7 * self.equations.n_slots();
        let what = "Writes ẏ; beyond what [`Equations::accelerations`] takes";
        self.function(what, &self.functions.derivative, |body, _, _| {
            let (statements, (positions, power)) = (&body.statements, body.values.split_at(n_positions));
            let accelerations = (0..self.equations.accelerations.len()).map(index);
            quote! {
                fn derivative(&self, t: T, y: &Self::State, dy: &mut Self::State) {
                    let mut v = gyro_sim::Equations::velocities(self);
                    let mut lambda = gyro_sim::Mechanism::rows(self);
                    gyro_sim::Equations::accelerations(self, t, y, &mut v, &mut lambda);
                    #statements
                    *dy = [#(#positions,)* #(v[#accelerations],)* #(#power),*];
                }
            }
        })
    }
}
