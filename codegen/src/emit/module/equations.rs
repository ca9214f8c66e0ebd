//! The equations of motion term by term.

use super::writer::ModuleWriter;
use crate::emit::tokens::{ident, index};
use crate::equations::Sparse;
use crate::expr::symbol::Symbol;
use crate::kernels::Kernel;
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    pub fn equations(&self) -> TokenStream {
        let name = ident(self.type_name);
        let e = self.equations;
        let [n_velocities, n_loop_multipliers, n_phi_q, n_phi_pi] =
            [e.n_velocities(), e.n_loop_multipliers(), e.phi_q.len(), e.phi_pi.len()].map(index);
        let n_solved = index(e.solved.roots.len());
        let rest = if e.n_loop_multipliers() == 0 {
            " (s̈, ẇ') of each body.".to_owned()
        } else {
            format!(
                " (s̈, ẇ') of each body, then {n_loop_multipliers} multipliers of the rows that close loops."
            )
        };
        let (phi_q_pattern, phi_pi_pattern) = (pattern(&e.phi_q), pattern(&e.phi_pi));
        let filling = [
            self.filling(Kernel::PhiQ, "Writes the non-zeros of Φ_q", "PhiQ"),
            self.filling(Kernel::PhiPi, "Writes the non-zeros of (Φ_r, Φ_π')", "PhiPi"),
            self.filling(Kernel::Nu, "Writes ν", "Rows"),
            self.filling(Kernel::Gamma, "Writes γ", "Rows"),
            self.filling(Kernel::AppliedForce, "Writes (f, n' − w̃'J'w')", "Velocities"),
        ];
        let accelerations = self.filling(Kernel::Accelerations, "Solves eq. (17)", "Accelerations");
        let multipliers = self.multipliers(Kernel::Multipliers, "Accelerations");
        let project = self.projection();
        quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::Equations for #name<T> {
                type Velocities = [T; #n_velocities];
                type PhiQ = [T; #n_phi_q];
                type PhiPi = [T; #n_phi_pi];
                #[doc = #rest]
                type Accelerations = [T; #n_solved];

                fn terms(&self) -> gyro_sim::Terms<Self> {
                    gyro_sim::Terms {
                        velocities: [T::constant(0.0); #n_velocities],
                        phi_q: [T::constant(0.0); #n_phi_q],
                        phi_pi: [T::constant(0.0); #n_phi_pi],
                        accelerations: [T::constant(0.0); #n_solved],
                    }
                }
                fn phi_q_pattern(&self) -> &[(u16, u16)] {
                    &[#(#phi_q_pattern),*]
                }
                fn phi_pi_pattern(&self) -> &[(u16, u16)] {
                    &[#(#phi_pi_pattern),*]
                }

                #(#filling)*
                #accelerations
                #multipliers
                #project
            }
        }
    }

    fn projection(&self) -> TokenStream {
        let what = "Solves eq. (17) without forces, the changes of the rows for γ";
        self.function(what, self.kernels.roots(Kernel::Project), |body, t, y| {
            let (statements, values) = (&body.statements, &body.values);
            let reads_rows = body.symbols.iter().any(|symbol| matches!(symbol, Symbol::Change(_)));
            let rows = ident(if reads_rows { "rows" } else { "_rows" });
            quote! {
                fn project(&self, #t: T, #y: &Self::State, #rows: &Self::Rows, out: &mut Self::Velocities) {
                    #statements
                    *out = [#(#values),*];
                }
            }
        })
    }

    /// λ, the accelerations being known.
    pub fn multipliers(&self, kernel: Kernel, accelerations: &str) -> TokenStream {
        let (name, accelerations) = (ident(kernel.name()), ident(accelerations));
        self.function("Writes λ", self.kernels.roots(kernel), |body, t, y| {
            let (statements, values) = (&body.statements, &body.values);
            let known = |s: &Symbol| matches!(s, Symbol::Acceleration { .. } | Symbol::LoopMultiplier(_));
            let argument =
                ident(if body.symbols.iter().any(known) { "accelerations" } else { "_accelerations" });
            quote! {
                fn #name(
                    &self, #t: T, #y: &Self::State, #argument: &Self::#accelerations, lambda: &mut Self::Rows,
                ) {
                    #statements
                    *lambda = [#(#values),*];
                }
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
