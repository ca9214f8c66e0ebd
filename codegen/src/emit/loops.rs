//! A kernel with loops as Rust tokens.

use crate::emit::literals::Literals;
use crate::emit::names::{ident, index};
use crate::emit::results::{evenly, kept_name};
use crate::emit::tokens::{Body, Variables, Writer};
use crate::expr::constant::Constant;
use crate::expr::symbol::Symbol;
use crate::repeat::{At, Direction, Local, Row, Shape};
use crate::tape::{Kernel, Loop, Place};
use proc_macro2::{Ident, TokenStream};
use quote::{ToTokens, quote};
use std::collections::BTreeSet;

/// Writes a kernel with loops, with stand-ins for its literals.
pub fn body(variables: &impl Variables, literals: &Literals, kernel: &Kernel<Symbol, Constant>) -> Body {
    let writer = Writer::new(&kernel.outside, variables, literals, "t");
    let mut parts = writer.parts(&kernel.parts(), &kernel.roots()).into_iter();
    let mut symbols = writer.symbols();
    let mut statements = arrays(&kernel.arrays);
    let mut has_literals = false;
    let mut n_fixed = 0;
    for (number, repeat) in kernel.loops.iter().enumerate() {
        let fixed = writer.values(&repeat.fixed);
        let names = (n_fixed..).take(fixed.len()).map(|n| ident(&format!("fixed{n}")));
        n_fixed += fixed.len();
        let (places, values): (Vec<_>, Vec<_>) = repeat.stores.iter().copied().unzip();
        let stored = writer.values(&values);
        let places = places.into_iter().map(|[array, row, column]| {
            let (array, row, column) = (kept_name(array), index(row), index(column));
            quote! { #array[#row][#column] }
        });
        let part = parts.next();
        let body = Repeated { number, repeat, variables }.body(literals);
        symbols.extend(body.symbols);
        has_literals |= body.has_literals;
        let repeated = body.statements;
        statements.extend(quote! { #part #(let #names = #fixed;)* #(#places = #stored;)* #repeated });
    }
    statements.extend(parts.next());
    let values = writer.results(&kernel.results);
    symbols.retain(|symbol| !matches!(symbol, Symbol::Entry { .. } | Symbol::Local(_)));
    // What loops alone read by its place needs no name.
    let tapes = [&kernel.outside].into_iter().chain(kernel.loops.iter().map(|repeat| &repeat.body));
    let read: BTreeSet<Symbol> = tapes.flat_map(|tape| tape.variables()).copied().collect();
    let named: BTreeSet<Symbol> = symbols.intersection(&read).copied().collect();
    let bindings = writer.bindings(&named);
    let literal = (has_literals || writer.has_literals()).then(|| quote! { let k = T::constant; });
    Body { statements: quote! { #literal #bindings #statements }, values, symbols }
}

fn table_name(number: usize) -> Ident {
    ident(&format!("PARTS_{number}"))
}

fn arrays(shapes: &[Shape]) -> TokenStream {
    let used = shapes.iter().enumerate().filter(|(_, shape)| shape.columns > 0);
    let arrays = used.map(|(array, shape)| {
        let (name, rows, columns) = (kept_name(array), index(shape.rows), index(shape.columns));
        quote! { let mut #name = [[T::constant(0.0); #columns]; #rows]; }
    });
    arrays.collect()
}

/// A loop, and the variables of its body.
struct Repeated<'v, V> {
    number: usize,
    repeat: &'v Loop<Symbol, Constant>,
    variables: &'v V,
}

struct RepeatedBody {
    statements: TokenStream,
    symbols: BTreeSet<Symbol>,
    has_literals: bool,
}

impl<V: Variables> Repeated<'_, V> {
    fn body(&self, literals: &Literals) -> RepeatedBody {
        let repeat = self.repeat;
        let writer = Writer::new(&repeat.body, self, literals, "r");
        let mut symbols = writer.symbols();
        let locals: BTreeSet<Symbol> =
            symbols.iter().filter(|s| matches!(s, Symbol::Local(_))).copied().collect();
        let bindings = writer.bindings(&locals);
        let named = std::slice::from_ref(&repeat.body.named);
        let stored: Vec<Place> = repeat.values().copied().collect();
        let temporaries: TokenStream = writer.parts(named, &stored).into_iter().collect();
        let rows = repeat.rows.iter().map(|Row { array, at, values }| {
            let (array, values) = (kept_name(*array), writer.values(values));
            let row = match at {
                At::Part(offset) => row(*offset),
                At::Only => index(0).into_token_stream(),
            };
            quote! { #array[#row] = [#(#values),*]; }
        });
        let count = index(repeat.count);
        let range = match repeat.direction {
            Direction::Forward => quote! { 0..#count },
            Direction::Backward => quote! { (0..#count).rev() },
        };
        let table = self.table(literals);
        let statements = quote! {
            #table
            for i in #range {
                #bindings
                #temporaries
                #(#rows)*
            }
        };
        symbols.extend(self.repeat.locals.iter().filter_map(|local| match local {
            Local::Element { first, .. } => Some(*first),
            _ => None,
        }));
        let has_literals = writer.has_literals() || !repeat.table[0].is_empty();
        RepeatedBody { statements, symbols, has_literals }
    }

    fn table(&self, literals: &Literals) -> Option<TokenStream> {
        let table = &self.repeat.table;
        let (name, rows, columns) = (table_name(self.number), index(table.len()), index(table[0].len()));
        let written = table.iter().map(|row| {
            let row = row.iter().map(|constant| literals.tabulated(constant));
            quote! { [#(#row),*] }
        });
        (!table[0].is_empty()).then(|| quote! { const #name: [[f64; #columns]; #rows] = [#(#written),*]; })
    }
}

/// So many rows after that of the part.
fn row(offset: usize) -> TokenStream {
    evenly(offset, 1)
}

impl<V: Variables> Variables for Repeated<'_, V> {
    fn variable(&self, symbol: Symbol) -> (TokenStream, Option<TokenStream>) {
        let Symbol::Local(place) = symbol else { return (self.variables.variable(symbol).0, None) };
        let source = match self.repeat.locals[place] {
            Local::Factor(column) => {
                let (table, column) = (table_name(self.number), index(column));
                quote! { k(#table[i][#column]) }
            }
            Local::Row { array, offset, column } => {
                let (array, row, column) = (kept_name(array), row(offset), index(column));
                quote! { #array[#row][#column] }
            }
            Local::Carried { array, column } => {
                let (array, row, column) = (kept_name(array), index(0), index(column));
                quote! { #array[#row][#column] }
            }
            Local::Element { first, stride } => {
                let (array, at) = self.variables.element(first).expect("it is an element of an argument");
                let (array, place) = (ident(array), evenly(at, stride));
                quote! { #array[#place] }
            }
            Local::Fixed(number) => {
                let name = ident(&format!("fixed{number}"));
                return (quote! { #name }, None);
            }
        };
        let name = ident(&format!("v{place}"));
        (quote! { #name }, Some(source))
    }

    fn element(&self, symbol: Symbol) -> Option<(&'static str, usize)> {
        self.variables.element(symbol)
    }
}
