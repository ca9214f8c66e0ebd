//! A kernel with loops as Rust tokens.

use crate::emit::literals::Literals;
use crate::emit::tokens::{Body, Variables, Writer, ident, index};
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::schedule::Program;
use crate::expr::symbol::Symbol;
use crate::repeat::{Direction, Local, Repeat, Rolled, Shape};
use proc_macro2::{Ident, TokenStream};
use quote::quote;
use rustc_hash::FxHashSet as HashSet;
use std::collections::BTreeSet;

/// Writes a kernel with loops, with stand-ins for its literals.
pub fn body(variables: &impl Variables, literals: &Literals, rolled: &Rolled) -> Body {
    let outside = Outside { variables };
    let roots: Vec<Vec<ExprId>> = rolled.loops.iter().map(|(before, _)| before.roots()).collect();
    let all = rolled.outside_roots();
    let program = Program::new(&rolled.graph, &all);
    let writer = Writer::new(&rolled.graph, &outside, literals, (&program, "t"));
    let parts = parts(rolled, &program, &roots);
    let mut parts = writer.parts(&parts, &all).into_iter();
    let mut symbols = writer.symbols();
    let mut statements = arrays(&rolled.arrays);
    let mut has_literals = false;
    let mut n_fixed = 0;
    for (number, (before, repeat)) in rolled.loops.iter().enumerate() {
        let values = writer.values(&before.roots());
        let (fixed, stored) = values.split_at(before.fixed.len());
        let names = (n_fixed..).take(fixed.len()).map(|n| ident(&format!("fixed{n}")));
        n_fixed += fixed.len();
        let places = before.stores.iter().map(|&([array, row, column], _)| {
            let (array, row, column) = (array_name(array), index(row), index(column));
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
    let values = writer.values(&rolled.roots);
    symbols.retain(|symbol| !matches!(symbol, Symbol::Entry { .. } | Symbol::Local(_)));
    // What loops alone read by its place needs no name.
    let named: BTreeSet<Symbol> =
        symbols.iter().filter(|s| is_named(rolled, &program, **s)).copied().collect();
    let bindings = writer.bindings(&named);
    let literal = (has_literals || writer.has_literals()).then(|| quote! { let k = T::constant; });
    Body { statements: quote! { #literal #bindings #statements }, values, symbols }
}

/// Whether a variable is read by its name anywhere.
fn is_named(rolled: &Rolled, program: &Program, symbol: Symbol) -> bool {
    let is_it = |graph: &Graph, id: ExprId| matches!(graph.node(id), Node::Symbol(other) if *other == symbol);
    program.uses.order.iter().any(|&id| is_it(&rolled.graph, id))
        || rolled.loops.iter().any(|(_, repeat)| {
            repeat.graph.reachable(&repeat.values).into_iter().any(|id| is_it(&repeat.graph, id))
        })
}

/// Shared expressions that are bound before each loop, and after all of them.
fn parts(rolled: &Rolled, program: &Program, roots: &[Vec<ExprId>]) -> Vec<Vec<ExprId>> {
    let mut known: HashSet<ExprId> = HashSet::default();
    let mut rest = program.temporaries.clone();
    let mut parts = Vec::new();
    for roots in roots {
        known.extend(rolled.graph.reachable(roots));
        let (part, after): (Vec<_>, Vec<_>) = rest.into_iter().partition(|id| known.contains(id));
        parts.push(part);
        rest = after;
    }
    parts.push(rest);
    parts
}

fn array_name(array: usize) -> Ident {
    ident(&format!("kept{array}"))
}

fn table_name(number: usize) -> Ident {
    ident(&format!("PARTS_{number}"))
}

fn arrays(shapes: &[Shape]) -> TokenStream {
    let used = shapes.iter().enumerate().filter(|(_, shape)| shape.columns > 0);
    let arrays = used.map(|(array, shape)| {
        let (name, rows, columns) = (array_name(array), index(shape.rows), index(shape.columns));
        quote! { let mut #name = [[T::constant(0.0); #columns]; #rows]; }
    });
    arrays.collect()
}

/// Variables outside of loops.
struct Outside<'v, V> {
    variables: &'v V,
}

impl<V: Variables> Variables for Outside<'_, V> {
    fn variable(&self, symbol: Symbol) -> (TokenStream, Option<TokenStream>) {
        let Symbol::Entry { array, row, column } = symbol else { return self.variables.variable(symbol) };
        let (array, row, column) = (array_name(array), index(row), index(column));
        (quote! { #array[#row][#column] }, None)
    }

    fn element(&self, symbol: Symbol) -> Option<(&'static str, usize)> {
        self.variables.element(symbol)
    }
}

/// A loop, and the variables of its body.
struct Repeated<'v, V> {
    number: usize,
    repeat: &'v Repeat,
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
        let program = Program::new(&repeat.graph, &repeat.values);
        let writer = Writer::new(&repeat.graph, self, literals, (&program, "r"));
        let mut symbols = writer.symbols();
        let locals: BTreeSet<Symbol> =
            symbols.iter().filter(|s| matches!(s, Symbol::Local(_))).copied().collect();
        let bindings = writer.bindings(&locals);
        let temporaries: TokenStream =
            writer.parts(std::slice::from_ref(&program.temporaries), &repeat.values).into_iter().collect();
        let values = writer.values(&repeat.values);
        let (array, row) = (array_name(repeat.array), row(repeat.offset));
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
                #array[#row] = [#(#values),*];
            }
        };
        symbols.extend(repeat.locals.iter().filter_map(|local| match local {
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
    let offset = (offset > 0).then(|| index(offset));
    offset.map_or(quote! { i }, |offset| quote! { i + #offset })
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
                let (array, row, column) = (array_name(array), row(offset), index(column));
                quote! { #array[#row][#column] }
            }
            Local::Element { first, stride } => {
                let (array, at) = self.variables.element(first).expect("it is an element of an argument");
                let (array, factor) = (ident(array), (stride > 1).then(|| index(stride)));
                let i = factor.map_or(quote! { i }, |factor| quote! { #factor * i });
                let at = (at > 0).then(|| index(at));
                let place = at.map_or(i.clone(), |at| quote! { #i + #at });
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
