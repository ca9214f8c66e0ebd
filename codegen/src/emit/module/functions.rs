//! Functions of the contract, each as its signature says.

use super::writer::ModuleWriter;
use crate::emit::names::{ident, if_read, index};
use crate::emit::results::{Value, filled, stored};
use crate::emit::tokens::Body;
use crate::equations::Argument;
use crate::scheduled::{Store, Stored};
use gyro_program::{Given, Kernel, Outcome, Signature};
use proc_macro2::TokenStream;
use quote::quote;

impl ModuleWriter<'_> {
    /// A function that computes something, with its operation counts. Arguments that it does not read get a leading
    /// underscore.
    pub fn written(&self, kernel: Kernel) -> TokenStream {
        let signature = kernel.signature();
        self.function(kernel, |body, t, read| {
            let solved = self.solved(kernel);
            let results = self.results(signature, body);
            let has_work = self.counts().work > 0 && matches!(kernel, Kernel::ToMaximal | Kernel::ToJoints);
            let (t, state) = match (&solved, signature.state.argument()) {
                (Some(_), Some((state, _))) => (&quote! { t }, ident(state)),
                (None, Some((state, _))) if has_work || signature.result == Outcome::Overwrites => {
                    (t, ident(state))
                }
                _ => (t, read.clone()),
            };
            let mut arguments = vec![quote! { #t: T }];
            arguments.extend(signature.state.argument().map(|(_, space)| {
                let ty = ident(space.name());
                match signature.result {
                    Outcome::Overwrites => quote! { #state: &mut Self::#ty },
                    _ => quote! { #state: &Self::#ty },
                }
            }));
            if let Given::Told(name, space) = signature.given {
                let (name, ty) = (
                    if_read(name, self.reads_argument(kernel, &[Argument::Accelerations, Argument::Rows])),
                    ident(space.name()),
                );
                arguments.push(quote! { #name: &Self::#ty });
            }
            if signature.result != Outcome::Overwrites {
                arguments.extend(signature.written().into_iter().map(|(name, space)| {
                    let (name, ty) = (ident(name), ident(space.name()));
                    quote! { #name: &mut Self::#ty }
                }));
            }
            let (name, statements) = (ident(kernel.name()), &body.statements);
            let returns = (signature.result == Outcome::Energies).then(|| quote! { -> gyro_sim::Energy<T> });
            quote! {
                fn #name(&self, #(#arguments),*) #returns {
                    #solved
                    #statements
                    #results
                }
            }
        })
    }

    /// One that has nothing to write.
    pub fn idle(&self, kernel: Kernel) -> TokenStream {
        let Signature { state, result, .. } = kernel.signature();
        let (Some((state, ty)), Outcome::Fills(out, space)) = (state.argument(), result) else {
            return quote! {};
        };
        let (name, ty, space) = (ident(kernel.name()), ident(ty.name()), ident(space.name()));
        let [state, out] = [state, out].map(|name| if_read(name, false));
        quote! { fn #name(&self, _t: T, #state: &Self::#ty, #out: &mut Self::#space) {} }
    }

    /// What another function computes before this one; nothing if it is not read.
    fn solved(&self, kernel: Kernel) -> Option<TokenStream> {
        let (buffer, first) = self.scheduled.called_first(kernel)?;
        let (of, function) = (ident(first.group().trait_name()), ident(first.name()));
        let (buffer, state) = (ident(buffer), ident(first.signature().state.argument()?.0));
        let n = index(first.signature().n_results(self.counts())?);
        Some(quote! {
            let mut #buffer = [T::constant(0.0); #n];
            gyro_sim::#of::#function(self, t, #state, &mut #buffer);
        })
    }

    /// What hands the results over.
    fn results(&self, signature: &Signature, body: &Body) -> TokenStream {
        let stores = self.scheduled.stores(signature.kernel);
        let value = |store: &Store| match store.value {
            Stored::Result(n) => body.values[n].clone(),
            Stored::Element(array, at) => Value::of_named(array, at),
        };
        let values: Vec<Value> = stores.iter().map(value).collect();
        let places: Vec<usize> = stores.iter().map(|store| store.place).collect();
        match signature.result {
            Outcome::Energies => {
                let [kinetic, potential] = [&values[0], &values[1]];
                quote! { gyro_sim::Energy { kinetic: #kinetic, potential: #potential } }
            }
            Outcome::FillsTwo(arrays) => {
                let filled = arrays.map(|(array, _)| {
                    let (name, of) = (ident(array), stores.iter().zip(&values));
                    let values = of.filter(|(store, _)| store.array == array).map(|(_, value)| value);
                    quote! { *#name = [#(#values),*]; }
                });
                quote! { #(#filled)* }
            }
            Outcome::Fills(array, _) => filled(array, &values),
            Outcome::Renews(array, _) => stored(array, &places, &values),
            Outcome::Overwrites => {
                let (array, _) = signature.state.argument().expect("it overwrites a state");
                stored(array, &places, &values)
            }
            Outcome::Vectors | Outcome::Derived => unreachable!("it is no function of a trait"),
        }
    }
}
