//! Names and numbers as Rust tokens.

use proc_macro2::{Ident, Literal, Span};

pub fn ident(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

pub fn index(value: usize) -> Literal {
    Literal::usize_unsuffixed(value)
}
