//! What the parts of a module are written from, and how a function of it is written.

use crate::emit::data_sheet::printable;
use crate::emit::literals::Literals;
use crate::emit::loops;
use crate::emit::names::{ident, if_read, index, table_names};
use crate::emit::tokens::{self, Body};
use crate::equations::Argument;
use crate::expr::constant::Constant;
use crate::expr::symbol::Symbol;
use crate::scheduled::{Computed, ExactKernel, Scheduled, Variable};
use crate::tape;
use gyro_model::Model;
use gyro_program::{Counts, Kernel};
use proc_macro2::{Ident, TokenStream};
use quote::quote;
use std::collections::BTreeSet;

fn table_of(symbol: &Symbol) -> Option<usize> {
    if let Symbol::Table { table, .. } = symbol { Some(*table) } else { None }
}

/// Binds value and derivatives of a table's curve.
fn evaluated_table(table: usize) -> TokenStream {
    let (name, (knots, pieces)) = (ident(&format!("table{table}")), table_names(table));
    quote! { let #name = t.spline(&#knots, &#pieces); }
}

/// What the parts of a module are written from.
pub struct ModuleWriter<'a> {
    pub computed: &'a Computed<'a>,
    pub type_name: &'a str,
    /// Exact constants of all functions.
    pub literals: Literals,
    /// The mechanism as data.
    pub scheduled: &'a Scheduled,
}

impl ModuleWriter<'_> {
    pub fn model(&self) -> &Model {
        self.computed.equations.model
    }

    pub fn moving_bodies(&self) -> Vec<usize> {
        self.model().coordinate_bodies()
    }

    pub fn counts(&self) -> &Counts {
        &self.scheduled.counts
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
        let tables = self.scheduled.curves.iter().enumerate().map(|(table, spline)| {
            let (knots, pieces) = table_names(table);
            let (n_knots, n_pieces) = (index(spline.knots.len()), index(spline.pieces.len()));
            let n_curves = self.computed.equations.graph.domains.curves.len();
            let [of, unit] = if table < n_curves { ["Arguments", ""] } else { ["Times", ", s"] };
            let doc = format!(" {of} of the points of `{}`{unit}.", printable(&spline.source));
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
        let exact = self.computed.exact.get(&kernel).unwrap_or(&nothing);
        let body = self.body(&exact.tape);
        let of_time = |read: &Variable| matches!(read, Variable::Time | Variable::Curve { .. });
        let t = if_read("t", self.reads(kernel, of_time));
        let reads = |argument| self.reads_argument(kernel, &[argument]);
        let y = ident(match (reads(Argument::State), reads(Argument::Joints)) {
            (true, _) => "y",
            (false, true) => "x",
            (false, false) => "_y",
        });
        let doc = format!(" {}: {}.", kernel.signature().does_in_rust(), exact.operations);
        let function = write(&body, &quote! { #t }, &y);
        quote! { #[doc = #doc] #function }
    }

    /// Whether a kernel reads such a variable.
    pub fn reads(&self, kernel: Kernel, is_such: impl Fn(&Variable) -> bool) -> bool {
        self.scheduled.kernels.get(&kernel).is_some_and(|kernel| kernel.variables().any(is_such))
    }

    /// Whether a kernel reads one of these arguments.
    pub fn reads_argument(&self, kernel: Kernel, arguments: &[Argument]) -> bool {
        let kernel = self.scheduled.kernels.get(&kernel);
        kernel.is_some_and(|kernel| arguments.iter().any(|&argument| kernel.reads(argument)))
    }
}
