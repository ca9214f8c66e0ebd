//! Where numbers stand, as constants by name.
//!
//! Names of a model file are in lower case and unique among their kind, so in upper case no two of a kind are alike,
//! and none is a word of Rust. Kinds, and coordinates of joints that have several, are modules: no name is put together
//! of others.

use super::writer::ModuleWriter;
use crate::emit::names::{ident, index};
use crate::scheduled::Index;
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    /// Of joint coordinates and rates in the joint state, of inputs, outputs and parameters.
    pub fn indices(&self) -> TokenStream {
        let kinds = self.scheduled.indices.chunk_by(|one, next| one.kind == next.kind).map(|of_kind| {
            let coordinates = of_kind.chunk_by(|one, next| one.coordinate == next.coordinate);
            let content = coordinates.map(|of_coordinate| {
                let constants = of_coordinate.iter().map(constant);
                let constants = quote! { #(#constants)* };
                of_coordinate[0].coordinate.map_or(constants.clone(), |name| module(name, &constants))
            });
            module(of_kind[0].kind, &content.collect())
        });
        quote! {
            /// Where numbers stand, by name; of several numbers the first.
            #[allow(dead_code, missing_docs)]
            pub mod index {
                #(#kinds)*
            }
        }
    }
}

fn constant(Index { name, place, .. }: &Index) -> TokenStream {
    let (name, place) = (ident(&name.to_uppercase()), index(*place));
    quote! { pub const #name: usize = #place; }
}

fn module(name: &str, content: &TokenStream) -> TokenStream {
    let name = ident(name);
    quote! { pub mod #name { #content } }
}
