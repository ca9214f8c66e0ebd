//! Where numbers stand, as constants by name.
//!
//! Names of a model file are in lower case and unique among their kind, so in upper case no two of a kind are alike,
//! and none is a word of Rust. Kinds, and coordinates of joints that have several, are modules: no name is put together
//! of others.

use super::writer::ModuleWriter;
use crate::emit::names::{ident, index};
use crate::joint_space::JointSpace;
use gyro_model::{Attachment, CoordinateKind};
use proc_macro2::TokenStream;
use quote::quote;

/// A coordinate of a joint state: what names it, and where it and its rate stand.
struct Named<'m> {
    name: &'m str,
    of: Of,
    x: usize,
    u: usize,
}

#[derive(Clone, Copy, PartialEq)]
enum Of {
    /// The only coordinate of a joint.
    Joint,
    /// One of several.
    Coordinate(CoordinateKind),
    Orientation,
    Body,
}

/// The modules of joints with several coordinates, in their order.
const COORDINATES: [(Of, &str); 7] = [
    (Of::Coordinate(CoordinateKind::Angle), "angle"),
    (Of::Coordinate(CoordinateKind::Displacement), "displacement"),
    (Of::Coordinate(CoordinateKind::FirstAngle), "first_angle"),
    (Of::Coordinate(CoordinateKind::SecondAngle), "second_angle"),
    (Of::Coordinate(CoordinateKind::X), "x"),
    (Of::Coordinate(CoordinateKind::Y), "y"),
    (Of::Orientation, "orientation"),
];

impl ModuleWriter<'_> {
    /// Of joint coordinates and rates in the joint state, of inputs, outputs and parameters.
    pub fn indices(&self) -> TokenStream {
        let model = self.equations.model;
        let named = self.equations.joint_space.as_ref().map_or_else(Vec::new, |space| self.named(space));
        let n_x = self.equations.joint_space.as_ref().map_or(0, |space| space.layout.n_coordinates);
        let [joint, joint_rate] = [("joint", 0), ("joint_rate", n_x)].map(|(kind, first)| {
            let of = |of: Of| constants(named.iter().filter(|n| n.of == of).map(|n| (n.name, n.at(first))));
            let inner = COORDINATES.map(|(coordinate, name)| module(name, &of(coordinate)));
            let own = of(Of::Joint);
            module(kind, &quote! { #own #(#inner)* })
        });
        let [body, body_rate] = [("body", 0), ("body_rate", n_x)].map(|(kind, first)| {
            let of_bodies = named.iter().filter(|n| n.of == Of::Body);
            module(kind, &constants(of_bodies.map(|n| (n.name, n.at(first)))))
        });
        let named_in_order = |names: Vec<&String>| constants(names.into_iter().map(String::as_str).zip(0..));
        let input = module("input", &named_in_order(model.inputs.iter().map(|p| &p.name).collect()));
        let parameter =
            module("parameter", &named_in_order(model.parameters.iter().map(|p| &p.name).collect()));
        let mut n_before = 0;
        let outputs = model.outputs.iter().map(|output| {
            let first = n_before;
            n_before += output.kind.columns().len();
            (output.name.as_str(), first)
        });
        let output = module("output", &constants(outputs));
        quote! {
            /// Where numbers stand, by name; of several numbers the first.
            #[allow(dead_code, missing_docs)]
            pub mod index {
                #joint #joint_rate #body #body_rate #input #output #parameter
            }
        }
    }

    /// What stands in x, in its order.
    fn named(&self, space: &JointSpace) -> Vec<Named<'_>> {
        let model = self.equations.model;
        let mut named = Vec::new();
        for link in &space.layout.links {
            for scalar in link.scalars.iter().filter(|scalar| scalar.place.x < space.layout.n_coordinates) {
                let joint = &model.joints[scalar.coordinate.joint];
                let is_alone = joint.kind.coordinates().len() == 1;
                let of = if is_alone { Of::Joint } else { Of::Coordinate(scalar.kind) };
                named.push(Named { name: &joint.name, of, x: scalar.place.x, u: scalar.place.u });
            }
            let Some(orientation) = link.orientation else { continue };
            let (name, of, place) = match (link.link.attachment, link.position) {
                (Attachment::Joint { joint, .. }, _) => {
                    (&model.joints[joint].name, Of::Orientation, orientation)
                }
                (_, position) => {
                    let place = position.expect("nothing else holds it");
                    (&model.bodies[link.link.body].name, Of::Body, place)
                }
            };
            named.push(Named { name, of, x: place.x, u: place.u });
        }
        named.sort_by_key(|named| named.x);
        named
    }
}

impl Named<'_> {
    /// Where it stands, or its rate if rates begin somewhere.
    fn at(&self, first_rate: usize) -> usize {
        if first_rate == 0 { self.x } else { first_rate + self.u }
    }
}

fn constants<'m>(named: impl Iterator<Item = (&'m str, usize)>) -> TokenStream {
    let constants = named.map(|(name, place)| {
        let (name, place) = (ident(&name.to_uppercase()), index(place));
        quote! { pub const #name: usize = #place; }
    });
    quote! { #(#constants)* }
}

/// Nothing if it would be empty.
fn module(name: &str, content: &TokenStream) -> Option<TokenStream> {
    let name = ident(name);
    (!content.is_empty()).then(|| quote! { pub mod #name { #content } })
}
