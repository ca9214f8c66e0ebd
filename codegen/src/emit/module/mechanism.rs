//! What solvers and observers see of the mechanism.

use super::writer::ModuleWriter;
use crate::emit::literals::float;
use crate::emit::tokens::{self, ident, index};
use crate::kernels::Kernel;
use gyro_model::{JointKind, RowOwner, RowUnit};
use proc_macro2::{Ident, TokenStream};
use quote::quote;

impl ModuleWriter<'_> {
    pub fn mechanism(&self) -> TokenStream {
        let name = ident(self.type_name);
        let e = self.equations;
        let [n_rows, n_all, n_readings] = [e.n_rows(), e.phi.len(), e.readings.len()].map(index);
        let phi = self.filling(Kernel::Phi, "Writes Φ", "Constraints");
        let residual = self.filling(Kernel::VelocityResidual, "Writes Φ_r s + Φ_π' w' − ν", "Rows");
        let energy = self.function(
            "Kinetic and potential energy",
            self.kernels.roots(Kernel::Energy),
            |body, t, y| {
                let (statements, kinetic, potential) = (&body.statements, &body.values[0], &body.values[1]);
                quote! {
                    fn energy(&self, #t: T, #y: &Self::State) -> gyro_sim::Energy<T> {
                        #statements
                        gyro_sim::Energy { kinetic: #kinetic, potential: #potential }
                    }
                }
            },
        );
        let readings = self.filling(Kernel::ReadJoints, "Writes the joint readings", "Readings");
        let (corrected, tables) = (self.corrected_derivative(), self.tables());
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

                #corrected
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
        let bodies = self.moving_bodies().into_iter().map(|body| &e.model.bodies[body].name);
        let joints = e.model.joints.iter().map(|joint| {
            let (name, coordinates) = (&joint.name, coordinates(joint.kind));
            quote! { gyro_sim::JointInfo { name: #name, coordinates: &[#(gyro_sim::Coordinate::#coordinates),*] } }
        });
        let rows = e.model.rows().into_iter().map(|row| {
            let is_length = row.unit == RowUnit::Length;
            let (owner, index) = match row.owner {
                RowOwner::Body(body) => (
                    "Body",
                    self.moving_bodies()
                        .iter()
                        .position(|&b| b == body)
                        .expect("a held body has coordinates"),
                ),
                RowOwner::Joint(joint) => ("Joint", joint),
                RowOwner::Coupler(coupler) => ("Coupler", coupler),
                RowOwner::Driver(driver) => ("Driver", driver),
            };
            let (owner, index) = (ident(owner), tokens::index(index));
            quote! { gyro_sim::RowInfo { owner: gyro_sim::Owner::#owner(#index), is_length: #is_length } }
        });
        let (couplers, drivers) =
            (e.model.couplers.iter().map(|c| &c.name), e.model.drivers.iter().map(|d| &d.name));
        let [n_couplers, n_drivers] = [e.model.couplers.len(), e.model.drivers.len()].map(index);
        let [n_bodies, n_joints, n_rows] = [e.n_moving_bodies(), e.model.joints.len(), e.n_rows()].map(index);
        let size = float(e.model.size());
        let references = self.turn_references();
        let (y, work) = if e.model.has_work() {
            let at = index(13 * e.n_moving_bodies());
            (quote! { y }, quote! { y[#at] })
        } else {
            (quote! { _y }, quote! { T::constant(0.0) })
        };
        quote! {
            #references
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
                JOINTS.get(joint).copied().unwrap_or(gyro_sim::JointInfo { name: "", coordinates: &[] })
            }
            fn coupler_name(&self, coupler: usize) -> &str {
                const COUPLERS: [&str; #n_couplers] = [#(#couplers),*];
                COUPLERS.get(coupler).copied().unwrap_or_default()
            }
            fn driver_name(&self, driver: usize) -> &str {
                const DRIVERS: [&str; #n_drivers] = [#(#drivers),*];
                DRIVERS.get(driver).copied().unwrap_or_default()
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

    /// Where the angles of the turn references are among the readings; nothing if there are none.
    fn turn_references(&self) -> TokenStream {
        let model = self.equations.model;
        let len = |c: &Ident| {
            if c == "Angle" {
                3
            } else if c == "Length" {
                2
            } else {
                7
            }
        };
        let places = model.turn_references().into_iter().map(|turn| {
            let before = model.joints[..turn.joint].iter().flat_map(|joint| coordinates(joint.kind));
            let own = coordinates(model.joints[turn.joint].kind).into_iter().take(turn.coordinate);
            index(before.chain(own).map(|c| len(&c)).sum())
        });
        let places: Vec<_> = places.collect();
        if places.is_empty() {
            return TokenStream::new();
        }
        quote! {
            fn turn_references(&self) -> &[u16] {
                &[#(#places),*]
            }
        }
    }
}

/// What the readings of a joint are.
fn coordinates(kind: JointKind) -> Vec<Ident> {
    if kind == JointKind::Spherical {
        return vec![ident("Orientation")];
    }
    let coordinates = kind.coordinates().iter();
    coordinates.map(|c| ident(if c.is_angle() { "Angle" } else { "Length" })).collect()
}
