//! Functions of the contract, each as its signature says.

use super::writer::ModuleWriter;
use crate::emit::names::{ident, index};
use crate::emit::results::{Value, filled, stored};
use crate::emit::tokens::Body;
use crate::expr::symbol::Symbol;
use crate::scheduled;
use gyro_program::{Given, Kernel, Outcome, Signature, Space, State};
use proc_macro2::{Ident, TokenStream};
use quote::quote;

impl ModuleWriter<'_> {
    /// A function that computes something, with its operation counts. Arguments that it does not read get a leading
    /// underscore.
    pub fn written(&self, kernel: Kernel) -> TokenStream {
        let signature = kernel.signature();
        let (places, roots) = scheduled::written(self.equations, &self.kernels, kernel);
        self.function(signature.does, &roots, |body, t, read| {
            let solved = self.solved(signature, body);
            let work = self.work_of(kernel);
            let (t, state) = match (&solved, signature.state.argument()) {
                (Some(_), Some((state, _))) => (&quote! { t }, ident(state)),
                (None, Some((state, _))) if work.is_some() || signature.result == Outcome::Overwrites => {
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
                let (name, ty) = (if_read(name, reads_given(body)), ident(space.name()));
                arguments.push(quote! { #name: &Self::#ty });
            }
            if signature.result != Outcome::Overwrites {
                arguments.extend(signature.written().into_iter().map(|(name, space)| {
                    let (name, ty) = (ident(name), ident(space.name()));
                    quote! { #name: &mut Self::#ty }
                }));
            }
            let (name, statements) = (ident(kernel.name()), &body.statements);
            let (returns, results) = self.results(signature, &places, body, work);
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
    fn solved(&self, signature: &Signature, body: &Body) -> Option<TokenStream> {
        let (buffer, kernel) = match signature.given {
            Given::HandedOn(buffer, kernel) => (buffer, kernel),
            Given::First(buffer, kernel) if reads_given(body) => (buffer, kernel),
            _ => return None,
        };
        let (of, function) = (ident(kernel.group().trait_name()), ident(kernel.name()));
        let (buffer, state) = (ident(buffer), ident(signature.state.argument()?.0));
        let n = index(kernel.signature().n_results(&self.counts)?);
        Some(quote! {
            let mut #buffer = [T::constant(0.0); #n];
            gyro_sim::#of::#function(self, t, #state, &mut #buffer);
        })
    }

    /// Where the work stands that passes from one state into the other, if there is any: from and to.
    fn work_of(&self, kernel: Kernel) -> Option<[usize; 2]> {
        let (maximal, joint) = (13 * self.counts.bodies, self.counts.coordinates + self.counts.rates);
        match kernel {
            _ if self.counts.work == 0 => None,
            Kernel::ToMaximal => Some([joint, maximal]),
            Kernel::ToJoints => Some([maximal, joint]),
            _ => None,
        }
    }

    /// The result's type, if it is returned, and what hands the results over.
    fn results(
        &self,
        signature: &Signature,
        places: &[usize],
        body: &Body,
        work: Option<[usize; 2]>,
    ) -> (Option<TokenStream>, TokenStream) {
        let values = &body.values;
        let results = match signature.result {
            Outcome::Energies => {
                let [kinetic, potential] = [&values[0], &values[1]];
                let returns = quote! { -> gyro_sim::Energy<T> };
                return (
                    Some(returns),
                    quote! { gyro_sim::Energy { kinetic: #kinetic, potential: #potential } },
                );
            }
            Outcome::FillsTwo([(first, space), (second, _)]) => {
                let (one, other) = values.split_at(space.len(&self.counts));
                let [first, second] = [first, second].map(ident);
                quote! {
                    *#first = [#(#one),*];
                    *#second = [#(#other),*];
                }
            }
            Outcome::Fills(target, _) if places.is_empty() => filled(target, values),
            Outcome::Fills(target, space) => {
                filled(target, &self.with_handed_on(signature, space, (places, values), work))
            }
            Outcome::Renews(target, _) => {
                let all: Vec<usize> = (0..values.len()).collect();
                let (stored, target) = (stored(target, &all, values), ident(target));
                let work = work.map(|work| {
                    let [from, to] = work.map(index);
                    quote! { #target[#to] = y[#from]; }
                });
                quote! { #stored #work }
            }
            Outcome::Overwrites => {
                let (target, _) = signature.state.argument().expect("it overwrites a state");
                stored(target, places, values)
            }
            Outcome::Vectors | Outcome::Derived => unreachable!("it is no function of a trait"),
        };
        (None, results)
    }

    /// Results in their places, with accelerations, or the work, that others have computed between them.
    fn with_handed_on(
        &self,
        signature: &Signature,
        space: Space,
        (places, values): (&[usize], &[Value]),
        work: Option<[usize; 2]>,
    ) -> Vec<Value> {
        let mut own = places.iter().zip(values).peekable();
        let mut n_handed_on = 0;
        let all = (0..space.len(&self.counts)).map(|place| {
            if let Some((_, value)) = own.next_if(|(own, _)| **own == place) {
                return value.clone();
            }
            let (buffer, at) = match (signature.given, signature.state, work) {
                (Given::HandedOn(buffer, _), ..) => (buffer, n_handed_on),
                (_, State::Joint, Some([from, _])) => ("x", from),
                _ => unreachable!("all other numbers are its own"),
            };
            n_handed_on += 1;
            Value::of_buffer(buffer, at)
        });
        all.collect()
    }
}

/// Whether a body reads what is given beside the state.
fn reads_given(body: &Body) -> bool {
    body.symbols.iter().any(|symbol| {
        matches!(
            symbol,
            Symbol::Acceleration { .. }
                | Symbol::LoopMultiplier(_)
                | Symbol::RateOfRate(_)
                | Symbol::Change(_)
        )
    })
}

/// The name of an argument, with a leading underscore if nothing reads it.
pub fn if_read(name: &str, is_read: bool) -> Ident {
    if is_read { ident(name) } else { ident(&format!("_{name}")) }
}
