//! What solvers and observers see of the mechanism.

use super::ModuleWriter;
use crate::emit::{self, float, ident, index};
use gyro_model::{JointKind, RowOwner, RowUnit};
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    pub fn mechanism(&self) -> TokenStream {
        let name = ident(self.type_name);
        let e = self.equations;
        let [n_rows, n_all, n_readings] = [e.n_rows(), e.phi.len(), e.readings.len()].map(index);
        let phi = self.filling("phi", "Writes Φ", "Constraints", &self.functions.phi);
        let residual = self.filling(
            "velocity_residual",
            "Writes Φ_r s + Φ_π' w' − ν",
            "Rows",
            &self.functions.velocity_residual,
        );
        let energy = self.function("Kinetic and potential energy", &self.functions.energy, |body, _, y| {
            let (statements, kinetic, potential) = (&body.statements, &body.values[0], &body.values[1]);
            quote! {
                fn energy(&self, #y: &Self::State) -> gyro_sim::Energy<T> {
                    #statements
                    gyro_sim::Energy { kinetic: #kinetic, potential: #potential }
                }
            }
        });
        let readings =
            self.function("Writes the joint readings", &self.functions.read_joints, |body, _, y| {
                let (statements, values) = (&body.statements, &body.values);
                quote! {
                    fn read_joints(&self, #y: &Self::State, out: &mut Self::Readings) {
                        #statements
                        *out = [#(#values),*];
                    }
                }
            });
        let tables = self.tables();
        quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::Mechanism for #name<T> {
                type Rows = [T; #n_rows];
                type Constraints = [T; #n_all];
                type Readings = [T; #n_readings];

                fn rows(&self) -> Self::Rows {
                    [T::constant(0.0); #n_rows]
                }
                fn constraints(&self) -> Self::Constraints {
                    [T::constant(0.0); #n_all]
                }
                fn readings(&self) -> Self::Readings {
                    [T::constant(0.0); #n_readings]
                }

                #phi
                #residual
                #energy
                #readings
                #tables
            }
        }
    }

    /// Names, rows and sizes.
    fn tables(&self) -> TokenStream {
        let e = self.equations;
        let bodies = self.slots().into_iter().map(|body| &e.model.bodies[body].name);
        let joints = e.model.joints.iter().map(|joint| {
            let (name, coordinate) = (
                &joint.name,
                ident(match joint.kind {
                    JointKind::Revolute => "Angle",
                    JointKind::Spherical => "Orientation",
                    JointKind::Fixed => "None",
                }),
            );
            quote! { gyro_sim::JointInfo { name: #name, coordinate: gyro_sim::Coordinate::#coordinate } }
        });
        let rows = e.model.rows().into_iter().map(|row| {
            let is_length = row.unit == RowUnit::Length;
            let (owner, index) = match row.owner {
                RowOwner::Body(body) => (
                    "Body",
                    self.slots().iter().position(|&b| b == body).expect("a held body has coordinates"),
                ),
                RowOwner::Joint(joint) => ("Joint", joint),
            };
            let (owner, index) = (ident(owner), emit::index(index));
            quote! { gyro_sim::RowInfo { owner: gyro_sim::Owner::#owner(#index), is_length: #is_length } }
        });
        let [n_bodies, n_joints, n_rows] = [e.n_slots(), e.model.joints.len(), e.n_rows()].map(index);
        let size = float(e.model.size());
        let (y, work) = if e.model.has_work() {
            let at = index(13 * e.n_slots());
            (quote! { y }, quote! { y[#at] })
        } else {
            (quote! { _y }, quote! { T::constant(0.0) })
        };
        quote! {
            fn n_bodies(&self) -> usize {
                #n_bodies
            }
            fn n_joints(&self) -> usize {
                #n_joints
            }
            fn body_name(&self, body: usize) -> &str {
                const BODIES: [&str; #n_bodies] = [#(#bodies),*];
                BODIES.get(body).copied().unwrap_or_default()
            }
            fn joint(&self, joint: usize) -> gyro_sim::JointInfo<'_> {
                const JOINTS: [gyro_sim::JointInfo<'static>; #n_joints] = [#(#joints),*];
                JOINTS.get(joint).copied().unwrap_or(gyro_sim::JointInfo { name: "", coordinate: gyro_sim::Coordinate::None })
            }
            fn row(&self, row: usize) -> gyro_sim::RowInfo {
                const ROWS: [gyro_sim::RowInfo; #n_rows] = [#(#rows),*];
                ROWS.get(row).copied().unwrap_or(gyro_sim::RowInfo { owner: gyro_sim::Owner::Body(0), is_length: false })
            }
            fn size(&self) -> T {
                T::constant(#size)
            }
            fn work(&self, #y: &Self::State) -> T {
                #work
            }
        }
    }
}
