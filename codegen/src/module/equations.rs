//! The equations of motion term by term.

use super::ModuleWriter;
use crate::emit::{ident, index};
use crate::equations::Sparse;
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    pub fn equations(&self) -> TokenStream {
        let name = ident(self.type_name);
        let e = self.equations;
        let [n_velocities, n_phi_q, n_phi_pi] =
            [e.accelerations.len(), e.phi_q.len(), e.phi_pi.len()].map(index);
        let (phi_q_pattern, phi_pi_pattern) = (pattern(&e.phi_q), pattern(&e.phi_pi));
        let f = &self.functions;
        let filling = [
            self.filling("phi_q", "Writes the non-zeros of Φ_q", "PhiQ", &f.phi_q),
            self.filling("phi_pi", "Writes the non-zeros of (Φ_r, Φ_π')", "PhiPi", &f.phi_pi),
            self.filling("nu", "Writes ν", "Rows", &f.nu),
            self.filling("gamma", "Writes γ", "Rows", &f.gamma),
            self.filling("applied_force", "Writes (f, n' − w̃'J'w')", "Velocities", &f.applied_force),
        ];
        let accelerations = self.function("Solves eq. (17)", &f.accelerations, |body, t, y| {
            let (statements, (out, lambda)) = (&body.statements, body.values.split_at(e.accelerations.len()));
            quote! {
                fn accelerations(
                    &self, #t: T, #y: &Self::State, out: &mut Self::Velocities, lambda: &mut Self::Rows,
                ) {
                    #statements
                    *out = [#(#out),*];
                    *lambda = [#(#lambda),*];
                }
            }
        });
        quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::Equations for #name<T> {
                type Velocities = [T; #n_velocities];
                type PhiQ = [T; #n_phi_q];
                type PhiPi = [T; #n_phi_pi];

                fn velocities(&self) -> Self::Velocities {
                    [T::constant(0.0); #n_velocities]
                }
                fn phi_q_values(&self) -> Self::PhiQ {
                    [T::constant(0.0); #n_phi_q]
                }
                fn phi_pi_values(&self) -> Self::PhiPi {
                    [T::constant(0.0); #n_phi_pi]
                }
                fn phi_q_pattern(&self) -> &[(u16, u16)] {
                    &[#(#phi_q_pattern),*]
                }
                fn phi_pi_pattern(&self) -> &[(u16, u16)] {
                    &[#(#phi_pi_pattern),*]
                }

                #(#filling)*
                #accelerations
            }
        }
    }
}

fn pattern(sparse: &Sparse) -> impl Iterator<Item = TokenStream> + '_ {
    sparse.iter().map(|&(row, column, _)| {
        let (row, column) = (index(row), index(column));
        quote! { (#row, #column) }
    })
}
