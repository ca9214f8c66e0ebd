//! The coordinate partition.

use super::writer::ModuleWriter;
use crate::emit::names::{ident, if_read, index};
use crate::emit::results::stored;
use crate::equations::PartitionForm;
use crate::scheduled::Variable;
use gyro_program::{Kernel, Space};
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    /// In the way that suits the mechanism.
    pub fn partition(&self) -> TokenStream {
        // Trees have no singular poses.
        let joint = self.scheduled.joint.as_ref();
        let has_poses = joint.is_none_or(|joint| !joint.closure_rows.is_empty());
        match self.scheduled.partition {
            PartitionForm::Charts => self.by_charts(),
            PartitionForm::Joints => self.by_joints(has_poses),
        }
    }

    /// Through the coordinates of a tree of joints.
    fn by_joints(&self, has_poses: bool) -> TokenStream {
        let name = ident(self.type_name);
        let clearance = has_poses.then(|| {
            quote! {
                fn clearance(&self, t: T, y: &Self::State) -> ::core::option::Option<gyro_sim::Clearance<T>> {
                    gyro_sim::joint_partition::clearance(self, t, y)
                }
            }
        });
        quote! {
            impl<T: gyro_sim::Real> gyro_sim::Partition for #name<T> {
                type Independent = ();

                fn independent(&self, _t: T, _y: &Self::State) -> Self::Independent {}
                fn follow(&self, _t: T, _y: &Self::State, _choice: &mut Self::Independent) -> u32 {
                    0
                }
                fn is_met(&self, t: T, y: &Self::State, phi: &Self::Constraints) -> bool {
                    gyro_sim::pivoting::is_met(self, t, y, phi)
                }
                fn newton_step(
                    &self, t: T, _choice: &Self::Independent, y: &mut Self::State,
                ) -> ::core::result::Result<(), gyro_sim::Error> {
                    gyro_sim::joint_partition::newton_step(self, t, y)
                }
                fn solve_velocities(
                    &self, t: T, _choice: &Self::Independent, y: &mut Self::State,
                ) -> ::core::result::Result<(), gyro_sim::Error> {
                    gyro_sim::joint_partition::solve_velocities(self, t, y);
                    Ok(())
                }
                #clearance
            }
        }
    }

    /// The unrolled solves with their charts.
    fn by_charts(&self) -> TokenStream {
        let name = ident(self.type_name);
        let n_charts = index(self.scheduled.n_results(Kernel::ChartVectors) / 4);
        let n_state = index(Space::State.len(self.counts()));
        let vectors = self.function(Kernel::ChartVectors, |body, _, y| {
            let statements = &body.statements;
            let vectors = body.values.chunks(4).map(|vector| quote! { [#(#vector),*] });
            quote! {
                fn chart_vectors(&self, #y: &[T; #n_state]) -> [[T; 4]; #n_charts] {
                    #statements
                    [#(#vectors),*]
                }
            }
        });
        let newton = self.solve("newton_step_on", Kernel::NewtonStep);
        let velocities = self.solve("solve_velocities_on", Kernel::SolveVelocities);
        quote! {
            /// The solves of the partition, for the charts that are given as unit vectors.
            impl<T: gyro_sim::Scalar> #name<T> {
                #vectors
                #newton
                #velocities
            }

            impl<T: gyro_sim::Lanes> gyro_sim::Partition for #name<T> {
                type Independent = gyro_sim::charts::Charts<T, #n_charts>;

                fn independent(&self, _t: T, y: &Self::State) -> Self::Independent {
                    gyro_sim::charts::best(&self.chart_vectors(y))
                }
                fn follow(&self, _t: T, y: &Self::State, choice: &mut Self::Independent) -> u32 {
                    gyro_sim::charts::follow(&self.chart_vectors(y), choice)
                }
                fn newton_step(
                    &self, t: T, choice: &Self::Independent, y: &mut Self::State,
                ) -> ::core::result::Result<(), gyro_sim::Error> {
                    self.newton_step_on(t, &gyro_sim::charts::one_hot(choice), y);
                    Ok(())
                }
                fn solve_velocities(
                    &self, t: T, choice: &Self::Independent, y: &mut Self::State,
                ) -> ::core::result::Result<(), gyro_sim::Error> {
                    self.solve_velocities_on(t, &gyro_sim::charts::one_hot(choice), y);
                    Ok(())
                }
            }
        }
    }

    /// A solve of the partition, which overwrites part of the state; what keeps its value is not stored again.
    fn solve(&self, name: &str, kernel: Kernel) -> TokenStream {
        let name = ident(name);
        let places = self.computed.exact.get(&kernel).map_or(&[][..], |exact| &exact.places);
        let y = ident(if places.is_empty() { "_y" } else { "y" });
        let n_charts = index(self.scheduled.n_results(Kernel::ChartVectors) / 4);
        let n_state = index(Space::State.len(self.counts()));
        self.function(kernel, |body, t, _| {
            let (statements, stored) = (&body.statements, stored("y", places, &body.values));
            let charts = if_read("charts", self.reads(kernel, |read| matches!(read, Variable::Chart(_))));
            quote! {
                fn #name(&self, #t: T, #charts: &[[T; 4]; #n_charts], #y: &mut [T; #n_state]) {
                    #statements
                    #stored
                }
            }
        })
    }
}
