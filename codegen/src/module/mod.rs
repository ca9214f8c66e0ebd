//! The text of a generated module: the mechanism's type and its implementation of the run-time contract.

mod definition;
mod equations;
mod mechanism;
mod ode;
mod partition;
mod variables;

use crate::emit::ident;
use crate::emit::{self, Body};
use crate::equations::Equations;
use crate::functions::Functions;
use crate::graph::ExprId;
use crate::schedule::Operations;
use crate::sheet;
use crate::symbol::Symbol;
use gyro_model::Start;
use proc_macro2::TokenStream;
use quote::quote;

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
    if ["Self", "T"].contains(&name.as_str()) { format!("{name}_") } else { name }
}

/// Writes the file.
pub fn write(file_name: &str, type_name: &str, equations: &Equations, start: &Start) -> String {
    let module = ModuleWriter { equations, type_name, functions: Functions::of(equations) };
    let tokens = module.tokens(start);
    let file = syn::parse2(tokens).expect("the emitted tokens are Rust");
    let sheet = sheet::write(file_name, equations, &module.functions);
    format!("{sheet}\n{}", prettyplease::unparse(&file))
}

/// What the parts of a module are written from.
struct ModuleWriter<'a> {
    equations: &'a Equations<'a>,
    type_name: &'a str,
    functions: Functions,
}

impl ModuleWriter<'_> {
    fn slots(&self) -> Vec<usize> {
        self.equations.model.coordinate_bodies()
    }

    fn body(&self, roots: &[ExprId]) -> Body {
        emit::body(&self.equations.graph, self, roots)
    }

    fn operations(&self, roots: &[ExprId]) -> Operations {
        Operations::count(&self.equations.graph, roots)
    }

    fn tokens(&self, start: &Start) -> TokenStream {
        let (definition, ode) = (self.definition(), self.ode(start));
        let (mechanism, partition, equations) = (self.mechanism(), self.partition(), self.equations());
        quote! {
            #definition
            #ode
            #mechanism
            #partition
            #equations
        }
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
        write: impl Fn(&Body, &TokenStream, &TokenStream) -> TokenStream,
    ) -> TokenStream {
        let body = self.body(roots);
        let reads_state = body.symbols.iter().any(|symbol| {
            matches!(
                symbol,
                Symbol::Position { .. }
                    | Symbol::Euler { .. }
                    | Symbol::Velocity { .. }
                    | Symbol::Spin { .. }
            )
        });
        let t = if body.symbols.contains(&Symbol::Time) {
            quote! { t }
        } else {
            quote! { _t }
        };
        let y = if reads_state {
            quote! { y }
        } else {
            quote! { _y }
        };
        let doc = format!(" {what}: {}.", self.operations(roots));
        let function = write(&body, &t, &y);
        quote! { #[doc = #doc] #function }
    }
}
