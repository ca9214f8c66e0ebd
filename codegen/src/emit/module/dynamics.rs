//! The equations of motion in maximal coordinates, and the projection.

use super::writer::ModuleWriter;
use crate::emit::names::{ident, index};
use crate::emit::results::{Value, filled};
use crate::expr::symbol::Symbol;
use crate::groups::Group;
use crate::kernels::Kernel;
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    /// At any state; nothing unless it is asked for.
    pub fn dynamics(&self) -> Option<TokenStream> {
        let (name, e) = (ident(self.type_name), self.equations);
        if !e.functions.has(Group::Maximal) {
            return None;
        }
        let [n_solved, n_loop_multipliers] = [e.solved.roots.len(), e.n_loop_multipliers()].map(index);
        let contents = if e.n_loop_multipliers() == 0 {
            " (s̈, ẇ') of each body.".to_owned()
        } else {
            format!(
                " (s̈, ẇ') of each body, then {n_loop_multipliers} multipliers of the rows that close loops."
            )
        };
        let accelerations = self.filling(Kernel::Accelerations, "Solves eq. (17)", "Accelerations");
        let multipliers = self.multipliers(Kernel::Multipliers, "Accelerations");
        let derivative = self.derivative();
        Some(quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::Dynamics for #name<T> {
                #[doc = #contents]
                type Accelerations = [T; #n_solved];

                fn acceleration_buffer(&self) -> Self::Accelerations {
                    [T::constant(0.0); #n_solved]
                }

                #accelerations
                #multipliers
                #derivative
            }
        })
    }

    /// At corrected states; nothing unless it is asked for. What is not solved for these is that at any state.
    pub fn corrected_dynamics(&self) -> Option<TokenStream> {
        let (name, e) = (ident(self.type_name), self.equations);
        if !e.functions.has(Group::Corrected) {
            return None;
        }
        let accelerations = match &e.joint_space {
            Some(_) => self.filling(
                Kernel::CorrectedAccelerations,
                "Writes (s̈, ẇ') at a state that satisfies the constraints",
                "Velocities",
            ),
            None => self.cut_accelerations(),
        };
        let derivative = self.corrected_derivative().unwrap_or_else(|| {
            quote! {
                fn corrected_derivative(&self, t: T, y: &Self::State, dy: &mut Self::State) {
                    gyro_sim::Dynamics::derivative(self, t, y, dy);
                }
            }
        });
        Some(quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::CorrectedDynamics for #name<T> {
                #accelerations
                #derivative
            }
        })
    }

    /// The accelerations at any state without the multipliers that come with them.
    fn cut_accelerations(&self) -> TokenStream {
        let e = self.equations;
        let [n_solved, n_velocities] = [e.solved.roots.len(), e.n_velocities()].map(index);
        let solved = if e.n_loop_multipliers() == 0 {
            quote! { gyro_sim::Dynamics::accelerations(self, t, y, out); }
        } else {
            quote! {
                let mut solved = [T::constant(0.0); #n_solved];
                gyro_sim::Dynamics::accelerations(self, t, y, &mut solved);
                out.copy_from_slice(&solved[..#n_velocities]);
            }
        };
        quote! {
            fn corrected_accelerations(&self, t: T, y: &Self::State, out: &mut Self::Velocities) {
                #solved
            }
        }
    }

    /// What else there is at corrected states; nothing unless it is asked for.
    pub fn corrected_solution(&self) -> Option<TokenStream> {
        let (name, e) = (ident(self.type_name), self.equations);
        if !e.functions.has(Group::Reactions) {
            return None;
        }
        let n_solution = index(e.n_velocities() + e.n_rows);
        let at = self.filling(
            Kernel::JointAccelerationsAt,
            "Writes u̇ at a state that satisfies the constraints",
            "Rates",
        );
        let multipliers = self.multipliers(Kernel::CorrectedMultipliers, "Velocities");
        let solution = self.filling(
            Kernel::CorrectedSolution,
            "Writes (s̈, ẇ') and λ at a state that satisfies the constraints",
            "Solution",
        );
        Some(quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::CorrectedSolution for #name<T> {
                type Solution = [T; #n_solution];

                fn solution_buffer(&self) -> Self::Solution {
                    [T::constant(0.0); #n_solution]
                }

                #at
                #multipliers
                #solution
            }
        })
    }

    /// Nothing unless it is asked for.
    pub fn projection(&self) -> Option<TokenStream> {
        let name = ident(self.type_name);
        if !self.equations.functions.has(Group::Projection) {
            return None;
        }
        let what = "Solves eq. (17) without forces, the changes of the rows for γ";
        let project = self.function(what, self.kernels.roots(Kernel::Project), |body, t, y| {
            let (statements, filled) = (&body.statements, filled("out", &body.values));
            let reads_rows = body.symbols.iter().any(|symbol| matches!(symbol, Symbol::Change(_)));
            let rows = ident(if reads_rows { "rows" } else { "_rows" });
            quote! {
                fn project(&self, #t: T, #y: &Self::State, #rows: &Self::Rows, out: &mut Self::Velocities) {
                    #statements
                    #filled
                }
            }
        });
        Some(quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::Projection for #name<T> {
                #project
            }
        })
    }

    /// The rates of everything but the velocities; the accelerations are unrolled where they are and nowhere else.
    fn derivative(&self) -> TokenStream {
        let what = "Writes ẏ; beyond what [`gyro_sim::Dynamics::accelerations`] takes";
        let n = index(self.equations.solved.roots.len());
        self.derivative_with(
            Kernel::Derivative,
            what,
            &quote! {
                let mut accelerations = [T::constant(0.0); #n];
                gyro_sim::Dynamics::accelerations(self, t, y, &mut accelerations);
            },
        )
    }

    /// The same between two corrections, where there are cheaper accelerations for it.
    fn corrected_derivative(&self) -> Option<TokenStream> {
        if self.kernels.roots(Kernel::CorrectedDerivative).is_empty() {
            return None;
        }
        let what = "Writes ẏ; beyond what [`gyro_sim::CorrectedDynamics::corrected_accelerations`] takes";
        let n = index(self.equations.n_velocities());
        Some(self.derivative_with(
            Kernel::CorrectedDerivative,
            what,
            &quote! {
                let mut accelerations = [T::constant(0.0); #n];
                gyro_sim::CorrectedDynamics::corrected_accelerations(self, t, y, &mut accelerations);
            },
        ))
    }

    fn derivative_with(&self, kernel: Kernel, what: &str, solve: &TokenStream) -> TokenStream {
        let (name, n_positions) = (ident(kernel.name()), 7 * self.equations.n_moving_bodies());
        self.function(what, self.kernels.roots(kernel), |body, _, _| {
            let (statements, (positions, rest)) = (&body.statements, body.values.split_at(n_positions));
            let solved = (0..self.equations.n_velocities()).map(|k| Value::of_buffer("accelerations", k));
            let values: Vec<Value> =
                positions.iter().cloned().chain(solved).chain(rest.iter().cloned()).collect();
            let filled = filled("dy", &values);
            quote! {
                fn #name(&self, t: T, y: &Self::State, dy: &mut Self::State) {
                    #solve
                    #statements
                    #filled
                }
            }
        })
    }

    /// λ, the accelerations being known.
    fn multipliers(&self, kernel: Kernel, accelerations: &str) -> TokenStream {
        let (name, accelerations) = (ident(kernel.name()), ident(accelerations));
        self.function("Writes λ", self.kernels.roots(kernel), |body, t, y| {
            let (statements, filled) = (&body.statements, filled("lambda", &body.values));
            let known = |s: &Symbol| matches!(s, Symbol::Acceleration { .. } | Symbol::LoopMultiplier(_));
            let argument =
                ident(if body.symbols.iter().any(known) { "accelerations" } else { "_accelerations" });
            quote! {
                fn #name(
                    &self, #t: T, #y: &Self::State, #argument: &Self::#accelerations, lambda: &mut Self::Rows,
                ) {
                    #statements
                    #filled
                }
            }
        })
    }
}
