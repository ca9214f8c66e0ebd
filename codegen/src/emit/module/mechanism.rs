//! What solvers and observers see of the mechanism.

use super::patterns::without_signs_of_zeros;
use super::writer::ModuleWriter;
use crate::emit::literals::float;
use crate::emit::names::{self, ident, index};
use gyro_model::{JointKind, RowOwner, RowUnit};
use proc_macro2::{Ident, TokenStream};
use quote::quote;

impl ModuleWriter<'_> {
    pub fn start(&self) -> TokenStream {
        let start = without_signs_of_zeros(&self.scheduled.start);
        quote! {
            fn start(&self) -> Self::State {
                let k = T::constant;
                [#(k(#start)),*]
            }
        }
    }

    /// The setter of inputs by their index.
    pub fn set_input(&self) -> TokenStream {
        let inputs = &self.model().inputs;
        if inputs.is_empty() {
            return quote! {
                fn set_input(&mut self, _index: usize, _value: T) -> bool {
                    false
                }
            };
        }
        let fields = inputs.iter().map(|input| ident(&input.name));
        let places = (0..inputs.len()).map(index);
        quote! {
            fn set_input(&mut self, index: usize, value: T) -> bool {
                match index {
                    #(#places => { self.#fields = value; })*
                    _ => return false,
                }
                true
            }
        }
    }

    /// Names, rows and sizes.
    pub fn description(&self) -> TokenStream {
        let model = self.model();
        let bodies = self.moving_bodies().into_iter().map(|body| &model.bodies[body].name);
        let joints = model.joints.iter().map(|joint| {
            let (name, coordinates) = (&joint.name, coordinates(joint.kind));
            quote! { gyro_sim::JointInfo { name: #name, coordinates: &[#(gyro_sim::Coordinate::#coordinates),*] } }
        });
        let rows = model.rows().into_iter().map(|row| {
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
            (model.couplers.iter().map(|c| &c.name), model.drivers.iter().map(|d| &d.name));
        let (size, has_work, references) = (float(model.size()), model.has_work(), self.turn_references());
        let inputs = model.inputs.iter().map(|input| &input.name);
        let outputs = model.outputs.iter().flat_map(|output| {
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
        let model = self.model();
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
