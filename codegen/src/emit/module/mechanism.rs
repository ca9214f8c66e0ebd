//! What solvers and observers see of the mechanism.

use super::writer::ModuleWriter;
use crate::emit::literals::float;
use crate::emit::names::{self, ident, index};
use crate::kernels::Kernel;
use crate::scheduled;
use gyro_model::{JointKind, RowOwner, RowUnit, Start};
use proc_macro2::{Ident, TokenStream};
use quote::quote;

impl ModuleWriter<'_> {
    pub fn mechanism(&self, start: &Start) -> TokenStream {
        let name = ident(self.type_name);
        let e = self.equations;
        let [n_rows, n_all, n_velocities] = [e.n_rows, e.phi.len(), e.n_velocities()].map(index);
        let [n_readings, n_outputs, n_state] = [e.readings.len(), e.outputs.len(), e.n_state()].map(index);
        let phi = self.filling(Kernel::Phi, "Writes Φ", "Constraints");
        let residual = self.filling(Kernel::VelocityResidual, "Writes Φ_r s + Φ_π' w' − ν", "Rows");
        let force = self.filling(Kernel::AppliedForce, "Writes (f, n' − w̃'J'w')", "Velocities");
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
        let (start, description) = (self.start(start), self.description());
        let (outputs, set_input) = (self.outputs(), self.set_input());
        quote! {
            impl<T: gyro_sim::Scalar> gyro_sim::Mechanism for #name<T> {
                type Scalar = T;
                type State = [T; #n_state];
                type Rows = [T; #n_rows];
                type Constraints = [T; #n_all];
                type Velocities = [T; #n_velocities];
                type Readings = [T; #n_readings];
                type Outputs = [T; #n_outputs];

                #description
                fn buffers(&self) -> gyro_sim::Buffers<Self> {
                    gyro_sim::Buffers {
                        rows: [T::constant(0.0); #n_rows],
                        constraints: [T::constant(0.0); #n_all],
                        velocities: [T::constant(0.0); #n_velocities],
                        readings: [T::constant(0.0); #n_readings],
                        outputs: [T::constant(0.0); #n_outputs],
                    }
                }
                #start
                #phi
                #residual
                #force
                #energy
                #readings
                #outputs
                #set_input
            }
        }
    }

    fn start(&self, start: &Start) -> TokenStream {
        let start = scheduled::start(self.equations.model, start).into_iter();
        let start: Vec<_> = start.map(|x| if x == 0.0 { float(0.0) } else { float(x) }).collect();
        quote! {
            fn start(&self) -> Self::State {
                let k = T::constant;
                [#(k(#start)),*]
            }
        }
    }

    /// Names, rows and sizes.
    fn description(&self) -> TokenStream {
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
            let (owner, index) = (ident(owner), names::index(index));
            quote! { gyro_sim::RowInfo { owner: gyro_sim::Owner::#owner(#index), is_length: #is_length } }
        });
        let (couplers, drivers) =
            (e.model.couplers.iter().map(|c| &c.name), e.model.drivers.iter().map(|d| &d.name));
        let (size, has_work, references) =
            (float(e.model.size()), e.model.has_work(), self.turn_references());
        let inputs = e.model.inputs.iter().map(|input| &input.name);
        let outputs = e.model.outputs.iter().flat_map(|output| {
            output.kind.columns().iter().map(|(suffix, unit)| {
                let name = &output.name;
                quote! { gyro_sim::OutputInfo { name: #name, suffix: #suffix, unit: #unit } }
            })
        });
        quote! {
            fn description(&self) -> &gyro_sim::Description<'_> {
                const DESCRIPTION: gyro_sim::Description<'static> = gyro_sim::Description {
                    size: #size,
                    bodies: &[#(#bodies),*],
                    joints: &[#(#joints),*],
                    couplers: &[#(#couplers),*],
                    drivers: &[#(#drivers),*],
                    rows: &[#(#rows),*],
                    has_work: #has_work,
                    turn_references: &[#(#references),*],
                    inputs: &[#(#inputs),*],
                    outputs: &[#(#outputs),*],
                };
                &DESCRIPTION
            }
        }
    }

    /// Where the angles of the turn references are among the readings.
    fn turn_references(&self) -> Vec<TokenStream> {
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
            let place = index(before.chain(own).map(|c| len(&c)).sum());
            quote! { #place }
        });
        places.collect()
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
