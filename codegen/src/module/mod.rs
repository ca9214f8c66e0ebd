//! The text of a generated module: the mechanism's type and its implementation of the run-time contract.

mod definition;
mod equations;
mod joint_space;
mod mechanism;
mod ode;
mod partition;
mod ports;
mod tables;
mod variables;

use crate::emit::ident;
use crate::emit::{self, Body};
use crate::equations::Equations;
use crate::functions::Functions;
use crate::graph::ExprId;
use crate::literals::Literals;
use crate::schedule::Operations;
use crate::set_up;
use crate::sheet::{Sheet, printable};
use crate::symbol::Symbol;
use gyro_model::Start;
use proc_macro2::{Ident, TokenStream};
use quote::quote;
use std::collections::BTreeSet;

/// `gyroscope_maximal` to `GyroscopeMaximal`; what Rust or the generic parameter already means gets an underscore.
pub fn type_name(module_name: &str) -> String {
    let capital = |word: &str| {
        let mut letters = word.chars();
        letters
            .next()
            .map(|first| first.to_uppercase().chain(letters).collect::<String>())
            .unwrap_or_default()
    };
    let name: String = module_name.split('_').map(capital).collect();
    if ["Self", "T", "Parameters"].contains(&name.as_str()) { format!("{name}_") } else { name }
}

/// The text of a module, the exact constants of its literals and its data sheet.
pub struct Text {
    pub code: String,
    pub constants: String,
    pub sheet: Sheet,
}

/// Writes the files.
pub fn write(file_name: &str, type_name: &str, mut equations: Equations, start: &Start) -> Text {
    let mut functions = Functions::of(&equations);
    equations.finish.all(&mut equations.graph, &mut functions);
    set_up::separate(&mut equations.graph, &mut functions);
    let (equations, literals) = (&equations, Literals::default());
    let module = ModuleWriter { equations, type_name, functions, literals };
    let tokens = module.tokens(start);
    let sheet = Sheet::of(equations, &module.functions);
    let (tokens, constants) = module.literals.write(tokens);
    let file = syn::parse2(tokens).expect("the emitted tokens are Rust");
    let text = tables::with_numbers(prettyplease::unparse(&file), &equations.tables);
    let code = format!("{}\n{text}", sheet.head(file_name));
    Text { code, constants, sheet }
}

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
struct ModuleWriter<'a> {
    equations: &'a Equations<'a>,
    type_name: &'a str,
    functions: Functions,
    /// Exact constants of all functions.
    literals: Literals,
}

impl ModuleWriter<'_> {
    fn slots(&self) -> Vec<usize> {
        self.equations.model.coordinate_bodies()
    }

    fn body(&self, roots: &[ExprId]) -> Body {
        let mut body = emit::body(&self.equations.graph, self, &self.literals, roots);
        let tables: BTreeSet<_> = body.symbols.iter().filter_map(table_of).collect();
        let (statements, tables) = (&body.statements, tables.into_iter().map(evaluated_table));
        body.statements = quote! { #(#tables)* #statements };
        body
    }

    fn operations(&self, roots: &[ExprId]) -> Operations {
        Operations::count(&self.equations.graph, roots)
    }

    fn tokens(&self, start: &Start) -> TokenStream {
        let (tables, definition, ode) = (self.tables_of_motions(), self.definition(), self.ode(start));
        let (mechanism, partition) = (self.mechanism(), self.partition());
        let (equations, projection) = (self.equations(), self.projection());
        let (joint_space, joint_jacobian) = (self.joint_space(), self.joint_jacobian());
        let ports = self.ports();
        quote! {
            #tables
            #definition
            #ode
            #mechanism
            #partition
            #equations
            #projection
            #joint_space
            #joint_jacobian
            #ports
        }
    }

    /// Knots and pieces of each table, without their numbers.
    fn tables_of_motions(&self) -> TokenStream {
        let tables = self.equations.tables.iter().enumerate().map(|(table, spline)| {
            let (knots, pieces) = table_names(table);
            let (n_knots, n_pieces) = (emit::index(spline.knots.len()), emit::index(spline.pieces.len()));
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

    /// A function of time and state that fills `out`.
    fn filling(&self, name: &str, what: &str, ty: &str, roots: &[ExprId]) -> TokenStream {
        let (name, ty) = (ident(name), ident(ty));
        self.function(what, roots, |body, t, y| {
            let (statements, values) = (&body.statements, &body.values);
            quote! {
                fn #name(&self, #t: T, #y: &Self::State, out: &mut Self::#ty) {
                    #statements
                    *out = [#(#values),*];
                }
            }
        })
    }

    /// A function with its operation counts; arguments that it does not read get a leading underscore.
    fn function(
        &self,
        what: &str,
        roots: &[ExprId],
        write: impl Fn(&Body, &TokenStream, &Ident) -> TokenStream,
    ) -> TokenStream {
        let body = self.body(roots);
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
        let doc = format!(" {what}: {}.", self.operations(roots));
        let function = write(&body, &t, &y);
        quote! { #[doc = #doc] #function }
    }
}
