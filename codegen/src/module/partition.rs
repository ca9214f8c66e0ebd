//! The coordinate partition.

use super::ModuleWriter;
use crate::emit::{ident, index};
use crate::graph::ExprId;
use crate::symbol::Symbol;
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    pub fn partition(&self) -> TokenStream {
        let name = ident(self.type_name);
        let [n_charts, n_state] = [self.equations.n_charts(), self.equations.n_state()].map(index);
        let vectors = self.function(
            "The four-vectors whose largest components are the special Euler parameters",
            &self.functions.chart_vectors,
            |body, _, y| {
                let statements = &body.statements;
                let vectors = body.values.chunks(4).map(|vector| quote! { [#(#vector),*] });
                quote! {
                    fn chart_vectors(&self, #y: &[T; #n_state]) -> [[T; 4]; #n_charts] {
                        #statements
                        [#(#vectors),*]
                    }
                }
            },
        );
        let newton = self.solve(
            "newton_step",
            "One Newton step of the dependent positions",
            &self.functions.newton_step,
            0,
        );
        let velocities = self.solve(
            "solve_velocities",
            "Solves eq. (19) for the dependent velocities",
            &self.functions.solve_velocities,
            7 * self.equations.n_slots(),
        );
        quote! {
            impl<T: Scalar> #name<T> {
                #vectors
            }

            impl<T: Real> Partition for #name<T> {
                type Independent = Charts<#n_charts>;

                fn independent(&self, _t: T, y: &Self::State) -> Self::Independent {
                    charts::best(&self.chart_vectors(y))
                }
                fn follow(&self, _t: T, y: &Self::State, choice: &mut Self::Independent) -> u32 {
                    charts::follow(&self.chart_vectors(y), choice)
                }

                #newton
                #velocities
            }
        }
    }

    /// A solve of the partition, which overwrites part of the state.
    fn solve(&self, name: &str, what: &str, roots: &[ExprId], first: usize) -> TokenStream {
        let reads_integrated = name == "solve_velocities";
        let name = ident(name);
        self.function(what, roots, |body, t, _| {
            let (statements, values) = (&body.statements, &body.values);
            let places = (first..first + values.len()).map(index);
            let charted = body.symbols.iter().any(|s| matches!(s, Symbol::Chart { .. }));
            let (choice, charts) = if charted {
                (quote! { choice }, quote! { let charts = charts::one_hot::<T, _>(choice); })
            } else {
                (quote! { _choice }, quote! {})
            };
            let integrated = reads_integrated.then(|| {
                let read = body.symbols.iter().any(|s| {
                    matches!(
                        s,
                        Symbol::IntegratedEuler { .. } | Symbol::IntegratedVelocity { .. } | Symbol::IntegratedSpin { .. }
                    )
                });
                let name = ident(if read { "integrated" } else { "_integrated" });
                quote! { #name: &Self::State, }
            });
            quote! {
                fn #name(&self, #t: T, #choice: &Self::Independent, #integrated y: &mut Self::State) -> Result<(), Error> {
                    #charts
                    #statements
                    #(y[#places] = #values;)*
                    Ok(())
                }
            }
        })
    }
}
