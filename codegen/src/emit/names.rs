//! Names and numbers as Rust tokens.

use proc_macro2::{Ident, Literal, Span};

pub fn ident(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

pub fn index(value: usize) -> Literal {
    Literal::usize_unsuffixed(value)
}

/// Name of the times, or arguments, of a table.
pub fn knots_name(table: usize) -> String {
    format!("KNOTS_{table}")
}

/// Name of its polynomials.
pub fn pieces_name(table: usize) -> String {
    format!("PIECES_{table}")
}

/// Both names.
pub fn table_names(table: usize) -> (Ident, Ident) {
    (ident(&knots_name(table)), ident(&pieces_name(table)))
}

/// The name of an argument, with a leading underscore if nothing reads it.
pub fn if_read(name: &str, is_read: bool) -> Ident {
    if is_read { ident(name) } else { ident(&format!("_{name}")) }
}
