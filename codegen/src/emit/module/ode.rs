//! The mechanism as a first-order system.

use super::writer::ModuleWriter;
use crate::emit::literals::float;
use crate::emit::tokens::index;
use crate::kernels::Kernel;
use gyro_model::Start;
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    /// The start.
    pub fn start(&self, start: &Start) -> TokenStream {
        let work = self.equations.model.has_work().then_some(0.0);
        let turns = self.equations.model.turn_references();
        let turns = turns.iter().map(|turn| start.joints[turn.joint].position[turn.coordinate]);
        let start = start.q.iter().chain(&start.v).copied().chain(work).chain(turns);
        let start: Vec<_> = start.map(|x| if x == 0.0 { float(0.0) } else { float(x) }).collect();
        quote! {
            fn start(&self) -> Self::State {
                let k = T::constant;
                [#(k(#start)),*]
            }
        }
    }

    /// The rates of everything but the velocities; the accelerations are those of `Equations`, unrolled there and
    /// nowhere else.
    pub fn derivative(&self) -> TokenStream {
        let what = "Writes ẏ; beyond what [`gyro_sim::Equations::accelerations`] takes";
        let n = index(self.equations.solved.roots.len());
        self.derivative_with(
            &quote! { derivative },
            what,
            &quote! {
                let mut accelerations = [T::constant(0.0); #n];
                gyro_sim::Equations::accelerations(self, t, y, &mut accelerations);
            },
        )
    }

    /// The same between two corrections, where there are cheaper accelerations for it.
    pub fn corrected_derivative(&self) -> Option<TokenStream> {
        self.equations.joint_space.as_ref()?;
        if self.kernels.derivative_needs_multipliers(&self.equations.graph) {
            return None;
        }
        let what = "Writes ẏ; beyond what [`gyro_sim::JointSpace::corrected_accelerations`] takes";
        let n = index(self.equations.n_velocities());
        Some(self.derivative_with(
            &quote! { corrected_derivative },
            what,
            &quote! {
                let mut accelerations = [T::constant(0.0); #n];
                gyro_sim::JointSpace::corrected_accelerations(self, t, y, &mut accelerations);
            },
        ))
    }

    fn derivative_with(&self, name: &TokenStream, what: &str, solve: &TokenStream) -> TokenStream {
        let n_positions = 7 * self.equations.n_moving_bodies();
        self.function(what, self.kernels.roots(Kernel::Derivative), |body, _, _| {
            let (statements, (positions, rest)) = (&body.statements, body.values.split_at(n_positions));
            let places = (0..self.equations.n_velocities()).map(index);
            quote! {
                fn #name(&self, t: T, y: &Self::State, dy: &mut Self::State) {
                    #solve
                    #statements
                    *dy = [#(#positions,)* #(accelerations[#places],)* #(#rest),*];
                }
            }
        })
    }
}
