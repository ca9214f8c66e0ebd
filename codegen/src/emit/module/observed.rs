//! What is read off a joint state.

use super::writer::ModuleWriter;
use crate::emit::names::{ident, index};
use crate::emit::results::{Value, filled};
use crate::expr::symbol::Symbol;
use crate::kernels::Kernel;
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    /// Empty unless it is asked for.
    pub fn joint_outputs(&self) -> Option<TokenStream> {
        let space = self.equations.joint_space.as_ref()?;
        let roots = self.kernels.roots(Kernel::JointOutputs);
        if roots.is_empty() {
            return None;
        }
        let name = ident(self.type_name);
        let n_rates = index(space.layout.n_rates);
        let outputs = self.function("Writes the outputs of a joint state", roots, |body, t, x| {
            let (statements, filled) = (&body.statements, filled("out", &body.values));
            let reads_rates = body.symbols.iter().any(|symbol| matches!(symbol, Symbol::RateOfRate(_)));
            let (t, x, solved) = if reads_rates {
                let solved = quote! {
                    let mut accelerations = [T::constant(0.0); #n_rates];
                    gyro_sim::JointSpace::joint_accelerations(self, t, x, &mut accelerations);
                };
                (&quote! { t }, &ident("x"), solved)
            } else {
                (t, x, quote! {})
            };
            quote! {
                fn joint_outputs(&self, #t: T, #x: &Self::Joints, out: &mut Self::Outputs) {
                    #solved
                    #statements
                    #filled
                }
            }
        });
        Some(quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::JointOutputs for #name<T> {
                #outputs
            }
        })
    }

    /// Empty unless they are asked for.
    pub fn output_derivatives(&self) -> Option<TokenStream> {
        let space = self.equations.joint_space.as_ref()?;
        let derivatives = space.output_derivatives.as_ref()?;
        if self.kernels.roots(Kernel::JointOutputs).is_empty() {
            return None;
        }
        let name = ident(self.type_name);
        let kernels = [
            (Kernel::OutputsByState, "∂(outputs)/∂(x, u), u̇ being held", "ByState", &derivatives.by_state),
            (
                Kernel::OutputsByAccelerations,
                "∂(outputs)/∂u̇",
                "ByAccelerations",
                &derivatives.by_accelerations,
            ),
            (
                Kernel::OutputsByInputs,
                "∂(outputs)/∂(inputs), u̇ being held",
                "ByInputs",
                &derivatives.by_inputs,
            ),
            (
                Kernel::OutputsByParameters,
                "∂(outputs)/∂(parameters), u̇ being held",
                "ByParameters",
                &derivatives.by_parameters,
            ),
        ];
        let types = kernels.map(|(.., ty, chosen)| {
            let (ty, n) = (ident(ty), index(chosen.roots.len()));
            quote! { type #ty = [T; #n]; }
        });
        let zeros = kernels.map(|(.., chosen)| match chosen.roots.len() {
            0 => quote! { [] },
            n => {
                let n = index(n);
                quote! { [T::constant(0.0); #n] }
            }
        });
        let [by_state, by_accelerations, by_inputs, by_parameters] = zeros;
        let functions = kernels.map(|(kernel, what, ty, _)| {
            let (function, ty) = (ident(kernel.name()), ident(ty));
            self.function(&format!("Writes {what}"), self.kernels.roots(kernel), |body, t, x| {
                let (statements, filled) = (&body.statements, filled("out", &body.values));
                let reads_rates = body.symbols.iter().any(|symbol| matches!(symbol, Symbol::RateOfRate(_)));
                let rates = ident(if reads_rates { "accelerations" } else { "_accelerations" });
                quote! {
                    fn #function(&self, #t: T, #x: &Self::Joints, #rates: &Self::Rates, out: &mut Self::#ty) {
                        #statements
                        #filled
                    }
                }
            })
        });
        Some(quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::OutputDerivatives for #name<T> {
                #(#types)*

                fn output_slopes(&self) -> gyro_sim::OutputSlopes<Self> {
                    gyro_sim::OutputSlopes {
                        by_state: #by_state,
                        by_accelerations: #by_accelerations,
                        by_inputs: #by_inputs,
                        by_parameters: #by_parameters,
                    }
                }
                #(#functions)*
            }
        })
    }

    /// Empty unless the model file has frames and they are asked for.
    pub fn frames(&self) -> Option<TokenStream> {
        let space = self.equations.joint_space.as_ref()?;
        let frames = space.frames.as_ref()?;
        let name = ident(self.type_name);
        let n_biases = index(frames.biases.roots.len());
        let n_jacobians = index(frames.jacobians.roots.len());
        let names = &frames.names;
        let write = |values: &[Value]| filled("out", values);
        let jacobians = self.of_joints(
            Kernel::FrameJacobians,
            "Writes ∂(ṡ, w')/∂u of frames, row by row",
            &quote! { out: &mut Self::FrameJacobians },
            write,
        );
        let biases = self.of_joints(
            Kernel::FrameBiases,
            "Writes (s̈, ẇ') of frames at u̇ = 0",
            &quote! { out: &mut Self::FrameBiases },
            write,
        );
        Some(quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::Frames for #name<T> {
                type FrameJacobians = [T; #n_jacobians];
                type FrameBiases = [T; #n_biases];

                fn frame_names(&self) -> &[&str] {
                    &[#(#names),*]
                }
                fn frame_buffers(&self) -> gyro_sim::FrameBuffers<Self> {
                    gyro_sim::FrameBuffers {
                        jacobians: [T::constant(0.0); #n_jacobians],
                        biases: [T::constant(0.0); #n_biases],
                    }
                }
                #jacobians
                #biases
            }
        })
    }
}
