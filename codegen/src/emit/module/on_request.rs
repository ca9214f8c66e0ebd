//! What controllers of robots ask for, a trait for each group.

use super::writer::ModuleWriter;
use crate::emit::names::{ident, index};
use crate::emit::results::filled;
use crate::expr::symbol::Symbol;
use crate::kernels::Kernel;
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    /// Empty unless they are asked for.
    pub fn on_request(&self) -> Option<TokenStream> {
        let space = self.equations.joint_space.as_ref()?;
        let (name, asked) = (ident(self.type_name), &space.on_request);
        let inverse = asked.inverse.is_some().then(|| {
            let inverse = self.of_accelerations(
                Kernel::InverseDynamics,
                "Writes τ = M u̇ + h of given u̇",
                &quote! { Self::Rates },
            );
            let bias = self.of_joint_state(Kernel::BiasForces, "Writes h", &quote! { Self::Rates });
            let gravity = self.of_joint_state(
                Kernel::GravityForces,
                "Writes what of h is against gravity",
                &quote! { Self::Rates },
            );
            quote! {
                impl<T: gyro_sim::Scalar> gyro_sim::InverseDynamics for #name<T> {
                    #inverse
                    #bias
                    #gravity
                }
            }
        });
        let mass = asked.mass_matrix.is_some().then(|| {
            let n = index(space.layout.n_rates * space.layout.n_rates);
            let order = asked.mass_order.iter().copied().map(index);
            let matrix = self.of_joint_state(
                Kernel::MassMatrix,
                "Writes M in joint coordinates, row by row",
                &quote! { Self::MassMatrix },
            );
            let factor = self.of_joint_state(
                Kernel::MassFactor,
                "Writes D and L of M = Lᵀ D L",
                &quote! { Self::MassMatrix },
            );
            quote! {
                impl<T: gyro_sim::Scalar> gyro_sim::MassMatrix for #name<T> {
                    type MassMatrix = [T; #n];
                    fn mass_buffer(&self) -> Self::MassMatrix {
                        [T::constant(0.0); #n]
                    }
                    fn mass_order(&self) -> &[u16] {
                        &[#(#order),*]
                    }
                    #matrix
                    #factor
                }
            }
        });
        let derivatives = asked.forward_derivatives.is_some().then(|| {
            let n = space.layout.n_rates;
            let [of_forces, of_accelerations] = [2 * n * n, 3 * n * n].map(index);
            let inverse = self.of_accelerations(
                Kernel::InverseDerivatives,
                "Writes ∂τ/∂(x, u), row by row",
                &quote! { Self::InverseDerivatives },
            );
            let forward = self.of_joint_state(
                Kernel::ForwardDerivatives,
                "Writes ∂u̇/∂(x, u, τ), row by row",
                &quote! { Self::ForwardDerivatives },
            );
            quote! {
                impl<T: gyro_sim::Scalar> gyro_sim::DynamicsDerivatives for #name<T> {
                    type InverseDerivatives = [T; #of_forces];
                    type ForwardDerivatives = [T; #of_accelerations];
                    fn inverse_buffer(&self) -> Self::InverseDerivatives {
                        [T::constant(0.0); #of_forces]
                    }
                    fn forward_buffer(&self) -> Self::ForwardDerivatives {
                        [T::constant(0.0); #of_accelerations]
                    }
                    #inverse
                    #forward
                }
            }
        });
        let regressor = asked.regressor.as_ref().map(|regressor| {
            let n = index(regressor.roots.len());
            let regressor = self.of_accelerations(
                Kernel::Regressor,
                "Writes Y of what inertia and gravity take, Y θ, row by row",
                &quote! { Self::Regressor },
            );
            quote! {
                impl<T: gyro_sim::Scalar> gyro_sim::Regressor for #name<T> {
                    type Regressor = [T; #n];
                    fn regressor_buffer(&self) -> Self::Regressor {
                        [T::constant(0.0); #n]
                    }
                    #regressor
                }
            }
        });
        Some(quote! {
            #inverse
            #mass
            #derivatives
            #regressor
        })
    }

    /// A function that fills `out`, of time, joint state and u̇.
    fn of_accelerations(&self, kernel: Kernel, what: &str, out: &TokenStream) -> TokenStream {
        let name = ident(kernel.name());
        self.function(what, self.kernels.roots(kernel), |body, t, x| {
            let (statements, filled) = (&body.statements, filled("out", &body.values));
            let known = |symbol: &Symbol| matches!(symbol, Symbol::RateOfRate(_));
            let given =
                ident(if body.symbols.iter().any(known) { "accelerations" } else { "_accelerations" });
            quote! {
                fn #name(&self, #t: T, #x: &Self::Joints, #given: &Self::Rates, out: &mut #out) {
                    #statements
                    #filled
                }
            }
        })
    }

    /// One that fills `out`, of time and joint state.
    fn of_joint_state(&self, kernel: Kernel, what: &str, out: &TokenStream) -> TokenStream {
        let name = ident(kernel.name());
        self.function(what, self.kernels.roots(kernel), |body, t, x| {
            let (statements, filled) = (&body.statements, filled("out", &body.values));
            quote! {
                fn #name(&self, #t: T, #x: &Self::Joints, out: &mut #out) {
                    #statements
                    #filled
                }
            }
        })
    }
}
