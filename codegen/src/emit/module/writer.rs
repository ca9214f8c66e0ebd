//! What the parts of a module are written from, and how a function of it is written.

use super::tables;
use crate::emit::data_sheet::printable;
use crate::emit::literals::Literals;
use crate::emit::loops;
use crate::emit::names::{ident, index};
use crate::emit::tokens::{self, Body};
use crate::equations::Equations;
use crate::expr::constant::Constant;
use crate::expr::symbol::Symbol;
use crate::kernels::Kernels;
use crate::scheduled::ExactKernel;
use crate::tape;
use gyro_program::{Counts, Kernel};
use proc_macro2::{Ident, TokenStream};
use quote::quote;
use std::collections::{BTreeMap, BTreeSet};

fn table_of(symbol: &Symbol) -> Option<usize> {
    if let Symbol::Table { table, .. } = symbol { Some(*table) } else { None }
}

fn table_names(table: usize) -> (Ident, Ident) {
    (ident(&tables::knots_name(table)), ident(&tables::pieces_name(table)))
}

/// Binds value and derivatives of a table's curve.
fn evaluated_table(table: usize) -> TokenStream {
    let (name, (knots, pieces)) = (ident(&format!("table{table}")), table_names(table));
    quote! { let #name = t.spline(&#knots, &#pieces); }
}

/// What the parts of a module are written from.
pub struct ModuleWriter<'a> {
    pub equations: &'a Equations<'a>,
    pub counts: Counts,
    pub type_name: &'a str,
    pub kernels: Kernels,
    /// Exact constants of all functions.
    pub literals: Literals,
    /// What is written of each kernel.
    pub exact: BTreeMap<Kernel, ExactKernel>,
}

impl ModuleWriter<'_> {
    pub fn moving_bodies(&self) -> Vec<usize> {
        self.equations.model.coordinate_bodies()
    }

    fn body(&self, kernel: &tape::Kernel<Symbol, Constant>) -> Body {
        let mut body = if kernel.loops.is_empty() {
            tokens::body(self, &self.literals, kernel)
        } else {
            loops::body(self, &self.literals, kernel)
        };
        let tables: BTreeSet<_> = body.symbols.iter().filter_map(table_of).collect();
        let (statements, tables) = (&body.statements, tables.into_iter().map(evaluated_table));
        body.statements = quote! { #(#tables)* #statements };
        body
    }

    /// Knots and pieces of each table, without their numbers.
    pub fn tables_of_motions(&self) -> TokenStream {
        let tables = self.equations.tables.iter().enumerate().map(|(table, spline)| {
            let (knots, pieces) = table_names(table);
            let (n_knots, n_pieces) = (index(spline.knots.len()), index(spline.pieces.len()));
            let doc = format!(" Times of the points of `{}`, s.", printable(&spline.source));
            quote! {
                #[doc = #doc]
                const #knots: [f64; #n_knots] = [];
                /// Polynomials between them, from each point's own time.
                const #pieces: [[f64; 4]; #n_pieces] = [];
            }
        });
        tables.collect()
    }

    /// A function with its operation counts; arguments that it does not read get a leading underscore.
    pub fn function(
        &self,
        kernel: Kernel,
        write: impl Fn(&Body, &TokenStream, &Ident) -> TokenStream,
    ) -> TokenStream {
        let nothing = ExactKernel::default();
        let exact = self.exact.get(&kernel).unwrap_or(&nothing);
        let body = self.body(&exact.tape);
        let reads_state = body.symbols.iter().any(|symbol| {
            matches!(
                symbol,
                Symbol::Position { .. }
                    | Symbol::Euler { .. }
                    | Symbol::Velocity { .. }
                    | Symbol::Spin { .. }
                    | Symbol::Turn(_)
            )
        });
        let t = if body.symbols.iter().any(|s| matches!(s, Symbol::Time | Symbol::Table { .. })) {
            quote! { t }
        } else {
            quote! { _t }
        };
        let reads_joints =
            body.symbols.iter().any(|symbol| matches!(symbol, Symbol::Coordinate(_) | Symbol::Rate(_)));
        let y = ident(match (reads_state, reads_joints) {
            (true, _) => "y",
            (false, true) => "x",
            (false, false) => "_y",
        });
        let doc = format!(" {}: {}.", kernel.signature().does_in_rust(), exact.operations);
        let function = write(&body, &t, &y);
        quote! { #[doc = #doc] #function }
    }
}
