//! Derivatives of the constraints.

use super::writer::ModuleWriter;
use crate::emit::names::{ident, index};
use crate::equations::Sparse;
use crate::groups::Group;
use crate::kernels::Kernel;
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    /// Nothing unless it is asked for.
    pub fn kinematics(&self) -> Option<TokenStream> {
        let (name, e) = (ident(self.type_name), self.equations);
        if !e.functions.has(Group::Kinematics) {
            return None;
        }
        let [n_phi_q, n_phi_pi] = [e.phi_q.len(), e.phi_pi.len()].map(index);
        let (phi_q_pattern, phi_pi_pattern) = (pattern(&e.phi_q), pattern(&e.phi_pi));
        let filling = [
            self.filling(Kernel::PhiQ, "Writes the non-zeros of Φ_q", "PhiQ"),
            self.filling(Kernel::PhiPi, "Writes the non-zeros of (Φ_r, Φ_π')", "PhiPi"),
            self.filling(Kernel::Nu, "Writes ν", "Rows"),
            self.filling(Kernel::Gamma, "Writes γ", "Rows"),
        ];
        Some(quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::Kinematics for #name<T> {
                type PhiQ = [T; #n_phi_q];
                type PhiPi = [T; #n_phi_pi];

                fn terms(&self) -> gyro_sim::Terms<Self> {
                    gyro_sim::Terms {
                        phi_q: [T::constant(0.0); #n_phi_q],
                        phi_pi: [T::constant(0.0); #n_phi_pi],
                    }
                }
                fn phi_q_pattern(&self) -> &[(u16, u16)] {
                    &[#(#phi_q_pattern),*]
                }
                fn phi_pi_pattern(&self) -> &[(u16, u16)] {
                    &[#(#phi_pi_pattern),*]
                }

                #(#filling)*
            }
        })
    }
}

fn pattern(sparse: &Sparse) -> impl Iterator<Item = TokenStream> + '_ {
    sparse.0.iter().map(|&(row, column, _)| {
        let (row, column) = (index(row), index(column));
        quote! { (#row, #column) }
    })
}
