//! Names and numbers as Rust tokens.

use proc_macro2::{Ident, Literal, Span};

pub fn ident(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

pub fn index(value: usize) -> Literal {
    Literal::usize_unsuffixed(value)
}

/// The name of an argument, with a leading underscore if nothing reads it.
pub fn if_read(name: &str, is_read: bool) -> Ident {
    if is_read { ident(name) } else { ident(&format!("_{name}")) }
}
