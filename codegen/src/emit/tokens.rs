//! A straight-line program as Rust tokens.

use crate::emit::literals::Literals;
use crate::expr::constant::Constant;
use crate::expr::graph::{ExprId, Graph, Node};
use crate::expr::schedule::Program;
use crate::expr::symbol::Symbol;
use proc_macro2::{Ident, Literal, Span, TokenStream};
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
    pub values: Vec<TokenStream>,
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

/// Writes the program that computes `roots`, with stand-ins for its literals.
pub fn body(graph: &Graph, variables: &impl Variables, literals: &Literals, roots: &[ExprId]) -> Body {
    let program = Program::new(graph, roots);
    let writer = Writer::new(graph, variables, literals, (&program, "t"));
    let symbols = writer.symbols();
    let bindings = writer.bindings(&symbols);
    let values = writer.values(roots);
    let temporaries = writer.temporaries(roots);
    let literal = writer.literal_binding();
    let statements = quote! { #literal #bindings #temporaries };
    Body { statements, values, symbols }
}

pub fn ident(name: &str) -> Ident {
    Ident::new(name, Span::call_site())
}

pub fn index(value: usize) -> Literal {
    Literal::usize_unsuffixed(value)
}

/// `x y + added`.
fn fused(x: &TokenStream, y: &TokenStream, added: &TokenStream) -> (TokenStream, Binding) {
    (quote! { T::fused(#x, #y, #added) }, Binding::Call)
}

/// Writes expressions of a graph.
pub struct Writer<'a, V> {
    graph: &'a Graph,
    variables: &'a V,
    literals: &'a Literals,
    program: &'a Program,
    names: HashMap<ExprId, Ident>,
    has_literals: Cell<bool>,
}

impl<'a, V: Variables> Writer<'a, V> {
    /// Names of shared expressions begin with the given letter.
    pub fn new(
        graph: &'a Graph,
        variables: &'a V,
        literals: &'a Literals,
        (program, letter): (&'a Program, &str),
    ) -> Self {
        let named = program.temporaries.iter().enumerate();
        let names = named.map(|(n, &id)| (id, ident(&format!("{letter}{n}")))).collect();
        Self { graph, variables, literals, program, names, has_literals: Cell::new(false) }
    }

    /// The variables that the program reads.
    pub fn symbols(&self) -> BTreeSet<Symbol> {
        self.program.uses.order.iter().filter_map(|&id| self.as_symbol(id)).collect()
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
    pub fn values(&self, roots: &[ExprId]) -> Vec<TokenStream> {
        roots.iter().map(|&root| self.expression(root, Binding::Sum)).collect()
    }

    /// What literals are made by, if there are any in what was written.
    pub fn literal_binding(&self) -> Option<TokenStream> {
        self.has_literals.get().then(|| quote! { let k = T::constant; })
    }

    pub fn has_literals(&self) -> bool {
        self.has_literals.get()
    }

    fn as_symbol(&self, id: ExprId) -> Option<Symbol> {
        if let Node::Symbol(symbol) = self.graph.node(id) { Some(*symbol) } else { None }
    }

    fn temporaries(&self, roots: &[ExprId]) -> TokenStream {
        self.parts(std::slice::from_ref(&self.program.temporaries), roots).into_iter().collect()
    }

    /// Binds shared expressions, those of each part by themselves. Roots may be read after any part.
    pub fn parts(&self, parts: &[Vec<ExprId>], roots: &[ExprId]) -> Vec<TokenStream> {
        let n_temporaries = self.program.temporaries.len();
        let is_long = n_temporaries > LONG;
        let size = if is_long { PART } else { CHUNK };
        let order: Vec<ExprId> = parts.concat();
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
    fn last_uses(&self, order: &[ExprId], roots: &[ExprId]) -> HashMap<ExprId, usize> {
        let mut last = HashMap::default();
        for (position, &id) in order.iter().enumerate() {
            for operand in self.graph.node(id).operands() {
                self.mark(operand, position, &mut last);
            }
        }
        for &root in roots {
            self.mark(root, usize::MAX, &mut last);
        }
        last
    }

    fn mark(&self, id: ExprId, position: usize, last: &mut HashMap<ExprId, usize>) {
        if self.names.contains_key(&id) {
            let entry = last.entry(id).or_insert(position);
            *entry = position.max(*entry);
            return;
        }
        for operand in self.graph.node(id).operands() {
            self.mark(operand, position, last);
        }
    }

    fn binding(&self, id: ExprId) -> TokenStream {
        let name = &self.names[&id];
        let (value, _) = self.operation(id);
        quote! { let #name = #value; }
    }

    /// An expression by its name if it has one, in parentheses if it binds less strongly than needed.
    fn expression(&self, id: ExprId, needed: Binding) -> TokenStream {
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

    fn operation(&self, id: ExprId) -> (TokenStream, Binding) {
        match self.graph.node(id) {
            Node::Constant(value) => (self.literal(value), Binding::Unary),
            Node::Symbol(symbol) => (self.variables.variable(*symbol).0, Binding::Call),
            Node::Add(a, b) => self.sum(*a, *b),
            Node::Mul(a, b) => (self.product(*a, *b), Binding::Product),
            Node::Neg(a) => self.negation(*a),
            Node::Recip(a) => {
                let (one, a) = (self.literal(&Constant::integer(1)), self.expression(*a, Binding::Unary));
                (quote! { #one / #a }, Binding::Product)
            }
            Node::Sqrt(a) => self.function("sqrt", *a),
            Node::Sin(a) => self.function("sin", *a),
            Node::Cos(a) => self.function("cos", *a),
            Node::Tanh(a) => self.function("tanh", *a),
            Node::Atan2(y, x) => {
                // Odd in y: a sign before it may as well be one before the angle.
                let (y, x) = (self.expression(*y, Binding::Unary), self.expression(*x, Binding::Sum));
                (quote! { #y.atan2(#x) }, Binding::Call)
            }
        }
    }

    /// A product that nobody else uses becomes one operation with the sum.
    fn sum(&self, a: ExprId, b: ExprId) -> (TokenStream, Binding) {
        if let Node::Neg(subtracted) = self.graph.node(b) {
            return self.difference(a, *subtracted);
        }
        let with_b = self.fusible(b).map(|factors| (factors, a));
        if let Some((factors, added)) = with_b.or_else(|| Some((self.fusible(a)?, b))) {
            let (x, y) = self.factors(factors);
            return fused(&x, &y, &self.expression(added, Binding::Sum));
        }
        let (first, second) = (self.expression(a, Binding::Sum), self.expression(b, Binding::Product));
        (quote! { #first + #second }, Binding::Sum)
    }

    fn difference(&self, from: ExprId, subtracted: ExprId) -> (TokenStream, Binding) {
        if let Some((x, y)) = self.fusible(subtracted) {
            let (x, y) = (self.expression(x, Binding::Unary), self.expression(y, Binding::Sum));
            let minus_x = quote! { -#x };
            return fused(&minus_x, &y, &self.expression(from, Binding::Sum));
        }
        if let Some(factors) = self.fusible(from) {
            let ((x, y), added) = (self.factors(factors), self.expression(subtracted, Binding::Unary));
            let minus_added = quote! { -#added };
            return fused(&x, &y, &minus_added);
        }
        let first = self.expression(from, Binding::Sum);
        let second = self.expression(subtracted, Binding::Product);
        (quote! { #first - #second }, Binding::Sum)
    }

    fn factors(&self, (x, y): (ExprId, ExprId)) -> (TokenStream, TokenStream) {
        (self.expression(x, Binding::Sum), self.expression(y, Binding::Sum))
    }

    /// The factors of a product that is written where it is used, and is not a quotient.
    fn fusible(&self, id: ExprId) -> Option<(ExprId, ExprId)> {
        match self.graph.node(id) {
            Node::Mul(a, b)
                if !self.names.contains_key(&id)
                    && self.program.uses.quotient(self.graph, *a, *b).is_none() =>
            {
                Some((*a, *b))
            }
            _ => None,
        }
    }

    fn product(&self, a: ExprId, b: ExprId) -> TokenStream {
        if let Some((numerator, denominator)) = self.program.uses.quotient(self.graph, a, b) {
            let numerator = self.expression(numerator, Binding::Product);
            let denominator = self.expression(denominator, Binding::Unary);
            return quote! { #numerator / #denominator };
        }
        let (a, b) = (self.expression(a, Binding::Product), self.expression(b, Binding::Unary));
        quote! { #a * #b }
    }

    /// A difference that is not needed elsewhere has its operands swapped instead of being negated.
    fn negation(&self, a: ExprId) -> (TokenStream, Binding) {
        if let Node::Add(x, y) = self.graph.node(a)
            && let Node::Neg(y) = self.graph.node(*y)
            && !self.names.contains_key(&a)
        {
            return self.difference(*y, *x);
        }
        let a = self.expression(a, Binding::Unary);
        (quote! { -#a }, Binding::Unary)
    }

    fn literal(&self, constant: &Constant) -> TokenStream {
        self.has_literals.set(true);
        self.literals.stand_in(constant)
    }

    fn function(&self, name: &str, a: ExprId) -> (TokenStream, Binding) {
        let (name, a) = (ident(name), self.expression(a, Binding::Call));
        (quote! { #a.#name() }, Binding::Call)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Coordinates;

    impl Variables for Coordinates {
        fn variable(&self, symbol: Symbol) -> (TokenStream, Option<TokenStream>) {
            let Symbol::Coordinate(k) = symbol else { unreachable!("there are no others") };
            let name = ident(&format!("x{k}"));
            (quote! { #name }, None)
        }

        fn element(&self, _: Symbol) -> Option<(&'static str, usize)> {
            None
        }
    }

    fn written(build: impl FnOnce(&mut Graph, [ExprId; 2]) -> ExprId) -> String {
        let mut graph = Graph::new();
        let [x, y] = [0, 1].map(|k| graph.symbol(Symbol::Coordinate(k)));
        let root = build(&mut graph, [x, y]);
        let body = body(&graph, &Coordinates, &Literals::default(), &[root]);
        body.values[0].to_string().replace(' ', "")
    }

    /// A method binds more strongly than a sign.
    #[test]
    fn functions_are_of_the_negative_where_the_graph_says_so() {
        let product = |graph: &mut Graph, [x, y]: [ExprId; 2]| {
            let product = graph.mul(x, y);
            graph.neg(product)
        };
        let root = |graph: &mut Graph, of| {
            let negative = product(graph, of);
            graph.sqrt(negative)
        };
        let of_product = "-(x0*x1)";
        assert_eq!(written(root), format!("({of_product}).sqrt()"));
        let opposite = |graph: &mut Graph, of| {
            let root = root(graph, of);
            graph.neg(root)
        };
        assert_eq!(written(opposite), format!("-({of_product}).sqrt()"));
    }
}
