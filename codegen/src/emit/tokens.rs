//! A tape as Rust tokens.

use crate::emit::literals::Literals;
use crate::emit::names::{ident, index, table_names};
use crate::emit::results::Value;
use crate::expr::constant::Constant;
use crate::expr::symbol::Symbol;
use crate::tape::{Exact, Kernel, Operation, Place};
use gyro_program::elementary::Function;
use proc_macro2::{Ident, TokenStream};
use quote::quote;
use rustc_hash::FxHashMap as HashMap;
use std::cell::Cell;
use std::collections::BTreeSet;

/// The statements of a function and the values of its roots.
#[derive(Debug)]
pub struct Body {
    /// Bindings of literals, variables and shared expressions.
    pub statements: TokenStream,
    /// One expression for each root.
    pub values: Vec<Value>,
    /// Variables that the program reads.
    pub symbols: BTreeSet<Symbol>,
}

/// Where the variables of a module come from.
pub trait Variables {
    /// Name of a variable and the expression that reads it; `None` for the expression where it needs no binding.
    fn variable(&self, symbol: Symbol) -> (TokenStream, Option<TokenStream>);
    /// The array that a variable is an element of, and where, if it is.
    fn element(&self, symbol: Symbol) -> Option<(&'static str, usize)>;
}

/// Statements in one block: rustc opens a scope for each `let` and recurses over them, so long functions are cut into
/// blocks that hand on what is still needed.
const CHUNK: usize = 200;

/// A function with more statements is cut into larger blocks that are compiled apart: LLVM's time grows with the square
/// of a function's length.
const LONG: usize = 1500;
const PART: usize = 500;

/// How strongly an expression binds, for parentheses.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Binding {
    Sum,
    Product,
    Unary,
    /// What a method may be called on: `-x.sqrt()` is the negative of a root.
    Call,
}

/// Writes a kernel without loops, with stand-ins for its literals.
pub fn body(variables: &impl Variables, literals: &Literals, kernel: &Kernel<Symbol, Constant>) -> Body {
    let writer = Writer::new(&kernel.outside, variables, literals, "t");
    let symbols = writer.symbols();
    let bindings = writer.bindings(&symbols);
    let values = writer.results(&kernel.results);
    let temporaries: TokenStream = writer.parts(&kernel.parts(), &kernel.results).into_iter().collect();
    let literal = writer.literal_binding();
    let statements = quote! { #literal #bindings #temporaries };
    Body { statements, values, symbols }
}

/// Writes the operations of a tape.
pub struct Writer<'a, V> {
    tape: &'a Exact,
    variables: &'a V,
    literals: &'a Literals,
    names: HashMap<Place, Ident>,
    has_literals: Cell<bool>,
}

impl<'a, V: Variables> Writer<'a, V> {
    /// Names begin with the given letter.
    pub fn new(tape: &'a Exact, variables: &'a V, literals: &'a Literals, letter: &str) -> Self {
        let named = tape.named.iter().enumerate();
        let names = named.map(|(n, &place)| (place, ident(&format!("{letter}{n}")))).collect();
        Self { tape, variables, literals, names, has_literals: Cell::new(false) }
    }

    /// The variables that the program reads.
    pub fn symbols(&self) -> BTreeSet<Symbol> {
        self.tape.variables().copied().collect()
    }

    /// Binds variables to their names.
    pub fn bindings(&self, symbols: &BTreeSet<Symbol>) -> TokenStream {
        let bindings = symbols.iter().filter_map(|&symbol| match self.variables.variable(symbol) {
            (name, Some(source)) => Some(quote! { let #name = #source; }),
            (_, None) => None,
        });
        bindings.collect()
    }

    /// Values as they stand at the end of an assignment.
    pub fn values(&self, roots: &[Place]) -> Vec<TokenStream> {
        roots.iter().map(|&root| self.expression(root, Binding::Sum)).collect()
    }

    /// The same for the results of a function.
    pub fn results(&self, roots: &[Place]) -> Vec<Value> {
        let has_name = |place| self.names.contains_key(&place);
        let kept = |symbol: &Symbol| match *symbol {
            Symbol::Entry { array, row, column } => Some([array, row, column]),
            _ => None,
        };
        let copied = |&root| self.tape.copied(root, has_name, kept);
        let tokens = self.values(roots).into_iter().zip(roots);
        tokens.map(|(tokens, root)| Value { tokens, copied: copied(root) }).collect()
    }

    /// What literals are made by, if there are any in what was written.
    pub fn literal_binding(&self) -> Option<TokenStream> {
        self.has_literals.get().then(|| quote! { let k = T::constant; })
    }

    pub fn has_literals(&self) -> bool {
        self.has_literals.get()
    }

    /// Binds shared expressions, those of each part by themselves. Roots may be read after any part.
    pub fn parts(&self, parts: &[Vec<Place>], roots: &[Place]) -> Vec<TokenStream> {
        let n_temporaries = self.tape.named.len();
        let is_long = n_temporaries > LONG;
        let size = if is_long { PART } else { CHUNK };
        let order: Vec<Place> = parts.concat();
        let last_use = if n_temporaries > CHUNK { self.last_uses(&order, roots) } else { HashMap::default() };
        let mut end = 0;
        let mut written = Vec::new();
        for part in parts {
            if part.len() <= CHUNK {
                end += part.len();
                written.push(part.iter().map(|&id| self.binding(id)).collect());
                continue;
            }
            let chunks = part.chunks(size).map(|chunk| {
                end += chunk.len();
                let live: Vec<_> =
                    chunk.iter().filter(|id| last_use[id] >= end).map(|id| &self.names[id]).collect();
                let bindings = chunk.iter().map(|&id| self.binding(id));
                let block = quote! { { #(#bindings)* (#(#live,)*) } };
                let block = if is_long {
                    quote! { gyro_sim::apart(move || #block) }
                } else {
                    block
                };
                quote! { let (#(#live,)*) = #block; }
            });
            written.push(chunks.collect());
        }
        written
    }

    /// For each temporary the position of the last one that reads it; beyond all for a root.
    fn last_uses(&self, order: &[Place], roots: &[Place]) -> HashMap<Place, usize> {
        let mut last = HashMap::default();
        for (position, &id) in order.iter().enumerate() {
            for operand in self.tape.operation(id).operands() {
                self.mark(operand, position, &mut last);
            }
        }
        for &root in roots {
            self.mark(root, usize::MAX, &mut last);
        }
        last
    }

    fn mark(&self, id: Place, position: usize, last: &mut HashMap<Place, usize>) {
        if self.names.contains_key(&id) {
            let entry = last.entry(id).or_insert(position);
            *entry = position.max(*entry);
            return;
        }
        for operand in self.tape.operation(id).operands() {
            self.mark(operand, position, last);
        }
    }

    fn binding(&self, id: Place) -> TokenStream {
        let name = &self.names[&id];
        let (value, _) = self.operation(id);
        quote! { let #name = #value; }
    }

    /// A number by its name if it has one, in parentheses if it binds less strongly than needed.
    fn expression(&self, id: Place, needed: Binding) -> TokenStream {
        if let Some(name) = self.names.get(&id) {
            return quote! { #name };
        }
        let (tokens, binding) = self.operation(id);
        if binding < needed {
            quote! { (#tokens) }
        } else {
            tokens
        }
    }

    fn operation(&self, id: Place) -> (TokenStream, Binding) {
        let [sum, product, unary] = [Binding::Sum, Binding::Product, Binding::Unary]
            .map(|needed| move |a: &Place| self.expression(*a, needed));
        match self.tape.operation(id) {
            Operation::Constant(value) => (self.literal(value), Binding::Unary),
            Operation::Variable(symbol) => (self.variables.variable(*symbol).0, Binding::Call),
            Operation::Add(a, b) => {
                let (a, b) = (sum(a), product(b));
                (quote! { #a + #b }, Binding::Sum)
            }
            Operation::Subtract(a, b) => {
                let (a, b) = (sum(a), product(b));
                (quote! { #a - #b }, Binding::Sum)
            }
            Operation::Multiply(a, b) => {
                let (a, b) = (product(a), unary(b));
                (quote! { #a * #b }, Binding::Product)
            }
            Operation::Divide(a, b) => {
                let (a, b) = (product(a), unary(b));
                (quote! { #a / #b }, Binding::Product)
            }
            Operation::Negate(a) => {
                let a = unary(a);
                (quote! { -#a }, Binding::Unary)
            }
            Operation::Fused(x, y, added) => {
                let (x, y, added) = (sum(x), sum(y), sum(added));
                (quote! { T::fused(#x, #y, #added) }, Binding::Call)
            }
            Operation::Call(Function::Curve { curve, order }, [a, _]) => {
                let (a, (knots, pieces)) =
                    (self.expression(*a, Binding::Call), table_names(usize::from(*curve)));
                if *order == Function::LAST_ORDER {
                    return (quote! { #a.spline_third(&#knots, &#pieces) }, Binding::Call);
                }
                let order = index(usize::from(*order));
                (quote! { #a.spline(&#knots, &#pieces)[#order] }, Binding::Call)
            }
            Operation::Call(function, [a, b]) => {
                let (name, a) = (ident(function.name()), self.expression(*a, Binding::Call));
                let b = (function.arity() == 2).then(|| sum(b));
                (quote! { #a.#name(#b) }, Binding::Call)
            }
        }
    }

    fn literal(&self, constant: &Constant) -> TokenStream {
        self.has_literals.set(true);
        self.literals.stand_in(constant)
    }
}

#[cfg(test)]
mod tests;
